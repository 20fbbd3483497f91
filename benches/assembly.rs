//! Assembly (`Model::new`) of blocks of 20-node bricks: checks, pattern, stiffness, consistent mass. Elements
//! per second of wall time (`item/s`); arguments: elements per side, threads. Stiffness: `full` 27 points,
//! `reduced` 8; mass 27.
//!
//! `cargo bench --bench assembly` (about 10 s).

#[path = "common/remarks.rs"]
mod remarks;
#[path = "common/watch.rs"]
mod watch;

use divan::Bencher;
use divan::counter::ItemsCount;
use trackbed_fem::{Elastic, Mesh, Model, ModelInput, Quadrature};

fn main() {
    divan::main();
    remarks::print();
}

#[divan::bench(args = [(8, 1), (8, 2), (16, 1), (16, 2)], sample_count = 20, sample_size = 1, max_time = 3)]
fn full(bencher: Bencher<'_, '_>, (side, threads): (usize, usize)) {
    assemble(bencher, side, threads, Quadrature::Gauss3);
}

#[divan::bench(args = [(8, 1), (8, 2), (16, 1), (16, 2)], sample_count = 20, sample_size = 1, max_time = 3)]
fn reduced(bencher: Bencher<'_, '_>, (side, threads): (usize, usize)) {
    assemble(bencher, side, threads, Quadrature::Gauss2);
}

fn assemble(bencher: Bencher<'_, '_>, side: usize, threads: usize, quadrature: Quadrature) {
    let input = ModelInput {
        mesh: Mesh::block([side; 3], [1.0; 3]),
        materials: [(1, Elastic { young: 20e6, poisson: 0.3, density: 2000.0 }.into())].into(),
        quadrature,
        constraints: Vec::new(),
        gravity: [0.0; 3],
        ..Default::default()
    };
    let pool = watch::pool(threads);
    let (mut watch, mut elements) = (watch::Watch::default(), 0);
    bencher.counter(ItemsCount::new(side.pow(3))).with_inputs(|| input.clone()).bench_local_values(|input| {
        elements += input.mesh.element_count();
        watch.time(|| pool.install(|| Model::new(input).expect("a block is a model")))
    });
    remarks::add(format!(
        "{quadrature:?}, {side}³ elements, {threads} threads: {:.1} k elements per processor second",
        elements as f64 / watch.cpu / 1e3
    ));
}
