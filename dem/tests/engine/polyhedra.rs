//! Dilated polyhedra: rest, sliding, tipping, bouncing, collisions.

use crate::scene::{FOLLOWED, Random, Run, block, body, plane, stone, weightless};
use crate::tables::read;
use nalgebra::UnitQuaternion;
use std::f64::consts::PI;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::{BodyInput, Material, Model, ModelInput, Shape, TimeStep, Vec3};
use trackbed_dem::{flow, measure};

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

fn hertz() -> Material {
    Material { young: Some(1e9), poisson: 0.3, stiffness: f64::INFINITY, ..material() }
}

/// Effective modulus of two equal bodies [Pa].
const MODULUS: f64 = 1e9 / (2.0 * (1.0 - 0.09));

fn laws() -> [(&'static str, Material); 2] {
    let smooth = Material { friction: 0.0, restitution: 1.0, ..hertz() };
    [("springs", elastic()), ("Hertz", Material { young: Some(1e8), ..smooth })]
}

fn polyhedron(corners: &[Vec3], radius: f64) -> Shape {
    Shape::Polyhedron(Box::new(Dilated::new(corners, radius).expect("a convex body").0))
}

/// Random points on an ellipsoid.
fn stone_of(random: &mut Random, corners: usize, half: [f64; 3], radius: f64) -> Shape {
    let mut corner = || random.vector().normalize().component_mul(&Vec3::from(half));
    polyhedron(&(0..corners).map(|_| corner()).collect::<Vec<_>>(), radius)
}

fn scene(material: Material, shapes: Vec<Shape>) -> ModelInput {
    ModelInput { shapes, time_step: TimeStep::Auto { fraction: 0.5 }, ..weightless(material) }
}

fn total(run: &Run) -> f64 {
    measure::energies(&run.model, &run.state).total()
}

#[test]
fn loops_name_the_shapes() {
    let shapes = vec![Shape::Sphere { radius: 0.1 }, block([0.1; 3], 0.01)];
    let loops = |bodies: Vec<BodyInput>| {
        let input = ModelInput { bodies, ..scene(material(), shapes.clone()) };
        measure::kernels(&Model::new(input).expect("a good input"))
    };
    let far = |k| body(k, Vec3::x() * k as f64);
    assert!(loops(vec![far(0), far(1)]).contains(", polyhedra, single spheres,"));
    assert!(loops(vec![far(1)]).contains(", polyhedra,") && !loops(vec![far(1)]).contains("spheres"));
    assert!(loops(vec![far(0)]).contains(", single spheres,") && !loops(vec![far(0)]).contains("poly"));
}

/// Settlement: weight over springs of four corners and four edges.
#[test]
fn a_cube_at_rest() {
    let (half, radius) = (0.1, 0.01);
    let mut input = scene(material(), vec![block([half; 3], radius)]);
    input.gravity = DOWN;
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    input.bodies.push(body(0, Vec3::new(0.3, -0.2, half)));
    let mut run = Run::new(input);
    run.until(1.0);
    let springs = 4.0 + 4.0 * (2.0 * (half - radius)) / (2.0 * radius);
    let weight = run.model.mass(0) * G;
    let sunk = half - run.state.position(0).z;
    // Ends of the upright edges bear a little.
    let share = sunk / (weight / (springs * K));
    assert!((share - 1.0).abs() < 1e-3, "{share}");
    assert!(run.state.velocity(0).norm() < 1e-9 && run.state.spin(0).norm() < 1e-9);
    let carried: f64 = measure::contacts(&run.model, &run.state).iter().map(|c| c.force.z).sum();
    assert!((carried / weight - 1.0).abs() < 1e-9, "{carried}");
}

/// Offset and rotated cubes for ten seconds; stiff contacts barely damp the swaying.
#[test]
fn ten_cubes_stand() {
    let half = 0.05;
    let mut input = scene(material(), vec![block([half; 3], 0.005)]);
    (input.gravity, input.time_step) = (DOWN, FOLLOWED);
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    let mut random = Random::new(3);
    for k in 0..10 {
        let aside = 0.01 * random.vector();
        let turn = UnitQuaternion::from_axis_angle(&Vec3::z_axis(), 0.3 * aside.z / 0.01);
        let position = Vec3::new(aside.x, aside.y, half + 2.0 * half * f64::from(k));
        input.bodies.push(BodyInput { orientation: turn, ..body(0, position) });
    }
    let mut run = Run::new(input);
    run.follow_until(5.0);
    let before: Vec<Vec3> = (0..10).map(|b| run.state.position(b)).collect();
    let moving = measure::energies(&run.model, &run.state).kinetic();
    run.follow_until(10.0);
    let drift = (0..10).map(|b| (run.state.position(b) - before[b]).norm()).fold(0.0, f64::max);
    let still = measure::energies(&run.model, &run.state).kinetic();
    println!("kinetic energy after 5 and 10 s: {moving:.1e} J, {still:.1e} J; drift between {drift:.1e} m");
    assert!(moving < 1e-5 && still < 1e-5 && drift < 5e-5, "{still:e} {drift:e}");
    let weight = 10.0 * run.model.mass(0) * G;
    let contacts = measure::contacts(&run.model, &run.state);
    let lowest: f64 = contacts.iter().filter(|c| c.point.z < 0.01).map(|c| c.force.z).sum();
    assert!((lowest / weight - 1.0).abs() < 1e-4, "{lowest} of {weight}");
}

#[test]
fn round_plates_on_a_slope() {
    let corner = |k: u32| {
        let (s, c) = (std::f64::consts::TAU * f64::from(k % 12) / 12.0).sin_cos();
        Vec3::new(0.1 * c, 0.1 * s, if k < 12 { -0.01 } else { 0.01 })
    };
    let plate = polyhedron(&(0..24).map(corner).collect::<Vec<_>>(), 0.005);
    let mut input = scene(material(), vec![plate]);
    let slope = 0.8 * input.materials[0].friction.atan();
    input.gravity = Vec3::new(G * slope.sin(), 0.0, -G * slope.cos());
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    for k in 0..3 {
        input.bodies.push(body(0, Vec3::z() * (0.015 + 0.03 * f64::from(k))));
    }
    let mut run = Run::new(input);
    run.until(0.4);
    let before = run.state.position(2);
    run.until(0.6);
    let (weight, drift) = (run.model.mass(0) * G, (run.state.position(2) - before).norm());
    let contacts = measure::contacts(&run.model, &run.state);
    for joint in 0..3 {
        let there = |z: f64| (z - 0.03 * f64::from(joint)).abs() < 0.01;
        let forces: Vec<Vec3> = contacts.iter().filter(|c| there(c.point.z)).map(|c| c.force).collect();
        let carried =
            forces.iter().map(|f| f.z.abs()).sum::<f64>() / (f64::from(3 - joint) * weight * slope.cos());
        let held =
            forces.iter().map(|f| f.x.abs()).sum::<f64>() / (f64::from(3 - joint) * weight * slope.sin());
        println!("joint {joint}: {} points carry {carried}, hold {held}", forces.len());
        assert!(forces.len() >= 24, "{}", forces.len());
        assert!((carried - 1.0).abs() < 1e-3 && (held - 1.0).abs() < 1e-2, "{carried} {held}");
    }
    assert!(drift < 1e-6, "{drift:e}");
}

/// Slides with g (sin α − μ cos α); tips above 1/2 for a height of twice the flat base.
#[test]
fn a_block_on_an_incline() {
    let mu = 0.4;
    for (slope, slides) in [(0.39, false), (0.41, true)] {
        let (sine, cosine) = f64::atan(slope).sin_cos();
        let mut input =
            scene(Material { friction: mu, ..material() }, vec![block([0.06, 0.05, 0.02], 0.004)]);
        input.gravity = Vec3::new(G * sine, 0.0, -G * cosine);
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        input.bodies.push(body(0, Vec3::new(0.0, 0.0, 0.02)));
        let mut run = Run::new(input);
        run.until(0.5);
        let (speed, from) = (run.state.velocity(0).x, run.state.time);
        run.until(1.0);
        let found = (run.state.velocity(0).x - speed) / (run.state.time - from);
        let expected = if slides { G * (sine - mu * cosine) } else { 0.0 };
        assert!((found - expected).abs() < 5e-3 * G * 0.01 + 1e-9, "{slope}: {found} for {expected}");
        assert_eq!(run.state.velocity(0).x > 1e-3, slides);
    }
    let radius = 0.01;
    // The flat face ends at the rounding: tan α = (w/2 − r)/(h/2).
    let limit = (0.05 - radius) / 0.1;
    for (slope, tips) in [(limit - 0.02, false), (limit + 0.02, true)] {
        let (sine, cosine) = f64::atan(slope).sin_cos();
        let sticky = Material { friction: 2.0, stiffness: 1e8, ..material() };
        let mut input = scene(sticky, vec![block([0.1, 0.05, 0.05], radius)]);
        input.gravity = Vec3::new(G * sine, 0.0, -G * cosine);
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        let upright = UnitQuaternion::from_axis_angle(&Vec3::y_axis(), std::f64::consts::FRAC_PI_2);
        input.bodies.push(BodyInput { orientation: upright, ..body(0, Vec3::new(0.0, 0.0, 0.1)) });
        let mut run = Run::new(input);
        run.until(0.6);
        let turned = run.state.orientation(&run.model, 0).angle_to(&upright);
        assert_eq!(turned > 0.05, tips, "slope {slope}: turned by {turned}");
    }
}

#[test]
fn bounces_on_face_edge_and_corner() {
    let half = 0.05;
    let diagonal = UnitQuaternion::rotation_between(&Vec3::repeat(1.0), &Vec3::z()).expect("not opposite");
    let turns = [
        ("face", UnitQuaternion::identity()),
        ("edge", UnitQuaternion::from_axis_angle(&Vec3::x_axis(), std::f64::consts::FRAC_PI_4)),
        ("corner", diagonal),
        ("askew", UnitQuaternion::from_scaled_axis(Vec3::new(0.3, 0.2, 0.1))),
    ];
    let all = laws().map(|law| [(1.0, false), (1.0, true), (0.5, false)].map(|(e, wall)| (law, e, wall)));
    for ((law, elastic), restitution, wall) in all.into_iter().flatten() {
        for (name, orientation) in turns {
            let shapes = vec![block([half; 3], 0.01), block([0.2, 0.2, 0.05], 0.01)];
            let mut input = scene(Material { restitution, ..elastic }, shapes);
            input.time_step = TimeStep::Auto { fraction: 0.1 };
            if wall {
                input.planes.push(plane(Vec3::zeros(), Vec3::z()));
            } else {
                input.bodies.push(BodyInput { fixed: [true; 6], ..body(1, Vec3::z() * -0.05) });
            }
            let number = input.bodies.len();
            let velocity = Vec3::new(0.0, 0.0, -0.5);
            input.bodies.push(BodyInput { orientation, velocity, ..body(0, Vec3::z() * 0.1) });
            let mut run = Run::new(input);
            let before = total(&run);
            run.until(0.3);
            let (after, speed) = (total(&run), run.state.velocity(number).z);
            println!(
                "{law}, {name}, e = {restitution}: energy {:.2e}, speed {speed:.4}",
                after / before - 1.0
            );
            if restitution == 1.0 {
                assert!((after / before - 1.0).abs() < 1e-4, "{law}, {name}: {after} of {before}");
            } else if name == "face" {
                assert!((speed - 0.25).abs() < 0.01, "{law}: {speed}");
            }
            assert!(speed > 0.05 || name == "askew", "{name}: {speed}");
        }
    }
}

#[test]
fn collisions_keep_momentum_and_energy() {
    for (name, elastic) in laws() {
        collisions(name, elastic);
    }
}

fn collisions(name: &str, elastic: Material) {
    let mut random = Random::new(5);
    let (mut worst, mut sum, mut touched) = (0.0_f64, 0.0, 0);
    for k in 0..200 {
        let mut shapes = vec![
            stone_of(&mut random, 8 + k % 17, [0.05, 0.04, 0.03], 0.004),
            block([0.03, 0.04, 0.05], 0.006),
        ];
        if k % 4 == 0 {
            shapes[1] = Shape::Box { half: [0.03, 0.04, 0.05] };
        }
        if k % 4 == 1 {
            shapes[1] = Shape::Sphere { radius: 0.03 };
        }
        let mut input = scene(elastic, shapes);
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
        let change = total(&run) / before - 1.0;
        touched += i32::from(contact);
        worst = worst.max(change.abs());
        sum += change;
    }
    let mean = sum / f64::from(touched);
    println!("{name}, {touched} collisions: worst {worst:.1e}, mean {mean:.1e}");
    assert!(touched > 150 && worst < 1e-3 && mean.abs() < 1e-4, "{name}: {touched} {worst:e} {mean:e}");
}

#[test]
fn collisions_keep_their_account() {
    damped_collisions(24);
}

#[test]
#[ignore = "minutes"]
fn many_collisions_keep_their_account() {
    damped_collisions(60);
}

fn damped_collisions(count: usize) {
    let pairs = [(0.0, 0.5), (0.5, 1.0), (0.5, 0.5)];
    let young = Material { young: Some(1e8), ..hertz() };
    let all = [("springs", material()), ("Hertz", young)].map(|law| pairs.map(|pair| (law, pair)));
    for ((law, material), (friction, restitution)) in all.into_iter().flatten() {
        let mut random = Random::new(6);
        let (mut worst, mut sum) = (0.0_f64, 0.0);
        for k in 0..count {
            let mut shapes = vec![
                stone_of(&mut random, 8 + k % 17, [0.05, 0.04, 0.03], 0.004),
                block([0.05, 0.04, 0.03], 0.006),
            ];
            if k % 4 == 1 {
                shapes[1] = Shape::Box { half: [0.05, 0.04, 0.03] };
            }
            let mut input = scene(Material { friction, restitution, ..material }, shapes);
            input.time_step = TimeStep::Auto { fraction: 0.1 };
            for (shape, side) in [(0, -1.0), (1, 1.0)] {
                let orientation = UnitQuaternion::from_scaled_axis(random.vector() * 3.0);
                let aside = random.vector() * 0.02;
                let position = Vec3::new(0.06 * side, aside.y, aside.z);
                let (spin, velocity) = (random.vector() * 5.0, Vec3::x() * (-0.5 * side));
                input.bodies.push(BodyInput { orientation, spin, velocity, ..body(shape, position) });
            }
            let mut run = Run::new(input);
            let before = total(&run);
            run.until(0.1);
            let balance = &run.state.balance;
            let error = (total(&run) + balance.dissipated() - before) / before;
            worst = worst.max(error.abs());
            sum += error;
        }
        println!(
            "{law}, friction {friction}, e {restitution}: account off by {worst:.1e}, mean {:.1e}",
            sum / count as f64
        );
        assert!(worst < 0.01, "{worst:e}");
    }
}

#[test]
fn a_heap_of_stones() {
    let mut random = Random::new(9);
    let stone = |k: usize, random: &mut Random| stone_of(random, 10 + 4 * k, [0.05, 0.04, 0.03], 0.004);
    let mut shapes: Vec<Shape> = (0..4).map(|k| stone(k, &mut random)).collect();
    shapes.push(Shape::Sphere { radius: 0.03 });
    shapes.push(Shape::Box { half: [0.06, 0.04, 0.02] });
    let mut input = scene(Material { stiffness: 5e4, ..material() }, shapes);
    input.gravity = DOWN;
    for (n, x) in [(Vec3::x(), -0.1), (-Vec3::x(), 0.1), (Vec3::y(), -0.1), (-Vec3::y(), 0.1)] {
        input.planes.push(plane(n.abs() * x, n));
    }
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    for k in 0..18_usize {
        // Four per level; the block last, clear of the planes.
        let aside = if k == 17 { 0.03 } else { 0.045 };
        let side = |bit: usize| if k >> bit & 1 == 0 { -aside } else { aside };
        let position = Vec3::new(side(0), side(1), 0.06 + 0.1 * (k / 4 + k / 17) as f64);
        let shape = if k >= 16 { k - 12 } else { k % 4 };
        let orientation = UnitQuaternion::from_scaled_axis(random.vector() * if k == 17 { 0.1 } else { 3.0 });
        let scale = if k < 16 { 0.7 + 0.3 * random.unit() } else { 1.0 };
        input.bodies.push(BodyInput { orientation, scale, ..body(shape, position) });
    }
    let run_on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut run = Run::new(input.clone());
            let before = total(&run);
            run.until(0.5);
            let balance = run.state.balance;
            let error = (total(&run) - balance.work() + balance.dissipated() - before) / balance.dissipated();
            let places: Vec<[u64; 3]> =
                (0..18).map(|b| run.state.position(b).map(f64::to_bits).into()).collect();
            (places, error, balance.dissipated() / before)
        })
    };
    let (places, error, lost) = run_on(1);
    println!("account of energy off by {error:.1e} of what was dissipated, {lost:.2} of all");
    assert!(error.abs() < 1e-3 && lost > 0.4, "{error:e} {lost}");
    assert_eq!(places, run_on(3).0);
}

/// Edge radius and length of the table's cubes [m].
const RADIUS: f64 = 0.04;
const LENGTH: f64 = 0.5;

fn about(axis: nalgebra::Unit<Vec3>, angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&axis, angle.to_radians())
}

fn lift(material: Material, change: impl Fn(&mut ModelInput)) -> f64 {
    let mut input = scene(material, vec![block([0.5 * LENGTH + RADIUS; 3], RADIUS)]);
    input.time_step = TimeStep::FixedAboveLimit(1e-12);
    change(&mut input);
    let mut run = Run::new(input);
    run.step();
    measure::contacts(&run.model, &run.state).iter().filter(|c| c.a == 0).map(|c| c.force.z).sum()
}

fn pressed(edge_factor: f64, orientation: UnitQuaternion<f64>, low: f64, overlap: f64) -> f64 {
    lift(Material { edge_factor, ..hertz() }, |input| {
        input.planes.push(plane(Vec3::zeros(), Vec3::z()));
        input.bodies.push(BodyInput { orientation, ..body(0, Vec3::z() * (low + RADIUS - overlap)) });
    })
}

/// 4/3 E* √r d^(3/2) [N].
fn sphere_on_plane(overlap: f64) -> f64 {
    4.0 / 3.0 * MODULUS * (RADIUS * overlap).sqrt() * overlap
}

/// Hertz: corner as a sphere; edge a quarter of the modulus per unit length, or π/4 with that factor.
#[test]
fn corner_and_edge_forces_match_hertz() {
    let diagonal = UnitQuaternion::rotation_between(&Vec3::repeat(1.0), &Vec3::z()).expect("not opposite");
    let low = 0.5 * LENGTH * f64::sqrt(2.0);
    for row in read("tests/data/shapes/laws/halfspace_edge_face.csv") {
        let [overlap, half_space, popov] = [row[0], row[1], row[3]];
        let sphere = sphere_on_plane(overlap);
        let corner = pressed(1.0, diagonal, 0.5 * LENGTH * f64::sqrt(3.0), overlap) / sphere;
        // Without its two end corners.
        let edge = |factor| pressed(factor, about(Vec3::x_axis(), 45.0), low, overlap) - 2.0 * sphere;
        let share = edge(1.0) / (0.25 * MODULUS * LENGTH * overlap);
        let beside = 0.25 * MODULUS * LENGTH * overlap / half_space;
        println!(
            "overlap {overlap:.0e}: corner over sphere {corner:.4}, edge {share:.4}; over half-space {beside:.3}"
        );
        assert!(corner > 1.0 && corner < 1.0 + 0.6 * (overlap / RADIUS).sqrt(), "{corner}");
        assert!(share > 1.0 && share < 1.0 + 4.0 * overlap / LENGTH + 0.2 * overlap / RADIUS, "{share}");
        let share = edge(PI) / popov;
        assert!(
            share > 1.0 - 1e-9 && share < 1.0 + 4.0 * overlap / LENGTH + 0.2 * overlap / RADIUS,
            "{share}"
        );
        assert!((0.9..1.4).contains(&beside), "{beside}");
    }
}

/// Perpendicular edges: crossed cylinders after Hertz, otherwise divided by the sine of their angle up to
/// parallel. Up to 2.5 times the half-space.
#[test]
fn edges_that_cross_after_hertz() {
    for row in read("tests/data/shapes/laws/halfspace_edge_edge.csv") {
        let [angle, half_space] = [row[0], row[1]];
        let force = lift(hertz(), |input| {
            let apart = LENGTH * f64::sqrt(2.0) + 2.0 * RADIUS - 1e-4;
            let tilt = about(Vec3::x_axis(), 45.0);
            input.bodies.push(BodyInput { orientation: tilt, ..body(0, Vec3::z() * apart) });
            let orientation = about(Vec3::z_axis(), angle) * tilt;
            input.bodies.push(BodyInput { orientation, ..body(0, Vec3::zeros()) });
        });
        let over_sine = sphere_on_plane(1e-4) / angle.to_radians().sin();
        println!(
            "edges at {angle} degrees: {force:.1} N, half-space {half_space} N, ratio {:.3}",
            force / half_space
        );
        if angle >= 5.0 {
            assert!((force / over_sine - 1.0).abs() < 3e-3, "{angle}: {force} and {over_sine}");
        }
        assert!((0.99..2.5).contains(&(force / half_space)), "{angle}: {force}");
    }
}

#[test]
fn refusals() {
    let refused = |change: &dyn Fn(&mut ModelInput)| {
        let mut input = scene(material(), vec![block([0.05; 3], 0.01)]);
        input.bodies.push(body(0, Vec3::zeros()));
        change(&mut input);
        Model::new(input).expect_err("a refusal").to_string()
    };
    let crush = |i: &mut ModelInput| {
        i.materials[0] = Material { corner_strength: 1e8, corner_angle: 1.3, ..hertz() };
    };
    assert!(refused(&crush).contains("grows with the overlap"));
    let surface = |i: &mut ModelInput| i.surface_material = Some(0);
    assert!(refused(&surface).contains("an external surface"));
    let narrow = |i: &mut ModelInput| i.periodic[0] = Some([0.0, 0.2]);
    assert!(refused(&narrow).contains("two diameters"));
    let absent = |i: &mut ModelInput| {
        i.shapes.push(Shape::Box { half: [0.1; 3] });
        i.bodies.push(BodyInput { absent: true, ..body(1, Vec3::x()) });
    };
    assert!(refused(&absent).contains("it is a box"));
}

#[test]
fn stones_come_and_go() {
    let mut input = scene(elastic(), vec![block([0.05; 3], 0.01)]);
    input.gravity = DOWN;
    // Second-order energy error of a bounce: 0.3 % at half the critical time step.
    input.time_step = TimeStep::Auto { fraction: 0.1 };
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    input.bodies.push(body(0, Vec3::new(0.0, 0.0, 0.0501)));
    input.bodies.push(BodyInput { absent: true, ..body(0, Vec3::zeros()) });
    let mut run = Run::new(input);
    assert!(!run.state.present(1));
    let start = total(&run);
    run.until(0.05);
    let arrival = flow::Arrival {
        body: 1,
        position: Vec3::new(0.3, 0.0, 0.16),
        orientation: UnitQuaternion::identity(),
        velocity: Vec3::new(0.0, 0.0, -1.0),
        spin: Vec3::zeros(),
    };
    flow::exchange(&run.model, &mut run.state, &mut run.work, &[], &[arrival]).unwrap();
    run.until(0.2);
    assert!(run.state.velocity(1).z > 0.5, "it has bounced: {}", run.state.velocity(1));
    flow::exchange(&run.model, &mut run.state, &mut run.work, &[0], &[]).unwrap();
    run.until(0.25);
    assert!(!run.state.present(0) && run.state.present(1));
    let balance = &run.state.balance;
    let error = total(&run) + balance.dissipated() - start - balance.work_flow;
    let brought = run.model.mass(1) * (0.5 + G * 0.16);
    println!("account off by {:.1e} of what came", error / brought);
    assert!(error.abs() < 1e-3 * brought, "{error:e}");
}

/// Faces land between two stability checks; without an impact limit blocks fly off at 16 m/s.
#[test]
fn blocks_that_fall_flat() {
    let mut input = scene(Material { restitution: 0.9, ..material() }, vec![block([0.1, 0.05, 0.02], 0.003)]);
    input.gravity = DOWN;
    input.time_step = TimeStep::Measured { share: 0.8, longest: f64::INFINITY, collisions: false };
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    for k in 0..4 {
        let tilt = 1.15 - 0.05 * f64::from(k);
        let orientation = UnitQuaternion::from_axis_angle(&Vec3::x_axis(), tilt);
        let height = 0.047 * tilt.sin() + 0.017 * tilt.cos() + 0.003;
        input.bodies.push(BodyInput { orientation, ..body(0, Vec3::new(0.5 * f64::from(k), 0.0, height)) });
    }
    let mut run = Run::new(input);
    let before = total(&run);
    while run.state.time < 0.6 {
        run.follow();
    }
    let balance = &run.state.balance;
    let error = (total(&run) + balance.dissipated() - before) / before;
    let flat = (0..4).filter(|b| run.state.position(*b).z < 0.021).count();
    println!("{flat} blocks lie flat, account off by {error:.1e}");
    assert!(flat >= 2 && error.abs() < 0.01, "{flat} {error:e}");
}

#[test]
fn cores_that_meet_are_named() {
    let mut input = scene(elastic(), vec![block([0.05; 3], 0.001)]);
    input.materials[0].stiffness = 1e3;
    for side in [-1.0, 1.0] {
        input
            .bodies
            .push(BodyInput { velocity: Vec3::x() * (-3.0 * side), ..body(0, Vec3::x() * (0.06 * side)) });
    }
    let mut run = Run::new(input);
    let error = (0..100_000).find_map(|_| {
        trackbed_dem::step(&run.model, &mut run.state, &mut run.work, &trackbed_dem::surface::NoSurface, &[])
            .err()
    });
    let error = error.expect("the cores meet").to_string();
    assert!(error.contains("overlap"), "{error}");
}
