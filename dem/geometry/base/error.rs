//! Errors of models and steps, with body, pair and time.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Error of a model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// Quantity is not finite, or zero where zero is invalid.
    #[error("{quantity} of the grains is not a finite number")]
    NotFinite {
        /// Quantity.
        quantity: &'static str,
    },
    /// Invalid material constant.
    #[error("material {material}: {parameter}: found {value}, expected {expected}")]
    Material {
        /// Material index.
        material: usize,
        /// Parameter key.
        parameter: &'static str,
        /// Value found [unit of the parameter].
        value: f64,
        /// Valid values.
        expected: String,
    },
    /// Invalid parameter of a material pair.
    #[error("pair {index} of materials: {parameter}: found {value}, expected {expected}")]
    Pair {
        /// Pair index.
        index: usize,
        /// Parameter key.
        parameter: &'static str,
        /// Value found [unit of the parameter].
        value: f64,
        /// Valid values.
        expected: String,
    },
    /// Material pair without contact law.
    #[error("contact of materials {a} and {b}: {problem}")]
    Law {
        /// First material.
        a: usize,
        /// Second material.
        b: usize,
        /// Problem.
        problem: String,
    },
    /// Index out of range.
    #[error("{owner} {index} names {kind} {found}, but there are {count}")]
    Index {
        /// Owner of the index: "body", "plane", …
        owner: &'static str,
        /// Index of the owner.
        index: usize,
        /// Kind of the referenced object.
        kind: &'static str,
        /// Index found.
        found: usize,
        /// Number of such objects.
        count: usize,
    },
    /// Degenerate shape.
    #[error("shape {shape}: {problem}")]
    Shape {
        /// Shape index.
        shape: usize,
        /// Problem.
        problem: String,
    },
    /// Invalid value of a body.
    #[error("body {body}: {quantity} is {value}; it must {requirement}")]
    Body {
        /// Body index.
        body: usize,
        /// Quantity.
        quantity: &'static str,
        /// Value found.
        value: f64,
        /// Requirement.
        requirement: &'static str,
    },
    /// Degenerate wall.
    #[error("{wall}: {problem}")]
    Wall {
        /// "plane 2", "triangle 7 of surface 0", …
        wall: String,
        /// Problem.
        problem: &'static str,
    },
    /// Body that cannot be absent at the start.
    #[error("body {body} is to be absent at the start, but {problem}")]
    Absent {
        /// Body index.
        body: usize,
        /// Reason.
        problem: &'static str,
    },
    /// Possible contact of two rigid partners.
    #[error(
        "{a} and {b} can be in contact, but both are rigid (infinite stiffness); give one material, or the pair, a stiffness"
    )]
    RigidPair {
        /// First partner.
        a: String,
        /// Second partner.
        b: String,
    },
    /// Time step above the stability limit.
    #[error(
        "time step {dt} s is above the critical time step {limit} s, set by {cause}; reduce it, or allow it explicitly"
    )]
    TimeStep {
        /// Requested time step [s].
        dt: f64,
        /// Critical time step [s].
        limit: f64,
        /// Object that sets the limit.
        cause: String,
    },
    /// Invalid constant of a bond kind.
    #[error("bond kind {kind}: {quantity} is {value}; it must {requirement}")]
    BondKind {
        /// Kind index.
        kind: usize,
        /// Constant.
        quantity: &'static str,
        /// Value found.
        value: f64,
        /// Requirement.
        requirement: &'static str,
    },
    /// Invalid bond.
    #[error("bond {index}: {problem}")]
    Bond {
        /// Bond index.
        index: usize,
        /// Problem.
        problem: String,
    },
    /// Adhesion combined with an unsupported feature.
    #[error("contact override {index} has adhesion, which cannot be combined with {with}")]
    Adhesion {
        /// Override index.
        index: usize,
        /// Unsupported feature.
        with: &'static str,
    },
    /// Invalid periodic axes.
    #[error("periodic axes: {problem}")]
    Periodic {
        /// Problem.
        problem: String,
    },
    /// Invalid setting of the run.
    #[error("{quantity} is {value}; it must {requirement}")]
    StepContext {
        /// Setting.
        quantity: &'static str,
        /// Value found.
        value: f64,
        /// Requirement.
        requirement: &'static str,
    },
}

/// Contact partner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Partner {
    /// Body (index).
    Body(usize),
    /// Plane (index).
    Plane(usize),
    /// Triangle (index over all triangle surfaces).
    Triangle(u32),
    /// Wall without triangles (index over all walls).
    Wall(u32),
    /// Patch of the external surface.
    Patch(u32),
}

impl fmt::Display for Partner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Partner::Body(k) => write!(f, "body {k}"),
            Partner::Plane(k) => write!(f, "plane {k}"),
            Partner::Triangle(k) => write!(f, "triangle {k}"),
            Partner::Wall(k) => write!(f, "wall {k}"),
            Partner::Patch(k) => write!(f, "surface patch {k}"),
        }
    }
}

/// Plain or exponent form, without `inf` and `NaN`.
fn size(value: f64) -> String {
    match value {
        _ if value.is_nan() => "no number".into(),
        _ if value.is_infinite() => "more than 1e308".into(),
        _ if value >= 1e15 => format!("{value:e}"),
        _ => value.to_string(),
    }
}

/// Error of a step. The state is invalid afterwards: return to an earlier copy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// Overlap above the smaller radius: time step too large, contact too soft, or initial overlap.
    #[error(
        "at t = {time:.6e} s: overlap of body {body} and {partner}: {overlap} m (limit {bound} m). Reduce the time step, or increase the contact stiffness."
    )]
    Overlap {
        /// Time [s].
        time: f64,
        /// Body.
        body: usize,
        /// Contact partner.
        partner: Partner,
        /// Overlap [m].
        overlap: f64,
        /// Largest valid overlap [m].
        bound: f64,
    },
    /// Body too fast for contact detection, or its velocity is not a number.
    #[error(
        "at t = {time:.6e} s: speed of body {body}: {} m/s (limit {bound} m/s, half the smallest radius per time step). Reduce the time step.",
        size(*speed)
    )]
    Speed {
        /// Time [s].
        time: f64,
        /// Body.
        body: usize,
        /// Speed [m/s].
        speed: f64,
        /// Limit [m/s].
        bound: f64,
    },
    /// Rigid triangle body too fast for contact detection, or its velocity is not a number.
    #[error(
        "at t = {time:.6e} s: speed of wall {wall}: {} m/s (limit {bound} m/s, half the smallest radius per time step). Reduce the time step.",
        size(*speed)
    )]
    WallSpeed {
        /// Time [s].
        time: f64,
        /// Wall (index over all walls).
        wall: usize,
        /// Largest speed of a point [m/s].
        speed: f64,
        /// Limit [m/s].
        bound: f64,
    },
    /// Overlapping bounding boxes of two round rigid bodies.
    #[error(
        "at t = {time:.6e} s: contact of walls {} and {}: not supported between round rigid bodies. Keep their bounding boxes apart.",
        walls[0],
        walls[1]
    )]
    WallsMeet {
        /// Time [s].
        time: f64,
        /// Walls (indices over all walls).
        walls: [usize; 2],
    },
    /// Overlap of two walls above the limit.
    #[error(
        "at t = {time:.6e} s: overlap of walls {} and {}: {overlap:e} m (limit {bound:e} m). Increase the contact stiffness, or `rounding`.",
        walls[0],
        walls[1]
    )]
    WallsOverlap {
        /// Time [s].
        time: f64,
        /// Walls (indices over all walls).
        walls: [usize; 2],
        /// Overlap of one contact [m].
        overlap: f64,
        /// Limit [m].
        bound: f64,
    },
    /// Device does not respond, or is out of memory.
    #[error("at t = {time:.6e} s: GPU failed: {problem}")]
    Device {
        /// Time [s].
        time: f64,
        /// Problem.
        problem: String,
    },
    /// Rank does not respond, or failed.
    #[error("at t = {time:.6e} s: rank {rank} lost: {problem}")]
    Rank {
        /// Time [s].
        time: f64,
        /// Rank.
        rank: usize,
        /// Problem.
        problem: String,
    },
    /// Applied force on an unknown body, or not finite.
    #[error("at t = {time:.6e} s: applied force {index} (body {body}): no such body, or not finite")]
    Applied {
        /// Time [s].
        time: f64,
        /// Index of the applied force.
        index: usize,
        /// Body.
        body: usize,
    },
    /// Surface without a material in the model.
    #[error("surface without a material in the model (surface_material)")]
    SurfaceMaterial,
    /// Surface with other triangles than the model.
    #[error("surface with other triangles than the model's (surface_mesh)")]
    SurfaceMesh,
    /// State or workspace of another model.
    #[error("state of {found} bodies for a model of {expected} bodies")]
    Mismatch {
        /// Bodies of the model.
        expected: usize,
        /// Bodies of the state.
        found: usize,
    },
}
