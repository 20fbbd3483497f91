//! Neighbour search on a device against the engine.

use crate::c_machine::{TestMachine, device_is_there};
use crate::device::{
    STEPS, between_triangles, bonded, compare_events, gas, parallel, smooth, turning, with_borders,
    with_clumps,
};
use crate::device_beside::{self, among_blocks};
use crate::device_changes::assert_detected;
use crate::scene::{Random, sphere, stone};
use trackbed_dem::bond::Bond;
use trackbed_dem::device::{Device, kernels, source};
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{BackEnd, Model, ModelInput, State, Vec3, Work, step};

/// Large spheres; small unequal ones fly in threes, or overlap at rest.
fn unlike() -> ModelInput {
    let mut random = Random::new(5);
    let mut input = gas([turning(stone()), smooth()], Vec::new());
    let mut more = Vec::new();
    for (k, body) in input.bodies.iter_mut().enumerate() {
        if (k % 11 + k / 11 % 11 + k / 121) % 2 == 0 {
            continue;
        }
        let middle = body.position;
        for axis in [Vec3::x(), Vec3::y(), Vec3::z()] {
            body.scale = 0.1 + 0.17 * random.unit().powi(3);
            let still = k % 7 == 0;
            body.fixed = [still, still, still, false, false, false];
            let way = if still { 0.05 * body.scale } else { 1.02 - body.scale };
            body.position = middle + axis * way * 0.01;
            body.velocity = if still { Vec3::zeros() } else { random.vector() * 4.0 };
            more.push(body.clone());
        }
        more.pop();
    }
    input.bodies.extend(more);
    input.bodies.push(sphere(Vec3::new(1e6, 3e5, 7e5), Vec3::new(-1.0, 0.0, 0.0)));
    input.planes.truncate(3);
    for plane in &mut input.planes[..2] {
        plane.point += plane.normal * 1.5e-3;
    }
    input
}

fn events(k: usize, state: &mut State) -> bool {
    match k {
        300 => state.open_plane(1, true),
        600 => state.open_plane(1, false),
        _ => return false,
    }
    true
}

#[test]
fn unlike_sizes_have_the_same_bits() {
    if device_is_there() {
        let (differs, state, (searches, _)) = compare_events(unlike(), STEPS, |text| text, events);
        let l = &state.balance;
        let (spent, walls) = (l.dissipated_friction, l.work_walls);
        println!("{searches} searches, friction {spent:.3e} J, planes {walls:.3e} J");
        assert_eq!(differs, None);
        assert!(searches > 10 && spent > 0.0 && walls != 0.0);
    }
}

#[test]
fn the_state_stays_on_the_device() {
    if device_is_there() {
        let spheres = gas([stone(), smooth()], Vec::new());
        for (input, share) in [
            (spheres.clone(), 0.125),
            (with_clumps(unlike(), |k| k % 3 == 1), 0.125),
            (between_triangles(spheres), 0.3),
        ] {
            let model = Model::new(input).expect("a good input");
            let text = source(&model).expect("a model for a device");
            kernels(&model).iter().for_each(|k| assert!(text.contains(&format!("KERNEL({k})")), "{k}"));
            let (mut ours, mut theirs) = (State::new(&model), State::new(&model));
            let mut work = Work::new(&model, &theirs);
            let mut device = Device::new(TestMachine::new(&text, &model), &model, &ours).expect("memory");
            for _ in 0..500 {
                step(&model, &mut theirs, &mut work, &NoSurface, &[]).expect("a good step");
                device.step(&model, &mut ours, &NoSurface, &[]).expect("a good step on the device");
            }
            let (_, near_lists) = device.rebuilds();
            let read = device.machine().read;
            device.download(&model, &mut ours).expect("a device that responds");
            let whole = device.machine().read - read;
            println!("{read} numbers are read in 500 steps, {near_lists} near lists; {whole} in a download");
            assert!(near_lists > 10 && (read as f64) < share * (near_lists * whole as u64) as f64);
            assert!(postcard::to_stdvec(&ours).unwrap() == postcard::to_stdvec(&theirs).unwrap());
        }
    }
}

#[test]
fn a_changed_search_is_seen() {
    if device_is_there() {
        let input = unlike();
        let changes = [
            ("known ? OLD_MEMORY[old] : fresh", "fresh"),
            ("known ? OLD_TURN[old] : none()", "none()"),
            ("if (!in_row(p, y, size, inverse, from_x, to_x, cy, cz)) continue;", ""),
            ("if (still && OLD_V[there].w == 0.0) continue;", ""),
        ];
        assert_detected("device_search::a_changed_search_is_seen", &changes, |_, change| {
            compare_events(input.clone(), STEPS, change, events).0
        });
    }
}

fn packed() -> ModelInput {
    let (mut random, count, wide) = (Random::new(9), 14, 0.0199);
    let mut input = with_borders(gas([stone(), smooth()], Vec::new()));
    let far = f64::from(count) * wide;
    input.periodic = [Some([0.0, far]), Some([0.0, far]), None];
    let body = |k: i32| {
        let cell =
            Vec3::new(f64::from(k % count), f64::from(k / count % count), f64::from(k / count / count));
        sphere((cell + Vec3::repeat(0.5)) * wide, random.vector() * 0.3)
    };
    input.bodies = (0..count * count * count).map(body).collect();
    input.planes.truncate(1);
    input
}

#[test]
fn periodic_lattice_matches_engine_bits() {
    if device_is_there() {
        let (differs, state, (searches, _)) = compare_events(packed(), 400, |text| text, |_, _| false);
        let (friction, couple) = (state.balance.dissipated_friction, state.balance.periodic.angular.norm());
        println!("{searches} searches, friction {friction:.3e} J, impulse of the borders {couple:.3e} N m s");
        assert_eq!(differs, None);
        assert!(searches > 1 && friction > 0.0 && couple > 0.0);
    }
}

#[test]
fn orphaned_contact_ends_on_cpu() {
    if device_is_there() {
        let opens = |k: usize, state: &mut State| {
            matches!(k % 40, 0 | 2).then(|| state.open_wall(0, k.is_multiple_of(40))).is_some()
        };
        let input = between_triangles(gas([turning(stone()), smooth()], Vec::new()));
        let (differs, state, _) = compare_events(input, STEPS, |text| text, opens);
        assert_eq!(differs, None);
        assert!(state.wall_contact_count() > 10 && state.balance.dissipated_friction > 0.0);
    }
}

#[test]
fn changed_contact_order_is_detected() {
    if device_is_there() {
        let spheres = gas([stone(), smooth()], Vec::new());
        let bonds = bonded(Bond::Parallel(parallel()), stone());
        let inputs = [packed(), between_triangles(spheres.clone()), bonds.clone(), bonds];
        let changes = [
            ("REST_FROM[*rest] < BLOCK[", "REST_FROM[*rest] <= BLOCK["),
            ("REST_FROM[*rest] <= BLOCKS", "REST_FROM[*rest] <= ~0u"),
            ("REST_FROM[*rest] <= BLOCKS", "REST_FROM[*rest] < BLOCKS"),
            ("if (HELD_WITH[k] == other) return 1;", "if (HELD_WITH[k] == other) return 0;"),
            ("NO_SPHERE(s) (SINGLE[s] & ELSEWHERE)", "NO_SPHERE(s) 0"),
        ];
        assert_detected(
            "device_search::changed_contact_order_is_detected",
            &changes,
            |k, change| match inputs.get(k) {
                Some(input) => compare_events(input.clone(), STEPS, change, |_, _| false).0,
                None => device_beside::compare(among_blocks(spheres.clone()), change).differs,
            },
        );
    }
}
