//! Initial conditions and state checks of a step.

use crate::error::SolveError;
use crate::integrator::Loading;
use crate::model::Model;
use crate::state::State;
use crate::statics::check_finite;
use crate::supports::name;

pub(crate) fn subtract_springs(model: &Model, u: &[f64], rhs: &mut [f64]) {
    if !model.matrices().springs().is_empty() {
        rhs.iter_mut().for_each(|r| *r = -*r);
        model.boundary_spring_times(u, rhs);
        rhs.iter_mut().for_each(|r| *r = -*r);
    }
}

pub(crate) fn prescribe(
    model: &Model,
    state: &State,
    time: f64,
    loading: &mut dyn Loading,
    increments: &mut [f64],
) -> Result<(), SolveError> {
    let fixed = model.supports().fixed();
    increments.iter_mut().zip(fixed).for_each(|(i, (_, value))| *i = *value);
    loading.prescribed(time, increments);
    for (increment, &(dof, _)) in increments.iter_mut().zip(fixed) {
        if !increment.is_finite() {
            let (node, direction) = name(model.mesh(), dof as usize);
            let what = "the prescribed displacement";
            return Err(SolveError::NotFinite { what, node, direction, time });
        }
        *increment -= state.u[dof as usize];
    }
    Ok(())
}

pub(crate) fn check_state(model: &Model, state: &State) -> Result<(), SolveError> {
    let n = model.dof_count();
    for (what, found) in [
        ("displacement of the state", state.u.len()),
        ("velocity of the state", state.v.len()),
        ("acceleration of the state", state.a.len()),
    ] {
        if found != n {
            return Err(SolveError::Length { what, found, expected: n });
        }
    }
    let (found, expected) = (state.points.len(), model.point_count());
    if found != expected && !(found == 0 && model.is_linear()) {
        return Err(SolveError::Length { what: "list of integration points of the state", found, expected });
    }
    check_finite(model, "the displacement", &state.u, state.time)
}

pub(crate) fn ensure_points(model: &Model, state: &mut State) {
    if state.points.is_empty() {
        let mut points = model.new_points();
        for e in 0..model.mesh().element_count() {
            let stresses = crate::stress::gauss(model, &state.u, e);
            for (point, stress) in points[model.point_start(e)..].iter_mut().zip(stresses) {
                point.stress = stress;
            }
        }
        state.points = points;
    }
}
