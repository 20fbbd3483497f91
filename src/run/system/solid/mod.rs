//! Solid-only system: elastic, plastic, or quasi-static.

mod loading;

use super::{Applied, SolidView, System, stored_at_rest};
use crate::checkpoint::{Body, Loaded};
use crate::checkpoint_store::Interrupt;
use crate::initial;
use loading::SolidLoading;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::io;
use trackbed_coupling::energy_balance::{StoredEnergy, WorkAndDissipation};
use trackbed_fem as fem;
use trackbed_fem::newmark::{self, NewmarkSolver};
use trackbed_fem::nonlinear::dynamics::{self, NonlinearNewmark};
use trackbed_fem::nonlinear::{QuasiStatic, SolverState, Statistics, StepControl, energy};
use trackbed_fem::{SolveError, State, TimeIntegrator};
use trackbed_input::model::solid::{Analysis, QuasiStaticPlan, SolidPart, TimeMethod};
use trackbed_io::failure::Failure;
use trackbed_track::TrackSystem;

const SMALLEST_PART: f64 = 1.0 / 256.0;

/// Stepping method.
#[derive(Clone, Copy)]
pub enum SolidKind {
    /// Elastic dynamics.
    Elastic(TimeMethod),
    /// Plastic dynamics, or with initial stress.
    Plastic(TimeMethod),
    /// Quasi-static.
    QuasiStatic(QuasiStaticPlan),
}

impl SolidKind {
    /// Returns the method; none without time steps.
    pub fn of(part: &SolidPart) -> Option<SolidKind> {
        match part.analysis {
            Analysis::Dynamic(method) if part.is_linear() => Some(SolidKind::Elastic(method)),
            Analysis::Dynamic(method) => Some(SolidKind::Plastic(method)),
            Analysis::QuasiStatic(plan) => Some(SolidKind::QuasiStatic(plan)),
            Analysis::Static | Analysis::StrengthReduction(_) => None,
        }
    }

    fn integrator(self, part: &SolidPart, step: f64) -> Result<Box<dyn TimeIntegrator>, SolveError> {
        let (model, newton) = (&part.model, part.newton);
        let min = step * SMALLEST_PART;
        let control = StepControl { initial: step, min, max: step, target_iterations: 40 };
        Ok(match self {
            SolidKind::Elastic(TimeMethod::Newmark(method)) => {
                Box::new(NewmarkSolver::conditionally_stable(model, method, step)?)
            }
            SolidKind::Elastic(TimeMethod::Hht(alpha)) => Box::new(NewmarkSolver::hht(model, alpha, step)?),
            SolidKind::Plastic(TimeMethod::Newmark(method)) => {
                Box::new(NonlinearNewmark::newmark(model, method, newton, control)?)
            }
            SolidKind::Plastic(TimeMethod::Hht(alpha)) => {
                Box::new(NonlinearNewmark::hht(model, alpha, newton, control)?)
            }
            SolidKind::QuasiStatic(plan) => Box::new(quasi_static(part, plan, [step; 2])?),
        })
    }
}

/// Solid-only system.
pub struct SolidSystem<'a> {
    part: &'a SolidPart,
    kind: SolidKind,
    loading: SolidLoading<'a>,
    /// Before an aborted step, for checkpoints.
    given_up: Option<SolverState>,
    state: State,
    before: State,
    integrator: Box<dyn TimeIntegrator>,
    step: f64,
    steps: u64,
    /// Reactions of a solid in equilibrium [N], else empty. Shape `[3·nodes]`.
    reactions: Vec<f64>,
    spent: WorkAndDissipation,
}

/// Checkpoint of the system. The load follows from the time.
#[derive(Serialize, Deserialize)]
struct Saved<'a> {
    /// Of an elastoplastic solver.
    memory: Option<SolverState>,
    state: Cow<'a, State>,
    carried: f64,
    steps: u64,
    reactions: Cow<'a, [f64]>,
    spent: WorkAndDissipation,
}

impl<'a> SolidSystem<'a> {
    /// Creates the solid at time 0, accelerated by its loads or in equilibrium; `step` [s].
    ///
    /// # Errors
    /// Insufficient constraints, equilibrium not converged, or failed factorization.
    pub fn new(
        part: &'a SolidPart,
        kind: SolidKind,
        step: f64,
        interrupt: &Interrupt,
    ) -> Result<Self, Failure> {
        let model = &part.model;
        let mut loading = SolidLoading::new(part, kind, interrupt);
        let (mut state, mut reactions) = (State::new(model), Vec::new());
        match kind {
            SolidKind::Elastic(_) => newmark::initial_acceleration(model, &mut state, &loading.at(0.0)),
            SolidKind::Plastic(_) => {
                (state, _) = initial::state(part, model, &loading.gravity)?;
                dynamics::initial_acceleration(model, &mut state, &loading.at(0.0))
            }
            SolidKind::QuasiStatic(plan) => {
                (state, loading.carried) = initial::state(part, model, &loading.gravity)?;
                reactions = bring_on_loads(part, plan, &mut state, &mut loading)?;
                Ok(())
            }
        }
        .map_err(|e| part.failure(&e))?;
        Ok(SolidSystem { reactions, ..SolidSystem::with(part, kind, step, loading, state)? })
    }

    /// Restores a checkpoint.
    ///
    /// # Errors
    /// As [`SolidSystem::new`]; unsuitable checkpoint.
    pub fn resume(
        part: &'a SolidPart,
        kind: SolidKind,
        step: f64,
        interrupt: &Interrupt,
        loaded: &mut Loaded,
    ) -> Result<Self, Failure> {
        let loading = SolidLoading::new(part, kind, interrupt);
        let mut system = SolidSystem::with(part, kind, step, loading, State::new(&part.model))?;
        let saved: Saved<'_> = loaded.take()?;
        if let Some(memory) = saved.memory {
            system.integrator.restore(&part.model, &memory).map_err(|e| part.failure(&e))?;
        }
        system.state = saved.state.into_owned();
        system.loading.carried = saved.carried;
        system.steps = saved.steps;
        system.reactions = saved.reactions.into_owned();
        system.spent = saved.spent;
        Ok(system)
    }

    fn with(
        part: &'a SolidPart,
        kind: SolidKind,
        step: f64,
        loading: SolidLoading<'a>,
        state: State,
    ) -> Result<Self, Failure> {
        Ok(SolidSystem {
            part,
            kind,
            loading,
            given_up: None,
            before: state.clone(),
            state,
            integrator: kind.integrator(part, step).map_err(|e| part.failure(&e))?,
            step,
            steps: 0,
            reactions: Vec::new(),
            spent: WorkAndDissipation::default(),
        })
    }

    /// Returns Newton statistics; none if elastic.
    pub fn statistics(&self) -> Option<Statistics> {
        self.integrator.solver_state().map(|memory| memory.statistics())
    }

    fn add_work_at_rest(&mut self) {
        if self.state.time <= self.before.time {
            return;
        }
        let [start, end] = [self.before.time, self.state.time].map(|time| self.loading.at(time));
        let reactions = self.integrator.reactions().expect("a solid in equilibrium keeps its reactions");
        // Mean end forces do the work of mean stresses (virtual work).
        let mut work = 0.0;
        for d in 0..start.len() {
            let loads = start[d] + end[d] - 2.0 * self.loading.gravity[d];
            let ends = loads + self.reactions[d] + reactions[d];
            work += 0.5 * ends * (self.state.u[d] - self.before.u[d]);
        }
        self.spent.solid_load_work += work;
        self.spent.plastic += energy::plastic_work(&self.part.model, &self.before.points, &self.state.points);
        self.reactions.copy_from_slice(reactions);
    }
}

fn quasi_static(
    part: &SolidPart,
    plan: QuasiStaticPlan,
    [initial, max]: [f64; 2],
) -> Result<QuasiStatic, SolveError> {
    let (min, target_iterations) = (initial * plan.smallest_step, plan.target_iterations);
    QuasiStatic::new(&part.model, part.newton, StepControl { initial, min, max, target_iterations })
}

/// Over one unit of time before time 0; returns reactions [N], shape `[3·nodes]`.
fn bring_on_loads(
    part: &SolidPart,
    plan: QuasiStaticPlan,
    state: &mut State,
    loading: &mut SolidLoading<'_>,
) -> Result<Vec<f64>, Failure> {
    let mut begin = quasi_static(part, plan, [0.25, 1.0]).map_err(|e| part.failure(&e))?;
    state.time = -1.0;
    begin
        .integrate(&part.model, state, 0.0, loading, &mut |_, _, _| {})
        .map_err(|e| part.failure(&e).in_stage("before time 0, during application of weight and loads"))?;
    state.time = 0.0;
    Ok(begin.reactions().to_vec())
}

impl TrackSystem for SolidSystem<'_> {
    fn window(&self) -> f64 {
        self.step
    }
}

impl System for SolidSystem<'_> {
    fn progress(&self) -> Option<String> {
        let Statistics { iterations, halvings, .. } = self.statistics()?;
        let repeated = if halvings == 0 { String::new() } else { format!(", {halvings} halved") };
        Some(format!("{iterations} iterations{repeated}"))
    }

    fn steps_done(&self, windows: u64) -> (u64, u64) {
        (0, windows)
    }

    fn advance(&mut self, _: Applied<'_>) -> Result<(), Failure> {
        let (part, elastic) = (self.part, matches!(self.kind, SolidKind::Elastic(_)));
        self.before.copy_from(&self.state);
        let (memory, spent_before) = (self.integrator.solver_state(), self.spent);
        // Elastic time is summed; other steps may be divided.
        let to = if elastic { self.state.time + self.step } else { (self.steps + 1) as f64 * self.step };
        let spent = &mut self.spent;
        let mut work = if elastic { 0.0 } else { spent.solid_load_work };
        let outcome = self.integrator.integrate(
            &part.model,
            &mut self.state,
            to,
            &mut self.loading,
            &mut |_, _, audit| {
                let Some(audit) = audit else { return };
                work += audit.external_work + audit.support_work;
                spent.rayleigh += audit.damping_dissipation;
                spent.absorbed += audit.boundary_dissipation;
                spent.plastic += audit.plastic_dissipation;
                spent.numerical += audit.numerical_dissipation;
            },
        );
        if outcome == Err(SolveError::Stopped) {
            // Continue from the previous step.
            std::mem::swap(&mut self.state, &mut self.before);
            (self.given_up, self.spent) = (memory, spent_before);
            return Err(part.failure(&SolveError::Stopped));
        }
        self.steps += u64::from(outcome.is_ok());
        // The balance must match the kept state.
        let moved = self.state.u.iter().zip(&self.before.u).map(|(u, before)| u - before);
        let weight = self.loading.gravity.iter().zip(moved).map(|(f, du)| f * du).sum::<f64>();
        match self.kind {
            SolidKind::Elastic(_) => self.spent.solid_load_work += work - weight,
            SolidKind::Plastic(_) => self.spent.solid_load_work = work - weight,
            SolidKind::QuasiStatic(_) => self.add_work_at_rest(),
        }
        outcome.map_err(|e| match self.kind {
            SolidKind::Elastic(_) => {
                Failure::Numerical(format!("at t = {:.6e} s: solid: {e}", self.before.time))
            }
            SolidKind::Plastic(_) | SolidKind::QuasiStatic(_) => part.failure(&e),
        })
    }

    fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        body.put(&Saved {
            memory: self.given_up.or_else(|| self.integrator.solver_state()),
            state: Cow::Borrowed(&self.state),
            carried: self.loading.carried,
            steps: self.steps,
            reactions: Cow::Borrowed(&self.reactions),
            spent: self.spent,
        })
    }

    fn stored(&self) -> StoredEnergy {
        let model = &self.part.model;
        let at_rest = stored_at_rest(model, &self.state, &self.loading.gravity);
        match self.kind {
            SolidKind::QuasiStatic(_) => at_rest,
            _ => StoredEnergy { solid_kinetic: fem::energy::kinetic(model, &self.state), ..at_rest },
        }
    }

    fn spent(&self) -> WorkAndDissipation {
        self.spent
    }

    fn solid(&self) -> Option<SolidView<'_>> {
        Some(SolidView { model: &self.part.model, state: &self.state })
    }

    fn reactions(&self) -> Option<Vec<f64>> {
        Some(match self.kind {
            SolidKind::QuasiStatic(_) => self.reactions.clone(),
            _ => {
                let load = self.loading.at(self.state.time);
                fem::energy::reactions(&self.part.model, &self.state, &load)
            }
        })
    }

    fn keeps_its_state(&self) -> bool {
        !matches!(self.kind, SolidKind::Elastic(_))
    }
}
