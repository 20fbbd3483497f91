//! Time integrators behind one trait, [`TimeIntegrator`].

mod solver_state;
mod step_control;

use crate::error::SolveError;
use crate::model::Model;
use crate::state::{State, StepAudit};
use serde::{Deserialize, Serialize};
pub use solver_state::{SolverState, Statistics};
pub use step_control::StepControl;
pub(crate) use step_control::StepLength;

/// Loads and prescribed displacements as functions of time; a closure `|time, load|` has constant supports.
pub trait Loading {
    /// Adds the nodal forces [N] at `time` to the zeroed `load`. Shape `[3 * nodes]`.
    fn load(&mut self, time: f64, load: &mut [f64]);

    /// Sets the displacements [m] of constrained dofs at `time`, ordered as
    /// [`Supports::fixed`](crate::supports::Supports::fixed).
    fn prescribed(&mut self, _time: f64, _values: &mut [f64]) {}

    /// Whether to abort the step: [`SolveError::Stopped`], with the last accepted state.
    fn stopped(&self) -> bool {
        false
    }
}

impl<F: FnMut(f64, &mut [f64])> Loading for F {
    fn load(&mut self, time: f64, load: &mut [f64]) {
        self(time, load);
    }
}

/// Loading by two closures.
pub struct LoadFunctions<L, P> {
    /// See [`Loading::load`].
    pub load: L,
    /// See [`Loading::prescribed`].
    pub prescribed: P,
}

impl<L: FnMut(f64, &mut [f64]), P: FnMut(f64, &mut [f64])> Loading for LoadFunctions<L, P> {
    fn load(&mut self, time: f64, load: &mut [f64]) {
        (self.load)(time, load);
    }

    fn prescribed(&mut self, time: f64, values: &mut [f64]) {
        (self.prescribed)(time, values);
    }
}

/// Convergence of one step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepReport {
    /// End time of the step.
    pub time: f64,
    /// Step length.
    pub dt: f64,
    /// Number of solves.
    pub iterations: u32,
    /// Relative residuals: at the start, then after each iteration.
    pub residuals: Vec<f64>,
    /// Gauss points that yielded.
    pub plastic_points: usize,
}

impl StepReport {
    pub(crate) fn linear(time: f64, dt: f64) -> StepReport {
        StepReport { time, dt, iterations: 1, ..StepReport::default() }
    }
}

/// Called after every accepted step with state, report, and balanced energies.
pub type OnStep<'a> = &'a mut dyn FnMut(&State, &StepReport, Option<&StepAudit>);

/// Time integration method.
pub trait TimeIntegrator: Send + Sync {
    /// Advances `state` to the time `to` exactly.
    ///
    /// Dynamic methods require the initial acceleration of the equations of motion.
    ///
    /// # Errors
    /// Values not finite; no convergence; for fixed steps, `to` not a whole number of steps ahead.
    fn integrate(
        &mut self,
        model: &Model,
        state: &mut State,
        to: f64,
        loading: &mut dyn Loading,
        on_step: OnStep<'_>,
    ) -> Result<(), SolveError>;

    /// Checkpointed state of methods with Newton iteration.
    fn solver_state(&self) -> Option<SolverState> {
        None
    }

    /// Restores checkpointed state of the same model and options.
    ///
    /// # Errors
    /// Failed factorisation.
    fn restore(&mut self, _model: &Model, _memory: &SolverState) -> Result<(), SolveError> {
        Ok(())
    }

    /// Support reactions [N] after the last accepted step, if stored; 0 at free dofs. Shape `[3 * nodes]`.
    fn reactions(&self) -> Option<&[f64]> {
        None
    }
}

#[derive(Default)]
pub(crate) struct Conditions {
    /// Loads [N] at start and end. Shape `[3 * nodes]`.
    pub loads: [Vec<f64>; 2],
    prescribed: Vec<f64>,
    moved: bool,
}

impl Conditions {
    /// Evaluates a loading at these `ends` [s].
    pub fn evaluate(&mut self, model: &Model, state: &State, ends: [f64; 2], loading: &mut dyn Loading) {
        for (load, time) in self.loads.iter_mut().zip(ends) {
            load.clear();
            load.resize(model.dof_count(), 0.0);
            loading.load(time, load);
        }
        let fixed = model.supports().fixed();
        self.prescribed.clear();
        self.prescribed.extend(fixed.iter().map(|(_, value)| *value));
        loading.prescribed(ends[1], &mut self.prescribed);
        let mut values = fixed.iter().zip(&self.prescribed);
        self.moved = values.any(|((dof, _), value)| state.u[*dof as usize] != *value);
    }

    /// Final displacements [m] of constrained dofs, unless fixed.
    pub fn prescribed(&self) -> Option<&[f64]> {
        self.moved.then_some(&self.prescribed)
    }
}

/// Ends [s] of each step.
///
/// # Errors
/// The interval is not a whole number of steps.
pub(crate) fn steps_of(from: f64, to: f64, dt: f64) -> Result<impl Iterator<Item = [f64; 2]>, SolveError> {
    let count = ((to - from) / dt).round();
    let whole = (from + count * dt - to).abs() <= 1e-9 * dt.max(to.abs());
    if !(whole && count >= 0.0) {
        let expected = "a whole number of steps ahead of the state";
        return Err(SolveError::Option { what: "the end time", value: to, expected });
    }
    let at = move |i: u64| if i as f64 == count { to } else { from + i as f64 * dt };
    Ok((0..count as u64).map(move |i| [at(i), at(i + 1)]))
}
