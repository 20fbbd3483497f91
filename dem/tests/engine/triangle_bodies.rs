//! Rigid bodies of triangles.

use crate::scene::{Run, free, plane, sphere, stone, weightless};
use trackbed_dem::{
    BodyInput, Material, Model, ModelError, ModelInput, RigidBody, StepError, TimeStep, Vec3, WallInput,
    WallShape, measure,
};

fn cuboid(centre: Vec3, half: Vec3, mass: f64) -> WallInput {
    WallInput { body: Some(free(mass)), ..WallInput::fixed(crate::scene::cuboid(centre, half), 0) }
}

fn with(material: Material) -> ModelInput {
    ModelInput { gravity: Vec3::new(0.0, 0.0, -9.81), ..weightless(material) }
}

fn body_of(wall: &mut WallInput) -> &mut RigidBody {
    wall.body.as_mut().expect("a body")
}

#[test]
fn free_flight() {
    let mut input = with(stone());
    input.time_step = TimeStep::Fixed(1e-4);
    let mut wall = cuboid(Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.3, 0.2, 0.1), 50.0);
    body_of(&mut wall).spin = Vec3::new(0.1, 7.0, 0.2);
    body_of(&mut wall).velocity = Vec3::new(1.0, 0.0, 2.0);
    input.walls.push(wall);
    let mut run = Run::new(input);
    let start = measure::momentum(&run.model, &run.state);
    let kinetic = |run: &Run| measure::energies(&run.model, &run.state).kinetic_rotation;
    let (first, mut worst) = (kinetic(&run), 0.0_f64);
    // Moments m/12 (b² + c²).
    let exact = 0.5 * 50.0 / 3.0 * ((0.04 + 0.01) * 0.01 + (0.09 + 0.01) * 49.0 + (0.09 + 0.04) * 0.04);
    assert!((first / exact - 1.0).abs() < 1e-12, "{first} {exact}");
    for _ in 0..20_000 {
        run.step();
        worst = worst.max((kinetic(&run) / first - 1.0).abs());
    }
    let t = run.state.time;
    let end = measure::momentum(&run.model, &run.state);
    let impulse = run.state.balance.impulse();
    eprintln!("rotation energy drift {worst:e} over {t} s");
    assert!(worst < 1e-12);
    assert!((end.linear - start.linear - impulse.linear).norm() < 1e-9 * 50.0);
    assert!((end.angular - start.angular - impulse.angular).norm() < 1e-9 * 50.0);
    let fall = Vec3::new(1.0, 0.0, 2.0) * t - Vec3::z() * 4.905 * t * t;
    assert!((run.state.wall_offset(0) - fall).norm() < 1e-9 * fall.norm());
    // The intermediate axis is unstable.
    let up = run.state.wall_orientation(0) * Vec3::y();
    assert!(t > 1.0 && (up - Vec3::y()).norm() > 1e-3, "{t} {up}");
}

#[test]
fn cube_at_rest_on_spheres() {
    let mut input = with(Material { restitution: 0.2, tangential_damping_ratio: 0.5, ..stone() });
    for (x, y) in [(-0.03, -0.03), (0.03, -0.03), (0.03, 0.03), (-0.03, 0.03)] {
        input.bodies.push(BodyInput { fixed: [true; 6], ..sphere(Vec3::new(x, y, 0.0), Vec3::zeros()) });
    }
    let mass = 2.0;
    input.walls.push(cuboid(Vec3::new(0.002, 0.001, 0.06), Vec3::repeat(0.05), mass));
    // Free to roll, it would never come to rest on the tilted top.
    let fixed = [true, true, false, true, true, true];
    input.bodies.push(BodyInput { fixed, ..sphere(Vec3::new(0.0, 0.0, 0.1201), Vec3::zeros()) });
    let mut run = Run::new(input);
    while run.state.time < 2.0 {
        run.step();
    }
    let (weight, load) = (mass * 9.81, run.model.mass(4) * 9.81);
    let below: Vec3 = (0..4).map(|b| run.work.contact_force(&run.state, b)).sum();
    eprintln!(
        "below {:e}, on top {:e}",
        below.z / -(weight + load) - 1.0,
        run.work.contact_force(&run.state, 4).z / load - 1.0
    );
    assert!((below.z + weight + load).abs() < 1e-8 * weight, "{below} {weight}");
    assert!((run.work.contact_force(&run.state, 4).z / load - 1.0).abs() < 1e-8);
    assert_eq!(run.state.wall_contact_count(), 5);
    let (force, moment) = run.state.wall_force(0);
    assert!(
        (force - Vec3::z() * weight).norm() < 1e-8 * weight && moment.norm() < 1e-8 * weight * 0.05,
        "{moment}"
    );
}

#[test]
fn box_stands_on_its_vertices() {
    let mut input = with(Material { restitution: 0.3, ..stone() });
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    let mut wall = cuboid(Vec3::new(0.0, 0.0, 0.06), Vec3::new(0.06, 0.05, 0.04), 1.5);
    body_of(&mut wall).spin = Vec3::new(2.0, -1.0, 0.5);
    input.walls.push(wall);
    let mut run = Run::new(input);
    let total = |run: &Run| {
        measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated()
            - run.state.balance.work()
    };
    let (start, before) = (total(&run), measure::momentum(&run.model, &run.state));
    let mut worst = 0.0_f64;
    while run.state.time < 2.5 {
        run.step();
        worst = worst.max((total(&run) - start).abs());
    }
    let lost = run.state.balance.dissipated();
    eprintln!("energy error {worst:e} of {lost:e} J");
    assert!(worst < 0.02 * lost, "{worst:e} {lost:e}");
    let after = measure::momentum(&run.model, &run.state);
    let impulse = run.state.balance.impulse();
    assert!((after.linear - before.linear - impulse.linear).norm() < 1e-10);
    assert!((after.angular - before.angular - impulse.angular).norm() < 1e-10);
    let rise = run.state.wall_offset(0).z + 0.06 - 0.04 + 1.5 * 9.81 / (4.0 * 1e5);
    assert!(rise.abs() < 1e-9, "{rise:e}");
    // Twisting on tangential springs is undamped.
    assert!(after.linear.norm() < 1e-6 && after.angular.norm() < 1e-3, "{after:?}");
}

#[test]
fn collision_conserves_momentum() {
    let mut input = weightless(Material { restitution: 1.0, friction: 0.6, ..stone() });
    input.walls.push(cuboid(Vec3::new(0.1, 0.0, 0.0), Vec3::new(0.03, 0.05, 0.04), 0.05));
    let ball = sphere(Vec3::new(0.05, 0.02, 0.01), Vec3::new(1.0, 0.1, 0.0));
    input.bodies.push(BodyInput { spin: Vec3::new(0.0, 0.0, 30.0), ..ball });
    let mut run = Run::new(input);
    let (start, energy) =
        (measure::momentum(&run.model, &run.state), measure::energies(&run.model, &run.state).total());
    while run.state.time < 0.1 {
        run.step();
    }
    let end = measure::momentum(&run.model, &run.state);
    assert!((end.linear - start.linear).norm() < 1e-15 && (end.angular - start.angular).norm() < 1e-15);
    assert!(run.state.velocity(0).x < 0.8 && run.state.wall_velocity(0).0.x > 0.1, "they must have met");
    let left = measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated();
    assert!((left / energy - 1.0).abs() < 1e-3, "{left} {energy}");
    assert_eq!(run.state.balance.work(), 0.0);
}

#[test]
fn central_impact_has_its_restitution() {
    for mass in [0.002, 0.02, 2.0] {
        let mut input = weightless(Material { restitution: 0.5, ..stone() });
        input.walls.push(cuboid(Vec3::new(0.1, 0.0, 0.0), Vec3::repeat(0.04), mass));
        input.bodies.push(sphere(Vec3::new(0.045, 0.0, 0.0), Vec3::x()));
        let mut run = Run::new(input);
        while run.state.time < 0.05 {
            run.step();
        }
        let apart = run.state.wall_velocity(0).0.x - run.state.velocity(0).x;
        assert!((apart - 0.5).abs() < 5e-3, "{mass} kg: {apart}");
    }
}

#[test]
fn held_body_stays() {
    let mut input = with(stone());
    let mut wall = cuboid(Vec3::new(0.0, 0.0, 0.05), Vec3::repeat(0.03), 1.0);
    *body_of(&mut wall) = RigidBody {
        fixed: [true, true, false, true, true, true],
        spin: Vec3::z(),
        ..body_of(&mut wall).clone()
    };
    input.walls.push(wall);
    input.bodies.push(BodyInput { fixed: [true; 6], ..sphere(Vec3::new(0.012, 0.0, 0.0), Vec3::zeros()) });
    let mut run = Run::new(input);
    let before = measure::momentum(&run.model, &run.state);
    while run.state.time < 0.5 {
        run.step();
    }
    let (v, w) = run.state.wall_velocity(0);
    assert!(v.xy().norm() == 0.0 && (w - Vec3::z()).norm() < 1e-12, "{v} {w}");
    let after = measure::momentum(&run.model, &run.state);
    let impulse = run.state.balance.impulse();
    assert!((after.linear - before.linear - impulse.linear).norm() < 1e-10);
    assert!((after.angular - before.angular - impulse.angular).norm() < 1e-10);
}

#[test]
fn refusals() {
    let with_wall = |wall: WallInput| {
        let mut input = with(stone());
        input.walls.push(wall);
        Model::new(input).map(|_| ())
    };
    let fails = |wall: WallInput, words: &str| match with_wall(wall) {
        Err(ModelError::Wall { problem, .. }) => assert!(problem.contains(words), "{problem}"),
        other => panic!("{other:?}"),
    };
    let good = || cuboid(Vec3::zeros(), Vec3::repeat(0.1), 1.0);
    with_wall(good()).unwrap();
    let mut open = good();
    if let WallShape::Triangles { triangles, .. } = &mut open.shape {
        triangles.pop();
    }
    fails(open, "not closed");
    let mut light = good();
    body_of(&mut light).mass = 0.0;
    fails(light, "mass must be positive");
    let mut odd = good();
    (body_of(&mut odd).centre, body_of(&mut odd).inertia) =
        (Some(Vec3::zeros()), Some([1.0, 1.0, 3.0, 0.0, 0.0, 0.0]));
    fails(odd, "not those of a rigid body");
    fails(
        WallInput { shape: WallShape::Plane { point: Vec3::zeros(), normal: Vec3::z() }, ..good() },
        "an infinite plane",
    );
    let mut moved = good();
    moved.motion.velocity = Vec3::x();
    fails(moved, "no prescribed motion");

    let mut input = with(stone());
    let round = |z: f64, velocity: Vec3| {
        let shape = WallShape::Sphere { centre: Vec3::z() * z, radius: 0.1 };
        WallInput { body: Some(RigidBody { velocity, ..free(1.0) }), ..WallInput::fixed(shape, 0) }
    };
    input.walls.extend([round(0.0, Vec3::zeros()), round(0.31, -Vec3::z())]);
    let mut run = Run::new(input);
    let error = loop {
        let surface = trackbed_dem::surface::NoSurface;
        if let Err(e) = trackbed_dem::step(&run.model, &mut run.state, &mut run.work, &surface, &[]) {
            break e;
        }
        assert!(run.state.time < 1.0);
    };
    assert!(matches!(error, StepError::WallsMeet { walls: [0, 1], .. }), "{error}");
    assert!((run.state.time - 0.11).abs() < 1e-3, "{}", run.state.time);
}

#[test]
fn a_light_body_sets_the_step() {
    let mut input = with(stone());
    input.bodies.push(sphere(Vec3::zeros(), Vec3::zeros()));
    let alone = Model::new(input.clone()).unwrap().dt();
    input.walls.push(cuboid(Vec3::new(0.0, 0.0, 0.5), Vec3::repeat(0.05), 1e-3));
    let model = Model::new(input).unwrap();
    assert!(model.dt() < alone);
    assert!(model.describe_limit().starts_with("the rigid body of wall 0"), "{}", model.describe_limit());
}
