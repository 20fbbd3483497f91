//! Blocks against external tables (`tests/data/kinetics`, each row by two methods); tower: Housner, Bull.
//! Seism. Soc. Am. 53, 1963, 403-417.

use crate::scene::{FOLLOWED, Run, block, plane, stone, weightless};
use crate::tables::read;
use nalgebra::{Quaternion, UnitQuaternion};
use std::f64::consts::{FRAC_PI_2, PI};
use trackbed_dem::{BodyInput, Material, ModelInput, Shape, TimeStep, Vec3};

const G: f64 = 9.81;
const DOWN: Vec3 = Vec3::new(0.0, 0.0, -G);

fn scene(material: Material, shape: Shape) -> ModelInput {
    ModelInput {
        shapes: vec![shape],
        time_step: TimeStep::Auto { fraction: 0.1 },
        planes: vec![plane(Vec3::zeros(), Vec3::z())],
        ..weightless(material)
    }
}

fn material() -> Material {
    Material { stiffness: 1e8, tangential_damping_ratio: 1.0, ..stone() }
}

fn turn(q: &[f64]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3]))
}

fn vector(row: &[f64]) -> Vec3 {
    Vec3::new(row[0], row[1], row[2])
}

#[test]
fn boxes_turn_freely() {
    for (name, bound) in
        [("general", 1e-4), ("near_smallest", 1e-4), ("near_largest", 1e-4), ("near_intermediate", 1e-2)]
    {
        let rows = read(&format!("tests/data/kinetics/torque_free_{name}.csv"));
        let error = |dt: f64| {
            let mut input =
                scene(Material { density: 1000.0, ..material() }, block([0.17, 0.12, 0.06], 0.02));
            (input.planes, input.time_step) = (Vec::new(), TimeStep::FixedAboveLimit(dt));
            let orientation = turn(&rows[0][4..8]);
            input.bodies.push(BodyInput {
                orientation,
                spin: orientation * vector(&rows[0][1..4]),
                ..BodyInput::default()
            });
            let mut run = Run::new(input);
            assert!((run.model.mass(0) - 9.56235981727112).abs() < 1e-9);
            let mut worst = 0.0_f64;
            for row in &rows[1..] {
                while run.state.steps_done() < (row[0] / dt).round() as u64 {
                    run.step();
                }
                worst = worst.max(run.state.orientation(&run.model, 0).angle_to(&turn(&row[4..8])));
            }
            worst
        };
        let (coarse, fine) = (error(2e-4), error(1e-4));
        println!("{name}: turned {coarse:.2e}, {fine:.2e} rad off after 20 s");
        assert!(fine < bound && (3.5..4.5).contains(&(coarse / fine)), "{name}: {coarse:e} {fine:e}");
    }
}

/// Lowest core corner of a table cube, from its centre.
fn lowest(orientation: &UnitQuaternion<f64>) -> Vec3 {
    let corners =
        (0..8).map(|k| orientation * Vec3::from_fn(|d, _| if k >> d & 1 == 1 { 0.045 } else { -0.045 }));
    corners.min_by(|a, b| a.z.total_cmp(&b.z)).expect("eight corners")
}

fn cube(material: Material, orientation: UnitQuaternion<f64>, velocity: Vec3, spin: Vec3) -> Run {
    let mut input = scene(material, block([0.05; 3], 0.005));
    input.time_step = TimeStep::Auto { fraction: 0.01 };
    let position = Vec3::z() * (0.005 - lowest(&orientation).z + 1e-9);
    input.bodies.push(BodyInput { position, orientation, velocity, spin, ..BodyInput::default() });
    let mut run = Run::new(input);
    assert!((run.model.mass(0) - 2.58369630788706).abs() < 1e-9);
    run.until(8.0 / material.stiffness.sqrt());
    run
}

/// Relative error of velocity and of angular velocity times side.
fn off(run: &Run, velocity: Vec3, spin: Vec3, speed: f64) -> f64 {
    let (v, w) = (run.state.velocity(0) - velocity, run.state.spin(0) - spin);
    v.amax().max(0.1 * w.amax()) / speed
}

/// Restitution of a spring and non-pulling dashpot, ζ < 1/√2 (Schwager and Pöschel, Granul. Matter 9, 2007,
/// 465-469).
fn clipped(zeta: f64) -> f64 {
    let omega = (1.0 - zeta * zeta).sqrt();
    (-(zeta / omega) * (PI - (2.0 * zeta * omega / (omega * omega - zeta * zeta)).atan())).exp()
}

/// The dashpot is sized for the total mass; a corner acts with m' (table), so its ratio is higher by √(m/m').
#[test]
fn a_corner_on_a_plane() {
    let (mass, moment) = (2.58369630788706, 0.00427278112039847);
    for (stiffness, bounds) in [(1e8, [0.02, 0.02]), (1e10, [0.002, 0.002])] {
        let mut worst = [0.0_f64; 2];
        for row in &read("tests/data/kinetics/oblique_impact_corner.csv") {
            let (velocity, spin) = (vector(&row[6..9]), vector(&row[9..12]));
            let smooth = Material {
                friction: 0.0,
                restitution: row[1],
                tangential_ratio: 0.0,
                stiffness,
                ..material()
            };
            let run = cube(smooth, turn(&row[2..6]), velocity, spin);
            let lever = lowest(&turn(&row[2..6])) - Vec3::z() * 0.005;
            let (mut low, mut high) = (0.0, 0.7);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if clipped(middle) > row[1] { low = middle } else { high = middle }
            }
            let rebound = if row[1] < 1.0 { clipped(low / row[12].sqrt()) } else { 1.0 };
            let impulse = -(1.0 + rebound) * (velocity + spin.cross(&lever)).z * row[12] * mass;
            let push = Vec3::z() * impulse;
            let after = [velocity + push / mass, spin + lever.cross(&push) / moment];
            if row[1] == 1.0 {
                assert!(
                    (after[0] - vector(&row[15..18])).norm() < 1e-9
                        && (after[1] - vector(&row[18..21])).norm() < 1e-7
                );
            }
            let off = off(&run, after[0], after[1], velocity.norm());
            let damped = usize::from(row[1] < 1.0);
            worst[damped] = worst[damped].max(off);
        }
        println!("K = {stiffness:e}: elastic {:.1e}, damped {:.1e} of the speed", worst[0], worst[1]);
        assert!(worst[0] < bounds[0] && worst[1] < bounds[1], "{stiffness:e}: {worst:?}");
    }
}

#[test]
fn an_edge_slides_on_a_plane() {
    let rows = read("tests/data/kinetics/oblique_impact_edge_friction.csv");
    for (stiffness, bound) in [(1e8, 0.02), (1e10, 0.002)] {
        let (mut worst, mut work) = (0.0_f64, 0.0_f64);
        for row in &rows {
            let rough = Material {
                friction: row[1],
                restitution: 1.0,
                tangential_damping_ratio: 0.0,
                stiffness,
                ..material()
            };
            let (velocity, spin) = (Vec3::new(row[3], 0.0, row[4]), Vec3::y() * row[5]);
            let run = cube(rough, UnitQuaternion::from_axis_angle(&Vec3::y_axis(), row[2]), velocity, spin);
            let after = Vec3::new(row[6], 0.0, row[7]);
            worst = worst.max(off(&run, after, Vec3::y() * row[8], velocity.norm()));
            let moving = 0.5 * 2.58369630788706 * velocity.norm_squared()
                + 0.5 * 0.00427278112039847 * row[5] * row[5];
            work = work.max((run.state.balance.dissipated() / moving - row[10]).abs());
        }
        println!("K = {stiffness:e}: {worst:.1e} of the speed, work of friction {work:.1e} of the energy");
        assert!(worst < bound && work < bound, "{stiffness:e}: {worst:e} {work:e}");
    }
}

/// Sliding distance v²/(2 μ g).
#[test]
fn a_block_slides_to_a_stop() {
    for row in read("tests/data/kinetics/sliding_stop.csv") {
        let mut input = scene(
            Material { friction: row[0], stiffness: 1e6, ..material() },
            block([0.1, 0.08, 0.02], 0.005),
        );
        (input.gravity, input.time_step) = (DOWN, FOLLOWED);
        let velocity = Vec3::x() * row[1];
        input.bodies.push(BodyInput { position: Vec3::z() * 0.02, velocity, ..BodyInput::default() });
        let mut run = Run::new(input);
        run.until(row[3] + 0.1);
        let way = run.state.position(0).x;
        println!("μ = {}: {way:.6} m of {:.6}", row[0], row[2]);
        assert!(
            (way / row[2] - 1.0).abs() < 0.005 && run.state.velocity(0).norm() < 1e-3,
            "{way} {}",
            row[2]
        );
    }
}

#[test]
fn stacks_that_lean_out() {
    for (row, cubes) in read("tests/data/kinetics/stack_overhang.csv").iter().zip(2..) {
        let limit = row.iter().find(|v| v.is_finite()).expect("a limit");
        for (share, falls) in [(0.97, false), (1.03, true)] {
            let firm = Material { restitution: 0.1, stiffness: 2e6, ..material() };
            let mut input = scene(firm, block([0.05; 3], 0.005));
            (input.gravity, input.time_step) = (DOWN, FOLLOWED);
            for k in 0..cubes {
                let position = Vec3::new(share * limit * f64::from(k), 0.0, 0.05 + 0.1 * f64::from(k));
                input.bodies.push(BodyInput { position, ..BodyInput::default() });
            }
            let mut run = Run::new(input);
            let sunk = |run: &Run| 0.1 * f64::from(cubes) - 0.05 - run.state.position(cubes as usize - 1).z;
            while run.state.time < 1.5 && sunk(&run) < 0.02 {
                run.follow();
            }
            let (sunk, time) = (sunk(&run), run.state.time);
            println!(
                "{cubes} cubes at {share} of the limit: the top has sunk by {:.3} mm after {time:.2} s",
                1e3 * sunk
            );
            assert_eq!(sunk > 0.02, falls, "{cubes} cubes, {share}: {sunk}");
            assert!(falls || sunk < 1e-4, "{cubes} cubes, {share}: {sunk}");
        }
    }
}

fn leaning(size: [f64; 3], radius: f64, tilt: f64, stiffness: f64) -> ModelInput {
    let [width, height, depth] = size.map(|s| 0.5 * s);
    let firm = Material { friction: 2.0, restitution: 0.05, stiffness, ..material() };
    let mut input = scene(firm, block([height, depth, width], radius));
    (input.gravity, input.time_step) = (DOWN, FOLLOWED);
    let lean = UnitQuaternion::from_axis_angle(&Vec3::y_axis(), tilt);
    // Axis of the rounded edge in the body frame.
    let edge = Vec3::new(width - radius, 0.0, radius - height);
    let position = Vec3::z() * radius - lean * edge;
    let orientation = lean * UnitQuaternion::from_axis_angle(&Vec3::y_axis(), FRAC_PI_2);
    input.bodies.push(BodyInput { position, orientation, ..BodyInput::default() });
    input
}

/// Tilt towards x [rad].
fn lean(run: &Run) -> f64 {
    let up = run.state.orientation(&run.model, 0) * -Vec3::x();
    up.x.atan2(up.z)
}

/// Released from a tilt: time to flat, and angular velocity.
#[test]
fn blocks_rock() {
    for row in read("tests/data/kinetics/rocking.csv").iter().filter(|row| row[3] > 0.0) {
        let mut run = Run::new(leaning([row[0], row[1], row[2]], row[3], row[4], 1e7));
        let (mut before, mut spin) = (row[4], 0.0_f64);
        loop {
            let now = lean(&run);
            if now < 0.0 || run.state.time > 1.0 {
                let time = run.state.time - run.state.dt() * now / (now - before);
                println!(
                    "r = {}, {:.3} rad: {time:.5} s of {:.5}, {spin:.4} of {:.4} rad/s",
                    row[3], row[4], row[5], row[6]
                );
                assert!((time / row[5] - 1.0).abs() < 0.01, "{time} {}", row[5]);
                assert!((spin / row[6] - 1.0).abs() < 0.01, "{spin} {}", row[6]);
                break;
            }
            (before, spin) = (now, spin.max(run.state.spin(0).norm()));
            run.follow();
        }
    }
}

/// Falls after a floor acceleration a for a time t if cosh(pt) > 1 + 1/(2β(β − 1)) (Housner 1963, equation
/// 8); with rounded edges, centre h/2 above the floor and b from the flat's end: β = a h/(2gb), p² = g(h/2 −
/// r)/(i² + b² + h²/4).
#[test]
fn a_tower_on_a_shaking_floor() {
    let (width, height, radius): (f64, f64, f64) = (0.1, 1.0, 0.01);
    let (flat, middle) = (0.5 * width - radius, 0.5 * height);
    let gyration = (width * width + height * height) / 12.0;
    let p = (G * (middle - radius) / (gyration + flat * flat + middle * middle)).sqrt();
    let falling = flat / (middle - radius);
    for beta in [1.5_f64, 4.0] {
        let acceleration = beta * G * flat / middle;
        let limit = (1.0 + 0.5 / (beta * (beta - 1.0))).acosh() / p;
        let largest = |share: f64| {
            let mut run = Run::new(leaning([width, height, 0.2], radius, 0.0, 1e8));
            run.follow_until(0.05);
            let begun = run.state.time;
            let (mut leans, mut before) = (0.0_f64, 0.0);
            loop {
                let pushed = (run.state.time - begun).min(share * limit);
                run.state.set_plane_velocity(0, Vec3::x() * (acceleration * pushed));
                run.follow();
                let now = lean(&run).abs();
                leans = leans.max(now);
                if now > 0.6 || (pushed == share * limit && now < before && now < 0.5 * falling) {
                    return leans;
                }
                before = now;
                assert!(run.state.time < 10.0, "it stands on its edge: {now}");
            }
        };
        let [stands, falls] = [0.97, 1.03].map(largest);
        println!(
            "{acceleration:.2} m/s² for {limit:.3} s: it leans by {stands:.4} rad at 0.97 of that, {falls:.2} at 1.03"
        );
        assert!(stands < falling && falls > 0.6, "{beta}: {stands} {falls}");
    }
}
