//! State and scratch memory of the coupled step.

use super::interface_check::InterfaceCheck;
use super::model::Model;
use super::solver::solver;
use super::stiffened::{Held, Stiffened};
use crate::accelerate::Accelerator;
use crate::interface::Interface;
use crate::ledger::Spent;
use crate::scheme::Passes;
use crate::surface::SolidSurface;
use crate::transfer::{Transfer, TransferAudit};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::sync::Arc;
use trackbed_dem as dem;
use trackbed_fem as fem;
use trackbed_fem::SolveError;
use trackbed_fem::nonlinear::{Memory, Statistics};
use trackbed_fem::reduction::{Estimate, Reduced};
use trackbed_fem::theta::{ReducedTheta, ThetaMethod};

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
    pub(super) spent: Spent,
    /// Velocity that the surface went on with in the last window [m/s], shape `[3·nodes]`; empty before the first.
    pub(super) rate: Vec<f64>,
    /// Displacement at the end of the last window less the one that its rate predicted [m], shape `[3·nodes]`; empty before the first.
    pub(super) correction: Vec<f64>,
    /// Repeated windows.
    pub passes: Passes,
    /// Mean contact load of the last window and of the one before [N], shape `[3·nodes]`; empty but for the lagged scheme.
    pub(super) lagged: [Vec<f64>; 2],
    /// Contacts of the last grain step, for the stiffened scheme.
    pub(super) held: Vec<Held>,
    /// Results of the interface checks.
    pub interface_check: InterfaceCheck,
}

/// Scratch memory and factors; `B` computes the steps of the grains.
pub struct Work<B = dem::Work> {
    /// What computes the steps of the grains.
    pub grains: B,
    /// The surface that grains touch.
    pub surface: SolidSurface,
    pub(super) transfer: Transfer,
    pub(super) solver: Box<dyn ThetaMethod>,
    /// Shapes that the steps of the solid are reduced to, if any.
    reduced: Option<Arc<Reduced>>,
    pub(super) load: Vec<f64>,
    pub(super) contact_load: Vec<f64>,
    pub(super) other_load: Vec<f64>,
    pub(super) before: fem::state::State,
    pub(super) rate: Vec<f64>,
    pub(super) correction: Vec<f64>,
    pub(super) applied: Vec<dem::AppliedForce>,
    pub(super) accelerator: Accelerator,
    pub(super) stiffened: Stiffened,
    pub(super) interface: Interface,
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
            correction: Vec::new(),
            passes: Passes::default(),
            lagged: Default::default(),
            held: Vec::new(),
            interface_check: InterfaceCheck::default(),
        }
    }

    /// Lets time, steps and accounts begin anew where everything is.
    pub fn begin_anew(&mut self) {
        self.grains.begin_anew();
        self.solid.time = 0.0;
        self.audit = TransferAudit::default();
        self.spent = Spent::default();
        self.passes = Passes::default();
        self.interface_check = InterfaceCheck::default();
    }

    /// The same with a contact load [N], shape `[3·nodes]`, that the solid carries from the start: the lagged scheme begins
    /// with it.
    pub fn carrying(self, load: Vec<f64>) -> State {
        State { lagged: [load.clone(), load], ..self }
    }
}

impl Work {
    /// Scratch memory and the factor of the solid's window matrix; the grains' steps are computed by [`dem::Work`].
    ///
    /// # Errors
    /// As [`Work::with_back_end`].
    pub fn new(model: &Model<'_>, state: &State, surface: SolidSurface) -> Result<Work, SolveError> {
        let grains = dem::Work::new(&model.grains, &state.grains);
        Work::with_back_end(model, state, surface, grains)
    }
}

impl<B: dem::BackEnd> Work<B> {
    /// Scratch memory, the factor of the solid's window matrix, and what computes the grains' steps, which has taken their state over.
    ///
    /// # Errors
    /// The matrix cannot be factored, or the solid is plastic and the scheme needs a constant matrix.
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
            interface: Interface::new(model.solid, &surface),
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
            accelerator: Accelerator::default(),
            stiffened: Stiffened::default(),
        })
    }

    /// Takes the steps of the solid in the span of a reduction from now on.
    ///
    /// # Errors
    /// A solid with plasticity or stresses at its Gauss points, or another one than was reduced.
    pub fn reduce(&mut self, model: &Model<'_>, reduced: Arc<Reduced>) -> Result<(), SolveError> {
        self.solver = Box::new(ReducedTheta::new(model.solid, reduced.clone(), model.theta, model.window())?);
        self.reduced = Some(reduced);
        Ok(())
    }

    /// Makes the solver of the solid anew, for windows of another length.
    pub(super) fn refactor(&mut self, model: &Model<'_>, without_stresses: bool) -> Result<(), SolveError> {
        match self.reduced.clone() {
            Some(reduced) => self.reduce(model, reduced),
            None => {
                self.solver = solver(model, without_stresses)?;
                Ok(())
            }
        }
    }

    /// What the reduction of the solid costs in accuracy; none without one.
    pub fn reduction(&self) -> Option<Estimate> {
        self.reduced.as_ref().map(|reduced| *reduced.estimate())
    }

    /// Counts of the iteration of a plastic solid.
    pub fn newton(&self) -> Option<Statistics> {
        self.memory().map(|memory| memory.statistics())
    }

    /// What the solver of a plastic solid remembers beside the state, for a checkpoint.
    pub fn memory(&self) -> Option<Memory> {
        self.solver.memory()
    }

    /// Goes on with the memory of scratch that was made for the same model.
    ///
    /// # Errors
    /// A matrix cannot be factored.
    pub fn recall(&mut self, model: &Model<'_>, memory: Option<&Memory>) -> Result<(), SolveError> {
        memory.map_or(Ok(()), |memory| self.solver.recall(model.solid, memory))
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
