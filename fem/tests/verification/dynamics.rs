//! Newmark's method: free vibration, order in time, energy, and the tabled column (E5).

use crate::common::{fix, model, read_mesh, soils, table};
use trackbed_fem::SolveError;
use trackbed_fem::damping::Rayleigh;
use trackbed_fem::element::quadrature::Quadrature::{Gauss2, Gauss3};
use trackbed_fem::energy;
use trackbed_fem::loads;
use trackbed_fem::material::elastic::Elastic;
use trackbed_fem::mesh::{Constraint, Mesh};
use trackbed_fem::model::{Model, ModelInput};
use trackbed_fem::newmark::{Newmark, NewmarkError, NewmarkSolver, initial_acceleration};
use trackbed_fem::state::State;

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };

/// One free dof; returns it and its circular frequency.
fn oscillator() -> (Model, usize, f64) {
    let mesh = Mesh::block([1, 1, 1], [1.0; 3]);
    let dof = 3 * 19 + 1;
    let constraints = (0..60)
        .filter(|&d| d != dof)
        .map(|d| Constraint { node: d as u32 / 3, direction: (d % 3) as u8, value: 0.0 })
        .collect();
    let model = model(mesh, constraints, SOIL, Gauss3);
    let mut unit = vec![0.0; 60];
    unit[dof] = 1.0;
    let (mut k, mut m) = (vec![0.0; 60], vec![0.0; 60]);
    model.stiffness_times(&unit, &mut k);
    model.mass_times(&unit, &mut m);
    (model, dof, (k[dof] / m[dof]).sqrt())
}

/// 100 periods: energy is constant, the period longer by the fraction (w dt)²/12.
#[test]
fn free_vibration_keeps_its_energy() {
    let (model, dof, frequency) = oscillator();
    let step = 0.1; // w dt
    let dt = step / frequency;
    let load = vec![0.0; 60];
    let mut state = State::new(&model);
    state.u[dof] = 1e-3;
    initial_acceleration(&model, &mut state, &load).unwrap();
    assert!((state.a[dof] / (-frequency * frequency * 1e-3) - 1.0).abs() < 1e-12);
    let mut solver = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, dt).unwrap();
    let start = energy::kinetic(&model, &state) + energy::strain(&model, &state);
    let (mut crossings, mut drift) = (Vec::new(), 0.0_f64);
    while crossings.len() < 201 {
        let (time, before) = (state.time, state.u[dof]);
        solver.step(&model, &mut state, &load).unwrap();
        if before * state.u[dof] < 0.0 {
            crossings.push(time + dt * before / (before - state.u[dof]));
        }
        let now = energy::kinetic(&model, &state) + energy::strain(&model, &state);
        drift = drift.max((now / start - 1.0).abs());
    }
    let period = (crossings[200] - crossings[0]) / 100.0;
    let error = period * frequency / std::f64::consts::TAU - 1.0;
    println!("V0.9: energy drift {drift:.1e}, period error {error:.4e}, theory {:.4e}", step * step / 12.0);
    assert!(drift < 1e-10, "{drift:e}");
    assert!((error / (step * step / 12.0) - 1.0).abs() < 0.05, "{error:e}");
}

fn column(rayleigh: Rayleigh) -> Model {
    let mesh = Mesh::block([2, 1, 4], [1.0, 0.5, 2.0]);
    let constraints = fix(&mesh, &[0, 1, 2], |x| x[2] == 0.0);
    let materials = [(1, SOIL.into())].into();
    Model::new(ModelInput {
        mesh,
        materials,
        quadrature: Gauss2,
        constraints,
        rayleigh,
        ..Default::default()
    })
    .unwrap()
}

/// Oblique push on the top, N per face area.
fn push(model: &Model) -> Vec<f64> {
    let mut load = vec![0.0; model.dof_count()];
    for face in model.mesh().boundary_faces().iter().filter(|f| f.side == 5 && f.element >= 6) {
        loads::face_traction(model.mesh(), face, [3e3, 1e3, -10e3], &mut load);
    }
    load
}

fn after_pulse(model: &Model, method: Newmark, steps: usize) -> State {
    let (push, mut load) = (push(model), vec![0.0; model.dof_count()]);
    let dt = 0.08 / steps as f64;
    let mut state = State::new(model);
    let mut solver = NewmarkSolver::new(model, method, dt).unwrap();
    for n in 1..=steps {
        let factor = (std::f64::consts::PI * n as f64 / steps as f64).sin().powi(4);
        load.iter_mut().zip(&push).for_each(|(l, p)| *l = factor * p);
        solver.step(model, &mut state, &load).unwrap();
    }
    state
}

#[test]
fn average_acceleration_converges_at_second_order() {
    let model = column(Rayleigh { alpha_m: 2.0, beta_k: 2e-4 });
    let fine = after_pulse(&model, Newmark::AVERAGE_ACCELERATION, 16 * 1280);
    let error = |steps| {
        let state = after_pulse(&model, Newmark::AVERAGE_ACCELERATION, steps);
        let square = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        (square(&state.u, &fine.u), square(&state.v, &fine.v))
    };
    let errors = [320, 640, 1280].map(error);
    for pair in errors.windows(2) {
        let (u, v) = ((pair[0].0 / pair[1].0).log2(), (pair[0].1 / pair[1].1).log2());
        println!("Newmark in time: order {u:.3} in u, {v:.3} in v");
        assert!((1.95..2.05).contains(&u) && (1.9..2.1).contains(&v), "{u} {v}");
    }
}

#[test]
fn every_step_balances_energy() {
    let model = column(Rayleigh { alpha_m: 2.0, beta_k: 2e-4 });
    for (method, conserves) in
        [(Newmark::AVERAGE_ACCELERATION, true), (Newmark { beta: 0.3025, gamma: 0.6 }, false)]
    {
        let load = push(&model);
        let mut state = State::new(&model);
        initial_acceleration(&model, &mut state, &load).unwrap();
        let mut solver = NewmarkSolver::new(&model, method, 2e-3).unwrap();
        let total = |s: &State| energy::kinetic(&model, s) + energy::strain(&model, s);
        let (mut work, mut damped, mut lost, mut exact_work) = (0.0, 0.0, 0.0, 0.0);
        for _ in 0..200 {
            let before = state.u.clone();
            let audit = solver.step(&model, &mut state, &load).unwrap();
            work += audit.external_work;
            damped += audit.damping_dissipation;
            lost += audit.numerical_dissipation;
            exact_work += (0..load.len()).map(|d| load[d] * (state.u[d] - before[d])).sum::<f64>();
        }
        let end = total(&state);
        assert!((work - exact_work).abs() < 1e-10 * work, "the load is constant: {work} {exact_work}");
        assert!((work - damped - lost - end).abs() < 1e-12 * work, "balance");
        assert!(damped > 0.1 * work);
        if conserves {
            assert!(lost.abs() < 1e-11 * work, "{lost} of {work}");
        } else {
            assert!(lost > 1e-4 * work, "{lost} of {work}");
        }
    }
}

#[test]
fn equilibrium_under_gravity_persists() {
    let mesh = Mesh::block([2, 2, 2], [1.0; 3]);
    let mut constraints = fix(&mesh, &[0, 1, 2], |x| x[2] == 0.0);
    constraints.iter_mut().filter(|c| c.direction == 2).for_each(|c| c.value = -1e-3);
    let model = Model::new(ModelInput {
        mesh,
        materials: [(1, SOIL.into())].into(),
        quadrature: Gauss2,
        constraints,
        gravity: [0.0, 0.0, -9.81],
        rayleigh: Rayleigh { alpha_m: 1.0, beta_k: 1e-4 },
        ..Default::default()
    })
    .unwrap();
    let load = model.gravity_load();
    let mut state = State::new(&model);
    assert_eq!(state.u[2], -1e-3);
    state.u = trackbed_fem::statics::solve(&model, &load).unwrap().u;
    let start = state.u.clone();
    initial_acceleration(&model, &mut state, &load).unwrap();
    let mut solver = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, 1e-3).unwrap();
    for _ in 0..100 {
        solver.step(&model, &mut state, &load).unwrap();
    }
    assert!(state.u.iter().zip(&start).all(|(u, s)| (u - s).abs() < 1e-12));
    let carried: f64 = energy::reactions(&model, &state, &load).iter().skip(2).step_by(3).sum();
    assert!((carried / (2000.0 * 9.81) - 1.0).abs() < 1e-9, "{carried}");
}

#[test]
fn rejects_unstable_parameters_and_bad_steps() {
    let (model, ..) = oscillator();
    for (beta, gamma) in [(0.25, 0.6), (0.2, 0.5), (0.25, 0.4)] {
        let error = NewmarkSolver::new(&model, Newmark { beta, gamma }, 1e-3).err().unwrap();
        assert!(matches!(error, SolveError::Newmark(NewmarkError::Unstable { .. })), "{error}");
        assert!(NewmarkSolver::conditionally_stable(&model, Newmark { beta, gamma }, 1e-6).is_ok());
    }
    assert!(Newmark { beta: 0.3025, gamma: 0.6 }.check().is_ok());
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, dt).err().unwrap();
        assert!(matches!(error, SolveError::TimeStep { .. }), "{error}");
    }
}

#[test]
fn invalid_load_leaves_state_untouched() {
    let model = column(Rayleigh::default());
    let mut state = State::new(&model);
    let mut solver = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, 1e-3).unwrap();
    let mut load = push(&model);
    solver.step(&model, &mut state, &load).unwrap();
    let before = state.clone();
    load[5] = f64::NAN;
    let error = solver.step(&model, &mut state, &load).unwrap_err();
    assert!(matches!(error, SolveError::NotFinite { node: 2, direction: "z", .. }), "{error}");
    assert_eq!(state, before);
}

#[test]
fn extreme_steps_stay_bounded() {
    let (model, dof, frequency) = oscillator();
    for step in [1e-9, 1e-3, 1e3] {
        let dt = step * std::f64::consts::TAU / frequency;
        let mut state = State::new(&model);
        state.u[dof] = 1e-3;
        let load = vec![0.0; 60];
        initial_acceleration(&model, &mut state, &load).unwrap();
        let mut solver = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, dt).unwrap();
        for _ in 0..1000 {
            solver.step(&model, &mut state, &load).unwrap();
        }
        let now = energy::kinetic(&model, &state) + energy::strain(&model, &state);
        let mut rest = State::new(&model);
        rest.u[dof] = 1e-3;
        let start = energy::strain(&model, &rest);
        assert!((now / start - 1.0).abs() < 1e-6, "{step}: {now} {start}");
    }
}

#[test]
fn layered_column_follows_the_tabled_history() {
    let (mesh, constraints) = read_mesh("E5_column_pulse");
    let model = Model::new(ModelInput {
        mesh,
        materials: soils(),
        quadrature: Gauss3,
        constraints,
        gravity: [0.0; 3],
        rayleigh: Rayleigh { alpha_m: 4.1887902047863905, beta_k: 0.0003315727981081153 },
        ..Default::default()
    })
    .unwrap();
    let mut full = vec![0.0; model.dof_count()];
    loads::face_pressure(model.mesh(), &model.mesh().face(28, 5), 100e3, &mut full);
    let (dt, duration) = (0.0005, 0.02);
    let mut solver = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, dt).unwrap();
    let mut state = State::new(&model);
    let mut load = vec![0.0; model.dof_count()];
    initial_acceleration(&model, &mut state, &load).unwrap();

    let nodes = [241, 251, 261, 146, 71].map(|id| 3 * (id - 1));
    let rows = table("E5_column_pulse", "reference_history.csv");
    assert_eq!(rows.len(), 401);
    let mut found = vec![vec![0.0; 36]; 401];
    for (n, row) in found.iter_mut().enumerate() {
        if n > 0 {
            let t = n as f64 * dt;
            let f = if t <= duration { (std::f64::consts::PI * t / duration).sin().powi(2) } else { 0.0 };
            load.iter_mut().zip(&full).for_each(|(l, p)| *l = f * p);
            solver.step(&model, &mut state, &load).unwrap();
        }
        for (i, &d) in nodes.iter().enumerate() {
            row[1 + 7 * i..4 + 7 * i].copy_from_slice(&state.u[d..d + 3]);
            row[4 + 7 * i..7 + 7 * i].copy_from_slice(&state.v[d..d + 3]);
            row[7 + 7 * i] = state.a[d + 2];
        }
    }
    let size = |c: usize| rows.iter().fold(0.0, |m: f64, r| m.max(r[c].abs()));
    for (kind, offsets, tolerance) in [("u", 1..4, 1e-6), ("v", 4..7, 1e-5), ("a", 7..8, 1e-5)] {
        let columns: Vec<usize> = (0..5).flat_map(|i| offsets.clone().map(move |o| 7 * i + o)).collect();
        let largest = columns.iter().fold(0.0, |m: f64, &c| m.max(size(c)));
        let mut worst: f64 = 0.0;
        for c in columns.into_iter().filter(|&c| size(c) > 1e-3 * largest) {
            let miss = (0..401).fold(0.0, |m: f64, n| m.max((found[n][c] - rows[n][c]).abs()));
            worst = worst.max(miss / size(c));
        }
        println!("E5 {kind}: largest difference {worst:.1e}");
        assert!(worst <= tolerance, "{kind}: {worst:e}");
    }
    for row in table("E5_column_pulse", "reference_displacement_final.csv") {
        for k in 0..3 {
            assert!((state.u[3 * (row[0] as usize - 1) + k] - row[1 + k]).abs() < 1e-6 * size(3));
        }
    }
}
