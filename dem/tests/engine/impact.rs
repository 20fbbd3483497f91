//! Single impacts against closed forms.

use crate::scene::{Run, plane, rigid, sphere, stone, weightless};
use trackbed_dem::{BodyInput, Material, Plane, TimeStep, Vec3, measure};

const RESTITUTIONS: [f64; 4] = [0.2, 0.5, 0.8, 0.95];

fn until_apart(run: &mut Run) {
    let touching = |run: &Run| !measure::contacts(&run.model, &run.state).is_empty();
    let mut steps = 0;
    while !touching(run) {
        run.step();
        steps += 1;
        assert!(steps < 100_000, "the bodies never meet");
    }
    while touching(run) {
        run.step();
        steps += 1;
        assert!(steps < 200_000, "the bodies never part");
    }
    run.step();
}

#[test]
fn restitution_as_requested_between_unequal_spheres() {
    for e in RESTITUTIONS {
        for gap in [1e-4, 1.37e-4, 2.11e-4] {
            let mut input = weightless(Material { restitution: e, ..stone() });
            input.bodies.push(sphere(Vec3::zeros(), Vec3::x()));
            let position = Vec3::new(0.03 + gap, 0.0, 0.0);
            input.bodies.push(BodyInput { scale: 2.0, position, ..BodyInput::default() });
            let mut run = Run::new(input);
            until_apart(&mut run);
            let found = run.state.velocity(1).x - run.state.velocity(0).x;
            assert!((found / e - 1.0).abs() < 5e-3, "asked {e}, got {found}");
        }
    }
}

#[test]
fn restitution_as_requested_on_a_plane() {
    for e in RESTITUTIONS {
        for gap in [1e-4, 1.37e-4, 2.11e-4] {
            let material = Material { restitution: e, ..stone() };
            let mut input = weightless(material);
            input.materials.push(rigid(material));
            input.planes.push(Plane { material: 1, ..plane(Vec3::zeros(), Vec3::z()) });
            input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.01 + gap), Vec3::new(0.0, 0.0, -1.0)));
            let mut run = Run::new(input);
            until_apart(&mut run);
            let found = run.state.velocity(0).z;
            assert!((found / e - 1.0).abs() < 5e-3, "asked {e}, got {found}");
        }
    }
}

#[test]
fn restitution_error_is_of_second_order() {
    let error = |dt: f64| {
        let worst = |gap: f64| {
            let mut input = weightless(Material { restitution: 0.3, ..stone() });
            input.time_step = TimeStep::Fixed(dt);
            input.planes.push(plane(Vec3::zeros(), Vec3::z()));
            input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.01 + gap), Vec3::new(0.0, 0.0, -1.0)));
            let mut run = Run::new(input);
            until_apart(&mut run);
            (run.state.velocity(0).z - 0.3).abs()
        };
        (0..20).map(|k| worst(1e-4 + 0.05 * f64::from(k) * dt)).fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(2e-5), error(5e-6));
    assert!(coarse < 5e-3 && coarse / fine > 10.0, "{coarse:e} {fine:e}");
}

#[test]
fn oblique_impact_conserves_momentum() {
    let mut input = weightless(stone());
    input.bodies.push(BodyInput {
        spin: Vec3::new(3.0, -50.0, 20.0),
        ..sphere(Vec3::zeros(), Vec3::new(1.0, 0.3, -0.2))
    });
    let position = Vec3::new(0.0301, 0.008, -0.005);
    input.bodies.push(BodyInput { scale: 2.0, position, ..BodyInput::default() });
    let mut run = Run::new(input);
    let before = measure::momentum(&run.model, &run.state);
    until_apart(&mut run);
    let after = measure::momentum(&run.model, &run.state);
    assert!((run.state.velocity(1)).norm() > 0.01, "they must have met");
    let linear = (after.linear - before.linear).norm() / before.linear.norm();
    let angular = (after.angular - before.angular).norm() / before.angular.norm();
    assert!(linear < 1e-13 && angular < 1e-12, "{linear:e} {angular:e}");
}

/// Angular velocity gains 5/2 μ(1 + e) vₙ over r (Walton 1993; Maw, Barber & Fawcett 1976).
#[test]
fn sliding_impact_matches_closed_form() {
    let mu = 0.1;
    for e in RESTITUTIONS {
        let mut input = weightless(Material { restitution: e, friction: mu, ..stone() });
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.0101), Vec3::new(40.0, 0.0, -1.0)));
        let mut run = Run::new(input);
        until_apart(&mut run);
        let change = 40.0 - run.state.velocity(0).x;
        let expected = mu * (1.0 + e);
        assert!((change / expected - 1.0).abs() < 5e-3, "e {e}: {change} against {expected}");
        // Lever arm: radius less overlap.
        let spin = run.state.spin(0).y * 0.01;
        assert!((spin / (2.5 * expected) - 1.0).abs() < 0.05, "spin {spin}");
    }
}

/// ωₜ² = 7/2 Ks/m, T = π √(m/Kn): full reversal for Ks/Kn = 2/7.
#[test]
fn sticking_impact_matches_closed_form() {
    for ratio in [2.0 / 7.0_f64, 0.5, 0.1] {
        let material =
            Material { restitution: 1.0, friction: 1e6, tangential_ratio: ratio, stiffness: 1e7, ..stone() };
        let mut input = weightless(material);
        input.time_step = TimeStep::Auto { fraction: 0.01 };
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.01001), Vec3::new(0.05, 0.0, -0.1)));
        let mut run = Run::new(input);
        until_apart(&mut run);
        let point = run.state.velocity(0).x - run.state.spin(0).y * 0.01;
        let expected = 0.05 * (std::f64::consts::PI * (3.5 * ratio).sqrt()).cos();
        assert!((point - expected).abs() < 4e-3 * 0.05, "ratio {ratio}: {point} against {expected}");
    }
}
