//! Elastoplastic dynamics: linear solvers without yield, frictional oscillator in closed form, energy
//! balance.

use crate::common::difference;
use crate::plastic_common::{mohr_coulomb, tight};
use trackbed_fem::TimeIntegrator;
use trackbed_fem::boundary::BoundaryLayer;
use trackbed_fem::mass::Mass;
use trackbed_fem::newmark::{Newmark, NewmarkSolver, StepLoads};
use trackbed_fem::nonlinear::dynamics::{NonlinearNewmark, initial_acceleration};
use trackbed_fem::nonlinear::{Loading, NewtonOptions, StepControl};
use trackbed_fem::theta::{NonlinearTheta, ThetaMethod, ThetaSolver};
use trackbed_fem::{
    Constraint, DruckerPrager, Elastic, ElementKind, Material, Mesh, Model, ModelInput, Rayleigh, State,
    StepAudit, energy, loads,
};

const SOIL: Elastic = Elastic { young: 20e6, poisson: 0.3, density: 2000.0 };

/// Block on a fixed base with damping, an absorbing sprung side, and gravity.
fn block(material: Material, lumped: bool) -> Model {
    let mesh = Mesh::block([3, 2, 2], [3.0, 2.0, 2.0]);
    let constraints = (0..mesh.node_count() as u32)
        .filter(|&n| mesh.coordinates[n as usize][2] == 0.0)
        .flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }))
        .collect();
    let side = mesh.boundary_faces().into_iter().filter(|f| f.centre(&mesh)[0] == 3.0).collect();
    let layer =
        BoundaryLayer { spring_normal: 1e6, spring_tangential: 5e5, ..BoundaryLayer::absorbing(side, &SOIL) };
    Model::new(ModelInput {
        mesh,
        materials: [(1, material)].into(),
        constraints,
        gravity: [0.0, 0.0, -9.81],
        rayleigh: Rayleigh { alpha_m: 2.0, beta_k: 1e-4 },
        mass: if lumped { Mass::Lumped } else { Mass::Consistent },
        boundaries: vec![layer],
        ..Default::default()
    })
    .unwrap()
}

/// Half sine of 0.02 s.
fn pulse(time: f64) -> f64 {
    if time < 0.02 { (std::f64::consts::PI * time / 0.02).sin() } else { 0.0 }
}

fn top_load(model: &Model, pressure: f64) -> Vec<f64> {
    let (mesh, mut load) = (model.mesh(), vec![0.0; model.dof_count()]);
    for face in mesh.boundary_faces() {
        if face.centre(mesh)[2] == 2.0 && face.centre(mesh)[0] < 1.0 {
            loads::face_pressure(mesh, &face, pressure, &mut load);
        }
    }
    load
}

/// Weight, pulse on the top and a moving base, with all kinds of damping.
struct Shaken {
    model: Model,
    weight: Vec<f64>,
    top: Vec<f64>,
}

impl Shaken {
    fn new() -> Shaken {
        let model = block(SOIL.into(), false);
        Shaken { weight: model.gravity_load(), top: top_load(&model, 50e3), model }
    }

    fn at(&self, time: f64) -> Vec<f64> {
        self.weight.iter().zip(&self.top).map(|(w, t)| w + pulse(time) * t).collect()
    }

    fn moved(&self, time: f64) -> Vec<f64> {
        let base = 1e-3 * (200.0 * time).sin();
        let fixed = self.model.supports().fixed();
        fixed.iter().map(|(dof, _)| if dof % 3 == 0 { base } else { 0.0 }).collect()
    }
}

impl Loading for &Shaken {
    fn load(&mut self, time: f64, load: &mut [f64]) {
        load.copy_from_slice(&self.at(time));
    }

    fn prescribed(&mut self, time: f64, values: &mut [f64]) {
        values.copy_from_slice(&self.moved(time));
    }
}

#[test]
fn elastic_response_matches_linear_newmark() {
    let mut shaken = &Shaken::new();
    let model = &shaken.model;
    let dt = 1e-3;
    for hht in [0.0, -0.2] {
        let (mut a, mut b) = (State::new(model), State::new(model));
        trackbed_fem::newmark::initial_acceleration(model, &mut a, &shaken.at(0.0)).unwrap();
        initial_acceleration(model, &mut b, &shaken.at(0.0)).unwrap();
        assert!(difference(&b.a, &a.a) < 1e-10);
        let mut linear = NewmarkSolver::hht(model, hht, dt).unwrap();
        let mut driver = NonlinearNewmark::hht(model, hht, tight(), StepControl::fixed(dt)).unwrap();
        let (mut sum_a, mut sum_b) = ([0.0; 4], [0.0; 4]);
        let parts =
            |x: &StepAudit| [x.external_work, x.support_work, x.damping_dissipation, x.boundary_dissipation];
        for step in 0..40 {
            let (from, to) = (dt * f64::from(step), dt * f64::from(step + 1));
            let prescribed = shaken.moved(to);
            let (load_start, load_end) = (shaken.at(from), shaken.at(to));
            let drive = StepLoads {
                load_start: Some(&load_start),
                load_end: &load_end,
                prescribed: Some(&prescribed),
            };
            let audit = linear.advance(model, &mut a, drive).unwrap();
            (0..4).for_each(|k| sum_a[k] += parts(&audit)[k]);
            let end = b.time + dt;
            driver
                .integrate(model, &mut b, end, &mut shaken, &mut |_, _, x| {
                    (0..4).for_each(|k| sum_b[k] += parts(x.unwrap())[k])
                })
                .unwrap();
        }
        println!(
            "h {hht}: u {:.1e}, v {:.1e}, a {:.1e}; ledger {:.1e}",
            difference(&b.u, &a.u),
            difference(&b.v, &a.v),
            difference(&b.a, &a.a),
            difference(&sum_b, &sum_a)
        );
        assert!(
            difference(&b.u, &a.u) < 1e-8
                && difference(&b.v, &a.v) < 1e-7
                && difference(&sum_b, &sum_a) < 1e-7
        );
    }
}

#[test]
fn elastic_response_matches_linear_window() {
    let shaken = Shaken::new();
    let (model, dt) = (&shaken.model, 1e-3);
    for theta in [0.5, 0.7] {
        let (mut a, mut b) = (State::new(model), State::new(model));
        let mut linear = ThetaSolver::new(model, theta, dt).unwrap();
        let mut driver = NonlinearTheta::new(model, theta, dt, tight()).unwrap();
        let (mut sum_a, mut sum_b) = ([0.0; 5], [0.0; 5]);
        let parts = |x: &StepAudit| {
            [
                x.external_work,
                x.support_work,
                x.damping_dissipation,
                x.boundary_dissipation,
                x.numerical_dissipation,
            ]
        };
        for step in 1..=40 {
            let (time, before) = (dt * f64::from(step), b.clone());
            let x =
                linear.step_prescribed(model, &mut a, &shaken.at(time), Some(&shaken.moved(time))).unwrap();
            let y =
                driver.step_prescribed(model, &mut b, &shaken.at(time), Some(&shaken.moved(time))).unwrap();
            (0..5).for_each(|k| (sum_a[k], sum_b[k]) = (sum_a[k] + parts(&x)[k], sum_b[k] + parts(&y)[k]));
            if step == 20 {
                let r = linear.mean_reactions(model, &before, &a, &shaken.at(time));
                let s = driver.mean_reactions(
                    model,
                    &{
                        let mut s = before;
                        s.points.resize(model.point_count(), 0);
                        s
                    },
                    &b,
                    &shaken.at(time),
                );
                assert!(difference(&s, &r) < 1e-6, "{:e}", difference(&s, &r));
            }
        }
        println!(
            "theta {theta}: u {:.1e}, v {:.1e}; ledger {:.1e}",
            difference(&b.u, &a.u),
            difference(&b.v, &a.v),
            difference(&sum_b, &sum_a)
        );
        assert!(
            difference(&b.u, &a.u) < 1e-8
                && difference(&b.v, &a.v) < 1e-7
                && difference(&sum_b, &sum_a) < 1e-6
        );
    }
}

#[test]
fn an_oscillator_with_friction() {
    let (shear, yield_shear) = (SOIL.lame().1, 20e3);
    let mut mesh = Mesh::default();
    for (n, x) in ElementKind::Hex8.natural().iter().enumerate() {
        mesh.node_ids.push(n as u32 + 1);
        mesh.coordinates.push(x.map(|x| 0.5 * (1.0 + x)));
    }
    mesh.push_element(1, 1, ElementKind::Hex8, &[0, 1, 2, 3, 4, 5, 6, 7]);
    let mut constraints = Vec::new();
    for node in 0..8 {
        let top = mesh.coordinates[node as usize][2] == 1.0;
        let directions: &[u8] = if top { &[1, 2] } else { &[0, 1, 2] };
        constraints.extend(directions.iter().map(|&direction| Constraint { node, direction, value: 0.0 }));
    }
    let law = DruckerPrager::von_mises(3.0_f64.sqrt() * yield_shear);
    let model = Model::new(ModelInput {
        mesh,
        materials: [(1, Material::plastic(SOIL, law))].into(),
        constraints,
        mass: Mass::Lumped,
        ..Default::default()
    })
    .unwrap();
    let (mass, w) = (0.5 * SOIL.density, (shear / (0.5 * SOIL.density)).sqrt());
    let (v0, u_y) = (1.0, yield_shear / shear);
    let v1 = (v0 * v0 - (w * u_y).powi(2)).sqrt();
    let u_max = u_y + mass * v1 * v1 / (2.0 * yield_shear);
    let t_max = (u_y * w / v0).asin() / w + mass * v1 / yield_shear;
    let end = t_max + std::f64::consts::PI / w;
    let dt = t_max / 2000.0;
    let mut state = State::new(&model);
    let moving: Vec<usize> = model.supports().free().iter().map(|d| *d as usize).collect();
    moving.iter().for_each(|d| state.v[*d] = v0);
    initial_acceleration(&model, &mut state, &vec![0.0; model.dof_count()]).unwrap();
    let mut driver =
        NonlinearNewmark::newmark(&model, Newmark::AVERAGE_ACCELERATION, tight(), StepControl::fixed(dt))
            .unwrap();
    let (mut found, mut when, mut plastic) = (0.0, 0.0, 0.0);
    let mut rest = |_: f64, _: &mut [f64]| ();
    driver
        .integrate(&model, &mut state, end, &mut rest, &mut |s, _, audit| {
            plastic += audit.unwrap().plastic_dissipation;
            if s.u[moving[0]] > found {
                (found, when) = (s.u[moving[0]], s.time);
            }
        })
        .unwrap();
    let swing = u_max - state.u[moving[0]];
    println!(
        "oscillator: u_max {:.1e}, at {:.1e}, half a swing back {:.1e}, dissipation {:.1e}",
        found / u_max - 1.0,
        when / t_max - 1.0,
        swing / (2.0 * u_y) - 1.0,
        plastic / (yield_shear * (u_max - u_y)) - 1.0
    );
    assert!((found / u_max - 1.0).abs() < 1e-4 && (when / t_max - 1.0).abs() < 1e-3);
    assert!((swing / (2.0 * u_y) - 1.0).abs() < 1e-3);
    assert!((plastic / (yield_shear * (u_max - u_y)) - 1.0).abs() < 1e-3);
}

fn stored(model: &Model, state: &State) -> f64 {
    energy::kinetic(model, state) + energy::strain(model, state)
}

#[test]
fn energy_balance_closes_under_yield() {
    for lumped in [false, true] {
        let model = block(mohr_coulomb(SOIL, 10e3, 25.0, 5.0), lumped);
        let (weight, top) = (model.gravity_load(), top_load(&model, 150e3));
        let at = |time: f64, load: &mut [f64]| {
            for d in 0..load.len() {
                load[d] = weight[d] + pulse(time) * top[d];
            }
        };
        let dt = 5e-4;
        for scheme in ["newmark", "hht", "window 0.5", "window 0.6"] {
            let mut state = State::new(&model);
            let mut load = vec![0.0; model.dof_count()];
            at(0.0, &mut load);
            initial_acceleration(&model, &mut state, &load).unwrap();
            let (mut sum, mut most, mut least) = (StepAudit::default(), 0.0_f64, 0.0_f64);
            let mut add = |x: &StepAudit, state: &State| {
                sum.external_work += x.external_work;
                sum.damping_dissipation += x.damping_dissipation;
                sum.boundary_dissipation += x.boundary_dissipation;
                sum.plastic_dissipation += x.plastic_dissipation;
                sum.numerical_dissipation += x.numerical_dissipation;
                most = most.max(energy::kinetic(&model, state));
                least = least.min(x.plastic_dissipation);
            };
            let mut counts = Default::default();
            if let Some(theta) = scheme.strip_prefix("window ") {
                let theta: f64 = theta.parse().unwrap();
                let mut driver = NonlinearTheta::new(&model, theta, dt, NewtonOptions::default()).unwrap();
                for step in 0..60 {
                    // Window impulse by the mid-point rule.
                    at(dt * (f64::from(step) + 0.5), &mut load);
                    let audit = driver.step(&model, &mut state, &load).unwrap();
                    add(&audit, &state);
                    counts = driver.statistics();
                }
            } else {
                let control = StepControl::fixed(dt);
                let alpha = if scheme == "hht" { -0.1 } else { 0.0 };
                let mut driver =
                    NonlinearNewmark::hht(&model, alpha, NewtonOptions::default(), control).unwrap();
                let mut loading = at;
                driver
                    .integrate(&model, &mut state, 60.0 * dt, &mut loading, &mut |s, _, x| add(x.unwrap(), s))
                    .unwrap();
                counts = driver.statistics();
            }
            let end = stored(&model, &state);
            let out = sum.damping_dissipation + sum.boundary_dissipation + sum.plastic_dissipation;
            let balance = (sum.external_work - out - sum.numerical_dissipation - end) / sum.external_work;
            let numerical = sum.numerical_dissipation / sum.external_work;
            println!(
                "{scheme}, lumped {lumped}: work {:.1} J, plastic {:.1}, damping {:.1}, boundary {:.1}, stored {end:.1}, numerical {numerical:.1e} of the work, balance {balance:.1e}; peak kinetic {most:.1}; {} steps, {} iterations, {} halvings",
                sum.external_work,
                sum.plastic_dissipation,
                sum.damping_dissipation,
                sum.boundary_dissipation,
                counts.steps,
                counts.iterations,
                counts.halvings
            );
            assert!(balance.abs() < 1e-9, "the ledger and the state disagree: {balance:e}");
            assert!(sum.plastic_dissipation > 0.05 * sum.external_work && least > -1e-6 * sum.external_work);
            let damps = scheme == "hht" || scheme == "window 0.6";
            assert!(numerical.abs() < if damps { 0.05 } else { 5e-3 }, "{numerical:e}");
        }
    }
}

#[test]
fn bits_and_restart() {
    let run = |threads: usize, restart: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let model = block(mohr_coulomb(SOIL, 10e3, 25.0, 5.0), false);
            let (weight, top) = (model.gravity_load(), top_load(&model, 150e3));
            let mut loading = |time: f64, load: &mut [f64]| {
                for d in 0..load.len() {
                    load[d] = weight[d] + pulse(time) * top[d];
                }
            };
            let new = || {
                NonlinearNewmark::hht(&model, -0.1, NewtonOptions::default(), StepControl::fixed(1e-3))
                    .unwrap()
            };
            let (mut state, mut driver) = (State::new(&model), new());
            for step in 1..=10 {
                if restart && step == 6 {
                    driver = new();
                }
                driver
                    .integrate(&model, &mut state, 1e-3 * f64::from(step), &mut loading, &mut |_, _, _| ())
                    .unwrap();
            }
            state
        })
    };
    let one = run(1, false);
    assert!(one == run(2, false) && one == run(3, false) && one == run(1, true));
}
