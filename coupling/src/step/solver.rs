//! FEM solver over a window, and errors of the coupled step.

use super::model::Model;
use crate::scheme::Scheme;
use std::sync::Arc;
use trackbed_dem as dem;
use trackbed_fem::SolveError;
use trackbed_fem::reduction::ReducedModel;
use trackbed_fem::theta::{NonlinearTheta, ReducedTheta, ThetaMethod, ThetaSolver};

/// One stored factor for a linear solid without initial stress, else Newton's method.
///
/// # Errors
/// Singular matrix, or a plastic solid with the stiffened scheme.
pub(super) fn solver(model: &Model<'_>, without_stresses: bool) -> Result<Box<dyn ThetaMethod>, SolveError> {
    let (solid, theta, window) = (model.solid, model.theta, model.window());
    if solid.is_linear() && without_stresses {
        return Ok(Box::new(ThetaSolver::new(solid, theta, window)?));
    }
    if model.scheme == Scheme::Stiffened {
        return Err(SolveError::Plastic { material: solid.plastic_material().unwrap_or_default() });
    }
    Ok(Box::new(NonlinearTheta::new(solid, theta, window, model.newton)?))
}

/// Solver in the basis of a reduced solid.
///
/// # Errors
/// Plastic or another solid.
pub(super) fn reduced_solver(
    model: &Model<'_>,
    reduced: Arc<ReducedModel>,
) -> Result<Box<dyn ThetaMethod>, SolveError> {
    let (solid, theta, window) = (model.solid, model.theta, model.window());
    Ok(Box::new(ReducedTheta::new(solid, reduced, theta, window, &model.dead_load)?))
}

/// Errors of a coupled step.
#[derive(Debug, thiserror::Error)]
pub enum StepError {
    /// DEM.
    #[error(transparent)]
    Grains(#[from] dem::StepError),
    /// FEM.
    #[error("at t = {time:.6e} s: solid: {source}")]
    Solid {
        /// Time [s].
        time: f64,
        /// Cause.
        source: SolveError,
    },
    /// Inverted surface face.
    #[error(
        "at t = {time:.6e} s: inverted face of the solid surface at element {element}. Reduce the load (small strains only) or coupling.substeps."
    )]
    Folded {
        /// Element number in the mesh file.
        element: u32,
        /// Time [s].
        time: f64,
    },
}
