//! CG for coupling windows and Newmark steps, against the direct solver.

use crate::common::{Random, difference, fix};
use crate::mixed::block;
use trackbed_fem::boundary::BoundaryLayer;
use trackbed_fem::energy;
use trackbed_fem::newmark::{NewmarkSolver, StepLoads};
use trackbed_fem::solver::conjugate::Stopped;
use trackbed_fem::theta::{ThetaMethod, ThetaSolver};
use trackbed_fem::{
    Elastic, ElementKind, Mass, Mesh, Method, Methods, Model, ModelInput, Quadrature, Rayleigh, SolveError,
    State,
};

const SOIL: Elastic = Elastic { young: 60e6, poisson: 0.35, density: 1900.0 };
const STIFF: Elastic = Elastic { young: 300e6, poisson: 0.25, density: 2300.0 };
/// Coupling window [s].
const WINDOW: f64 = 1e-4;

fn iterative(tolerance: f64) -> Methods {
    Methods { dynamics: Method::Iterative { tolerance }, ..Methods::default() }
}

/// Two soils, dashpots on one side, damping.
pub fn soils(kind: ElementKind, counts: [usize; 3], mass: Mass, methods: Methods) -> Model {
    let size = counts.map(|n| 0.25 * n as f64);
    let mut mesh = match kind {
        ElementKind::Hex20 => Mesh::block(counts, size),
        kind => block(kind, counts, size),
    };
    for e in 0..mesh.element_count() {
        mesh.materials[e] = if mesh.element_centre(e)[2] > 0.5 * size[2] { 2 } else { 1 };
    }
    let side: Vec<_> = mesh
        .boundary_faces()
        .into_iter()
        .filter(|f| f.nodes().iter().all(|&n| mesh.coordinates[n as usize][0] < 1e-9))
        .collect();
    Model::new(ModelInput {
        constraints: fix(&mesh, &[0, 1, 2], |x| x[2] < 1e-9),
        materials: [(1, SOIL.into()), (2, STIFF.into())].into(),
        quadrature: Quadrature::Gauss2,
        gravity: [0.0, 0.0, -9.81],
        rayleigh: Rayleigh { alpha_m: 1.0, beta_k: 2e-4 },
        mass,
        boundaries: vec![BoundaryLayer::absorbing(side, &SOIL)],
        methods,
        mesh,
        ..ModelInput::default()
    })
    .unwrap()
}

pub fn loads(model: &Model, count: usize) -> Vec<Vec<f64>> {
    let mut random = Random(17);
    (0..count).map(|_| (0..model.dof_count()).map(|_| 1e3 * random.next()).collect()).collect()
}

/// Base displacements [m].
fn shake(model: &Model, step: usize) -> Vec<f64> {
    let phase = 0.3 * step as f64;
    model.supports().fixed().iter().map(|(dof, _)| 1e-5 * phase.sin() * f64::from(dof % 3)).collect()
}

/// Final state and most iterations of ten windows, random loads, moving base.
pub fn windows(model: &Model, theta: f64) -> (State, u32) {
    let mut solver = ThetaSolver::new(model, theta, WINDOW).unwrap();
    let mut state = State::new(model);
    for (k, load) in loads(model, 10).iter().enumerate() {
        solver.step_prescribed(model, &mut state, load, Some(&shake(model, k))).unwrap();
    }
    (state, solver.counts().map_or(0, |c| c.most))
}

#[test]
fn windows_match_direct_solver() {
    for (kind, counts) in [(ElementKind::Hex20, [5, 4, 4]), (ElementKind::Tet10, [4, 3, 3])] {
        for (mass, theta) in [(Mass::Lumped, 0.5), (Mass::Lumped, 0.8), (Mass::Consistent, 0.55)] {
            let (direct, _) = windows(&soils(kind, counts, mass, Methods::default()), theta);
            for tolerance in [1e-6, 1e-10] {
                let (found, most) = windows(&soils(kind, counts, mass, iterative(tolerance)), theta);
                let miss = difference(&found.u, &direct.u).max(difference(&found.v, &direct.v));
                println!(
                    "{} {mass:?} theta {theta}, tolerance {tolerance:.0e}: {most} iterations, differs by {miss:.1e}",
                    kind.name()
                );
                assert!(miss < 30.0 * tolerance && miss > 0.0, "{miss:e}");
                assert!(most < if mass == Mass::Lumped { 40 } else { 250 });
            }
        }
    }
}

#[test]
fn newmark_and_hht_match_direct_solver() {
    let run = |methods| {
        let model = soils(ElementKind::Hex20, [5, 4, 4], Mass::Lumped, methods);
        let mut solver = NewmarkSolver::hht(&model, -0.1, 4.0 * WINDOW).unwrap();
        let mut state = State::new(&model);
        for (k, ends) in loads(&model, 11).windows(2).enumerate() {
            let prescribed = shake(&model, k);
            let drive =
                StepLoads { load_start: Some(&ends[0]), load_end: &ends[1], prescribed: Some(&prescribed) };
            solver.advance(&model, &mut state, drive).unwrap();
        }
        (state, solver.counts())
    };
    let ((direct, none), (found, counts)) = (run(Methods::default()), run(iterative(1e-10)));
    let miss = difference(&found.u, &direct.u).max(difference(&found.v, &direct.v));
    println!("differs by {miss:.1e}, {counts:?}");
    assert!(none.is_none() && miss < 1e-8 && miss > 0.0, "{miss:e}");
    assert_eq!(counts.map(|c| c.solves), Some(10));
}

#[test]
fn iteration_count_independent_of_model_size() {
    let sizes = [[4, 4, 2], [8, 8, 4], [16, 8, 8]];
    let counts = sizes.map(|counts| {
        let model = soils(ElementKind::Hex20, counts, Mass::Lumped, iterative(1e-10));
        let most = windows(&model, 0.5).1;
        println!("{counts:?}, {} nodes: {most} iterations", model.mesh().node_count());
        most
    });
    assert!(counts.iter().all(|&c| c > 5 && c <= 2 * counts[0]), "{counts:?}");
}

#[test]
fn energy_balance_closes_within_tolerance() {
    for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
        let model = soils(ElementKind::Hex20, [4, 4, 4], Mass::Lumped, iterative(tolerance));
        let total = |s: &State| energy::kinetic(&model, s) + energy::strain(&model, s);
        let mut solver = ThetaSolver::new(&model, 0.55, WINDOW).unwrap();
        let (mut state, mut miss, mut work) = (State::new(&model), 0.0, 0.0);
        for load in loads(&model, 40) {
            let before = total(&state);
            let audit = solver.step(&model, &mut state, &load).unwrap();
            let lost = audit.damping_dissipation + audit.boundary_dissipation + audit.numerical_dissipation;
            miss += audit.external_work - (total(&state) - before) - lost;
            work += audit.external_work.abs();
        }
        println!("tolerance {tolerance:.0e}: account off by {:.1e} of the work", miss.abs() / work);
        assert!(miss.abs() < 10.0 * tolerance * work, "{miss:e} of {work:e}");
    }
}

fn bits(state: &State) -> Vec<u64> {
    state.u.iter().chain(&state.v).chain(&state.a).map(|x| x.to_bits()).collect()
}

#[test]
fn window_bits_independent_of_thread_count() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let model = soils(ElementKind::Hex20, [12, 9, 7], Mass::Lumped, iterative(1e-10));
            assert!(model.mesh().node_count() > 3 * 1024, "several parts");
            bits(&windows(&model, 0.55).0)
        })
    };
    let one = on(1);
    assert!(one == on(2) && one == on(3) && one == on(7));
}

#[test]
fn new_solver_continues_bitwise_identically() {
    let model = soils(ElementKind::Tet10, [4, 3, 3], Mass::Lumped, iterative(1e-8));
    let run = |restart: bool| {
        let mut state = State::new(&model);
        let mut solver = ThetaSolver::new(&model, 0.6, WINDOW).unwrap();
        for (n, load) in loads(&model, 10).iter().enumerate() {
            if restart && n == 5 {
                solver = ThetaSolver::new(&model, 0.6, WINDOW).unwrap();
            }
            solver.step(&model, &mut state, load).unwrap();
        }
        bits(&state)
    };
    assert!(run(false) == run(true));
}

#[test]
fn a_steady_load_takes_fewer_iterations() {
    let model = soils(ElementKind::Hex20, [5, 4, 4], Mass::Lumped, iterative(1e-8));
    let load = model.gravity_load();
    let mut solver = ThetaSolver::new(&model, 0.6, WINDOW).unwrap();
    let mut state = State::new(&model);
    let steps: Vec<u64> = (0..60)
        .map(|_| {
            let before = solver.counts().unwrap().iterations;
            solver.step(&model, &mut state, &load).unwrap();
            solver.counts().unwrap().iterations - before
        })
        .collect();
    println!("{steps:?}");
    assert!(steps[40..].iter().all(|&s| s < steps[0]), "{steps:?}");
}

/// Prediction with contacts stiff against the window matrix, and its iterations.
pub fn predict(methods: Methods) -> (Vec<f64>, u32) {
    let model = soils(ElementKind::Hex20, [5, 4, 4], Mass::Lumped, methods);
    let load = &loads(&model, 1)[0];
    let mut solver = ThetaSolver::new(&model, 0.6, WINDOW).unwrap();
    let mut state = State::new(&model);
    solver.step(&model, &mut state, load).unwrap();
    let top: Vec<usize> =
        (0..model.mesh().node_count()).filter(|&n| model.mesh().coordinates[n][2] > 0.99).collect();
    let mut contacts =
        |w: &[f64], f: &mut [f64]| top.iter().for_each(|&n| f[3 * n + 2] += 1e6 * w[3 * n + 2]);
    let mut rate = vec![0.0; model.dof_count()];
    let iterations =
        solver.solve_with_contact_stiffness(&model, &state, load, &mut contacts, &mut rate).unwrap();
    (rate, iterations)
}

#[test]
fn predictions_match_direct_solver() {
    let ((direct, few), (found, more)) = (predict(Methods::default()), predict(iterative(1e-10)));
    println!("{few} iterations on the factor, {more} without: differ by {:.1e}", difference(&found, &direct));
    assert!(difference(&found, &direct) < 1e-6 && few > 0 && more > few);
}

#[test]
fn reports_failed_convergence_and_keeps_state() {
    // Slender column, window so long that mass is negligible.
    let model = soils(ElementKind::Hex20, [1, 1, 120], Mass::Lumped, iterative(1e-13));
    let mut solver = ThetaSolver::new(&model, 0.6, 1e4).unwrap();
    let mut state = State::new(&model);
    let error = solver.step(&model, &mut state, &loads(&model, 1)[0]).unwrap_err();
    println!("{error}");
    let SolveError::NotConverged { stopped, .. } = error else { panic!("{error}") };
    let Stopped::Limit { iterations: 2000, residual } = stopped else { panic!("{stopped}") };
    assert!(residual > 1e-13 && residual.is_finite(), "{residual:e}");
    assert!(state == State::new(&model));
}
