//! The search for neighbours on a device: the lists, their order and the memory of their contacts are the engine's.

use crate::c_machine::{TestMachine, device_is_there};
use crate::device::{STEPS, changed, compare_events, gas, smooth, turning, with_clumps};
use crate::scene::{Random, sphere, stone};
use trackbed_dem::device::{Device, kernels, source};
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{BackEnd, Model, ModelInput, State, Vec3, Work, step};

/// Large spheres between which small ones of unlike sizes fly, three at a time, or stand still and overlap; one is very far away.
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
            // Just beside the next sphere, or beside each other.
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
    // Large ones lie on the plane that rises, and on one that opens.
    for plane in &mut input.planes[..2] {
        plane.point += plane.normal * 1.5e-3;
    }
    input
}

/// Opens a plane for a while.
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
        let l = &state.ledger;
        let (spent, walls) = (l.dissipated_friction, l.work_walls);
        println!("{searches} searches, friction {spent:.3e} J, planes {walls:.3e} J");
        assert_eq!(differs, None);
        assert!(searches > 10 && spent > 0.0 && walls != 0.0);
    }
}

/// Between downloads a device is asked for no more than what its steps book, and for the size of what a search has found.
#[test]
fn the_state_stays_on_the_device() {
    if device_is_there() {
        for input in [gas([stone(), smooth()], Vec::new()), with_clumps(unlike(), |k| k % 3 == 1)] {
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
            let (searches, _) = device.rebuilds();
            let read = device.machine().read;
            device.download(&model, &mut ours).expect("a device that responds");
            let whole = device.machine().read - read;
            println!("{read} numbers are read in 500 steps, {searches} searches; {whole} in a download");
            assert!(searches > 10 && 8 * read < searches as usize * whole);
            assert!(postcard::to_stdvec(&ours).unwrap() == postcard::to_stdvec(&theirs).unwrap());
        }
    }
}

/// The comparison sees what is wrong with a list: a memory lost, a partner twice, one that may not touch.
#[test]
fn a_changed_search_is_seen() {
    if device_is_there() {
        let input = unlike();
        for (from, to) in [
            ("known ? OLD_MEMORY[old] : fresh", "fresh"),
            ("known ? OLD_TURN[old] : none()", "none()"),
            ("if (!in_row(p, y, size, inverse, from_x, to_x, cy, cz)) continue;", ""),
            ("if (still && OLD_V[there].w == 0.0) continue;", ""),
        ] {
            let (differs, ..) = compare_events(input.clone(), STEPS, changed(from, to), events);
            println!("{from} -> {to}: {differs:?}");
            assert!(differs.is_some(), "{from} -> {to}");
        }
    }
}
