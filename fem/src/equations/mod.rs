//! The equations of a model on its free dofs, handed to the solvers: ordering by the mesh ([`ordering`]), pattern and
//! values, and the solvers of a combination of K, M and D behind the trait [`SystemSolver`](system::SystemSolver): a factor
//! ([`cholesky`], [`mumps`]) or an iteration ([`iteration`]), whichever the model's [`method`] says; the mass matrix alone ([`mass`]).

pub mod cholesky;
pub mod iteration;
pub mod mass;
pub mod method;
pub mod mumps;
pub mod ordering;
mod pattern;
pub mod system;

pub use pattern::{analyse, values};
