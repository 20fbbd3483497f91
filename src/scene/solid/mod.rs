//! The solid part as written in a scene.

mod analysis;
mod boundary;
mod material;
mod mesh;

pub use analysis::{
    Dynamics, EquationMethod, Equations, InitialStress, InitialStressMethod, LinearSolver, Newton,
    NewtonVariant, QuasiStatic, Rayleigh, Reduction, ReductionKind, StrengthReduction,
};
pub use boundary::{Absorbing, Side, Support};
pub use material::{Cone, MaterialFault, MaterialModel, SolidMaterial};
pub use mesh::{Axis, Block, Layer, Order};

use super::history::History;
use super::units::{Force, Length, Quantity, Stress};
use crate::read::ListLayout;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// `[solid]`: a mesh, its materials, supports and loads, and how it is solved.
///
/// The mesh comes from `mesh` (any mesh file), from `nodes` and `elements` (ANSYS lists), or from `block`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// Mesh file (`.cdb`, `.msh`, `.inp`, `.vtu`, `.vtk`) or a folder with the three lists; relative to the scene.
    pub mesh: Option<PathBuf>,
    /// Node list, `id x y z`; path relative to the scene file.
    pub nodes: Option<PathBuf>,
    /// Element list, `id mat n1 … n20` in SOLID186 order.
    pub elements: Option<PathBuf>,
    /// Constraint list, `node dir value`.
    pub constraints: Option<PathBuf>,
    /// Factor from the lengths of the mesh's files to metres, such as 0.001 for millimetres; default 1.
    pub scale: Option<f64>,
    /// Columns of the lists, where their number alone does not tell.
    pub layout: Option<ListLayout>,
    /// A block of bricks made on the spot.
    pub block: Option<Block>,
    /// Elements with or without mid-side nodes; default as the mesh has them.
    pub order: Option<Order>,
    /// Integration rule of the stiffness; default `reduced`.
    #[serde(default)]
    pub integration: Integration,
    /// Volume strain of quadratic elements; default `pointwise`.
    pub dilatation: Option<Dilatation>,
    /// Whether 8-node hexahedra have incompatible modes; default true.
    pub incompatible_modes: Option<bool>,
    /// Mass matrix; default `consistent`.
    #[serde(default)]
    pub mass: Mass,
    /// One entry per material number of the element list.
    #[serde(default)]
    pub material: Vec<SolidMaterial>,
    /// Whether gravity acts on the solid; default true.
    #[serde(default = "super::yes")]
    pub gravity: bool,
    /// Supports, beside those of the mesh file.
    #[serde(default)]
    pub support: Vec<Support>,
    /// Boundaries that let waves out.
    #[serde(default)]
    pub absorbing: Vec<Absorbing>,
    /// Stress before the run; default none.
    pub initial_stress: Option<InitialStress>,
    /// Dynamics; without it a solid alone is solved statically. A coupled solid is always dynamic.
    pub dynamics: Option<Dynamics>,
    /// Equilibrium in steps of a pseudo-time.
    pub quasi_static: Option<QuasiStatic>,
    /// Factor of safety by strength reduction.
    pub strength_reduction: Option<StrengthReduction>,
    /// How equilibrium is found in a plastic solid.
    pub newton: Option<Newton>,
    /// How the equations of an elastic solid are solved; default by their size.
    pub equations: Option<Equations>,
    /// Rayleigh damping C = α M + β K; default none.
    pub rayleigh: Option<Rayleigh>,
    /// Reduction of an elastic solid under grains; default none.
    pub reduction: Option<Reduction>,
    /// Loads on the solid.
    #[serde(default)]
    pub load: Vec<SolidLoad>,
}

/// Mass matrix of the solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Mass {
    /// ∫ ρ Nₐ N_b dV.
    #[default]
    Consistent,
    /// Its diagonal, scaled to the mass of the element.
    Lumped,
}

/// Integration rule of the element stiffness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Integration {
    /// 2 × 2 × 2 points, the default of SOLID186.
    #[default]
    Reduced,
    /// Irons' 14 points, the "full" rule of SOLID186.
    Irons14,
    /// 3 × 3 × 3 points.
    Full,
}

/// How quadratic elements take their volume strain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Dilatation {
    /// At the points of the rule.
    #[default]
    Pointwise,
    /// Averaged over the element.
    Mean,
}

/// A load on the solid.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidLoad {
    /// What it is.
    pub kind: SolidLoadKind,
    /// Faces of `pressure` and `traction` as pairs [element number, face from 1].
    pub faces: Option<Vec<[u32; 2]>>,
    /// Instead of `faces`: all boundary faces whose centre lies in this box [m], [[x, y, z] low, high].
    pub faces_in: Option<[[Quantity<Length>; 3]; 2]>,
    /// Instead of `faces`: all boundary faces on this side of the bounding box.
    pub side: Option<Side>,
    /// Instead of `faces`: all boundary faces whose nodes belong to this node set of the mesh file.
    pub set: Option<String>,
    /// Pressure [Pa]; positive compresses.
    pub pressure: Option<Quantity<Stress>>,
    /// Traction vector [Pa].
    pub traction: Option<[Quantity<Stress>; 3]>,
    /// Node number of a `point` load.
    pub node: Option<u32>,
    /// Place of a `point` load [m]: the point of the solid's surface or inside it, loaded through the shape
    /// functions.
    pub at: Option<[Quantity<Length>; 3]>,
    /// Force of a `point` load [N].
    pub force: Option<[Quantity<Force>; 3]>,
    /// How the load varies in time; default constant.
    pub history: Option<History>,
}

/// Kind of a load on the solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SolidLoadKind {
    /// Normal pressure on faces.
    Pressure,
    /// Traction vector on faces.
    Traction,
    /// Force at a node or a point.
    Point,
}
