//! Rigid walls on supports: triangles and round shapes under all grain shapes.

use crate::scene::{Random, Run, block, body, clump, cuboid, free, plane, sphere, stone, weightless};
use nalgebra::UnitQuaternion;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::{
    BodyInput, Material, Model, ModelError, ModelInput, Mount, RigidBody, Shape, State, TimeStep, Vec3,
    WallInput, WallShape, Work, measure, stability,
};

const G: f64 = 9.81;

const FOLLOWS: TimeStep = TimeStep::Measured { share: 0.8, longest: f64::INFINITY, collisions: true };

fn elastic() -> Material {
    Material { friction: 0.0, restitution: 1.0, tangential_ratio: 0.0, stiffness: 1e6, ..stone() }
}

fn disk(radius: f64, rounding: f64) -> Shape {
    Shape::Polyhedron(Box::new(Dilated::disk(radius - rounding, rounding).expect("a disk")))
}

fn pile(centre: Vec3, radius: f64, height: f64) -> WallShape {
    WallShape::Frustum {
        base: centre - Vec3::z() * (0.5 * height),
        axis: Vec3::z(),
        height,
        radii: [radius; 2],
        caps: [true; 2],
    }
}

fn on_mount(mass: f64, axis: usize, stiffness: f64, damping: f64) -> RigidBody {
    let along = |x: f64| Vec3::from_fn(|d, _| if d == axis { x } else { 0.0 });
    let mount = Mount { stiffness: along(stiffness), damping: along(damping) };
    let fixed = std::array::from_fn(|k| k != axis);
    RigidBody { fixed, mount: Some(mount), ..free(mass) }
}

fn wall(shape: WallShape, body: RigidBody) -> WallInput {
    WallInput { body: Some(body), ..WallInput::fixed(shape, 0) }
}

/// Energy balance: stored plus dissipated minus external work [J].
fn account(run: &Run) -> f64 {
    measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated()
        - run.state.balance.work()
}

#[test]
fn free_vibration() {
    let (mass, stiffness, speed) = (2.0, 800.0, 0.3);
    let omega = f64::sqrt(stiffness / mass);
    for zeta in [0.0, 0.03, 0.4] {
        let damping = 2.0 * zeta * mass * omega;
        let mut errors = Vec::new();
        for h in [4e-3, 2e-3, 1e-3] {
            let mut input = ModelInput { time_step: TimeStep::FixedAboveLimit(h), ..weightless(stone()) };
            let start = RigidBody { velocity: Vec3::y() * speed, ..on_mount(mass, 1, stiffness, damping) };
            let start = RigidBody { fixed: [true, false, true, true, true, true], ..start };
            input.walls.push(wall(WallShape::Sphere { centre: Vec3::x(), radius: 0.1 }, start));
            let mut run = Run::new(input);
            let first = account(&run);
            let (a, square) = (damping * h / (2.0 * mass), (omega * h).powi(2));
            let (root, angle) =
                (((1.0 - a) / (1.0 + a)).sqrt(), ((2.0 - square) / (2.0 * (1.0 - a * a).sqrt())).acos());
            let damped = omega * (1.0 - zeta * zeta).sqrt();
            let (mut off, mut far, mut energy) = (0.0_f64, 0.0_f64, 0.0_f64);
            let steps = (2.0 / h) as i32;
            for n in 1..=steps {
                run.step();
                let u = run.state.wall_offset(0).y;
                let t = f64::from(n) * h;
                let exact = speed / damped * (-zeta * omega * t).exp() * (damped * t).sin();
                let own =
                    h * speed * (1.0 - a) * root.powi(n - 1) * (f64::from(n) * angle).sin() / angle.sin();
                off = off.max((u - exact).abs() * damped / speed);
                far = far.max((u - own).abs() * damped / speed);
                energy = energy.max((account(&run) / first - 1.0).abs());
            }
            assert!(far < 1e-10, "{zeta} {h}: {far:e} from the recurrence");
            let frequency = angle / h / damped - 1.0;
            let decay = if zeta > 0.0 { -root.ln() / h / (zeta * omega) - 1.0 } else { 0.0 };
            println!(
                "ζ = {zeta}, h = {h}: path {off:.2e}, frequency {frequency:.2e}, decay {decay:.2e}, energy {energy:.2e}"
            );
            errors.push([off, frequency, decay, energy]);
            let momentum = measure::momentum(&run.model, &run.state).linear
                - Vec3::y() * (mass * speed * (1.0 + a))
                - run.state.balance.impulse().linear;
            assert!(momentum.norm() < 1e-12 * mass * speed, "{momentum}");
        }
        for pair in errors.windows(2) {
            for k in 0..4 {
                let order = (pair[0][k] / pair[1][k]).log2();
                assert!(
                    (k == 2 && zeta == 0.0) || (order - 2.0).abs() < 0.15,
                    "ζ = {zeta}: order {order} of {k}"
                );
            }
        }
    }
}

fn targets() -> [(&'static str, WallShape); 4] {
    let middle = Vec3::new(0.2, 0.0, 0.0);
    [
        ("box", cuboid(middle, Vec3::new(0.08, 0.1, 0.12))),
        ("pile", pile(middle, 0.08, 0.4)),
        ("ball", WallShape::Sphere { centre: middle, radius: 0.08 }),
        (
            "cone",
            WallShape::Frustum {
                base: middle - Vec3::z() * 0.2,
                axis: Vec3::z(),
                height: 0.4,
                radii: [0.1, 0.05],
                caps: [true; 2],
            },
        ),
    ]
}

#[test]
fn collisions_keep_momentum_and_energy() {
    let shapes = [
        ("sphere", Shape::Sphere { radius: 0.03 }),
        ("clump", Shape::Clump(clump())),
        ("block", block([0.05, 0.04, 0.03], 0.006)),
        ("disk", disk(0.05, 0.01)),
    ];
    let mut random = Random::new(11);
    for (name, shape) in &shapes {
        for (what, target) in targets() {
            let (mut worst, mut off, mut turn, mut touched) = (0.0_f64, 0.0_f64, 0.0_f64, 0);
            for _ in 0..4 {
                let mut input = ModelInput { shapes: vec![shape.clone()], ..weightless(elastic()) };
                input.time_step = TimeStep::Auto { fraction: 0.05 };
                let mass = 0.5 + random.unit();
                input.walls.push(wall(target.clone(), free(mass)));
                let (orientation, aside) =
                    (UnitQuaternion::from_scaled_axis(random.vector() * 3.0), random.vector() * 0.03);
                let (velocity, spin) = (Vec3::x(), random.vector() * 3.0);
                let position = Vec3::new(0.02, aside.y, aside.z);
                input.bodies.push(BodyInput { orientation, velocity, spin, ..body(0, position) });
                let mut run = Run::new(input);
                let (before, start) = (account(&run), measure::momentum(&run.model, &run.state));
                run.until(0.25);
                let (after, end) = (account(&run), measure::momentum(&run.model, &run.state));
                let impulse = run.state.balance.impulse();
                let exchanged = mass * run.state.wall_velocity(0).0.norm();
                touched += i32::from(exchanged > 1e-3);
                worst = worst.max((after / before - 1.0).abs());
                off = off.max((end.linear - start.linear).norm() / start.linear.norm());
                turn = turn.max((end.angular - start.angular - impulse.angular).norm() / start.linear.norm());
            }
            println!(
                "{name} on {what}: {touched} hits, energy {worst:.1e}, momentum {off:.1e}, angular {turn:.1e}"
            );
            assert!(touched >= 3 && worst < 3e-3 && off < 1e-12 && turn < 1e-12, "{name} on {what}");
        }
    }
}

#[test]
fn central_impacts_have_their_restitution() {
    for (name, shape, half) in [("block", block([0.05; 3], 0.01), 0.05), ("disk", disk(0.05, 0.02), 0.02)] {
        for mass in [0.3, 3.0, 300.0] {
            let material = Material { restitution: 0.5, ..elastic() };
            let mut input = ModelInput { shapes: vec![shape.clone()], ..weightless(material) };
            input.time_step = TimeStep::Auto { fraction: 0.05 };
            let target = cuboid(Vec3::new(0.0, 0.0, 0.3), Vec3::new(0.2, 0.2, 0.1));
            input.walls.push(wall(target, free(mass)));
            input.bodies.push(BodyInput { velocity: Vec3::z(), ..body(0, Vec3::z() * (0.19 - half)) });
            let mut run = Run::new(input);
            run.until(0.05);
            let apart = run.state.wall_velocity(0).0.z - run.state.velocity(0).z;
            println!("{name} on {mass} kg: {apart:.4}");
            assert!((apart - 0.5).abs() < 5e-3, "{name}, {mass} kg: {apart}");
            assert!(run.state.velocity(0).z < 0.9, "they must have met");
        }
    }
}

#[test]
fn a_sprung_plate_sags() {
    let (mass, stiffness) = (4.0, 2e4);
    let plates = [
        ("slab", cuboid(Vec3::z() * -0.05, Vec3::new(0.3, 0.3, 0.05))),
        ("disc", pile(Vec3::z() * -0.05, 0.4, 0.1)),
    ];
    for (name, plate) in plates {
        for (what, shape, half) in
            [("block", block([0.1, 0.08, 0.06], 0.01), 0.06), ("disk", disk(0.1, 0.02), 0.02)]
        {
            let material = Material {
                restitution: 0.3,
                friction: 0.4,
                tangential_ratio: 0.5,
                stiffness: 1e5,
                ..elastic()
            };
            let mut input = ModelInput { shapes: vec![shape], ..weightless(material) };
            input.gravity = Vec3::new(0.0, 0.0, -G);
            input.time_step = FOLLOWS;
            input.walls.push(wall(plate.clone(), on_mount(mass, 2, stiffness, 250.0)));
            input.bodies.push(body(0, Vec3::new(0.02, 0.01, half + 0.01)));
            let mut run = Run::new(input);
            let (before, start) = (account(&run), measure::momentum(&run.model, &run.state));
            let mut worst = 0.0_f64;
            while run.state.time < 2.5 {
                run.follow();
                worst = worst.max((account(&run) - before).abs());
            }
            let whole = mass + run.model.mass(0);
            let sag = -run.state.wall_offset(0).z * stiffness / (whole * G) - 1.0;
            let balance = run.state.balance;
            println!(
                "{name} under {what}: sag off by {sag:.1e}, account by {:.1e}",
                worst / balance.dissipated()
            );
            assert!(sag.abs() < 1e-7, "{name} {what}: {sag:e}");
            assert!(worst < 0.01 * balance.dissipated(), "{name} {what}: {worst:e}");
            let end = measure::momentum(&run.model, &run.state);
            let (off, turn) = (
                end.linear - start.linear - balance.impulse().linear,
                end.angular - start.angular - balance.impulse().angular,
            );
            let whole = balance.impulse().linear.norm().max(balance.gravity.linear.norm());
            assert!(off.norm() < 1e-10 * whole && turn.norm() < 1e-10 * whole, "{off} {turn}");
            let held = run.state.wall_force(0).0.z / (run.model.mass(0) * G);
            assert!((held + 1.0).abs() < 1e-7 && balance.dissipated_mounts > 0.0, "{held}");
        }
    }
}

/// Exact step of u'' + 2ζω u' + ω² u = p, p linear: N. C. Nigam and P. C. Jennings, Bull. Seismol. Soc. Am.
/// 59 (1969) 909–922.
struct Recurrence {
    omega: f64,
    zeta: f64,
}

impl Recurrence {
    fn step(&self, [u, v]: [f64; 2], [p, q]: [f64; 2], h: f64) -> [f64; 2] {
        let (w, z) = (self.omega, self.zeta);
        let damped = w * (1.0 - z * z).sqrt();
        // Particular solution b + s t.
        let slope = (q - p) / h;
        let s = slope / (w * w);
        let b = p / (w * w) - 2.0 * z * slope / w.powi(3);
        let (c, d) = (u - b, (v - s + z * w * (u - b)) / damped);
        let (sine, cosine) = (damped * h).sin_cos();
        let fade = (-z * w * h).exp();
        let x = fade * (c * cosine + d * sine);
        let dx = fade * ((d * damped - z * w * c) * cosine - (c * damped + z * w * d) * sine);
        [x + b + s * h, dx + s]
    }
}

#[test]
fn response_to_the_recorded_force() {
    let (mass, frequency, zeta) = (40.0, 2.5, 0.03);
    let omega = std::f64::consts::TAU * frequency;
    let mut errors = Vec::new();
    for h in [4e-5, 2e-5] {
        let material = Material { restitution: 0.3, stiffness: 1e5, ..elastic() };
        let mut input = ModelInput { shapes: vec![block([0.1, 0.1, 0.05], 0.01)], ..weightless(material) };
        input.time_step = TimeStep::Fixed(h);
        let held = on_mount(mass, 0, mass * omega * omega, 2.0 * zeta * mass * omega);
        input.walls.push(wall(pile(Vec3::x() * 0.31, 0.2, 2.0), held));
        for k in 0..4 {
            let at = Vec3::new(-0.3 * f64::from(k), 0.01 * f64::from(k), 0.0);
            input.bodies.push(BodyInput { velocity: Vec3::x() * 1.5, ..body(0, at) });
        }
        let mut run = Run::new(input);
        let recurrence = Recurrence { omega, zeta };
        let (mut now, mut last) = ([0.0; 2], None::<f64>);
        let (mut most, mut off, mut impacts) = (0.0_f64, 0.0_f64, 0);
        while run.state.time < 1.5 {
            let before = run.state.wall_offset(0).x;
            run.step();
            // Force and position of the previous step.
            let p = run.state.wall_force(0).0.x / mass;
            if let Some(last) = last {
                now = recurrence.step(now, [last, p], h);
            }
            impacts += i32::from(last == Some(0.0) && p != 0.0);
            last = Some(p);
            (most, off) = (most.max(before.abs()), off.max((before - now[0]).abs()));
        }
        println!("h = {h}: {impacts} impacts, largest way {most:.4e} m, off by {:.2e} of it", off / most);
        assert!(impacts >= 4 && most > 0.01, "{impacts} {most}");
        errors.push(off / most);
    }
    assert!(errors[0] < 1e-5 && errors[0] > 3.0 * errors[1], "{errors:?}");
}

fn crowd() -> ModelInput {
    let contact = Material { stiffness: 1e5, ..elastic() };
    let material = Material { restitution: 0.4, friction: 0.3, tangential_ratio: 0.5, ..contact };
    let shapes = vec![
        block([0.05, 0.04, 0.03], 0.006),
        disk(0.05, 0.01),
        Shape::Sphere { radius: 0.03 },
        Shape::Clump(clump()),
    ];
    let mut input = ModelInput { shapes, ..weightless(material) };
    input.gravity = Vec3::new(0.0, 0.0, -G);
    input.time_step = FOLLOWS;
    input.planes.push(plane(Vec3::z() * -0.6, Vec3::z()));
    let mount = Mount { stiffness: Vec3::new(3e3, 2e3, 8e3), damping: Vec3::new(10.0, 20.0, 40.0) };
    let slab = cuboid(Vec3::z() * -0.1, Vec3::new(0.3, 0.2, 0.05));
    input.walls.push(wall(slab, RigidBody { mount: Some(mount), ..free(8.0) }));
    let held = on_mount(3.0, 0, 2e3, 15.0);
    input.walls.push(wall(pile(Vec3::new(0.47, 0.0, 0.1), 0.1, 0.8), held));
    let mut random = Random::new(77);
    for k in 0..60 {
        let at = |n: i32, pitch: f64| (f64::from(n) - 1.5) * pitch;
        let place = Vec3::new(at(k % 4, 0.14), at(k / 4 % 3, 0.13), 0.05 + 0.13 * f64::from(k / 12));
        let orientation = UnitQuaternion::from_scaled_axis(random.vector() * 3.0);
        let velocity = random.vector() * 0.5 + Vec3::x();
        input.bodies.push(BodyInput { orientation, velocity, ..body(k as usize % 4, place) });
    }
    for body in input.bodies.iter_mut().filter(|b| b.shape == 3) {
        body.scale = 3.0;
    }
    input
}

fn bits(state: &State) -> Vec<u8> {
    postcard::to_stdvec(state).expect("a checkpoint")
}

#[test]
fn bits_are_independent_of_restart() {
    let run_in = |threads: usize, restart: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut run = Run::new(crowd());
            let (before, start) = (account(&run), measure::momentum(&run.model, &run.state));
            let mut most = [0.0_f64; 2];
            for k in 0..12_000 {
                if restart && k == 5000 {
                    run.state = postcard::from_bytes(&bits(&run.state)).expect("a state");
                    run.work = Work::new(&run.model, &run.state);
                }
                run.follow();
                (0..2).for_each(|w| most[w] = most[w].max(run.state.wall_force(w).0.norm()));
            }
            let end = measure::momentum(&run.model, &run.state);
            let impulse = run.state.balance.impulse();
            let off = (end.linear - start.linear - impulse.linear).norm();
            let error = (account(&run) - before).abs() / run.state.balance.dissipated();
            println!(
                "{threads} threads, t = {:.3} s: forces {most:?}, energy {error:.1e}, momentum {off:.1e}",
                run.state.time
            );
            assert!(most.iter().all(|f| *f > 10.0), "{most:?}");
            assert!(off < 1e-10 && error < 0.01, "{off:e} {error:e}");
            bits(&run.state)
        })
    };
    let one = run_in(1, false);
    assert!(one == run_in(3, false), "three threads differ from one");
    assert!(one == run_in(1, true), "a restart differs");
}

#[test]
fn the_step_knows_the_mount() {
    let (mass, stiffness) = (0.5, 4e8);
    let omega = f64::sqrt(stiffness / mass);
    let mut input = weightless(elastic());
    input.walls.push(wall(cuboid(Vec3::zeros(), Vec3::repeat(0.1)), on_mount(mass, 0, stiffness, 1e3)));
    let model = Model::new(input.clone()).expect("a model");
    assert!((model.dt_limit().dt * omega / 2.0 - 1.0).abs() < 1e-12, "{:?}", model.dt_limit());
    assert_eq!(model.describe_limit(), format!("the rigid body of wall 0 on its mount ({omega:.3e} rad/s)"));
    for (share, stable) in [(0.99, true), (1.01, false)] {
        let mut input = input.clone();
        input.time_step = TimeStep::FixedAboveLimit(share * 2.0 / omega);
        input.walls[0].body.as_mut().expect("a body").velocity = Vec3::x() * 1e-6;
        let mut run = Run::new(input);
        let surface = trackbed_dem::surface::NoSurface;
        let mut step =
            || trackbed_dem::step(&run.model, &mut run.state, &mut run.work, &surface, &[]).is_ok();
        let goes = (0..1000).all(|_| step());
        assert_eq!(goes && run.state.wall_offset(0).norm() < 1e-3 / omega, stable, "{share}");
    }
    // The support dominates the frequency of a light body.
    let (mass, stiffness) = (0.05, 2e7);
    input.walls[0].body = Some(on_mount(mass, 0, stiffness, 0.0));
    input.bodies.push(sphere(Vec3::new(-0.109, 0.0, 0.0), Vec3::zeros()));
    input.time_step = TimeStep::Auto { fraction: 0.1 };
    let mut run = Run::new(input);
    run.step();
    let (k, _) = run.model.contact_stiffness(0, 0);
    let (a, b, c) = (k / run.model.mass(0), k / (run.model.mass(0) * mass).sqrt(), (k + stiffness) / mass);
    let highest = 0.5 * (a + c) + (0.25 * (a - c).powi(2) + b * b).sqrt();
    let found = stability::limit(&run.model, &run.state) * highest.sqrt() / 2.0;
    println!("limit found over the true one: {found:.4}");
    assert!((0.95..=1.0).contains(&found), "{found}");
}

#[test]
fn refusals() {
    let refused = |shape: WallShape, body: RigidBody, words: &str| {
        let mut input = weightless(stone());
        input.walls.push(wall(shape, body));
        match Model::new(input) {
            Err(ModelError::Wall { problem, .. }) => assert!(problem.contains(words), "{problem}"),
            other => panic!("{other:?}"),
        }
    };
    let ball = || WallShape::Sphere { centre: Vec3::zeros(), radius: 1.0 };
    refused(WallShape::Plane { point: Vec3::zeros(), normal: Vec3::z() }, free(1.0), "an infinite plane");
    refused(ball(), RigidBody { spin: Vec3::z(), ..free(1.0) }, "rotates only if its inertia is given");
    refused(ball(), on_mount(1.0, 0, -1.0, 0.0), "zero or positive");
    refused(ball(), RigidBody { fixed: [true; 6], ..on_mount(1.0, 0, 1.0, 0.0) }, "a fixed direction");
}

#[test]
fn a_round_body_with_inertia_turns() {
    let mut input = ModelInput { shapes: vec![block([0.05, 0.04, 0.03], 0.006)], ..weightless(elastic()) };
    input.time_step = TimeStep::Auto { fraction: 0.05 };
    let body_of = RigidBody { inertia: Some([0.02, 0.02, 0.004, 0.0, 0.0, 0.0]), ..free(1.0) };
    input.walls.push(wall(pile(Vec3::new(0.2, 0.0, 0.0), 0.08, 0.4), body_of));
    input.bodies.push(BodyInput { velocity: Vec3::x(), ..body(0, Vec3::new(0.0, 0.0, 0.12)) });
    let mut run = Run::new(input);
    let (before, start) = (account(&run), measure::momentum(&run.model, &run.state));
    run.until(0.3);
    let end = measure::momentum(&run.model, &run.state);
    assert!((end.linear - start.linear).norm() < 1e-12 && (end.angular - start.angular).norm() < 1e-12);
    assert!((account(&run) / before - 1.0).abs() < 3e-3);
    assert!(run.state.wall_velocity(0).1.y > 0.5, "{}", run.state.wall_velocity(0).1);
    assert_eq!(run.state.balance.impulse().angular, Vec3::zeros());
}
