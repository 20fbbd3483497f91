//! Oscillating, rotating and servo-controlled walls.

use crate::scene::{Random, Run, clump, plane, sphere, stone, weightless};
use trackbed_dem::{
    BodyInput, Material, ModelInput, Motion, Oscillation, Servo, Shape, TimeStep, Vec3, WallInput, WallShape,
    measure,
};

/// Grains in an open box.
pub fn heap(count: usize, width: f64, material: Material) -> ModelInput {
    let mut random = Random::new(9);
    let mut input = ModelInput {
        gravity: Vec3::new(0.0, 0.0, -9.81),
        time_step: TimeStep::Auto { fraction: 0.3 },
        ..weightless(material)
    };
    let n = (width / 0.022) as usize;
    for k in 0..count {
        let cell = Vec3::new((k % n) as f64, (k / n % n) as f64, (k / n / n) as f64);
        let position = (cell + Vec3::repeat(0.55)) * (width / n as f64) + random.vector() * 5e-4;
        input.bodies.push(BodyInput { scale: 0.9 + 0.1 * random.unit(), ..sphere(position, Vec3::zeros()) });
    }
    for d in [Vec3::x(), Vec3::y()] {
        input.planes.extend([plane(Vec3::zeros(), d), plane(d * width, -d)]);
    }
    input
}

/// Two triangles at height `z`.
pub fn square(width: f64, z: f64) -> WallShape {
    let (a, b) = (-0.1 * width, 1.1 * width);
    WallShape::Triangles {
        vertices: [[a, a], [b, a], [b, b], [a, b]].map(|[x, y]| Vec3::new(x, y, z)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

#[test]
fn stirred_heap_balances() {
    let run = |fraction: f64| {
        let mut input = heap(60, 0.09, Material { restitution: 0.7, ..stone() });
        input.shapes.push(Shape::Clump(clump()));
        input.bodies.push(BodyInput {
            shape: 1,
            position: Vec3::new(0.04, 0.05, 0.15),
            ..BodyInput::default()
        });
        input.time_step = TimeStep::Auto { fraction };
        let swing = Oscillation { amplitude: Vec3::new(0.0, 3e-4, 1e-3), frequency: 25.0, phase: 0.4 };
        let table = Motion { oscillation: Some(swing), ..Motion::default() };
        input.walls.push(WallInput { motion: table, ..WallInput::fixed(square(0.09, 0.0), 0) });
        let paddle = WallShape::Triangles {
            vertices: vec![
                Vec3::new(0.02, 0.045, 0.02),
                Vec3::new(0.07, 0.045, 0.02),
                Vec3::new(0.07, 0.045, 0.06),
                Vec3::new(0.02, 0.045, 0.06),
            ],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        };
        let turning = Motion {
            velocity: Vec3::new(0.01, 0.0, 0.02),
            angular_velocity: Vec3::new(0.3, 0.2, 4.0),
            centre: Some(Vec3::new(0.045, 0.045, 0.04)),
            oscillation: None,
        };
        input.walls.push(WallInput { motion: turning, ..WallInput::fixed(paddle, 0) });
        let mut run = Run::new(input);
        let total = |run: &Run| {
            measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated()
                - run.state.balance.work()
        };
        let (start, before) = (total(&run), measure::momentum(&run.model, &run.state));
        let mut worst = 0.0_f64;
        while run.state.time < 0.5 {
            run.step();
            worst = worst.max((total(&run) - start).abs());
        }
        let t = run.state.time;
        let place = swing.at(t);
        assert!((run.state.wall_offset(0) - place).norm() < 1e-15, "{}", run.state.wall_offset(0));
        assert!((run.state.wall_offset(1) - turning.velocity * t).norm() < 1e-12);
        let tip = run.state.wall_point(&run.model, 1, &Vec3::new(0.07, 0.045, 0.06));
        let turn = nalgebra::UnitQuaternion::from_scaled_axis(turning.angular_velocity * t);
        let exact = turn * Vec3::new(0.025, 0.0, 0.02) + Vec3::new(0.045, 0.045, 0.04) + turning.velocity * t;
        assert!((tip - exact).norm() < 1e-12, "{tip} {exact}");
        let change = measure::momentum(&run.model, &run.state);
        let impulse = run.state.balance.impulse();
        assert!((change.linear - before.linear - impulse.linear).norm() < 1e-12);
        assert!((change.angular - before.angular - impulse.angular).norm() < 1e-12);
        let work = run.state.balance.work_walls;
        assert!(work > 1e-3, "the walls must do work: {work}");
        (worst, work + run.state.balance.dissipated())
    };
    let ((coarse, turnover), (fine, _)) = (run(0.4), run(0.1));
    eprintln!("energy error {coarse:e} and {fine:e} J of {turnover:e} J");
    assert!(coarse < 2e-2 * turnover && fine < 0.25 * coarse, "{coarse:e} {fine:e} {turnover:e}");
}

/// After a preload of 5 kPa it holds 1 kPa within 1 % at every step.
#[test]
fn servo_holds_its_pressure() {
    let width = 0.09;
    let area = width * width;
    for triangles in [false, true] {
        let mut input = heap(48, width, Material { restitution: 0.3, ..stone() });
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        let shape = if triangles {
            square(width, 0.09)
        } else {
            WallShape::Plane { point: Vec3::new(0.0, 0.0, 0.09), normal: -Vec3::z() }
        };
        let force = vec![[0.0, 5e3 * area], [0.5, 5e3 * area], [0.55, 1e3 * area]];
        let servo = Servo { direction: -Vec3::z(), force, max_speed: 0.2, gain: 0.5, driven: None };
        input.walls.push(WallInput { servo: Some(servo), ..WallInput::fixed(shape, 0) });
        let mut run = Run::new(input);
        let total = |run: &Run| {
            measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated()
                - run.state.balance.work()
        };
        let start = total(&run);
        let mut worst = 0.0_f64;
        while run.state.time < 1.05 {
            run.step();
            let t = run.state.time;
            if t > 0.9 {
                let pressure = run.state.wall_force(0).0.z / area;
                worst = worst.max((pressure / 1e3 - 1.0).abs());
            }
        }
        eprintln!("largest deviation of the pressure {:.4} %", 100.0 * worst);
        assert!(worst < 0.01, "{worst}");
        let balance = &run.state.balance;
        assert!(balance.work_servo > 1e-3 && balance.work_walls == 0.0, "{balance:?}");
        let error = (total(&run) - start).abs();
        assert!(error < 0.02 * balance.work_servo, "{error:e} of {:e}", balance.work_servo);
    }
}

/// Table acceleration below gravity. Energy error ~ dt².
#[test]
fn ball_rides_a_swinging_table() {
    let error = |fraction: f64| {
        let mut input = weightless(Material { restitution: 0.8, ..stone() });
        input.gravity = Vec3::new(0.0, 0.0, -9.81);
        input.time_step = TimeStep::Auto { fraction };
        let swing = Oscillation { amplitude: Vec3::z() * 1e-4, frequency: 20.0, phase: -1.5 };
        let motion = Motion { oscillation: Some(swing), ..Motion::default() };
        let shape = WallShape::Plane { point: Vec3::zeros(), normal: Vec3::z() };
        input.walls.push(WallInput { motion, ..WallInput::fixed(shape, 0) });
        input.bodies.push(sphere(Vec3::new(0.0, 0.0, 0.01 - 1e-6), Vec3::zeros()));
        let mut run = Run::new(input);
        let total = |run: &Run| {
            measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated()
                - run.state.balance.work()
        };
        while run.state.time < 0.1 {
            run.step();
        }
        let start = total(&run);
        let mut worst = 0.0_f64;
        while run.state.time < 0.2 {
            run.step();
            worst = worst.max((total(&run) - start).abs());
        }
        worst
    };
    let (coarse, fine) = (error(0.4), error(0.1));
    eprintln!("energy error {coarse:e} and {fine:e} J");
    assert!(fine < coarse / 8.0, "{coarse:e} {fine:e}");
}

/// Springs are capped by friction.
#[test]
fn sliding_gate_stores_no_spring_energy() {
    for friction in [0.0, 0.3] {
        let mut input = heap(1, 0.09, Material { friction, ..stone() });
        let motion = Motion { velocity: Vec3::new(-3.0, 0.0, 0.0), ..Motion::default() };
        input.walls.push(WallInput { motion, ..WallInput::fixed(square(1.0, 0.0), 0) });
        let mut run = Run::new(input);
        let total = |run: &Run| {
            measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated()
                - run.state.balance.work()
        };
        let (start, mut most, mut worst) = (total(&run), 0.0_f64, 0.0_f64);
        while run.state.time < 0.05 {
            run.step();
            most = most.max(measure::energies(&run.model, &run.state).elastic_tangential);
            worst = worst.max((total(&run) - start).abs());
        }
        let turned = run.state.balance.dissipated();
        println!("friction {friction}: {most:.3e} J in springs, error {worst:.3e} of {turned:.3e} J");
        assert!(turned > 0.0, "the grain has met nothing");
        assert!(friction > 0.0 || most == 0.0, "{most} J in springs without friction");
        assert!(worst < 5e-3 * turned, "{worst} J of {turned} J with a friction of {friction}");
    }
}
