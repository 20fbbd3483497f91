//! One step of the grains: search when due, contacts, integration.

use crate::Vec3;
use crate::bond;
use crate::contact::coming::Coming;
use crate::contact::{pass, passes, patches, planes};
use crate::error::{Partner, StepError};
use crate::input::AppliedForce;
use crate::law::{ContactLaw, PairTable, with_law};
use crate::ledger::Ledger;
use crate::model::{Kind, Model};
use crate::order;
use crate::periodic;
use crate::search::near;
use crate::state::{Block, Cross, State, xyz};
use crate::surface::Surface;
use crate::threads::{self, Lists, Part, Slots};
use crate::wall::advance::{self, WallSum};
use crate::work::{Applied, BlockWork, CrossWork, Failure, Sums, Work};

/// Advances `state` by one step of [`Model::dt`].
///
/// `surface` is a surface that another crate owns ([`NoSurface`](crate::surface::NoSurface) for none), as it is at
/// the state's time; its contacts are then in [`Work::surface_contacts`]. `applied` forces act during this step.
///
/// The result has the same bits whatever the number of threads, and whether or not `work` is new. Large scenes share
/// their blocks among the threads of rayon's current pool; calling from inside a pool (`ThreadPool::install`) spares
/// two hand-overs per step.
///
/// # Errors
/// [`StepError`] names the body, its partner and the time when an overlap or a speed leaves the range in which the
/// method has a meaning. The state is then not fit to go on from.
pub fn step<S: Surface>(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    surface: &S,
    applied: &[AppliedForce],
) -> Result<(), StepError> {
    if state.places.len() != model.bodies.len() || work.blocks.len() != state.blocks.len() {
        return Err(StepError::Mismatch { expected: model.bodies.len(), found: state.places.len() });
    }
    if !surface.is_empty() && model.surface_material.is_none() {
        return Err(StepError::SurfaceMaterial);
    }
    if state.steps > 0 && state.steps.is_multiple_of(order::EVERY) {
        state.reorder(model);
        work.arrange(model, state);
    }
    place_loads(model, state, work, applied)?;
    near::update(model, state, work, surface);
    if !model.bonds.is_empty() {
        bond::pass::cross(model, state, work);
    }
    planes::now(model, &state.planes, &mut work.planes);
    with_law!(&model.laws, laws => if model.rigid {
        contacts_and_motion::<_, S, true>(model, laws, state, work, surface);
    } else {
        contacts_and_motion::<_, S, false>(model, laws, state, work, surface);
    });
    collect(model, state, work, surface.max_speed())
}

/// Finds the contacts of a state that has made no step yet, so that measures see them from the start. Nothing moves,
/// and the ledger stays as it is.
///
/// # Errors
/// As [`step`].
pub fn find_contacts<S: Surface>(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    surface: &S,
) -> Result<(), StepError> {
    let mut probe = state.clone();
    step(model, &mut probe, work, surface, &[])?;
    for (block, seen) in state.blocks.iter_mut().zip(probe.blocks) {
        let Block { pairs, planes, walls, surface, .. } = seen;
        *block = Block { pairs, planes, walls, surface, ..std::mem::take(block) };
    }
    state.cross = probe.cross;
    for (wall, seen) in state.walls.iter_mut().zip(probe.walls) {
        (wall.force, wall.moment, wall.feet) = (seen.force, seen.moment, seen.feet);
    }
    (state.near, state.drift, state.wall_drift) = (probe.near, probe.drift, probe.wall_drift);
    (state.lasted, state.stale) = (probe.lasted, probe.stale);
    // The probe may have broken bonds.
    bond::pass::arrange(model, state, work);
    Ok(())
}

fn contacts_and_motion<L: ContactLaw, S: Surface, const RIGID: bool>(
    model: &Model,
    laws: &PairTable<L>,
    state: &mut State,
    work: &mut Work,
    surface: &S,
) {
    let dt = model.dt();
    let State { blocks, cross, planes: motions, walls: wall_states, bonds, drift, wall_drift, .. } = state;
    let Work {
        blocks: works,
        cross: slots,
        applied,
        parallel,
        planes,
        simd,
        beyond,
        buffers,
        keep_forces,
        bonds: bonded,
        material,
        plane_material,
        slot_width,
        ..
    } = work;
    let plane_list = planes;
    let (simd, plane_list) = (*simd, &**plane_list);
    let (material, plane_material, slot_width) = (*material, *plane_material, *slot_width);

    // Contacts between blocks: they read their own block and later ones, and write slots.
    let between = |b: usize,
                   all: Part<'_, Block>,
                   scratch: Part<'_, BlockWork>,
                   pairs: &mut Cross,
                   out: &mut CrossWork| {
        (out.dashpot, out.friction, out.failure) = (0.0, 0.0, None);
        passes::between(model, simd, (all, scratch), material, b, pairs, out);
        if !pairs.boxes.is_empty() {
            pass::boxes(laws, all, scratch, b, pairs, out, dt);
        }
        if let Some(periodic) = &model.periodic {
            out.couple = Vec3::zeros();
            periodic::contacts::<_, RIGID>(periodic, laws, all, scratch, b, pairs, out, slot_width, dt);
        }
    };

    // All else concerns one block at a time.
    let (applied, bonded, bonds) = (&**applied, &*bonded, &*bonds);
    let walls = model.walls.placed(wall_states);
    let gone = *drift + *wall_drift;
    let within = |b: usize, block: &mut Block, w: &mut BlockWork, slots: Slots<'_>, coming: Coming<'_>| {
        w.ledger = Ledger::default();
        w.failure = None;
        w.contacts.clear();
        w.sums = buffers.take();
        w.sums.clear();
        w.sums.resize(block.bodies.len(), Sums::default());
        passes::gather(model, simd, w, slots);
        if !model.bonds.is_empty() {
            bond::pass::within(model, b, block, w, bonded, bonds.fresh);
        }
        let (mut pairs, mut plane_pairs) =
            (std::mem::take(&mut block.pairs), std::mem::take(&mut block.planes));
        if !pairs.is_empty() {
            passes::interior(model, simd, block, &mut pairs, w, coming);
        }
        if RIGID && w.kind.first() == Some(&Kind::Box) {
            planes::corners(model, laws, motions, block, &mut plane_pairs, w, dt);
        } else if !plane_pairs.is_empty() {
            passes::planes(model, simd, plane_list, plane_material, block, &mut plane_pairs, w);
        }
        (block.pairs, block.planes) = (pairs, plane_pairs);
        w.wall_sums.clear();
        if !block.walls.is_empty() {
            let mut list = std::mem::take(&mut block.walls);
            let mut sums = std::mem::take(&mut w.wall_sums);
            sums.resize(walls.groups(), WallSum::default());
            patches::contacts::<_, _, RIGID>(
                (model, simd),
                laws,
                &walls,
                |patch| model.walls.material(patch),
                |patch| model.walls.partner(patch),
                &mut list,
                block,
                w,
                &mut sums,
                false,
                gone,
            );
            w.wall_sums = sums;
            block.walls = list;
        }
        if !block.surface.is_empty() {
            let mut list = std::mem::take(&mut block.surface);
            let done = patches::contacts::<_, _, RIGID>(
                (model, simd),
                laws,
                surface,
                |patch| model.patch_material(patch) as u32,
                Partner::Patch,
                &mut list,
                block,
                w,
                &mut [],
                true,
                gone,
            );
            w.ledger.work_surface += done.work;
            w.ledger.surface += &done.impulse;
            block.surface = list;
        }
        let from = applied.partition_point(|a| (a.block as usize) < b);
        let to = applied.partition_point(|a| a.block as usize <= b);
        passes::advance(model, simd, block, w, &applied[from..to]);
        if !*keep_forces {
            buffers.give_back(std::mem::take(&mut w.sums));
        }
    };
    let threads = if *parallel { rayon::current_num_threads() } else { 1 };
    let lists = Lists { blocks, works, cross, slots };
    threads::through(threads, lists, beyond, slot_width, between, within);
}

/// Brings the applied forces into block order.
fn place_loads(
    model: &Model,
    state: &State,
    work: &mut Work,
    applied: &[AppliedForce],
) -> Result<(), StepError> {
    work.applied.clear();
    for (index, a) in applied.iter().enumerate() {
        let there = a.body < model.bodies.len() && state.present(a.body);
        if !there || !a.force.iter().chain(a.point.iter()).all(|x| x.is_finite()) {
            return Err(StepError::Applied { time: state.time, index, body: a.body });
        }
        let [block, place] = state.places[a.body];
        let centre = xyz(&state.blocks[block as usize].centre[place as usize]);
        work.applied.push(Applied {
            block,
            place,
            force: a.force,
            torque: (a.point - centre).cross(&a.force),
        });
    }
    // Stable: forces on one body add up in the order given.
    work.applied.sort_by_key(|a| (a.block, a.place));
    Ok(())
}

/// Adds up what the blocks report, in block order, and moves on in time.
fn collect(model: &Model, state: &mut State, work: &mut Work, surface_speed: f64) -> Result<(), StepError> {
    let dt = model.dt();
    let mut fastest = 0.0_f64;
    let mut failure = None;
    work.surface_contacts.clear();
    let mut sum = Ledger::default();
    for (w, cross) in work.blocks.iter().zip(&work.cross) {
        sum += &w.ledger;
        sum.dissipated_dashpot += cross.dashpot;
        sum.dissipated_friction += cross.friction;
        sum.periodic.angular += cross.couple;
        fastest = fastest.max(w.fastest);
        failure = failure.or(cross.failure).or(w.failure);
        work.surface_contacts.extend_from_slice(&w.contacts);
    }
    let (wall_speed, wall_failure) = advance::walls(model, state, work, &mut sum);
    failure = failure.or(wall_failure);
    state.ledger += &sum;
    if !model.bonds.is_empty() {
        failure = failure.or(bond::pass::settle(model, state, work));
    }
    let time = state.time;
    let mut wall_speed = wall_speed.max(surface_speed);
    for wall in &mut state.planes {
        wall.offset += wall.velocity * dt;
        wall_speed = wall_speed.max(wall.velocity.norm());
    }
    state.drift += fastest * dt;
    state.wall_drift += wall_speed * dt;
    state.lasted = state.lasted.saturating_add(1);
    state.steps += 1;
    state.time = time + dt;
    match failure {
        None => Ok(()),
        Some(Failure::Overlap { body, partner, overlap, bound }) => {
            Err(StepError::Overlap { time, body: body as usize, partner, overlap, bound })
        }
        Some(Failure::Speed { body, speed, bound }) => {
            Err(StepError::Speed { time, body: body as usize, speed, bound })
        }
        Some(Failure::Wall { wall, speed, bound }) => {
            Err(StepError::WallSpeed { time, wall: wall as usize, speed, bound })
        }
        Some(Failure::Meeting { walls }) => {
            Err(StepError::WallsMeet { time, walls: walls.map(|w| w as usize) })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::{BodyInput, ModelInput, Plane};
    use crate::lanes::Simd;
    use crate::law::material::{Material, PairOverride};
    use crate::shape::Shape;
    use crate::shape::clump::Clump;
    use crate::surface::NoSurface;

    /// A tumbling heap of spheres, or of spheres and clumps, under either law.
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
            Material {
                young: Some(5e7),
                poisson: 0.25,
                rolling_friction: 0.1,
                twisting_friction: 0.1,
                ..soft
            }
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
            // A plate that falls on top, also of the last block of spheres.
            input.shapes.push(Shape::Box { half: [0.1, 0.1, 0.01] });
            let (position, velocity) = (Vec3::new(0.15, 0.2, 0.4627), Vec3::new(0.0, 0.0, -3.0));
            input.bodies.push(BodyInput { shape: 2, position, velocity, ..BodyInput::default() });
        }
        input
    }

    fn bits(model: &Model, steps: usize, parallel: bool, simd: Simd) -> Vec<u64> {
        let mut state = State::new(model);
        let mut work = Work::new(model, &state);
        assert!(work.blocks.len() > 2);
        (work.parallel, work.simd) = (parallel, simd);
        for _ in 0..steps {
            step(model, &mut state, &mut work, &NoSurface, &[]).unwrap();
        }
        assert!(state.ledger.dissipated() > 0.1);
        let at = |b| [state.position(b), state.velocity(b), state.spin(b)];
        let l = &state.ledger;
        let damped = l.local_damping.angular.y + l.dissipated_local_damping;
        let booked = [l.dissipated_dashpot, l.dissipated_friction, l.walls.angular.x, damped];
        let motion = (0..model.body_count()).flat_map(at).flat_map(|v| [v.x, v.y, v.z]);
        motion.chain(booked).map(f64::to_bits).collect()
    }

    /// Stepped serially and shared among threads: the same bits.
    #[test]
    fn shared_blocks_give_the_bits_of_serial_ones() {
        let model = heap(false, false);
        let run = |parallel| bits(&model, 1500, parallel, Simd::best());
        assert!(run(false) == run(true));
    }

    /// Registers of either kind, and plain arrays: the same bits, for each law, with and without clumps.
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

    /// Four bodies at a time are moved and booked as one by one, which a force on any of them calls for, be it zero: with
    /// local damping and without, with forces on some and motions of others fixed.
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
                (far, state.ledger)
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

    /// Four at a time and one by one, which a fixed neighbour calls for.
    #[test]
    fn a_speed_that_is_no_number_is_an_error() {
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

    /// One, two, three and seven threads: the same bits, with memory of rolling and rebuilt lists, or with a box.
    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
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
}
