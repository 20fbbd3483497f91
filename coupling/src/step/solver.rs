//! The solid's step over a window: elastic, plastic or reduced.

use super::model::Model;
use crate::scheme::Scheme;
use trackbed_dem as dem;
use trackbed_fem as fem;
use trackbed_fem::SolveError;
use trackbed_fem::nonlinear::PlasticWindowSolver;
use trackbed_fem::reduction::ReducedWindowSolver;
use trackbed_fem::state::StepAudit;
use trackbed_fem::window::WindowSolver;

/// The solid's step over a window.
pub(super) enum SolidSolver {
    /// One solve with a factor that is kept.
    Elastic(Box<WindowSolver>),
    /// Newton's iteration on the stresses of the Gauss points.
    Plastic(Box<PlasticWindowSolver>),
    /// The equations of a few shapes.
    Reduced(Box<ReducedWindowSolver>),
}

impl SolidSolver {
    pub fn new(model: &Model<'_>, without_stresses: bool) -> Result<SolidSolver, SolveError> {
        let (solid, theta, window) = (model.solid, model.theta, model.window());
        if solid.is_linear() && without_stresses {
            return Ok(SolidSolver::Elastic(Box::new(WindowSolver::new(solid, theta, window)?)));
        }
        if model.scheme == Scheme::Stiffened {
            return Err(not_constant(model));
        }
        Ok(SolidSolver::Plastic(Box::new(PlasticWindowSolver::new(solid, theta, window, model.newton)?)))
    }

    pub fn step(
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

/// The stiffened scheme needs a solid with a constant matrix.
pub(super) fn not_constant(model: &Model<'_>) -> SolveError {
    SolveError::Plastic { material: model.solid.plastic_material().unwrap_or_default() }
}

/// Why a coupled step failed.
#[derive(Debug, thiserror::Error)]
pub enum StepError {
    /// The grains failed.
    #[error(transparent)]
    Grains(#[from] dem::StepError),
    /// The solid failed.
    #[error("at t = {time:.6e} s: solid: {source}")]
    Solid {
        /// Time of the failure [s].
        time: f64,
        /// What failed.
        source: SolveError,
    },
    /// The surface turned over.
    #[error(
        "at t = {time:.6e} s: inverted face of the solid surface at element {element}. Reduce the load (small strains only) or coupling.substeps."
    )]
    Folded {
        /// Number of the element in the mesh's file.
        element: u32,
        /// Time [s].
        time: f64,
    },
}
