//! The coupled step: one window of the grains' steps and one step of the solid, in the order that a
//! [scheme](crate::scheme) tells.
//!
//! One window of length Δt = m·dt, as scheme B has it:
//!
//! 1. the surface nodes take position and velocity of the solid at the start of the window and go on with that
//!    velocity;
//! 2. m steps of the grains, each with contact on the curved faces where they are in the middle of the step; each contact
//!    force becomes nodal forces at its mapped point, and their sums are audited;
//! 3. the nodal impulses, divided by Δt, load the solid for one implicit step with the window's mean force (see
//!    [`trackbed_fem::window`]), so that the momentum given by the grains is the momentum received by the solid.
//!
//! Why the middle: the leapfrog's velocities are those of half a step before its places, and the window begins where they are. A
//! surface taken at the start of each grain step would answer half a step late, and gain ½ dt ∫ K v² dt at a contact K.
//!
//! The two-mass study behind the choice (guide, "order of the exchange") finds this order stable up to
//! W = Δt √(Kₙ/m) of about 1 with damping and nearly neutral without (0.02 W⁴ per window), where the reverse order (solid first, with
//! the last window's force) gains energy at every step size.

use crate::accelerate::Accelerator;
use crate::ledger::{Spent, Stored};
use crate::scheme::{Passes, Scheme};
use crate::stiffened::{Held, Stiffened};
use crate::surface::{Motion, SolidSurface};
use crate::transfer::{Transfer, TransferAudit};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::sync::Arc;
use trackbed_dem as dem;
use trackbed_fem as fem;
use trackbed_fem::SolveError;
use trackbed_fem::nonlinear::{Memory, NewtonOptions, PlasticWindowSolver, Statistics};
use trackbed_fem::reduction::{Estimate, Reduced, ReducedWindowSolver};
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
    /// Order of the exchange.
    pub scheme: Scheme,
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
    /// Velocity that the surface went on with in the last window [m/s], shape `[3·nodes]`; empty before the first.
    rate: Vec<f64>,
    /// Repeated windows.
    pub passes: Passes,
    /// Mean contact load of the last window and of the one before [N], shape `[3·nodes]`; empty but for the lagged scheme.
    lagged: [Vec<f64>; 2],
    /// Contacts of the last grain step, for the stiffened scheme.
    held: Vec<Held>,
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
    before: fem::state::State,
    rate: Vec<f64>,
    applied: Vec<dem::AppliedForce>,
    accelerator: Accelerator,
    stiffened: Stiffened,
}

/// The solid's step over a window.
enum SolidSolver {
    /// One solve with a factor that is kept.
    Elastic(Box<WindowSolver>),
    /// Newton's iteration on the stresses of the Gauss points.
    Plastic(Box<PlasticWindowSolver>),
    /// The equations of a few shapes.
    Reduced(Box<ReducedWindowSolver>),
}

impl SolidSolver {
    fn new(model: &Model<'_>, without_stresses: bool) -> Result<SolidSolver, SolveError> {
        let (solid, theta, window) = (model.solid, model.theta, model.window());
        if solid.is_linear() && without_stresses {
            return Ok(SolidSolver::Elastic(Box::new(WindowSolver::new(solid, theta, window)?)));
        }
        if model.scheme == Scheme::Stiffened {
            return Err(not_constant(model));
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
            SolidSolver::Reduced(solver) => solver.step(solid, state, mean_load),
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
    /// The surface turned over.
    #[error(
        "the surface of the solid has folded at element {element} at t = {time:.6e} s: a face there has turned over or \
         collapsed; the load is beyond what a solid of small strains can bear, or the exchange is unstable"
    )]
    Folded {
        /// Number of the element in the mesh's file.
        element: u32,
        /// Time [s].
        time: f64,
    },
}

impl State {
    /// The start of a run: solid and grains as given.
    pub fn new(solid: fem::state::State, grains: dem::State) -> State {
        State {
            solid,
            grains,
            audit: TransferAudit::default(),
            spent: Spent::default(),
            rate: Vec::new(),
            passes: Passes::default(),
            lagged: Default::default(),
            held: Vec::new(),
        }
    }

    /// The same with a contact load [N], shape `[3·nodes]`, that the solid carries from the start: the lagged scheme begins
    /// with it.
    pub fn carrying(self, load: Vec<f64>) -> State {
        State { lagged: [load.clone(), load], ..self }
    }
}

impl Work {
    /// Scratch memory and the factor of the solid's window matrix.
    ///
    /// # Errors
    /// The matrix cannot be factored, or the solid is plastic and the scheme needs a constant matrix.
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
            before: fem::state::State { points: Default::default(), ..state.solid.clone() },
            rate: vec![0.0; n],
            applied: Vec::new(),
            accelerator: Accelerator::default(),
            stiffened: Stiffened::default(),
        })
    }

    /// Takes the steps of the solid in the span of a reduction from now on.
    ///
    /// # Errors
    /// A solid with plasticity or stresses at its Gauss points, or another one than was reduced.
    pub fn reduce(&mut self, model: &Model<'_>, reduced: Arc<Reduced>) -> Result<(), SolveError> {
        let solver = ReducedWindowSolver::new(model.solid, reduced, model.theta, model.window())?;
        self.solver = SolidSolver::Reduced(Box::new(solver));
        Ok(())
    }

    /// What the reduction of the solid costs in accuracy; none without one.
    pub fn reduction(&self) -> Option<Estimate> {
        match &self.solver {
            SolidSolver::Reduced(solver) => Some(*solver.reduced().estimate()),
            SolidSolver::Elastic(_) | SolidSolver::Plastic(_) => None,
        }
    }

    /// Counts of the iteration of a plastic solid.
    pub fn newton(&self) -> Option<Statistics> {
        match &self.solver {
            SolidSolver::Elastic(_) | SolidSolver::Reduced(_) => None,
            SolidSolver::Plastic(solver) => Some(solver.statistics()),
        }
    }

    /// What the solver of a plastic solid remembers beside the state, for a checkpoint.
    pub fn memory(&self) -> Option<Memory> {
        match &self.solver {
            SolidSolver::Elastic(_) | SolidSolver::Reduced(_) => None,
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

    /// The same on some faces of the surface [N].
    pub fn contact_force_on(&self, faces: Range<usize>, window: f64) -> [f64; 3] {
        self.transfer.impulse_on(faces).map(|i| i / window)
    }

    /// Largest pressure on one of some faces in the last window, as [`Work::peak_face_pressure`] [Pa].
    pub fn peak_pressure_on(&self, faces: Range<usize>, window: f64) -> f64 {
        self.transfer.peak_pressure_on(faces, &self.surface, window)
    }
}

/// Speed below which changes of the surface's motion are rounding [m/s].
const STILL: f64 = 1e-12;

/// Advances the system by one window. `applied` fills in the forces on bodies at a given time; `solid_load` adds
/// loads on the solid other than gravity and contact at a given time, which are taken at the middle of the window.
/// Both may be asked more than once for the same time.
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
    work.other_load.fill(0.0);
    solid_load(state.solid.time + 0.5 * window, &mut work.other_load);
    copy(&state.solid, &mut work.before);
    work.rate.copy_from_slice(&state.solid.v);
    let mut passes = 1;
    let audit = match model.scheme {
        Scheme::Predicted => {
            grains(model, state, work, &mut applied)?;
            solid(model, state, work)?
        }
        Scheme::Stiffened => {
            // The contacts of the start are not known: the first window goes on with the present velocity.
            if state.passes.windows > 0 {
                begin(model, state, work)?;
                state.passes.solves += u64::from(predict(model, state, work)?);
            }
            grains(model, state, work, &mut applied)?;
            state.held.clear();
            state.held.extend(work.grains.surface_contacts().iter().map(Held::from));
            solid(model, state, work)?
        }
        Scheme::Lagged => {
            let n = work.contact_load.len();
            state.lagged.iter_mut().for_each(|l| l.resize(n, 0.0));
            for (load, (a, b)) in
                work.contact_load.iter_mut().zip(state.lagged[0].iter().zip(&state.lagged[1]))
            {
                *load = 0.5 * (a + b);
            }
            let audit = solid(model, state, work)?;
            mean_velocity(&state.solid, work, window);
            // What the grains do in this window loads the solid in the next; what did so now is still in the account.
            book(model, state, work, &audit);
            grains(model, state, work, &mut applied)?;
            state.lagged.swap(0, 1);
            state.lagged[0].copy_from_slice(&work.contact_load);
            state.passes.windows += 1;
            state.passes.passes += 1;
            return Ok(());
        }
        Scheme::Iterated { tolerance, passes: most } => {
            work.before.points.clone_from(&state.solid.points);
            let start = (state.grains.clone(), state.audit);
            work.accelerator.start();
            let nodes = work.surface.nodes().to_vec();
            let gather = |from: &[f64]| -> Vec<f64> {
                nodes.iter().flat_map(|&n| [0, 1, 2].map(|d| from[3 * n as usize + d])).collect()
            };
            let mut at = gather(&work.rate);
            loop {
                grains(model, state, work, &mut applied)?;
                let audit = solid(model, state, work)?;
                let found: Vec<f64> = nodes
                    .iter()
                    .flat_map(|&n| [0, 1, 2].map(|d| 3 * n as usize + d))
                    .map(|i| (state.solid.u[i] - work.before.u[i]) / window)
                    .collect();
                let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                let change = found.iter().zip(&at).fold(0.0_f64, |m, (f, a)| m.max((f - a).abs()));
                let there = change <= tolerance * largest(&found).max(largest(&at)) + STILL;
                if there || passes >= most {
                    state.passes.unconverged += u64::from(!there);
                    break audit;
                }
                work.accelerator.next(&mut at, &found);
                for (i, a) in nodes.iter().flat_map(|&n| [0, 1, 2].map(|d| 3 * n as usize + d)).zip(&at) {
                    work.rate[i] = *a;
                }
                copy(&work.before, &mut state.solid);
                state.solid.points.clone_from(&work.before.points);
                (state.grains, state.audit) = start.clone();
                work.grains.follow(&model.grains, &state.grains);
                passes += 1;
            }
        }
    };
    state.passes.windows += 1;
    state.passes.passes += u64::from(passes);
    book(model, state, work, &audit);
    // The surface of the next window begins where the solid is, not where this window left it.
    let (u, before, rate) = (&state.solid.u, &work.before.u, &work.rate);
    let jump = work.surface.nodes().iter().flat_map(|&n| [0, 1, 2].map(|d| 3 * n as usize + d));
    let jump = jump.fold(0.0_f64, |m, i| m.max((u[i] - before[i] - rate[i] * window).abs()));
    state.grains.allow_for_jump(work.surface.reach_of(2.0 * jump));
    Ok(())
}

/// The stiffened scheme needs a solid with a constant matrix.
fn not_constant(model: &Model<'_>) -> SolveError {
    SolveError::Plastic { material: model.solid.plastic_material().unwrap_or_default() }
}

/// Copies displacement and motion without new memory. The stresses at Gauss points are many, and only a window that may be
/// made again needs them.
fn copy(from: &fem::state::State, to: &mut fem::state::State) {
    to.time = from.time;
    to.u.copy_from_slice(&from.u);
    to.v.copy_from_slice(&from.v);
    to.a.copy_from_slice(&from.a);
}

/// The mean velocity of the window just made by the solid.
fn mean_velocity(solid: &fem::state::State, work: &mut Work, window: f64) {
    for ((rate, u), before) in work.rate.iter_mut().zip(&solid.u).zip(&work.before.u) {
        *rate = (u - before) / window;
    }
}

/// Puts the surface at the start of the window, to move with [`Work::rate`].
fn begin(model: &Model<'_>, state: &State, work: &mut Work) -> Result<(), StepError> {
    let velocity =
        (model.scheme == Scheme::Lagged).then_some([work.before.v.as_slice(), state.solid.v.as_slice()]);
    let motion = Motion {
        start: &work.before.u,
        reference: &model.reference,
        rate: &work.rate,
        velocity,
        duration: model.window(),
    };
    work.surface.begin(model.solid.mesh(), &motion);
    match work.surface.folded() {
        None => Ok(()),
        Some(face) => {
            let element = work.surface.faces()[face].element as usize;
            let element = model.solid.mesh().element_ids[element];
            Err(StepError::Folded { element, time: work.before.time })
        }
    }
}

/// The grains' steps of a window; their mean load on the solid is then in [`Work::contact_load`].
fn grains(
    model: &Model<'_>,
    state: &mut State,
    work: &mut Work,
    applied: &mut impl FnMut(f64, &dem::State, &mut Vec<dem::AppliedForce>),
) -> Result<(), StepError> {
    let dt = model.grains.dt();
    begin(model, state, work)?;
    work.transfer.begin_window();
    for k in 0..model.substeps {
        work.surface.advance((f64::from(k) + 0.5) * dt);
        work.applied.clear();
        applied(state.grains.time, &state.grains, &mut work.applied);
        dem::step(&model.grains, &mut state.grains, &mut work.grains, &work.surface, &work.applied)?;
        work.transfer.add(&work.surface, work.grains.surface_contacts(), dt, &mut state.audit);
    }
    work.contact_load.fill(0.0);
    work.transfer.add_mean_load(&work.surface, model.window(), &mut work.contact_load);
    work.transfer.audit_spread(&work.surface, model.window(), &work.contact_load, &mut state.audit);
    Ok(())
}

/// The solid's step of a window, under [`Work::contact_load`], the other loads and its weight.
fn solid(model: &Model<'_>, state: &mut State, work: &mut Work) -> Result<StepAudit, StepError> {
    let loads = work.contact_load.iter().zip(&work.other_load).zip(&model.dead_load);
    for (load, ((contact, other), dead)) in work.load.iter_mut().zip(loads) {
        *load = other + (contact + dead);
    }
    let time = state.solid.time;
    work.solver
        .step(model.solid, &mut state.solid, &work.load)
        .map_err(|source| StepError::Solid { time, source })
}

/// The velocity that the surface goes on with in the stiffened scheme.
fn predict(model: &Model<'_>, state: &State, work: &mut Work) -> Result<u32, StepError> {
    let time = state.solid.time;
    let SolidSolver::Elastic(solver) = &mut work.solver else {
        return Err(StepError::Solid { time, source: not_constant(model) });
    };
    for ((load, other), dead) in work.load.iter_mut().zip(&work.other_load).zip(&model.dead_load) {
        *load = other + dead;
    }
    work.stiffened
        .predict(
            model,
            &state.grains,
            &state.held,
            &work.surface,
            solver,
            &state.solid,
            &mut work.load,
            &mut work.rate,
        )
        .map_err(|source| StepError::Solid { time, source })
}

/// Work of each kind of load on the window's displacement, which the solver does not split, and what was dissipated.
fn book(model: &Model<'_>, state: &mut State, work: &Work, step: &StepAudit) {
    for (i, u) in state.solid.u.iter().enumerate() {
        let du = u - work.before.u[i];
        state.spent.contacts_on_solid += work.contact_load[i] * du;
        state.spent.solid_load_work += work.other_load[i] * du;
    }
    let (u, before) = (&state.solid.u, &work.before.u);
    let rate = |i: usize| work.rate[i];
    let found = |i: usize| (u[i] - before[i]) / model.window();
    let last = |i: usize| if state.rate.is_empty() { work.rate[i] } else { state.rate[i] };
    state.spent.dashpot_lag += work.transfer.dashpot_lag(&work.surface, rate, last, found);
    if model.scheme != Scheme::Lagged {
        // The lagged scheme shows a velocity that does not jump.
        state.rate.clear();
        state.rate.extend_from_slice(&work.rate);
    }
    state.spent.rayleigh += step.damping_dissipation;
    state.spent.absorbed += step.boundary_dissipation;
    state.spent.plastic += step.plastic_dissipation;
    state.spent.numerical += step.numerical_dissipation;
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
    let grains = spent_by_grains(&state.grains);
    Spent {
        dashpot: grains.dashpot + solid.dashpot_lag,
        dashpot_lag: solid.dashpot_lag,
        solid_load_work: solid.solid_load_work,
        rayleigh: solid.rayleigh,
        absorbed: solid.absorbed,
        plastic: solid.plastic,
        numerical: solid.numerical,
        contacts_on_solid: solid.contacts_on_solid,
        ..grains
    }
}

/// Takes grains out and puts grains in between two windows, as [`dem::flow::exchange`] does.
///
/// # Errors
/// A grain that cannot leave or come.
pub fn exchange(
    model: &Model<'_>,
    state: &mut State,
    work: &mut Work,
    leave: &[usize],
    arrive: &[dem::flow::Arrival],
) -> Result<(), dem::flow::FlowError> {
    dem::flow::exchange(&model.grains, &mut state.grains, &mut work.grains, leave, arrive)?;
    // Contacts of grains that have left load the solid no more, not even in a prediction.
    state.held.retain(|c| !leave.contains(&c.body()));
    Ok(())
}

/// The grains' share of [`spent`].
pub fn spent_by_grains(grains: &dem::State) -> Spent {
    let ledger = &grains.ledger;
    Spent {
        applied_work: ledger.work_applied,
        // Grains put back at the upper end of a periodic slope have their potential energy anew, and those that come in
        // bring all of theirs.
        wall_work: ledger.work_walls
            + ledger.work_servo
            + ledger.work_constraints
            + ledger.work_periodic
            + ledger.work_flow,
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
