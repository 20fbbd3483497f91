//! Sliding and rolling on planes.

use crate::scene::{Run, plane, rigid, sphere, stone, weightless};
use trackbed_dem::{BodyInput, Material, Plane, Shape, TimeStep, Vec3};

const G: f64 = 9.81;

fn on_plane(friction: f64, velocity: f64, gravity: Vec3) -> Run {
    let material = Material { stiffness: 1e7, friction, tangential_damping_ratio: 1.0, ..stone() };
    let mut input = weightless(material);
    input.gravity = gravity;
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    let mass = 2600.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6;
    let sink = mass * -gravity.z / 1e7;
    input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.01 - sink), Vec3::new(velocity, 0.0, 0.0)));
    input.time_step = TimeStep::Auto { fraction: 0.2 };
    Run::new(input)
}

/// Ends rolling at 5/7 of its speed after t = 2 v₀/(7 μ g).
#[test]
fn sliding_sphere_rolls_at_five_sevenths() {
    let (v0, mu) = (0.2, 0.3);
    let mut run = on_plane(mu, v0, Vec3::new(0.0, 0.0, -G));
    let slip = |run: &Run| run.state.velocity(0).x - 0.01 * run.state.spin(0).y;
    while slip(&run) > 1e-3 * v0 {
        run.step();
        assert!(run.state.time < 1.0);
    }
    let expected = 2.0 * v0 / (7.0 * mu * G);
    assert!((run.state.time / expected - 1.0).abs() < 5e-3, "{} against {expected}", run.state.time);
    while run.state.time < 0.1 {
        run.step();
    }
    let speed = run.state.velocity(0).x / v0;
    assert!((speed - 5.0 / 7.0).abs() < 1e-4, "{speed}");
}

/// Acceleration 5/7 g sin α.
#[test]
fn sphere_rolls_down_an_incline() {
    let angle = 0.2_f64;
    let mut run = on_plane(0.5, 0.0, Vec3::new(G * angle.sin(), 0.0, -G * angle.cos()));
    while run.state.time < 0.3 {
        run.step();
    }
    let expected = 5.0 / 7.0 * G * angle.sin() * (run.state.time - 0.5 * run.model.dt());
    let found = run.state.velocity(0).x;
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} against {expected}");
}

/// Stops after v²/(2 μ g).
#[test]
fn block_slides_to_rest() {
    let (v0, mu) = (0.5, 0.4);
    let material = Material { stiffness: 1e6, friction: mu, tangential_damping_ratio: 1.0, ..stone() };
    let mut input = weightless(material);
    input.gravity = Vec3::new(0.0, 0.0, -G);
    input.materials.push(rigid(material));
    input.shapes = vec![Shape::Box { half: [0.2, 0.1, 0.02] }];
    input.planes.push(Plane { material: 1, ..plane(Vec3::zeros(), Vec3::z()) });
    let mass = 2600.0 * 8.0 * 0.2 * 0.1 * 0.02;
    let sink = mass * G / 4.0 / 2e6;
    let position = Vec3::new(0.0, 0.0, 0.02 - sink);
    input.bodies.push(BodyInput { position, velocity: Vec3::new(v0, 0.0, 0.0), ..BodyInput::default() });
    let mut run = Run::new(input);
    while run.state.time < 0.5 {
        run.step();
    }
    let (way, expected) = (run.state.position(0).x, v0 * v0 / (2.0 * mu * G));
    assert!((way / expected - 1.0).abs() < 3e-3, "{way} against {expected}");
    assert!(run.state.velocity(0).norm() < 1e-4);
    assert!((run.state.position(0).z - position.z).abs() < 1e-6);
}

/// Sliding acceleration g (sin α − μ cos α).
#[test]
fn block_on_slope_obeys_friction() {
    let mu = 0.4_f64;
    for (angle, slides) in [(0.9 * mu.atan(), false), (1.2 * mu.atan(), true)] {
        let material = Material { stiffness: 1e6, friction: mu, tangential_damping_ratio: 1.0, ..stone() };
        let mut input = weightless(material);
        input.gravity = Vec3::new(G * angle.sin(), 0.0, -G * angle.cos());
        input.shapes = vec![Shape::Box { half: [0.2, 0.1, 0.02] }];
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        let position = Vec3::new(0.0, 0.0, 0.02);
        input.bodies.push(BodyInput { position, ..BodyInput::default() });
        let mut run = Run::new(input);
        while run.state.time < 0.3 {
            run.step();
        }
        let found = run.state.velocity(0).x;
        let expected = if slides { G * (angle.sin() - mu * angle.cos()) * run.state.time } else { 0.0 };
        assert!((found - expected).abs() < 5e-3 * G * 0.3, "{found} against {expected}");
    }
}
