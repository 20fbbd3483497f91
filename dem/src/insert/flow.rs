//! Inlets and outlets: bodies that are taken out of a run and put in.
//!
//! All bodies that a run will ever see are in the model from the start. One that is *absent* is in no block, so that no
//! loop over blocks meets it; [`State::present`] tells. [`exchange`] takes bodies out and puts bodies in between two steps,
//! and books what they brought and took, so that the accounts of energy and momentum close as ever.
//!
//! Limits: no boxes, and no bodies that the model joins by bonds.

use crate::base::Vec3;
use crate::base::error::StepError;
use crate::bodies::block::Rotation;
use crate::bodies::table::Kind;
use crate::engine::back_end::BackEnd;
use crate::engine::model::Model;
use crate::engine::order::Turnover;
use crate::engine::place::Row;
use crate::engine::start::half_a_step_ago;
use crate::engine::state::State;
use crate::measure;
use nalgebra::UnitQuaternion;
use std::collections::BTreeMap;

/// A body on its way in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Body (index).
    pub body: usize,
    /// Centre of mass [m].
    pub position: Vec3,
    /// Turns the shape's frame into the world's; single spheres do not track theirs.
    pub orientation: UnitQuaternion<f64>,
    /// Velocity at the state's time [m/s].
    pub velocity: Vec3,
    /// Angular velocity, in world axes [rad/s].
    pub spin: Vec3,
}

/// Why bodies cannot be taken out or put in.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlowError {
    /// The body cannot.
    #[error("body {body} cannot be {what}: {problem}")]
    Body {
        /// Index of the body.
        body: usize,
        /// `"taken out"` or `"put in"`.
        what: &'static str,
        /// Why not.
        problem: &'static str,
    },
    /// What computes the steps cannot take the bodies over.
    #[error(transparent)]
    Step(#[from] StepError),
}

/// Takes out the bodies `leave` and puts in `arrive`, which may be bodies that have just left. Contacts among bodies that
/// stay keep their memory; those of bodies taken out cease to be. The velocities that the leapfrog keeps are those half a
/// step ago: of a body put in, the given one less half a step of gravity, so that it falls freely as from its place and
/// velocity at the state's time.
///
/// The energy and momentum of half a step ago that go and come are booked in the ledger.
///
/// # Errors
/// [`FlowError`] names the first body that cannot leave or come; nothing is changed then.
pub fn exchange(
    model: &Model,
    state: &mut State,
    work: &mut impl BackEnd,
    leave: &[usize],
    arrive: &[Arrival],
) -> Result<(), FlowError> {
    let bonded = bonded(model);
    let check = |body: usize, what: &'static str, here: Option<bool>| {
        let problem = match here {
            None => "there is no such body",
            Some(false) if what == "taken out" => "it is not there",
            Some(true) if what == "put in" => "it is there already",
            _ if model.bodies.kind(body) == Kind::Solid && !model.shape(body).dilated() => "it is a box",
            _ if bonded.get(body).is_some_and(|b| *b) => "a bond holds it",
            _ => return Ok(()),
        };
        Err(FlowError::Body { body, what, problem })
    };
    let mut turnover = Turnover::none(state);
    for &body in leave {
        check(body, "taken out", turnover.stays.get(body).copied())?;
        turnover.stays[body] = false;
    }
    for a in arrive {
        let here = turnover.stays.get(a.body).map(|s| *s || turnover.come.contains_key(&(a.body as u32)));
        check(a.body, "put in", here)?;
        let finite = [&a.position, &a.velocity, &a.spin].iter().all(|v| v.iter().all(|x| x.is_finite()));
        if !finite {
            let problem = "its position or motion is not finite";
            return Err(FlowError::Body { body: a.body, what: "put in", problem });
        }
        turnover.come.insert(a.body as u32, row(model, a));
    }
    if let Some(periodic) = &model.periodic {
        crate::engine::periodic::wrap(periodic, model, state);
    }
    let gone = |b: usize| state.present(b) && !turnover.stays[b];
    if !leave.is_empty() {
        let energy = measure::energies_of(model, state, gone).total();
        let momentum = measure::momentum_of(model, state, gone);
        state.ledger.work_flow -= energy;
        state.ledger.flow.linear -= momentum.linear;
        state.ledger.flow.angular -= momentum.angular;
    }
    let positions = turnover.positions(state);
    crate::engine::order::reorder(state, model, &positions, &turnover);
    let by_number: BTreeMap<usize, &Arrival> = arrive.iter().map(|a| (a.body, a)).collect();
    for (&body, a) in &by_number {
        let velocity = half_a_step_ago(model, body, &a.velocity, state.pace.last);
        state.set_velocity(model, body, velocity, a.spin);
    }
    if !arrive.is_empty() {
        // They touch nothing: what they bring is their own.
        let come = |b: usize| by_number.contains_key(&b);
        state.ledger.work_flow += measure::energies_of(model, state, come).total();
        let momentum = measure::momentum_of(model, state, come);
        state.ledger.flow += &momentum;
    }
    work.upload(model, state)?;
    Ok(())
}

fn row(model: &Model, a: &Arrival) -> Row {
    let rotation = Rotation { orientation: a.orientation, momentum: Vec3::zeros() };
    Row::at_rest(model, a.body, &a.position, rotation)
}

/// Whether each body has a bond in the model; empty where there are none.
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
