//! Quasi-static loading with automatic step lengths.
//!
//! Limits: no path following beyond a limit load.

use super::conditions::{prescribe, subtract_springs};
use super::newton::{Failure, Newton, Problem};
use super::options::NewtonOptions;
use super::step_halving::StepHalving;
use crate::assembly::Combination;
use crate::error::SolveError;
use crate::integrator::{Loading, Statistics, StepControl, StepLength};
use crate::model::Model;
use crate::state::{State, StepAudit};
use crate::statics::{check_load, check_rigid_body_motion};

/// Quasi-static solver.
pub struct QuasiStatic {
    newton: Newton,
    length: StepLength,
    load: Vec<f64>,
    fixed: Vec<f64>,
    reactions: Vec<f64>,
}

impl QuasiStatic {
    /// Checks against rigid-body motion and allocates buffers.
    ///
    /// # Errors
    /// Insufficient constraints; options out of range.
    pub fn new(
        model: &Model,
        options: NewtonOptions,
        control: StepControl,
    ) -> Result<QuasiStatic, SolveError> {
        control.check()?;
        check_rigid_body_motion(model)?;
        Ok(QuasiStatic {
            newton: Newton::new(model, options)?,
            length: StepLength::new(control),
            load: vec![0.0; model.dof_count()],
            fixed: vec![0.0; model.supports().fixed().len()],
            reactions: vec![0.0; model.dof_count()],
        })
    }

    /// Counts and times.
    pub fn statistics(&self) -> Statistics {
        self.newton.statistics
    }

    /// Support reactions [N] after the last accepted step; 0 at free dofs. Shape `[3 * nodes]`.
    pub fn reactions(&self) -> &[f64] {
        &self.reactions
    }

    /// Forces [N] of stresses and boundary springs. Shape `[3 * nodes]`.
    pub(super) fn internal_force(&mut self, model: &Model, state: &State) -> Vec<f64> {
        self.newton.force.of_states(model, &state.points);
        let mut carried = self.newton.force.force.clone();
        model.boundary_spring_times(&state.u, &mut carried);
        carried
    }

    fn conditions(
        &mut self,
        model: &Model,
        state: &State,
        time: f64,
        loading: &mut dyn Loading,
    ) -> Result<(), SolveError> {
        self.load.fill(0.0);
        loading.load(time, &mut self.load);
        check_load(model, &self.load, time)?;
        subtract_springs(model, &state.u, &mut self.load);
        prescribe(model, state, time, loading, &mut self.fixed)
    }
}

impl StepHalving for QuasiStatic {
    fn parts(&self) -> (&Newton, &StepLength) {
        (&self.newton, &self.length)
    }

    fn parts_mut(&mut self) -> (&mut Newton, &mut StepLength) {
        (&mut self.newton, &mut self.length)
    }

    fn step(
        &mut self,
        model: &Model,
        state: &mut State,
        time: f64,
        dt: f64,
        loading: &mut dyn Loading,
    ) -> Result<Option<StepAudit>, Failure> {
        self.conditions(model, state, time, loading).map_err(Failure::Fatal)?;
        let stop = || loading.stopped();
        let problem = Problem {
            old: &state.points,
            rhs: &self.load,
            fixed: &self.fixed,
            linear: Combination::default(),
            step: [state.time, dt],
            forces: None,
            stop: &stop,
        };
        self.newton.solve(model, &problem)?;
        for &(dof, _) in model.supports().fixed() {
            self.reactions[dof as usize] = -self.newton.residual[dof as usize];
        }
        self.newton.commit(state, time, dt);
        Ok(None)
    }

    fn reactions(&self) -> Option<&[f64]> {
        Some(&self.reactions)
    }
}
