//! Solvers of the equation system on the free dofs.
//!
//! [`ordering`] numbers the nodes so that the factor stays small, [`analysis`] finds its structure, [`multifrontal`] factors and
//! solves, symmetric or not, and [`cholesky`] does so for K and M of a model. [`gmres`] solves with a matrix near a
//! factored one, and [`conjugate_gradient`] with the mass matrix alone, which needs no factor.
pub mod analysis;
pub mod cholesky;
pub mod conjugate_gradient;
mod dense;
mod front;
pub mod gmres;
mod kernels;
pub mod multifrontal;
pub mod ordering;
mod pattern;
mod solution;
mod structure;

use crate::material::Region;
use crate::newmark::NewmarkError;
use thiserror::Error;

/// A direct solver: numbers in, factor kept, many right-hand sides.
pub trait LinearSolver {
    /// Number of equations.
    fn size(&self) -> usize;

    /// Solves in place: the right-hand side comes in, the solution goes out. Shape `[equations]`.
    fn solve_in_place(&mut self, x: &mut [f64]);
}

/// Why equations could not be solved. Numbers of nodes are those of the user's files.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs, reason = "the messages are the documentation")]
pub enum SolveError {
    #[error("the body is not held: node {node} is free to move in {direction}; add supports")]
    NotHeld { node: u32, direction: &'static str },
    #[error(
        "the body is not held: no stiffness is left at node {node} in {direction} (pivot {pivot:.3e} of the diagonal); add \
         supports, join elements by whole faces, and use the full rule where a row of elements is one element wide"
    )]
    NoStiffness { node: u32, direction: &'static str, pivot: f64 },
    #[error("the solution misses equilibrium by {residual:.3e} of the load at node {node} in {direction}")]
    Inaccurate { node: u32, direction: &'static str, residual: f64 },
    #[error("material {material} has density 0; dynamics needs a mass")]
    NoMass { material: u32 },
    #[error("the {what} has {found} values, expected {expected}")]
    Length { what: &'static str, found: usize, expected: usize },
    #[error("{what} is not a finite number at node {node} in {direction}, at time {time} s")]
    NotFinite { what: &'static str, node: u32, direction: &'static str, time: f64 },
    #[error(
        "material {material} is plastic: this solver is linear and would treat it as elastic; use the nonlinear one"
    )]
    Plastic { material: u32 },
    #[error(
        "no equilibrium after time {time}: {iterations} iterations left a residual of {residual:.3e} of the forces; worst at \
         element {element}, Gauss point {point} (natural coordinates {xi:?}), which returned to: {region:?}"
    )]
    Diverged {
        time: f64,
        iterations: u32,
        residual: f64,
        element: u32,
        point: u32,
        xi: [f64; 3],
        region: Region,
    },
    #[error("{what} is {value}, expected {expected}")]
    Option { what: &'static str, value: f64, expected: &'static str },
    #[error("the time step is {dt} s, expected a finite number above 0")]
    TimeStep { dt: f64 },
    #[error("theta is {theta}, expected 0.5 to 1")]
    Theta { theta: f64 },
    #[error(transparent)]
    Newmark(#[from] NewmarkError),
    #[error(
        "the mass matrix could not be solved: {residual:.3e} of the load left after {iterations} iterations"
    )]
    MassNotSolved { residual: f64, iterations: usize },
    #[error("there is not enough memory to factor {equations} equations")]
    Memory { equations: usize },
    #[error("the pattern of the matrix cannot be used: {what}")]
    Pattern { what: &'static str },
}

/// A pivot that ended a factorization.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("the pivot of equation {equation} is {ratio:.3e} of its scale: the matrix cannot be factored")]
pub struct PivotError {
    /// The equation, numbered as in the pattern.
    pub equation: usize,
    /// The pivot over the diagonal (symmetric) or over the largest entry of its column (unsymmetric); 0 when the
    /// factorization could not tell more than that it is not usable.
    pub ratio: f64,
}
