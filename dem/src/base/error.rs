//! What can go wrong, with the body, pair and time it happened at.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Why a model cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// A quantity of the model is beyond what a number holds, or 0 where it must not be.
    #[error("{quantity} of the grains is not a finite number")]
    NotFinite {
        /// Name of the quantity.
        quantity: &'static str,
    },
    /// A material constant is out of range.
    #[error("material {material}: {parameter}: found {value}, expected {expected}")]
    Material {
        /// Index of the material.
        material: usize,
        /// Key of the parameter.
        parameter: &'static str,
        /// Value found, in the unit of the parameter.
        value: f64,
        /// Valid values.
        expected: String,
    },
    /// A parameter of a pair of materials is out of range.
    #[error("pair {index} of materials: {parameter}: found {value}, expected {expected}")]
    Pair {
        /// Index of the pair.
        index: usize,
        /// Key of the parameter.
        parameter: &'static str,
        /// Value found, in the unit of the parameter.
        value: f64,
        /// Valid values.
        expected: String,
    },
    /// Two materials have no law of contact.
    #[error("contact of materials {a} and {b}: {problem}")]
    Law {
        /// One material.
        a: usize,
        /// The other.
        b: usize,
        /// What is wrong.
        problem: String,
    },
    /// An index points nowhere.
    #[error("{owner} {index} names {kind} {found}, but there are {count}")]
    Index {
        /// What holds the index: "body", "plane", …
        owner: &'static str,
        /// Its own index.
        index: usize,
        /// What the index should name.
        kind: &'static str,
        /// The index found.
        found: usize,
        /// How many there are.
        count: usize,
    },
    /// A shape is degenerate.
    #[error("shape {shape}: {problem}")]
    Shape {
        /// Index of the shape.
        shape: usize,
        /// What is wrong.
        problem: String,
    },
    /// A body's value is out of range.
    #[error("body {body}: {quantity} is {value}; it must {requirement}")]
    Body {
        /// Index of the body.
        body: usize,
        /// Name of the value.
        quantity: &'static str,
        /// The value found.
        value: f64,
        /// What it must satisfy.
        requirement: &'static str,
    },
    /// A wall is degenerate.
    #[error("{wall}: {problem}")]
    Wall {
        /// "plane 2", "triangle 7 of surface 0", …
        wall: String,
        /// What is wrong.
        problem: &'static str,
    },
    /// A body cannot be absent at the start.
    #[error("body {body} is to be absent at the start, but {problem}")]
    Absent {
        /// Index of the body.
        body: usize,
        /// Why it cannot.
        problem: &'static str,
    },
    /// Two rigid partners may touch.
    #[error(
        "{a} and {b} can be in contact, but both are rigid (infinite stiffness); give one material, or the pair, a stiffness"
    )]
    RigidPair {
        /// One partner.
        a: String,
        /// The other.
        b: String,
    },
    /// The time step is above the stability limit.
    #[error(
        "time step {dt} s is above the critical time step {limit} s, set by {cause}; reduce it, or allow it explicitly"
    )]
    TimeStep {
        /// The step asked for [s].
        dt: f64,
        /// The limit [s].
        limit: f64,
        /// What sets the limit.
        cause: String,
    },
    /// A constant of a kind of bond is out of range.
    #[error("bond kind {kind}: {quantity} is {value}; it must {requirement}")]
    BondKind {
        /// Index of the kind.
        kind: usize,
        /// Name of the constant.
        quantity: &'static str,
        /// The value found.
        value: f64,
        /// What it must satisfy.
        requirement: &'static str,
    },
    /// A bond cannot be made.
    #[error("bond {index}: {problem}")]
    Bond {
        /// Index of the bond.
        index: usize,
        /// What is wrong.
        problem: String,
    },
    /// Adhesion cannot be combined with something.
    #[error("contact override {index} has adhesion, which cannot be combined with {with}")]
    Adhesion {
        /// Index of the override.
        index: usize,
        /// With what.
        with: &'static str,
    },
    /// Periodic axes cannot be as asked for.
    #[error("periodic axes: {problem}")]
    Periodic {
        /// What is wrong.
        problem: String,
    },
    /// A setting of the run is out of range.
    #[error("{quantity} is {value}; it must {requirement}")]
    Setting {
        /// Name of the setting.
        quantity: &'static str,
        /// The value found.
        value: f64,
        /// What it must satisfy.
        requirement: &'static str,
    },
}

/// One side of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Partner {
    /// A body (index).
    Body(usize),
    /// A plane (index).
    Plane(usize),
    /// A triangle (index over all triangle surfaces in order).
    Triangle(u32),
    /// A wall that has no triangles (index over all walls in order).
    Wall(u32),
    /// A patch of the external surface.
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

/// Why a step failed. The state is then not fit to go on from: return to an earlier copy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// Two partners overlap by more than the smaller radius: the time step is too large, the contact too soft,
    /// or the scene starts with bodies inside each other.
    #[error(
        "at t = {time:.6e} s: overlap of body {body} and {partner}: {overlap} m (limit {bound} m). Reduce the time step, or increase the contact stiffness."
    )]
    Overlap {
        /// Time [s].
        time: f64,
        /// The body.
        body: usize,
        /// What it touches.
        partner: Partner,
        /// The overlap [m].
        overlap: f64,
        /// The largest overlap that has a meaning [m].
        bound: f64,
    },
    /// A body moves so fast that contacts would be missed, or its velocity is not a number.
    #[error(
        "at t = {time:.6e} s: speed of body {body}: {speed} m/s (limit {bound} m/s, half the smallest radius per time step). Reduce the time step."
    )]
    Speed {
        /// Time [s].
        time: f64,
        /// The body.
        body: usize,
        /// Its speed [m/s].
        speed: f64,
        /// The bound [m/s].
        bound: f64,
    },
    /// A rigid triangle body moves so fast that contacts would be missed, or its velocity is not a number.
    #[error(
        "at t = {time:.6e} s: speed of wall {wall}: {speed} m/s (limit {bound} m/s, half the smallest radius per time step). Reduce the time step."
    )]
    WallSpeed {
        /// Time [s].
        time: f64,
        /// The wall, counted through.
        wall: usize,
        /// The largest speed of its points [m/s].
        speed: f64,
        /// The bound [m/s].
        bound: f64,
    },
    /// Two round bodies of walls have come within each other's bounds.
    #[error(
        "at t = {time:.6e} s: contact of walls {} and {}: not supported between round rigid bodies. Keep their bounding boxes apart.",
        walls[0],
        walls[1]
    )]
    WallsMeet {
        /// Time [s].
        time: f64,
        /// The walls, counted through.
        walls: [usize; 2],
    },
    /// Two walls overlap by more than contacts are meant for.
    #[error(
        "at t = {time:.6e} s: overlap of walls {} and {}: {overlap:e} m (limit {bound:e} m). Increase the contact stiffness, or `rounding`.",
        walls[0],
        walls[1]
    )]
    WallsOverlap {
        /// Time [s].
        time: f64,
        /// The walls, counted through.
        walls: [usize; 2],
        /// Overlap of one contact [m].
        overlap: f64,
        /// The bound [m].
        bound: f64,
    },
    /// The device that computes the steps does not respond, or has no memory left.
    #[error("at t = {time:.6e} s: GPU failed: {problem}")]
    Device {
        /// Time [s].
        time: f64,
        /// What went wrong.
        problem: String,
    },
    /// A rank that computes a part of the steps does not respond, or cannot.
    #[error("at t = {time:.6e} s: rank {rank} lost: {problem}")]
    Rank {
        /// Time [s].
        time: f64,
        /// Number of the rank.
        rank: usize,
        /// What is known.
        problem: String,
    },
    /// An applied force names no body, or is not finite.
    #[error("at t = {time:.6e} s: applied force {index} (body {body}): no such body, or not finite")]
    Applied {
        /// Time [s].
        time: f64,
        /// Index of the applied force.
        index: usize,
        /// The body it names.
        body: usize,
    },
    /// A surface is given, but the model has no material for it.
    #[error("surface without a material in the model (surface_material)")]
    SurfaceMaterial,
    /// The surface is not made of the triangles that the model has of it.
    #[error("surface with other triangles than the model's (surface_mesh)")]
    SurfaceMesh,
    /// State or work belongs to another model.
    #[error("state of {found} bodies for a model of {expected} bodies")]
    Mismatch {
        /// Bodies of the model.
        expected: usize,
        /// Bodies of the state.
        found: usize,
    },
}
