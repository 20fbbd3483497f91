//! Memory of beds at rest (10,000 spheres; 1,000 clumps of 10): allocated bytes of model, state and scratch,
//! and the peak.
//!
//! `cargo bench --bench memory` (about 2 s). The peak includes input and scratch of the neighbour search.

#[path = "common/bed.rs"]
mod bed;
#[path = "common/boxes.rs"]
mod boxes;
#[path = "common/grains.rs"]
mod grains;

use bed::Bed;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// System allocator with counters.
struct Counting;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

fn grow(bytes: usize) {
    PEAK.fetch_max(LIVE.fetch_add(bytes, Relaxed) + bytes, Relaxed);
}

// SAFETY: calls are forwarded unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        grow(layout.size());
        // SAFETY: the caller's contract is forwarded.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as above.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        grow(size);
        LIVE.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as above.
        unsafe { System.realloc(at, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn main() {
    report("spheres", Bed::spheres);
    report("clumps", Bed::clumps);
}

fn report(name: &str, build: fn() -> Bed) {
    let before = LIVE.load(Relaxed);
    PEAK.store(before, Relaxed);
    let mut bed = build();
    bed.model.forget_start();
    let (live, peak) = (LIVE.load(Relaxed) - before, PEAK.load(Relaxed) - before);
    let spheres = bed.model.sphere_count() as f64;
    println!(
        "{name}: {live} bytes held, {:.0} per sphere; {peak} at most, {:.0} per sphere",
        live as f64 / spheres,
        peak as f64 / spheres
    );
}
