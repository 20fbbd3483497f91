//! Memory of settled beds of 10,000 spheres and 1,000 clumps of 10 spheres, walls and contacts included: all that the
//! run holds (model, state, scratch), in bytes as the allocator was asked for them, and the peak while the bed was
//! built and stepped.
//!
//! `cargo bench --bench memory` (about 2 s). The search for neighbours, once in some thousand steps of a settled bed,
//! takes scratch that is freed at once; it is in the peak. So is the input that the model was made from.

#[path = "common/bed.rs"]
mod bed;
#[path = "common/boxes.rs"]
mod boxes;
#[path = "common/grains.rs"]
mod grains;

use bed::Bed;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// The system's allocator, counting.
struct Counting;

static LIVE: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

fn grow(bytes: usize) {
    PEAK.fetch_max(LIVE.fetch_add(bytes, Relaxed) + bytes, Relaxed);
}

// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        grow(layout.size());
        // SAFETY: the caller's promises go on to the system.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        LIVE.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller's promises go on to the system.
        unsafe { System.dealloc(at, layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        grow(size);
        LIVE.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller's promises go on to the system.
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
