//! Coupled windows (10 DEM steps, one FEM step) per second of wall time (`item/s`), on blocks of 20-node
//! bricks. Below: milliseconds per part, simulated seconds per second.
//!
//! `cargo bench --bench coupled` (about 30 s).
//!
//! * `settling`: 1,000 spheres (radius up to 45 mm) fall in a 1 m box onto 1 × 1 × 0.5 m, 4 × 4 × 4 elements,
//!   fixed base; 0.5 s, DEM step 2e-5 s, window 2e-4 s, restitution 0.3, friction 0.5; E 20 MPa, nu 0.3, 1800
//!   kg/m³, stiffness-proportional damping 1e-4 s. K = 3e5 N/m: like Hertz with E 100 MPa, nu 0.2 at 1 m/s.
//! * `clumps`: 1,000 clumps of 10 spheres at rest, 0.4 × 0.4 × 0.2 m, same elements and material; one and two
//!   threads.
//! * `solid_step`: FEM step, varying top load, 8 × 8 × 6 elements, 2,061 nodes: direct solver, or 60 modes;
//!   50 steps. The reduction's error estimate is printed.
//!
//! Kratos (PyPI `KratosDEMApplication`, `KratosDemStructuresCouplingApplication`): `settling` from
//! `data/falling_1k.csv`, Hertz (E 100 MPa, nu 0.2), 8 × 8 × 4 cells of six 4-node tetrahedra (405 nodes), 10
//! substeps, one thread, CPU time.

#[path = "common/boxes.rs"]
mod boxes;
#[path = "common/grains.rs"]
mod grains;
#[path = "common/remarks.rs"]
mod remarks;
#[path = "common/watch.rs"]
mod watch;

use divan::Bencher;
use divan::counter::ItemsCount;
use std::cell::Cell;
use std::sync::Arc;
use std::time::Instant;
use trackbed_coupling::step::{self, Model, State, Work};
use trackbed_coupling::surface::SolidSurface;
use trackbed_coupling::transfer::{Transfer, TransferAudit};
use trackbed_dem::{Material, ModelInput, Shape, TimeStep};
use trackbed_fem::reduction::{ReducedModel, Reduction};
use trackbed_fem::theta::{ReducedTheta, ThetaMethod, ThetaSolver};
use trackbed_fem::{Constraint, Elastic, Mesh, Quadrature, Rayleigh};
use watch::Watch;

const SUBSTEPS: u32 = 10;

fn main() {
    divan::main();
    remarks::print();
}

#[divan::bench(sample_count = 1, sample_size = 1)]
fn settling(bencher: Bencher<'_, '_>) {
    let input = ModelInput {
        materials: vec![Material { density: 2650.0, stiffness: 3e5, restitution: 0.3, ..grains::stone() }],
        shapes: vec![Shape::Sphere { radius: 1.0 }],
        bodies: grains::spheres(&grains::table("falling_1k.csv")),
        ..ModelInput::default()
    };
    run(bencher, "settling", 1, input, [1.0, 0.5], [0, 2500]);
}

#[divan::bench(args = [1, 2], sample_count = 10, sample_size = 1)]
fn clumps(bencher: Bencher<'_, '_>, threads: usize) {
    let (shape, bodies) = boxes::clumps(&grains::table("s2_1k.csv"));
    let input =
        ModelInput { materials: vec![grains::stone()], shapes: vec![shape], bodies, ..ModelInput::default() };
    run(bencher, "clumps", threads, input, [0.4, 0.2], [50, 20]);
}

const CHOICES: [(&str, Option<Reduction>); 2] =
    [("full", None), ("modes", Some(Reduction::Modes { modes: 60 }))];

#[divan::bench(args = CHOICES.map(|c| c.0), sample_count = 5, sample_size = 1)]
fn solid_step(bencher: Bencher<'_, '_>, name: &str) {
    let solid = block_of([8, 8, 6], [1.0, 0.6]);
    let faces = SolidSurface::facing(solid.mesh(), [0.0, 0.0, 1.0], 1.3);
    let mut state = trackbed_fem::State::new(&solid);
    let mut loads = vec![vec![0.0; solid.dof_count()]; 2];
    for (k, load) in loads.iter_mut().enumerate() {
        for n in faces.iter().flat_map(|f| f.nodes) {
            load[3 * n as usize + 2] = -100.0 * (1.0 + (n as f64 + k as f64).sin());
        }
    }
    let reduction = CHOICES.iter().find(|c| c.0 == name).and_then(|c| c.1);
    let mut full = ThetaSolver::new(&solid, 0.5, 2e-4).expect("a solid that can be factored");
    let start = Instant::now();
    let mut reduced = reduction.map(|r| {
        let reduced = ReducedModel::new(&solid, &faces, &faces, r).expect("a reduction");
        remarks::add(format!(
            "{name}: {} ({:.1} s to make)",
            reduced.estimate(),
            start.elapsed().as_secs_f64()
        ));
        ReducedTheta::new(&solid, Arc::new(reduced), 0.5, 2e-4, &vec![0.0; solid.dof_count()])
            .expect("the same solid")
    });
    const STEPS: u32 = 50;
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        for k in 0..STEPS {
            let load = &loads[k as usize % 2];
            let audit = match &mut reduced {
                Some(solver) => solver.step(&solid, &mut state, load),
                None => full.step(&solid, &mut state, load),
            };
            divan::black_box(audit.expect("a finite load"));
        }
    });
}

fn block(size: [f64; 2]) -> trackbed_fem::Model {
    block_of([4; 3], size)
}

fn block_of(counts: [usize; 3], [width, height]: [f64; 2]) -> trackbed_fem::Model {
    let mut mesh = Mesh::block(counts, [width, width, height]);
    mesh.coordinates.iter_mut().for_each(|x| x[2] -= height);
    let constraints = (0..mesh.node_count() as u32)
        .filter(|&i| mesh.coordinates[i as usize][2] == -height)
        .flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }))
        .collect();
    trackbed_fem::Model::new(trackbed_fem::ModelInput {
        mesh,
        materials: [(1, Elastic { young: 2e7, poisson: 0.3, density: 1800.0 }.into())].into(),
        quadrature: Quadrature::Gauss3,
        constraints,
        gravity: [0.0; 3],
        rayleigh: Rayleigh { alpha_m: 0.0, beta_k: 1e-4 },
        ..Default::default()
    })
    .expect("a block is a model")
}

#[derive(Default)]
struct Split {
    grains: f64,
    transfer: f64,
    solid: f64,
    windows: u32,
}

/// Times `windows` windows after a warm-up.
fn run(
    bencher: Bencher<'_, '_>,
    name: &str,
    threads: usize,
    mut input: ModelInput,
    size: [f64; 2],
    [before, windows]: [u32; 2],
) {
    let solid = block(size);
    input.planes = boxes::walls(size[0]);
    input.surface_material = Some(0);
    input.time_step = TimeStep::Fixed(2e-5);
    let zero = vec![0.0; solid.dof_count()];
    let model = Model {
        solid: &solid,
        grains: trackbed_dem::Model::new(input).expect("the grains are a model"),
        substeps: SUBSTEPS,
        division: 1,
        scheme: Default::default(),
        theta: 0.5,
        newton: Default::default(),
        dead_load: zero.clone(),
        reference: zero,
    };
    let faces = SolidSurface::facing(solid.mesh(), [0.0, 0.0, 1.0], 1.3);
    let surface = SolidSurface::new(solid.mesh(), faces);
    let mut state = State::new(trackbed_fem::State::new(&solid), trackbed_dem::State::new(&model.grains));
    let mut work = Work::new(&model, &state, surface).expect("the solid's matrix can be factored");

    let pool = watch::pool(threads);
    let mut split = Split::default();
    pool.install(|| (0..before).for_each(|_| window(&model, &mut state, &mut work, &mut Split::default())));
    let lists = work.grains.rebuilds();
    let mut watch = Watch::default();
    bencher.counter(ItemsCount::new(windows)).bench_local(|| {
        watch.time(|| {
            pool.install(|| (0..windows).for_each(|_| window(&model, &mut state, &mut work, &mut split)));
        });
    });
    let after = work.grains.rebuilds();
    let per_window = |seconds: f64| 1e3 * seconds / f64::from(split.windows);
    let simulated = model.window() * f64::from(split.windows);
    remarks::add(format!(
        "{name}, {threads} threads, {} windows, {} searches, {} near lists: grains {:.3} ms, transfer {:.3} ms, solid {:.3} ms per window; {:.4} \
         simulated seconds per second, {:.4} per processor second; {} contacts with the solid at the end",
        split.windows,
        after.0 - lists.0,
        after.1 - lists.1,
        per_window(split.grains),
        per_window(split.transfer),
        per_window(split.solid),
        simulated / watch.wall,
        simulated / watch.cpu,
        work.grains.surface_contacts().len(),
    ));
}

/// One window, timed by the applied-force callback of each DEM step; the last step is extrapolated. Every
/// tenth window times an extra data exchange.
fn window(model: &Model<'_>, state: &mut State, work: &mut Work, split: &mut Split) {
    let (first, last) = (Cell::new(None), Cell::new(None));
    let start = Instant::now();
    let forces = |_: f64, _: &trackbed_dem::State, _: &mut Vec<trackbed_dem::AppliedForce>| {
        last.set(Some(Instant::now()));
        first.set(first.get().or(last.get()));
    };
    step::step(model, state, work, forces, |_, _| {}).expect("the step is stable");
    let end = Instant::now();
    let (first, last) = (first.get().expect("grains were stepped"), last.get().expect("more than once"));
    let steps = f64::from(SUBSTEPS);
    let grains = (last - first).as_secs_f64() * steps / (steps - 1.0);
    split.grains += grains;
    split.transfer += (first - start).as_secs_f64();
    split.solid += (end - first).as_secs_f64() - grains;
    split.windows += 1;
    if split.windows.is_multiple_of(10) {
        let mut transfer = Transfer::new(&work.surface);
        let dt = model.grains.dt();
        let start = Instant::now();
        work.surface.advance(f64::from(SUBSTEPS - 1) * dt);
        transfer.add(&work.surface, work.grains.surface_contacts(), dt, &mut TransferAudit::default());
        let exchange = 10.0 * f64::from(SUBSTEPS) * start.elapsed().as_secs_f64();
        split.grains -= exchange;
        split.transfer += exchange;
    }
}
