//! Floating walls against hydrostatics, linear wave theory and steady states.

use crate::scene::{Run, cuboid, free, stone, weightless};
use crate::water::still;
use std::f64::consts::{PI, TAU};
use trackbed_dem::{
    BodyForce, BodyWater, Measured, Model, ModelInput, Mount, Propulsion, RigidBody, Rudder, TimeStep, Vec3,
    WallInput, WallShape, Water, Wave, measure,
};

const G: f64 = 9.81;
const DENSITY: f64 = 1000.0;
/// Length, beam, depth, draught of a box barge [m].
const LENGTH: f64 = 20.0;
const BEAM: f64 = 8.0;
const DEPTH: f64 = 3.0;
const DRAUGHT: f64 = 1.2;
const MASS: f64 = DENSITY * LENGTH * BEAM * DRAUGHT;

fn ideal() -> BodyWater {
    BodyWater {
        drag: Vec3::zeros(),
        skin_drag: 0.0,
        drag_moment: Vec3::zeros(),
        added_mass: Vec3::zeros(),
        added_inertia: Vec3::zeros(),
        damping_ratio: Vec3::zeros(),
    }
}

/// Barge at its draught, raised by `lift` [m], centre of mass `kg` above the keel [m].
fn barge(kg: f64, lift: f64, water: BodyWater) -> (WallShape, RigidBody) {
    let keel = lift - DRAUGHT;
    let shape = cuboid(Vec3::z() * (keel + 0.5 * DEPTH), Vec3::new(LENGTH, BEAM, DEPTH) * 0.5);
    let body = RigidBody { water: Some(water), centre: Some(Vec3::z() * (keel + kg)), ..free(MASS) };
    (shape, body)
}

fn afloat((shape, body): (WallShape, RigidBody), water: Water, dt: f64) -> Run {
    let input = ModelInput {
        gravity: Vec3::z() * -G,
        body_forces: vec![BodyForce::Water(water)],
        time_step: TimeStep::FixedAboveLimit(dt),
        walls: vec![WallInput { body: Some(body), ..WallInput::fixed(shape, 0) }],
        ..weightless(stone())
    };
    Run::new(input)
}

/// Mean period of a signal, from its rising zeros.
fn period(run: &mut Run, dt: f64, end: f64, signal: impl Fn(&Run) -> f64) -> f64 {
    let mut zeros = Vec::new();
    let mut last = signal(run);
    for n in 1..=(end / dt) as usize {
        run.step();
        let next = signal(run);
        if last < 0.0 && next >= 0.0 {
            zeros.push((n as f64 - next / (next - last)) * dt);
        }
        last = next;
    }
    (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64
}

fn roll(run: &Run) -> f64 {
    let up = run.state.wall_orientation(0) * Vec3::y();
    up.z.atan2(up.y)
}

#[test]
fn draught_matches_archimedes() {
    for lift in [0.4, -0.5] {
        let damped = BodyWater { damping_ratio: Vec3::new(0.7, 0.7, 0.7), ..ideal() };
        let mut run = afloat(barge(1.0, lift, damped), still(DENSITY), 5e-3);
        run.until(60.0);
        let draught = DRAUGHT - lift - run.state.wall_offset(0).z;
        println!("draught off by {:.1e} m", draught - DRAUGHT);
        assert!((draught - DRAUGHT).abs() < 1e-6, "{draught}");
        assert!(roll(&run).abs() < 1e-9);
    }
}

#[test]
fn heave_period_matches_closed_form() {
    for added in [0.0, 0.8] {
        let water = BodyWater { added_mass: Vec3::z() * added, ..ideal() };
        let dt = 2e-3;
        let mut run = afloat(barge(1.0, 0.01, water), still(DENSITY), dt);
        let found = period(&mut run, dt, 40.0, |run| run.state.wall_offset(0).z + 0.01);
        let exact = TAU * (MASS * (1.0 + added) / (DENSITY * G * LENGTH * BEAM)).sqrt();
        println!("heave period off by {:.1e}", found / exact - 1.0);
        // Added mass follows the wet volume: 0.01/1.2 at most.
        assert!((found / exact - 1.0).abs() < 1e-4, "{found} s, expected {exact} s");
    }
}

#[test]
fn heave_decays_by_its_ratio() {
    let zeta = 0.05;
    let water = BodyWater { damping_ratio: Vec3::x() * zeta, ..ideal() };
    let mut run = afloat(barge(1.0, 0.1, water), still(DENSITY), 2e-3);
    let (omega, end) = ((G / DRAUGHT).sqrt(), 10.0);
    let mut largest = [0.0_f64; 2];
    for n in 0..(end / 2e-3) as usize {
        run.step();
        let height = (run.state.wall_offset(0).z + 0.1).abs();
        let late = n as f64 * 2e-3;
        let scaled = height * (zeta * omega * late).exp();
        largest[usize::from(late > 0.5 * end)] = largest[usize::from(late > 0.5 * end)].max(scaled);
    }
    assert!((largest[1] / largest[0] - 1.0).abs() < 0.01, "{largest:?}");
}

/// Barrass & Derrett 2012: GM = KB + I/∇ − KG.
#[test]
fn roll_period_matches_closed_form() {
    for (kg, added) in [(1.0, 0.0), (2.0, 0.3)] {
        let water = BodyWater { added_inertia: Vec3::x() * added, ..ideal() };
        let (shape, body) = barge(kg, 0.0, water);
        let inertia = MASS / 12.0 * (BEAM * BEAM + DEPTH * DEPTH) + MASS * (kg - 0.5 * DEPTH).powi(2);
        let gm = 0.5 * DRAUGHT + BEAM * BEAM / (12.0 * DRAUGHT) - kg;
        let exact = TAU * (inertia * (1.0 + added) / (MASS * G * gm)).sqrt();
        let start = RigidBody { spin: Vec3::x() * (0.01 * TAU / exact), ..body };
        let dt = 2e-3;
        let mut run = afloat((shape, start), still(DENSITY), dt);
        let found = period(&mut run, dt, 8.0 * exact, roll);
        println!("roll period off by {:.1e}", found / exact - 1.0);
        assert!((found / exact - 1.0).abs() < 1e-3, "{found} s, expected {exact} s");
    }
}

/// Wall-sided formula: with GM < 0 the barge rests at tan φ = √(−2 GM/BM) (Barrass & Derrett 2012).
#[test]
fn unstable_barge_lolls() {
    let bm = BEAM * BEAM / (12.0 * DRAUGHT);
    for gm in [0.3, -0.1] {
        let kg = 0.5 * DRAUGHT + bm - gm;
        let water = BodyWater { drag_moment: Vec3::x() * 0.5, ..ideal() };
        let (shape, body) = barge(kg, 0.0, water);
        let start = RigidBody { spin: Vec3::x() * 0.02, ..body };
        let mut run = afloat((shape, start), still(DENSITY), 5e-3);
        let mut last = [0.0_f64; 2];
        for _ in 0..120_000 {
            run.step();
            if run.state.time > 500.0 {
                last = [last[0] + roll(&run), last[1] + 1.0];
            }
        }
        let found = last[0] / last[1];
        let exact = if gm < 0.0 { (-2.0 * gm / bm).sqrt().atan() } else { 0.0 };
        println!("loll {found:.5} rad of {exact:.5} rad");
        assert!((found.abs() - exact).abs() < 0.01 * exact.max(0.1), "{found} rad, expected {exact} rad");
    }
}

#[test]
fn top_heavy_barge_capsizes() {
    for (kg, upright) in [(3.0, true), (8.0, false)] {
        let (shape, body) = barge(kg, 0.0, BodyWater { drag_moment: Vec3::x() * 0.1, ..ideal() });
        let inertia = MASS / 12.0 * Vec3::new(73.0, 409.0, 464.0);
        let body = RigidBody { inertia: Some([inertia.x, inertia.y, inertia.z, 0.0, 0.0, 0.0]), ..body };
        let mut run = afloat((shape, RigidBody { spin: Vec3::x() * 0.02, ..body }), still(DENSITY), 5e-3);
        let mut largest = 0.0_f64;
        while run.state.time < 40.0 {
            run.step();
            largest = largest.max(roll(&run).abs());
        }
        assert_eq!(largest < 0.1, upright, "{largest} rad with KG = {kg} m");
        assert!(upright || largest > 0.5 * PI, "{largest} rad");
    }
}

/// In a wave 60 hulls long, heave follows the surface and pitch its slope.
#[test]
fn hull_follows_long_waves() {
    let (height, length) = (4.0, 60.0 * LENGTH);
    let wave = Wave::new(height, Measured::Length(length), 0.0, 0.0, f64::INFINITY, [0.0; 2], G).unwrap();
    let water = BodyWater {
        damping_ratio: Vec3::repeat(0.5),
        drag: Vec3::repeat(1.0),
        drag_moment: Vec3::repeat(0.1),
        ..ideal()
    };
    let (shape, body) = barge(1.0, 0.5 * height, water);
    let mut run = afloat((shape, body), Water { wave: Some(wave), ..still(DENSITY) }, 5e-3);
    let span = TAU / wave.frequency;
    let (mut heave, mut pitch) = (0.0_f64, 0.0_f64);
    while run.state.time < 4.0 * span {
        run.step();
        if run.state.time > 2.0 * span {
            let offset = run.state.wall_offset(0);
            let surface = wave.at(offset.x, 0.0, 0.0, run.state.time).elevation;
            let ahead = wave.at(offset.x + 1.0, 0.0, 0.0, run.state.time).elevation;
            heave = heave.max((offset.z + 0.5 * height - surface).abs());
            let bow = run.state.wall_orientation(0) * Vec3::x();
            pitch = pitch.max((bow.z / bow.x - (ahead - surface)).abs());
        }
    }
    let slope = PI * height / length;
    println!("heave {heave:.2e} m of {}, pitch {pitch:.2e} of {slope:.2e}", 0.5 * height);
    assert!(heave < 0.01 * height, "{heave} m from the surface");
    assert!(pitch < 0.02 * slope, "{pitch} from a slope of {slope}");
}

fn driven(thrust: f64, rudder: Option<Rudder>) -> Propulsion {
    Propulsion {
        point: Vec3::new(-0.5 * LENGTH, 0.0, -0.5 * DRAUGHT),
        direction: Vec3::x(),
        thrust: vec![[0.0, thrust]],
        diameter: 0.0,
        rudder,
    }
}

#[test]
fn thrust_balances_drag() {
    let thrust = 20e3;
    let drag = Vec3::new(0.4, 1.0, 1.0);
    let water = BodyWater { drag, skin_drag: 0.004, added_mass: Vec3::x() * 0.1, ..ideal() };
    let (shape, body) = barge(1.0, 0.0, water);
    let area = 0.4 * BEAM * DRAUGHT + 0.004 * (LENGTH * BEAM + 2.0 * (LENGTH + BEAM) * DRAUGHT);
    let exact = (2.0 * thrust / (DENSITY * area)).sqrt();
    let hold = [false, true, true, true, true, true];
    let body = RigidBody { propulsion: Some(driven(thrust, None)), fixed: hold, ..body };
    let current = [-0.7, 0.0];
    let mut run = afloat((shape, body), Water { current, ..still(DENSITY) }, 0.02);
    let time = MASS * 1.1 * exact / thrust;
    run.until(0.5 * time);
    // Relative to the current v = v∞ tanh(t/t∞ + c), initially 0.7 m/s; velocities are half a step old.
    let found = run.state.wall_velocity(0).0.x + 0.7;
    let early = exact * ((run.state.time - 0.01) / time + (0.7 / exact).atanh()).tanh();
    assert!((found / early - 1.0).abs() < 1e-3, "{found} m/s, expected {early} m/s");
    run.until(12.0 * time);
    let speed = run.state.wall_velocity(0).0.x + 0.7;
    println!("speed off by {:.1e}", speed / exact - 1.0);
    assert!((speed / exact - 1.0).abs() < 1e-6, "{speed} m/s, expected {exact} m/s");
    let load = run.state.water_load(&run.model, 0).expect("a body in water");
    assert_eq!(load.thrust, [thrust; 2]);
    assert!((load.force.x / thrust + 1.0).abs() < 1e-6, "{}", load.force);
}

fn rudder(angle: f64) -> Rudder {
    let point = Vec3::new(-0.5 * LENGTH, 0.0, -0.5 * DRAUGHT);
    Rudder { point, area: 2.0, aspect_ratio: 1.5, angle: vec![[0.0, angle]] }
}

/// Slope of the normal force of [`rudder`] (Fujii & Tuda 1961).
const SLOPE: f64 = 6.13 * 1.5 / (1.5 + 2.25);

/// A held barge in a current: normal force, to starboard at the stern for an angle to port; with the race of
/// the propeller.
#[test]
fn rudder_force_matches_fujii() {
    let (angle, current) = (0.3_f64, 2.0);
    for (thrust, diameter) in [(0.0, 0.0), (30e3, 1.5)] {
        let (shape, body) = barge(1.0, 0.0, ideal());
        let propulsion = Propulsion { diameter, ..driven(thrust, Some(rudder(angle))) };
        let body = RigidBody { propulsion: Some(propulsion), fixed: [true; 6], ..body };
        let mut run = afloat((shape, body), Water { current: [-current, 0.0], ..still(DENSITY) }, 0.01);
        run.step();
        let load = run.state.water_load(&run.model, 0).expect("a body in water");
        let disc = PI * 1.5 * 1.5 / 4.0;
        let speed = (current * current + 2.0 * thrust / (DENSITY * disc)).sqrt();
        let normal = 0.5 * DENSITY * 2.0 * SLOPE * speed * speed * angle.sin();
        let exact = Vec3::new(-angle.sin(), -angle.cos(), 0.0) * normal;
        assert!((load.rudder - exact).norm() < 1e-9 * normal, "{} for {exact}", load.rudder);
        assert_eq!(load.angle, angle);
    }
}

/// Thrust and rudder out of the water have no force.
#[test]
fn dry_propeller_has_no_force() {
    let (shape, body) = barge(1.0, 1.0, ideal());
    let point = Vec3::new(-0.5 * LENGTH, 0.0, 0.4);
    let dry = Propulsion { point, ..driven(1e3, Some(Rudder { point, ..rudder(0.2) })) };
    let body = RigidBody { propulsion: Some(dry), fixed: [true; 6], ..body };
    let run = afloat((shape, body), Water { current: [-1.0, 0.0], ..still(DENSITY) }, 0.01);
    let load = run.state.water_load(&run.model, 0).expect("a body in water");
    assert_eq!((load.thrust, load.rudder), ([1e3, 0.0], Vec3::zeros()));
}

/// Only free to yaw: the moments of rudder and water are equal.
#[test]
fn yaw_rate_balances_rudder() {
    let (angle, coefficient) = (0.25_f64, 0.2);
    let water = BodyWater { drag_moment: Vec3::z() * coefficient, ..ideal() };
    let (shape, body) = barge(1.0, 0.0, water);
    let hold = [true, true, true, true, true, false];
    let race = Propulsion { diameter: 1.0, ..driven(50e3, Some(rudder(angle))) };
    let body = RigidBody { propulsion: Some(race), fixed: hold, ..body };
    let mut run = afloat((shape, body), still(DENSITY), 0.02);
    run.until(600.0);
    let rate = run.state.wall_velocity(0).1.z;
    let wet = LENGTH * BEAM + 2.0 * (LENGTH + BEAM) * DRAUGHT;
    let lever = (LENGTH.powi(2) + BEAM.powi(2)).sqrt() / 2.0;
    let brake = |r: f64| 0.5 * DENSITY * coefficient * lever.powi(3) * wet * r * r;
    let race = (2.0 * 50e3 / (DENSITY * PI / 4.0)).sqrt();
    let turn = |r: f64| {
        // Inflow: race astern, stern swinging to starboard at r L/2.
        let (u, v) = (-race, r * 0.5 * LENGTH);
        let normal = u * angle.sin() + v * angle.cos();
        let force = 0.5 * DENSITY * 2.0 * SLOPE * (u * u + v * v).sqrt() * normal;
        -force * angle.cos() * 0.5 * LENGTH
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if turn(middle) > brake(middle) { low = middle } else { high = middle }
    }
    println!("yaw rate off by {:.1e}", rate / low - 1.0);
    assert!((rate / low - 1.0).abs() < 1e-3, "{rate} rad/s, expected {low} rad/s");
}

/// Moored: the spring moves the added mass too.
#[test]
fn surge_period_on_a_mount() {
    let (stiffness, added) = (2e5, 0.5);
    let water = BodyWater { added_mass: Vec3::x() * added, ..ideal() };
    let (shape, body) = barge(1.0, 0.0, water);
    let mount = Mount { stiffness: Vec3::x() * stiffness, damping: Vec3::zeros() };
    let body = RigidBody { mount: Some(mount), velocity: Vec3::x() * 0.1, ..body };
    let dt = 5e-3;
    let mut run = afloat((shape, body), still(DENSITY), dt);
    let exact = TAU * (MASS * (1.0 + added) / stiffness).sqrt();
    let found = period(&mut run, dt, 4.5 * exact, |run| run.state.wall_offset(0).x);
    assert!((found / exact - 1.0).abs() < 1e-4, "{found} s, expected {exact} s");
}

/// Energy and momentum of a barge that drifts, turns, rolls in waves.
#[test]
fn balances_close_in_waves() {
    let wave = Wave::new(0.6, Measured::Length(35.0), 0.7, 0.3, 20.0, [0.0; 2], G).unwrap();
    let water = BodyWater {
        drag: Vec3::new(0.3, 1.0, 1.0),
        skin_drag: 0.003,
        drag_moment: Vec3::repeat(0.1),
        added_mass: Vec3::new(0.1, 0.6, 0.9),
        added_inertia: Vec3::new(0.2, 0.5, 0.3),
        damping_ratio: Vec3::repeat(0.05),
    };
    let mut errors = Vec::new();
    for dt in [8e-3, 4e-3] {
        let (shape, body) = barge(1.2, 0.3, water);
        let propulsion = Some(driven(20e3, Some(rudder(0.3))));
        let body = RigidBody { propulsion, spin: Vec3::new(0.05, 0.02, 0.01), ..body };
        let mut run = afloat((shape, body), Water { wave: Some(wave), ..still(DENSITY) }, dt);
        let energy = |run: &Run| measure::energies(&run.model, &run.state).total() - run.state.balance.work();
        let first = energy(&run);
        let start = measure::momentum(&run.model, &run.state);
        let mut worst = 0.0_f64;
        while run.state.time < 10.0 {
            run.step();
            worst = worst.max((energy(&run) - first).abs());
        }
        let end = measure::momentum(&run.model, &run.state);
        let impulse = run.state.balance.impulse();
        let linear = (end.linear - start.linear - impulse.linear).norm();
        assert!(linear < 1e-9 * MASS, "{linear} N s");
        errors.push(worst / (MASS * G * 0.3));
    }
    println!("energy errors {errors:?}");
    assert!(errors[0] < 1e-3, "{errors:?}");
}

#[test]
fn rejects_open_surfaces() {
    let (shape, body) = barge(1.0, 0.0, ideal());
    let WallShape::Triangles { vertices, mut triangles } = shape else { unreachable!() };
    triangles.pop();
    let inertia = Some([1e6, 1e6, 1e6, 0.0, 0.0, 0.0]);
    let body = RigidBody { inertia, ..body };
    let shape = WallShape::Triangles { vertices, triangles };
    let refused = Model::new(ModelInput {
        gravity: Vec3::z() * -G,
        body_forces: vec![BodyForce::Water(still(DENSITY))],
        walls: vec![WallInput { body: Some(body), ..WallInput::fixed(shape, 0) }],
        ..weightless(stone())
    });
    let message = refused.expect_err("an open surface").to_string();
    assert!(message.contains("must be closed to float"), "{message}");
}
