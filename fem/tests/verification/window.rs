//! Window step of the coupling: equivalence to Newmark, energy, momentum, order.

use crate::common::{Random, difference, fix, model};
use trackbed_fem::SolveError;
use trackbed_fem::damping::Rayleigh;
use trackbed_fem::element::quadrature::Quadrature::{Gauss2, Gauss3};
use trackbed_fem::energy;
use trackbed_fem::material::elastic::Elastic;
use trackbed_fem::mesh::Mesh;
use trackbed_fem::model::{Model, ModelInput};
use trackbed_fem::newmark::{Newmark, NewmarkSolver, initial_acceleration};
use trackbed_fem::state::State;
use trackbed_fem::theta::{ThetaMethod, ThetaSolver};

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };

fn block(rayleigh: Rayleigh) -> Model {
    let mesh = Mesh::block([2, 2, 2], [1.0, 0.8, 0.6]);
    let constraints = fix(&mesh, &[0, 1, 2], |x| x[2] == 0.0);
    let materials = [(1, SOIL.into())].into();
    Model::new(ModelInput {
        mesh,
        materials,
        quadrature: Gauss3,
        constraints,
        rayleigh,
        ..Default::default()
    })
    .unwrap()
}

fn random_load(random: &mut Random, model: &Model) -> Vec<f64> {
    (0..model.dof_count()).map(|_| 1e3 * random.next()).collect()
}

#[test]
fn theta_one_half_equals_average_acceleration() {
    let model = block(Rayleigh { alpha_m: 3.0, beta_k: 1e-4 });
    let load = random_load(&mut Random(3), &model);
    let dt = 1e-3;
    let (mut a, mut b) = (State::new(&model), State::new(&model));
    initial_acceleration(&model, &mut a, &load).unwrap();
    let mut newmark = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, dt).unwrap();
    let mut window = ThetaSolver::new(&model, 0.5, dt).unwrap();
    for _ in 0..50 {
        newmark.step(&model, &mut a, &load).unwrap();
        window.step(&model, &mut b, &load).unwrap();
        assert!(difference(&b.u, &a.u) < 1e-11 && difference(&b.v, &a.v) < 1e-10);
    }
    assert_eq!(a.time, b.time);
}

#[test]
fn energy_balances_for_every_theta() {
    let model = block(Rayleigh { alpha_m: 3.0, beta_k: 1e-4 });
    let total = |s: &State| energy::kinetic(&model, s) + energy::strain(&model, s);
    for theta in [0.5, 0.55, 0.7, 1.0] {
        let mut random = Random(11);
        let mut state = State::new(&model);
        let mut solver = ThetaSolver::new(&model, theta, 2e-3).unwrap();
        for _ in 0..30 {
            let load = random_load(&mut random, &model);
            let before = total(&state);
            let audit = solver.step(&model, &mut state, &load).unwrap();
            let lost = audit.damping_dissipation + audit.numerical_dissipation;
            let miss = audit.external_work - (total(&state) - before) - lost;
            let size = audit.external_work.abs() + total(&state) + before;
            assert!(miss.abs() < 1e-13 * size, "theta {theta}: {miss:e} of {size:e}");
            assert!(audit.damping_dissipation > 0.0);
            assert_eq!(audit.numerical_dissipation > 0.0, theta > 0.5);
        }
    }
}

#[test]
fn free_vibration_without_damping_conserves_energy() {
    let model = block(Rayleigh::default());
    let load = random_load(&mut Random(5), &model);
    let mut state = State::new(&model);
    state.u = trackbed_fem::statics::solve(&model, &load).unwrap().u;
    let rest = vec![0.0; model.dof_count()];
    let mut solver = ThetaSolver::new(&model, 0.5, 1e-3).unwrap();
    let start = energy::strain(&model, &state);
    for _ in 0..2000 {
        solver.step(&model, &mut state, &rest).unwrap();
    }
    let end = energy::kinetic(&model, &state) + energy::strain(&model, &state);
    assert!((end / start - 1.0).abs() < 1e-11, "{}", end / start - 1.0);
}

#[test]
fn free_body_conserves_impulse() {
    let model = model(Mesh::block([3, 2, 1], [1.5, 1.0, 0.4]), Vec::new(), SOIL, Gauss2);
    let (mut state, mut random) = (State::new(&model), Random(9));
    let dt = 5e-4;
    let mut solver = ThetaSolver::new(&model, 0.6, dt).unwrap();
    let (mut linear, mut angular, mut size) = ([0.0; 3], [0.0; 3], 0.0);
    for _ in 0..200 {
        let load = random_load(&mut random, &model);
        for (x, f) in model.mesh().coordinates.iter().zip(load.chunks_exact(3)) {
            for k in 0..3 {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                linear[k] += dt * f[k];
                angular[k] += dt * (x[i] * f[j] - x[j] * f[i]);
                size += dt * f[k].abs();
            }
        }
        solver.step(&model, &mut state, &load).unwrap();
    }
    let (p, l) = energy::momentum(&model, &state);
    for k in 0..3 {
        assert!((p[k] - linear[k]).abs() < 1e-12 * size, "{p:?} {linear:?}");
        assert!((l[k] - angular[k]).abs() < 1e-12 * size, "{l:?} {angular:?}");
    }
}

#[test]
fn theta_method_converges_at_expected_order() {
    let model = block(Rayleigh { alpha_m: 1.0, beta_k: 1e-4 });
    let shape = random_load(&mut Random(2), &model);
    let duration = 0.05;
    let run = |theta: f64, steps: usize| {
        let dt = duration / steps as f64;
        let mut solver = ThetaSolver::new(&model, theta, dt).unwrap();
        let mut state = State::new(&model);
        for n in 0..steps {
            // Exact mean of sin² over the window.
            let w = std::f64::consts::TAU / duration;
            let (t0, t1) = (n as f64 * dt, (n + 1) as f64 * dt);
            let mean = 0.5 - ((w * t1).sin() - (w * t0).sin()) / (2.0 * w * dt);
            let load: Vec<f64> = shape.iter().map(|f| f * mean).collect();
            solver.step(&model, &mut state, &load).unwrap();
        }
        state.u
    };
    let fine = run(0.5, 40960);
    for (theta, order) in [(0.5, 2.0), (1.0, 1.0)] {
        let error = |steps| -> f64 {
            run(theta, steps).iter().zip(&fine).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
        };
        let found = (error(1280) / error(2560)).log2();
        println!("window theta {theta}: order {found:.3}");
        assert!((found - order).abs() < 0.1, "theta {theta}: {found}");
    }
}

#[test]
fn theta_out_of_range_is_refused() {
    let model = block(Rayleigh::default());
    for theta in [0.49, 1.01, f64::NAN] {
        assert!(matches!(ThetaSolver::new(&model, theta, 1e-3), Err(SolveError::Theta { .. })));
    }
}
