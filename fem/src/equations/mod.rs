//! The equations of a model on its free dofs, handed to the solvers: ordering by the mesh ([`ordering`]), pattern and
//! values, the factor of a combination of K, M and D ([`cholesky`]; that of the library MUMPS, with the feature `mumps`) or its
//! iteration ([`iteration`]), whichever the model's [`method`] asks for ([`system`]), and the mass matrix alone ([`mass`]).

pub mod cholesky;
pub mod iteration;
pub mod mass;
pub mod method;
#[cfg(feature = "mumps")]
pub mod mumps;
pub mod ordering;
mod pattern;
pub mod system;

pub use pattern::{analyse, values};
