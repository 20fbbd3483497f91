//! Memory of settled beds of 10,000 spheres and 1,000 clumps of 10 spheres: state and scratch are copied, and `alloc`
//! below each line is what the copy takes, in bytes. Both beds hold 10,000 spheres: divide by that.
//!
//! `cargo bench --bench memory` (about 2 s). The model, which is shared and never changes, is not counted.

#[path = "common/bed.rs"]
mod bed;
#[path = "common/grains.rs"]
mod grains;

use bed::Bed;
use divan::{AllocProfiler, Bencher};

#[global_allocator]
static ALLOCATOR: AllocProfiler = AllocProfiler::system();

fn main() {
    divan::main();
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn spheres(bencher: Bencher<'_, '_>) {
    copy(bencher, &Bed::spheres());
}

#[divan::bench(sample_count = 5, sample_size = 1)]
fn clumps(bencher: Bencher<'_, '_>) {
    copy(bencher, &Bed::clumps());
}

fn copy(bencher: Bencher<'_, '_>, bed: &Bed) {
    bencher.bench_local(|| (bed.state.clone(), bed.work.clone()));
}
