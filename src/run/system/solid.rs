//! An elastic solid alone.

use super::{Applied, SolidView, System, stored_at_rest};
use crate::failure::Failure;
use crate::model::solid::{SolidPart, TimeMethod};
use crate::run::checkpoint::{Body, Loaded};
use std::io;
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_coupling::track::TrackSystem;
use trackbed_fem as fem;

/// An elastic solid alone, through time.
pub struct SolidSystem<'a> {
    part: &'a SolidPart,
    /// Displacement, velocity, acceleration.
    pub state: fem::state::State,
    solver: fem::newmark::NewmarkSolver,
    gravity: Vec<f64>,
    load: Vec<f64>,
    next_load: Vec<f64>,
    spent: Spent,
}

impl<'a> SolidSystem<'a> {
    /// The solid at rest at time 0, with the acceleration that its loads give it.
    ///
    /// # Errors
    /// A matrix cannot be factored.
    pub fn new(part: &'a SolidPart, method: TimeMethod, dt: f64) -> Result<Self, fem::SolveError> {
        let model = &part.model;
        let solver = match method {
            TimeMethod::Newmark(m) => fem::newmark::NewmarkSolver::conditionally_stable(model, m, dt)?,
            TimeMethod::Hht(alpha) => fem::newmark::NewmarkSolver::hht(model, alpha, dt)?,
        };
        let mut state = fem::state::State::new(model);
        let gravity = model.gravity_load();
        let mut load = gravity.clone();
        part.add_loads(0.0, &mut load);
        fem::newmark::initial_acceleration(model, &mut state, &load)?;
        let next_load = vec![0.0; load.len()];
        Ok(SolidSystem { part, state, solver, gravity, load, next_load, spent: Spent::default() })
    }

    /// The same, going on from a checkpoint.
    ///
    /// # Errors
    /// As [`SolidSystem::new`]; a checkpoint of something else.
    pub fn resume(
        part: &'a SolidPart,
        method: TimeMethod,
        dt: f64,
        loaded: &mut Loaded,
    ) -> Result<Self, Failure> {
        let system = SolidSystem::new(part, method, dt).map_err(|e| part.failure(&e))?;
        let (state, load, spent) = loaded.take()?;
        Ok(SolidSystem { state, load, spent, ..system })
    }
}

impl TrackSystem for SolidSystem<'_> {
    fn window(&self) -> f64 {
        self.solver.dt()
    }
}

impl System for SolidSystem<'_> {
    fn steps_done(&self, windows: u64) -> (u64, u64) {
        (0, windows)
    }

    fn advance(&mut self, _: Applied<'_>) -> Result<(), Failure> {
        let (part, time) = (self.part, self.state.time);
        let end = time + self.solver.dt();
        self.next_load.copy_from_slice(&self.gravity);
        part.add_loads(end, &mut self.next_load);
        let before = self.state.u.clone();
        let prescribed = (!part.supports.moving.is_empty()).then(|| {
            let fixed = part.model.supports().fixed();
            let mut values: Vec<f64> = fixed.iter().map(|(_, value)| *value).collect();
            part.prescribe(end, &mut values);
            values
        });
        let drive = fem::newmark::Drive {
            load_start: Some(&self.load),
            load_end: &self.next_load,
            prescribed: prescribed.as_deref(),
        };
        let audit = self
            .solver
            .advance(&part.model, &mut self.state, drive)
            .map_err(|e| Failure::Numerical(format!("at t = {time:.6e} s: solid: {e}")))?;
        std::mem::swap(&mut self.load, &mut self.next_load);
        let gravity_work: f64 =
            self.gravity.iter().zip(self.state.u.iter().zip(&before)).map(|(f, (u, b))| f * (u - b)).sum();
        self.spent.solid_load_work += audit.external_work + audit.support_work - gravity_work;
        self.spent.rayleigh += audit.damping_dissipation;
        self.spent.absorbed += audit.boundary_dissipation;
        self.spent.numerical += audit.numerical_dissipation;
        Ok(())
    }

    fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        body.put(&(&self.state, &self.load, &self.spent))
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
}
