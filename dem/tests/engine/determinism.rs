//! Bitwise identical results for any threads, skin or restart.

use crate::device::{gas, smooth, with_clumps};
use crate::scene::{Run, pile, sphere, stone, weightless};
use nalgebra::UnitQuaternion;
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{
    BodyInput, Model, ModelInput, Motion, Oscillation, RigidBody, Servo, State, TimeStep, Vec3, WallInput,
    WallShape, Work, step,
};

fn bits(run: &Run) -> Vec<u64> {
    let mut out = Vec::new();
    for b in 0..run.model.body_count() {
        let q = run.state.orientation(&run.model, b);
        let v = [run.state.position(b), run.state.velocity(b), run.state.spin(b)];
        out.extend(v.iter().flat_map(|v| v.iter()).chain(q.coords.iter()).map(|x| x.to_bits()));
    }
    let l = &run.state.balance;
    out.extend([l.dissipated_dashpot, l.dissipated_friction, l.work_walls].map(f64::to_bits));
    out.extend(l.walls.angular.iter().map(|x| x.to_bits()));
    out.push(l.work_servo.to_bits());
    for wall in 0..run.model.wall_count() {
        let (force, moment) = run.state.wall_force(wall);
        let v = [force, moment, run.state.wall_offset(wall)];
        out.extend(v.iter().flat_map(|v| v.iter()).map(|x| x.to_bits()));
    }
    out
}

fn scene() -> ModelInput {
    pile(10, true)
}

#[test]
fn bits_are_independent_of_threads() {
    let run_in = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut run = Run::new(scene());
            assert!(run.model.sphere_count() > 2500);
            run.steps(4000);
            let (searches, lists) = run.work.rebuilds();
            assert!(searches > 2 && lists > 20, "{searches} {lists}");
            assert!(run.state.balance.dissipated() > 0.1);
            bits(&run)
        })
    };
    let one = run_in(1);
    assert!(one == run_in(2), "two threads differ from one");
    assert!(one == run_in(3), "three threads differ from one");
}

#[test]
fn skin_changes_nothing() {
    let run_with = |skin: f64| {
        let mut run =
            Run::new(ModelInput { skin: trackbed_dem::SearchSkin::Distance(skin), ..pile(4, true) });
        run.steps(4000);
        (bits(&run), run.work.rebuilds())
    };
    let (a, rebuilds_a) = run_with(0.0005);
    let (b, rebuilds_b) = run_with(0.006);
    assert!(rebuilds_a.0 > 3 * rebuilds_b.0 && rebuilds_b.0 > 2, "{rebuilds_a:?} {rebuilds_b:?}");
    assert!(a == b, "the skin shows");
}

#[test]
fn restart_changes_nothing() {
    let mut run = Run::new(pile(4, true));
    run.steps(4321);
    let state: State = run.state.clone();
    let work = Work::new(&run.model, &state);
    let mut again = Run { model: run.model.clone(), state, work };
    run.steps(1500);
    again.steps(1500);
    assert!(bits(&run) == bits(&again), "the restart shows");
}

#[test]
fn finding_contacts_has_no_effect() {
    let mut settled = Run::new(pile(4, true));
    settled.steps(3000);
    let Run { model, mut state, .. } = settled;
    state.reset_time();
    let mut work = Work::new(&model, &state);
    trackbed_dem::find_contacts(&model, &mut state, &mut work, &NoSurface).expect("contacts");
    let new = Work::new(&model, &state);
    let mut one = Run { model: model.clone(), state: state.clone(), work };
    let mut other = Run { model, state, work: new };
    one.steps(1);
    other.steps(1);
    assert!(one.state.balance.dissipated() > 0.0, "nothing touches");
    assert!(bits(&one) == bits(&other), "the look shows");
}

#[test]
fn sorting_keeps_contacts() {
    let mut run = Run::new(pile(3, true));
    let mut worst = 0.0_f64;
    let mut before = None;
    for _ in 0..5010 {
        run.step();
        let e = trackbed_dem::measure::energies(&run.model, &run.state);
        if run.state.steps > 4990 {
            if let Some(last) = before {
                let last: f64 = last;
                worst = worst.max((e.elastic_tangential - last).abs() / e.elastic_tangential);
            }
            before = Some(e.elastic_tangential);
        }
    }
    assert!(worst < 0.05, "tangential energy jumps by {worst}");
}

/// Mill of `n`³ grains: oscillating triangle floor, servo lid, free triangle block.
pub fn mill(n: usize) -> ModelInput {
    let width = 0.021 * n as f64;
    let mut input = ModelInput {
        gravity: Vec3::new(0.0, 0.0, -9.81),
        time_step: TimeStep::Auto { fraction: 0.3 },
        ..weightless(stone())
    };
    for k in 0..n * n * n {
        let cell = Vec3::new((k % n) as f64, (k / n % n) as f64, (k / n / n) as f64);
        let position = (cell + Vec3::repeat(0.5)) * 0.021;
        let velocity = Vec3::new((k as f64 * 1.7).sin(), (k as f64 * 2.9).cos(), -1.0);
        input.bodies.push(BodyInput { spin: velocity * 10.0, ..sphere(position, velocity) });
    }
    let middle = Vec3::new(0.5 * width, 0.5 * width, 0.0);
    let frustum = |height: f64, radii: [f64; 2]| WallShape::Frustum {
        base: middle - Vec3::z() * 0.1 * height,
        axis: Vec3::z(),
        height,
        radii,
        caps: [true, false],
    };
    let turning = Motion { angular_velocity: Vec3::z() * 5.0, ..Motion::default() };
    let drum = frustum(2.0 * width, [0.7 * width, 0.72 * width]);
    input.walls.push(WallInput { motion: turning, ..WallInput::fixed(drum, 0) });
    let (m, a) = (12, 1.6 * width);
    let at = |k: u32| a * (f64::from(k) / f64::from(m) - 0.5);
    let vertices = (0..=m).flat_map(|j| (0..=m).map(move |i| (i, j)));
    let floor = WallShape::Triangles {
        vertices: vertices
            .map(|(i, j)| middle + Vec3::new(at(i), at(j), -0.004 * f64::from((i * j) % 2)))
            .collect(),
        triangles: (0..m)
            .flat_map(|j| (0..m).map(move |i| j * (m + 1) + i))
            .flat_map(|a| [[a, a + 1, a + m + 2], [a, a + m + 2, a + m + 1]])
            .collect(),
    };
    let swing = Oscillation { amplitude: Vec3::new(1e-3, 0.0, 1e-3), frequency: 40.0, phase: 0.0 };
    let shaking = Motion { oscillation: Some(swing), angular_velocity: Vec3::y() * 0.1, ..Motion::default() };
    input.walls.push(WallInput { motion: shaking, ..WallInput::fixed(floor, 0) });
    let lid = WallShape::Plane { point: Vec3::z() * (width + 0.13), normal: -Vec3::z() };
    let servo =
        Servo { direction: -Vec3::z(), force: vec![[0.0, 50.0]], max_speed: 0.5, gain: 0.5, driven: None };
    input.walls.push(WallInput { servo: Some(servo), ..WallInput::fixed(lid, 0) });
    let corner = |k: usize| Vec3::from_fn(|d, _| if k >> d & 1 == 1 { 0.05 } else { -0.05 });
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let block = WallShape::Triangles {
        vertices: (0..8).map(|k| middle + Vec3::z() * (width + 0.06) + corner(k)).collect(),
        triangles: quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect(),
    };
    let body = RigidBody {
        mass: 2.0,
        centre: None,
        inertia: None,
        velocity: Vec3::z() * -3.0,
        spin: Vec3::new(1.0, 2.0, 0.5),
        fixed: [false; 6],
        mount: None,
        rounding: Some(0.015),
        water: None,
        propulsion: None,
    };
    let other = RigidBody { velocity: Vec3::new(-2.0, 0.0, -1.0), rounding: Some(0.015), ..body.clone() };
    input.walls.push(WallInput { body: Some(body), ..WallInput::fixed(block.clone(), 0) });
    // Flying block.
    let WallShape::Triangles { vertices, triangles } = block else { return input };
    let vertices = vertices.iter().map(|v| v + Vec3::new(0.115, 0.01, 0.005)).collect();
    input.walls.push(WallInput {
        body: Some(other),
        ..WallInput::fixed(WallShape::Triangles { vertices, triangles }, 0)
    });
    input
}

#[test]
fn walls_of_all_kinds() {
    let run_in = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut run = Run::new(mill(14));
            assert!(run.model.sphere_count() > 2500);
            run.steps(1200);
            if threads == 2 {
                run.work = Work::new(&run.model, &run.state);
            }
            let mut most = [0.0_f64; 5];
            for _ in 0..80 {
                run.steps(10);
                for wall in [0, 1, 3, 4] {
                    most[wall] = most[wall].max(run.state.wall_force(wall).0.norm());
                }
            }
            assert!([0, 1, 3, 4].iter().all(|&w| most[w] > 1.0), "every wall must be touched: {most:?}");
            bits(&run)
        })
    };
    let one = run_in(1);
    for threads in [2, 3, 7] {
        assert!(one == run_in(threads), "{threads} threads differ from one");
    }
}

#[test]
fn skin_changes_nothing_at_walls() {
    let run_with = |skin: f64, kind: usize| {
        let mut input = ModelInput { skin: trackbed_dem::SearchSkin::Distance(skin), ..mill(5) };
        input.walls = input
            .walls
            .into_iter()
            .enumerate()
            .filter(|(k, _)| *k == kind || kind == 4)
            .map(|w| w.1)
            .collect();
        let mut run = Run::new(input);
        run.steps(4000);
        // Sums follow the grouping of contacts: last bits may differ.
        let l = run.state.balance;
        let sums = [l.dissipated_dashpot, l.dissipated_friction, l.work_walls, l.work_servo];
        run.state.balance = trackbed_dem::balance_terms::BalanceTerms::default();
        (bits(&run), sums)
    };
    let mut seen = Vec::new();
    for kind in 0..6 {
        let (a, b) = (run_with(0.0005, kind), run_with(0.005, kind));
        let close = a.1.iter().zip(b.1).all(|(x, y)| (x - y).abs() <= 1e-11 * x.abs());
        seen.push((kind, a.0 == b.0, close));
    }
    assert!(seen.iter().all(|s| s.1 && s.2), "the skin shows: {seen:?}");
}

#[test]
fn shifted_clumps_update_member_spheres() {
    let input = with_clumps(gas([stone(), smooth()], Vec::new()), |k| k % 3 != 1);
    let model = Model::new(input).unwrap();
    let mut state = State::new(&model);
    let mut work = Work::new(&model, &state);
    for _ in 0..50 {
        step(&model, &mut state, &mut work, &NoSurface, &[]).unwrap();
    }
    let turn = UnitQuaternion::from_axis_angle(&Vec3::x_axis(), 0.01);
    for body in 0..model.body_count() {
        let shift = Vec3::new(0.0, 3e-4 * (body % 5) as f64, -2e-4 * (body % 3) as f64);
        state.shift(&model, body, &shift, &turn);
    }
    state.request_search();
    let mut other = state.clone();
    let mut fresh = Work::new(&model, &other);
    for k in 0..100 {
        step(&model, &mut state, &mut work, &NoSurface, &[]).unwrap();
        step(&model, &mut other, &mut fresh, &NoSurface, &[]).unwrap();
        let same = postcard::to_stdvec(&state).unwrap() == postcard::to_stdvec(&other).unwrap();
        assert!(same, "step {k} after the shift differs");
    }
}
