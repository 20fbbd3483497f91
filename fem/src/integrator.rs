//! Methods that carry a body through time, behind one trait: linear and elastoplastic, dynamic and quasi-static.
//!
//! [`NewmarkSolver`](crate::newmark::NewmarkSolver) (Newmark and HHT-α with one factor), [`WindowSolver`](crate::window::WindowSolver)
//! (mid-point form), and the elastoplastic [`Dynamics`](crate::nonlinear::Dynamics), [`QuasiStatic`](crate::nonlinear::QuasiStatic)
//! and [`PlasticWindowSolver`](crate::nonlinear::PlasticWindowSolver). A new method is one that implements
//! [`TimeIntegrator`].

use crate::error::SolveError;
use crate::model::Model;
use crate::state::{State, StepAudit};
use serde::{Deserialize, Serialize};

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

/// A method of time integration.
pub trait TimeIntegrator {
    /// Carries `state` to the time `to`, which it reaches exactly. After every accepted step `on_step` is given the state,
    /// how the step converged, and its energies where the method keeps a ledger.
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
        on_step: &mut dyn FnMut(&State, &StepReport, Option<&StepAudit>),
    ) -> Result<(), SolveError>;
}

/// A step of a method with one length of step.
pub(crate) struct Step<'m> {
    model: &'m Model,
    /// Times at both ends [s].
    pub ends: [f64; 2],
}

impl Step<'_> {
    /// Loads at both ends, shape `[3 * nodes]`, and the displacements of the constrained dofs at the end.
    pub fn loads(&self, loading: &mut dyn Loading) -> ([Vec<f64>; 2], Vec<f64>) {
        let loads = self.ends.map(|time| {
            let mut load = vec![0.0; self.model.dof_count()];
            loading.load(time, &mut load);
            load
        });
        let mut prescribed: Vec<f64> =
            self.model.supports().fixed().iter().map(|(_, value)| *value).collect();
        loading.prescribed(self.ends[1], &mut prescribed);
        (loads, prescribed)
    }

    /// The mean of the loads at both ends, and the displacements of the constrained dofs at the end.
    pub fn mean(&self, loading: &mut dyn Loading) -> (Vec<f64>, Vec<f64>) {
        let ([mut mean, end], prescribed) = self.loads(loading);
        mean.iter_mut().zip(&end).for_each(|(m, e)| *m = 0.5 * (*m + e));
        (mean, prescribed)
    }
}

/// The steps of length `dt` from `from` to `to`.
///
/// # Errors
/// The end is not a whole number of steps ahead.
pub(crate) fn steps_of(
    model: &Model,
    from: f64,
    to: f64,
    dt: f64,
) -> Result<impl Iterator<Item = Step<'_>>, SolveError> {
    let count = ((to - from) / dt).round();
    let whole = (from + count * dt - to).abs() <= 1e-9 * dt.max(to.abs());
    if !(whole && count >= 0.0) {
        let expected = "a whole number of steps ahead of the state";
        return Err(SolveError::Option { what: "the end time", value: to, expected });
    }
    Ok((0..count as u64).map(move |i| {
        let at = |i: u64| if i as f64 == count { to } else { from + i as f64 * dt };
        Step { model, ends: [at(i), at(i + 1)] }
    }))
}
