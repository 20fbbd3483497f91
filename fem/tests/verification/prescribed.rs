//! Prescribed motion: base excitation, rigid translation, momentum balance with reactions.

use crate::common::{Random, difference, fix, model};
use trackbed_fem::boundary::{BoundaryLayer, SpringFactors};
use trackbed_fem::damping::Rayleigh;
use trackbed_fem::element::quadrature::Quadrature::Gauss3;
use trackbed_fem::energy::{self, DofSet};
use trackbed_fem::material::elastic::Elastic;
use trackbed_fem::mesh::{Constraint, Mesh};
use trackbed_fem::model::{Model, ModelInput};
use trackbed_fem::newmark::{
    Newmark, NewmarkSolver, StepLoads, initial_acceleration, initial_acceleration_prescribed,
};
use trackbed_fem::state::State;
use trackbed_fem::statics::StaticSolver;
use trackbed_fem::theta::{ThetaMethod, ThetaSolver};

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };

/// Column, 10 m high, that shears along x on a base with prescribed x motion.
fn shear_column(rayleigh: Rayleigh) -> Model {
    let mesh = Mesh::block([1, 1, 40], [0.5, 0.5, 10.0]);
    let mut constraints = fix(&mesh, &[1, 2], |_| true);
    constraints.extend(fix(&mesh, &[0], |x| x[2] == 0.0));
    Model::new(ModelInput {
        mesh,
        materials: [(1, SOIL.into())].into(),
        quadrature: Gauss3,
        constraints,
        rayleigh,
        ..Default::default()
    })
    .unwrap()
}

/// Prescribed displacements for support motion `x`.
fn along_x(model: &Model, x: f64) -> Vec<f64> {
    model.supports().fixed().iter().map(|&(dof, _)| if dof % 3 == 0 { x } else { 0.0 }).collect()
}

/// `u = U cos k(H - z)/cos kH sin wt`, k = w/c (Kramer, Geotechnical Earthquake Engineering (1996), section
/// 7.2.1, undamped); second order in the step.
#[test]
fn harmonic_base_motion_matches_standing_wave() {
    let model = shear_column(Rayleigh::default());
    let (amplitude, frequency) = (1e-3, 40.0);
    let k = frequency / (SOIL.lame().1 / SOIL.density).sqrt();
    let shape = |z: f64| amplitude * (k * (10.0 - z)).cos() / (k * 10.0).cos();
    let duration = 3.1 * std::f64::consts::TAU / frequency;
    let load = vec![0.0; model.dof_count()];
    let error = |steps: usize, window: bool| {
        let dt = duration / steps as f64;
        let mut state = State::new(&model);
        for (n, x) in model.mesh().coordinates.iter().enumerate() {
            state.v[3 * n] = frequency * shape(x[2]);
        }
        initial_acceleration(&model, &mut state, &load).unwrap();
        let mut newmark = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, dt).unwrap();
        let mut windows = ThetaSolver::new(&model, 0.5, dt).unwrap();
        for n in 1..=steps {
            let motion = along_x(&model, amplitude * (frequency * n as f64 * dt).sin());
            if window {
                windows.step_prescribed(&model, &mut state, &load, Some(&motion)).unwrap();
            } else {
                let drive = StepLoads { load_start: Some(&load), load_end: &load, prescribed: Some(&motion) };
                newmark.advance(&model, &mut state, drive).unwrap();
            }
        }
        let sine = (frequency * duration).sin();
        let off = |(n, x): (usize, &[f64; 3])| (state.u[3 * n] - shape(x[2]) * sine).abs();
        let largest = amplitude / (k * 10.0).cos().abs();
        model.mesh().coordinates.iter().enumerate().map(off).fold(0.0, f64::max) / largest
    };
    for window in [false, true] {
        let errors = [200, 400, 800].map(|n| error(n, window));
        let order = (errors[1] / errors[2]).log2();
        println!(
            "base motion, window {window}: errors {:.1e} {:.1e} {:.1e}, order {order:.3}",
            errors[0], errors[1], errors[2]
        );
        assert!((order - 2.0).abs() < 0.1 && errors[2] < 2e-3, "{errors:?}");
    }
}

#[test]
fn base_motion_matches_relative_motion() {
    let model = shear_column(Rayleigh { alpha_m: 0.0, beta_k: 5e-4 });
    let (dt, n) = (2e-3, model.dof_count());
    let zero = vec![0.0; n];
    let unit: Vec<f64> = (0..n).map(|d| f64::from(u8::from(d % 3 == 0))).collect();
    let mut inertia = vec![0.0; n];
    model.mass_times(&unit, &mut inertia);
    let base = |t: f64| 1e-3 * (1.0 - (25.0 * t).cos());
    for method in [Newmark::AVERAGE_ACCELERATION, Newmark { beta: 0.3025, gamma: 0.6 }] {
        let (mut moved, mut relative) = (State::new(&model), State::new(&model));
        let start = along_x(&model, 1e-3 * 25.0 * 25.0);
        initial_acceleration_prescribed(&model, &mut moved, &zero, Some(&start)).unwrap();
        let load = |a: f64| inertia.iter().map(|i| -i * a).collect::<Vec<_>>();
        initial_acceleration(&model, &mut relative, &load(0.625)).unwrap();
        let mut first = NewmarkSolver::new(&model, method, dt).unwrap();
        let mut second = NewmarkSolver::new(&model, method, dt).unwrap();
        let mut worst = 0.0_f64;
        for step in 1..=300 {
            let x = base(f64::from(step) * dt);
            let motion = along_x(&model, x);
            first
                .advance(
                    &model,
                    &mut moved,
                    StepLoads { load_start: Some(&zero), load_end: &zero, prescribed: Some(&motion) },
                )
                .unwrap();
            // Node 0 is on the base.
            second.step(&model, &mut relative, &load(moved.a[0])).unwrap();
            let seen: Vec<f64> = moved.u.iter().zip(&unit).map(|(u, r)| u - r * x).collect();
            worst = worst.max(difference(&seen, &relative.u));
        }
        println!("relative motion, gamma {}: {worst:.1e}", method.gamma);
        assert!(worst < 1e-9, "{worst:e}");
    }
}

#[test]
fn constant_speed_strains_nothing() {
    let mesh = Mesh::block([2, 2, 3], [1.0, 0.8, 1.5]);
    let constraints = fix(&mesh, &[0, 1, 2], |x| x[2] == 0.0);
    let model = model(mesh, constraints, SOIL, Gauss3);
    let (speed, dt, load) = ([3.0, -2.0, 0.5], 1e-3, vec![0.0; model.dof_count()]);
    for solver in 0..3 {
        let mut state = State::new(&model);
        state.v.chunks_exact_mut(3).for_each(|v| v.copy_from_slice(&speed));
        let mut newmark = match solver {
            0 => NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, dt).unwrap(),
            _ => NewmarkSolver::hht(&model, -0.3, dt).unwrap(),
        };
        let mut window = ThetaSolver::new(&model, 0.7, dt).unwrap();
        let kinetic = energy::kinetic(&model, &state);
        let mut work = 0.0_f64;
        for step in 1..=200 {
            let motion: Vec<f64> = model
                .supports()
                .fixed()
                .iter()
                .map(|&(dof, _)| speed[dof as usize % 3] * f64::from(step) * dt)
                .collect();
            let audit = if solver == 2 {
                window.step_prescribed(&model, &mut state, &load, Some(&motion)).unwrap()
            } else {
                let drive = StepLoads { load_start: Some(&load), load_end: &load, prescribed: Some(&motion) };
                newmark.advance(&model, &mut state, drive).unwrap()
            };
            work = work.max(audit.support_work.abs());
        }
        let travelled = state.u.iter().enumerate().map(|(d, u)| (u - speed[d % 3] * 0.2).abs());
        let (off, strain) = (travelled.fold(0.0, f64::max), energy::strain(&model, &state));
        println!(
            "translation: off {off:.1e} m, strain energy {:.1e}, work {:.1e} of the kinetic",
            strain / kinetic,
            work / kinetic
        );
        assert!(off < 1e-12 && strain < 1e-12 * kinetic && work < 1e-9 * kinetic);
    }
}

#[test]
fn supports_keep_their_last_position() {
    let model = shear_column(Rayleigh { alpha_m: 0.0, beta_k: 5e-2 });
    let load = vec![0.0; model.dof_count()];
    let mut state = State::new(&model);
    let mut solver = NewmarkSolver::new(&model, Newmark { beta: 0.36, gamma: 0.7 }, 5e-3).unwrap();
    for step in 1..=20 {
        let motion = along_x(&model, 1e-4 * f64::from(step));
        let drive = StepLoads { load_start: None, load_end: &load, prescribed: Some(&motion) };
        solver.advance(&model, &mut state, drive).unwrap();
    }
    for _ in 0..4000 {
        solver.step(&model, &mut state, &load).unwrap();
    }
    assert!(state.u.iter().step_by(3).all(|u| (u - 2e-3).abs() < 1e-12), "{:?}", state.u[0]);
}

fn block() -> Model {
    let mesh = Mesh::block([2, 2, 2], [1.0, 0.8, 0.6]);
    let constraints = fix(&mesh, &[0, 2], |x| x[0] == 0.0);
    let faces = |side| mesh.boundary_faces().into_iter().filter(|f| f.side == side).collect();
    let boundaries = vec![
        BoundaryLayer::viscous_spring(faces(0), &SOIL, 2.0, SpringFactors::SPATIAL),
        BoundaryLayer::absorbing(faces(2), &SOIL),
    ];
    let materials = [(1, SOIL.into())].into();
    let rayleigh = Rayleigh { alpha_m: 3.0, beta_k: 1e-4 };
    Model::new(ModelInput {
        mesh,
        materials,
        quadrature: Gauss3,
        constraints,
        boundaries,
        rayleigh,
        ..Default::default()
    })
    .unwrap()
}

#[test]
fn momentum_balances_with_the_reactions() {
    let model = block();
    let (n, dt) = (model.dof_count(), 1e-3);
    let fixed = model.supports().fixed().len();
    let method = Newmark { beta: 0.3025, gamma: 0.6 };
    let mut newmark = NewmarkSolver::new(&model, method, dt).unwrap();
    let mut window = ThetaSolver::new(&model, 0.6, dt).unwrap();
    let outer = |state: &State, forces: &[f64]| -> Vec<f64> {
        let mut inertia = vec![0.0; n];
        model.mass_times(&state.v, &mut inertia);
        let boundary = energy::boundary_forces(&model, state);
        let all: Vec<f64> = (0..n).map(|d| forces[d] + boundary[d] - 3.0 * inertia[d]).collect();
        let sum = energy::resultant(model.mesh(), &all);
        [sum.force, sum.moment].concat()
    };
    let momentum = |state: &State| {
        let (p, l) = energy::momentum(&model, state);
        [p, l].concat()
    };
    for by_window in [false, true] {
        let (mut random, mut state, mut worst, mut size) = (Random(3), State::new(&model), 0.0_f64, 0.0_f64);
        let mut start: Vec<f64> = vec![0.0; n];
        for step in 1..=60 {
            let end: Vec<f64> = (0..n).map(|_| 1e2 * random.next()).collect();
            let t = f64::from(step) * dt;
            let motion: Vec<f64> = (0..fixed).map(|i| 1e-4 * ((70.0 + i as f64) * t).sin().powi(2)).collect();
            let before = state.clone();
            let rate: Vec<f64> = if by_window {
                window.step_prescribed(&model, &mut state, &end, Some(&motion)).unwrap();
                let mut forces = window.mean_reactions(&model, &before, &state, &end);
                forces.iter_mut().zip(&end).for_each(|(f, e)| *f += e);
                let mid = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| 0.4 * a + 0.6 * b).collect();
                let middle =
                    State { u: mid(&before.u, &state.u), v: mid(&before.v, &state.v), ..State::new(&model) };
                outer(&middle, &forces)
            } else {
                let drive = StepLoads { load_start: Some(&start), load_end: &end, prescribed: Some(&motion) };
                newmark.advance(&model, &mut state, drive).unwrap();
                let total = |s: &State, load: &[f64]| {
                    let mut forces = energy::reactions(&model, s, load);
                    forces.iter_mut().zip(load).for_each(|(f, l)| *f += l);
                    outer(s, &forces)
                };
                let (old, new) = (total(&before, &start), total(&state, &end));
                old.iter().zip(new).map(|(o, n)| 0.4 * o + 0.6 * n).collect()
            };
            let change = momentum(&state).into_iter().zip(momentum(&before)).map(|(a, b)| a - b);
            for (change, rate) in change.zip(rate) {
                worst = worst.max((change - dt * rate).abs());
                size = size.max((dt * rate).abs());
            }
            start = end;
        }
        println!("momentum, window {by_window}: off by {:.1e} of {size:.2e} N s", worst / size);
        assert!(worst < 1e-10 * size, "{:e}", worst / size);
    }
}

#[test]
fn sums_of_reactions_carry_the_weight() {
    let mesh = Mesh::block([2, 2, 2], [2.0, 1.0, 1.0]);
    let constraints = fix(&mesh, &[0, 1, 2], |x| x[2] == 0.0);
    let model = Model::new(ModelInput {
        mesh,
        materials: [(1, SOIL.into())].into(),
        quadrature: Gauss3,
        constraints,
        gravity: [0.0, 0.0, -9.81],
        ..Default::default()
    })
    .unwrap();
    let load = model.gravity_load();
    let mut state = State::new(&model);
    state.u = trackbed_fem::statics::solve(&model, &load).unwrap().u;
    let half = |left: bool| DofSet {
        name: if left { "left" } else { "right" }.into(),
        dofs: (0..model.mesh().node_count() as u32)
            .filter(|&n| (model.mesh().coordinates[n as usize][0] < 1.0) == left)
            .flat_map(|n| 3 * n..3 * n + 3)
            .collect(),
    };
    let whole = energy::reaction_sum(&model, &state, &load);
    let parts = energy::reaction_sums(&model, &state, &load, &[half(true), half(false)]);
    let weight = 2.0 * 2000.0 * 9.81;
    assert!((whole.force[2] / weight - 1.0).abs() < 1e-11 && whole.force[0].abs() < 1e-9 * weight);
    // Support moment about the origin: (y W, -x W, 0).
    assert!((whole.moment[0] / (0.5 * weight) - 1.0).abs() < 1e-10, "{whole:?}");
    assert!((whole.moment[1] / -weight - 1.0).abs() < 1e-10, "{whole:?}");
    for k in 0..3 {
        assert!((parts[0].force[k] + parts[1].force[k] - whole.force[k]).abs() < 1e-9 * weight);
        assert!((parts[0].moment[k] + parts[1].moment[k] - whole.moment[k]).abs() < 1e-9 * weight);
    }
}

#[test]
fn static_supports_move_between_solutions() {
    let mesh = Mesh::block([3, 2, 2], [1.5, 1.0, 1.0]);
    let constraints = |value| -> Vec<Constraint> {
        let mut all = fix(&mesh, &[0, 1, 2], |x| x[0] == 0.0);
        let end = fix(&mesh, &[0], |x| x[0] == 1.5);
        all.extend(end.iter().map(|c| Constraint { value, ..*c }));
        all
    };
    let (still, moved) = (
        model(mesh.clone(), constraints(0.0), SOIL, Gauss3),
        model(mesh.clone(), constraints(1e-3), SOIL, Gauss3),
    );
    let load = vec![5.0; still.dof_count()];
    let values: Vec<f64> = moved.supports().fixed().iter().map(|&(_, value)| value).collect();
    let mut solver = StaticSolver::new(&still).unwrap();
    let found = solver.solve_prescribed(&still, &load, Some(&values)).unwrap();
    let exact = trackbed_fem::statics::solve(&moved, &load).unwrap();
    assert!(difference(&found.u, &exact.u) < 1e-13 && difference(&found.reactions, &exact.reactions) < 1e-12);
    assert!(solver.solve_prescribed(&still, &load, Some(&values[1..])).is_err());
}
