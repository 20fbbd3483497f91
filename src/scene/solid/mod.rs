//! Scene table `[solid]`.

mod analysis;
mod boundary;
mod material;
mod mesh;
mod user_material;

pub use analysis::{
    Dynamics, EquationMethod, Equations, InitialStress, InitialStressMethod, LinearSolver, Newton,
    NewtonVariant, QuasiStatic, Rayleigh, Reduction, ReductionKind, StrengthReduction,
};
pub use boundary::{Absorbing, Side, Support};
pub use material::{Cone, MaterialFault, MaterialModel, SolidMaterial};
pub use mesh::{Axis, Block, Layer, Order};
pub use user_material::{EnergySource, RoutineThreads, TangentSource, UserState, UserTable};

use super::history::History;
use super::units::{Force, Length, Quantity, Stress, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;
use trackbed_io::read::ListLayout;

/// `[solid]`: a mesh, its materials, supports and loads, and how it is solved.
///
/// The mesh comes from `mesh` (any mesh file), from `nodes` and `elements` (ANSYS lists), or from `block`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// Mesh file (`.cdb`, `.msh`, `.inp`, `.vtu`, `.vtk`), or directory of the three lists; or `nodes`, `block`.
    #[schemars(extend("format" = "path"))]
    pub mesh: Option<PathBuf>,
    /// Node list `id x y z` [m]; or `mesh`.
    #[schemars(extend("format" = "path"))]
    pub nodes: Option<PathBuf>,
    /// Element list `id material n1 … n20`, SOLID186 order; with `nodes`.
    #[schemars(extend("format" = "path"))]
    pub elements: Option<PathBuf>,
    /// Constraint list `node direction value` (1, 2, 3, `UX`, `UY`, `UZ`, `ALL`; value 0 if absent) [m]; default none; with `nodes`.
    #[schemars(extend("format" = "path"))]
    pub constraints: Option<PathBuf>,
    /// Factor from file lengths to metres, displacements too; default 1; > 0 (0.001 for mm).
    pub scale: Option<f64>,
    /// Columns of the lists; default recognised.
    pub layout: Option<ListLayout>,
    /// Generated hexahedra; or `mesh`.
    pub block: Option<Block>,
    /// Order of elements; default of the mesh.
    pub order: Option<Order>,
    /// Integration rule; default `"reduced"`.
    #[serde(default)]
    pub integration: Integration,
    /// Volumetric strain of quadratic elements; default `"pointwise"`.
    pub dilatation: Option<Dilatation>,
    /// Whether 8-node hexahedra have bending modes; default true.
    pub incompatible_modes: Option<bool>,
    /// Mass matrix; default `"consistent"`.
    #[serde(default)]
    pub mass: Mass,
    /// Materials.
    #[serde(default)]
    pub material: Vec<SolidMaterial>,
    /// Boxes with another material than in the mesh; default none.
    #[serde(default)]
    pub region: Vec<SolidRegion>,
    /// Whether gravity acts on the solid; default true.
    #[serde(default = "super::yes")]
    pub gravity: bool,
    /// Supports.
    #[serde(default)]
    pub support: Vec<Support>,
    /// Absorbing boundaries.
    #[serde(default)]
    pub absorbing: Vec<Absorbing>,
    /// Initial stress; default none.
    pub initial_stress: Option<InitialStress>,
    /// Time integration; or `quasi_static`, `strength_reduction`.
    pub dynamics: Option<Dynamics>,
    /// Equilibrium in steps; or `dynamics`.
    pub quasi_static: Option<QuasiStatic>,
    /// Factor of safety; or `dynamics`.
    pub strength_reduction: Option<StrengthReduction>,
    /// Iteration of plastic solids.
    pub newton: Option<Newton>,
    /// Solver of elastic solids; default by size.
    pub equations: Option<Equations>,
    /// Rayleigh damping; default none.
    pub rayleigh: Option<Rayleigh>,
    /// Reduced model under grains; default none.
    pub reduction: Option<Reduction>,
    /// Loads.
    #[serde(default)]
    pub load: Vec<SolidLoad>,
}

/// Mass matrix of the solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mass {
    /// Consistent.
    #[default]
    Consistent,
    /// Scaled diagonal.
    Lumped,
}

/// Integration rule of the element stiffness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Integration {
    /// 2 × 2 × 2 points.
    #[default]
    Reduced,
    /// 14 points.
    Irons14,
    /// 3 × 3 × 3 points.
    Full,
}

/// Volumetric strain of quadratic elements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Dilatation {
    /// Pointwise.
    #[default]
    Pointwise,
    /// Average, for ν ≥ 0.49 and plastic flow without `"reduced"` hexahedra.
    Mean,
}

/// A load on the solid.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidLoad {
    /// Kind of load.
    pub kind: SolidLoadKind,
    /// Faces `[[element, face], …]`, numbered as SOLID186; or `faces_in`, `side`, `set`; with `"pressure"`, `"traction"`.
    pub faces: Option<Vec<[u32; 2]>>,
    /// Box `[low, high]` of face centres [m]; or `faces`.
    pub faces_in: Option<[[Quantity<Length>; 3]; 2]>,
    /// Side of the bounding box; or `faces`.
    pub side: Option<Side>,
    /// Face set, or node set around faces; or `faces`.
    pub set: Option<String>,
    /// Pressure, compression positive [Pa]; with `"pressure"`.
    pub pressure: Option<Quantity<Stress>>,
    /// Traction vector [Pa]; with `"traction"`.
    pub traction: Option<[Quantity<Stress>; 3]>,
    /// Node number; or `at`; with `"point"`.
    pub node: Option<u32>,
    /// Point of the solid [m]; or `node`; with `"point"`.
    pub at: Option<[Quantity<Length>; 3]>,
    /// Force vector, with `"moving"` of each axle [N]; with `"point"`, `"moving"`.
    pub force: Option<[Quantity<Force>; 3]>,
    /// Start and end of the line on the solid [m]; with `"moving"`.
    pub path: Option<[[Quantity<Length>; 3]; 2]>,
    /// Speed along `path` [m/s]; > 0; with `"moving"`.
    pub speed: Option<Quantity<Velocity>>,
    /// Time at which the first axle enters [s]; default 0; with `"moving"`.
    pub start: Option<Quantity<Time>>,
    /// Distances behind the first axle, ascending from 0 [m]; default `[0]`; with `"moving"`.
    pub axles: Option<Vec<Quantity<Length>>>,
    /// Length and width that spread the force [m]; default a point; with `"moving"`.
    pub size: Option<[Quantity<Length>; 2]>,
    /// Time history; default constant.
    pub history: Option<History>,
}

/// `[[solid.region]]`: elements with their centre in a box have another material.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidRegion {
    /// Box `[low, high]` of element centres [m].
    #[serde(rename = "box")]
    pub bounds: [[Quantity<Length>; 3]; 2],
    /// Number of a `[[solid.material]]`.
    pub material: u32,
}

/// Kind of a load on the solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SolidLoadKind {
    /// Normal to faces.
    Pressure,
    /// On faces.
    Traction,
    /// Force.
    Point,
    /// Forces that move along a line.
    Moving,
}
