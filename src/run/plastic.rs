//! A plastic solid that runs alone: in quasi-static steps, or through time.

use super::checkpoint::{Body, Loaded};
use super::checkpoint_store::Interrupt;
use super::system::{Applied, SolidView, System};
use crate::failure::Failure;
use crate::model::solid::{QuasiStaticPlan, SolidPart, TimeMethod};
use std::io;
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_coupling::track::TrackSystem;
use trackbed_fem as fem;
use trackbed_fem::nonlinear::dynamics::{self, Dynamics};
use trackbed_fem::nonlinear::{Loading, Memory, QuasiStatic, Statistics, StepControl, energy};
use trackbed_fem::{SolveError, State};

/// Loads and supports of a solid in time; before time 0 they are brought on from nothing.
pub struct Course<'a> {
    /// The solid.
    pub part: &'a SolidPart,
    /// Weight [N]. Shape `[3·nodes]`.
    pub gravity: &'a [f64],
    /// Share of the weight that acts at the beginning of the time before 0: 1 where the initial stress carries it.
    pub carried: f64,
    /// Request to give a step up.
    pub interrupt: &'a Interrupt,
}

impl Course<'_> {
    /// The time at which loads and supports are taken, their share, and that of the weight.
    fn shares(&self, time: f64) -> (f64, f64, f64) {
        let share = (1.0 + time).clamp(0.0, 1.0);
        (time.max(0.0), share, self.carried + (1.0 - self.carried) * share)
    }
}

impl Loading for Course<'_> {
    fn load(&mut self, time: f64, load: &mut [f64]) {
        let (time, share, weight) = self.shares(time);
        self.part.add_loads(time, load);
        let carried = self.part.initial_stress.as_ref().is_some_and(|i| i.loads);
        let share = if carried { 1.0 } else { share };
        for (l, g) in load.iter_mut().zip(self.gravity) {
            *l = share * *l + weight * g;
        }
    }

    fn prescribed(&mut self, time: f64, values: &mut [f64]) {
        let (time, share, _) = self.shares(time);
        self.part.prescribe(time, values);
        values.iter_mut().for_each(|v| *v *= share);
    }

    fn stopped(&self) -> bool {
        self.interrupt.stopped()
    }
}

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
        let (mut state, carried) = super::initial::state(part, &part.model, &gravity)?;
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
        begin
            .advance(model, &mut state, 0.0, &mut course, |_, _| {})
            .map_err(|e| part.failure(&e).in_stage("before time 0, while weight and loads are brought on"))?;
        state.time = 0.0;
        let solver = quasi_static(part, plan, step)?;
        let reactions = begin.reactions().to_vec();
        let mut load = vec![0.0; model.dof_count()];
        course.load(0.0, &mut load);
        Ok(QuasiStaticSystem {
            part,
            interrupt: interrupt.clone(),
            given_up: None,
            state,
            solver,
            carried,
            step,
            steps: 0,
            load,
            reactions,
            spent: Spent::default(),
            gravity,
        })
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
        let (state, carried, steps, load, reactions, spent) = loaded.take()?;
        let gravity = part.model.gravity_load();
        Ok(QuasiStaticSystem {
            part,
            interrupt: interrupt.clone(),
            given_up: None,
            state,
            solver,
            carried,
            step,
            steps,
            load,
            reactions,
            spent,
            gravity,
        })
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
        Stored {
            solid_strain: fem::energy::strain(&self.part.model, &self.state),
            solid_gravity: -self.gravity.iter().zip(&self.state.u).map(|(f, u)| f * u).sum::<f64>(),
            ..Stored::default()
        }
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

/// Parts of a time step that are tried before a dynamic run gives up.
const SMALLEST_PART: f64 = 1.0 / 256.0;

/// A plastic solid through time.
pub struct PlasticDynamics<'a> {
    part: &'a SolidPart,
    interrupt: Interrupt,
    /// As of [`QuasiStaticSystem`].
    given_up: Option<Memory>,
    state: State,
    solver: Dynamics,
    gravity: Vec<f64>,
    load: Vec<f64>,
    step: f64,
    steps: u64,
    spent: Spent,
}

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
        let (mut state, _) = super::initial::state(part, &part.model, &gravity)?;
        let solver = dynamics_solver(part, method, step)?;
        let mut load = vec![0.0; model.dof_count()];
        let mut course = Course { part, gravity: &gravity, carried: 1.0, interrupt };
        course.load(0.0, &mut load);
        dynamics::initial_acceleration(model, &mut state, &load).map_err(|e| part.failure(&e))?;
        let (interrupt, spent) = (interrupt.clone(), Spent::default());
        Ok(PlasticDynamics {
            part,
            interrupt,
            given_up: None,
            state,
            solver,
            load,
            step,
            steps: 0,
            spent,
            gravity,
        })
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
        let (state, steps, load, spent) = loaded.take()?;
        let gravity = part.model.gravity_load();
        let interrupt = interrupt.clone();
        Ok(PlasticDynamics {
            part,
            interrupt,
            given_up: None,
            state,
            solver,
            load,
            step,
            steps,
            spent,
            gravity,
        })
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
        Stored {
            solid_kinetic: fem::energy::kinetic(&self.part.model, &self.state),
            solid_strain: fem::energy::strain(&self.part.model, &self.state),
            solid_gravity: -self.gravity.iter().zip(&self.state.u).map(|(f, u)| f * u).sum::<f64>(),
            ..Stored::default()
        }
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
