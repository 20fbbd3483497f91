//! Rolling and twisting resistance against closed forms.

use crate::hertz::elastic;
use crate::scene::{Run, plane, sphere, stone, weightless};
use trackbed_dem::{Material, TimeStep, Vec3};

const G: f64 = 9.81;

fn on_plane(hertz: bool, slope: f64, velocity: f64, spin: Vec3) -> Run {
    let law = if hertz { elastic() } else { Material { stiffness: 1e6, ..stone() } };
    let material = Material {
        friction: 0.8,
        tangential_damping_ratio: 1.0,
        rolling_friction: 0.1,
        twisting_friction: 0.05,
        ..law
    };
    let mut input = weightless(material);
    let gravity = G / (1.0 + slope * slope).sqrt();
    input.gravity = Vec3::new(gravity * slope, 0.0, -gravity);
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    let weight = 2600.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6 * gravity;
    let modulus = 5e7 / (2.0 * (1.0 - 0.0625));
    let sink = if hertz { (weight * 0.75 / (modulus * 0.1)).powf(2.0 / 3.0) } else { weight / 1e6 };
    let mut body = sphere(Vec3::new(0.0, 0.0, 0.01 - sink), Vec3::new(velocity, 0.0, 0.0));
    body.spin = spin;
    input.bodies.push(body);
    input.time_step = TimeStep::Auto { fraction: 0.2 };
    Run::new(input)
}

/// Moment μᵣ r N: deceleration 5/7 μᵣ g, then rest.
#[test]
fn ball_rolls_to_rest() {
    for hertz in [false, true] {
        let v0 = 0.2;
        let mut run = on_plane(hertz, 0.0, v0, Vec3::new(0.0, v0 / 0.01, 0.0));
        while run.state.time < 0.15 {
            run.step();
        }
        let expected = v0 - 5.0 / 7.0 * 0.1 * G * run.state.time;
        let found = run.state.velocity(0).x;
        assert!((found - expected).abs() < 2e-3 * v0, "{found} against {expected}");
        while run.state.time < 0.5 {
            run.step();
        }
        let speed = run.state.velocity(0).norm();
        assert!(speed < 1e-5, "{speed}");
        let path = run.state.position(0).x;
        let expected = 0.5 * v0 * v0 / (5.0 / 7.0 * 0.1 * G);
        assert!((path / expected - 1.0).abs() < 5e-3, "{path} against {expected}");
        let lost = run.state.balance.dissipated_friction + run.state.balance.dissipated_dashpot;
        let kinetic = 0.7 * run.model.mass(0) * v0 * v0;
        assert!((lost / kinetic - 1.0).abs() < 1e-2, "{lost} against {kinetic}");
    }
}

/// Rest below tan α = μᵣ; above, 5/7 g (sin α − μᵣ cos α).
#[test]
fn ball_rolls_above_critical_slope() {
    for hertz in [false, true] {
        for slope in [0.095, 0.105, 0.2] {
            let mut run = on_plane(hertz, slope, 0.0, Vec3::zeros());
            while run.state.time < 0.4 {
                run.step();
            }
            let found = run.state.velocity(0).x;
            let expected = 5.0 / 7.0 * G / (1.0 + slope * slope).sqrt() * (slope - 0.1) * run.state.time;
            if slope < 0.1 {
                assert!(found.abs() < 1e-5, "{found}");
            } else {
                let free = 5.0 / 7.0 * G * slope * run.state.time;
                assert!((found - expected).abs() < 3e-3 * free, "slope {slope}: {found} against {expected}");
            }
        }
    }
}

/// Stops after 2/5 r ω/(μₜ g).
#[test]
fn twisting_ball_stops() {
    for hertz in [false, true] {
        let omega = 30.0;
        let mut run = on_plane(hertz, 0.0, 0.0, Vec3::new(0.0, 0.0, omega));
        let time = 0.4 * 0.01 * omega / (0.05 * G);
        while run.state.time < 0.5 * time {
            run.step();
        }
        let half = run.state.spin(0).z / omega;
        assert!((half - 0.5).abs() < 2e-3, "{half}");
        while run.state.time < 1.1 * time {
            run.step();
        }
        assert!(run.state.spin(0).norm() < 1e-2 * omega, "{}", run.state.spin(0));
    }
}

#[test]
fn no_resistance_without_coefficients() {
    let mut input = weightless(Material { friction: 0.8, ..stone() });
    input.gravity = Vec3::new(0.0, 0.0, -G);
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    let mut body = sphere(Vec3::new(0.0, 0.0, 0.01), Vec3::new(0.2, 0.0, 0.0));
    body.spin = Vec3::new(0.0, 20.0, 5.0);
    input.bodies.push(body);
    let mut run = Run::new(input);
    while run.state.time < 0.2 {
        run.step();
    }
    assert!((run.state.velocity(0).x - 0.2).abs() < 1e-3);
    assert_eq!(run.state.spin(0).z, 5.0);
}
