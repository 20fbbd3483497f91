//! Initial acceleration from the equations of motion.

use super::check_density;
use crate::energy::inner_force;
use crate::equations::mass::solve_mass;
use crate::error::SolveError;
use crate::model::Model;
use crate::state::State;
use crate::statics::{check_linear, check_load, check_prescribed};

/// Sets `state.a`: `M a = F - C v - K u` on the free dofs, 0 on the others.
///
/// # Errors
/// Load of wrong length or not finite, material without density, or failed mass solution.
pub fn initial_acceleration(model: &Model, state: &mut State, load: &[f64]) -> Result<(), SolveError> {
    initial_acceleration_prescribed(model, state, load, None)
}

/// Like [`initial_acceleration`], with accelerations [m/s²] of constrained dofs, ordered as
/// [`crate::supports::Supports::fixed`].
///
/// # Errors
/// As [`initial_acceleration`].
pub fn initial_acceleration_prescribed(
    model: &Model,
    state: &mut State,
    load: &[f64],
    accelerations: Option<&[f64]>,
) -> Result<(), SolveError> {
    check_load(model, load, state.time)?;
    check_linear(model)?;
    check_prescribed(model, accelerations, state.time)?;
    check_density(model)?;
    let n = model.dof_count();
    state.a.fill(0.0);
    if let Some(values) = accelerations {
        for (&(dof, _), &value) in model.supports().fixed().iter().zip(values) {
            state.a[dof as usize] = value;
        }
    }
    let (mut force, mut scratch) = (vec![0.0; n], vec![0.0; 2 * n]);
    inner_force(model, [&state.u, &state.v, &state.a], &mut force, &mut scratch);
    force.iter_mut().zip(load).for_each(|(f, l)| *f = l - *f);
    accelerate(model, &force, state)
}

pub(crate) fn accelerate(model: &Model, force: &[f64], state: &mut State) -> Result<(), SolveError> {
    let mut free = vec![0.0; force.len()];
    if let Some(masses) = model.matrices().lumped_mass() {
        for &d in model.supports().free() {
            free[d as usize] = force[d as usize] / masses[d as usize / 3];
        }
    } else {
        solve_mass(model.matrices(), model.supports(), force, &mut free)?;
    }
    for &d in model.supports().free() {
        state.a[d as usize] = free[d as usize];
    }
    Ok(())
}
