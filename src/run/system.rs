//! What the main loop needs of a model, whatever it consists of: solid, grains, or both.

use super::checkpoint::{Body, Loaded};
use crate::failure::Failure;
use crate::model::solid::{SolidPart, TimeMethod};
use std::io;
use trackbed_coupling as coupling;
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_dem as dem;
use trackbed_fem as fem;

/// Forces on bodies at a time.
pub type Applied<'a> = &'a dyn Fn(f64, &dem::Model, &dem::State, &mut Vec<dem::AppliedForce>);

/// The solid of a running system.
#[derive(Clone, Copy)]
pub struct SolidView<'a> {
    /// Model.
    pub model: &'a fem::model::Model,
    /// Its state.
    pub state: &'a fem::state::State,
}

/// The grains of a running system.
#[derive(Clone, Copy)]
pub struct GrainsView<'a> {
    /// Model.
    pub model: &'a dem::Model,
    /// Its state.
    pub state: &'a dem::State,
}

/// A model that can be advanced window by window.
pub trait System {
    /// Length of a window [s].
    fn window(&self) -> f64;
    /// Steps of grains and solid in a window.
    fn steps_per_window(&self) -> (u64, u64);
    /// Advances by one window.
    fn advance(&mut self, applied: Applied<'_>) -> Result<(), Failure>;
    /// Puts into a checkpoint what `resume` of the system goes on from.
    fn save(&self, body: &mut Body<'_>) -> io::Result<()>;
    /// Sets grains elsewhere: body, shift [m], rotation in world axes.
    fn relocate(&mut self, _moves: &[(usize, dem::Vec3, nalgebra::UnitQuaternion<f64>)]) {}
    /// Energy stored now [J].
    fn stored(&self) -> Stored;
    /// Work and dissipation so far [J].
    fn spent(&self) -> Spent;
    /// The solid, if there is one.
    fn solid(&self) -> Option<SolidView<'_>> {
        None
    }
    /// The grains, if there are any.
    fn grains(&self) -> Option<GrainsView<'_>> {
        None
    }
    /// Whether a window that fails leaves the state of the last good step behind.
    fn keeps_its_state(&self) -> bool {
        false
    }
    /// Forces of the supports on the solid [N], shape `[3·nodes]`, where they are known.
    fn reactions(&self) -> Option<Vec<f64>> {
        None
    }
    /// Force of the grains on the solid, mean over the last window [N].
    fn contact_force(&self) -> [f64; 3] {
        [0.0; 3]
    }
    /// Largest mean pressure on a face of the solid in the last window [Pa].
    fn peak_pressure(&self) -> f64 {
        0.0
    }
}

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
    pub fn new(part: &'a SolidPart, method: TimeMethod, dt: f64) -> Result<Self, fem::solver::SolveError> {
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

impl System for SolidSystem<'_> {
    fn window(&self) -> f64 {
        self.solver.dt()
    }

    fn steps_per_window(&self) -> (u64, u64) {
        (0, 1)
    }

    fn advance(&mut self, _: Applied<'_>) -> Result<(), Failure> {
        let (part, time) = (self.part, self.state.time);
        let end = time + self.solver.dt();
        self.next_load.copy_from_slice(&self.gravity);
        part.add_loads(end, &mut self.next_load);
        let before = self.state.u.clone();
        let prescribed = (!part.moving.is_empty()).then(|| {
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
            .map_err(|e| Failure::Numerical(format!("solid at t = {time:.6e} s: {e}")))?;
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
}

/// Grains alone.
pub struct GrainsSystem {
    /// Model.
    pub model: dem::Model,
    /// State.
    pub state: dem::State,
    /// Scratch.
    pub work: dem::Work,
    applied: Vec<dem::AppliedForce>,
}

impl GrainsSystem {
    /// The grains at the start of their model.
    ///
    /// # Errors
    /// They overlap so much that no step can be made.
    pub fn new(model: dem::Model) -> Result<GrainsSystem, Failure> {
        let mut state = dem::State::new(&model);
        let mut work = dem::Work::new(&model, &state);
        dem::find_contacts(&model, &mut state, &mut work, &dem::surface::NoSurface)
            .map_err(|e| Failure::Numerical(format!("grains: {e}")))?;
        Ok(GrainsSystem { model, state, work, applied: Vec::new() })
    }

    /// The grains as a checkpoint has them.
    ///
    /// # Errors
    /// A checkpoint of something else.
    pub fn resume(model: dem::Model, loaded: &mut Loaded) -> Result<GrainsSystem, Failure> {
        let state = loaded.take()?;
        let work = dem::Work::new(&model, &state);
        Ok(GrainsSystem { model, state, work, applied: Vec::new() })
    }
}

impl System for GrainsSystem {
    fn window(&self) -> f64 {
        self.model.dt()
    }

    fn steps_per_window(&self) -> (u64, u64) {
        (1, 0)
    }

    fn advance(&mut self, applied: Applied<'_>) -> Result<(), Failure> {
        self.applied.clear();
        applied(self.state.time, &self.model, &self.state, &mut self.applied);
        dem::step(&self.model, &mut self.state, &mut self.work, &dem::surface::NoSurface, &self.applied)
            .map_err(|e| Failure::Numerical(format!("grains: {e}")))
    }

    fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        body.put(&self.state)
    }

    fn relocate(&mut self, moves: &[(usize, dem::Vec3, nalgebra::UnitQuaternion<f64>)]) {
        moves.iter().for_each(|(body, shift, turn)| self.state.shift(&self.model, *body, shift, turn));
        self.state.forget_neighbours();
    }

    fn stored(&self) -> Stored {
        let e = dem::measure::energies(&self.model, &self.state);
        Stored {
            grains_kinetic: e.kinetic_translation + e.kinetic_rotation,
            contact_springs: e.elastic_normal + e.elastic_tangential,
            bonds: e.elastic_bonds,
            grains_gravity: e.gravity,
            ..Stored::default()
        }
    }

    fn spent(&self) -> Spent {
        coupling::step::spent_by_grains(&self.state)
    }

    fn grains(&self) -> Option<GrainsView<'_>> {
        Some(GrainsView { model: &self.model, state: &self.state })
    }
}

/// Grains on a solid.
pub struct CoupledSystem<'a> {
    /// Both models and how they are joined.
    pub model: coupling::step::Model<'a>,
    /// Both states.
    pub state: coupling::step::State,
    /// Scratch and factors.
    pub work: coupling::step::Work,
    /// Loads on the solid.
    pub loads: &'a [crate::model::solid::NodalLoad],
}

impl System for CoupledSystem<'_> {
    fn window(&self) -> f64 {
        self.model.window()
    }

    fn steps_per_window(&self) -> (u64, u64) {
        (u64::from(self.model.substeps), 1)
    }

    fn advance(&mut self, applied: Applied<'_>) -> Result<(), Failure> {
        let loads = self.loads;
        let solid_load = |t: f64, load: &mut [f64]| loads.iter().for_each(|l| l.add(t, load));
        let model = &self.model;
        let apply =
            |t: f64, s: &dem::State, out: &mut Vec<dem::AppliedForce>| applied(t, &model.grains, s, out);
        coupling::step::step(model, &mut self.state, &mut self.work, apply, solid_load)
            .map_err(|e| Failure::Numerical(e.to_string()))
    }

    fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        body.put(&(&self.model.reference, self.work.memory(), &self.state))
    }

    fn relocate(&mut self, moves: &[(usize, dem::Vec3, nalgebra::UnitQuaternion<f64>)]) {
        let grains = &mut self.state.grains;
        moves.iter().for_each(|(body, shift, turn)| grains.shift(&self.model.grains, *body, shift, turn));
        grains.forget_neighbours();
    }

    fn stored(&self) -> Stored {
        coupling::step::stored(&self.model, &self.state)
    }

    fn spent(&self) -> Spent {
        coupling::step::spent(&self.state)
    }

    fn solid(&self) -> Option<SolidView<'_>> {
        Some(SolidView { model: self.model.solid, state: &self.state.solid })
    }

    fn grains(&self) -> Option<GrainsView<'_>> {
        Some(GrainsView { model: &self.model.grains, state: &self.state.grains })
    }

    fn contact_force(&self) -> [f64; 3] {
        self.work.mean_contact_force(self.model.window())
    }

    fn peak_pressure(&self) -> f64 {
        self.work.peak_face_pressure(self.model.window())
    }
}
