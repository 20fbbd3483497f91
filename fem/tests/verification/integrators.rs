//! All time integrators through one trait: column under a harmonic load.
//!
//! Tolerance 1 %: second order, 160 steps per load period.

use std::sync::Arc;
use trackbed_fem::newmark::{Newmark, NewmarkSolver, initial_acceleration};
use trackbed_fem::nonlinear::{
    LoadFunctions, NewtonOptions, NonlinearNewmark, QuasiStatic, StepControl, Variant,
};
use trackbed_fem::reduction::{ReducedModel, Reduction};
use trackbed_fem::theta::{NonlinearTheta, ReducedTheta, ThetaSolver};
use trackbed_fem::{
    Constraint, DruckerPrager, Elastic, Material, Mesh, Model, ModelInput, Quadrature, Rayleigh, SolveError,
    State, StepAudit, TimeIntegrator, energy, loads,
};

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.0, density: 2000.0 };
const LENGTH: f64 = 4.0;
const PERIOD: f64 = 0.4;
const DT: f64 = PERIOD / 160.0;

/// Column on a fixed foot; `plastic` adds a strength that is never reached.
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

/// θ-method in the span of the slowest modes.
fn reduced(model: &Model) -> ReducedTheta {
    let (mesh, modes) = (model.mesh(), Reduction::Modes { modes: 12 });
    let faces = mesh.boundary_faces();
    let top: Vec<_> = faces.into_iter().filter(|f| f.centre(mesh)[2] == LENGTH).collect();
    let shapes = Arc::new(ReducedModel::new(model, &top, &top, modes).unwrap());
    ReducedTheta::new(model, shapes, 0.5, DT, &vec![0.0; model.dof_count()]).unwrap()
}

/// Top deflection per step, final state, and summed energy balance.
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
fn dynamic_methods_agree_and_conserve_energy() {
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
            Box::new(NonlinearNewmark::newmark(&plastic, average, options, control).unwrap()),
        ),
        (
            "plastic HHT",
            &plastic,
            Box::new(NonlinearNewmark::hht(&plastic, -0.05, options, control).unwrap()),
        ),
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
fn quasi_static_steps_are_in_equilibrium() {
    let model = column(true);
    let mut method = QuasiStatic::new(&model, NewtonOptions::default(), StepControl::fixed(DT)).unwrap();
    // The residual is relative to the load, which must not vanish.
    let (rows, ..) = course(&mut method, &model, 0.375 * PERIOD);
    for [time, u] in rows {
        // E A u / L, uniaxial, since Poisson's ratio is 0.
        let expected = 1e4 * (std::f64::consts::TAU * time / PERIOD).sin() * LENGTH / SOIL.young;
        assert!((u - expected).abs() < 1e-5 * 1e4 * LENGTH / SOIL.young, "{time}: {u} {expected}");
    }
}

#[test]
fn rejects_end_between_two_steps() {
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

#[test]
fn reduced_model_rejects_moved_supports() {
    let model = column(false);
    let (mut method, mut state) = (reduced(&model), State::new(&model));
    let before = state.clone();
    let load = |_: f64, _: &mut [f64]| ();
    let mut raised = LoadFunctions { load, prescribed: |_: f64, values: &mut [f64]| values.fill(1e-3) };
    let error = method.integrate(&model, &mut state, DT, &mut raised, &mut |_, _, _| ()).unwrap_err();
    assert!(matches!(error, SolveError::Option { expected: "0", .. }), "{error}");
    assert_eq!(state, before);
}
