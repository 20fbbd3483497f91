//! State and scratch memory of the coupled step.

use super::interface_check::InterfaceCheck;
use super::model::Model;
use super::solver::{reduced_solver, solver};
use super::stiffened::{LinearisedContact, Stiffened};
use crate::energy_balance::WorkAndDissipation;
use crate::interface_stability::InterfaceStability;
use crate::iqn_ils::IqnIls;
use crate::scheme::IterationStats;
use crate::surface::SolidSurface;
use crate::transfer::{Transfer, TransferAudit};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::sync::Arc;
use trackbed_dem as dem;
use trackbed_fem as fem;
use trackbed_fem::SolveError;
use trackbed_fem::nonlinear::{SolverState, Statistics};
use trackbed_fem::reduction::{Estimate, FoundError, ReducedModel};
use trackbed_fem::statics::StaticSolver;
use trackbed_fem::theta::ThetaMethod;

/// State of a run.
#[derive(Clone, Serialize, Deserialize)]
pub struct State {
    /// Solid.
    pub solid: fem::state::State,
    /// Grains with contact history.
    pub grains: dem::State,
    /// Largest transfer errors.
    pub audit: TransferAudit,
    /// Work and dissipation of the solid.
    pub(super) spent: WorkAndDissipation,
    /// Last surface velocity [m/s], shape `[3·nodes]`; empty at the start.
    pub(super) rate: Vec<f64>,
    /// Computed minus predicted displacement [m], shape `[3·nodes]`; empty at the start.
    pub(super) correction: Vec<f64>,
    /// Repeated windows.
    pub passes: IterationStats,
    /// Mean contact loads of the last two windows [N], shape `[3·nodes]`; lagged scheme only.
    pub(super) lagged: [Vec<f64>; 2],
    /// Last contacts; stiffened scheme only.
    pub(super) last_contacts: Vec<LinearisedContact>,
    /// Interface checks.
    pub interface_check: InterfaceCheck,
    /// Errors of a reduced solid.
    pub reduction: FoundError,
    /// Faces of the surface that the basis of a reduced solid has loads on; empty without.
    pub loaded_faces: Vec<u32>,
}

/// Scratch memory and factors; `B` computes the DEM steps.
pub struct Work<B = dem::Work> {
    /// DEM back end.
    pub grains: B,
    /// Contact surface.
    pub surface: SolidSurface,
    pub(super) transfer: Transfer,
    pub(super) solver: Box<dyn ThetaMethod>,
    /// Basis of a reduced solid, and a solver for its errors.
    reduced: Option<(Arc<ReducedModel>, StaticSolver)>,
    pub(super) load: Vec<f64>,
    pub(super) contact_load: Vec<f64>,
    pub(super) other_load: Vec<f64>,
    pub(super) before: fem::state::State,
    pub(super) rate: Vec<f64>,
    pub(super) correction: Vec<f64>,
    pub(super) applied: Vec<dem::AppliedForce>,
    pub(super) accelerator: IqnIls,
    pub(super) stiffened: Stiffened,
    pub(super) interface: InterfaceStability,
}

impl State {
    /// Initial state.
    pub fn new(solid: fem::state::State, grains: dem::State) -> State {
        State {
            solid,
            grains,
            audit: TransferAudit::default(),
            spent: WorkAndDissipation::default(),
            rate: Vec::new(),
            correction: Vec::new(),
            passes: IterationStats::default(),
            lagged: Default::default(),
            last_contacts: Vec::new(),
            interface_check: InterfaceCheck::default(),
            reduction: FoundError::default(),
            loaded_faces: Vec::new(),
        }
    }

    /// Resets time, step counts and balances.
    pub fn reset_time_and_balances(&mut self) {
        self.grains.reset_time();
        self.solid.time = 0.0;
        self.audit = TransferAudit::default();
        self.spent = WorkAndDissipation::default();
        self.passes = IterationStats::default();
        self.interface_check = InterfaceCheck::default();
        self.reduction = FoundError::default();
        // The next run may have another basis.
        self.solid.reduced = Default::default();
        self.loaded_faces.clear();
    }

    /// Adds an initial contact load [N], shape `[3·nodes]`, for the lagged scheme.
    pub fn with_initial_contact_load(self, load: Vec<f64>) -> State {
        State { lagged: [load.clone(), load], ..self }
    }
}

impl Work {
    /// Allocates memory and factors.
    ///
    /// # Errors
    /// As [`Work::with_back_end`].
    pub fn new(model: &Model<'_>, state: &State, surface: SolidSurface) -> Result<Work, SolveError> {
        let grains = dem::Work::new(&model.grains, &state.grains);
        Work::with_back_end(model, state, surface, grains)
    }
}

impl<B: dem::BackEnd> Work<B> {
    /// Allocates memory and factors; `grains` already has the DEM state.
    ///
    /// # Errors
    /// Singular matrix, or a plastic solid with a scheme that needs a constant matrix.
    pub fn with_back_end(
        model: &Model<'_>,
        state: &State,
        surface: SolidSurface,
        grains: B,
    ) -> Result<Work<B>, SolveError> {
        let n = 3 * model.solid.mesh().node_count();
        Ok(Work {
            grains,
            transfer: Transfer::new(&surface),
            interface: InterfaceStability::new(model.solid, &surface),
            surface,
            solver: solver(model, state.solid.points.is_empty())?,
            reduced: None,
            load: vec![0.0; n],
            contact_load: vec![0.0; n],
            other_load: vec![0.0; n],
            before: fem::state::State { points: Default::default(), ..state.solid.clone() },
            rate: vec![0.0; n],
            correction: Vec::new(),
            applied: Vec::new(),
            accelerator: IqnIls::default(),
            stiffened: Stiffened::default(),
        })
    }

    /// Switches the solid to a reduced basis.
    ///
    /// # Errors
    /// Plastic solid, initial stress, or another solid than the reduced one.
    pub fn reduce(&mut self, model: &Model<'_>, reduced: Arc<ReducedModel>) -> Result<(), SolveError> {
        self.solver = reduced_solver(model, reduced.clone())?;
        self.reduced = Some((reduced, StaticSolver::new(model.solid)?));
        Ok(())
    }

    /// Completes the motion of a reduced solid, of which windows compute the contact surface.
    pub fn recover(&self, solid: &mut fem::state::State) {
        self.solver.recover(solid);
    }

    /// Compares the last window of a reduced solid with the full one.
    ///
    /// # Errors
    /// Values not finite.
    pub fn find_reduction_error(&mut self, model: &Model<'_>, state: &mut State) -> Result<(), SolveError> {
        let Some((_, solver)) = &mut self.reduced else { return Ok(()) };
        match self.solver.out_of_balance(model.solid, &state.solid, &self.load) {
            Some(step) => state.reduction.add(model.solid, solver, &step),
            None => Ok(()),
        }
    }

    pub(super) fn refactor(&mut self, model: &Model<'_>, without_stresses: bool) -> Result<(), SolveError> {
        self.solver = match &self.reduced {
            Some((reduced, _)) => reduced_solver(model, reduced.clone())?,
            None => solver(model, without_stresses)?,
        };
        Ok(())
    }

    /// Accuracy estimate of the reduction, if any.
    pub fn reduction(&self) -> Option<Estimate> {
        self.reduced.as_ref().map(|(reduced, _)| *reduced.estimate())
    }

    /// Newton statistics of a plastic solid.
    pub fn newton(&self) -> Option<Statistics> {
        self.solver_state().map(|memory| memory.statistics())
    }

    /// Solver memory of a plastic solid, for a checkpoint.
    pub fn solver_state(&self) -> Option<SolverState> {
        self.solver.solver_state()
    }

    /// Restores solver memory of the same model.
    ///
    /// # Errors
    /// Singular matrix.
    pub fn restore(&mut self, model: &Model<'_>, memory: Option<&SolverState>) -> Result<(), SolveError> {
        memory.map_or(Ok(()), |memory| self.solver.restore(model.solid, memory))
    }

    /// Largest mean pressure on a face in the last window [Pa].
    pub fn peak_face_pressure(&self, window: f64) -> f64 {
        self.transfer.peak_face_pressure(&self.surface, window)
    }

    /// Last load on the solid, with gravity and contacts [N]. Shape `[3·nodes]`.
    pub fn load(&self) -> &[f64] {
        &self.load
    }

    /// Mean force of the grains on the solid [N].
    pub fn mean_contact_force(&self, window: f64) -> [f64; 3] {
        self.transfer.total_impulse().map(|i| i / window)
    }

    /// Mean force on `faces` [N].
    pub fn contact_force_on(&self, faces: Range<usize>, window: f64) -> [f64; 3] {
        self.transfer.impulse_on(faces).map(|i| i / window)
    }

    /// Largest mean pressure on one of `faces` [Pa].
    pub fn peak_pressure_on(&self, faces: Range<usize>, window: f64) -> f64 {
        self.transfer.peak_pressure_on(faces, &self.surface, window)
    }
}
