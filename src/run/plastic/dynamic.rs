//! A plastic solid through time.

use super::Course;
use crate::failure::Failure;
use crate::model::solid::{SolidPart, TimeMethod};
use crate::run::checkpoint::{Body, Loaded};
use crate::run::checkpoint_store::Interrupt;
use crate::run::initial;
use crate::run::system::{Applied, SolidView, System, stored_at_rest};
use std::io;
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_coupling::track::TrackSystem;
use trackbed_fem as fem;
use trackbed_fem::nonlinear::dynamics::{self, Dynamics};
use trackbed_fem::nonlinear::{Loading, Memory, Statistics, StepControl};
use trackbed_fem::{SolveError, State};

/// Parts of a time step that are tried before a dynamic run gives up.
const SMALLEST_PART: f64 = 1.0 / 256.0;

/// A plastic solid through time.
pub struct PlasticDynamics<'a> {
    part: &'a SolidPart,
    interrupt: Interrupt,
    /// What the solver remembered before a step that was given up, which the checkpoint holds then.
    given_up: Option<Memory>,
    state: State,
    solver: Dynamics,
    gravity: Vec<f64>,
    load: Vec<f64>,
    step: f64,
    steps: u64,
    spent: Spent,
}

/// What a checkpoint holds beside the memory of the solver: state, steps done, load, what was spent.
type Held = (State, u64, Vec<f64>, Spent);

impl<'a> PlasticDynamics<'a> {
    /// The solid at rest with its initial stress at time 0, and the acceleration that its loads give it.
    ///
    /// # Errors
    /// The initial stress finds no equilibrium, or a matrix cannot be factored.
    pub fn new(
        part: &'a SolidPart,
        method: TimeMethod,
        step: f64,
        interrupt: &Interrupt,
    ) -> Result<Self, Failure> {
        let model = &part.model;
        let gravity = model.gravity_load();
        let (mut state, _) = initial::state(part, &part.model, &gravity)?;
        let solver = dynamics_solver(part, method, step)?;
        let mut load = vec![0.0; model.dof_count()];
        let mut course = Course { part, gravity: &gravity, carried: 1.0, interrupt };
        course.load(0.0, &mut load);
        dynamics::initial_acceleration(model, &mut state, &load).map_err(|e| part.failure(&e))?;
        Ok(PlasticDynamics::with(part, step, interrupt, solver, (state, 0, load, Spent::default())))
    }

    /// The solid as a checkpoint has it.
    ///
    /// # Errors
    /// A matrix cannot be factored; a checkpoint of something else.
    pub fn resume(
        part: &'a SolidPart,
        method: TimeMethod,
        step: f64,
        interrupt: &Interrupt,
        loaded: &mut Loaded,
    ) -> Result<Self, Failure> {
        let mut solver = dynamics_solver(part, method, step)?;
        let memory = loaded.take()?;
        solver.recall(&part.model, &memory).map_err(|e| part.failure(&e))?;
        Ok(PlasticDynamics::with(part, step, interrupt, solver, loaded.take()?))
    }

    fn with(
        part: &'a SolidPart,
        step: f64,
        interrupt: &Interrupt,
        solver: Dynamics,
        (state, steps, load, spent): Held,
    ) -> Self {
        PlasticDynamics {
            part,
            interrupt: interrupt.clone(),
            given_up: None,
            state,
            solver,
            gravity: part.model.gravity_load(),
            load,
            step,
            steps,
            spent,
        }
    }

    /// Counts of the iteration.
    pub fn statistics(&self) -> Statistics {
        self.solver.statistics()
    }
}

/// The solver of a plastic solid in motion.
fn dynamics_solver(part: &SolidPart, method: TimeMethod, step: f64) -> Result<Dynamics, Failure> {
    let control = StepControl { initial: step, min: step * SMALLEST_PART, max: step, target_iterations: 40 };
    match method {
        TimeMethod::Newmark(m) => Dynamics::newmark(&part.model, m, part.newton, control),
        TimeMethod::Hht(alpha) => Dynamics::hht(&part.model, alpha, part.newton, control),
    }
    .map_err(|e| part.failure(&e))
}

impl TrackSystem for PlasticDynamics<'_> {
    fn window(&self) -> f64 {
        self.step
    }
}

impl System for PlasticDynamics<'_> {
    fn progress(&self) -> Option<String> {
        Some(super::iterations(&self.statistics()))
    }

    fn steps_done(&self, windows: u64) -> (u64, u64) {
        (0, windows)
    }

    fn advance(&mut self, _: Applied<'_>) -> Result<(), Failure> {
        let (part, before) = (self.part, self.state.clone());
        let (memory, spent_before) = (self.solver.memory(), self.spent);
        let to = (self.steps + 1) as f64 * self.step;
        let mut course = Course { part, gravity: &self.gravity, carried: 1.0, interrupt: &self.interrupt };
        let spent = &mut self.spent;
        let outcome = self.solver.advance(&part.model, &mut self.state, to, &mut course, |_, _, audit| {
            spent.solid_load_work += audit.external_work + audit.support_work;
            spent.rayleigh += audit.damping_dissipation;
            spent.absorbed += audit.boundary_dissipation;
            spent.plastic += audit.plastic_dissipation;
            spent.numerical += audit.numerical_dissipation;
        });
        if outcome == Err(SolveError::Stopped) {
            (self.state, self.given_up, self.spent) = (before, Some(memory), spent_before);
            return Err(part.failure(&SolveError::Stopped));
        }
        let outcome = outcome.map_err(|e| part.failure(&e));
        // A step given up half-way counts as far as it came, so that the accounts belong to the state that is kept.
        let reached = if outcome.is_ok() { to } else { self.state.time };
        self.steps += u64::from(outcome.is_ok());
        let moved = self.state.u.iter().zip(&before.u).map(|(u, b)| u - b);
        self.spent.solid_load_work -= self.gravity.iter().zip(moved).map(|(f, du)| f * du).sum::<f64>();
        self.load.fill(0.0);
        course.load(reached, &mut self.load);
        outcome
    }

    fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        body.put(&self.given_up.unwrap_or_else(|| self.solver.memory()))?;
        body.put(&(&self.state, self.steps, &self.load, &self.spent))
    }

    fn stored(&self) -> Stored {
        let kinetic = fem::energy::kinetic(&self.part.model, &self.state);
        Stored { solid_kinetic: kinetic, ..stored_at_rest(&self.part.model, &self.state, &self.gravity) }
    }

    fn spent(&self) -> Spent {
        self.spent
    }

    fn solid(&self) -> Option<SolidView<'_>> {
        Some(SolidView { model: &self.part.model, state: &self.state })
    }

    fn reactions(&self) -> Option<Vec<f64>> {
        Some(fem::energy::reactions(&self.part.model, &self.state, &self.load))
    }

    fn keeps_its_state(&self) -> bool {
        true
    }
}
