//! Allocation of memory that ends the program in one line where the system has none left.

use std::alloc::{GlobalAlloc, Layout, System};

/// The system's allocator; a request that the system rejects ends the process with exit code 3.
///
/// The standard library would print two lines, and with `RUST_BACKTRACE` collect a backtrace, which may not end without memory.
pub struct Allocator;

// SAFETY: all requests go to the system's allocator as they are; a pointer that is null is not returned on Unix.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the promises of `alloc`.
        given(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the promises of `alloc_zeroed`.
        given(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller keeps the promises of `realloc`.
        given(unsafe { System.realloc(pointer, layout, size) }, size)
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the promises of `dealloc`.
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// The pointer; for none the end of the process.
#[inline]
fn given(pointer: *mut u8, size: usize) -> *mut u8 {
    if pointer.is_null() {
        exhausted(size);
    }
    pointer
}

/// Ends the process with one line. It allocates nothing.
#[cfg(unix)]
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
    // SAFETY: the bytes are those of the line. In one piece, so that lines of several processes do not mix.
    unsafe { libc::write(libc::STDERR_FILENO, line.as_ptr().cast(), length) };
    signal_hook::low_level::exit(3);
}

/// The standard library ends the process.
#[cfg(not(unix))]
#[cold]
fn exhausted(_: usize) {}

/// The digits of a number, in the last bytes of `digits`.
#[cfg(unix)]
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

#[cfg(all(test, unix))]
mod tests {
    use super::decimal;

    #[test]
    fn digits_of_all_sizes() {
        for number in [0, 7, 10, 33_177_600, usize::MAX] {
            assert_eq!(decimal(number, &mut [0; 20]), number.to_string().as_bytes());
        }
    }
}
