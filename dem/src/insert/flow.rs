//! Inlets and outlets: insertion and removal of bodies during a run.
//!
//! Absent bodies belong to no block ([`State::present`]).
//!
//! Limits: no boxes, no bonded bodies.

use crate::base::Vec3;
use crate::base::error::StepError;
use crate::bodies::block::Rotation;
use crate::engine::back_end::BackEnd;
use crate::engine::block_layout::BodyState;
use crate::engine::model::Model;
use crate::engine::reordering::BodyChanges;
use crate::engine::start::half_a_step_ago;
use crate::engine::state::State;
use crate::measure;
use nalgebra::UnitQuaternion;
use std::collections::BTreeMap;

/// Body to insert.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Body (index).
    pub body: usize,
    /// Centre of mass [m].
    pub position: Vec3,
    /// Rotation from shape frame to world; not tracked for single spheres.
    pub orientation: UnitQuaternion<f64>,
    /// Velocity at the current time [m/s].
    pub velocity: Vec3,
    /// Angular velocity in world axes [rad/s].
    pub spin: Vec3,
}

/// Failed insertion or removal.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlowError {
    /// Body not supported.
    #[error("body {body} cannot be {what}: {problem}")]
    Body {
        /// Index of the body.
        body: usize,
        /// `"taken out"` or `"put in"`.
        what: &'static str,
        /// Reason.
        problem: &'static str,
    },
    /// Back end failure.
    #[error(transparent)]
    Step(#[from] StepError),
}

/// Removes the bodies `leave` and inserts `arrive`, possibly the same; remaining contacts keep their history.
/// Energy and momentum of that instant are balanced.
///
/// # Errors
/// [`FlowError`] of the first invalid body; nothing is changed.
pub fn exchange(
    model: &Model,
    state: &mut State,
    work: &mut impl BackEnd,
    leave: &[usize],
    arrive: &[Arrival],
) -> Result<(), FlowError> {
    let bonded = bonded(model);
    let check = |body: usize, what: &'static str, here: Option<bool>| {
        let permanent = || model.shape(body).query(|s| s.permanent());
        let problem = match here {
            None => "there is no such body",
            Some(false) if what == "taken out" => "it is not there",
            Some(true) if what == "put in" => "it is there already",
            _ => match permanent() {
                Some(problem) => problem,
                None if bonded.get(body).is_some_and(|b| *b) => "a bond holds it",
                None => return Ok(()),
            },
        };
        Err(FlowError::Body { body, what, problem })
    };
    let mut changes = BodyChanges::none(state);
    for &body in leave {
        check(body, "taken out", changes.stays.get(body).copied())?;
        changes.stays[body] = false;
    }
    for a in arrive {
        let here = changes.stays.get(a.body).map(|s| *s || changes.come.contains_key(&(a.body as u32)));
        check(a.body, "put in", here)?;
        let finite = [&a.position, &a.velocity, &a.spin].iter().all(|v| v.iter().all(|x| x.is_finite()));
        if !finite {
            let problem = "its position or motion is not finite";
            return Err(FlowError::Body { body: a.body, what: "put in", problem });
        }
        changes.come.insert(a.body as u32, row(model, a));
    }
    if let Some(periodic) = &model.periodic {
        crate::engine::periodic::wrap(periodic, model, state);
    }
    let gone = |b: usize| state.present(b) && !changes.stays[b];
    if !leave.is_empty() {
        let energy = measure::energies_of(model, state, gone).total();
        let momentum = measure::momentum_of(model, state, gone);
        state.balance.work_flow -= energy;
        state.balance.flow.linear -= momentum.linear;
        state.balance.flow.angular -= momentum.angular;
    }
    let positions = changes.positions(state);
    crate::engine::reordering::reorder(state, model, &positions, &changes);
    let by_number: BTreeMap<usize, &Arrival> = arrive.iter().map(|a| (a.body, a)).collect();
    for (&body, a) in &by_number {
        let velocity = half_a_step_ago(model, body, &a.velocity, state.step_size.last);
        state.set_velocity(model, body, velocity, a.spin);
    }
    if !arrive.is_empty() {
        // Without contacts, only their own energy enters.
        let come = |b: usize| by_number.contains_key(&b);
        state.balance.work_flow += measure::energies_of(model, state, come).total();
        let momentum = measure::momentum_of(model, state, come);
        state.balance.flow += &momentum;
    }
    work.upload(model, state)?;
    Ok(())
}

fn row(model: &Model, a: &Arrival) -> BodyState {
    let rotation = Rotation { orientation: a.orientation, momentum: Vec3::zeros() };
    BodyState::at_rest(model, a.body, &a.position, rotation)
}

fn bonded(model: &Model) -> Vec<bool> {
    let mut bonded = if model.bonds.is_empty() { Vec::new() } else { vec![false; model.bodies.len()] };
    for bond in &model.bonds {
        bond.ends.iter().for_each(|&b| bonded[b as usize] = true);
    }
    bonded
}

#[cfg(test)]
#[path = "flow_tests.rs"]
mod tests;
