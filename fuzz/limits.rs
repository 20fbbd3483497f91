//! What a call may take: memory of 20 times its input and 64 MB. Time is libFuzzer's to watch (`-timeout=1`).

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Memory that a call may take besides 20 times its input [bytes].
const FLOOR: usize = 64 << 20;

/// The system's allocator, with the memory in use counted.
struct Counted;

static USED: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

// SAFETY: all is done by the system's allocator.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let used = USED.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        MOST.fetch_max(used, Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        USED.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counted = Counted;

/// Calls a target with its input.
///
/// # Panics
/// Where it takes more memory than it may.
pub fn within(target: fn(&[u8]), data: &[u8]) {
    let before = USED.load(Ordering::Relaxed);
    MOST.store(before, Ordering::Relaxed);
    target(data);
    let most = MOST.load(Ordering::Relaxed).saturating_sub(before);
    assert!(most <= 20 * data.len() + FLOOR, "{most} bytes of memory for an input of {}", data.len());
}
