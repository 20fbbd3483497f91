use super::*;
use crate::base::Vec3;
use crate::bodies::input::BodyInput;
use crate::engine::input::ModelInput;
use crate::lanes::Simd;
use crate::law::LawTable;
use crate::law::material::{Material, PairOverride};
use crate::shape::Shape;
use crate::shape::clump::Clump;
use crate::shape::plane::Plane;
use crate::spatial::surface::NoSurface;

fn heap(hertz: bool, clumps: bool) -> Model {
    Model::new(heap_input(hertz, clumps)).unwrap()
}

fn heap_input(hertz: bool, clumps: bool) -> ModelInput {
    let soft = Material {
        density: 2600.0,
        tangential_ratio: 0.5,
        tangential_damping_ratio: 0.1,
        friction: 0.5,
        restitution: 0.5,
        ..Material::RIGID
    };
    let material = if hertz {
        Material { young: Some(5e7), poisson: 0.25, rolling_friction: 0.1, twisting_friction: 0.1, ..soft }
    } else {
        Material { stiffness: 1e5, ..soft }
    };
    let twins = Clump::from_spheres(&[([0.0; 3], 0.01), ([0.006, 0.0, 0.0], 0.008)]).unwrap();
    let mut input = ModelInput {
        materials: vec![material, Material { friction: 0.3, ..material }],
        shapes: vec![Shape::Sphere { radius: 0.01 }, Shape::Clump(twins)],
        ..ModelInput::default()
    };
    if !clumps {
        input.materials.truncate(1);
    } else if hertz {
        input.contacts.push(PairOverride { a: 0, b: 1, adhesion: Some(2.0), ..PairOverride::default() });
    }
    input.planes.push(Plane {
        point: Vec3::zeros(),
        normal: Vec3::z(),
        material: 0,
        velocity: Vec3::zeros(),
    });
    for k in 0..5001_u32 {
        let (x, y, z) = (f64::from(k % 15), f64::from(k / 15 % 15), f64::from(k / 225));
        let shift = 0.002 * (f64::from(k) * 1.7).sin();
        let position = Vec3::new(0.021 * x + shift, 0.021 * y - shift, 0.012 + 0.0205 * z);
        let odd = usize::from(clumps && k % 3 == 0);
        input.bodies.push(BodyInput {
            shape: odd,
            material: odd,
            position,
            velocity: Vec3::new(shift, 0.0, -1.0),
            ..BodyInput::default()
        });
    }
    if clumps && !hertz {
        input.shapes.push(Shape::Box { half: [0.1, 0.1, 0.01] });
        let (position, velocity) = (Vec3::new(0.15, 0.2, 0.4627), Vec3::new(0.0, 0.0, -3.0));
        input.bodies.push(BodyInput { shape: 2, position, velocity, ..BodyInput::default() });
    }
    input
}

fn bits(model: &Model, steps: usize, parallel: bool, simd: Simd) -> Vec<u64> {
    bits_above(0.1, model, steps, parallel, simd)
}

/// `least`: dissipation that shows contacts [J].
fn bits_above(least: f64, model: &Model, steps: usize, parallel: bool, simd: Simd) -> Vec<u64> {
    let mut state = State::new(model);
    let mut work = Work::new(model, &state);
    assert!(work.blocks.len() > 2);
    (work.parallel, work.simd) = (parallel, simd);
    for _ in 0..steps {
        step(model, &mut state, &mut work, &NoSurface, &[]).unwrap();
    }
    assert!(state.balance.dissipated() > least, "{} J at {} s", state.balance.dissipated(), state.time);
    let at = |b| [state.position(b), state.velocity(b), state.spin(b)];
    let l = &state.balance;
    let damped = l.local_damping.angular.y + l.dissipated_local_damping;
    let booked = [l.dissipated_dashpot, l.dissipated_friction, l.walls.angular.x, damped];
    let motion = (0..model.body_count()).flat_map(at).flat_map(|v| [v.x, v.y, v.z]);
    motion.chain(booked).map(f64::to_bits).collect()
}

#[test]
fn threaded_blocks_match_serial_bitwise() {
    let model = heap(false, false);
    let run = |parallel| bits(&model, 1500, parallel, Simd::best());
    assert!(run(false) == run(true));
}

#[test]
fn all_lanes_give_the_same_bits() {
    let kinds = [(false, false), (false, true), (true, false), (true, true)];
    for (k, (hertz, clumps)) in kinds.into_iter().enumerate() {
        let mut model = heap(hertz, clumps);
        model.damping = [0.0, 0.2, 0.2, 0.0][k];
        let plain = bits(&model, 500, false, Simd::Portable);
        for simd in Simd::all() {
            assert!(bits(&model, 500, false, simd) == plain, "{simd:?}, hertz {hertz}, clumps {clumps}");
        }
    }
}

/// Tables of one law and of its special case against the loops of any law (plain arrays on x86-64).
#[test]
fn loops_of_a_law_and_of_any_law_agree() {
    let rough = |m: Material| Material { asperity_friction: 0.4, asperity_pressure: 2e4, ..m };
    let conical = |m: Material| Material { corner_strength: 1e6, corner_angle: 1.3, ..m };
    for hertz in [false, true] {
        let mut input = heap_input(hertz, true);
        input.materials[0] = if hertz { conical(input.materials[0]) } else { rough(input.materials[0]) };
        input.contacts.clear();
        let model = Model::new(input).unwrap();
        assert_eq!(matches!(model.laws.table, LawTable::Rough(_)), !hertz);
        assert_eq!(matches!(model.laws.table, LawTable::Conical(_)), hertz);
        // Corners that crush have no dashpot and a short step.
        let (least, steps) = if hertz { (2e-5, 2000) } else { (0.1, 500) };
        let run = |simd| bits_above(least, &model, steps, false, simd);
        let plain = run(Simd::Portable);
        for simd in Simd::all() {
            assert!(run(simd) == plain, "{simd:?}, hertz {hertz}");
        }
    }
}

/// Applied forces, even zero, select the scalar path.
#[test]
fn four_move_as_one() {
    for (clumps, damping) in [(false, 0.0), (false, 0.3), (true, 0.0), (true, 0.3)] {
        let mut input = heap_input(false, clumps);
        for body in input.bodies.iter_mut().skip(5).step_by(31) {
            body.fixed = [true, false, false, false, true, false];
        }
        let mut model = Model::new(input).unwrap();
        model.damping = damping;
        let run = |applied: &[AppliedForce]| {
            let mut state = State::new(&model);
            let mut work = Work::new(&model, &state);
            for _ in 0..60 {
                step(&model, &mut state, &mut work, &NoSurface, applied).unwrap();
            }
            let far = (0..model.body_count()).flat_map(|b| [state.velocity(b), state.spin(b)]).collect();
            (far, state.balance)
        };
        let force = |body: usize, force: Vec3| AppliedForce { body, force, point: Vec3::zeros() };
        let some: Vec<_> = (0..5001).step_by(44).map(|b| force(b, Vec3::new(0.1, 0.3, -0.2))).collect();
        let all = (0..model.body_count()).map(|b| force(b, Vec3::zeros())).chain(some.clone());
        let ((four, a), (one, b)): ((Vec<Vec3>, _), (Vec<Vec3>, _)) =
            (run(&some), run(&all.collect::<Vec<_>>()));
        let case = format!("clumps {clumps}, damping {damping}");
        let size = one.iter().map(Vec3::norm).fold(0.0, f64::max);
        let off = four.iter().zip(&one).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max);
        assert!(off < 1e-9 * size, "{case}: {off:e} of {size:e}");
        let like = |x: f64, y: f64| assert!((x - y).abs() <= 1e-9 * y.abs(), "{case}: {x} {y}");
        like(a.dissipated_local_damping, b.dissipated_local_damping);
        like(a.local_damping.linear.norm(), b.local_damping.linear.norm());
        like(a.local_damping.angular.norm(), b.local_damping.angular.norm());
        assert!(b.dissipated_local_damping > 0.01 || damping == 0.0, "{}", b.dissipated_local_damping);
        like(a.work_applied, b.work_applied);
        like(a.applied.angular.norm(), b.applied.angular.norm());
        like(a.constraints.linear.x, b.constraints.linear.x);
        like(a.constraints.angular.norm(), b.constraints.angular.norm());
        like(a.gravity.angular.norm(), b.gravity.angular.norm());
        assert!(b.work_applied.abs() > 1e-3 && b.constraints.linear.x.abs() > 1e-6, "{b:?}");
    }
}

/// A fixed neighbour selects the scalar path.
#[test]
fn rejects_nan_speed() {
    for fixed in [false, true] {
        let mut input = heap_input(false, false);
        input.bodies.truncate(8);
        for (k, body) in input.bodies.iter_mut().enumerate() {
            body.position = Vec3::new(0.1 * k as f64, 0.0, 0.1);
        }
        input.bodies[0].fixed = [fixed; 6];
        let model = Model::new(input).unwrap();
        let mut state = State::new(&model);
        let mut work = Work::new(&model, &state);
        let [block, place] = state.places[1].map(|k| k as usize);
        assert_eq!((block, place / 4), (state.places[0][0] as usize, state.places[0][1] as usize / 4));
        state.blocks[block].velocity[place][1] = f64::NAN;
        let end = step(&model, &mut state, &mut work, &NoSurface, &[]);
        assert!(matches!(end, Err(StepError::Speed { body: 1, .. })), "fixed {fixed}: {end:?}");
    }
}

#[test]
fn step_bits_independent_of_thread_count() {
    for hertz in [true, false] {
        let model = heap(hertz, true);
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| bits(&model, 600, true, Simd::best()))
        };
        let one = run(1);
        for threads in [2, 3, 7] {
            assert!(run(threads) == one, "{threads} threads, hertz {hertz}");
        }
    }
}
