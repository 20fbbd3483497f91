//! One window of the coupled step.
//!
//! Theory manual: eqs. (5.6), (5.7).

use super::energy::add_step_energy;
use super::model::Model;
use super::solver::StepError;
use super::state::{State, Work};
use super::stiffened::LinearisedContact;
use crate::scheme::Scheme;
use crate::surface::Motion;
use trackbed_dem as dem;
use trackbed_dem::{BackEnd, stability};
use trackbed_fem as fem;
use trackbed_fem::state::StepAudit;

/// Velocity changes below this are rounding [m/s].
const STILL: f64 = 1e-12;

/// Advances the system by one window.
///
/// `applied` sets the forces on bodies at a given time, `solid_load` other solid loads at mid-window.
///
/// # Errors
/// The grains or the solid cannot make the step; `state` is then invalid.
pub fn step<B: BackEnd>(
    model: &Model<'_>,
    state: &mut State,
    work: &mut Work<B>,
    mut applied: impl FnMut(f64, &dem::State, &mut Vec<dem::AppliedForce>),
    solid_load: impl Fn(f64, &mut [f64]),
) -> Result<(), StepError> {
    let window = model.window();
    work.other_load.fill(0.0);
    solid_load(state.solid.time + 0.5 * window, &mut work.other_load);
    work.solver.keep_current(model.solid, &mut state.solid, &work.other_load);
    copy(&state.solid, &mut work.before);
    work.rate.copy_from_slice(&state.solid.v);
    let (passes, audit) = match model.scheme {
        Scheme::Predicted => {
            grains(model, state, work, &mut applied)?;
            (1, solid(model, state, work)?)
        }
        Scheme::Stiffened => (1, stiffened(model, state, work, &mut applied)?),
        Scheme::Lagged => return lagged(model, state, work, &mut applied),
        Scheme::Iterated { tolerance, passes } => {
            iterated(model, state, work, &mut applied, tolerance, passes)?
        }
    };
    state.passes.windows += 1;
    state.passes.passes += u64::from(passes);
    add_step_energy(model, state, work, &audit);
    // The next window begins at the computed surface.
    state.correction.resize(work.rate.len(), 0.0);
    let mut jump = 0.0_f64;
    for i in work.surface.dofs() {
        let moved = state.solid.u[i] - work.before.u[i];
        state.correction[i] = moved - work.rate[i] * window;
        jump = jump.max(state.correction[i].abs());
    }
    state.grains.add_surface_travel(work.surface.reach_of(2.0 * jump));
    Ok(())
}

fn stiffened<B: BackEnd>(
    model: &Model<'_>,
    state: &mut State,
    work: &mut Work<B>,
    applied: &mut impl FnMut(f64, &dem::State, &mut Vec<dem::AppliedForce>),
) -> Result<StepAudit, StepError> {
    // Initial contacts are unknown.
    if state.passes.windows > 0 {
        begin(model, state, work)?;
        state.passes.solves += u64::from(predict(model, state, work)?);
    }
    grains(model, state, work, applied)?;
    state.last_contacts.clear();
    state.last_contacts.extend(work.grains.surface_contacts().iter().map(LinearisedContact::from));
    solid(model, state, work)
}

fn lagged<B: BackEnd>(
    model: &Model<'_>,
    state: &mut State,
    work: &mut Work<B>,
    applied: &mut impl FnMut(f64, &dem::State, &mut Vec<dem::AppliedForce>),
) -> Result<(), StepError> {
    let n = work.contact_load.len();
    state.lagged.iter_mut().for_each(|l| l.resize(n, 0.0));
    for (load, (a, b)) in work.contact_load.iter_mut().zip(state.lagged[0].iter().zip(&state.lagged[1])) {
        *load = 0.5 * (a + b);
    }
    let audit = solid(model, state, work)?;
    mean_velocity(&state.solid, work, model.window());
    // This window's contact load acts on the solid in the next.
    add_step_energy(model, state, work, &audit);
    grains(model, state, work, applied)?;
    state.lagged.swap(0, 1);
    state.lagged[0].copy_from_slice(&work.contact_load);
    state.passes.windows += 1;
    state.passes.passes += 1;
    Ok(())
}

/// Repeats passes until the surface velocity converges, else takes the best.
fn iterated<B: BackEnd>(
    model: &Model<'_>,
    state: &mut State,
    work: &mut Work<B>,
    applied: &mut impl FnMut(f64, &dem::State, &mut Vec<dem::AppliedForce>),
    tolerance: f64,
    most: u32,
) -> Result<(u32, StepAudit), StepError> {
    let window = model.window();
    work.before.points.clone_from(&state.solid.points);
    let start = (state.grains.clone(), state.audit);
    work.accelerator.start();
    let nodes = work.surface.nodes().to_vec();
    let unknowns = || nodes.iter().flat_map(|&n| [0, 1, 2].map(|d| 3 * n as usize + d));
    let mut at: Vec<f64> = unknowns().map(|i| work.rate[i]).collect();
    let mut best = (f64::INFINITY, at.clone());
    let mut passes = 1;
    loop {
        grains(model, state, work, applied)?;
        let audit = solid(model, state, work)?;
        let found: Vec<f64> = unknowns().map(|i| (state.solid.u[i] - work.before.u[i]) / window).collect();
        let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let change = found.iter().zip(&at).fold(0.0_f64, |m, (f, a)| m.max((f - a).abs()));
        let there = change <= tolerance * largest(&found).max(largest(&at)) + STILL;
        // Last allowed pass, or a repetition of the best.
        let last = there || passes > most || (passes == most && change <= best.0);
        if last {
            state.passes.unconverged += u64::from(!there);
            return Ok((passes, audit));
        }
        if change < best.0 {
            best.0 = change;
            best.1.copy_from_slice(&at);
        }
        if passes == most {
            at.copy_from_slice(&best.1);
        } else {
            work.accelerator.next(&mut at, &found);
        }
        unknowns().zip(&at).for_each(|(i, a)| work.rate[i] = *a);
        copy(&work.before, &mut state.solid);
        state.solid.points.clone_from(&work.before.points);
        (state.grains, state.audit) = start.clone();
        work.grains.upload(&model.grains, &state.grains)?;
        passes += 1;
    }
}

/// Motion only: stresses are large, and only repeated windows need them.
fn copy(from: &fem::state::State, to: &mut fem::state::State) {
    to.time = from.time;
    to.u.copy_from_slice(&from.u);
    to.v.copy_from_slice(&from.v);
    to.a.copy_from_slice(&from.a);
    to.reduced.copy_motion(&from.reduced);
}

fn mean_velocity<B>(solid: &fem::state::State, work: &mut Work<B>, window: f64) {
    for ((rate, u), before) in work.rate.iter_mut().zip(&solid.u).zip(&work.before.u) {
        *rate = (u - before) / window;
    }
}

/// Starts the surface motion with [`Work::rate`].
fn begin<B>(model: &Model<'_>, state: &State, work: &mut Work<B>) -> Result<(), StepError> {
    let velocity =
        (model.scheme == Scheme::Lagged).then_some([work.before.v.as_slice(), state.solid.v.as_slice()]);
    let motion = Motion {
        start: &work.before.u,
        reference: &model.reference,
        rate: &work.rate,
        velocity,
        correction: (!work.correction.is_empty()).then_some(&work.correction),
        duration: model.window(),
    };
    work.surface.begin(model.solid.mesh(), &motion);
    match work.surface.folded() {
        None => Ok(()),
        Some(face) => {
            let element = work.surface.faces()[face].element as usize;
            let element = model.solid.mesh().element_ids[element];
            Err(StepError::Folded { element, time: work.before.time })
        }
    }
}

/// First-step displacement of tangential springs in excess of the rate.
fn correct<B>(state: &State, work: &mut Work<B>) {
    let half = state.grains.kick() - 0.5 * state.grains.dt();
    if state.rate.is_empty() || state.rate.len() != state.correction.len() {
        work.correction.clear();
        return;
    }
    work.correction.resize(state.correction.len(), 0.0);
    for i in work.surface.dofs() {
        work.correction[i] = state.correction[i] + (state.rate[i] - work.rate[i]) * half;
    }
}

/// The mean load is then in [`Work::contact_load`].
fn grains<B: BackEnd>(
    model: &Model<'_>,
    state: &mut State,
    work: &mut Work<B>,
    applied: &mut impl FnMut(f64, &dem::State, &mut Vec<dem::AppliedForce>),
) -> Result<(), StepError> {
    let substeps = {
        let most = model.substeps / model.division;
        stability::divide(&model.grains, &mut state.grains, model.window(), most)
    };
    let dt = state.grains.dt();
    correct(state, work);
    begin(model, state, work)?;
    work.transfer.begin_window();
    for k in 0..substeps {
        work.surface.advance((f64::from(k) + 0.5) * dt);
        work.applied.clear();
        applied(state.grains.time, &state.grains, &mut work.applied);
        // Both sides get the same impulse, also if the step changes.
        let kick = state.grains.kick();
        work.grains.step(&model.grains, &mut state.grains, &work.surface, &work.applied)?;
        work.transfer.add(&work.surface, work.grains.surface_contacts(), kick, &mut state.audit);
        work.surface.end_correction();
    }
    work.grains.download(&model.grains, &mut state.grains)?;
    work.contact_load.fill(0.0);
    work.transfer.add_mean_load(&work.surface, model.window(), &mut work.contact_load);
    work.transfer.audit_spread(&work.surface, model.window(), &work.contact_load, &mut state.audit);
    Ok(())
}

fn solid<B>(model: &Model<'_>, state: &mut State, work: &mut Work<B>) -> Result<StepAudit, StepError> {
    let loads = work.contact_load.iter().zip(&work.other_load).zip(&model.dead_load);
    for (load, ((contact, other), dead)) in work.load.iter_mut().zip(loads) {
        *load = other + (contact + dead);
    }
    let time = state.solid.time;
    work.solver
        .step(model.solid, &mut state.solid, &work.load)
        .map_err(|source| StepError::Solid { time, source })
}

/// Predicted surface velocity of the stiffened scheme.
fn predict<B>(model: &Model<'_>, state: &State, work: &mut Work<B>) -> Result<u32, StepError> {
    let time = state.solid.time;
    for ((load, other), dead) in work.load.iter_mut().zip(&work.other_load).zip(&model.dead_load) {
        *load = other + dead;
    }
    work.stiffened
        .predict(
            model,
            &state.grains,
            &state.last_contacts,
            &work.surface,
            &mut *work.solver,
            &state.solid,
            &mut work.load,
            &mut work.rate,
        )
        .map_err(|source| StepError::Solid { time, source })
}

/// Removes and inserts grains between two windows, see [`dem::flow::exchange`].
///
/// # Errors
/// A grain cannot be removed or inserted.
pub fn exchange<B: BackEnd>(
    model: &Model<'_>,
    state: &mut State,
    work: &mut Work<B>,
    leave: &[usize],
    arrive: &[dem::flow::Arrival],
) -> Result<(), dem::flow::FlowError> {
    dem::flow::exchange(&model.grains, &mut state.grains, &mut work.grains, leave, arrive)?;
    state.last_contacts.retain(|c| !leave.contains(&c.body()));
    Ok(())
}
