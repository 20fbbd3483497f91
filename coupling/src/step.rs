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

/// The two models and how they are joined.
pub struct Model {
    /// The solid.
    pub solid: fem::Model,
    /// The grains.
    pub grains: dem::Model,
    /// Steps of the grains per window.
    pub substeps: u32,
    /// Implicitness of the solid's step, ½–1.
    pub theta: f64,
    /// Constant load on the solid (gravity) [N]. Shape `[3·nodes]`.
    pub dead_load: Vec<f64>,
    /// Displacement of the solid in the shape that the mesh file describes [m]. Shape `[3·nodes]`.
    pub reference: Vec<f64>,
}

impl Model {
    /// Length of a window [s].
    pub fn window(&self) -> f64 {
        self.grains.dt() * f64::from(self.substeps)
    }
}

/// All that a continuation of the run needs.
#[derive(Clone, Serialize, Deserialize)]
pub struct State {
    /// Displacement, velocity of the solid.
    pub solid: fem::State,
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
    solver: fem::window::WindowSolver,
    load: Vec<f64>,
    contact_load: Vec<f64>,
    other_load: Vec<f64>,
    before: Vec<f64>,
    applied: Vec<dem::AppliedForce>,
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
        source: fem::SolveError,
    },
}

impl State {
    /// The start of a run: solid and grains as given.
    pub fn new(solid: fem::State, grains: dem::State) -> State {
        State { solid, grains, audit: TransferAudit::default(), spent: Spent::default() }
    }
}

impl Work {
    /// Scratch memory and the factor of the solid's window matrix.
    ///
    /// # Errors
    /// The matrix cannot be factored.
    pub fn new(model: &Model, state: &State, surface: SolidSurface) -> Result<Work, fem::SolveError> {
        let n = 3 * model.solid.mesh().node_count();
        Ok(Work {
            grains: dem::Work::new(&model.grains, &state.grains),
            transfer: Transfer::new(&surface),
            surface,
            solver: fem::window::WindowSolver::new(&model.solid, model.theta, model.window())?,
            load: vec![0.0; n],
            contact_load: vec![0.0; n],
            other_load: vec![0.0; n],
            before: vec![0.0; n],
            applied: Vec::new(),
        })
    }

    /// Largest pressure on one face in the last window: normal force over area, mean over the window [Pa].
    pub fn peak_face_pressure(&self, window: f64) -> f64 {
        self.transfer.peak_face_pressure(&self.surface, window)
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
    model: &Model,
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
        .step(&model.solid, solid, &work.load)
        .map_err(|source| StepError::Solid { time, source })?;
    for i in 0..other.len() {
        let du = solid.u[i] - work.before[i];
        state.spent.contacts_on_solid += work.contact_load[i] * du;
        state.spent.solid_load_work += other[i] * du;
    }
    state.spent.rayleigh += step.damping_dissipation;
    state.spent.numerical += step.numerical_dissipation;
    Ok(())
}

/// Energy stored in the system now.
pub fn stored(model: &Model, state: &State, work: &Work) -> Stored {
    let grains = dem::measure::energies(&model.grains, &state.grains, &work.grains);
    Stored {
        grains_kinetic: grains.kinetic_translation + grains.kinetic_rotation,
        contact_springs: grains.elastic_normal + grains.elastic_tangential,
        grains_gravity: grains.gravity,
        solid_kinetic: fem::energy::kinetic(&model.solid, &state.solid),
        solid_strain: fem::energy::strain(&model.solid, &state.solid),
        solid_gravity: -model.dead_load.iter().zip(&state.solid.u).map(|(f, u)| f * u).sum::<f64>(),
    }
}

/// Work and dissipation of both sides since the start.
pub fn spent(state: &State) -> Spent {
    let grains = &state.grains.ledger;
    Spent {
        applied_work: grains.work_applied,
        wall_work: grains.work_walls,
        dashpot: grains.dissipated_dashpot,
        friction: grains.dissipated_friction,
        local_damping: grains.dissipated_local_damping,
        surface_on_grains: grains.work_surface,
        ..state.spent
    }
}

/// Stability number W = Δt √(Kₙ/m) of the exchange: window, stiffest contact of a grain with the surface [N/m], and
/// the lightest surface point, a corner node's share 0.018 of the lightest touched element's mass (consistent mass;
/// two-mass study). Damped contacts need W below about 1.
pub fn stability_number(model: &Model, surface: &SolidSurface, stiffness: f64) -> f64 {
    const CORNER_SHARE: f64 = 0.018;
    let lightest = surface
        .faces()
        .iter()
        .map(|f| model.solid.element_mass(f.element as usize))
        .fold(f64::INFINITY, f64::min);
    model.window() * (stiffness / (CORNER_SHARE * lightest)).sqrt()
}
