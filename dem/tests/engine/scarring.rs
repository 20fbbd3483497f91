//! Scarring: sinkage, soil drag, growing friction, balances.

use crate::scene::{Random, Run, block, body, stone, weightless};
use nalgebra::UnitQuaternion;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::{
    BodyInput, Material, Model, ModelError, ModelInput, Motion, Scarring, Shape, State, TimeStep, Vec3,
    WallInput, WallShape, Work, measure,
};

const G: f64 = 9.81;
const FOLLOWS: TimeStep = TimeStep::Measured { share: 0.1, longest: 2e-4, collisions: true };
/// Half sides of a slab, edge radius [m].
const HALF: [f64; 3] = [0.4, 0.4, 0.2];
const ROUND: f64 = 0.05;

const SOFT: Scarring =
    Scarring { strength: 15e6, drag: 0.0, density: 1700.0, friction: [0.0; 2], growth: 3.0, decay: 185.0 };

fn ground(angle: f64, scarring: Scarring) -> WallInput {
    let at = |x: f64, y: f64| Vec3::new(x, y, -x * angle.tan());
    let vertices = vec![at(-50.0, -50.0), at(200.0, -50.0), at(-50.0, 50.0), at(200.0, 50.0)];
    let shape = WallShape::Triangles { vertices, triangles: vec![[0, 1, 3], [0, 3, 2]] };
    WallInput { scarring: Some(scarring), ..WallInput::fixed(shape, 0) }
}

fn scene(scarring: Scarring) -> ModelInput {
    let rock = Material {
        stiffness: 5e7,
        restitution: 0.05,
        friction: 0.9,
        tangential_damping_ratio: 1.0,
        ..stone()
    };
    let slab = block(HALF, ROUND);
    let mut input = ModelInput { shapes: vec![slab], time_step: FOLLOWS, ..weightless(rock) };
    input.gravity = Vec3::z() * -G;
    input.walls.push(ground(0.0, scarring));
    input
}

fn slab(scarring: Scarring, velocity: Vec3) -> Run {
    let mut input = scene(scarring);
    input.bodies.push(BodyInput { velocity, ..body(0, Vec3::z() * (HALF[2] + 1e-4)) });
    Run::new(input)
}

fn depth(run: &Run) -> f64 {
    HALF[2] - run.state.position(0).z
}

fn account(run: &Run) -> f64 {
    measure::energies(&run.model, &run.state).total() + run.state.balance.dissipated()
        - run.state.balance.work()
}

#[test]
fn sinkage_matches_impact_speed() {
    for (strength, speed) in [(15e6, 5.0), (15e6, 2.0), (5e6, 4.0)] {
        let law = Scarring { strength, ..SOFT };
        let mut run = slab(law, Vec3::z() * -speed);
        let mass = run.model.mass(0);
        run.follow_until(1.5);
        let expected = law.depth(mass, f64::sqrt(speed * speed + 2.0 * G * 1e-4));
        let found = depth(&run);
        println!("{strength:e} Pa, {speed} m/s: {found:.5} m of {expected:.5} m");
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
        assert!(run.state.velocity(0).norm() < 1e-3);
    }
}

/// 1/u grows with ½ C ρ A t/m, A the slab's front.
#[test]
fn drag_matches_front_in_soil() {
    let law = Scarring { drag: 2.5, ..SOFT };
    let mut run = slab(law, Vec3::new(12.0, 0.0, -5.0));
    let mass = run.model.mass(0);
    run.follow_until(0.25);
    let (t, u, deep) = (run.state.time, run.state.velocity(0).x, depth(&run));
    run.follow_until(0.75);
    // Two visible edges are rounded.
    let front = 2.0 * HALF[1] * deep - (2.0 - std::f64::consts::FRAC_PI_2) * ROUND * ROUND;
    let rate = 0.5 * law.drag * law.density * front / mass;
    let found = (1.0 / run.state.velocity(0).x - 1.0 / u) / (run.state.time - t);
    println!(
        "{deep:.4} m deep, from {u:.3} to {:.3} m/s: rate {found:.5} of {rate:.5} 1/m",
        run.state.velocity(0).x
    );
    assert!(u - run.state.velocity(0).x > 2.0);
    assert!((found / rate - 1.0).abs() < 2e-3, "{found} {rate}");
    assert!((depth(&run) - deep).abs() < 1e-4);
}

/// Loss m g ∫ μ ds from the first contact.
#[test]
fn friction_grows_with_the_way() {
    let law = Scarring { friction: [0.1, 0.6], growth: 2.0, ..SOFT };
    let mut run = slab(law, Vec3::new(6.0, 0.0, -0.3));
    // Bouncing is over; contact since then.
    run.follow_until(0.2);
    let (x, u) = (run.state.position(0).x, run.state.velocity(0).x);
    run.follow_until(0.9);
    let (far, slow) = (run.state.position(0).x, run.state.velocity(0).x);
    let sum = |s: f64| {
        let k = law.growth;
        let [a, b] = law.friction;
        a * s
            + std::f64::consts::FRAC_2_PI
                * (b - a)
                * (s * (k * s).atan() - (k * k * s * s).ln_1p() / (2.0 * k))
    };
    let lost = 0.5 * (u * u - slow * slow);
    let expected = G * (sum(far) - sum(x));
    println!(
        "from {x:.3} to {far:.3} m: {lost:.4} of {expected:.4} J/kg; with μ₀ {:.4}",
        G * 0.1 * (far - x)
    );
    assert!((lost / expected - 1.0).abs() < 0.01, "{lost} {expected}");
}

fn tumbling() -> ModelInput {
    let mut input = scene(SOFT);
    input.materials[0].restitution = 0.5;
    let law = Scarring { strength: 8e6, drag: 2.0, friction: [0.5, 1.5], ..SOFT };
    input.walls = vec![ground(0.6, law)];
    let disk = Dilated::disk(0.3, 0.08).expect("a disk");
    input.shapes.push(Shape::Polyhedron(Box::new(disk)));
    let mut random = Random::new(5);
    for k in 0..8_usize {
        let position = Vec3::new(0.5 * (k % 4) as f64, 3.0 * k as f64 - 10.0, 0.7);
        input.bodies.push(BodyInput {
            orientation: UnitQuaternion::from_scaled_axis(random.vector() * 3.0),
            velocity: Vec3::new(6.0, 0.0, -2.0) + random.vector(),
            spin: random.vector() * 10.0,
            ..body(k % 2, position)
        });
    }
    input
}

fn bits(state: &State) -> Vec<u8> {
    postcard::to_allocvec(state).expect("a state")
}

#[test]
fn balances_close_and_bits_agree() {
    let run_in = |threads: usize, restart: bool| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut run = Run::new(tumbling());
            let (before, start) = (account(&run), measure::momentum(&run.model, &run.state));
            let mut k = 0;
            while run.state.time < 1.5 {
                k += 1;
                if restart && k % 7000 == 3000 {
                    run.state = postcard::from_bytes(&bits(&run.state)).expect("a state");
                    run.work = Work::new(&run.model, &run.state);
                }
                run.follow();
            }
            let (end, impulse) = (measure::momentum(&run.model, &run.state), run.state.balance.impulse());
            let off = (end.linear - start.linear - impulse.linear).norm() / impulse.linear.norm();
            let turn = (end.angular - start.angular - impulse.angular).norm() / impulse.angular.norm();
            let turned = run.state.balance.dissipated() + run.state.balance.work().abs();
            let error = (account(&run) - before).abs() / turned;
            println!(
                "{threads} threads, {:.2} s in {k} steps: energy {error:.1e}, momentum {off:.1e}, angular {turn:.1e}, soil {:.0} J",
                run.state.time, run.state.balance.work_body_forces
            );
            assert!(error < 3e-3 && off < 1e-10 && turn < 1e-10, "{error:e} {off:e} {turn:e}");
            assert!(run.state.balance.work_body_forces < -1e4);
            bits(&run.state)
        })
    };
    let one = run_in(1, false);
    assert!(one == run_in(3, false), "three threads differ from one");
    assert!(one == run_in(1, true), "a restart differs");
}

#[test]
fn refusals() {
    let refused = |input: ModelInput, what: &str| match Model::new(input) {
        Err(ModelError::Wall { problem, .. }) => assert!(problem.contains(what), "{problem}"),
        other => panic!("{what}: {:?}", other.err()),
    };
    let mut spheres = scene(SOFT);
    spheres.shapes.push(Shape::Sphere { radius: 0.1 });
    spheres.bodies.push(body(1, Vec3::z()));
    refused(spheres, "polyhedra and disks");
    let mut floating = scene(SOFT);
    floating.gravity = Vec3::zeros();
    refused(floating, "gravity");
    let mut moving = scene(SOFT);
    moving.walls[0].motion = Motion { velocity: Vec3::x(), ..Motion::default() };
    refused(moving, "must be of triangles and fixed");
    let mut round = scene(SOFT);
    round.walls[0].shape = WallShape::Sphere { centre: Vec3::zeros(), radius: 1.0 };
    refused(round, "triangles");
    for wrong in [
        Scarring { strength: 0.0, ..SOFT },
        Scarring { friction: [0.5, 0.4], ..SOFT },
        Scarring { drag: -1.0, ..SOFT },
        Scarring { decay: f64::NAN, ..SOFT },
    ] {
        refused(scene(wrong), "strength above zero");
    }
}
