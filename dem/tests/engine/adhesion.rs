//! Adhesion: pull-off force, friction, sticking impacts.

use crate::scene::{Random, Run, plane, sphere, stone, weightless};
use std::f64::consts::PI;
use trackbed_dem::law::restitution::damping_ratio;
use trackbed_dem::{
    AppliedForce, BodyInput, Material, ModelError, ModelInput, PairOverride, Shape, TimeStep,
    TriangleSurface, Vec3, Work, measure,
};

/// Radius [m] and work of adhesion [J/m²].
const R: f64 = 0.01;
const W: f64 = 20.0;

fn sticky(material: Material) -> ModelInput {
    let mut input = weightless(material);
    input.contacts.push(PairOverride { a: 0, b: 0, adhesion: Some(W), ..PairOverride::default() });
    input
}

fn glass() -> Material {
    Material { young: Some(1e7), poisson: 0.25, stiffness: f64::INFINITY, ..stone() }
}

fn ceiling() -> TriangleSurface {
    let vertices = vec![Vec3::new(-1.0, -1.0, 0.0), Vec3::new(2.0, -1.0, 0.0), Vec3::new(-1.0, 2.0, 0.0)];
    TriangleSurface { vertices, triangles: vec![[0, 1, 2]], ..TriangleSurface::default() }
}

/// Pull-off force 2π w R*: Derjaguin, Muller & Toporov 1975. Plane, triangle: R* = R; sphere: R/2.
#[test]
fn holds_up_to_pull_off_force() {
    for (law, material) in [stone(), glass()].into_iter().enumerate() {
        for (partner, reduced) in [("plane", R), ("triangle", R), ("sphere", 0.5 * R)] {
            let pull = 2.0 * PI * W * reduced;
            let mass = 2600.0 * 4.0 / 3.0 * PI * R.powi(3);
            for share in [0.99, 1.01] {
                let load = share * pull;
                let spring = |force: f64| match (law, partner) {
                    (0, _) => force / 1e5,
                    _ => {
                        let modulus = 1e7 / (2.0 * (1.0 - 0.25 * 0.25));
                        (0.75 * force / (modulus * reduced.sqrt())).powf(2.0 / 3.0)
                    }
                };
                let rest = spring((pull - load).abs());
                let mut input = sticky(material);
                input.gravity = Vec3::new(0.0, 0.0, -load / mass);
                let below = if partner == "sphere" { -2.0 * R } else { -R };
                input.bodies.push(sphere(Vec3::new(0.0, 0.0, below + 1.2 * rest), Vec3::zeros()));
                match partner {
                    "plane" => input.planes.push(plane(Vec3::zeros(), -Vec3::z())),
                    "triangle" => input.triangles.push(ceiling()),
                    _ => input.bodies.push(BodyInput { fixed: [true; 6], ..BodyInput::default() }),
                }
                let mut run = Run::new(input);
                while run.state.time < 0.4 {
                    run.step();
                }
                let overlap = run.state.position(0).z - below;
                if share < 1.0 {
                    assert!((overlap / rest - 1.0).abs() < 1e-6, "{law} {partner}: {overlap:e}, {rest:e}");
                } else {
                    assert!(overlap < -1e-4, "{law} {partner}: {overlap:e} must have fallen");
                }
            }
        }
    }
}

/// Without load, friction reaches μF under the adhesive pressure F (Derjaguin 1934).
#[test]
fn friction_without_a_load() {
    let pull = 2.0 * PI * W * R;
    for (share, slides) in [(0.98, false), (1.02, true)] {
        let mut input = sticky(stone());
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        let fixed = [false, false, false, true, true, true];
        let position = Vec3::new(0.0, 0.0, R - pull / 1e5);
        input.bodies.push(BodyInput { position, fixed, ..BodyInput::default() });
        let mut run = Run::new(input);
        let steps = (0.2 / run.model.dt()) as usize;
        for k in 0..steps {
            let force = Vec3::x() * (0.5 * pull * share * (k as f64 / (0.5 * steps as f64)).min(1.0));
            let point = run.state.position(0);
            run.step_under(&[AppliedForce { body: 0, force, point }]);
        }
        let way = run.state.position(0).x;
        assert!((way > 1e-3) == slides, "{share}: {way:e}");
        assert!(way > 0.0);
    }
}

/// Rebound speed with spring K, dashpot C = 2ζ√(mK) and pull F; zero if it sticks. x(t) = e^(−ζωt)(−d₀ cos pt
/// + B sin pt) + d₀ until spring and dashpot stop pushing.
fn rebound(v: f64, mass: f64, stiffness: f64, zeta: f64, pull: f64) -> f64 {
    let omega = (stiffness / mass).sqrt();
    let p = omega * (1.0 - zeta * zeta).sqrt();
    let d0 = pull / stiffness;
    let b = (v - zeta * omega * d0) / p;
    let at = |t: f64| {
        let (e, s, c) = ((-zeta * omega * t).exp(), (p * t).sin(), (p * t).cos());
        let x = e * (-d0 * c + b * s);
        (x + d0, -zeta * omega * x + e * p * (d0 * s + b * c))
    };
    let push = |t: f64| {
        let (d, rate) = at(t);
        stiffness * d + 2.0 * zeta * (mass * stiffness).sqrt() * rate
    };
    let step = 1e-3 / omega;
    let Some(k) = (1..10_000).find(|&k| push(f64::from(k) * step) <= 0.0) else { return 0.0 };
    let (mut low, mut high) = (f64::from(k - 1) * step, f64::from(k) * step);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if push(middle) > 0.0 { low = middle } else { high = middle }
    }
    let (d, rate) = at(low);
    (rate * rate - 2.0 * pull * d.max(0.0) / mass).max(0.0).sqrt()
}

#[test]
fn slow_impacts_stick() {
    let material = Material { friction: 0.0, ..stone() };
    let zeta = damping_ratio(0.5);
    let whole = 2600.0 * 4.0 / 3.0 * PI * R.powi(3);
    for pair in [false, true] {
        let (mass, reduced, stiffness) = if pair { (0.5 * whole, 0.5 * R, 1e5) } else { (whole, R, 1e5) };
        let pull = 2.0 * PI * W * reduced;
        let after = |v: f64| rebound(v, mass, stiffness, zeta, pull);
        let (mut low, mut high) = (1e-4, 10.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if after(middle) > 0.0 { high = middle } else { low = middle }
        }
        println!("sticks below {low:.4} m/s");
        assert!(low > 0.005 && high < 1.0);
        for share in [0.5, 0.95, 1.05, 1.5, 3.0, 10.0] {
            let v = share * low;
            let mut input = sticky(material);
            input.time_step = TimeStep::Auto { fraction: 0.01 };
            if pair {
                input.bodies.push(sphere(Vec3::new(-1.0001 * R, 0.0, 0.0), Vec3::x() * (0.5 * v)));
                input.bodies.push(sphere(Vec3::new(1.0001 * R, 0.0, 0.0), -Vec3::x() * (0.5 * v)));
            } else {
                input.planes.push(plane(Vec3::zeros(), Vec3::z()));
                input.bodies.push(sphere(Vec3::new(0.0, 0.0, 1.0002 * R), -Vec3::z() * v));
            }
            let mut run = Run::new(input);
            let energy = |run: &Run| {
                measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated()
            };
            let before = energy(&run);
            let end = 2e-4 * R / v + 40.0 * (mass / stiffness).sqrt();
            while run.state.time < end {
                run.step();
            }
            let (apart, speed) = if pair {
                let apart = run.state.position(1).x - run.state.position(0).x - 2.0 * R;
                (apart, run.state.velocity(1).x - run.state.velocity(0).x)
            } else {
                (run.state.position(0).z - R, run.state.velocity(0).z)
            };
            if share < 1.0 {
                assert!(apart < 0.0, "{pair} {share}: {apart:e}");
                let open = (energy(&run) / before - 1.0).abs();
                println!("{share} of it: sticks, energy open {open:.1e}");
                assert!(open < 5e-4, "{pair} {share}: {open:e}");
            } else {
                let expected = after(v);
                println!("{share} of it: {speed:.5} m/s, closed form {expected:.5}");
                assert!(
                    apart > 0.0 && (speed / expected - 1.0).abs() < 0.01,
                    "{pair} {share}: {apart:e} {speed}"
                );
            }
        }
    }
}

#[test]
fn sticking_cloud_closes_balances() {
    let input = || {
        let mut random = Random::new(3);
        let mut input = sticky(Material { friction: 0.3, ..stone() });
        input.time_step = TimeStep::Auto { fraction: 0.05 };
        for k in 0..2200_usize {
            let cell = Vec3::new((k % 13) as f64, (k / 13 % 13) as f64, (k / 169) as f64);
            let (position, velocity) =
                (cell * 0.0205, random.vector() * 0.4 - (cell - Vec3::repeat(6.0)) * 0.05);
            input.bodies.push(sphere(position, velocity));
        }
        input
    };
    let run_in = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut run = Run::new(input());
            let total = |run: &Run| {
                measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated()
            };
            let (start, before) = (total(&run), measure::momentum(&run.model, &run.state).linear);
            run.steps(400);
            if threads == 2 {
                let bytes = postcard::to_stdvec(&run.state).expect("a checkpoint");
                run.state = postcard::from_bytes(&bytes).expect("a state");
                run.work = Work::new(&run.model, &run.state);
            }
            run.steps(400);
            let dissipated = run.state.balance.dissipated();
            let open = (total(&run) - start).abs();
            let contacts = measure::contacts(&run.model, &run.state);
            let pulled = contacts.iter().filter(|c| c.normal_force < 0.0).count();
            println!("{} contacts, {pulled} pulled; open {open:.1e} of {dissipated:.3} J", contacts.len());
            assert!(contacts.len() > 1000 && pulled > 100);
            assert!(open < 2e-3 * dissipated, "{open:e} of {dissipated}");
            assert!((measure::momentum(&run.model, &run.state).linear - before).norm() < 1e-12);
            let bodies = (0..run.model.body_count()).flat_map(|b| [run.state.position(b), run.state.spin(b)]);
            bodies.flat_map(|v| [v.x, v.y, v.z].map(f64::to_bits)).collect::<Vec<_>>()
        })
    };
    let one = run_in(1);
    for threads in [2, 3, 7] {
        assert!(one == run_in(threads), "{threads} threads");
    }
}

#[test]
fn rejects_adhesion_conflicts() {
    let mut input = sticky(stone());
    input.shapes.push(Shape::Box { half: [R; 3] });
    input.bodies.push(BodyInput { shape: 1, ..BodyInput::default() });
    let error = trackbed_dem::Model::new(input.clone()).expect_err("a box");
    assert_eq!(error, ModelError::Adhesion { index: 0, with: "boxes and polyhedra" });
    input.contacts[0].adhesion = Some(0.0);
    assert!(trackbed_dem::Model::new(input.clone()).is_ok());
    input.contacts[0].adhesion = Some(-1.0);
    let error = trackbed_dem::Model::new(input).expect_err("a negative work");
    assert!(error.to_string().contains("adhesion"), "{error}");
}
