//! Every method of time integration behind the one trait, on one body: a column under a load that swings.
//!
//! Reference is the linear Newmark method at a step sixteen times shorter. Tolerance 1 %: the methods are of second order
//! and take 160 steps per period of the load.

use std::sync::Arc;
use trackbed_fem::newmark::{Newmark, NewmarkSolver, initial_acceleration};
use trackbed_fem::nonlinear::{Driven, Dynamics, NewtonOptions, QuasiStatic, StepControl, Variant};
use trackbed_fem::reduction::{Reduced, Reduction};
use trackbed_fem::theta::{NonlinearTheta, ReducedTheta, ThetaSolver};
use trackbed_fem::{
    Constraint, DruckerPrager, Elastic, Material, Mesh, Model, ModelInput, Quadrature, Rayleigh, SolveError,
    State, StepAudit, TimeIntegrator, energy, loads,
};

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.0, density: 2000.0 };
const LENGTH: f64 = 4.0;
const PERIOD: f64 = 0.4;
const DT: f64 = PERIOD / 160.0;

/// A column on a fixed foot; with a strength that it never reaches where `plastic`.
fn column(plastic: bool) -> Model {
    let mesh = Mesh::block([1, 1, 4], [1.0, 1.0, LENGTH]);
    let foot = (0..mesh.node_count() as u32).filter(|&n| mesh.coordinates[n as usize][2] == 0.0);
    let constraints = foot
        .flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }))
        .collect();
    let strong = Material::plastic(SOIL, DruckerPrager::von_mises(1e9));
    let material = if plastic { strong } else { SOIL.into() };
    Model::new(ModelInput {
        mesh,
        materials: [(1, material)].into(),
        quadrature: Quadrature::Gauss3,
        constraints,
        rayleigh: Rayleigh { alpha_m: 0.5, beta_k: 1e-4 },
        ..Default::default()
    })
    .unwrap()
}

fn top(model: &Model) -> usize {
    3 * (model.mesh().node_count() - 1) + 2
}

/// Traction on the top.
fn swing(model: &Model) -> impl FnMut(f64, &mut [f64]) + use<> {
    let (mesh, mut unit) = (model.mesh(), vec![0.0; model.dof_count()]);
    for face in mesh.boundary_faces().iter().filter(|f| f.centre(mesh)[2] == LENGTH) {
        loads::face_traction(mesh, face, [0.0, 0.0, 1e4], &mut unit);
    }
    move |time, load| {
        let share = (std::f64::consts::TAU * time / PERIOD).sin();
        load.iter_mut().zip(&unit).for_each(|(l, u)| *l += share * u);
    }
}

/// The θ-method of a column in the span of its slowest modes.
fn reduced(model: &Model) -> ReducedTheta {
    let (mesh, modes) = (model.mesh(), Reduction::Modes { modes: 12 });
    let faces = mesh.boundary_faces();
    let top: Vec<_> = faces.into_iter().filter(|f| f.centre(mesh)[2] == LENGTH).collect();
    let shapes = Arc::new(Reduced::new(model, &top, modes).unwrap());
    ReducedTheta::new(model, shapes, 0.5, DT).unwrap()
}

/// Deflections of the top after every step, the state at the end, and the sum of the ledgers.
fn course(method: &mut dyn TimeIntegrator, model: &Model, end: f64) -> (Vec<[f64; 2]>, State, StepAudit) {
    let mut state = State::new(model);
    let (mut rows, mut sum) = (Vec::new(), StepAudit::default());
    method
        .integrate(model, &mut state, end, &mut swing(model), &mut |state, report, audit| {
            assert_eq!(report.time, state.time);
            rows.push([state.time, state.u[top(model)]]);
            if let Some(a) = audit {
                sum += *a;
            }
        })
        .unwrap();
    assert_eq!(state.time, end);
    (rows, state, sum)
}

#[test]
fn every_dynamic_method_follows_the_same_motion_and_closes_its_ledger() {
    let (linear, plastic) = (column(false), column(true));
    let options = NewtonOptions { force_tolerance: 1e-10, ..NewtonOptions::new(Variant::Full) };
    let control = StepControl::fixed(DT);
    let average = Newmark::AVERAGE_ACCELERATION;
    let mut fine = NewmarkSolver::new(&linear, average, DT / 16.0).unwrap();
    let (reference, ..) = course(&mut fine, &linear, 2.0 * PERIOD);
    let size = reference.iter().fold(0.0, |m: f64, r| m.max(r[1].abs()));
    let methods: [(&str, &Model, Box<dyn TimeIntegrator>); 7] = [
        ("Newmark", &linear, Box::new(NewmarkSolver::new(&linear, average, DT).unwrap())),
        ("HHT", &linear, Box::new(NewmarkSolver::hht(&linear, -0.05, DT).unwrap())),
        ("mid-point", &linear, Box::new(ThetaSolver::new(&linear, 0.5, DT).unwrap())),
        ("reduced mid-point", &linear, Box::new(reduced(&linear))),
        (
            "plastic Newmark",
            &plastic,
            Box::new(Dynamics::newmark(&plastic, average, options, control).unwrap()),
        ),
        ("plastic HHT", &plastic, Box::new(Dynamics::hht(&plastic, -0.05, options, control).unwrap())),
        ("plastic mid-point", &plastic, Box::new(NonlinearTheta::new(&plastic, 0.5, DT, options).unwrap())),
    ];
    for (name, model, mut method) in methods {
        let (rows, state, sum) = course(&mut *method, model, 2.0 * PERIOD);
        assert_eq!(rows.len(), 320, "{name}");
        for (i, row) in rows.iter().enumerate() {
            let miss = (row[1] - reference[16 * i + 15][1]).abs() / size;
            assert!(miss < 0.01, "{name}, step {i}: {miss}");
        }
        let kept = energy::kinetic(model, &state) + energy::strain(model, &state);
        let spent = kept + sum.damping_dissipation + sum.numerical_dissipation;
        let entered = sum.external_work + sum.support_work;
        assert!((spent / entered - 1.0).abs() < 1e-6, "{name}: {spent} {entered}");
    }
}

#[test]
fn the_quasi_static_method_is_in_equilibrium_at_every_step() {
    let model = column(true);
    let mut method = QuasiStatic::new(&model, NewtonOptions::default(), StepControl::fixed(DT)).unwrap();
    // The load stays away from 0, by which the residual is measured.
    let (rows, ..) = course(&mut method, &model, 0.375 * PERIOD);
    for [time, u] in rows {
        // E A u / L, uniaxial: Poisson's ratio is 0. The tolerance is that of the iteration.
        let expected = 1e4 * (std::f64::consts::TAU * time / PERIOD).sin() * LENGTH / SOIL.young;
        assert!((u - expected).abs() < 1e-5 * 1e4 * LENGTH / SOIL.young, "{time}: {u} {expected}");
    }
}

/// A method with one length of step refuses an end between two steps, and leaves the state.
#[test]
fn an_end_between_two_steps_is_refused() {
    let model = column(false);
    let mut method = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, DT).unwrap();
    let mut state = State::new(&model);
    initial_acceleration(&model, &mut state, &vec![0.0; model.dof_count()]).unwrap();
    let before = state.clone();
    let error =
        method.integrate(&model, &mut state, 2.5 * DT, &mut swing(&model), &mut |_, _, _| ()).unwrap_err();
    assert!(matches!(error, SolveError::Option { what: "the end time", .. }), "{error}");
    assert_eq!(state, before);
}

/// The supports of a reduced body stay where they are: a method that would leave them there says so.
#[test]
fn a_reduced_body_does_not_follow_moved_supports() {
    let model = column(false);
    let (mut method, mut state) = (reduced(&model), State::new(&model));
    let before = state.clone();
    let load = |_: f64, _: &mut [f64]| ();
    let mut raised = Driven { load, prescribed: |_: f64, values: &mut [f64]| values.fill(1e-3) };
    let error = method.integrate(&model, &mut state, DT, &mut raised, &mut |_, _, _| ()).unwrap_err();
    assert!(matches!(error, SolveError::Option { expected: "0", .. }), "{error}");
    assert_eq!(state, before);
}
