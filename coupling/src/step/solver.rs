//! The solver of the solid's step over a window, and why a coupled step fails.

use super::model::Model;
use crate::scheme::Scheme;
use trackbed_dem as dem;
use trackbed_fem::SolveError;
use trackbed_fem::theta::{NonlinearTheta, ThetaMethod, ThetaSolver};

/// The solver for a solid with stresses at its Gauss points or without: one factor that is kept for a linear solid without, else
/// Newton's iteration.
///
/// # Errors
/// The matrix cannot be factored, or the stiffened scheme, which needs a constant one, has a plastic solid.
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
