//! θ-methods: one implicit step under the mean load of a coupling window.

mod linear;
mod nonlinear;
mod reduced;

pub use linear::ThetaSolver;
pub use nonlinear::NonlinearTheta;
pub use reduced::ReducedTheta;

use crate::error::SolveError;
use crate::integrator::{Conditions, Loading, OnStep, StepReport, TimeIntegrator, steps_of};
use crate::model::Model;
use crate::reduction::OutOfBalance;
use crate::state::{State, StepAudit};

/// θ-method of one window length; as [`TimeIntegrator`] it averages the loads at both ends.
pub trait ThetaMethod: TimeIntegrator {
    /// Window length [s].
    fn dt(&self) -> f64;

    /// Convergence of the last step or its last part.
    fn report(&mut self) -> &mut StepReport;

    /// Steps under the mean load [N], shape `[3 * nodes]`, to displacements [m] ordered as
    /// [`Supports::fixed`](crate::supports::Supports::fixed); `None`: unchanged. `state.a` becomes the mean
    /// acceleration.
    ///
    /// # Errors
    /// Values not finite; no convergence; moved supports of a reduced body (state unchanged).
    fn step_prescribed(
        &mut self,
        model: &Model,
        state: &mut State,
        mean_load: &[f64],
        prescribed: Option<&[f64]>,
    ) -> Result<StepAudit, SolveError>;

    /// Steps under the mean load [N], shape `[3 * nodes]`, with fixed supports.
    ///
    /// # Errors
    /// As [`ThetaMethod::step_prescribed`].
    fn step(&mut self, model: &Model, state: &mut State, mean_load: &[f64]) -> Result<StepAudit, SolveError> {
        self.step_prescribed(model, state, mean_load, None)
    }

    /// Lists dofs with a load [N] among those whose motion each step of a reduced body writes to `state`, the
    /// contact surface and others that carried loads.
    fn keep_current(&mut self, _model: &Model, _state: &mut State, _load: &[f64]) {}

    /// Writes the motion of all other dofs of a reduced body to `state`.
    fn recover(&self, _state: &mut State) {}

    /// Returns energies of a reduced body, none before its first step and for others: their state has all motion.
    fn stored(&self, _state: &State) -> Option<Stored> {
        None
    }

    /// Returns what the basis of a reduced body left unbalanced in the last step, to `state` under this load [N].
    fn out_of_balance(&self, _model: &Model, _state: &State, _mean_load: &[f64]) -> Option<OutOfBalance> {
        None
    }

    /// Predicts the mean velocity [m/s] with linearised contact:
    ///
    /// `contacts` adds a symmetric positive semidefinite product; shapes `[3 * nodes]`. Returns the
    /// iterations.
    ///
    /// # Errors
    /// [`SolveError::Plastic`]; values not finite; no convergence.
    fn solve_with_contact_stiffness(
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

/// Energies of a reduced body [J].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stored {
    /// Kinetic.
    pub kinetic: f64,
    /// Strain energy.
    pub strain: f64,
    /// Work of the dead load on the displacement.
    pub dead_load_work: f64,
}

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
        // Exact end time, without rounding of the sum.
        state.time = ends[1];
        method.recover(state);
        let report = method.report();
        report.time = ends[1];
        on_step(state, report, Some(&audit));
    }
    Ok(())
}

fn check_theta(theta: f64) -> Result<(), SolveError> {
    if (0.5..=1.0).contains(&theta) { Ok(()) } else { Err(SolveError::Theta { theta }) }
}
