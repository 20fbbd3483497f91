//! A solid at every step in equilibrium.

use super::Course;
use crate::failure::Failure;
use crate::model::solid::{QuasiStaticPlan, SolidPart};
use crate::run::checkpoint::{Body, Loaded};
use crate::run::checkpoint_store::Interrupt;
use crate::run::initial;
use crate::run::system::{Applied, SolidView, System, stored_at_rest};
use std::io;
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_coupling::track::TrackSystem;
use trackbed_fem::nonlinear::{Loading, Memory, QuasiStatic, Statistics, StepControl, energy};
use trackbed_fem::{SolveError, State};

/// A solid at every step in equilibrium.
pub struct QuasiStaticSystem<'a> {
    part: &'a SolidPart,
    interrupt: Interrupt,
    /// What the solver remembered before a step that was given up, which the checkpoint holds then.
    given_up: Option<Memory>,
    state: State,
    solver: QuasiStatic,
    gravity: Vec<f64>,
    carried: f64,
    step: f64,
    steps: u64,
    load: Vec<f64>,
    reactions: Vec<f64>,
    spent: Spent,
}

/// What a checkpoint holds beside the memory of the solver: state, share of the weight that acts from the start, steps done,
/// load, reactions, what was spent.
type Held = (State, f64, u64, Vec<f64>, Vec<f64>, Spent);

impl<'a> QuasiStaticSystem<'a> {
    /// The solid with its initial stress, in equilibrium with its weight and the loads and supports at time 0.
    ///
    /// # Errors
    /// The body is not held, or finds no equilibrium at time 0.
    pub fn new(
        part: &'a SolidPart,
        plan: &QuasiStaticPlan,
        step: f64,
        interrupt: &Interrupt,
    ) -> Result<Self, Failure> {
        let model = &part.model;
        let gravity = model.gravity_load();
        let (mut state, carried) = initial::state(part, &part.model, &gravity)?;
        // What acts at time 0 is brought on over one unit of time before it.
        let control = StepControl {
            initial: 0.25,
            min: 0.25 * plan.smallest_step,
            max: 1.0,
            target_iterations: plan.target_iterations,
        };
        let mut begin = QuasiStatic::new(model, part.newton, control).map_err(|e| part.failure(&e))?;
        state.time = -1.0;
        let mut course = Course { part, gravity: &gravity, carried, interrupt };
        begin.advance(model, &mut state, 0.0, &mut course, |_, _| {}).map_err(|e| {
            part.failure(&e).in_stage("before time 0, during application of weight and loads")
        })?;
        state.time = 0.0;
        let solver = quasi_static(part, plan, step)?;
        let reactions = begin.reactions().to_vec();
        let mut load = vec![0.0; model.dof_count()];
        course.load(0.0, &mut load);
        let held = (state, carried, 0, load, reactions, Spent::default());
        Ok(QuasiStaticSystem::with(part, step, interrupt, solver, held))
    }

    /// The solid as a checkpoint has it.
    ///
    /// # Errors
    /// The body is not held; a checkpoint of something else.
    pub fn resume(
        part: &'a SolidPart,
        plan: &QuasiStaticPlan,
        step: f64,
        interrupt: &Interrupt,
        loaded: &mut Loaded,
    ) -> Result<Self, Failure> {
        let mut solver = quasi_static(part, plan, step)?;
        let memory = loaded.take()?;
        solver.recall(&part.model, &memory).map_err(|e| part.failure(&e))?;
        Ok(QuasiStaticSystem::with(part, step, interrupt, solver, loaded.take()?))
    }

    fn with(
        part: &'a SolidPart,
        step: f64,
        interrupt: &Interrupt,
        solver: QuasiStatic,
        (state, carried, steps, load, reactions, spent): Held,
    ) -> Self {
        QuasiStaticSystem {
            part,
            interrupt: interrupt.clone(),
            given_up: None,
            state,
            solver,
            gravity: part.model.gravity_load(),
            carried,
            step,
            steps,
            load,
            reactions,
            spent,
        }
    }

    /// Counts of the iteration.
    pub fn statistics(&self) -> Statistics {
        self.solver.statistics()
    }
}

/// The solver of the run proper.
fn quasi_static(part: &SolidPart, plan: &QuasiStaticPlan, step: f64) -> Result<QuasiStatic, Failure> {
    let control = StepControl {
        initial: step,
        min: step * plan.smallest_step,
        max: step,
        target_iterations: plan.target_iterations,
    };
    QuasiStatic::new(&part.model, part.newton, control).map_err(|e| part.failure(&e))
}

impl TrackSystem for QuasiStaticSystem<'_> {
    fn window(&self) -> f64 {
        self.step
    }
}

impl System for QuasiStaticSystem<'_> {
    fn progress(&self) -> Option<String> {
        Some(super::iterations(&self.statistics()))
    }

    fn steps_done(&self, windows: u64) -> (u64, u64) {
        (0, windows)
    }

    fn advance(&mut self, _: Applied<'_>) -> Result<(), Failure> {
        let (part, model) = (self.part, &self.part.model);
        let (before, memory) = (self.state.clone(), self.solver.memory());
        let to = (self.steps + 1) as f64 * self.step;
        let mut course =
            Course { part, gravity: &self.gravity, carried: self.carried, interrupt: &self.interrupt };
        let outcome = self.solver.advance(model, &mut self.state, to, &mut course, |_, _| {});
        if outcome == Err(SolveError::Stopped) {
            // The run goes on from the step before, whatever shorter steps this one has come to.
            (self.state, self.given_up) = (before, Some(memory));
            return Err(part.failure(&SolveError::Stopped));
        }
        let outcome = outcome.map_err(|e| part.failure(&e));
        // A step given up half-way counts as far as it came, so that the accounts belong to the state that is kept.
        let reached = if outcome.is_ok() { to } else { self.state.time };
        self.steps += u64::from(outcome.is_ok());
        let mut load = vec![0.0; self.load.len()];
        course.load(reached, &mut load);
        let reactions = self.solver.reactions().to_vec();
        if reached > before.time {
            // The mean of the forces at both ends does exactly the work of the mean stresses (virtual work).
            let mut work = 0.0;
            for d in 0..load.len() {
                let ends = self.load[d] + load[d] - 2.0 * self.gravity[d] + self.reactions[d] + reactions[d];
                work += 0.5 * ends * (self.state.u[d] - before.u[d]);
            }
            self.spent.solid_load_work += work;
            self.spent.plastic += energy::plastic_work(model, &before.points, &self.state.points);
            (self.load, self.reactions) = (load, reactions);
        }
        outcome
    }

    fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        body.put(&self.given_up.unwrap_or_else(|| self.solver.memory()))?;
        body.put(&(&self.state, self.carried, self.steps, &self.load, &self.reactions, &self.spent))
    }

    fn stored(&self) -> Stored {
        stored_at_rest(&self.part.model, &self.state, &self.gravity)
    }

    fn spent(&self) -> Spent {
        self.spent
    }

    fn solid(&self) -> Option<SolidView<'_>> {
        Some(SolidView { model: &self.part.model, state: &self.state })
    }

    fn reactions(&self) -> Option<Vec<f64>> {
        Some(self.reactions.clone())
    }

    fn keeps_its_state(&self) -> bool {
        true
    }
}
