//! Memory limit of a call: 20 times its input plus 64 MB. Time: libFuzzer's `-timeout=1`.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Constant part of the limit [bytes].
const FLOOR: usize = 64 << 20;

/// System allocator with counted memory.
struct Counted;

static USED: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

// SAFETY: calls are forwarded unchanged.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let used = USED.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        MOST.fetch_max(used, Ordering::Relaxed);
        // SAFETY: as above.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        USED.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counted = Counted;

/// Calls a target.
///
/// # Panics
/// If it exceeds the memory limit.
pub fn within(target: fn(&[u8]), data: &[u8]) {
    let before = USED.load(Ordering::Relaxed);
    MOST.store(before, Ordering::Relaxed);
    target(data);
    let most = MOST.load(Ordering::Relaxed).saturating_sub(before);
    assert!(most <= 20 * data.len() + FLOOR, "{most} bytes of memory for an input of {}", data.len());
}
