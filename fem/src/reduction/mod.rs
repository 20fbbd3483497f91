//! Galerkin reduction of a linear elastic solid: `du = V dq` with `VᵀM V`, `VᵀC V`, `VᵀK V`.
//!
//! * [`Reduction::Surface`]: static condensation to the contact surface (Guyan 1965), optionally with
//!   natural modes (MacNeal 1971; Rubin 1975).
//! * [`Reduction::Modes`]: lowest modes with static corrections for surface traction and pressure (Craig
//!   and Bampton 1968; Craig and Chang 1977).
//!
//! The basis is mass-orthonormal with diagonal `VᵀK V`; the state keeps coordinates in it and the motion of the
//! contact surface, other nodes on demand.
//!
//! Limits: linear elastic, constrained bodies, fixed supports, at most [`MAX_SHAPES`] basis vectors;
//! approximate stresses near point forces.

mod basis;
mod estimate;
mod orthonormal;
#[cfg(test)]
mod tests;

pub use basis::{Cost, ReducedModel};
pub use estimate::{Estimate, FoundError, OutOfBalance};

use crate::error::SolveError;
use crate::modal::ModalError;
use thiserror::Error;

/// Largest number of basis vectors; beyond it the sparse factor is faster.
pub const MAX_SHAPES: usize = 2000;

/// Type of reduction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reduction {
    /// Contact surface dofs and natural modes.
    Surface {
        /// Additional natural modes.
        modes: usize,
    },
    /// Natural modes with static corrections for surface pressure.
    Modes {
        /// Natural modes.
        modes: usize,
    },
}

/// Reduction errors.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ReductionError {
    /// Statics or factorisation.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// Modal analysis.
    #[error(transparent)]
    Modal(#[from] ModalError),
    /// Contact surface without faces or free dofs.
    #[error("the contact surface has no free degree of freedom")]
    NoSurface,
    /// No modes requested.
    #[error("a reduction to modes needs at least 1 mode")]
    NoModes,
    /// Too many basis vectors.
    #[error(
        "reduction of {shapes} modes for {dofs} free degrees of freedom, expected at most {} modes and half the degrees of freedom",
        MAX_SHAPES
    )]
    TooMany {
        /// Requested basis vectors.
        shapes: usize,
        /// Free dofs.
        dofs: usize,
    },
    /// Reduced stiffness not positive definite.
    #[error("reduced stiffness matrix not positive definite")]
    NotDefinite,
}
