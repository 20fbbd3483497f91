//! One step of the grains: search when due, contacts, integration.

use super::block_work::BlockWork;
use super::bonds;
use super::candidates::{self, Listed};
use super::input::AppliedForce;
use super::model::Model;
use super::state::State;
use super::threads::{self, Bodies, Lists, One};
use super::work::Work;
use super::{applied, neighbours, order, scarring, wall_contacts, walls};
use crate::base::error::{Partner, StepError};
use crate::base::failure::Failure;
use crate::base::ledger::Ledger;
use crate::bodies::block::Block;
use crate::bodies::members::Members;
use crate::bodies::sums::{Sums, Tally, WallSum};
use crate::body_force::Seen;
use crate::bond;
use crate::bond::pass::{BondWork, Parts};
use crate::contact::kind;
use crate::contact::patches::{self, Against};
use crate::contact::planes::PlaneNow;
use crate::contact::prefetch::Prefetch;
use crate::contact::single::Setting;
use crate::contact::{dispatch, images, planes};
use crate::integrate::leapfrog::{self, Drive};
use crate::integrate::pace::Pace;
use crate::law::scarring::Scar;
use crate::pairs::cross::{Cross, CrossForces, Slots};
use crate::pairs::patches::PatchList;
use crate::spatial::surface::Surface;
use crate::wall::set::PlacedWalls;

pub use super::probe::find_contacts;

/// Advances `state` by one step of [`State::dt`].
///
/// `surface` is a surface that another crate owns ([`NoSurface`](crate::spatial::surface::NoSurface) for none), as it is at
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
    if state.steps > 0 && state.steps.is_multiple_of(order::EVERY) {
        state.reorder(model);
        work.arrange(model, state);
    }
    prepare(model, state, work, surface, applied)?;
    neighbours::update(model, state, work, surface, Listed::All);
    advance(model, state, work, surface);
    collect(model, state, work, surface.max_speed())
}

/// Brings what acts on bodies from outside to where it is in this step: applied forces, walls, and the external surface.
pub(crate) fn prepare<S: Surface>(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    surface: &S,
    applied: &[AppliedForce],
) -> Result<(), StepError> {
    if !surface.is_empty() && model.surface_material.is_none() {
        return Err(StepError::SurfaceMaterial);
    }
    applied::place(model, state, applied, &mut work.applied)?;
    if !model.patches.is_empty() {
        model.walls.now(&state.walls, 0.0, &mut work.walls);
    }
    if !model.sheet.is_empty() {
        sheet(model, state, work, surface)?;
    }
    Ok(())
}

/// What drives all bodies in a step.
pub(crate) fn drive(model: &Model, pace: Pace) -> Drive<'_> {
    Drive {
        gravity: model.gravity,
        damping: model.damping,
        bound: 0.5 * model.radii.0 / pace.dt,
        bodies: &model.bodies,
        pace,
    }
}

/// Puts the triangles of the external surface where they are.
fn sheet<S: Surface>(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    surface: &S,
) -> Result<(), StepError> {
    // The lists name triangles that are there, or none.
    state.stale |= surface.is_empty() != work.sheet.is_empty();
    if surface.is_empty() {
        work.sheet.clear();
        return Ok(());
    }
    for (k, corner) in state.sheet.iter_mut().enumerate() {
        *corner = surface.vertex(k as u32).ok_or(StepError::SurfaceMesh)?;
    }
    model.sheet.now(&state.sheet, 0.0, &mut work.sheet);
    if surface.vertex_correction(0).is_some() {
        model.sheet.correct(|v| surface.vertex_correction(v).map(crate::base::Vec3::from), &mut work.sheet);
    }
    Ok(())
}

/// Forces on the bodies of the blocks that are this process's own, and their motion by a step; the near list is good.
pub(crate) fn advance<S: Surface>(model: &Model, state: &mut State, work: &mut Work, surface: &S) {
    if !model.bonds.is_empty() {
        let parts = bonds::parts(model, state.pace.last, state.bonds.fresh);
        let State { blocks, bonds, .. } = &mut *state;
        bond::pass::cross(&parts, blocks, &mut bonds.cross, &mut work.bonds, work.parallel);
    }
    if model.scarred {
        scarring::update(model, state, work);
    }
    planes::now(&model.planes, &state.planes, &mut work.planes);
    contacts_and_motion(model, state, work, surface);
}

/// Contacts between blocks go to slots; all else concerns one block at a time, its motion included.
fn contacts_and_motion<S: Surface>(model: &Model, state: &mut State, work: &mut Work, surface: &S) {
    let (pace, parallel) = (state.pace, work.parallel);
    let dt = pace.kick();
    let setting = Setting { laws: &model.laws, simd: work.simd, dt };
    let material = work.material;
    let State { blocks, lists, cross, planes, walls, bonds, drift, wall_drift, time, scars, .. } = state;
    let motions = &planes[..];
    let Work { members, blocks: works, cross: slots, beyond, applied, buffers, bonds: bonded, .. } = work;
    let standing = (&work.walls[..], &work.sheet[..]);
    // Contacts between blocks: they read their own block and later ones, and write slots.
    let between = |b: usize, (blocks, members): Bodies<'_>, pairs: &mut Cross, out: &mut CrossForces| {
        out.clear_books();
        dispatch::between(setting, model.clumps, (blocks, members), material, b, pairs, out);
        if !pairs.kinds.is_empty() {
            let now = candidates::now_of(model, (blocks, members), motions, standing, scars);
            kind::forces(&setting, &now, b, pairs, out);
        }
        if let Some(periodic) = &model.periodic {
            images::images(periodic, setting.laws, blocks, members, b, pairs, out, dt);
        }
    };
    let shared = Shared {
        model,
        setting,
        surface,
        planes: (&work.planes, work.plane_material),
        walls: model.walls.placed(walls),
        bonds: (bonded, bonds::parts(model, pace.last, bonds.fresh)),
        drive: drive(model, pace),
        time: *time,
        scars,
        gone: *drift + *wall_drift,
    };
    let (applied, keep) = (&**applied, work.keep_forces);
    let within = |b: usize, mut one: One<'_>, slots: Slots<'_>, next: Prefetch<'_>| {
        one.work.tally.sums = buffers.take();
        shared.forces(b, &mut one, slots, next);
        let One { block, members, work, .. } = one;
        let BlockWork { tally, body_forces, .. } = work;
        if model.acts_on_bodies() {
            let Tally { sums, ledger, .. } = &mut *tally;
            body_forces.act(&model.body_forces, shared.seen(block, members, sums), ledger);
            body_forces.add_to(sums);
        }
        let applied = applied::of_block(applied, b);
        leapfrog::advance(setting.simd, &shared.drive, block, members, tally, applied);
        if model.acts_on_bodies() {
            body_forces.book(block, &mut tally.ledger, dt);
        }
        if !keep {
            buffers.give_back(std::mem::take(&mut work.tally.sums));
        }
    };
    let threads = if parallel { rayon::current_num_threads() } else { 1 };
    let lists = Lists { blocks, members, lists, works, cross, slots };
    threads::through(threads, &work.own, lists, beyond, between, within);
}

/// What all blocks share in a step.
struct Shared<'a, S> {
    model: &'a Model,
    setting: Setting<'a>,
    surface: &'a S,
    /// The planes where they are, and their material where they have only one.
    planes: (&'a [PlaneNow], Option<u32>),
    walls: PlacedWalls<'a>,
    bonds: (&'a BondWork, Parts<'a>),
    drive: Drive<'a>,
    /// Time of the places [s].
    time: f64,
    scars: &'a [Scar],
    /// Bound on the way that anything has come towards anything since the near list was made [m].
    gone: f64,
}

impl<S: Surface> Shared<'_, S> {
    /// What body forces see of a block.
    fn seen<'b>(&'b self, block: &'b Block, members: &'b Members, sums: &'b [Sums]) -> Seen<'b> {
        let Model { bodies, skins, gravity, .. } = self.model;
        let Setting { simd, dt: kick, .. } = self.setting;
        let (time, scars) = (self.time, self.scars);
        Seen { simd, block, members, bodies, skins, gravity: *gravity, sums, time, kick, scars }
    }

    /// All forces on the bodies of a block; what other blocks left for it is in `slots`.
    fn forces(&self, b: usize, one: &mut One<'_>, slots: Slots<'_>, next: Prefetch<'_>) {
        let (model, setting) = (self.model, self.setting);
        let One { block, members, lists, work } = one;
        let (block, members) = (&**block, &**members);
        let tally = &mut work.tally;
        tally.ledger = Ledger::default();
        tally.failure = None;
        work.patches.contacts.clear();
        work.patches.wall_sums.clear();
        tally.sums.clear();
        tally.sums.resize(block.bodies.len(), Sums::default());
        dispatch::gather(setting.simd, &work.shares, &mut tally.sums, slots);
        if !model.bonds.is_empty() {
            let (shared, parts) = &self.bonds;
            bond::pass::within(parts, b, block, &mut lists.bonds, &mut tally.sums, &mut work.bonds, shared);
        }
        if !lists.pairs.is_empty() {
            dispatch::interior(setting, (block, members), &mut lists.pairs, tally, next);
        }
        let (planes, material) = self.planes;
        if !lists.planes.is_empty() {
            dispatch::planes(setting, planes, material, (block, members), &mut lists.planes, tally);
        }
        if !lists.walls.is_empty() {
            let walls = (&self.walls, self.gone);
            on_walls(model, &setting, walls, &mut lists.walls, (block, members), work);
        }
        if !lists.surface.is_empty() {
            let (surface, own) = ((self.surface, self.gone), (block, members));
            on_surface(model, &setting, surface, &mut lists.surface, own, work);
        }
    }
}

/// Contacts of a block's spheres with walls; `gone`: as for [`on_surface`].
pub(crate) fn on_walls(
    model: &Model,
    setting: &Setting<'_>,
    (walls, gone): (&PlacedWalls<'_>, f64),
    list: &mut PatchList,
    own: (&Block, &Members),
    work: &mut BlockWork,
) {
    work.patches.wall_sums.resize(walls.groups(), WallSum::default());
    let against = Against {
        surface: walls,
        material: |patch| model.walls.material(patch),
        partner: |patch| model.walls.partner(patch),
        external: false,
        gone,
    };
    patches::contacts(setting, &against, list, own, &mut work.tally, &mut work.patches);
}

/// Contacts of a block's spheres with the external surface, and what that did; `gone`: bound on the way that anything has come towards
/// anything since the near list was made [m].
pub(crate) fn on_surface<S: Surface>(
    model: &Model,
    setting: &Setting<'_>,
    (surface, gone): (&S, f64),
    list: &mut PatchList,
    own: (&Block, &Members),
    work: &mut BlockWork,
) {
    let against = Against {
        surface,
        material: |patch| model.patch_material(patch) as u32,
        partner: Partner::Patch,
        external: true,
        gone,
    };
    let done = patches::contacts(setting, &against, list, own, &mut work.tally, &mut work.patches);
    work.tally.ledger.work_surface += done.work;
    work.tally.ledger.surface += &done.impulse;
}

/// Adds up what the blocks report, in block order, and moves on in time.
pub(crate) fn collect(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    surface_speed: f64,
) -> Result<(), StepError> {
    work.surface_contacts.clear();
    let mut all = Collected::default();
    let Collected { sum, fastest, failure } = &mut all;
    for (w, cross) in work.blocks.iter().zip(&work.cross) {
        let tally = &w.tally;
        *sum += &tally.ledger;
        sum.dissipated_dashpot += cross.dashpot;
        sum.dissipated_friction += cross.friction;
        sum.work_walls += cross.work_walls;
        sum.walls += &cross.walls;
        sum.periodic.angular += cross.couple;
        sum.work_surface += cross.surface.work;
        sum.surface += &cross.surface.impulse;
        *fastest = fastest.max(tally.fastest);
        *failure = failure.or(cross.failure).or(tally.failure);
        work.surface_contacts.extend_from_slice(&w.patches.contacts);
        work.surface_contacts.extend_from_slice(&cross.surface.contacts);
    }
    conclude(model, state, work, all, surface_speed)
}

/// What all blocks report together.
#[derive(Default)]
pub(crate) struct Collected {
    pub sum: Ledger,
    /// The largest speed [m/s].
    pub fastest: f64,
    pub failure: Option<Failure>,
}

/// Moves walls on, then time.
pub(crate) fn conclude(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    all: Collected,
    surface_speed: f64,
) -> Result<(), StepError> {
    let dt = state.pace.dt;
    let Collected { mut sum, fastest, mut failure } = all;
    let meeting = wall_contacts::forces(model, state, &mut work.wall_contacts, &mut sum);
    let (wall_speed, wall_failure) = walls::advance(model, state, work, &mut sum);
    failure = failure.or(meeting).or(wall_failure);
    state.ledger += &sum;
    if !model.bonds.is_empty() {
        failure = failure.or(bonds::settle(model, state, work));
    }
    let time = state.time;
    let mut wall_speed = wall_speed.max(surface_speed);
    for wall in &mut state.planes {
        wall.offset += wall.velocity * dt;
        let speed = wall.velocity.norm();
        wall_speed = wall_speed.max(speed);
        state.driven_speed = state.driven_speed.max(speed);
    }
    state.drift += fastest * dt;
    state.wall_drift += wall_speed * dt;
    state.lasted = state.lasted.saturating_add(1);
    state.steps += 1;
    state.time = time + dt;
    state.pace.last = dt;
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
        Some(Failure::Walls { walls, overlap, bound }) => {
            Err(StepError::WallsOverlap { time, walls: walls.map(|w| w as usize), overlap, bound })
        }
    }
}

#[cfg(test)]
#[path = "step_tests.rs"]
mod tests;
