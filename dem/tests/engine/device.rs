//! Device kernels, compiled by the system's C compiler, against the engine.

use crate::c_machine::{TestMachine, device_is_there};
use crate::device_changes::assert_detected;
use crate::scene::{Random, cuboid, free, plane, sphere, stone};
use nalgebra::UnitQuaternion;
use trackbed_dem::bond::{
    Bond, BondDamping, BondInput, Criterion, ParallelBond, ParallelStiffness, ShearStrength, within_gap,
};
use trackbed_dem::device::{Device, source};
use trackbed_dem::law::damping::Damping;
use trackbed_dem::law::material::{LawName, PairOverride};
use trackbed_dem::law::table;
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::surface::{NoSurface, Surface};
use trackbed_dem::{
    BackEnd, BodyInput, LocalDamping, Material, Model, ModelInput, Motion, Oscillation, Plane, RigidBody,
    Servo, Shape, State, Vec3, WallInput, WallShape, Work, step,
};

pub(crate) const STEPS: usize = 1000;
const PAIR: PairOverride = PairOverride {
    a: 0,
    b: 1,
    friction: None,
    restitution: None,
    stiffness: None,
    adhesion: None,
    normal: None,
    formula: None,
    tangential: None,
    damping: None,
    rolling_friction: None,
    twisting_friction: None,
};

/// Unequal flying spheres in a box with a rising floor; more than a block.
pub(crate) fn gas(materials: [Material; 2], contacts: Vec<PairOverride>) -> ModelInput {
    let mut random = Random::new(7);
    let mut input = ModelInput {
        materials: materials.to_vec(),
        contacts,
        shapes: vec![Shape::Sphere { radius: 0.01 }],
        gravity: Vec3::new(0.3, -0.2, -9.81),
        ..ModelInput::default()
    };
    for k in 0..1085_usize {
        let cell = Vec3::new((k % 11) as f64, (k / 11 % 11) as f64, (k / 121) as f64);
        let mut body =
            sphere((cell + Vec3::repeat(0.5)) * 0.0206 + random.vector() * 3e-4, random.vector() * 1.5);
        body.material = usize::from(k % 3 == 0);
        body.scale = 0.8 + 0.2 * random.unit();
        body.spin = random.vector() * 40.0;
        input.bodies.push(body);
    }
    let far = 0.0206 * 11.0;
    for (k, (point, normal)) in [
        (Vec3::zeros(), Vec3::z()),
        (Vec3::zeros(), Vec3::x()),
        (Vec3::zeros(), Vec3::y()),
        (Vec3::repeat(far), -Vec3::x()),
        (Vec3::new(0.0, far, 0.0), Vec3::new(0.1, -1.0, 0.2)),
        (Vec3::repeat(0.19), -Vec3::z()),
    ]
    .into_iter()
    .enumerate()
    {
        let velocity = if k == 0 { Vec3::new(0.1, 0.0, 0.4) } else { Vec3::zeros() };
        input.planes.push(Plane { material: k % 2, velocity, ..plane(point, normal) });
    }
    input
}

/// First difference between device and engine, compared completely every seventh step; and the engine's
/// state.
fn compare(
    input: ModelInput,
    steps: usize,
    change: impl Fn(String) -> String,
) -> (Option<usize>, State, (u64, u64)) {
    compare_events(input, steps, change, |_, _| false)
}

/// As [`compare`]; `event` may modify both states before a step.
pub(crate) fn compare_events(
    input: ModelInput,
    steps: usize,
    change: impl Fn(String) -> String,
    event: impl Fn(usize, &mut State) -> bool,
) -> (Option<usize>, State, (u64, u64)) {
    let model = Model::new(input).expect("a good input");
    let text = change(source(&model).expect("a model for a device"));
    let (mut ours, mut theirs) = (State::new(&model), State::new(&model));
    let mut work = Work::new(&model, &theirs);
    // Includes a re-sorting of bodies.
    (ours.steps, theirs.steps) = (4750, 4750);
    let mut device = Device::new(TestMachine::new(&text, &model), &model, &ours).expect("memory");
    let mut differs = None;
    for k in 1..=steps {
        if event(k, &mut theirs) {
            device.download(&model, &mut ours).expect("a device that responds");
            event(k, &mut ours);
            device.upload(&model, &ours).expect("memory");
        }
        step(&model, &mut theirs, &mut work, &NoSurface, &[]).expect("a good step");
        // May fail after a difference.
        if let Err(e) = device.step(&model, &mut ours, &NoSurface, &[]) {
            println!("step {k} on the device: {e}");
            differs = Some(k);
            break;
        }
        if k % 7 == 0 || k == steps {
            device.download(&model, &mut ours).expect("a device that responds");
            let bytes = |s: &State| postcard::to_stdvec(s).unwrap();
            if bytes(&ours) != bytes(&theirs) {
                differs = Some(k);
                explain(&model, &ours, &theirs);
                break;
            }
        }
    }
    (differs, theirs, device.rebuilds())
}

fn explain(model: &Model, ours: &State, theirs: &State) {
    let motion = |s: &State, b: usize| [s.position(b), s.velocity(b), s.spin(b)];
    let other = (0..model.body_count()).filter(|&b| motion(ours, b) != motion(theirs, b)).count();
    let same = if ours.balance == theirs.balance { "the same" } else { "different" };
    println!("{other} bodies move otherwise, the ledger is {same}");
    let bytes = [ours, theirs].map(|s| postcard::to_stdvec(s).unwrap());
    let at: Vec<usize> =
        (0..bytes[0].len().min(bytes[1].len())).filter(|&k| bytes[0][k] != bytes[1][k]).collect();
    println!("{} and {} bytes, {} differ, from {:?}", bytes[0].len(), bytes[1].len(), at.len(), at.first());
    for k in at.iter().take(6) {
        println!("  {k}: {:?}\n   {:?}", &bytes[0][k - 8..k + 9], &bytes[1][k - 8..k + 9]);
    }
}

fn same_bits(name: &str, input: ModelInput) -> State {
    let (differs, state, (searches, refreshes)) = compare(input, STEPS, |text| text);
    let l = &state.balance;
    println!(
        "{name}: {STEPS} steps, {searches} searches, {refreshes} near lists, dashpots {:.3e} J, friction {:.3e} J, planes {:.3e} J",
        l.dissipated_dashpot, l.dissipated_friction, l.work_walls
    );
    assert_eq!(differs, None, "{name}: the first step after which the states differ");
    assert!(searches > 2 && refreshes > 10, "{name}: {searches} searches, {refreshes} near lists");
    assert!(l.dissipated_dashpot > 0.0 && l.dissipated_friction > 0.0 && l.work_walls != 0.0, "{name}");
    state
}

pub(crate) fn smooth() -> Material {
    Material { friction: 0.2, restitution: 0.8, tangential_damping_ratio: 0.1, density: 2000.0, ..stone() }
}

fn elastic(m: Material) -> Material {
    Material { young: Some(4e7), poisson: 0.25, stiffness: f64::INFINITY, ..m }
}

fn named(name: &str) -> Option<LawName> {
    Some(table::normal_named(name).expect("a normal law"))
}

pub(crate) fn turning(m: Material) -> Material {
    Material { rolling_friction: 0.1, twisting_friction: 0.05, ..m }
}

#[test]
fn linear_law() {
    if device_is_there() {
        same_bits("linear", gas([stone(), smooth()], Vec::new()));
        let slips = PairOverride { tangential: Some(LawName::NONE), damping: Some(Damping::None), ..PAIR };
        same_bits("linear, a pair without tangential force", gas([stone(), smooth()], vec![slips]));
    }
}

#[test]
fn hertz_law() {
    if device_is_there() {
        same_bits("hertz", gas([elastic(stone()), elastic(smooth())], Vec::new()));
    }
}

#[test]
fn rolling_twisting_adhesion() {
    if device_is_there() {
        let sticky = PairOverride { adhesion: Some(2.0), ..PAIR };
        same_bits("linear, rolling, adhesion", gas([turning(stone()), turning(smooth())], vec![sticky]));
        same_bits("hertz, rolling", gas([turning(elastic(stone())), turning(elastic(smooth()))], Vec::new()));
    }
}

#[test]
fn rough_and_several_laws() {
    if device_is_there() {
        let rough = Material { asperity_friction: 0.5, asperity_pressure: 2e4, ..stone() };
        same_bits("rough", gas([rough, smooth()], Vec::new()));
        let yielding = Material { normal: named("walton_braun"), restitution: 0.6, ..stone() };
        same_bits("walton-braun", gas([yielding, yielding], Vec::new()));
        let crushing = Material {
            stiffness: f64::INFINITY,
            young: Some(2e7),
            poisson: 0.2,
            corner_strength: 3e5,
            corner_angle: 1.36,
            asperity_friction: 0.5,
            asperity_pressure: 1e5,
            ..stone()
        };
        same_bits("corners that crush", gas([crushing, crushing], Vec::new()));
        let linear = PairOverride { normal: named("linear"), stiffness: Some(1e5), ..PAIR };
        same_bits("three laws", gas([turning(yielding), turning(elastic(stone()))], vec![linear]));
    }
}

#[test]
fn local_damping_and_fixed_motions() {
    if device_is_there() {
        let mut input = gas([turning(stone()), smooth()], Vec::new());
        for (k, body) in input.bodies.iter_mut().enumerate().filter(|(k, _)| k % 37 == 0) {
            body.fixed = std::array::from_fn(|d| [1, 2, 4, 8, 16, 32, 56, 7, 63][k / 37 % 9] >> d & 1 == 1);
        }
        same_bits("fixed motions", input.clone());
        input.damping = Some(LocalDamping { factor: 0.3 });
        same_bits("fixed motions, local damping", input);
    }
}

pub(crate) fn with_clumps(mut input: ModelInput, which: impl Fn(usize) -> bool) -> ModelInput {
    let three = [([0.0, 0.0, 0.0], 0.006), ([0.0035, 0.001, 0.0], 0.005), ([-0.003, 0.002, 0.002], 0.0045)];
    let two = [([0.003, 0.0, 0.0], 0.0055), ([-0.003, 0.001, 0.0], 0.005)];
    for spheres in [&three[..], &two[..]] {
        input.shapes.push(Shape::Clump(Clump::from_spheres(spheres).expect("one piece")));
    }
    let mut random = Random::new(11);
    for (k, body) in input.bodies.iter_mut().enumerate().filter(|(k, _)| which(*k)) {
        body.shape = 1 + k % 2;
        // Smaller bodies, shorter steps: faster approach.
        body.velocity *= 8.0;
        body.spin *= 8.0;
        body.orientation = UnitQuaternion::from_scaled_axis(random.vector() * 3.0);
    }
    input
}

fn in_a_corner(k: usize) -> bool {
    [k % 11, k / 11 % 11, k / 121].iter().all(|n| *n < 3)
}

fn largest_turn(state: &State, input: &ModelInput) -> f64 {
    let model = Model::new(input.clone()).expect("a good input");
    let turned = |k: usize| state.orientation(&model, k).angle_to(&input.bodies[k].orientation);
    (0..input.bodies.len()).map(turned).fold(0.0, f64::max)
}

#[test]
fn clumps() {
    if device_is_there() {
        let all = with_clumps(gas([stone(), smooth()], Vec::new()), |_| true);
        let state = same_bits("clumps", all.clone());
        let turn = largest_turn(&state, &all);
        println!("a clump has turned by {turn:.2} rad");
        assert!(turn > 0.3);
        same_bits("clumps among spheres", with_clumps(gas([stone(), smooth()], Vec::new()), |k| k % 3 == 1));
        same_bits("few clumps", with_clumps(gas([stone(), smooth()], Vec::new()), in_a_corner));
        let elastic = [turning(elastic(stone())), turning(elastic(smooth()))];
        same_bits("clumps, hertz, rolling", with_clumps(gas(elastic, Vec::new()), |k| k % 2 == 1));
    }
}

#[test]
fn clumps_with_damping_and_constraints() {
    if device_is_there() {
        let mut input = with_clumps(gas([turning(stone()), smooth()], Vec::new()), |k| k % 3 != 1);
        input.damping = Some(LocalDamping { factor: 0.3 });
        same_bits("clumps, local damping", input.clone());
        for (k, body) in input.bodies.iter_mut().enumerate().filter(|(k, _)| k % 37 == 0) {
            body.fixed = std::array::from_fn(|d| [56, 7, 63, 2, 57][k / 37 % 5] >> d & 1 == 1);
        }
        same_bits("clumps, fixed motions, local damping", input.clone());
        input.damping = None;
        same_bits("clumps, fixed motions", input);
    }
}

#[test]
fn rejects_partly_fixed_clump_rotation() {
    let mut input = with_clumps(gas([stone(), smooth()], Vec::new()), |k| k == 5);
    input.bodies[5].fixed[3] = true;
    let model = Model::new(input).expect("a good input");
    let why = source(&model).expect_err("not for a device").to_string();
    assert_eq!(why, "not supported on a GPU: clumps that rotate about some axes only");
}

/// Square mesh of `n` cells per side; `height` along each vertex normal.
pub(crate) fn mesh(n: u32, middle: Vec3, sides: [Vec3; 2], mut height: impl FnMut() -> f64) -> WallShape {
    let normal = sides[0].cross(&sides[1]).normalize();
    let at = |k: u32| f64::from(k) / f64::from(n) - 0.5;
    let all = (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j)));
    let vertices =
        all.map(|(i, j)| middle + sides[0] * at(i) + sides[1] * at(j) + normal * height()).collect();
    let corner = |i: u32, j: u32| j * (n + 1) + i;
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    WallShape::Triangles { vertices, triangles: triangles.collect() }
}

pub(crate) fn between_triangles(mut input: ModelInput) -> ModelInput {
    let (far, mut random) = (0.0206 * 11.0, Random::new(3));
    let (middle, wide) = (0.5 * far, 1.6 * far);
    input.planes.retain(|p| p.normal.x < 0.5 && p.normal.z.abs() < 0.5);
    input.bodies.iter_mut().for_each(|b| b.velocity *= 2.0);
    let [x, y, z] = [Vec3::x() * wide, Vec3::y() * wide, Vec3::z() * wide];
    let floor = mesh(17, Vec3::new(middle, middle, -1.5e-3), [x, y], || 1.4e-3 * random.unit());
    let lid = mesh(5, Vec3::new(middle, middle, 0.1915), [x, y], || 0.0);
    let side = mesh(3, Vec3::new(-4e-3, middle, middle), [y, z], || 0.0);
    let rising = Motion { velocity: Vec3::new(0.1, 0.0, 0.4), ..Motion::default() };
    let swing = Oscillation { amplitude: Vec3::new(2e-4, 0.0, 4e-4), frequency: 300.0, phase: 0.3 };
    let swinging = Motion { oscillation: Some(swing), ..Motion::default() };
    let turning = Motion { angular_velocity: Vec3::new(0.5, 1.0, 0.8), ..Motion::default() };
    for (k, (shape, motion)) in [(floor, rising), (lid, swinging), (side, turning)].into_iter().enumerate() {
        input.walls.push(WallInput { motion, ..WallInput::fixed(shape, k % 2) });
    }
    input
}

#[test]
fn walls_of_triangles() {
    if device_is_there() {
        let pairs: [(&str, ModelInput); 3] = [
            ("triangles", gas([stone(), smooth()], Vec::new())),
            (
                "triangles, hertz, rolling",
                gas([turning(elastic(stone())), turning(elastic(smooth()))], Vec::new()),
            ),
            ("triangles, clumps", with_clumps(gas([turning(stone()), smooth()], Vec::new()), |k| k % 3 != 1)),
        ];
        for (name, input) in pairs {
            let state = same_bits(name, between_triangles(input));
            let (force, moment) = state.wall_force(0);
            println!(
                "{} contacts with walls, {:.3} N, {:.4} N m",
                state.wall_contact_count(),
                force.norm(),
                moment.norm()
            );
            assert!(state.wall_contact_count() > 20 && moment.norm() > 0.0);
        }
    }
}

pub(crate) fn with_borders(mut input: ModelInput) -> ModelInput {
    let far = 0.0206 * 11.0;
    input.planes.retain(|p| p.normal.z.abs() > 0.9);
    input.periodic = [Some([0.0, far]), Some([0.0, far]), None];
    input.bodies.iter_mut().for_each(|b| b.velocity = b.velocity * 2.0 + Vec3::new(1.5, -1.0, 0.0));
    input
}

#[test]
fn a_body_of_triangles() {
    if device_is_there() {
        let mut input = with_clumps(gas([stone(), smooth()], Vec::new()), |k| k % 3 != 1);
        input.planes.retain(|p| p.normal.z > -0.5);
        let block = cuboid(Vec3::new(0.11, 0.11, 0.2065), Vec3::new(0.06, 0.05, 0.02));
        let body =
            RigidBody { velocity: Vec3::new(0.0, 0.3, -8.0), spin: Vec3::new(3.0, 5.0, 1.0), ..free(3.0) };
        input.walls.push(WallInput { body: Some(body), ..WallInput::fixed(block, 0) });
        let state = same_bits("a body of triangles", input);
        let (velocity, spin) = state.wall_velocity(0);
        println!("{} contacts, {velocity:?} m/s, {spin:?} rad/s", state.wall_contact_count());
        assert!(state.wall_contact_count() > 2 && state.wall_acceleration(0).norm() > 0.0);
    }
}

#[test]
fn periodic_borders() {
    if device_is_there() {
        let pairs: [(&str, ModelInput); 3] = [
            ("borders", gas([stone(), smooth()], Vec::new())),
            (
                "borders, hertz, rolling",
                gas([turning(elastic(stone())), turning(elastic(smooth()))], Vec::new()),
            ),
            ("borders, clumps", with_clumps(gas([stone(), smooth()], Vec::new()), |k| k % 3 != 1)),
        ];
        for (name, input) in pairs {
            let state = same_bits(name, with_borders(input));
            let couple = state.balance.periodic.angular.norm();
            println!("{name}: angular impulse of the borders {couple:.3e} N m s");
            assert!(couple > 0.0);
        }
    }
}

/// Servo-controlled plate instead of a plane, pressed along `way`.
pub(crate) fn pressed(mut input: ModelInput, way: Vec3) -> ModelInput {
    input.planes.retain(|p| p.normal.dot(&way) < 0.5);
    let side = |b: &BodyInput| b.position.dot(&way) - 0.01 * b.scale;
    let point = way * input.bodies.iter().map(side).fold(f64::INFINITY, f64::min);
    let plate = WallShape::Plane { point, normal: way + Vec3::new(0.0, 0.002, 0.0) };
    let servo = Servo { direction: way, force: vec![[0.0, 300.0]], max_speed: 3.0, gain: 0.5, driven: None };
    input.walls.push(WallInput { servo: Some(servo), ..WallInput::fixed(plate, 1) });
    input
}

fn in_a_cone(input: ModelInput) -> ModelInput {
    let mut input = pressed(input, -Vec3::z());
    input.planes.retain(|p| p.normal.z.abs() < 0.5);
    input.bodies.iter_mut().for_each(|b| b.velocity *= 2.0);
    let middle = Vec3::repeat(0.5 * 0.0206 * 11.0);
    let cone = WallShape::Frustum {
        base: Vec3::new(middle.x, middle.y, -1.2e-3),
        axis: Vec3::z(),
        height: 0.3,
        radii: [0.1555, 0.158],
        caps: [true, false],
    };
    let rising = Motion { velocity: Vec3::new(0.1, 0.0, 0.4), ..Motion::default() };
    input.walls.push(WallInput { motion: rising, ..WallInput::fixed(cone, 0) });
    let shell = WallShape::Sphere { centre: Vec3::new(middle.x, middle.y, 0.0953), radius: 0.1775 };
    let turning = Motion { angular_velocity: Vec3::new(0.5, 1.0, 0.8), ..Motion::default() };
    input.walls.push(WallInput { motion: turning, ..WallInput::fixed(shell, 1) });
    let side = mesh(3, Vec3::new(-1e-3, middle.y, middle.z), [Vec3::y() * 0.4, Vec3::z() * 0.4], || 0.0);
    input.walls.push(WallInput::fixed(side, 0));
    input
}

#[test]
fn round_and_driven_walls() {
    if device_is_there() {
        let clumps = with_clumps(gas([turning(stone()), smooth()], Vec::new()), |k| k % 3 != 1);
        for (name, input) in [
            ("a plate", pressed(gas([stone(), smooth()], Vec::new()), -Vec3::z())),
            ("a cone", in_a_cone(gas([stone(), smooth()], Vec::new()))),
            (
                "a cone, hertz, rolling",
                in_a_cone(gas([turning(elastic(stone())), smooth()].map(elastic), Vec::new())),
            ),
            ("a cone, clumps", in_a_cone(clumps)),
        ] {
            let round = input.walls.len() > 1;
            let state = same_bits(name, input);
            let (force, contacts) = (state.wall_force(0).0.norm(), state.wall_contact_count());
            let of_walls: Vec<f64> = (1..4).filter(|_| round).map(|k| state.wall_force(k).0.norm()).collect();
            println!(
                "{name}: {contacts} contacts, plate {force:.3} N, servo {:.3e} J, {of_walls:.3?} N",
                state.balance.work_servo
            );
            assert!(contacts > 4 && force > 0.0 && state.balance.work_servo != 0.0);
        }
    }
}

pub(crate) fn bonded(kind: Bond, material: Material) -> ModelInput {
    let mut input = gas([material, smooth()], Vec::new());
    input.bodies.iter_mut().for_each(|b| b.velocity *= 0.4);
    let spheres: Vec<_> = input.bodies.iter().map(|b| (b.position, 0.01 * b.scale)).collect();
    input.bond_kinds = vec![kind];
    let pairs = within_gap(&spheres, 2.5e-3, |a, b| (a * 7 + b) % 5 != 0);
    input.bonds = pairs.into_iter().map(|[a, b]| BondInput::new(a, b, 0)).collect();
    input
}

pub(crate) fn parallel() -> ParallelBond {
    ParallelBond {
        radius_factor: 0.8,
        stiffness: ParallelStiffness::Modulus { young: 2e7, ratio: 2.5 },
        tensile_strength: 2e5,
        shear_strength: ShearStrength::MohrCoulomb { cohesion: 1e5, friction: 0.5 },
        moment_factor: 0.5,
        criterion: Criterion::Stress,
        damping: BondDamping::Fraction(0.05),
        contact: false,
    }
}

#[test]
fn bonds_that_break() {
    if device_is_there() {
        let parallel = parallel();
        for (name, material, contact) in [
            ("parallel bonds", stone(), false),
            ("parallel bonds beside contacts that roll", turning(stone()), true),
        ] {
            let input = bonded(Bond::Parallel(ParallelBond { contact, ..parallel }), material);
            let bonds = input.bonds.len();
            let state = same_bits(name, input);
            let left = state.bond_count();
            println!("{bonds} bonds, {left} left, {:?} broken by tension and shear", state.broken_bonds());
            assert!(left < bonds - 20 && left > bonds / 4, "{left} of {bonds} bonds are left");
        }
        let state =
            same_bits("bonds under a plate", pressed(bonded(Bond::Parallel(parallel), stone()), -Vec3::z()));
        assert!(state.broken_bonds().0 > 0 && state.balance.work_servo != 0.0);
        let mut input = bonded(Bond::Parallel(parallel), stone());
        input.bonds.retain(|b| b.a % 4 != 0 && b.b % 4 != 0);
        input.bodies.iter_mut().for_each(|b| b.velocity *= 8.0);
        same_bits("bonded spheres and clumps", with_clumps(input, |k| k % 4 == 0));
    }
}

/// Compares the errors of device and engine: step, body, partner, values; returns the message.
pub(crate) fn fails_alike(
    input: ModelInput,
    (body, velocity): (usize, Vec3),
    surface: &impl Surface,
) -> String {
    let model = Model::new(input).expect("a good input");
    let text = source(&model).expect("a model for a device");
    let (mut ours, mut theirs) = (State::new(&model), State::new(&model));
    let mut work = Work::new(&model, &theirs);
    let mut device = Device::new(TestMachine::new(&text, &model), &model, &ours).expect("memory");
    for k in 1..400 {
        if k == 40 {
            device.download(&model, &mut ours).expect("a device that responds");
            for state in [&mut ours, &mut theirs] {
                state.set_velocity(&model, body, velocity, Vec3::zeros());
            }
            device.upload(&model, &ours).expect("memory");
        }
        let one = step(&model, &mut theirs, &mut work, surface, &[]);
        assert_eq!(device.step(&model, &mut ours, surface, &[]), one, "step {k}");
        if let Err(e) = one {
            println!("step {k}: {e}");
            return e.to_string();
        }
    }
    panic!("no step has failed");
}

#[test]
fn failing_step_has_engine_message() {
    if device_is_there() {
        let input = gas([stone(), smooth()], Vec::new());
        fails_alike(input, (3, Vec3::new(0.0, 900.0, 0.0)), &NoSurface);
    }
}

#[test]
fn a_changed_operation_is_seen() {
    if device_is_there() {
        let spheres = gas([stone(), smooth()], Vec::new());
        let mut clumps = with_clumps(spheres.clone(), |k| k % 3 != 1);
        clumps.damping = Some(LocalDamping { factor: 0.3 });
        let few = with_clumps(spheres.clone(), in_a_corner);
        let walls = between_triangles(spheres.clone());
        let borders = with_borders(spheres.clone());
        let changes = [
            (&spheres, "x.w - ", "1.0000000000000002 * x.w - "),
            (&spheres, "unsigned k = lane;", "unsigned k = lane >> 1 | (lane & 1) << 1;"),
            (&spheres, "x[m] * mass[m]", "1.0000000000000002 * x[m] * mass[m]"),
            (&spheres, "unsigned i = first_single(p, from);", "unsigned i = to[0];"),
            (&clumps, "if (!more) break;", "if (n == 1) break;"),
            (&clumps, "HELD_WIDTH * (g + lane) + 3", "HELD_WIDTH * (g + lane) + 4"),
            (&walls, "keep_deepest(found, n);", ""),
            (&walls, "ENDED[before[m]] = ", "ENDED[before[m]] = 0.0 * "),
            (&walls, "past[nearest].alive = 0;", ""),
            (&walls, "turned = numbers[a] > numbers[b]", "turned = numbers[a] < numbers[b]"),
            (&borders, "if (!second) COUPLES[c - FIRST_IMAGE] = couple;", ""),
            (&borders, "SPENT[c].x : SPENT[c].y", "SPENT[c].y : SPENT[c].x"),
            (&few, " sphere_contact(p, c, there, second, x, v, w, &s)", " (void)second"),
        ];
        let places = changes.map(|(_, from, to)| (from, to));
        assert_detected("device::a_changed_operation_is_seen", &places, |k, change| {
            compare(changes[k].0.clone(), STEPS, change).0
        });
    }
}
