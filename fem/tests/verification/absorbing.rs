//! Boundary springs and dashpots: reflection, elastic supports, energy balance.

use crate::common::{Random, fix};
use trackbed_fem::boundary::{BoundaryLayer, SpringFactors};
use trackbed_fem::damping::Rayleigh;
use trackbed_fem::element::quadrature::Quadrature::Gauss3;
use trackbed_fem::material::elastic::Elastic;
use trackbed_fem::mesh::{Face, Mesh};
use trackbed_fem::model::{Model, ModelInput};
use trackbed_fem::newmark::{Newmark, NewmarkSolver, StepLoads, initial_acceleration};
use trackbed_fem::state::State;
use trackbed_fem::theta::{ThetaMethod, ThetaSolver};
use trackbed_fem::{Mass, energy, loads, statics};

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };

fn side(mesh: &Mesh, side: u8) -> Vec<Face> {
    mesh.boundary_faces().into_iter().filter(|f| f.side == side).collect()
}

/// Energy reflected at the base of a column, as a fraction. `direction` 2: P wave, 0: S wave.
fn reflected(direction: u8, absorbing: bool, mass: Mass) -> f64 {
    let (count, length, width) = (80, 40.0, 0.1);
    let mesh = Mesh::block([1, 1, count], [width, width, length]);
    let others: Vec<u8> = (0..3).filter(|k| *k != direction).collect();
    let mut constraints = fix(&mesh, &others, |_| true);
    let mut boundaries = Vec::new();
    if absorbing {
        boundaries.push(BoundaryLayer::absorbing(side(&mesh, 0), &SOIL));
    } else {
        constraints.extend(fix(&mesh, &[direction], |x| x[2] == 0.0));
    }
    let materials = [(1, SOIL.into())].into();
    let input = ModelInput {
        mesh,
        materials,
        quadrature: Gauss3,
        constraints,
        boundaries,
        mass,
        ..Default::default()
    };
    let model = Model::new(input).unwrap();
    let c = match direction {
        2 => SOIL.compression_wave_speed(),
        _ => (SOIL.lame().1 / SOIL.density).sqrt(),
    };
    // Pulse cos⁴, 12 m long, travelling down: u = f(z + c t), v = c f'(z).
    let (half, centre) = (6.0, 20.0);
    let mut state = State::new(&model);
    for (n, x) in model.mesh().coordinates.iter().enumerate() {
        let s = std::f64::consts::FRAC_PI_2 * (x[2] - centre) / half;
        if s.abs() < std::f64::consts::FRAC_PI_2 {
            let d = 3 * n + direction as usize;
            state.u[d] = 1e-3 * s.cos().powi(4);
            state.v[d] = -1e-3 * c * 4.0 * s.cos().powi(3) * s.sin() * std::f64::consts::FRAC_PI_2 / half;
        }
    }
    let load = vec![0.0; model.dof_count()];
    initial_acceleration(&model, &mut state, &load).unwrap();
    let total = |s: &State| energy::kinetic(&model, s) + energy::strain(&model, s);
    let start = total(&state);
    // Until a reflection would be half way up.
    let (time, steps) = ((centre + half + 4.0) / c, 600);
    let mut solver = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, time / steps as f64).unwrap();
    let mut absorbed = 0.0;
    for _ in 0..steps {
        absorbed += solver.step(&model, &mut state, &load).unwrap().boundary_dissipation;
    }
    let end = total(&state);
    assert!(((absorbed + end) / start - 1.0).abs() < 1e-10, "{absorbed} {end} {start}");
    end / start
}

/// Lysmer and Kuhlemeyer (1969): no reflection at normal incidence; limit 1 % of the energy.
#[test]
fn plane_waves_leave_absorbing_base() {
    for (name, direction) in [("P", 2), ("S", 0)] {
        for mass in [Mass::Consistent, Mass::Lumped] {
            let (absorbing, fixed) = (reflected(direction, true, mass), reflected(direction, false, mass));
            println!(
                "{name} wave, {mass:?} mass: absorbing base reflects {:.1e} %, fixed base {:.4} %",
                100.0 * absorbing,
                100.0 * fixed
            );
            assert!(absorbing < if mass == Mass::Consistent { 1e-7 } else { 5e-3 }, "{name}: {absorbing:e}");
            assert!((fixed - 1.0).abs() < 1e-9, "{name}: {fixed}");
        }
    }
}

/// Exact: settlement `p/k + p L/(lambda + 2 mu)`, lateral `t/k_t + t L/mu`.
#[test]
fn column_on_springs_matches_closed_form() {
    let mesh = Mesh::block([2, 1, 4], [1.0, 0.5, 2.0]);
    let (lambda, mu) = SOIL.lame();
    let (normal, tangential) = (8e6, 3e6);
    for (direction, traction, stiffness, spring) in
        [(2, -10e3, lambda + 2.0 * mu, normal), (0, 4e3, mu, tangential)]
    {
        let others: Vec<u8> = (0..3).filter(|k| usize::from(*k) != direction).collect();
        let constraints = fix(&mesh, &others, |_| true);
        let boundaries = vec![BoundaryLayer::springs(side(&mesh, 0), normal, tangential)];
        let materials = [(1, SOIL.into())].into();
        let model = Model::new(ModelInput {
            mesh: mesh.clone(),
            materials,
            quadrature: Gauss3,
            constraints,
            boundaries,
            ..Default::default()
        })
        .unwrap();
        let mut load = vec![0.0; model.dof_count()];
        let mut t = [0.0; 3];
        t[direction] = traction;
        for face in side(model.mesh(), 5) {
            loads::face_traction(model.mesh(), &face, t, &mut load);
        }
        let solution = statics::solve(&model, &load).unwrap();
        let top = 3 * (model.mesh().node_count() - 1) + direction;
        let (base, top) = (solution.u[direction], solution.u[top]);
        let exact = (traction / spring, traction / spring + traction * 2.0 / stiffness);
        println!("on springs: {:+.1e} {:+.1e}", base / exact.0 - 1.0, top / exact.1 - 1.0);
        assert!((base / exact.0 - 1.0).abs() < 1e-11 && (top / exact.1 - 1.0).abs() < 1e-11);
        let mut state = State::new(&model);
        state.u = solution.u;
        let pushed = energy::boundary_forces(&model, &state).iter().skip(direction).step_by(3).sum::<f64>();
        assert!((pushed + traction * 0.5).abs() < 1e-9 * traction.abs());
        let stored = energy::boundary_springs(&model, &state);
        assert!((stored / (0.5 * traction * base * 0.5) - 1.0).abs() < 1e-11);
    }
}

/// Pressurised hole in an infinite medium, plane strain: `u(a) = p a/(2 G)` (Timoshenko and Goodier,
/// section 28).
#[test]
fn viscous_springs_represent_infinite_medium() {
    let (inner, outer, pressure) = (1.0, 3.0, 50e3);
    let shear = SOIL.lame().1;
    let found = |springs: Option<SpringFactors>| {
        let mut mesh = Mesh::block([8, 6, 1], [1.0, 1.0, 0.3]);
        for x in &mut mesh.coordinates {
            let (r, angle) = (inner + (outer - inner) * x[0], x[1] * std::f64::consts::FRAC_PI_2);
            *x = [r * angle.cos(), r * angle.sin(), x[2]];
        }
        let mut constraints = fix(&mesh, &[2], |_| true);
        constraints.extend(fix(&mesh, &[1], |x| x[1].abs() < 1e-9));
        constraints.extend(fix(&mesh, &[0], |x| x[0].abs() < 1e-9));
        let rim = side(&mesh, 2);
        let boundaries =
            springs.map(|f| BoundaryLayer::viscous_spring(rim, &SOIL, outer, f)).into_iter().collect();
        let materials = [(1, SOIL.into())].into();
        let model = Model::new(ModelInput {
            mesh,
            materials,
            quadrature: Gauss3,
            constraints,
            boundaries,
            ..Default::default()
        })
        .unwrap();
        let mut load = vec![0.0; model.dof_count()];
        for face in side(model.mesh(), 4) {
            loads::face_pressure(model.mesh(), &face, pressure, &mut load);
        }
        statics::solve(&model, &load).unwrap().u[0] / (pressure * inner / (2.0 * shear)) - 1.0
    };
    let (on_springs, free) = (found(Some(SpringFactors::CYLINDER)), found(None));
    println!("hole in a ring: on viscous springs {on_springs:+.1e}, free rim {free:+.1e}");
    assert!(on_springs.abs() < 1e-3, "{on_springs:e}");
    assert!(free.abs() > 0.03, "{free}");
}

/// Random loads, one side moved.
fn shaken_block(mass: Mass) -> Model {
    let mesh = Mesh::block([2, 2, 2], [1.0, 0.8, 0.6]);
    let constraints = fix(&mesh, &[0, 2], |x| x[0] == 0.0);
    let base = BoundaryLayer::viscous_spring(side(&mesh, 0), &SOIL, 2.0, SpringFactors::SPATIAL);
    let far = BoundaryLayer::absorbing(side(&mesh, 2), &SOIL);
    let boundaries = vec![base, BoundaryLayer { dashpot_tangential: 0.0, ..far }];
    Model::new(ModelInput {
        mesh,
        materials: [(1, SOIL.into())].into(),
        quadrature: Gauss3,
        constraints,
        boundaries,
        mass,
        rayleigh: Rayleigh { alpha_m: 3.0, beta_k: 1e-4 },
        ..Default::default()
    })
    .unwrap()
}

#[test]
fn energy_balances_with_boundary_layers() {
    let dt = 1e-3;
    for mass in [Mass::Consistent, Mass::Lumped] {
        let model = shaken_block(mass);
        let total = |s: &State| energy::kinetic(&model, s) + energy::strain(&model, s);
        let (n, fixed) = (model.dof_count(), model.supports().fixed().len());
        for method in ["1/4, 1/2", "gamma 0.6", "HHT -0.2", "window 0.5", "window 0.8"] {
            let mut newmark = match method {
                "1/4, 1/2" => NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, dt).ok(),
                "gamma 0.6" => NewmarkSolver::new(&model, Newmark { beta: 0.3025, gamma: 0.6 }, dt).ok(),
                "HHT -0.2" => NewmarkSolver::hht(&model, -0.2, dt).ok(),
                _ => None,
            };
            let theta = if method == "window 0.5" { 0.5 } else { 0.8 };
            let mut window = ThetaSolver::new(&model, theta, dt).unwrap();
            let (mut random, mut state) = (Random(5), State::new(&model));
            let (mut worst, mut size, mut entered) = (0.0_f64, 0.0_f64, [0.0; 4]);
            let mut start = vec![0.0; n];
            for step in 1..=100 {
                let end: Vec<f64> = (0..n).map(|_| 1e2 * random.next()).collect();
                let t = f64::from(step) * dt;
                let motion: Vec<f64> =
                    (0..fixed).map(|i| 1e-4 * ((90.0 + i as f64) * t).sin() * (60.0 * t).sin()).collect();
                let before = state.clone();
                let audit = match &mut newmark {
                    Some(solver) => {
                        let drive =
                            StepLoads { load_start: Some(&start), load_end: &end, prescribed: Some(&motion) };
                        solver.advance(&model, &mut state, drive).unwrap()
                    }
                    None => window.step_prescribed(&model, &mut state, &end, Some(&motion)).unwrap(),
                };
                let change = total(&state) - total(&before);
                let gained = audit.external_work + audit.support_work;
                let lost =
                    audit.damping_dissipation + audit.boundary_dissipation + audit.numerical_dissipation;
                worst = worst.max((gained - lost - change).abs());
                size = size.max(total(&state));
                assert!(audit.boundary_dissipation >= 0.0);
                for (e, a) in entered.iter_mut().zip([
                    audit.support_work,
                    audit.damping_dissipation,
                    audit.boundary_dissipation,
                    audit.numerical_dissipation,
                ]) {
                    *e += a;
                }
                for (&(d, _), m) in model.supports().fixed().iter().zip(&motion) {
                    assert!((state.u[d as usize] - m).abs() < 1e-18);
                }
                // Independent work: from mean forces (window); numerical part zero (Newmark pair).
                if newmark.is_none() {
                    let mean = window.mean_reactions(&model, &before, &state, &end);
                    let work: f64 = (0..n).map(|d| mean[d] * (state.u[d] - before.u[d])).sum();
                    assert!((work - audit.support_work).abs() < 1e-11 * size);
                }
                start = end;
            }
            println!(
                "{method}, {mass:?}: balance {:.1e} of {size:.2e} J; supports {:.2e}, damping {:.2e}, dashpots {:.2e}, \
                 numerical {:.2e}",
                worst / size,
                entered[0],
                entered[1],
                entered[2],
                entered[3]
            );
            assert!(worst < 1e-12 * size, "{method}: {:e}", worst / size);
            assert!(entered[2] > 0.01 * size);
            match method {
                "window 0.5" => assert!(entered[3].abs() < 1e-12 * size),
                "window 0.8" => assert!(entered[3] > 1e-3 * size),
                _ => {}
            }
        }
    }
}

#[test]
fn average_acceleration_conserves_on_moved_supports() {
    let model = shaken_block(Mass::Consistent);
    let (n, dt) = (model.dof_count(), 1e-3);
    let load = vec![0.0; n];
    let mut state = State::new(&model);
    let mut solver = NewmarkSolver::new(&model, Newmark::AVERAGE_ACCELERATION, dt).unwrap();
    let (mut numerical, mut work, mut by_reactions, mut size) = (0.0_f64, 0.0, 0.0, 0.0_f64);
    for step in 1..=200 {
        let motion = vec![1e-4 * (50.0 * f64::from(step) * dt).sin().powi(3); model.supports().fixed().len()];
        let before = state.clone();
        let drive = StepLoads { load_start: Some(&load), load_end: &load, prescribed: Some(&motion) };
        let audit = solver.advance(&model, &mut state, drive).unwrap();
        let (old, new) =
            (energy::reactions(&model, &before, &load), energy::reactions(&model, &state, &load));
        by_reactions += (0..n).map(|d| 0.5 * (old[d] + new[d]) * (state.u[d] - before.u[d])).sum::<f64>();
        work += audit.support_work;
        numerical = numerical.max(audit.numerical_dissipation.abs());
        size = size.max(energy::kinetic(&model, &state) + energy::strain(&model, &state));
    }
    println!("moved supports: numerical {:.1e} of {size:.2e} J", numerical / size);
    assert!(numerical < 1e-12 * size, "{numerical} {size}");
    assert!((work / by_reactions - 1.0).abs() < 1e-12);
}

#[test]
fn results_independent_of_thread_count() {
    let bits = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let model = shaken_block(Mass::Lumped);
            let load = model.gravity_load().iter().map(|_| 1e2).collect::<Vec<_>>();
            let mut state = State::new(&model);
            let mut solver = NewmarkSolver::hht(&model, -0.1, 1e-3).unwrap();
            for _ in 0..10 {
                let motion = vec![1e-5; model.supports().fixed().len()];
                let drive = StepLoads { load_start: Some(&load), load_end: &load, prescribed: Some(&motion) };
                solver.advance(&model, &mut state, drive).unwrap();
            }
            state.u.iter().chain(&state.a).map(|x| x.to_bits()).collect::<Vec<_>>()
        })
    };
    let one = bits(1);
    assert!(one == bits(2) && one == bits(3));
}
