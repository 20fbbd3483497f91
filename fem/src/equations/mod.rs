//! Equations of a model on its free dofs: ordering, matrices, and solvers behind
//! [`SystemSolver`](system::SystemSolver).

pub mod cholesky;
pub mod mass;
pub mod method;
pub mod mumps;
pub mod ordering;
mod pattern;
pub mod pcg;
pub mod system;

pub use pattern::{analyse, values};
