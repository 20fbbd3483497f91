//! θ-methods: one implicit step under the mean load of a time window, the solid's part of a coupled step.
//!
//! [`ThetaSolver`] for linear bodies, [`NonlinearTheta`] for elastoplastic ones, [`ReducedTheta`] in the span of a
//! [reduction](crate::reduction). Only the impulse of a window enters, so the impulse that the other side felt is passed on exactly.

mod linear;
mod nonlinear;
mod reduced;

pub use linear::ThetaSolver;
pub use nonlinear::NonlinearTheta;
pub use reduced::ReducedTheta;

use crate::error::SolveError;
use crate::integrator::{Conditions, Loading, OnStep, StepReport, TimeIntegrator, steps_of};
use crate::model::Model;
use crate::state::{State, StepAudit};

/// A θ-method with windows of one length. As [`TimeIntegrator`] it takes the mean of the loads at both ends of each window.
pub trait ThetaMethod: TimeIntegrator {
    /// The length of the window [s].
    fn dt(&self) -> f64;

    /// How the last step, or the last part of it, converged.
    fn report(&mut self) -> &mut StepReport;

    /// One step under the mean load [N] of the window, shape `[3 * nodes]`, with the displacement [m] of each constrained dof at
    /// its end, in the order of [`Supports::fixed`](crate::supports::Supports::fixed); without it all stay where they are.
    /// `state.a` becomes the mean acceleration of the window, or of its last part.
    ///
    /// # Errors
    /// A load, a displacement or a result that is not finite; a window that does not converge; moved supports of a reduced body.
    /// The state is untouched then.
    fn step_prescribed(
        &mut self,
        model: &Model,
        state: &mut State,
        mean_load: &[f64],
        prescribed: Option<&[f64]>,
    ) -> Result<StepAudit, SolveError>;

    /// One step under the mean load [N] of the window, shape `[3 * nodes]`, on supports that stay where they are.
    ///
    /// # Errors
    /// As [`ThetaMethod::step_prescribed`].
    fn step(&mut self, model: &Model, state: &mut State, mean_load: &[f64]) -> Result<StepAudit, SolveError> {
        self.step_prescribed(model, state, mean_load, None)
    }

    /// The mean velocity [m/s] that a step would have if the load fell by `contacts(w)` as this velocity exceeds the present
    /// one by w: a linearized contact on the body. `contacts` adds a symmetric, positive semidefinite product to its second
    /// argument; shapes `[3 * nodes]`. The state stays as it is. Returns the iterations of the solve.
    ///
    /// # Errors
    /// [`SolveError::Plastic`] for a method without a constant matrix of all dofs; a load or a result that is not finite; an
    /// iteration without a factor that does not converge.
    fn predict(
        &mut self,
        model: &Model,
        _state: &State,
        _mean_load: &[f64],
        _contacts: &mut dyn FnMut(&[f64], &mut [f64]),
        _rate: &mut [f64],
    ) -> Result<u32, SolveError> {
        Err(SolveError::Plastic { material: model.plastic_material().unwrap_or_default() })
    }
}

/// [`TimeIntegrator::integrate`] of a θ-method; `to` must lie a whole number of windows ahead.
fn integrate(
    method: &mut impl ThetaMethod,
    model: &Model,
    state: &mut State,
    to: f64,
    loading: &mut dyn Loading,
    on_step: OnStep<'_>,
) -> Result<(), SolveError> {
    let mut conditions = Conditions::default();
    for ends in steps_of(state.time, to, method.dt())? {
        conditions.evaluate(model, state, ends, loading);
        let [mean, end] = &mut conditions.loads;
        mean.iter_mut().zip(&*end).for_each(|(m, e)| *m = 0.5 * (*m + e));
        let audit = method.step_prescribed(model, state, &conditions.loads[0], conditions.prescribed())?;
        // The end itself, where the sum of the steps would miss it by rounding.
        state.time = ends[1];
        let report = method.report();
        report.time = ends[1];
        on_step(state, report, Some(&audit));
    }
    Ok(())
}

/// Rejects a weight of the end of a window that is not from 1/2 to 1.
fn check_theta(theta: f64) -> Result<(), SolveError> {
    if (0.5..=1.0).contains(&theta) { Ok(()) } else { Err(SolveError::Theta { theta }) }
}
