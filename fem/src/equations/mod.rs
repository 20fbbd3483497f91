//! The equations of a model on its free dofs, handed to the solvers: ordering by the mesh ([`ordering`]), pattern and
//! values, the factor of a combination of K, M and D ([`cholesky`]), and the mass matrix alone ([`mass`]).

pub mod cholesky;
pub mod mass;
pub mod ordering;
mod pattern;

pub use pattern::{analyse, values};
