//! Boxes on boxes: face springs, sliding, tipping, collisions.

use crate::scene::{Random, Run, body, plane, rigid, stone, weightless};
use nalgebra::UnitQuaternion;
use trackbed_dem::measure;
use trackbed_dem::{BodyInput, Material, ModelInput, Shape, TimeStep, Vec3};

const G: f64 = 9.81;

/// Contact stiffness of two equal materials [N/m].
const K: f64 = 1e6;

fn material() -> Material {
    Material { stiffness: K, tangential_damping_ratio: 1.0, ..stone() }
}

fn boxes(material: Material, halves: &[[f64; 3]]) -> ModelInput {
    let mut input = weightless(material);
    input.shapes = halves.iter().map(|half| Shape::Box { half: *half }).collect();
    input.time_step = TimeStep::Auto { fraction: 0.5 };
    input
}

fn fixed(shape: usize, position: Vec3) -> BodyInput {
    BodyInput { fixed: [true; 6], ..body(shape, position) }
}

fn rest(run: &mut Run, seconds: f64) {
    while run.state.time < seconds {
        run.step();
    }
    let moving = measure::energies(&run.model, &run.state).kinetic();
    assert!(moving < 1e-9, "kinetic energy {moving}");
}

#[test]
fn faces_carry_four_springs_however_turned() {
    let cases = [
        ([0.1, 0.1, 0.05], [0.1, 0.1, 0.05], 0.0, 0.0, 4.0),
        ([0.1, 0.1, 0.05], [0.1, 0.1, 0.05], 45.0, 0.0, 4.0),
        ([0.3, 0.05, 0.05], [0.3, 0.05, 0.05], 90.0, 0.0, 4.0),
        ([0.3, 0.3, 0.05], [0.1, 0.1, 0.05], 17.0, 0.02, 4.0),
    ];
    for (lower, upper, turn, aside, springs) in cases {
        let mut input = boxes(material(), &[lower, upper]);
        input.gravity = Vec3::new(0.0, 0.0, -G);
        input.bodies.push(fixed(0, Vec3::zeros()));
        let orientation = UnitQuaternion::from_axis_angle(&Vec3::z_axis(), f64::to_radians(turn));
        let position = Vec3::new(aside, 0.0, lower[2] + upper[2]);
        input.bodies.push(BodyInput { orientation, ..body(1, position) });
        let mut run = Run::new(input);
        rest(&mut run, 0.6);
        let weight = run.model.mass(1) * G;
        let sunk = position.z - run.state.position(1).z;
        let expected = weight / (springs * K);
        assert!((sunk / expected - 1.0).abs() < 1e-6, "turned by {turn}: {sunk:e} for {expected:e}");
        let carried: f64 = measure::contacts(&run.model, &run.state).iter().map(|c| c.force.z.abs()).sum();
        assert!((carried / weight - 1.0).abs() < 1e-6, "turned by {turn}: {carried} of {weight}");
    }
}

#[test]
fn a_column_stands() {
    let half = [0.1, 0.08, 0.05];
    let mut input = boxes(material(), &[half]);
    input.gravity = Vec3::new(0.0, 0.0, -G);
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    for k in 0..4 {
        input.bodies.push(body(0, Vec3::new(1e-3 * f64::from(k % 2), 0.0, 0.05 + 0.1 * f64::from(k))));
    }
    let mut run = Run::new(input);
    rest(&mut run, 1.0);
    let weight = run.model.mass(0) * G;
    let mut joints = [0.0; 4];
    for c in measure::contacts(&run.model, &run.state) {
        let k = (c.point.z / 0.1).round() as usize;
        joints[k] += c.normal_force;
    }
    for (k, found) in joints.into_iter().enumerate() {
        let expected = weight * (4 - k) as f64;
        assert!((found / expected - 1.0).abs() < 1e-4, "joint {k}: {found} for {expected}");
    }
}

#[test]
fn a_block_slides_on_a_block() {
    let (angle, mu) = (0.5_f64, 0.3);
    let mut input = boxes(Material { friction: mu, ..material() }, &[[2.0, 0.3, 0.05], [0.05, 0.05, 0.02]]);
    input.gravity = Vec3::new(G * angle.sin(), 0.0, -G * angle.cos());
    input.bodies.push(fixed(0, Vec3::zeros()));
    let mass = 2600.0 * 8.0 * 0.05 * 0.05 * 0.02;
    let sink = mass * -input.gravity.z / (4.0 * K);
    input.bodies.push(body(1, Vec3::new(-1.0, 0.0, 0.07 - sink)));
    let mut run = Run::new(input);
    while run.state.time < 0.5 {
        run.step();
    }
    let speed = run.state.velocity(1).x;
    let expected = G * (angle.sin() - mu * angle.cos()) * run.state.time;
    assert!((speed / expected - 1.0).abs() < 2e-3, "{speed} for {expected}");
    assert!(run.state.spin(1).norm() < 1e-2, "{}", run.state.spin(1).norm());
}

#[test]
fn block_tips_at_its_diagonal() {
    for (slope, tips) in [(0.48, false), (0.52, true)] {
        let (sine, cosine) = f64::atan(slope).sin_cos();
        let mut input = boxes(
            Material { friction: 2.0, stiffness: 1e8, ..material() },
            &[[0.5, 0.5, 0.05], [0.05, 0.05, 0.1]],
        );
        input.gravity = Vec3::new(G * sine, 0.0, -G * cosine);
        input.bodies.push(fixed(0, Vec3::zeros()));
        input.bodies.push(body(1, Vec3::new(0.0, 0.0, 0.15)));
        let mut run = Run::new(input);
        while run.state.time < 0.5 {
            run.step();
        }
        let turned = run.state.orientation(&run.model, 1).angle();
        assert_eq!(turned > 0.05, tips, "slope {slope}: turned by {turned}");
    }
}

/// Momentum to rounding. The stiffness jumps when the deepest axis changes from a face to edges: at overlaps
/// of 2 % of the sides, one collision in twenty changes its energy by more than 2 %.
#[test]
fn collisions_keep_momentum_and_energy() {
    let mut random = Random::new(5);
    let mut unit = || random.unit();
    let ideal = Material { friction: 0.0, restitution: 1.0, tangential_ratio: 0.0, ..material() };
    let (mut worst, mut sum, mut touched, mut large) = (0.0_f64, 0.0, 0, 0);
    for _ in 0..200 {
        let mut input = boxes(ideal, &[[0.03, 0.04, 0.05], [0.05, 0.02, 0.04]]);
        input.time_step = TimeStep::Auto { fraction: 0.1 };
        for (shape, side) in [(0, -1.0), (1, 1.0)] {
            let axis = Vec3::new(unit() - 0.5, unit() - 0.5, unit() - 0.5);
            let orientation = UnitQuaternion::from_scaled_axis(axis * 6.0);
            let aside = Vec3::new(0.0, 0.04 * (unit() - 0.5), 0.04 * (unit() - 0.5));
            let position = Vec3::x() * (0.075 * side) + aside;
            let spin = Vec3::new(unit() - 0.5, unit() - 0.5, unit() - 0.5) * 10.0;
            input.bodies.push(BodyInput {
                orientation,
                spin,
                velocity: Vec3::x() * (-0.5 * side),
                ..body(shape, position)
            });
        }
        let mut run = Run::new(input);
        let before = measure::energies(&run.model, &run.state).total();
        let momentum = measure::momentum(&run.model, &run.state);
        let mut contact = false;
        while run.state.time < 0.12 {
            run.step();
            contact |= run.work.contact_force(&run.state, 0).norm() > 0.0;
        }
        let after = measure::momentum(&run.model, &run.state);
        assert!((after.linear - momentum.linear).norm() < 1e-12 * run.model.mass(0));
        assert!((after.angular - momentum.angular).norm() < 1e-12 * run.model.mass(0));
        let change = measure::energies(&run.model, &run.state).total() / before - 1.0;
        touched += i32::from(contact);
        large += i32::from(change.abs() > 0.02);
        worst = worst.max(change.abs());
        sum += change;
    }
    println!("{touched} collisions, {large} above 2 %: worst {worst:e}, mean {:e}", sum / f64::from(touched));
    assert!(touched > 150, "{touched}");
    let mean = sum / f64::from(touched);
    assert!(large <= 12 && worst < 0.2 && mean.abs() < 0.005, "{large} {worst:e} {mean:e}");
}

#[test]
fn two_rigid_boxes_are_refused() {
    let mut input = boxes(rigid(material()), &[[0.1, 0.1, 0.1]]);
    input.bodies.push(body(0, Vec3::zeros()));
    input.bodies.push(body(0, Vec3::x()));
    assert!(trackbed_dem::Model::new(input).unwrap_err().to_string().contains("body 1"));
}

/// Rotated by 45°, eight points of half a spring. On a slope of 1 in 20 the springs store ½ F²/(4 Kₜ), to 2
/// %.
#[test]
fn shared_spring_energy_matches_closed_form() {
    let mut input = boxes(material(), &[[0.1, 0.1, 0.05], [0.1, 0.1, 0.05]]);
    input.gravity = Vec3::new(0.05 * G, 0.0, -G);
    input.bodies.push(fixed(0, Vec3::zeros()));
    let mass = 2600.0 * 8.0 * 0.1 * 0.1 * 0.05;
    let orientation = UnitQuaternion::from_axis_angle(&Vec3::z_axis(), f64::to_radians(45.0));
    input.bodies.push(BodyInput { orientation, ..body(1, Vec3::z() * (0.1 - mass * G / (4.0 * K))) });
    let mut run = Run::new(input);
    rest(&mut run, 0.6);
    let held = measure::energies(&run.model, &run.state).elastic_tangential;
    let exact = 0.5 * (0.05 * mass * G).powi(2) / (4.0 * 0.5 * K);
    assert!((held / exact - 1.0).abs() < 0.02, "{held:e} against {exact:e}");
}
