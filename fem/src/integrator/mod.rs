//! Methods that carry a body through time, behind one trait: linear and elastoplastic, dynamic and quasi-static.
//!
//! [`NewmarkSolver`](crate::newmark::NewmarkSolver) (Newmark and HHT-α with one factor), the elastoplastic
//! [`Dynamics`](crate::nonlinear::Dynamics) and [`QuasiStatic`](crate::nonlinear::QuasiStatic), and the methods of
//! [`theta`](crate::theta). A new method is one that implements [`TimeIntegrator`].

mod memory;
mod step_control;

use crate::error::SolveError;
use crate::model::Model;
use crate::state::{State, StepAudit};
pub use memory::{Memory, Statistics};
use serde::{Deserialize, Serialize};
pub use step_control::StepControl;
pub(crate) use step_control::StepLength;

/// Loads and prescribed displacements as functions of time.
///
/// A closure `|time, load|` is a loading that leaves the supports at the values of the model.
pub trait Loading {
    /// Adds the nodal forces [N] at `time` to `load`, which comes in as zeros. Shape `[3 * nodes]`.
    fn load(&mut self, time: f64, load: &mut [f64]);

    /// Sets the displacements [m] of the constrained dofs at `time`, in the order of
    /// [`Supports::fixed`](crate::supports::Supports::fixed); they come in with the values of the model.
    fn prescribed(&mut self, _time: f64, _values: &mut [f64]) {}

    /// Whether a step is to be given up: a look between two iterations. The step then fails with
    /// [`SolveError::Stopped`], and the state is that of the last accepted one.
    fn stopped(&self) -> bool {
        false
    }
}

impl<F: FnMut(f64, &mut [f64])> Loading for F {
    fn load(&mut self, time: f64, load: &mut [f64]) {
        self(time, load);
    }
}

/// A loading of two closures.
pub struct Driven<L, P> {
    /// As [`Loading::load`].
    pub load: L,
    /// As [`Loading::prescribed`].
    pub prescribed: P,
}

impl<L: FnMut(f64, &mut [f64]), P: FnMut(f64, &mut [f64])> Loading for Driven<L, P> {
    fn load(&mut self, time: f64, load: &mut [f64]) {
        (self.load)(time, load);
    }

    fn prescribed(&mut self, time: f64, values: &mut [f64]) {
        (self.prescribed)(time, values);
    }
}

/// How one step converged.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepReport {
    /// Time at the end of the step.
    pub time: f64,
    /// Length of the step.
    pub dt: f64,
    /// Solves with a matrix in this step.
    pub iterations: u32,
    /// Residual on the free dofs over the forces: at the start, then after each iteration.
    pub residuals: Vec<f64>,
    /// Gauss points that yielded in the step.
    pub plastic_points: usize,
}

impl StepReport {
    /// The report of a step that is one linear solve.
    pub(crate) fn linear(time: f64, dt: f64) -> StepReport {
        StepReport { time, dt, iterations: 1, ..StepReport::default() }
    }
}

/// Called after every accepted step with the state, how the step converged, and its energies where the method balances them.
pub type OnStep<'a> = &'a mut dyn FnMut(&State, &StepReport, Option<&StepAudit>);

/// A method of time integration.
pub trait TimeIntegrator: Send + Sync {
    /// Carries `state` to the time `to`, which it reaches exactly.
    ///
    /// A dynamic method starts from the acceleration of the state, which must be that of its equations of motion.
    ///
    /// # Errors
    /// A load, a displacement or a result that is not finite; a step that does not converge; for a method with one length of
    /// step an end that is not a whole number of steps ahead. The state is that of the last accepted step then.
    fn integrate(
        &mut self,
        model: &Model,
        state: &mut State,
        to: f64,
        loading: &mut dyn Loading,
        on_step: OnStep<'_>,
    ) -> Result<(), SolveError>;

    /// Memory of a method with Newton's iteration beside the state, for a checkpoint; none of the others.
    fn memory(&self) -> Option<Memory> {
        None
    }

    /// Goes on with the memory of a method of the same model and options.
    ///
    /// # Errors
    /// A matrix cannot be factored.
    fn recall(&mut self, _model: &Model, _memory: &Memory) -> Result<(), SolveError> {
        Ok(())
    }

    /// Forces of the supports on the body [N] after the last accepted step, where the method keeps them; 0 at free dofs. Shape
    /// `[3 * nodes]`.
    fn reactions(&self) -> Option<&[f64]> {
        None
    }
}

/// Loads at both ends of a step and the displacements of the supports at its end; the memory serves all steps.
#[derive(Default)]
pub(crate) struct Conditions {
    /// Loads [N] at the start and the end. Shape `[3 * nodes]`.
    pub loads: [Vec<f64>; 2],
    prescribed: Vec<f64>,
    moved: bool,
}

impl Conditions {
    /// Evaluates a loading for the step of `state` that has these `ends` [s].
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

    /// The displacements [m] of the constrained dofs at the end; none where all stay where they are.
    pub fn prescribed(&self) -> Option<&[f64]> {
        self.moved.then_some(&self.prescribed)
    }
}

/// Both ends [s] of each step of length `dt` from `from` to `to`.
///
/// # Errors
/// The end is not a whole number of steps ahead.
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
