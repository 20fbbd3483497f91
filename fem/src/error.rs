//! Errors of models, methods and solvers.

use crate::material::{ReturnError, ReturnRegion};
use crate::solver::AnalysisError;
use crate::solver::conjugate::Stopped;
use thiserror::Error;

/// Model errors; numbers as in the input files.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs, reason = "the messages are the documentation")]
pub enum ModelError {
    #[error("the mesh has no {what}")]
    EmptyMesh { what: &'static str },
    #[error("the mesh has {found} {what}, expected {expected}")]
    Length { what: &'static str, found: usize, expected: usize },
    #[error("node {node} has a coordinate that is not a finite number")]
    Coordinate { node: u32 },
    #[error("element {element} refers to node index {index}, but the mesh has {nodes} nodes")]
    NodeRange { element: u32, index: u32, nodes: usize },
    #[error("element {element} uses node {node} more than once; a {kind} needs {nodes} different nodes")]
    RepeatedNode { element: u32, node: u32, kind: &'static str, nodes: usize },
    #[error("node {node} belongs to no element")]
    UnusedNode { node: u32 },
    #[error("element {element} has material {material}, which is not defined")]
    MissingMaterial { element: u32, material: u32 },
    #[error("material {material}: {constant} is {value}, expected {expected}")]
    MaterialConstant { material: u32, constant: &'static str, value: f64, expected: &'static str },
    #[error(
        "element {element} is inverted or degenerate: Jacobian determinant {determinant:.6e} m³ at integration point {point:?}, expected above 0"
    )]
    Inverted { element: u32, point: [f64; 3], determinant: f64 },
    #[error("constraint {index} names node index {node}, direction {direction}; that dof does not exist")]
    ConstraintRange { index: usize, node: u32, direction: u8 },
    #[error("the constraint of node {node} in {direction} has the value {value}, expected a finite number")]
    ConstraintValue { node: u32, direction: &'static str, value: f64 },
    #[error("node {node} is given two displacements in {direction}: {first} m and {second} m")]
    Contradiction { node: u32, direction: &'static str, first: f64, second: f64 },
    #[error("gravity is {gravity:?}, expected finite numbers")]
    Gravity { gravity: [f64; 3] },
    #[error("{name} is {value}, expected a finite number, 0 or above")]
    Damping { name: &'static str, value: f64 },
    #[error("boundary layer {index}: {name} is {value}, expected a finite number, 0 or above")]
    BoundaryConstant { index: usize, name: &'static str, value: f64 },
    #[error("boundary layer {index}: face {side} of element {element} {fault}")]
    BoundaryFace { index: usize, element: u32, side: u8, fault: &'static str },
}

/// Parameter errors of Newmark and HHT-α.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum NewmarkError {
    /// Not unconditionally stable.
    #[error(
        "Newmark with beta = {beta}, gamma = {gamma} is not unconditionally stable: it needs gamma >= 0.5 and \
         beta >= 0.25 (0.5 + gamma)^2 = {least_beta}"
    )]
    Unstable {
        /// Given beta.
        beta: f64,
        /// Given gamma.
        gamma: f64,
        /// Least beta for this gamma.
        least_beta: f64,
    },
    /// Negative or not finite.
    #[error("Newmark's beta = {beta} and gamma = {gamma} must be finite numbers, 0 or above")]
    Range {
        /// Given beta.
        beta: f64,
        /// Given gamma.
        gamma: f64,
    },
    /// HHT α out of range.
    #[error("HHT-alpha with alpha = {alpha} is not unconditionally stable: alpha must be between -1/3 and 0")]
    Hht {
        /// Given α.
        alpha: f64,
    },
    /// HHT-α needs both loads.
    #[error("HHT-alpha needs the load at the start of the step, too")]
    LoadAtStart,
    /// Not for prescribed motion.
    #[error("Newmark with beta = 0 cannot follow a prescribed motion")]
    Prescribed,
}

pub(crate) fn size(value: f64) -> String {
    if value.is_finite() { format!("{value:.3e}") } else { "more than a number holds".to_string() }
}

/// Solver errors; node numbers as in the input files.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs, reason = "the messages are the documentation")]
pub enum SolveError {
    #[error("insufficiently constrained: rigid-body motion of node {node} in {direction}; add supports")]
    RigidBodyMotion { node: u32, direction: &'static str },
    #[error(
        "singular stiffness matrix: zero pivot at node {node} in {direction} ({} of the diagonal), rigid-body motion or zero-energy mode; add supports, connect elements by whole faces, or use full integration in rows one element wide",
        size(*pivot)
    )]
    NoStiffness { node: u32, direction: &'static str, pivot: f64 },
    #[error("equilibrium error at node {node} in {direction}: {} of the load", size(*residual))]
    Inaccurate { node: u32, direction: &'static str, residual: f64 },
    #[error("material {material}: density 0, expected a mass for dynamics")]
    NoMass { material: u32 },
    #[error("the {what} has {found} values, expected {expected}")]
    Length { what: &'static str, found: usize, expected: usize },
    #[error("not finite: {what} at node {node} in {direction}, t = {time} s")]
    NotFinite { what: &'static str, node: u32, direction: &'static str, time: f64 },
    #[error("material {material} is plastic, not supported by the linear solver; use the nonlinear solver")]
    Plastic { material: u32 },
    #[error(
        "not converged at time {time}: residual {} of the forces after {iterations} iterations; largest at element {element}, integration point {point} (natural coordinates {xi:?}), returned to {region}",
        size(*residual)
    )]
    Diverged {
        time: f64,
        iterations: u32,
        residual: f64,
        element: u32,
        point: u32,
        xi: [f64; 3],
        region: ReturnRegion,
    },
    #[error(
        "{law} failed at time {time}, element {element}, integration point {point}, in the smallest step: {cause}"
    )]
    UserMaterial { time: f64, element: u32, point: u32, law: String, cause: ReturnError },
    #[error("step stopped between two iterations, as requested")]
    Stopped,
    #[error("{what} is {value}, expected {expected}")]
    Option { what: &'static str, value: f64, expected: &'static str },
    #[error("the time step is {dt} s, expected a finite number above 0")]
    TimeStep { dt: f64 },
    #[error("theta is {theta}, expected 0.5 to 1")]
    Theta { theta: f64 },
    #[error(transparent)]
    Newmark(#[from] NewmarkError),
    #[error("mass matrix not converged: residual {residual:.3e} after {iterations} iterations")]
    MassNotSolved { residual: f64, iterations: usize },
    #[error(
        "conjugate gradients not converged: {stopped} (limit {tolerance:.1e}). Increase `solid.equations.tolerance`, or use `method = \"direct\"`."
    )]
    NotConverged { stopped: Stopped, tolerance: f64 },
    #[error(
        "singular stiffness matrix: rigid-body motion of a part of the solid. Add supports; `solid.equations.method = \"direct\"` names a node."
    )]
    Singular,
    #[error(transparent)]
    Analysis(#[from] AnalysisError),
    #[error("{0}")]
    Library(String),
}
