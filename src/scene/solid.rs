//! The solid part as written in a scene.

use super::history::History;
use super::units::{Density, Force, Frequency, Length, Quantity, Rate, Stress, Time};
use crate::read::ListLayout;
use serde::Deserialize;
use std::path::PathBuf;

/// `[solid]`: a mesh of 20-node hexahedra from three ANSYS lists, its materials and loads.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Solid {
    /// Node list, `id x y z`; path relative to the scene file.
    pub nodes: PathBuf,
    /// Element list, `id mat n1 … n20` in SOLID186 order.
    pub elements: PathBuf,
    /// Constraint list, `node dir value`.
    pub constraints: Option<PathBuf>,
    /// Columns of the lists, where their number alone does not tell.
    #[serde(default)]
    pub layout: ListLayout,
    /// Integration rule of the stiffness; default `reduced`.
    #[serde(default)]
    pub integration: Integration,
    /// One entry per material number of the element list.
    #[serde(default)]
    pub material: Vec<SolidMaterial>,
    /// Whether gravity acts on the solid; default true.
    #[serde(default = "super::yes")]
    pub gravity: bool,
    /// Dynamics; without it a solid alone is solved statically. A coupled solid is always dynamic.
    pub dynamics: Option<Dynamics>,
    /// Rayleigh damping C = α M + β K; default none.
    pub rayleigh: Option<Rayleigh>,
    /// Loads on the solid.
    #[serde(default)]
    pub load: Vec<SolidLoad>,
}

/// Integration rule of the element stiffness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
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

/// Linear elastic material of the solid.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidMaterial {
    /// Material number of the element list.
    pub id: u32,
    /// Name for reports.
    #[serde(default)]
    pub name: String,
    /// Young's modulus [Pa], above 0.
    pub young: Quantity<Stress>,
    /// Poisson's ratio, above −1 and below 0.5.
    pub poisson: f64,
    /// Density [kg/m³], above 0.
    pub density: Quantity<Density>,
}

/// Newmark's method for a solid that runs alone.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Dynamics {
    /// Newmark α (β elsewhere); default 0.25.
    #[serde(default = "quarter")]
    pub alpha: f64,
    /// Newmark δ (γ elsewhere); default 0.5.
    #[serde(default = "super::half")]
    pub delta: f64,
    /// Accept α and δ that are not unconditionally stable; default false.
    #[serde(default)]
    pub accept_conditional_stability: bool,
}

fn quarter() -> f64 {
    0.25
}

/// Rayleigh damping, by its coefficients or by a damping ratio at two frequencies.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rayleigh {
    /// Coefficient of the mass [1/s].
    pub alpha_m: Option<Quantity<Rate>>,
    /// Coefficient of the stiffness [s].
    pub beta_k: Option<Quantity<Time>>,
    /// Damping ratio at both `frequencies`, 0–1.
    pub damping_ratio: Option<f64>,
    /// The two frequencies [Hz].
    pub frequencies: Option<[Quantity<Frequency>; 2]>,
}

/// A load on the solid.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidLoad {
    /// What it is.
    pub kind: SolidLoadKind,
    /// Faces of `pressure` and `traction` as pairs [element number, SOLID186 face 1–6].
    pub faces: Option<Vec<[u32; 2]>>,
    /// Instead of `faces`: all boundary faces whose centre lies in this box [m], [[x, y, z] low, high].
    pub faces_in: Option<[[Quantity<Length>; 3]; 2]>,
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SolidLoadKind {
    /// Normal pressure on faces.
    Pressure,
    /// Traction vector on faces.
    Traction,
    /// Force at a node or a point.
    Point,
}
