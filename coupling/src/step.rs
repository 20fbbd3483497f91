//! The coupled step, scheme B: grains first on the predicted motion of the surface, then the solid under the
//! impulse that it received.
//!
//! One window of length Δt = m·dt:
//!
//! 1. the surface nodes take position and velocity of the solid at the start of the window and go on with that
//!    velocity;
//! 2. m steps of the grains, each with contact on the curved faces where they are at that instant; each contact
//!    force becomes nodal forces at its mapped point, and their sums are audited;
//! 3. the nodal impulses, divided by Δt, load the solid for one implicit step with the window's mean force (see
//!    [`trackbed_fem::window`]), so that the momentum given by the grains is the momentum received by the solid.
//!
//! The two-mass study behind the choice (guide, "order of the exchange") finds this order stable up to
//! W = Δt √(Kₙ/m) of about 1 with damping and nearly neutral without, where the reverse order (solid first, with
//! the last window's force) gains energy at every step size.

use crate::ledger::{Spent, Stored};
use crate::surface::SolidSurface;
use crate::transfer::{Transfer, TransferAudit};
use serde::{Deserialize, Serialize};
use trackbed_dem as dem;
use trackbed_fem as fem;
use trackbed_fem::nonlinear::{Memory, NewtonOptions, PlasticWindowSolver, Statistics};
use trackbed_fem::solver::SolveError;
use trackbed_fem::state::StepAudit;
use trackbed_fem::window::WindowSolver;

/// The two models and how they are joined.
pub struct Model<'a> {
    /// The solid.
    pub solid: &'a fem::model::Model,
    /// The grains.
    pub grains: dem::Model,
    /// Steps of the grains per window.
    pub substeps: u32,
    /// Implicitness of the solid's step, ½–1.
    pub theta: f64,
    /// How a plastic solid finds the end of its step; not used for an elastic one.
    pub newton: NewtonOptions,
    /// Constant load on the solid (gravity) [N]. Shape `[3·nodes]`.
    pub dead_load: Vec<f64>,
    /// Displacement of the solid in the shape that the mesh file describes [m]. Shape `[3·nodes]`.
    pub reference: Vec<f64>,
}

impl Model<'_> {
    /// Length of a window [s].
    pub fn window(&self) -> f64 {
        self.grains.dt() * f64::from(self.substeps)
    }
}

/// All that a continuation of the run needs.
#[derive(Clone, Serialize, Deserialize)]
pub struct State {
    /// Displacement, velocity of the solid.
    pub solid: fem::state::State,
    /// Grains and their contact memory.
    pub grains: dem::State,
    /// Largest errors of force and moment across the interface so far.
    pub audit: TransferAudit,
    /// Work and dissipation on the solid's side; the grains keep their own account.
    spent: Spent,
}

/// Scratch memory and factors.
pub struct Work {
    /// Scratch of the grains.
    pub grains: dem::Work,
    /// The surface that grains touch.
    pub surface: SolidSurface,
    transfer: Transfer,
    solver: SolidSolver,
    load: Vec<f64>,
    contact_load: Vec<f64>,
    other_load: Vec<f64>,
    before: Vec<f64>,
    applied: Vec<dem::AppliedForce>,
}

/// The solid's step over a window.
enum SolidSolver {
    /// One solve with a factor that is kept.
    Elastic(Box<WindowSolver>),
    /// Newton's iteration on the stresses of the Gauss points.
    Plastic(Box<PlasticWindowSolver>),
}

impl SolidSolver {
    fn new(model: &Model<'_>, without_stresses: bool) -> Result<SolidSolver, SolveError> {
        let (solid, theta, window) = (model.solid, model.theta, model.window());
        if solid.is_linear() && without_stresses {
            return Ok(SolidSolver::Elastic(Box::new(WindowSolver::new(solid, theta, window)?)));
        }
        Ok(SolidSolver::Plastic(Box::new(PlasticWindowSolver::new(solid, theta, window, model.newton)?)))
    }

    fn step(
        &mut self,
        solid: &fem::model::Model,
        state: &mut fem::state::State,
        mean_load: &[f64],
    ) -> Result<StepAudit, SolveError> {
        match self {
            SolidSolver::Elastic(solver) => solver.step(solid, state, mean_load),
            SolidSolver::Plastic(solver) => solver.step(solid, state, mean_load),
        }
    }
}

/// Why a coupled step failed.
#[derive(Debug, thiserror::Error)]
pub enum StepError {
    /// The grains failed.
    #[error("grains: {0}")]
    Grains(#[from] dem::StepError),
    /// The solid failed.
    #[error("solid at t = {time:.6e} s: {source}")]
    Solid {
        /// Time of the failure [s].
        time: f64,
        /// What failed.
        source: SolveError,
    },
}

impl State {
    /// The start of a run: solid and grains as given.
    pub fn new(solid: fem::state::State, grains: dem::State) -> State {
        State { solid, grains, audit: TransferAudit::default(), spent: Spent::default() }
    }
}

impl Work {
    /// Scratch memory and the factor of the solid's window matrix.
    ///
    /// # Errors
    /// The matrix cannot be factored.
    pub fn new(model: &Model<'_>, state: &State, surface: SolidSurface) -> Result<Work, SolveError> {
        let n = 3 * model.solid.mesh().node_count();
        Ok(Work {
            grains: dem::Work::new(&model.grains, &state.grains),
            transfer: Transfer::new(&surface),
            surface,
            solver: SolidSolver::new(model, state.solid.points.is_empty())?,
            load: vec![0.0; n],
            contact_load: vec![0.0; n],
            other_load: vec![0.0; n],
            before: vec![0.0; n],
            applied: Vec::new(),
        })
    }

    /// Counts of the iteration of a plastic solid.
    pub fn newton(&self) -> Option<Statistics> {
        match &self.solver {
            SolidSolver::Elastic(_) => None,
            SolidSolver::Plastic(solver) => Some(solver.statistics()),
        }
    }

    /// What the solver of a plastic solid remembers beside the state, for a checkpoint.
    pub fn memory(&self) -> Option<Memory> {
        match &self.solver {
            SolidSolver::Elastic(_) => None,
            SolidSolver::Plastic(solver) => Some(solver.memory()),
        }
    }

    /// Goes on with the memory of scratch that was made for the same model.
    ///
    /// # Errors
    /// A matrix cannot be factored.
    pub fn recall(&mut self, model: &Model<'_>, memory: Option<&Memory>) -> Result<(), SolveError> {
        match (&mut self.solver, memory) {
            (SolidSolver::Plastic(solver), Some(memory)) => solver.recall(model.solid, memory),
            _ => Ok(()),
        }
    }

    /// Largest pressure on one face in the last window: normal force over area, mean over the window [Pa].
    pub fn peak_face_pressure(&self, window: f64) -> f64 {
        self.transfer.peak_face_pressure(&self.surface, window)
    }

    /// Load on the solid in the last window, weight and contacts included [N]. Shape `[3·nodes]`.
    pub fn load(&self) -> &[f64] {
        &self.load
    }

    /// Force of the grains on the solid, mean over the last window [N].
    pub fn mean_contact_force(&self, window: f64) -> [f64; 3] {
        self.transfer.total_impulse().map(|i| i / window)
    }
}

/// Advances the system by one window. `applied` fills in the forces on bodies at a given time; `solid_load` adds
/// loads on the solid other than gravity and contact at a given time, which are taken at the middle of the window.
///
/// # Errors
/// The grains or the solid cannot make the step; `state` is then not fit to go on from.
pub fn step(
    model: &Model<'_>,
    state: &mut State,
    work: &mut Work,
    mut applied: impl FnMut(f64, &dem::State, &mut Vec<dem::AppliedForce>),
    solid_load: impl Fn(f64, &mut [f64]),
) -> Result<(), StepError> {
    let window = model.window();
    let dt = model.grains.dt();
    let solid = &mut state.solid;

    work.surface.begin_window(model.solid.mesh(), &solid.u, &model.reference, &solid.v, window);
    work.transfer.begin_window();
    for k in 0..model.substeps {
        work.surface.advance(f64::from(k) * dt);
        work.applied.clear();
        applied(state.grains.time, &state.grains, &mut work.applied);
        dem::step(&model.grains, &mut state.grains, &mut work.grains, &work.surface, &work.applied)?;
        work.transfer.add(&work.surface, work.grains.surface_contacts(), dt, &mut state.audit);
    }

    work.contact_load.fill(0.0);
    work.transfer.add_mean_load(&work.surface, window, &mut work.contact_load);
    work.load.fill(0.0);
    solid_load(solid.time + 0.5 * window, &mut work.load);
    // Work of each kind of load on this window's displacement, which the solver does not split.
    work.before.copy_from_slice(&solid.u);
    let other = work.other_load.as_mut_slice();
    other.copy_from_slice(&work.load);
    for ((load, contact), dead) in work.load.iter_mut().zip(&work.contact_load).zip(&model.dead_load) {
        *load += contact + dead;
    }
    let time = solid.time;
    let step = work
        .solver
        .step(model.solid, solid, &work.load)
        .map_err(|source| StepError::Solid { time, source })?;
    for i in 0..other.len() {
        let du = solid.u[i] - work.before[i];
        state.spent.contacts_on_solid += work.contact_load[i] * du;
        state.spent.solid_load_work += other[i] * du;
    }
    state.spent.rayleigh += step.damping_dissipation;
    state.spent.absorbed += step.boundary_dissipation;
    state.spent.plastic += step.plastic_dissipation;
    state.spent.numerical += step.numerical_dissipation;
    Ok(())
}

/// Energy stored in the system now.
pub fn stored(model: &Model<'_>, state: &State) -> Stored {
    let grains = dem::measure::energies(&model.grains, &state.grains);
    Stored {
        grains_kinetic: grains.kinetic_translation + grains.kinetic_rotation,
        contact_springs: grains.elastic_normal + grains.elastic_tangential,
        bonds: grains.elastic_bonds,
        grains_gravity: grains.gravity,
        solid_kinetic: fem::energy::kinetic(model.solid, &state.solid),
        solid_strain: fem::energy::strain(model.solid, &state.solid),
        solid_gravity: -model.dead_load.iter().zip(&state.solid.u).map(|(f, u)| f * u).sum::<f64>(),
        ..Stored::default()
    }
}

/// Work and dissipation of both sides since the start.
pub fn spent(state: &State) -> Spent {
    let solid = &state.spent;
    Spent {
        solid_load_work: solid.solid_load_work,
        rayleigh: solid.rayleigh,
        absorbed: solid.absorbed,
        plastic: solid.plastic,
        numerical: solid.numerical,
        contacts_on_solid: solid.contacts_on_solid,
        ..spent_by_grains(&state.grains)
    }
}

/// The grains' share of [`spent`].
pub fn spent_by_grains(grains: &dem::State) -> Spent {
    let ledger = &grains.ledger;
    Spent {
        applied_work: ledger.work_applied,
        wall_work: ledger.work_walls + ledger.work_servo + ledger.work_constraints,
        dashpot: ledger.dissipated_dashpot,
        friction: ledger.dissipated_friction,
        bonds: ledger.dissipated_bonds,
        breaks: ledger.released_by_breaks,
        local_damping: ledger.dissipated_local_damping,
        surface_on_grains: ledger.work_surface,
        ..Spent::default()
    }
}

/// What the solid carries when a run begins: the nodal load of grains that lie on its undeformed surface [N], shape
/// `[3·nodes]`, and the grains' state with its contacts found.
///
/// # Errors
/// The grains cannot make a step.
pub fn resting_load(
    grains: &dem::Model,
    surface: &mut SolidSurface,
    mesh: &fem::mesh::Mesh,
) -> Result<(Vec<f64>, dem::State), dem::StepError> {
    let mut state = dem::State::new(grains);
    let mut work = dem::Work::new(grains, &state);
    let zero = vec![0.0; 3 * mesh.node_count()];
    surface.begin_window(mesh, &zero, &zero, &zero, grains.dt());
    dem::find_contacts(grains, &mut state, &mut work, &*surface)?;
    let mut transfer = Transfer::new(surface);
    transfer.add(surface, work.surface_contacts(), grains.dt(), &mut TransferAudit::default());
    let mut load = zero;
    transfer.add_mean_load(surface, grains.dt(), &mut load);
    Ok((load, state))
}

/// Masses of the elements that `faces` belong to [kg].
pub fn face_masses(solid: &fem::model::Model, faces: &[fem::mesh::Face]) -> impl Iterator<Item = f64> {
    faces.iter().map(|f| {
        let element = f.element as usize;
        solid.elastic(element).density * solid.mesh().element_volume(element)
    })
}

/// The two numbers that decide whether an exchange is stable; both should stay below about 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// W = Δt √(Kₙ/m): window Δt, stiffest contact Kₙ of a grain with the surface, mass m of the lightest surface
    /// node.
    pub stiffness: f64,
    /// D = C Δt/m: the dashpot C of that contact on the same node.
    pub damping: f64,
}

/// Stability of an exchange with windows of `window` [s] and contacts of `stiffness` [N/m] and dashpot `damping`
/// [N s/m]. The lightest surface node is a corner with the share 0.018 of the lightest of the touched elements'
/// `masses` [kg] (consistent mass; two-mass study).
pub fn stability(window: f64, stiffness: f64, damping: f64, masses: impl Iterator<Item = f64>) -> Stability {
    const CORNER_SHARE: f64 = 0.018;
    let lightest = CORNER_SHARE * masses.fold(f64::INFINITY, f64::min);
    Stability { stiffness: window * (stiffness / lightest).sqrt(), damping: damping * window / lightest }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// W = Δt √(K/m) and D = C Δt/m on the corner node, 0.018 of the lighter element: m = 2 kg here.
    #[test]
    fn stability_takes_the_corner_of_the_lightest_element() {
        let s = stability(1e-3, 1e6, 100.0, [500.0, 2.0 / 0.018].into_iter());
        assert!((s.stiffness - 0.5_f64.sqrt()).abs() < 1e-12, "{s:?}");
        assert!((s.damping - 0.05).abs() < 1e-12, "{s:?}");
    }
}
