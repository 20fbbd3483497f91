//! External forces on bodies in a step.

use super::input::AppliedForce;
use super::model::Model;
use super::state::State;
use crate::base::error::StepError;
use crate::integrate::leapfrog::Applied;
use crate::lanes::vec4::xyz;

pub(crate) fn add_forces(
    model: &Model,
    state: &State,
    applied: &[AppliedForce],
    out: &mut Vec<Applied>,
) -> Result<(), StepError> {
    out.clear();
    for (index, a) in applied.iter().enumerate() {
        let there = a.body < model.bodies.len() && state.present(a.body);
        if !there || !a.force.iter().chain(a.point.iter()).all(|x| x.is_finite()) {
            return Err(StepError::Applied { time: state.time, index, body: a.body });
        }
        let [block, place] = state.places[a.body];
        let centre = xyz(&state.blocks[block as usize].centre[place as usize]);
        let torque = (a.point - centre).cross(&a.force);
        out.push(Applied { block, place, force: a.force, torque });
    }
    // Stable sort: forces on one body are summed in the given order.
    out.sort_by_key(|a| (a.block, a.place));
    Ok(())
}

pub(crate) fn of_block(applied: &[Applied], b: usize) -> &[Applied] {
    let from = applied.partition_point(|a| (a.block as usize) < b);
    let to = applied.partition_point(|a| a.block as usize <= b);
    &applied[from..to]
}
