//! Dilated disks: rest, stacks, impacts, rolling, coin wobble, flotation.

use crate::scene::{FOLLOWED, Random, Run, body, plane, stone, weightless};
use crate::tables::read;
use nalgebra::{Quaternion, UnitQuaternion};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::{BodyForce, DragArea, Water, measure};
use trackbed_dem::{BodyInput, Material, ModelInput, Shape, TimeStep, Vec3};

const G: f64 = 9.81;
const DOWN: Vec3 = Vec3::new(0.0, 0.0, -G);

/// Contact stiffness of two equal materials [N/m].
const K: f64 = 1e6;

fn material() -> Material {
    Material { stiffness: K, tangential_damping_ratio: 1.0, ..stone() }
}

fn elastic() -> Material {
    Material { friction: 0.0, restitution: 1.0, tangential_ratio: 0.0, ..material() }
}

fn hertz(material: Material) -> Material {
    Material { young: Some(1e8), poisson: 0.3, stiffness: f64::INFINITY, ..material }
}

fn disk(radius: f64, rounding: f64) -> Shape {
    Shape::Polyhedron(Box::new(Dilated::disk(radius, rounding).expect("a disk")))
}

fn scene(material: Material, shapes: Vec<Shape>) -> ModelInput {
    ModelInput { shapes, time_step: TimeStep::Auto { fraction: 0.5 }, ..weightless(material) }
}

fn total(run: &Run) -> f64 {
    measure::energies(&run.model, &run.state).total()
}

/// Settles by weight over rim springs, or after Hertz by a quarter of the modulus per unit length.
#[test]
fn a_disk_at_rest() {
    let (big, r) = (0.1, 0.02);
    let modulus = 1e8 / (2.0 * (1.0 - 0.09));
    for (material, springs) in
        [(material(), TAU * big / (2.0 * r) * K), (hertz(material()), 0.25 * modulus * TAU * big)]
    {
        let mut input = scene(material, vec![disk(big, r)]);
        input.gravity = DOWN;
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        input.bodies.push(body(0, Vec3::new(0.3, -0.2, r)));
        let mut run = Run::new(input);
        run.until(1.0);
        let weight = run.model.mass(0) * G;
        let sunk = r - run.state.position(0).z;
        assert!((sunk / (weight / springs) - 1.0).abs() < 1e-6, "{sunk}");
        assert!(run.state.velocity(0).norm() < 1e-9 && run.state.spin(0).norm() < 1e-9);
        let carried: f64 = measure::contacts(&run.model, &run.state).iter().map(|c| c.force.z).sum();
        assert!((carried / weight - 1.0).abs() < 1e-9, "{carried}");
    }
}

#[test]
fn ten_disks_stand() {
    let (big, r) = (0.1, 0.01);
    let mut input = scene(material(), vec![disk(big, r)]);
    (input.gravity, input.time_step) = (DOWN, FOLLOWED);
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    let mut random = Random::new(3);
    for k in 0..10 {
        let aside = 0.015 * random.vector();
        let scale = 0.9 + 0.1 * random.unit();
        let height = input.bodies.iter().map(|b| 2.0 * r * b.scale).sum::<f64>() + r * scale;
        let turn = UnitQuaternion::from_axis_angle(&Vec3::z_axis(), f64::from(k));
        let position = Vec3::new(aside.x, aside.y, height);
        input.bodies.push(BodyInput { orientation: turn, scale, ..body(0, position) });
    }
    let mut run = Run::new(input);
    run.follow_until(1.0);
    let before: Vec<Vec3> = (0..10).map(|b| run.state.position(b)).collect();
    run.follow_until(2.0);
    let drift = (0..10).map(|b| (run.state.position(b) - before[b]).norm()).fold(0.0, f64::max);
    let moving = measure::energies(&run.model, &run.state).kinetic();
    println!("kinetic energy after 2 s: {moving:.1e} J, drift in the last second {drift:.1e} m");
    assert!(moving < 1e-6 && drift < 2e-5, "{moving:e} {drift:e}");
    let weight = (0..10).map(|b| run.model.mass(b)).sum::<f64>() * G;
    let contacts = measure::contacts(&run.model, &run.state);
    let lowest: f64 = contacts.iter().filter(|c| c.point.z < 0.002).map(|c| c.force.z).sum();
    assert!((lowest / weight - 1.0).abs() < 1e-4, "{lowest} of {weight}");
}

#[test]
fn bounces_on_face_and_rim() {
    let turns = [
        ("face", UnitQuaternion::identity()),
        ("rim", UnitQuaternion::from_axis_angle(&Vec3::x_axis(), FRAC_PI_2)),
        ("askew", UnitQuaternion::from_axis_angle(&Vec3::x_axis(), 0.7)),
        ("nearly flat", UnitQuaternion::from_scaled_axis(Vec3::new(0.01, 0.02, 0.1))),
    ];
    for (restitution, wall) in [(1.0, false), (1.0, true), (0.5, false), (0.5, true)] {
        for (name, orientation) in turns {
            let shapes = vec![disk(0.05, 0.01), disk(0.2, 0.02)];
            let mut input = scene(Material { restitution, ..elastic() }, shapes);
            input.time_step = TimeStep::Auto { fraction: 0.1 };
            if wall {
                input.planes.push(plane(Vec3::zeros(), Vec3::z()));
            } else {
                input.bodies.push(BodyInput { fixed: [true; 6], ..body(1, Vec3::z() * -0.02) });
            }
            let number = input.bodies.len();
            let velocity = Vec3::new(0.0, 0.0, -0.5);
            input.bodies.push(BodyInput { orientation, velocity, ..body(0, Vec3::z() * 0.1) });
            let mut run = Run::new(input);
            let before = total(&run);
            run.until(0.35);
            let (after, speed) = (total(&run), run.state.velocity(number).z);
            println!("{name}, e = {restitution}: energy {:.2e}, speed {speed:.4}", after / before - 1.0);
            if restitution == 1.0 {
                assert!((after / before - 1.0).abs() < 6e-4, "{name}: {after} of {before}");
            } else if name == "face" || name == "rim" {
                assert!((speed - 0.25).abs() < 0.02, "{name}: {speed}");
            }
            assert!(speed > 0.02 || name == "askew" || name == "nearly flat", "{name}: {speed}");
        }
    }
}

fn stone_of(random: &mut Random, half: [f64; 3], radius: f64) -> Shape {
    let mut corner = || random.vector().normalize().component_mul(&Vec3::from(half));
    let corners: Vec<Vec3> = (0..14).map(|_| corner()).collect();
    Shape::Polyhedron(Box::new(Dilated::new(&corners, radius).expect("a convex body").0))
}

#[test]
fn collisions_keep_momentum_and_energy() {
    collisions([80, 40]);
}

#[test]
#[ignore = "minutes"]
fn many_collisions_keep_momentum_and_energy() {
    collisions([160, 60]);
}

/// Numbers of collisions without and with losses.
fn collisions([elastic_ones, damped]: [i32; 2]) {
    let springs = [(elastic(), elastic_ones, 2e-3), (material(), damped, 0.01)];
    let after_hertz = springs.map(|(m, count, bound)| (hertz(m), count / 2, bound));
    for (material, count, bound) in springs.into_iter().chain(after_hertz) {
        let mut random = Random::new(5);
        let (mut worst, mut sum, mut touched) = (0.0_f64, 0.0, 0);
        for k in 0..count {
            let other = match k % 4 {
                0 => Shape::Box { half: [0.03, 0.04, 0.05] },
                1 => Shape::Sphere { radius: 0.03 },
                2 => stone_of(&mut random, [0.05, 0.04, 0.03], 0.004),
                _ => disk(0.04, 0.01),
            };
            let mut input = scene(material, vec![disk(0.05, 0.006), other]);
            input.time_step = TimeStep::Auto { fraction: 0.1 };
            for (shape, side) in [(0, -1.0), (1, 1.0)] {
                let orientation = UnitQuaternion::from_scaled_axis(random.vector() * 3.0);
                let aside = random.vector() * 0.02;
                let position = Vec3::new(0.08 * side, aside.y, aside.z);
                let (spin, velocity) = (random.vector() * 5.0, Vec3::x() * (-0.5 * side));
                input.bodies.push(BodyInput { orientation, spin, velocity, ..body(shape, position) });
            }
            let mut run = Run::new(input);
            let before = total(&run);
            let momentum = measure::momentum(&run.model, &run.state);
            let mut contact = false;
            while run.state.time < 0.2 {
                run.step();
                contact |= run.work.contact_force(&run.state, 0).norm() > 0.0;
            }
            let after = measure::momentum(&run.model, &run.state);
            assert!((after.linear - momentum.linear).norm() < 1e-12 * run.model.mass(0));
            assert!((after.angular - momentum.angular).norm() < 1e-12 * run.model.mass(0));
            let change = (total(&run) + run.state.balance.dissipated()) / before - 1.0;
            touched += i32::from(contact);
            worst = worst.max(change.abs());
            sum += change;
        }
        let mean = sum / f64::from(touched);
        println!("{touched} collisions: worst {worst:.1e}, mean {mean:.1e}");
        assert!(touched > count * 7 / 10 && worst < bound && mean.abs() < 0.1 * bound, "{worst:e} {mean:e}");
    }
}

#[test]
fn disks_roll_down_an_incline() {
    for row in read("tests/data/disks/disk_incline.csv") {
        let [big, r, angle, acceleration] = row[..4].try_into().unwrap();
        let slope = f64::to_radians(angle);
        let mut input = scene(Material { friction: 0.8, ..material() }, vec![disk(big, r)]);
        input.gravity = Vec3::new(G * slope.sin(), 0.0, -G * slope.cos());
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        let orientation = UnitQuaternion::from_axis_angle(&Vec3::x_axis(), FRAC_PI_2);
        input.bodies.push(BodyInput { orientation, ..body(0, Vec3::z() * (big + r)) });
        let mut run = Run::new(input);
        run.until(0.1);
        let (from, start) = (run.state.velocity(0).x, run.state.time);
        run.until(0.5);
        let found = (run.state.velocity(0).x - from) / (run.state.time - start);
        println!("acceleration {found:.5} for {acceleration:.5}");
        assert!((found / acceleration - 1.0).abs() < 0.005, "{found} for {acceleration}");
        assert!((run.state.spin(0).norm() * (big + r) / run.state.velocity(0).x - 1.0).abs() < 0.01);
    }
}

/// Rolling constraint: error 1 % of the path after a second.
#[test]
fn a_leaning_disk_rolls_its_path() {
    let rows = read("tests/data/disks/disk_rolling.csv");
    let mut material = material();
    (material.density, material.friction, material.restitution) = (2500.0, 1.0, 0.5);
    let mut input = scene(material, vec![disk(0.05, 0.005)]);
    input.gravity = DOWN;
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    let v = |row: &[f64], k: usize| Vec3::new(row[k], row[k + 1], row[k + 2]);
    let first = &rows[0];
    let turn = Quaternion::new(first[4], first[5], first[6], first[7]);
    input.bodies.push(BodyInput {
        orientation: UnitQuaternion::from_quaternion(turn),
        velocity: v(first, 8),
        spin: v(first, 11),
        ..body(0, v(first, 1))
    });
    let mut run = Run::new(input);
    let (mut way, mut worst) = (0.0, 0.0_f64);
    for pair in rows.windows(2) {
        way += (v(&pair[1], 1) - v(&pair[0], 1)).norm();
        let early = 0.5 * run.state.dt();
        run.until(pair[1][0] - early);
        worst = worst.max((run.state.position(0) - v(&pair[1], 1)).norm());
    }
    println!("off by {:.2e} of {way:.3} m", worst / way);
    assert!(way > 1.0 && worst < 0.01 * way, "{worst} of {way}");
}

#[test]
fn coins_wobble_steadily() {
    for row in read("tests/data/disks/coin_steady.csv") {
        let [big, r, tilt, mass, axial, other, precession] = row[..7].try_into().unwrap();
        let tilt = f64::to_radians(tilt);
        let mut material = material();
        // Equal overlap for any mass.
        (material.density, material.friction, material.stiffness) = (2500.0, 1.0, 8e6 * mass);
        let mut input = scene(material, vec![disk(big, r)]);
        input.gravity = DOWN;
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        let spin = Vec3::new(row[8], row[9], row[10]);
        let orientation = UnitQuaternion::from_axis_angle(&Vec3::y_axis(), tilt);
        input.bodies.push(BodyInput { orientation, spin, ..body(0, Vec3::z() * row[11]) });
        let mut run = Run::new(input);
        assert!((run.model.mass(0) / mass - 1.0).abs() < 1e-9);
        assert!(axial > other);
        let (mut angle, mut worst) = (0.0, 0.0_f64);
        let normal = |run: &Run| run.state.orientation(&run.model, 0) * Vec3::z();
        let mut before = normal(&run);
        while run.state.time < 1.5 * TAU / precession {
            run.step();
            let now = normal(&run);
            angle += libm_angle(&before, &now);
            before = now;
            let lean = now.x.hypot(now.y).atan2(now.z);
            worst = worst.max((lean - tilt).abs());
        }
        let found = angle / run.state.time;
        println!(
            "tilt {:.1}°: precession {found:.3} for {precession:.3}, tilt off by {:.2e}",
            tilt.to_degrees(),
            worst / tilt
        );
        assert!((found / precession - 1.0).abs() < 0.02, "{found} for {precession}");
        assert!(worst < 0.02 * tilt, "{} {worst}", tilt);
    }
}

fn libm_angle(a: &Vec3, b: &Vec3) -> f64 {
    (a.x * b.y - a.y * b.x).atan2(a.x * b.x + a.y * b.y)
}

#[test]
fn a_heap_of_disks() {
    let mut random = Random::new(9);
    let shapes = vec![
        disk(0.035, 0.008),
        disk(0.045, 0.006),
        stone_of(&mut random, [0.05, 0.04, 0.03], 0.004),
        disk(0.03, 0.015),
        Shape::Sphere { radius: 0.03 },
    ];
    let mut input = scene(Material { stiffness: 5e4, ..material() }, shapes);
    input.gravity = DOWN;
    for (n, x) in [(Vec3::x(), -0.1), (-Vec3::x(), 0.1), (Vec3::y(), -0.1), (-Vec3::y(), 0.1)] {
        input.planes.push(plane(n.abs() * x, n));
    }
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    for k in 0..20_usize {
        let side = |bit: usize| if k >> bit & 1 == 0 { -0.045 } else { 0.045 };
        let position = Vec3::new(side(0), side(1), 0.06 + 0.1 * (k / 4) as f64);
        let orientation = UnitQuaternion::from_scaled_axis(random.vector() * 3.0);
        let scale = 0.7 + 0.3 * random.unit();
        input.bodies.push(BodyInput { orientation, scale, ..body(k % 5, position) });
    }
    let run_on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut run = Run::new(input.clone());
            let before = total(&run);
            run.until(0.4);
            let balance = run.state.balance;
            let error = (total(&run) - balance.work() + balance.dissipated() - before) / balance.dissipated();
            let places: Vec<[u64; 3]> =
                (0..20).map(|b| run.state.position(b).map(f64::to_bits).into()).collect();
            (places, error, balance.dissipated() / before)
        })
    };
    let (places, error, lost) = run_on(1);
    println!("account of energy off by {error:.1e} of what was dissipated, {lost:.2} of all");
    assert!(error.abs() < 2e-3 && lost > 0.4, "{error:e} {lost}");
    for threads in [2, 3, 7] {
        assert_eq!(places, run_on(threads).0, "{threads} threads");
    }
}

/// Round floe, radii 1 m and 0.2 m, with its density ratio.
const BIG: f64 = 1.0;
const SMALL: f64 = 0.2;
const RATIO: f64 = 0.8927;

fn slice(z: f64) -> f64 {
    BIG + (SMALL * SMALL - z * z).max(0.0).sqrt()
}

fn waterline(volume: f64) -> f64 {
    let below = |z: f64| -> f64 {
        let n = 20_000;
        let angle = (z / SMALL).asin() + FRAC_PI_2;
        let thin = |k: i32| {
            let at = -FRAC_PI_2 + angle * (f64::from(k) + 0.5) / f64::from(n);
            PI * slice(SMALL * at.sin()).powi(2) * SMALL * at.cos()
        };
        (0..n).map(thin).sum::<f64>() * angle / f64::from(n)
    };
    let (mut low, mut high) = (-SMALL, SMALL);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if below(middle) < RATIO * volume { low = middle } else { high = middle }
    }
    low
}

fn afloat(added: f64, position: Vec3, orientation: UnitQuaternion<f64>, dt: f64) -> Run {
    let water = Water {
        level: 0.0,
        density: 1025.0,
        current: [0.0; 2],
        wave: None,
        drag: 0.0,
        drag_area: DragArea::Projected,
        skin_drag: 0.0,
        drag_moment: 0.0,
        added_mass: added,
    };
    let mut material = stone();
    material.density = RATIO * 1025.0;
    Run::new(ModelInput {
        materials: vec![material],
        shapes: vec![disk(BIG, SMALL)],
        bodies: vec![BodyInput {
            position,
            orientation,
            velocity: Vec3::z() * (-0.5 * G * dt),
            ..BodyInput::default()
        }],
        gravity: DOWN,
        body_forces: vec![BodyForce::Water(water)],
        time_step: TimeStep::FixedAboveLimit(dt),
        ..ModelInput::default()
    })
}

fn swing(run: &mut Run, steps: u32, dt: f64, signal: impl Fn(&Run) -> f64) -> (f64, f64) {
    let (mut sum, mut zeros, mut before) = (0.0, Vec::new(), signal(run));
    for step in 0..steps {
        run.step();
        let now = signal(run);
        if before * now < 0.0 {
            zeros.push(f64::from(step) - now / (now - before));
        }
        (before, sum) = (now, sum + now);
    }
    let period = 2.0 * dt * (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64;
    (sum / f64::from(steps), period)
}

#[test]
fn pancakes_float_heave_and_roll() {
    let (added, dt) = (0.5, 1e-3);
    let own = Dilated::disk(BIG, SMALL).expect("a disk");
    let level = waterline(own.volume);
    let draft = level + SMALL;
    let place = Vec3::z() * -level;
    let displaced = RATIO * own.volume * 1025.0;
    let start = place + Vec3::z() * (0.01 * draft);
    let mut run = afloat(added, start, UnitQuaternion::identity(), dt);
    let (mean, found) = swing(&mut run, 40_000, dt, |run| run.state.position(0).z - place.z);
    assert!(mean.abs() < 1e-3 * draft, "{mean}");
    let stiffness = 1025.0 * G * PI * slice(level).powi(2);
    let period = TAU * ((1.0 + added) * displaced / stiffness).sqrt();
    println!("draft {:.5} m, heave {found:.4} s for {period:.4} s", draft - mean);
    assert!((found / period - 1.0).abs() < 0.01, "{found} for {period}");
    let n = 20_000;
    let at = |k: i32| -SMALL + draft * (f64::from(k) + 0.5) / f64::from(n);
    let moment: f64 = (0..n).map(at).map(|z| z * PI * slice(z).powi(2)).sum::<f64>() * draft / f64::from(n);
    let height = (0.25 * PI * slice(level).powi(4) + moment) / (RATIO * own.volume);
    let period = TAU * (own.inertia[0] * RATIO * 1025.0 / (displaced * G * height)).sqrt();
    let mut run = afloat(0.0, place, UnitQuaternion::from_axis_angle(&Vec3::x_axis(), 0.002), dt);
    let (_, found) = swing(&mut run, 20_000, dt, |run| run.state.orientation(&run.model, 0).imag().x);
    println!("roll {found:.4} s for {period:.4} s");
    assert!((found / period - 1.0).abs() < 0.01, "{found} for {period}");
}
