//! HHT-α and Newmark on one mode.

use crate::common::{fix, model};
use nalgebra::Matrix3;
use trackbed_fem::SolveError;
use trackbed_fem::element::quadrature::Quadrature::{Gauss2, Gauss3};
use trackbed_fem::loads;
use trackbed_fem::material::elastic::Elastic;
use trackbed_fem::mesh::Mesh;
use trackbed_fem::model::Model;
use trackbed_fem::newmark::{Newmark, NewmarkError, NewmarkSolver, StepLoads, initial_acceleration};
use trackbed_fem::state::State;

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };

/// One free dof; returns it and its circular frequency.
fn oscillator() -> (Model, usize, f64) {
    let mesh = Mesh::block([1, 1, 1], [1.0; 3]);
    let dof = 3 * 19 + 1;
    let mut constraints = fix(&mesh, &[0, 1, 2], |_| true);
    constraints.retain(|c| 3 * c.node as usize + c.direction as usize != dof);
    let model = model(mesh, constraints, SOIL, Gauss3);
    let mut unit = vec![0.0; 60];
    unit[dof] = 1.0;
    let (mut k, mut m) = (vec![0.0; 60], vec![0.0; 60]);
    model.stiffness_times(&unit, &mut k);
    model.mass_times(&unit, &mut m);
    (model, dof, (k[dof] / m[dof]).sqrt())
}

/// Amplification matrix of (u, dt v, dt² a), undamped, `step` = w dt (Hughes 1987, section 9.3). `hht` = 0:
/// Newmark.
fn amplification(method: Newmark, hht: f64, step: f64) -> Matrix3<f64> {
    let (beta, gamma, s) = (method.beta, method.gamma, step * step);
    let left = Matrix3::new(1.0, 0.0, -beta, 0.0, 1.0, -gamma, s * (1.0 + hht), 0.0, 1.0);
    let right = Matrix3::new(1.0, 1.0, 0.5 - beta, 0.0, 1.0, 1.0 - gamma, s * hht, 0.0, 0.0);
    left.try_inverse().unwrap() * right
}

/// Modulus and angle per step of the principal eigenvalues.
fn principal(matrix: &Matrix3<f64>) -> (f64, f64) {
    let pair = matrix.complex_eigenvalues().iter().copied().max_by(|a, b| a.im.total_cmp(&b.im)).unwrap();
    (pair.norm(), pair.im.atan2(pair.re))
}

fn shown(solver: &mut NewmarkSolver, model: &Model, dof: usize) -> (f64, f64) {
    let load = vec![0.0; 60];
    let mut state = State::new(model);
    state.u[dof] = 1e-3;
    initial_acceleration(model, &mut state, &load).unwrap();
    let drive = StepLoads { load_start: Some(&load), load_end: &load, prescribed: None };
    let mut u = [0.0; 4];
    for n in 0..64 {
        solver.advance(model, &mut state, drive).unwrap();
        if n >= 60 {
            u[n - 60] = state.u[dof];
        }
    }
    let scale = u[0] * u[2] - u[1] * u[1];
    let trace = (u[0] * u[3] - u[1] * u[2]) / scale;
    let determinant = (u[1] * u[3] - u[2] * u[2]) / scale;
    (determinant.sqrt(), (0.5 * trace / determinant.sqrt()).acos())
}

#[test]
fn decay_and_period_match_theory() {
    let (model, dof, frequency) = oscillator();
    for step in [0.1, 0.5, 1.5] {
        let dt = step / frequency;
        for (beta, gamma) in [(0.25, 0.5), (0.3025, 0.6), (0.36, 0.7)] {
            let method = Newmark { beta, gamma };
            let mut solver = NewmarkSolver::new(&model, method, dt).unwrap();
            let (modulus, angle) = shown(&mut solver, &model, dof);
            // Hughes 1987, section 9.1.
            let bottom = 1.0 + beta * step * step;
            let half_trace = 1.0 - 0.5 * step * step * (gamma + 0.5) / bottom;
            let determinant: f64 = 1.0 - step * step * (gamma - 0.5) / bottom;
            let exact = (determinant.sqrt(), (half_trace / determinant.sqrt()).acos());
            println!(
                "Newmark {beta} {gamma}, w dt {step}: decay per step {:.3e}, period error {:+.4e}; off by {:.0e}, {:.0e}",
                1.0 - modulus,
                step / angle - 1.0,
                (modulus - exact.0).abs(),
                (angle - exact.1).abs()
            );
            assert!((modulus - exact.0).abs() < 1e-9 && (angle - exact.1).abs() < 1e-9);
            let by_matrix = principal(&amplification(method, 0.0, step));
            assert!((by_matrix.0 - exact.0).abs() < 1e-12 && (by_matrix.1 - exact.1).abs() < 1e-12);
        }
        for hht in [0.0, -0.05, -0.2, -1.0 / 3.0] {
            let mut solver = NewmarkSolver::hht(&model, hht, dt).unwrap();
            let (modulus, angle) = shown(&mut solver, &model, dof);
            let exact = principal(&amplification(Newmark::of_hht(hht), hht, step));
            println!(
                "HHT {hht:.3}, w dt {step}: decay per step {:.3e}, period error {:+.4e}; off by {:.0e}, {:.0e}",
                1.0 - modulus,
                step / angle - 1.0,
                (modulus - exact.0).abs(),
                (angle - exact.1).abs()
            );
            assert!((modulus - exact.0).abs() < 1e-8 && (angle - exact.1).abs() < 1e-8);
            assert!(hht == 0.0 || modulus < 1.0);
        }
    }
    for hht in [-0.1, -0.2, -1.0 / 3.0] {
        let matrix = amplification(Newmark::of_hht(hht), hht, 1e4);
        let radius = matrix.complex_eigenvalues().iter().map(|l| l.norm()).fold(0.0, f64::max);
        assert!((radius - (1.0 + hht) / (1.0 - hht)).abs() < 1e-2, "{radius}");
    }
}

fn after_pulse(model: &Model, mut solver: NewmarkSolver, steps: usize) -> State {
    let mut push = vec![0.0; model.dof_count()];
    for face in model.mesh().boundary_faces().iter().filter(|f| f.side == 5 && f.element >= 6) {
        loads::face_traction(model.mesh(), face, [3e3, 1e3, -10e3], &mut push);
    }
    let at = |n: usize| -> Vec<f64> {
        let factor = (std::f64::consts::PI * n as f64 / steps as f64).sin().powi(4);
        push.iter().map(|p| factor * p).collect()
    };
    let (mut state, mut start) = (State::new(model), at(0));
    for n in 1..=steps {
        let end = at(n);
        let drive = StepLoads { load_start: Some(&start), load_end: &end, prescribed: None };
        solver.advance(model, &mut state, drive).unwrap();
        start = end;
    }
    state
}

/// Hilber, Hughes and Taylor (1977): second order for every α.
#[test]
fn hht_converges_at_second_order() {
    let mesh = Mesh::block([2, 1, 4], [1.0, 0.5, 2.0]);
    let constraints = fix(&mesh, &[0, 1, 2], |x| x[2] == 0.0);
    let column = model(mesh, constraints, SOIL, Gauss2);
    let dt = |steps: usize| 0.08 / steps as f64;
    let fine = NewmarkSolver::new(&column, Newmark::AVERAGE_ACCELERATION, dt(10240)).unwrap();
    let fine = after_pulse(&column, fine, 10240);
    let error = |solver: NewmarkSolver, steps: usize| {
        let state = after_pulse(&column, solver, steps);
        state.u.iter().zip(&fine.u).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    for hht in [-0.1, -1.0 / 3.0] {
        let [a, b] = [320, 640].map(|n| error(NewmarkSolver::hht(&column, hht, dt(n)).unwrap(), n));
        println!("HHT {hht:.3}: order {:.3}", (a / b).log2());
        assert!(((a / b).log2() - 2.0).abs() < 0.1, "{hht}: {}", (a / b).log2());
    }
    let damped = Newmark { beta: 0.3025, gamma: 0.6 };
    let [a, b] = [320, 640].map(|n| error(NewmarkSolver::new(&column, damped, dt(n)).unwrap(), n));
    println!("Newmark with gamma 0.6: order {:.3}", (a / b).log2());
    assert!(((a / b).log2() - 1.0).abs() < 0.1);
}

#[test]
fn rejects_invalid_parameters_and_missing_loads() {
    let (model, ..) = oscillator();
    for hht in [-0.34, 0.01, f64::NAN] {
        let error = NewmarkSolver::hht(&model, hht, 1e-3).err().unwrap();
        assert!(matches!(error, SolveError::Newmark(NewmarkError::Hht { .. })), "{error}");
    }
    let mut solver = NewmarkSolver::hht(&model, -0.1, 1e-3).unwrap();
    assert!((solver.method().beta - 0.3025).abs() < 1e-15 && solver.hht_alpha() == -0.1);
    assert_eq!((solver.method().gamma, solver.dt()), (0.6, 1e-3));
    let (mut state, load) = (State::new(&model), vec![0.0; 60]);
    let error = solver.step(&model, &mut state, &load).unwrap_err();
    assert_eq!(error, SolveError::Newmark(NewmarkError::LoadAtStart));
    let explicit = Newmark { beta: 0.0, gamma: 0.5 };
    let mut solver = NewmarkSolver::conditionally_stable(&model, explicit, 1e-6).unwrap();
    assert!(solver.step(&model, &mut state, &load).is_ok());
    let motion = vec![0.0; 59];
    let drive = StepLoads { load_start: None, load_end: &load, prescribed: Some(&motion) };
    let error = solver.advance(&model, &mut state, drive).unwrap_err();
    assert_eq!(error, SolveError::Newmark(NewmarkError::Prescribed));
    let mut solver = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, 1e-3).unwrap();
    let drive = StepLoads { load_start: None, load_end: &load, prescribed: Some(&motion[1..]) };
    let error = solver.advance(&model, &mut state, drive).unwrap_err();
    assert!(matches!(error, SolveError::Length { found: 58, expected: 59, .. }), "{error}");
    let motion = vec![f64::NAN; 59];
    let drive = StepLoads { prescribed: Some(&motion), ..drive };
    assert!(matches!(solver.advance(&model, &mut state, drive), Err(SolveError::NotFinite { .. })));
}
