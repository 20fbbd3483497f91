//! Periodic axes: results do not depend on the borders.

use crate::bonds::cement;
use crate::bonds_many::falling;
use crate::scene::{Random, Run, clump, plane, sphere, stone, weightless};
use nalgebra::UnitQuaternion;
use trackbed_dem::{
    BodyInput, Material, Model, ModelError, ModelInput, Partner, Shape, State, TimeStep, TriangleSurface,
    Vec3, Work, measure,
};

const PITCH: f64 = 0.0225;

fn bed(n: usize, layers: usize) -> ModelInput {
    let mut random = Random::new(11);
    let length = PITCH * n as f64;
    let mut input = ModelInput {
        gravity: Vec3::new(0.0, 0.0, -9.81),
        time_step: TimeStep::Auto { fraction: 0.5 },
        periodic: [Some([0.0, length]), Some([0.0, length]), None],
        ..weightless(Material { stiffness: 4e3, ..stone() })
    };
    input.shapes.push(Shape::Clump(clump()));
    input.planes.push(plane(Vec3::zeros(), Vec3::z()));
    for k in 0..n * n * layers {
        // Staggered layers wedge the grains apart.
        let layer = k / n / n;
        let side = if layer.is_multiple_of(2) { 0.25 } else { 0.75 };
        let cell = Vec3::new((k % n) as f64 + side, (k / n % n) as f64 + side, 0.75 * layer as f64 + 0.55);
        let shape = usize::from(k % 4 == 3);
        input.bodies.push(BodyInput {
            shape,
            scale: if shape == 1 { 0.5 } else { 1.0 + 0.1 * random.unit() },
            position: cell * PITCH + random.vector() * 0.0002,
            orientation: UnitQuaternion::from_scaled_axis(random.vector() * 3.0),
            velocity: random.vector() * 0.3,
            spin: random.vector() * 5.0,
            ..BodyInput::default()
        });
    }
    input
}

fn continued(input: &ModelInput, run: &Run, by: impl Fn(usize) -> Vec3) -> ModelInput {
    let mut input = input.clone();
    for (k, b) in input.bodies.iter_mut().enumerate() {
        b.position = run.model.wrap(&run.state.position(k)) + by(k);
        b.orientation = run.state.orientation(&run.model, k);
        b.velocity = run.state.velocity(k);
        b.spin = run.state.spin(k);
    }
    input
}

fn across(run: &Run) -> usize {
    let contacts = measure::contacts(&run.model, &run.state);
    contacts.iter().filter(|c| c.shift != Vec3::zeros() && c.normal_force > 0.0).count()
}

/// Floor with hills of 4 mm whose triangles repeat themselves, in place of the plane.
fn hilly(n: usize, layers: usize, by: &Vec3) -> ModelInput {
    const CELLS: usize = 5;
    let mut input = bed(n, layers);
    input.planes.clear();
    let length = PITCH * n as f64;
    let height = |i: usize, j: usize| 0.004 * (((i % CELLS) * 7 + (j % CELLS) * 3) % 4) as f64 / 3.0 - 0.004;
    let at = |i: usize, j: usize| {
        Vec3::new(i as f64 * length / CELLS as f64, j as f64 * length / CELLS as f64, height(i, j)) + by
    };
    let vertices = (0..=CELLS).flat_map(|j| (0..=CELLS).map(move |i| at(i, j))).collect();
    let number = |i: usize, j: usize| (j * (CELLS + 1) + i) as u32;
    let cells = (0..CELLS).flat_map(|j| (0..CELLS).map(move |i| (i, j)));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    let triangles = triangles.collect();
    input.triangles.push(TriangleSurface { vertices, triangles, ..TriangleSurface::default() });
    input
}

/// Spheres and clumps on triangles: the same motion wherever the borders lie.
#[test]
fn floor_is_independent_of_borders() {
    const L: f64 = 6.0 * PITCH;
    let mut settled = Run::new(hilly(6, 4, &Vec3::zeros()));
    settled.steps(9_000);
    let ways = |by: Vec3, back: bool| {
        let mut moved = continued(&hilly(6, 4, &by), &settled, |_| by);
        if back {
            moved.bodies.iter_mut().for_each(|b| b.position = settled.model.wrap(&b.position));
        }
        moved.gravity.x = 4.0;
        let start: Vec<Vec3> = moved.bodies.iter().map(|b| b.position).collect();
        let mut run = Run::new(moved);
        run.steps(1000);
        let contacts = measure::contacts(&run.model, &run.state);
        let on_floor = contacts.iter().filter(|c| matches!(c.b, Partner::Triangle(_))).count();
        (start.iter().enumerate().map(|(k, x)| run.state.position(k) - x).collect::<Vec<_>>(), on_floor)
    };
    let (here, on_floor) = ways(Vec3::zeros(), false);
    assert!(on_floor > 20 && here.iter().any(|w| w.norm() > 5e-4), "{on_floor} contacts");
    for (by, back) in [(Vec3::new(0.5 * L, 0.5 * L, 0.0), true), (Vec3::new(0.3 * L, -0.2 * L, 0.0), false)] {
        let (there, contacts) = ways(by, back);
        let worst = here.iter().zip(&there).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        println!("{by:?}: ways differ by {worst:.1e} m, {on_floor} and {contacts} contacts on the floor");
        assert!(worst < 1e-12 && contacts == on_floor, "{worst:e}, {contacts} of {on_floor} contacts");
    }
}

/// Displacements over 1000 steps agree to 1e-12 m (measured 3e-15 m).
#[test]
fn bed_is_independent_of_borders() {
    moved_bed(6, 4);
}

/// Box of 2.2 diameters of the largest body.
#[test]
fn narrow_bed_is_independent_of_borders() {
    moved_bed(3, 8);
}

fn moved_bed(n: usize, layers: usize) {
    let length = PITCH * n as f64;
    let input = bed(n, layers);
    let mut settled = Run::new(input.clone());
    settled.steps(12_000);
    assert!(across(&settled) > 10, "{}", across(&settled));
    let half = |_: usize| Vec3::new(0.5 * length, 0.5 * length, 0.0);
    let laps = |k: usize| Vec3::new((k % 5) as f64 - 2.0, (k / 5 % 3) as f64 - 1.0, 0.0) * length;
    let ways = |by: &dyn Fn(usize) -> Vec3, back: bool| {
        let mut moved = continued(&input, &settled, by);
        if back {
            moved.bodies.iter_mut().for_each(|b| b.position = settled.model.wrap(&b.position));
        }
        moved.gravity.x = 5.0;
        let start: Vec<Vec3> = moved.bodies.iter().map(|b| b.position).collect();
        let mut run = Run::new(moved);
        run.steps(1000);
        let e = measure::energies(&run.model, &run.state);
        let ways: Vec<Vec3> = start.iter().enumerate().map(|(k, x)| run.state.position(k) - x).collect();
        (ways, across(&run), e.elastic())
    };
    let (here, crossing, elastic) = ways(&|_| Vec3::zeros(), false);
    assert!(here.iter().any(|w| w.norm() > 5e-4), "the bed must move");
    for (name, there) in [("half", ways(&half, true)), ("laps", ways(&laps, false))] {
        let worst = here.iter().zip(&there.0).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        println!("{name}: ways differ by {worst:.1e} m, contacts across borders {crossing} and {}", there.1);
        assert!(worst < 1e-12, "{name}: {worst:e}");
        assert!((there.2 / elastic - 1.0).abs() < 1e-7);
    }
}

#[test]
fn collision_is_independent_of_borders() {
    const L: f64 = 0.25;
    let rolling = Material { rolling_friction: 0.1, twisting_friction: 0.05, ..stone() };
    for (material, shape) in [(stone(), 0), (rolling, 0), (stone(), 1)] {
        let run_at = |middle: Vec3, swapped: bool| {
            let mut input = weightless(material);
            input.periodic = [Some([0.0, L]); 3];
            input.shapes.push(Shape::Clump(clump()));
            let apart = Vec3::new(0.024, 0.013, 0.009) * if shape == 1 { 1.5 } else { 0.8 };
            let velocity = Vec3::new(-1.0, -0.3, -0.4);
            for (side, spin) in [(1.0, Vec3::new(9.0, -30.0, 20.0)), (-1.0, Vec3::new(-14.0, 3.0, 8.0))] {
                let position = middle + apart * side;
                let position = Vec3::from_fn(|d, _| position[d].rem_euclid(L));
                let scale = if side < 0.0 { 0.9 } else { 1.0 };
                input.bodies.push(BodyInput { shape, scale, spin, ..sphere(position, velocity * side) });
            }
            if swapped {
                input.bodies.swap(0, 1);
            }
            let mut run = Run::new(input);
            let mut touched = 0;
            while run.state.time < 0.03 {
                run.step();
                touched = touched.max(across(&run));
            }
            assert!(run.state.balance.dissipated_friction > 0.0);
            let order = if swapped { [1, 0] } else { [0, 1] };
            (order.map(|k| [run.state.velocity(k), run.state.spin(k) * 0.01]), touched)
        };
        let (middle, none) = run_at(Vec3::repeat(0.5 * L), false);
        assert_eq!(none, 0);
        assert!((middle[0][0] - Vec3::new(-1.0, -0.3, -0.4)).norm() > 0.5, "they must meet");
        for place in [Vec3::new(0.0, 0.5, 0.5), Vec3::new(0.5, 0.0, 0.0), Vec3::zeros()] {
            for swapped in [false, true] {
                let (border, touched) = run_at(place * L, swapped);
                assert!(touched > 0, "{place:?}");
                let worst = (0..4).map(|k| (middle[k / 2][k % 2] - border[k / 2][k % 2]).norm());
                let worst = worst.fold(0.0, f64::max);
                println!("shape {shape}, {place:?}, swapped {swapped}: {worst:.1e} m/s");
                assert!(worst < 1e-11, "{place:?} {swapped} {worst:e}");
            }
        }
    }
}

#[test]
fn balances_close() {
    let mut input = bed(5, 5);
    input.gravity = Vec3::zeros();
    input.planes.clear();
    input.periodic[2] = Some([0.0, 5.0 * PITCH]);
    input.time_step = TimeStep::Auto { fraction: 0.1 };
    input.bodies.iter_mut().for_each(|b| b.velocity = b.velocity * 4.0 + Vec3::new(2.0, 0.0, 0.0));
    let mut flow = ModelInput {
        gravity: Vec3::new(4.0, 1.0, -9.0),
        time_step: TimeStep::Auto { fraction: 0.1 },
        ..bed(5, 3)
    };
    flow.bodies.iter_mut().for_each(|b| b.velocity += Vec3::new(2.0, 0.6, 0.0));
    let mut hills =
        ModelInput { gravity: flow.gravity, time_step: flow.time_step, ..hilly(5, 3, &Vec3::zeros()) };
    hills.bodies.iter_mut().for_each(|b| b.velocity += Vec3::new(2.0, 0.6, 0.0));
    for (input, free) in [(input, true), (flow, false), (hills, false)] {
        let mut run = Run::new(input);
        let before = measure::momentum(&run.model, &run.state);
        let total = |run: &Run| {
            let l = &run.state.balance;
            measure::energies(&run.model, &run.state).total() + l.dissipated() - l.work()
        };
        let start = total(&run);
        run.state.steps = 2000;
        let (mut crossing, mut worst, mut put_back) = (0, 0.0_f64, 0);
        let places =
            |run: &Run| (0..run.model.body_count()).map(|k| run.state.position(k)).collect::<Vec<_>>();
        let mut last = places(&run);
        while run.state.steps < 5500 {
            run.step();
            if run.state.steps.is_multiple_of(50) {
                crossing += across(&run);
                worst = worst.max((total(&run) - start).abs());
                let now = places(&run);
                put_back += now.iter().zip(&last).filter(|(x, y)| (*x - *y).norm() > 2.0 * PITCH).count();
                last = now;
            }
        }
        let l = run.state.balance;
        let after = measure::momentum(&run.model, &run.state);
        let given = l.impulse();
        let scale = before.linear.norm() + l.gravity.linear.norm();
        let linear = (after.linear - before.linear - given.linear).norm() / scale;
        let angular = (after.angular - before.angular - given.angular).norm() / scale;
        println!(
            "linear {linear:.1e}, angular {angular:.1e} of {:.1e} m, energy open {:.1e} of {:.3} J, {crossing} across, \
             {put_back} put back",
            l.periodic.angular.norm() / scale,
            worst / l.dissipated(),
            l.dissipated()
        );
        assert!(crossing > 20, "{crossing}");
        assert!(put_back > 10, "{put_back}");
        // Border terms nearly cancel in steady flow: check that they exceed the tolerance.
        assert!(l.periodic.angular.norm() > 1e-5 * scale, "{}", l.periodic.angular.norm() / scale);
        assert_eq!(l.periodic.linear, Vec3::zeros());
        assert!(linear < 1e-12 && angular < 1e-12, "{linear:e} {angular:e}");
        assert!(worst < 1e-4 * l.dissipated(), "{worst:e} of {:e}", l.dissipated());
        if free {
            assert!((after.linear - before.linear).norm() < 1e-12 * scale);
        } else {
            assert!(l.work_periodic.abs() > 1e-4, "{:e}", l.work_periodic);
        }
    }
}

fn bits(run: &Run) -> Vec<u64> {
    let at = |b| [run.state.position(b), run.state.velocity(b), run.state.spin(b)];
    let l = &run.state.balance;
    let sums = [l.dissipated_friction, l.work_periodic, l.periodic.angular.y];
    let bodies = (0..run.model.body_count()).flat_map(at).flat_map(|v| [v.x, v.y, v.z]);
    bodies.chain(sums).map(f64::to_bits).collect()
}

#[test]
fn threads_and_restarts_do_not_show() {
    let run_in = |threads: usize, skin: Option<f64>| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut input = bed(14, 8);
            input.gravity.x = 6.0;
            input.skin = skin.map_or(input.skin, trackbed_dem::SearchSkin::Distance);
            input.bodies.iter_mut().for_each(|b| b.velocity += Vec3::new(2.0, 1.0, -0.5));
            let mut run = Run::new(input);
            assert!(run.model.sphere_count() > 2500);
            run.state.steps = 4600;
            run.steps(300);
            assert!(across(&run) > 20, "{}", across(&run));
            if threads == 2 {
                let bytes = postcard::to_stdvec(&run.state).expect("a checkpoint");
                run.state = postcard::from_bytes::<State>(&bytes).expect("a state");
                run.work = Work::new(&run.model, &run.state);
            }
            run.steps(300);
            assert!(run.state.balance.work_periodic != 0.0, "bodies must have been put back");
            assert!(across(&run) > 20);
            bits(&run)
        })
    };
    let one = run_in(1, None);
    for (threads, skin) in [(2, None), (3, None), (7, None), (3, Some(0.001))] {
        assert!(one == run_in(threads, skin), "{threads} threads, skin {skin:?} differ from one");
    }
}

#[test]
fn far_borders_do_not_show() {
    let run = |periodic: bool| {
        let mut input = bed(5, 4);
        input.periodic = [None; 3];
        if periodic {
            input.periodic[0] = Some([-5.0, 5.0]);
        }
        let mut run = Run::new(input);
        run.steps(1500);
        bits(&run)
    };
    assert!(run(true) == run(false));
}

/// σ_zz is the weight above over the area.
#[test]
fn stress_is_independent_of_borders() {
    const L: f64 = 6.0 * PITCH;
    let mut input = bed(6, 4);
    input.bodies.iter_mut().for_each(|b| (b.velocity, b.spin) = (Vec3::zeros(), Vec3::zeros()));
    let mut settled = Run::new(input.clone());
    settled.steps(12_000);
    let of = |by: f64| {
        let mut moved = continued(&input, &settled, |_| Vec3::new(by, by, 0.0));
        moved.bodies.iter_mut().for_each(|b| b.position = settled.model.wrap(&b.position));
        let mut run = Run::new(moved);
        run.steps(100);
        let contacts = measure::contacts(&run.model, &run.state);
        let stress = measure::mean_stress_of(&run.model, &run.state, &contacts);
        (stress, measure::neighbours(&run.model, &contacts), measure::coordination(&run.model, &run.state))
    };
    let (here, there) = (of(0.0), of(0.5 * L));
    assert_eq!(here.1, there.1);
    assert_eq!(here.2, there.2);
    let size = here.0.iter().flatten().fold(0.0_f64, |m, s| m.max(s.abs()));
    let worst = here.0.iter().flatten().zip(there.0.iter().flatten()).map(|(a, b)| (a - b).abs());
    let worst = worst.fold(0.0, f64::max);
    assert!(size > 100.0 && worst < 1e-6 * size, "{worst:e} of {size}");
}

/// A bonded cube that breaks on the floor while it drifts: the same breaks and motion wherever the borders lie.
#[test]
fn bonded_piece_is_independent_of_borders() {
    const L: f64 = 0.3;
    let run_at = |by: Vec3| {
        let mut input = falling(5, cement(), 2.0);
        input.periodic = [Some([-0.5 * L, 0.5 * L]), Some([-0.5 * L, 0.5 * L]), None];
        for b in &mut input.bodies {
            b.position += by;
            b.velocity += Vec3::new(1.0, 0.4, 0.0);
        }
        let start: Vec<Vec3> = input.bodies.iter().map(|b| b.position).collect();
        let mut run = Run::new(input);
        run.state.steps = 4_000;
        run.steps(2_500);
        let jumped = (0..start.len()).any(|k| (run.state.position(k) - start[k]).norm() > 0.5 * L);
        let way = |k: usize| {
            let x = run.model.wrap(&run.state.position(k)) - run.model.wrap(&start[k]);
            x.map(|x| x - (x / L).round() * L)
        };
        let ways: Vec<Vec3> = (0..start.len()).map(way).collect();
        (ways, run.state.broken_bonds(), jumped, run.state.balance.dissipated())
    };
    let (here, broken, jumped, spent) = run_at(Vec3::zeros());
    assert!(broken.0 > 20 && !jumped, "{broken:?}");
    let (there, others, jumped, other) = run_at(Vec3::new(0.5 * L, 0.46 * L, 0.0));
    let worst = here.iter().zip(&there).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    println!("ways differ by {worst:.1e} m, {broken:?} and {others:?} broken");
    assert!(jumped && broken == others, "{broken:?} and {others:?}");
    assert!(worst < 1e-9 && (other / spent - 1.0).abs() < 1e-9, "{worst:e}, {spent} and {other} J");
}

/// Bonded pieces longer than the period, whose ends would meet.
#[test]
fn long_pieces_are_refused() {
    let mut input = falling(5, cement(), 2.0);
    input.periodic[0] = Some([-0.06, 0.06]);
    let said = Model::new(input).map(|_| ()).expect_err("a refusal").to_string();
    assert!(said.contains("a piece longer than a period"), "{said}");
}

fn triangle() -> TriangleSurface {
    let vertices = vec![Vec3::zeros(), Vec3::x(), Vec3::y()];
    TriangleSurface { vertices, triangles: vec![[0, 1, 2]], ..TriangleSurface::default() }
}

#[test]
fn what_cannot_be_periodic_is_refused() {
    let refused = |change: &dyn Fn(&mut ModelInput)| {
        let mut input = weightless(stone());
        input.bodies.push(sphere(Vec3::repeat(0.05), Vec3::zeros()));
        input.periodic[0] = Some([0.0, 0.1]);
        assert!(Model::new(input.clone()).is_ok());
        change(&mut input);
        match Model::new(input) {
            Err(e @ ModelError::Periodic { .. }) => e.to_string(),
            other => panic!("{other:?}"),
        }
    };
    let has = |text: String, words: &str| assert!(text.contains(words), "{text}");
    has(refused(&|i| i.periodic[0] = Some([0.0, 0.03])), "x is 0.03 m long; at least");
    has(refused(&|i| i.periodic[1] = Some([1.0, 1.0])), "y runs from 1 to 1");
    has(refused(&|i| i.periodic[2] = Some([0.0, f64::INFINITY])), "both must be finite");
    has(refused(&|i| i.planes.push(plane(Vec3::zeros(), Vec3::new(0.1, 0.0, 1.0)))), "normal of plane 0");
    let moving = |i: &mut ModelInput, velocity: Vec3| {
        i.triangles.push(triangle());
        i.triangles[0].velocity = velocity;
    };
    has(refused(&|i| moving(i, Vec3::x())), "wall 0 moves along x");
    let mut across = weightless(stone());
    across.bodies.push(sphere(Vec3::repeat(0.05), Vec3::zeros()));
    across.periodic[0] = Some([0.0, 0.1]);
    moving(&mut across, Vec3::y());
    assert!(Model::new(across).is_ok());
}
