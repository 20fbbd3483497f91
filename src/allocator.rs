//! Allocator that exits with one line when memory is exhausted.

use std::alloc::{GlobalAlloc, Layout, System};
use trackbed_io::system;

/// System allocator; failed requests exit with code 3.
pub struct Allocator;

// SAFETY: passed to the system allocator; no null pointer is returned.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as required by `alloc`.
        given(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as required by `alloc_zeroed`.
        given(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as required by `realloc`.
        given(unsafe { System.realloc(pointer, layout, size) }, size)
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as required by `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[inline]
fn given(pointer: *mut u8, size: usize) -> *mut u8 {
    if pointer.is_null() {
        exhausted(size);
    }
    pointer
}

/// Must not allocate.
#[cold]
fn exhausted(size: usize) {
    use std::sync::atomic::{AtomicBool, Ordering};
    static ENDS: AtomicBool = AtomicBool::new(false);
    while ENDS.swap(true, Ordering::Relaxed) {
        // Another thread prints the line.
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let mut digits = [0; 20];
    let number = decimal(size, &mut digits);
    let parts: [&[u8]; 3] = [
        b"error: memory: found no free memory for ",
        number,
        b" bytes, expected more. Reduce the scene, or raise the system limit (ulimit -v)\n",
    ];
    let mut line = [0; 200];
    let mut length = 0;
    for part in parts {
        line[length..length + part.len()].copy_from_slice(part);
        length += part.len();
    }
    // One call, so that lines of processes do not mix.
    system::write_error(&line[..length]);
    signal_hook::low_level::exit(3);
}

fn decimal(mut number: usize, digits: &mut [u8; 20]) -> &[u8] {
    let mut first = digits.len();
    loop {
        first -= 1;
        digits[first] = b'0' + (number % 10) as u8;
        number /= 10;
        if number == 0 {
            return &digits[first..];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::decimal;

    #[test]
    fn digits_of_all_sizes() {
        for number in [0, 7, 10, 33_177_600, usize::MAX] {
            assert_eq!(decimal(number, &mut [0; 20]), number.to_string().as_bytes());
        }
    }
}
