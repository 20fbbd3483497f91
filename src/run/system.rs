//! What the main loop needs of a model, whatever it consists of: solid, grains, or both.

use super::checkpoint::{Body, Loaded};
use crate::failure::Failure;
use crate::model::solid::{SleeperBodies, SolidPart, TimeMethod};
use std::io;
use trackbed_coupling as coupling;
use trackbed_coupling::ledger::{Spent, Stored};
pub use trackbed_coupling::track::GrainsView;
use trackbed_coupling::track::{CyclicLoad, MeshedSleeper, TrackSystem};
use trackbed_dem as dem;
use trackbed_fem as fem;

/// Forces on bodies at a time.
pub type Applied<'a> = &'a mut dyn FnMut(f64, &dem::Model, &dem::State, &mut Vec<dem::AppliedForce>);

/// The solid of a running system.
#[derive(Clone, Copy)]
pub struct SolidView<'a> {
    /// Model.
    pub model: &'a fem::model::Model,
    /// Its state.
    pub state: &'a fem::state::State,
}

/// A model that can be advanced window by window.
pub trait System: TrackSystem {
    /// Steps of grains and solid in a window.
    fn steps_per_window(&self) -> (u64, u64);
    /// Advances by one window.
    fn advance(&mut self, applied: Applied<'_>) -> Result<(), Failure>;
    /// Puts into a checkpoint what `resume` of the system goes on from.
    fn save(&self, body: &mut Body<'_>) -> io::Result<()>;
    /// Takes grains out and puts grains in.
    ///
    /// # Errors
    /// A grain that cannot leave or come.
    fn exchange(&mut self, _leave: &[usize], _arrive: &[dem::flow::Arrival]) -> Result<(), Failure> {
        Ok(())
    }
    /// The surface of the solid that grains may touch.
    fn surface(&self) -> &dyn dem::surface::Surface {
        &dem::surface::NoSurface
    }
    /// Energy stored now [J].
    fn stored(&self) -> Stored;
    /// Work and dissipation so far [J].
    fn spent(&self) -> Spent;
    /// The solid, if there is one.
    fn solid(&self) -> Option<SolidView<'_>> {
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
    /// Force of the grains on the ground, mean over the last window [N].
    fn contact_force(&self) -> [f64; 3] {
        [0.0; 3]
    }
    /// Largest mean pressure on a face of the ground in the last window [Pa].
    fn peak_pressure(&self) -> f64 {
        0.0
    }
    /// Work of the loads on the sleepers' seats so far [J].
    fn seat_work(&self) -> f64 {
        self.grains().map_or(0.0, |g| g.state.ledger.work_applied)
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
    fn steps_per_window(&self) -> (u64, u64) {
        (0, 1)
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

impl TrackSystem for GrainsSystem {
    fn window(&self) -> f64 {
        self.model.dt()
    }

    fn grains(&self) -> Option<GrainsView<'_>> {
        Some(GrainsView { model: &self.model, state: &self.state })
    }

    fn relocate(&mut self, moves: &[(usize, dem::Vec3, nalgebra::UnitQuaternion<f64>)]) {
        moves.iter().for_each(|(body, shift, turn)| self.state.shift(&self.model, *body, shift, turn));
        self.state.forget_neighbours();
    }
}

impl System for GrainsSystem {
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

    fn exchange(&mut self, leave: &[usize], arrive: &[dem::flow::Arrival]) -> Result<(), Failure> {
        dem::flow::exchange(&self.model, &mut self.state, &mut self.work, leave, arrive)
            .map_err(|e| Failure::Numerical(format!("grains: {e}")))
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
}

/// Meshed sleepers of a running system.
pub struct Meshed<'a> {
    /// Their nodes.
    pub bodies: &'a SleeperBodies,
    /// Heights of their bases when they were set down [m].
    pub bases: Vec<f64>,
    /// The load on their seats.
    pub load: Option<&'a CyclicLoad>,
    /// Their first face in the surface.
    pub first_face: usize,
    /// Work of that load so far [J].
    pub work: f64,
}

impl Meshed<'_> {
    /// Adds the forces on the seats at time `t` [s] to nodal loads, shape `[3·nodes]`.
    fn add_load(&self, t: f64, load: &mut [f64]) {
        let Some(cycles) = self.load else { return };
        (0..self.bodies.count()).for_each(|k| self.bodies.add_load(k, cycles.on(k, t), load));
    }

    /// Work of the forces at time `t` [s] on displacements that are added to `u`, less that on `u` itself [J].
    fn work_at(&self, t: f64, u: &[f64]) -> f64 {
        let on = |k: usize| self.load.map_or(0.0, |l| l.on(k, t));
        (0..self.bodies.count()).map(|k| -on(k) * self.bodies.rise_of_seats(k, u)).sum()
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
    /// Faces of the surface that are the ground's.
    pub ground_faces: usize,
    /// Meshed sleepers.
    pub seats: Option<Meshed<'a>>,
}

impl TrackSystem for CoupledSystem<'_> {
    fn window(&self) -> f64 {
        self.model.window()
    }

    fn grains(&self) -> Option<GrainsView<'_>> {
        Some(GrainsView { model: &self.model.grains, state: &self.state.grains })
    }

    fn meshed_sleeper(&self, k: usize) -> Option<MeshedSleeper> {
        let s = self.seats.as_ref()?;
        let (moved, [x, y, z]) = (s.bodies.moved(k, &self.state.solid.u), s.bodies.centre(k, s.bases[k]));
        let faces = s.bodies.face_count();
        let first = s.first_face + k * faces;
        Some(MeshedSleeper {
            place: [x + moved.way[0], y + moved.way[1], z + moved.way[2]],
            height: z + moved.seats,
            moved,
            contact: self.work.contact_force_on(first..first + faces, self.model.window()),
        })
    }

    fn relocate(&mut self, moves: &[(usize, dem::Vec3, nalgebra::UnitQuaternion<f64>)]) {
        let grains = &mut self.state.grains;
        moves.iter().for_each(|(body, shift, turn)| grains.shift(&self.model.grains, *body, shift, turn));
        grains.forget_neighbours();
    }
}

impl System for CoupledSystem<'_> {
    fn steps_per_window(&self) -> (u64, u64) {
        (u64::from(self.model.substeps), 1)
    }

    fn advance(&mut self, applied: Applied<'_>) -> Result<(), Failure> {
        let (loads, seats) = (self.loads, self.seats.as_ref());
        let solid_load = |t: f64, load: &mut [f64]| {
            loads.iter().for_each(|l| l.add(t, load));
            seats.iter().for_each(|s| s.add_load(t, load));
        };
        // The middle of the window, at which the step takes its loads.
        let middle = self.state.solid.time + 0.5 * self.model.window();
        let before = seats.map_or(0.0, |s| s.work_at(middle, &self.state.solid.u));
        let model = &self.model;
        let apply = |t: f64, s: &dem::State, out: &mut Vec<dem::AppliedForce>| {
            applied(t, &model.grains, s, out);
        };
        coupling::step::step(model, &mut self.state, &mut self.work, apply, solid_load)
            .map_err(|e| Failure::Numerical(e.to_string()))?;
        if let Some(seats) = &mut self.seats {
            seats.work += seats.work_at(middle, &self.state.solid.u) - before;
        }
        Ok(())
    }

    fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        let seat_work = self.seats.as_ref().map_or(0.0, |s| s.work);
        body.put(&(&self.model.reference, self.work.memory(), &self.state, seat_work))
    }

    fn exchange(&mut self, leave: &[usize], arrive: &[dem::flow::Arrival]) -> Result<(), Failure> {
        coupling::step::exchange(&self.model, &mut self.state, &mut self.work, leave, arrive)
            .map_err(|e| Failure::Numerical(format!("grains: {e}")))
    }

    fn surface(&self) -> &dyn dem::surface::Surface {
        &self.work.surface
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

    fn contact_force(&self) -> [f64; 3] {
        self.work.contact_force_on(0..self.ground_faces, self.model.window())
    }

    fn peak_pressure(&self) -> f64 {
        self.work.peak_pressure_on(0..self.ground_faces, self.model.window())
    }

    fn seat_work(&self) -> f64 {
        match &self.seats {
            Some(seats) => seats.work,
            None => self.state.grains.ledger.work_applied,
        }
    }
}
