//! Contacts between walls: triangle bodies and all others.

use crate::scene::{FOLLOWED, Random, Run, block, body, cuboid, free, stone, weightless};
use nalgebra::UnitQuaternion;
use trackbed_dem::{
    BodyInput, Material, Model, ModelError, ModelInput, Motion, RigidBody, StepError, TimeStep, Vec3,
    WallInput, WallShape, measure, surface::NoSurface,
};

const G: f64 = 9.81;

fn material() -> Material {
    Material { stiffness: 1e6, tangential_damping_ratio: 1.0, ..stone() }
}

fn elastic() -> [(&'static str, Material); 2] {
    let smooth = Material { friction: 0.0, restitution: 1.0, tangential_ratio: 0.0, ..material() };
    let hertz = Material { young: Some(1e8), poisson: 0.3, stiffness: f64::INFINITY, ..smooth };
    [("springs", smooth), ("Hertz", Material { tangential_ratio: 0.5, ..hertz })]
}

fn scene(material: Material) -> ModelInput {
    ModelInput { time_step: TimeStep::Auto { fraction: 0.1 }, ..weightless(material) }
}

fn rigid(shape: WallShape, body: RigidBody) -> WallInput {
    WallInput { body: Some(body), ..WallInput::fixed(shape, 0) }
}

/// Angle with two legs of 0.2 m, 0.05 m thick, 0.1 m wide; inner corner at the origin.
fn angle(turn: &UnitQuaternion<f64>, at: Vec3) -> WallShape {
    let outline = [[-0.05, -0.05], [0.15, -0.05], [0.15, 0.0], [0.0, 0.0], [0.0, 0.15], [-0.05, 0.15]];
    let corner = |y: f64, p: [f64; 2]| turn * Vec3::new(p[0], y, p[1]) + at;
    let ends = [-0.05, 0.05].into_iter().flat_map(|y| outline.map(|p| corner(y, p)));
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for k in 0..6 {
        let next = (k + 1) % 6;
        triangles.extend([[k, next, 6 + next], [k, 6 + next, 6 + k]]);
    }
    for first in [0, 6] {
        triangles
            .extend([[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]].map(|t: [u32; 3]| t.map(|v| first + v)));
    }
    WallShape::Triangles { vertices: ends.collect(), triangles }
}

fn total(run: &Run) -> f64 {
    measure::energies(&run.model, &run.state).total()
}

fn octahedron(radius: f64) -> WallShape {
    let vertices = [Vec3::x(), Vec3::y(), Vec3::z(), -Vec3::x(), -Vec3::y(), -Vec3::z()].map(|v| v * radius);
    let triangles =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    WallShape::Triangles { vertices: vertices.to_vec(), triangles }
}

const HALF: [f64; 3] = [0.05, 0.04, 0.03];
const ROUNDING: f64 = 0.006;

struct Throw {
    position: Vec3,
    orientation: UnitQuaternion<f64>,
    velocity: Vec3,
    spin: Vec3,
}

impl Throw {
    fn at_random(random: &mut Random, flat: bool) -> Throw {
        let way = random.vector();
        let way = if flat { Vec3::new(way.x, way.y, 0.0) } else { way }.normalize();
        Throw {
            position: way * 0.2 + random.vector() * 0.03,
            orientation: UnitQuaternion::from_scaled_axis(random.vector() * 3.0),
            velocity: way * -0.8,
            spin: random.vector() * 5.0,
        }
    }

    fn grain(&self) -> BodyInput {
        let Throw { orientation, velocity, spin, .. } = *self;
        BodyInput { orientation, velocity, spin, ..body(0, self.position) }
    }

    fn wall(&self, mass: f64, inertia: Vec3) -> WallInput {
        let WallShape::Triangles { vertices, triangles } = cuboid(Vec3::zeros(), Vec3::from(HALF)) else {
            panic!("triangles")
        };
        let vertices = vertices.iter().map(|v| self.orientation * v + self.position).collect();
        let turn = self.orientation.to_rotation_matrix();
        let t = turn.matrix() * nalgebra::Matrix3::from_diagonal(&inertia) * turn.matrix().transpose();
        let inertia = Some([t[(0, 0)], t[(1, 1)], t[(2, 2)], t[(0, 1)], t[(1, 2)], t[(2, 0)]]);
        let (velocity, spin, rounding) = (self.velocity, self.spin, Some(ROUNDING));
        let centre = Some(self.position);
        rigid(
            WallShape::Triangles { vertices, triangles },
            RigidBody { inertia, centre, velocity, spin, rounding, ..free(mass) },
        )
    }
}

/// A triangle block moves as the same polyhedron, whose contacts have separate references
/// (`docs/guide/verification.md`).
#[test]
fn as_polyhedra_with_the_same_faces() {
    let frustum = |radii, height: f64, caps| WallShape::Frustum {
        base: Vec3::z() * (-0.5 * height),
        axis: Vec3::z(),
        height,
        radii,
        caps,
    };
    let walls: [(&str, Option<WallShape>); 8] = [
        ("octahedron", Some(octahedron(0.1))),
        ("pile", Some(frustum([0.06, 0.06], 1.0, [false; 2]))),
        ("short pile", Some(frustum([0.07, 0.07], 0.1, [true; 2]))),
        ("cone", Some(frustum([0.08, 0.03], 0.2, [false; 2]))),
        ("ball", Some(WallShape::Sphere { centre: Vec3::zeros(), radius: 0.08 })),
        ("bowl", Some(WallShape::Sphere { centre: Vec3::zeros(), radius: 0.3 })),
        ("plane", Some(WallShape::Plane { point: Vec3::zeros(), normal: Vec3::z() })),
        ("another block", None),
    ];
    let hertz = Material { young: Some(1e8), poisson: 0.3, stiffness: f64::INFINITY, ..material() };
    for (name, shape) in walls {
        let mut random = Random::new(77);
        let (mut worst, mut met) = (0.0_f64, 0);
        for k in 0..2 {
            let law = if k == 1 { hertz } else { material() };
            let mut throw = Throw::at_random(&mut random, name == "pile");
            match name {
                // From inside.
                "bowl" => throw.velocity = -throw.velocity,
                "plane" => (throw.position.z, throw.velocity.z) = (0.12, -0.8),
                _ => {}
            }
            let still = Throw {
                position: Vec3::zeros(),
                orientation: UnitQuaternion::from_scaled_axis(random.vector()),
                velocity: Vec3::zeros(),
                spin: random.vector(),
            };
            let mut input = ModelInput { shapes: vec![block(HALF, ROUNDING)], ..scene(law) };
            input.bodies.push(throw.grain());
            match &shape {
                Some(shape) => input.walls.push(WallInput::fixed(shape.clone(), 0)),
                None => input.bodies.push(still.grain()),
            }
            let mut grains = Run::new(input);
            let dt = grains.model.dt().min(2e-5);
            grains.state.set_dt(dt);
            let (mass, inertia) = (grains.model.mass(0), grains.model.inertia(0));
            let mut input = scene(law);
            input.walls.push(throw.wall(mass, inertia));
            match &shape {
                Some(shape) => input.walls.push(WallInput::fixed(shape.clone(), 0)),
                None => input.walls.push(still.wall(mass, inertia)),
            }
            let mut walls = Run::new(input);
            walls.state.set_dt(dt);
            let mut touched = false;
            while walls.state.time < 0.2 {
                grains.step();
                walls.step();
                touched |= walls.state.wall_force(1).0.norm() > 0.0;
            }
            met += i32::from(touched);
            let (v, w) = walls.state.wall_velocity(0);
            let off = (v - grains.state.velocity(0)).norm() / 0.8;
            let turn = (w - grains.state.spin(0)).norm() / throw.spin.norm();
            worst = worst.max(off).max(turn);
        }
        println!("{name}: {met} collisions of 2, worst {worst:.1e}");
        assert!(met == 2 && worst < 1e-6, "{name}: {met} collisions, {worst:e}");
    }
}

#[test]
fn hollow_bodies_collide() {
    let laws = elastic().into_iter().chain([("rough springs", material())]);
    for (name, law) in laws {
        let mut random = Random::new(5);
        let (mut worst, mut met) = (0.0_f64, 0);
        for _ in 0..6 {
            let mut input = scene(law);
            let mut thrown = |at: Vec3, velocity: Vec3| {
                let turn = UnitQuaternion::from_scaled_axis(random.vector() * 3.0);
                let spin = random.vector() * 4.0;
                rigid(angle(&turn, at), RigidBody { velocity, spin, rounding: Some(0.005), ..free(2.5) })
            };
            input.walls.push(thrown(Vec3::new(-0.25, 0.02, 0.0), Vec3::x()));
            input.walls.push(thrown(Vec3::new(0.25, -0.02, 0.01), -Vec3::x()));
            let mut run = Run::new(input);
            let (before, start) = (total(&run), measure::momentum(&run.model, &run.state));
            let (mut touched, mut steps) = (false, 0);
            while run.state.time < 0.5 {
                run.step();
                let [a, b] = [0, 1].map(|k| run.state.wall_force(k).0);
                assert!((a + b).norm() <= 1e-12 * a.norm());
                touched |= a.norm() > 0.0;
                steps += 1;
                if steps % 20 == 0 {
                    let change = (total(&run) + run.state.balance.dissipated()) / before - 1.0;
                    worst = worst.max(change.abs());
                }
            }
            met += i32::from(touched);
            let end = measure::momentum(&run.model, &run.state);
            let [drift, turn] = [end.linear - start.linear, end.angular - start.angular].map(|d| d.norm());
            assert!(drift < 1e-12 && turn < 1e-11, "{drift:e} {turn:e}");
        }
        println!("{name}: {met} collisions of 6, energy {worst:.1e}");
        assert!(met >= 4 && worst < 2e-3, "{name}: {met} collisions, {worst:e}");
    }
}

#[test]
fn an_angle_hangs_in_another() {
    let mut input = scene(Material { restitution: 0.2, ..material() });
    input.gravity = Vec3::new(0.0, 0.0, -G);
    input.time_step = FOLLOWED;
    let half_turn = UnitQuaternion::from_axis_angle(&Vec3::y_axis(), std::f64::consts::PI);
    let held = RigidBody { fixed: [true; 6], ..free(3.0) };
    input.walls.push(rigid(angle(&UnitQuaternion::identity(), Vec3::zeros()), held));
    let hung = angle(&half_turn, Vec3::new(0.1, 0.0, 0.151));
    input.walls.push(rigid(hung, RigidBody { rounding: Some(0.004), ..free(3.0) }));
    let mut run = Run::new(input);
    let start = total(&run);
    run.follow_until(1.5);
    let (force, weight) = (run.state.wall_force(1).0, 3.0 * G);
    let (v, w) = run.state.wall_velocity(1);
    let left = total(&run) + run.state.balance.dissipated() - run.state.balance.work();
    println!("carries {:.6} of the weight, {:.1e} m/s, {:.1e} rad/s", force.z / weight, v.norm(), w.norm());
    println!("energy {:.1e} of what was lost", (left - start) / run.state.balance.dissipated());
    assert!((force.z / weight - 1.0).abs() < 1e-4 && v.norm() < 1e-4 && w.norm() < 1e-3);
    assert!((run.state.wall_force(0).0 + force).norm() < 1e-9);
    assert!((left - start).abs() < 1e-2 * run.state.balance.dissipated());
}

#[test]
fn blocks_stand_on_each_other() {
    let mut input = scene(Material { restitution: 0.2, ..material() });
    input.gravity = Vec3::new(0.0, 0.0, -G);
    input.time_step = FOLLOWED;
    input.walls.push(WallInput::fixed(cuboid(Vec3::new(0.03, 0.02, -0.1), Vec3::new(0.5, 0.6, 0.1)), 0));
    for k in 0..3 {
        let centre = Vec3::new(0.01 * f64::from(k), 0.0, 0.0502 + 0.1003 * f64::from(k));
        input.walls.push(rigid(cuboid(centre, Vec3::new(0.1, 0.08, 0.05)), free(4.0)));
    }
    let mut run = Run::new(input);
    run.follow_until(1.0);
    for k in 1..4 {
        let (v, w) = run.state.wall_velocity(k);
        assert!(v.norm() < 1e-5 && w.norm() < 1e-4, "{k}: {v} {w}");
        let force = run.state.wall_force(k).0.z;
        assert!((force / (4.0 * G) - 1.0).abs() < 1e-5, "{k}: {force}");
    }
    let measured = run.state.measured_limit().expect("steps follow the contacts");
    assert!((1.0..20.0).contains(&(measured / run.model.dt())), "{measured} {}", run.model.dt());
    let floor = run.state.wall_force(0).0.z / (-12.0 * G);
    println!("the floor carries {floor:.8} of the weight");
    assert!((floor - 1.0).abs() < 1e-5);
}

#[test]
fn a_driven_plate_presses_a_block() {
    let mut input = scene(Material { restitution: 0.3, ..material() });
    input.gravity = Vec3::new(0.0, 0.0, -G);
    input.walls.push(WallInput::fixed(WallShape::Plane { point: Vec3::zeros(), normal: Vec3::z() }, 0));
    input.walls.push(rigid(cuboid(Vec3::z() * 0.051, Vec3::new(0.1, 0.08, 0.05)), free(4.0)));
    let servo = trackbed_dem::Servo {
        direction: -Vec3::z(),
        force: vec![[0.0, 200.0]],
        max_speed: 0.2,
        gain: 0.5,
        driven: None,
    };
    let plate = WallShape::Plane { point: Vec3::z() * 0.11, normal: -Vec3::z() };
    input.walls.push(WallInput { servo: Some(servo), ..WallInput::fixed(plate, 0) });
    let mut run = Run::new(input);
    run.until(1.0);
    let [below, block, above] = [0, 1, 2].map(|k| run.state.wall_force(k).0.z);
    println!("plane {below:.6}, block {block:.6}, plate {above:.6} N");
    assert!((above - 200.0).abs() < 1e-3 && (below + 200.0 + 4.0 * G).abs() < 1e-3);
    assert!((block - 4.0 * G).abs() < 1e-3);
}

#[test]
fn a_belt_drags_a_block() {
    let mut input = scene(Material { restitution: 0.3, ..material() });
    input.gravity = Vec3::new(0.0, 0.0, -G);
    let belt = cuboid(Vec3::new(0.0, 0.0, -0.1), Vec3::new(2.0, 0.3, 0.1));
    let motion = Motion { velocity: Vec3::x() * 0.5, ..Motion::default() };
    input.walls.push(WallInput { motion, ..WallInput::fixed(belt, 0) });
    input.walls.push(rigid(cuboid(Vec3::new(-1.0, 0.0, 0.05), Vec3::new(0.1, 0.08, 0.05)), free(4.0)));
    let mut run = Run::new(input);
    let (start, before) = (total(&run), measure::momentum(&run.model, &run.state));
    run.until(1.0);
    let (v, _) = run.state.wall_velocity(1);
    let after = measure::momentum(&run.model, &run.state);
    let impulse = run.state.balance.impulse();
    assert!((after.linear - before.linear - impulse.linear).norm() < 1e-10);
    assert!((after.angular - before.angular - impulse.angular).norm() < 1e-10);
    let balance = run.state.balance;
    let left = total(&run) + balance.dissipated() - balance.work();
    println!("{:.6} m/s, work of the belt {:.4} J, account {:.1e} J", v.x, balance.work_walls, left - start);
    // Belt work m v²: half kinetic energy, half sliding.
    assert!((v.x - 0.5).abs() < 1e-4 && (balance.work_walls / (4.0 * 0.25) - 1.0).abs() < 1e-3);
    assert!((left - start).abs() < 2e-3 * balance.work_walls);
}

/// Eccentric berthing on a sprung dolphin: energy fraction K²/(K² + R²), K radius of gyration, R distance
/// from centre to contact (Vasco Costa 1964; BS 6349-4, "eccentricity coefficient").
#[test]
fn dolphin_absorbs_eccentric_berthing_energy() {
    let half = Vec3::new(15.0, 4.0, 1.5);
    let (mass, speed, stiffness) = (3.0e5, 0.2, 2.0e6);
    for off in [0.0_f64, 6.0, 10.0] {
        let mut input = scene(Material { stiffness: 2e9, ..elastic()[0].1 });
        let held = [false, false, true, true, true, false];
        let pontoon = RigidBody { velocity: Vec3::y() * speed, fixed: held, ..free(mass) };
        input.walls.push(rigid(cuboid(Vec3::zeros(), half), pontoon));
        let dolphin = WallShape::Frustum {
            base: Vec3::new(off, 5.01, -5.0),
            axis: Vec3::z(),
            height: 10.0,
            radii: [1.0; 2],
            caps: [false; 2],
        };
        let mount = trackbed_dem::Mount { stiffness: Vec3::new(0.0, stiffness, 0.0), damping: Vec3::zeros() };
        let fixed = [true, false, true, true, true, true];
        input.walls.push(rigid(dolphin, RigidBody { mount: Some(mount), fixed, ..free(1000.0) }));
        let mut run = Run::new(input);
        let mut most = 0.0_f64;
        while run.state.time < 1.5 {
            // Structure loads belong to the next step.
            let mut load = Vec3::zeros();
            measure::loads_on(&run.model, &run.state, (|_| false, |w| w == 1), |_, f| load += f);
            run.step();
            let force = run.state.wall_force(1).0;
            assert!((load - force).norm() <= 1e-9 * force.norm(), "{load} {force}");
            most = most.max(0.5 * stiffness * run.state.wall_offset(1).y.powi(2));
        }
        let k2 = (half.x * half.x + half.y * half.y) / 3.0;
        let share = k2 / (k2 + off * off);
        let absorbed = most / (0.5 * mass * speed * speed);
        println!("{off} m off its centre: {absorbed:.4} of its energy, formula {share:.4}");
        assert!((absorbed / share - 1.0).abs() < 0.02, "{absorbed} {share}");
        assert!(run.state.wall_velocity(0).0.y < 0.0 || off > 0.0);
    }
}

#[test]
fn refusals_and_failures() {
    let on_floor = |law: Material, body: RigidBody, height: f64| {
        let mut input = scene(law);
        input.walls.push(WallInput::fixed(cuboid(-Vec3::z(), Vec3::new(3.0, 3.0, 1.0)), 0));
        input.walls.push(rigid(cuboid(Vec3::z() * (0.05 + height), Vec3::new(0.1, 0.08, 0.05)), body));
        input
    };
    let refused = |input: ModelInput, words: &str| match Model::new(input).map(|_| ()) {
        Err(ModelError::Wall { problem, .. }) => assert!(problem.contains(words), "{problem}"),
        other => panic!("{other:?}"),
    };
    refused(
        on_floor(material(), RigidBody { rounding: Some(0.06), ..free(4.0) }, 0.1),
        "too large for its surface",
    );
    refused(on_floor(material(), RigidBody { rounding: Some(0.0), ..free(4.0) }, 0.1), "must be positive");
    let hard = Material { young: Some(1e10), poisson: 0.2, stiffness: f64::INFINITY, ..material() };
    let crushing = Material { corner_strength: 1e8, corner_angle: 1.3, ..hard };
    refused(on_floor(crushing, free(4.0), 0.1), "only linear and Hertz contacts");

    let fails = |input: ModelInput| {
        let mut run = Run::new(input);
        loop {
            match trackbed_dem::step(&run.model, &mut run.state, &mut run.work, &NoSurface, &[]) {
                Err(e) => break (e, run.state.wall_offset(1).z),
                Ok(()) => assert!(run.state.time < 1.0),
            }
        }
    };
    match Model::new(on_floor(crate::scene::rigid(material()), free(4.0), 0.1)).map(|_| ()) {
        Err(ModelError::RigidPair { a, b }) => {
            assert!(a == "the rigid body of wall 1" && b == "wall 0", "{a} {b}")
        }
        other => panic!("{other:?}"),
    }

    let thrown = |speed: f64| RigidBody { velocity: Vec3::z() * -speed, ..free(4.0) };
    let soft = Material { stiffness: 1e4, ..material() };
    let (error, _) = fails(on_floor(soft, thrown(3.0), 0.02));
    assert!(matches!(error, StepError::WallsOverlap { walls: [1, 0], .. }), "{error}");
    assert!(error.to_string().contains("or `rounding`"), "{error}");
    let (error, _) = fails(on_floor(Material { stiffness: 1e3, ..material() }, thrown(400.0), 0.02));
    assert!(matches!(error, StepError::WallSpeed { wall: 1, .. }), "{error}");
    let turned = |axis: Vec3, at: Vec3| {
        let WallShape::Triangles { vertices, triangles } = cuboid(Vec3::zeros(), Vec3::new(0.1, 0.1, 0.1))
        else {
            panic!("triangles")
        };
        let turn = UnitQuaternion::from_scaled_axis(axis * std::f64::consts::FRAC_PI_4);
        WallShape::Triangles { vertices: vertices.iter().map(|v| turn * v + at).collect(), triangles }
    };
    let low = turned(Vec3::x(), Vec3::zeros());
    let pile = WallShape::Frustum {
        base: Vec3::new(-1.0, 0.0, 0.1),
        axis: Vec3::x(),
        height: 2.0,
        radii: [0.04; 2],
        caps: [false; 2],
    };
    let edge = 0.3 - 2.0_f64.sqrt() * (0.1 - 0.004);
    for (below, top) in [(low, 2.0_f64.sqrt() * 0.1), (pile, 0.14)] {
        let mut input = scene(soft);
        input.walls.push(WallInput::fixed(below, 0));
        let fixed = [true, true, false, true, true, true];
        let above = turned(Vec3::y(), Vec3::new(0.013, 0.007, 0.3));
        input.walls.push(rigid(above, RigidBody { fixed, ..thrown(1.0) }));
        let (error, offset) = fails(input);
        assert!(matches!(error, StepError::WallsOverlap { walls: [1, 0], .. }), "{error}");
        // Close to the moment of crossing.
        assert!((-1e-3..2e-3).contains(&(offset + edge - top)), "{offset} {}", top - edge);
    }
}
