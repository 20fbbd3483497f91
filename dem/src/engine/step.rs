//! DEM time step: search if due, contacts, integration.

use super::block_work::BlockWork;
use super::bonds;
use super::broad_phase::{self, Listed};
use super::images::Repeated;
use super::input::AppliedForce;
use super::model::Model;
use super::state::State;
use super::threads::{self, BlockArrays, BlockTask, Bodies};
use super::work::Work;
use super::{applied, neighbour_list, reordering, scarring, wall_contacts, walls};
use crate::base::balance_terms::BalanceTerms;
use crate::base::error::{Partner, StepError};
use crate::base::failure::Failure;
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::sums::{BlockTotals, ForceTorque, WallSum};
use crate::body_force::ForceInput;
use crate::bond;
use crate::bond::pass::{BondWork, Parts};
use crate::contact::narrow_phase;
use crate::contact::planes::PlanePose;
use crate::contact::prefetch::Prefetch;
use crate::contact::scalar::StepContext;
use crate::contact::surface_contacts::{self, ContactSurface};
use crate::contact::{dispatch, images, planes};
use crate::integrate::leapfrog::{self, MotionInput};
use crate::integrate::step_size::StepSize;
use crate::law::scarring::Scar;
use crate::pairs::cross::{Cross, CrossForces, Slots};
use crate::pairs::patches::PatchList;
use crate::spatial::surface::Surface;
use crate::wall::set::PlacedWalls;

pub use super::initial_contacts::{find_contacts, find_deep_contacts};

/// Advances `state` by one step of [`State::dt`].
///
/// `surface` is at the state's time ([`NoSurface`](crate::spatial::surface::NoSurface) for none). Results are
/// bitwise identical for any number of threads. `applied` forces act for this step.
///
/// # Errors
/// [`StepError`] for overlaps or speeds out of range; the state is then invalid.
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
    if state.steps > 0 && state.steps.is_multiple_of(reordering::EVERY) {
        state.reorder(model);
        work.rebuild_layout(model, state);
    }
    prepare(model, state, work, surface, applied)?;
    neighbour_list::update(model, state, work, surface, Listed::All);
    advance(model, state, work, surface);
    reduce_blocks(model, state, work, surface.max_speed())
}

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
    applied::add_forces(model, state, applied, &mut work.applied)?;
    if !model.patches.is_empty() {
        model.walls.update_poses(&state.walls, 0.0, &mut work.walls);
    }
    if !model.sheet.is_empty() {
        sheet(model, state, work, surface)?;
    }
    Ok(())
}

pub(crate) fn drive(model: &Model, step_size: StepSize) -> MotionInput<'_> {
    MotionInput {
        gravity: model.gravity,
        damping: model.damping,
        bound: 0.5 * model.radii.0 / step_size.dt,
        bodies: &model.bodies,
        step_size,
    }
}

fn sheet<S: Surface>(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    surface: &S,
) -> Result<(), StepError> {
    // Lists depend on whether the surface has triangles.
    state.stale |= surface.is_empty() != work.sheet.is_empty();
    if surface.is_empty() {
        work.sheet.clear();
        return Ok(());
    }
    for (k, corner) in state.sheet.iter_mut().enumerate() {
        *corner = surface.vertex(k as u32).ok_or(StepError::SurfaceMesh)?;
    }
    model.sheet.update_poses(&state.sheet, 0.0, &mut work.sheet);
    if surface.vertex_correction(0).is_some() {
        model.sheet.correct(|v| surface.vertex_correction(v).map(crate::base::Vec3::from), &mut work.sheet);
    }
    Ok(())
}

/// The neighbour list must be valid.
pub(crate) fn advance<S: Surface>(model: &Model, state: &mut State, work: &mut Work, surface: &S) {
    if !model.bonds.is_empty() {
        let parts = bonds::parts(model, state.step_size.last, state.bonds.fresh);
        let State { blocks, bonds, .. } = &mut *state;
        bond::pass::cross(&parts, blocks, &mut bonds.cross, &mut work.bonds, work.parallel);
    }
    if model.scarred {
        scarring::update(model, state, work);
    }
    planes::update_poses(&model.planes, &state.planes, &mut work.planes);
    contacts_and_motion(model, state, work, surface);
}

fn contacts_and_motion<S: Surface>(model: &Model, state: &mut State, work: &mut Work, surface: &S) {
    let (step_size, parallel) = (state.step_size, work.parallel);
    let dt = step_size.kick();
    let setting = StepContext { laws: &model.laws, simd: work.simd, dt };
    let material = work.material;
    let State { blocks, lists, cross, planes, walls, bonds, max_travel, wall_travel, time, scars, .. } =
        state;
    let motions = &planes[..];
    let Work { members, blocks: works, cross: slots, beyond, applied, buffers, bonds: bonded, .. } = work;
    let standing = (&work.walls[..], &work.sheet[..]);
    let between = |b: usize, (blocks, members): Bodies<'_>, pairs: &mut Cross, out: &mut CrossForces| {
        out.clear_totals();
        dispatch::between(setting, model.clumps, (blocks, members), material, b, pairs, out);
        if !pairs.kinds.is_empty() {
            let now = broad_phase::block_configuration(model, (blocks, members), motions, standing, scars);
            narrow_phase::forces(&setting, &now, b, pairs, out);
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
        bonds: (bonded, bonds::parts(model, step_size.last, bonds.fresh)),
        drive: drive(model, step_size),
        time: *time,
        scars,
        travel_since_search: *max_travel + *wall_travel,
    };
    let (applied, keep) = (&**applied, work.keep_forces);
    let within = |b: usize, mut one: BlockTask<'_>, slots: Slots<'_>, next: Prefetch<'_>| {
        one.work.totals.sums = buffers.take();
        shared.forces(b, &mut one, slots, next);
        let BlockTask { block, members, work, .. } = one;
        let BlockWork { totals, body_forces, .. } = work;
        if model.acts_on_bodies() {
            let BlockTotals { sums, balance, .. } = &mut *totals;
            body_forces.act(&model.body_forces, shared.seen(block, members, sums), balance);
            body_forces.add_to(sums);
        }
        let applied = applied::of_block(applied, b);
        leapfrog::advance(setting.simd, &shared.drive, block, members, totals, applied);
        if model.acts_on_bodies() {
            body_forces.add_work(block, &mut totals.balance, dt);
        }
        if !keep {
            buffers.give_back(std::mem::take(&mut work.totals.sums));
        }
    };
    let threads = if parallel { rayon::current_num_threads() } else { 1 };
    let lists = BlockArrays { blocks, members, lists, works, cross, slots };
    threads::run_blocks(threads, &work.own, lists, beyond, between, within);
}

struct Shared<'a, S> {
    model: &'a Model,
    setting: StepContext<'a>,
    surface: &'a S,
    /// Placed planes and their common material.
    planes: (&'a [PlanePose], Option<u32>),
    walls: PlacedWalls<'a>,
    bonds: (&'a BondWork, Parts<'a>),
    drive: MotionInput<'a>,
    /// Time of the positions [s].
    time: f64,
    scars: &'a [Scar],
    /// Relative displacement bound since the last neighbour list [m].
    travel_since_search: f64,
}

impl<S: Surface> Shared<'_, S> {
    fn seen<'b>(
        &'b self,
        block: &'b Block,
        members: &'b BlockBodies,
        sums: &'b [ForceTorque],
    ) -> ForceInput<'b> {
        let Model { bodies, skins, gravity, .. } = self.model;
        let StepContext { simd, dt: kick, .. } = self.setting;
        let (time, scars) = (self.time, self.scars);
        ForceInput { simd, block, members, bodies, skins, gravity: *gravity, sums, time, kick, scars }
    }

    fn forces(&self, b: usize, one: &mut BlockTask<'_>, slots: Slots<'_>, next: Prefetch<'_>) {
        let (model, setting) = (self.model, self.setting);
        let BlockTask { block, members, lists, work } = one;
        let (block, members) = (&**block, &**members);
        let totals = &mut work.totals;
        totals.balance = BalanceTerms::default();
        totals.failure = None;
        work.patches.contacts.clear();
        work.patches.wall_sums.clear();
        totals.sums.clear();
        totals.sums.resize(block.bodies.len(), ForceTorque::default());
        dispatch::gather(setting.simd, &work.shares, &mut totals.sums, slots);
        if !model.bonds.is_empty() {
            let (shared, parts) = &self.bonds;
            bond::pass::within(parts, b, block, &mut lists.bonds, &mut totals.sums, &mut work.bonds, shared);
        }
        if !lists.pairs.is_empty() {
            dispatch::interior(setting, (block, members), &mut lists.pairs, totals, next);
        }
        let (planes, material) = self.planes;
        if !lists.planes.is_empty() {
            dispatch::planes(setting, planes, material, (block, members), &mut lists.planes, totals);
        }
        if !lists.walls.is_empty() {
            let walls = (&self.walls, self.travel_since_search);
            on_walls(model, &setting, walls, &mut lists.walls, (block, members), work);
        }
        if !lists.surface.is_empty() {
            let (surface, own) = ((self.surface, self.travel_since_search), (block, members));
            on_surface(model, &setting, surface, &mut lists.surface, own, work);
        }
    }
}

/// Sphere–wall contacts of a block; `travel_since_search`: as [`on_surface`].
pub(crate) fn on_walls(
    model: &Model,
    setting: &StepContext<'_>,
    (walls, travel_since_search): (&PlacedWalls<'_>, f64),
    list: &mut PatchList,
    own: (&Block, &BlockBodies),
    work: &mut BlockWork,
) {
    work.patches.wall_sums.resize(walls.groups(), WallSum::default());
    let (material, partner, external) = (|p| model.walls.material(p), |p| model.walls.partner(p), false);
    let BlockWork { totals, patches, .. } = work;
    match &model.images {
        None => {
            let against = ContactSurface { surface: walls, material, partner, external, travel_since_search };
            surface_contacts::contacts(setting, &against, list, own, totals, patches);
        }
        Some(images) => {
            let against = ContactSurface {
                surface: &Repeated { surface: walls, images },
                material: |p| material(images.original(p).0),
                partner: |p| partner(images.original(p).0),
                external,
                travel_since_search,
            };
            surface_contacts::contacts(setting, &against, list, own, totals, patches);
            // Sums refer to the centre of the wall itself.
            for (force, contact) in patches.forces().iter().zip(&list.live) {
                let offset = images.original(contact.patch).1;
                totals.balance.periodic.angular += offset.cross(&force.force()) * setting.dt;
            }
        }
    }
}

/// Sphere–surface contacts of a block; `travel_since_search`: relative displacement bound since the last neighbour list [m].
pub(crate) fn on_surface<S: Surface>(
    model: &Model,
    setting: &StepContext<'_>,
    (surface, travel_since_search): (&S, f64),
    list: &mut PatchList,
    own: (&Block, &BlockBodies),
    work: &mut BlockWork,
) {
    let (material, partner, external) = (|p| model.patch_material(p) as u32, Partner::Patch, true);
    let BlockWork { totals, patches, .. } = &mut *work;
    let done = match &model.images {
        None => {
            let against = ContactSurface { surface, material, partner, external, travel_since_search };
            surface_contacts::contacts(setting, &against, list, own, totals, patches)
        }
        Some(images) => {
            let against = ContactSurface {
                surface: &Repeated { surface, images },
                material: |p| material(images.original(p).0),
                partner: |p| partner(images.original(p).0),
                external,
                travel_since_search,
            };
            let first = patches.contacts.len();
            let done = surface_contacts::contacts(setting, &against, list, own, totals, patches);
            images.restore(&mut patches.contacts[first..]);
            done
        }
    };
    work.totals.balance.work_surface += done.work;
    work.totals.balance.surface += &done.impulse;
}

/// Sums in block order.
pub(crate) fn reduce_blocks(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    surface_speed: f64,
) -> Result<(), StepError> {
    work.surface_contacts.clear();
    let mut all = StepTotals::default();
    let StepTotals { sum, fastest, failure } = &mut all;
    for (w, cross) in work.blocks.iter().zip(&work.cross) {
        let totals = &w.totals;
        *sum += &totals.balance;
        sum.dissipated_dashpot += cross.dashpot;
        sum.dissipated_friction += cross.friction;
        sum.work_walls += cross.work_walls;
        sum.walls += &cross.walls;
        sum.periodic.angular += cross.couple;
        sum.work_surface += cross.surface.work;
        sum.surface += &cross.surface.impulse;
        *fastest = fastest.max(totals.fastest);
        *failure = failure.or(cross.failure).or(totals.failure);
        work.surface_contacts.extend_from_slice(&w.patches.contacts);
        work.surface_contacts.extend_from_slice(&cross.surface.contacts);
    }
    finish_step(model, state, work, all, surface_speed)
}

#[derive(Default)]
pub(crate) struct StepTotals {
    pub sum: BalanceTerms,
    /// Largest speed [m/s].
    pub fastest: f64,
    pub failure: Option<Failure>,
}

pub(crate) fn finish_step(
    model: &Model,
    state: &mut State,
    work: &mut Work,
    all: StepTotals,
    surface_speed: f64,
) -> Result<(), StepError> {
    let dt = state.step_size.dt;
    let StepTotals { mut sum, fastest, mut failure } = all;
    let meeting = wall_contacts::forces(model, state, &mut work.wall_contacts, &mut sum);
    let (wall_speed, wall_failure) = walls::advance(model, state, work, &mut sum);
    failure = failure.or(meeting).or(wall_failure);
    state.balance += &sum;
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
    state.max_travel += fastest * dt;
    state.wall_travel += wall_speed * dt;
    state.steps_since_search = state.steps_since_search.saturating_add(1);
    state.steps += 1;
    state.time = time + dt;
    state.step_size.last = dt;
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
