//! Reduction of a linear elastic solid to a few shapes: a speed choice for the coupled step, with its error stated.
//!
//! The displacement is sought in the span of the columns of V, `du = V dq`, and the equations are asked to hold in that
//! span only (Galerkin): `VᵀM V`, `VᵀC V`, `VᵀK V`. Two choices of the span:
//!
//! * [`Reduction::Surface`]: static condensation to the dofs of the contact surface (Guyan 1965): the displacements under a
//!   unit force on each of them, exact for slow loads on the surface; natural modes may be added for the inertia that static
//!   shapes miss (MacNeal 1971; Rubin 1975).
//! * [`Reduction::Modes`]: the slowest natural modes, and as static correction the displacements under a uniform
//!   traction along x, y, z on the whole surface and under a pressure on each of its faces (residual attachment shapes,
//!   Craig and Bampton 1968; Craig and Chang 1977). Loads spread over a face are met well, a point load is softened: what a point
//!   force does to its element is not in the span.
//!
//! The shapes are made orthonormal to the mass and turned so that `VᵀK V` is diagonal: the reduced equations come apart,
//! and their frequencies are known. The state stays that of all nodes, so everything that reads one works as before.
//!
//! [`Estimate`] is made before a run: the part of the static deflection under a pressure and under point forces that is lost,
//! and the frequency up to which the reduced solid is right within 1 %. A Galerkin span is never too soft, so errors of
//! deflections are from 0 to 1.
//!
//! Source: Guyan, AIAA J. 3 (1965) 380; Craig and Bampton, AIAA J. 6 (1968) 1313-1319; MacNeal, Computers and Structures 1 (1971)
//! 581-601; Rubin, AIAA J. 13 (1975) 995-1006; Craig and Chang, AIAA Paper 77-405 (1977). Limits: linear elastic, held bodies, supports
//! that stay; at most [`MOST_SHAPES`] shapes; internal stresses near a point force are those of the span.

mod basis;
mod estimate;
#[cfg(test)]
mod tests;

pub use basis::{Cost, Reduced};
pub use estimate::Estimate;

use crate::error::SolveError;
use crate::modal::ModalError;
use thiserror::Error;

/// Shapes that a reduction may have at most: beyond, the sparse factor is the faster way.
pub const MOST_SHAPES: usize = 1000;

/// What a solid is reduced to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reduction {
    /// The dofs of the contact surface, and so many natural modes.
    Surface {
        /// Natural modes beside the static shapes.
        modes: usize,
    },
    /// So many natural modes, and static corrections for pressures on the contact surface.
    Modes {
        /// Natural modes.
        modes: usize,
    },
}

/// Why a solid cannot be reduced.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ReductionError {
    /// Statics or the factor of a matrix.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// Natural modes.
    #[error(transparent)]
    Modal(#[from] ModalError),
    /// The contact surface has no faces, or no free dofs.
    #[error("the contact surface has no free degree of freedom")]
    NoSurface,
    /// No shape was asked for.
    #[error("a reduction to modes needs at least 1 mode")]
    NoModes,
    /// More shapes than pay.
    #[error(
        "reduction of {shapes} modes for {dofs} free degrees of freedom, expected at most {} modes and half the degrees of freedom",
        MOST_SHAPES
    )]
    TooMany {
        /// Shapes wanted.
        shapes: usize,
        /// Free dofs of the solid.
        dofs: usize,
    },
    /// The equations of the span cannot be taken apart.
    #[error("reduced stiffness matrix not positive definite")]
    NotDefinite,
}
