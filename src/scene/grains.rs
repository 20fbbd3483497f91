//! Grains, their materials and walls as written in a scene.

use super::units::{Density, Length, Quantity, Spin, Stiffness, Time, Velocity};
use serde::Deserialize;
use std::path::PathBuf;

/// `[[material]]`: linear spring–dashpot contact with Coulomb friction.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GrainMaterial {
    /// Name by which groups and walls refer to it.
    pub name: String,
    /// Density [kg/m³]; needed by materials of grains and sleepers.
    pub density: Option<Quantity<Density>>,
    /// Contact stiffness of a like pair [N/m]; absent: rigid (a contact with it is twice as stiff as a like pair).
    pub stiffness: Option<Quantity<Stiffness>>,
    /// Tangential over normal stiffness, 0–1; default 0.5.
    #[serde(default = "super::half")]
    pub tangential_ratio: f64,
    /// Tangential over normal damping coefficient, 0–1; default 0.
    #[serde(default)]
    pub tangential_damping_ratio: f64,
    /// Coulomb friction coefficient, 0 or more.
    pub friction: f64,
    /// Coefficient of restitution, above 0 and at most 1.
    pub restitution: f64,
}

/// `[[contact]]`: constants of one pair of materials.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PairContact {
    /// Names of the two materials (twice the same for a like pair).
    pub between: [String; 2],
    /// Friction coefficient of the pair.
    pub friction: Option<f64>,
    /// Restitution of the pair.
    pub restitution: Option<f64>,
    /// Normal stiffness of the pair [N/m].
    pub stiffness: Option<Quantity<Stiffness>>,
}

/// `[[grains]]`: a group of grains.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grains {
    /// Name for reports.
    pub name: String,
    /// Shape of the grains.
    pub shape: GrainShape,
    /// Name of their material.
    pub material: String,
    /// Stone library of `clump` grains.
    pub library: Option<PathBuf>,
    /// Spheres by hand: `[[x, y, z, r], …]` [m].
    pub spheres: Option<Vec<[Quantity<Length>; 4]>>,
    /// Spheres from a CSV file with columns x, y, z, r.
    pub packing: Option<PathBuf>,
    /// Number of grains to fill in.
    pub count: Option<usize>,
    /// Sizes of filled grains from a sieve table.
    pub gradation: Option<GradationSource>,
    /// Instead of a gradation: smallest and largest size [m], uniform in number.
    pub size: Option<[Quantity<Length>; 2]>,
    /// Box that filled grains start in: [[x, y, z] low, [x, y] high]; they are stacked upwards as high as needed.
    pub fill: Option<FillBox>,
    /// Seed of the random sizes, places and orientations; default 1.
    #[serde(default = "one")]
    pub seed: u64,
    /// Initial velocity [m/s].
    pub velocity: Option<[Quantity<Velocity>; 3]>,
    /// Initial angular velocity [rad/s].
    pub spin: Option<[Quantity<Spin>; 3]>,
}

fn one() -> u64 {
    1
}

/// Shape of a group of grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GrainShape {
    /// Single spheres.
    Sphere,
    /// Rigid clumps from a stone library.
    Clump,
}

/// A row set of a gradation table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GradationSource {
    /// CSV file with columns standard, grade, sieve_mm, passing_lo_pct, passing_hi_pct.
    pub file: PathBuf,
    /// Value of the column `standard`.
    pub standard: String,
    /// Value of the column `grade`.
    pub grade: String,
    /// Factor on all sieve sizes; default 1.
    #[serde(default = "unity")]
    pub scale: f64,
}

fn unity() -> f64 {
    1.0
}

/// Where filled grains start.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FillBox {
    /// Lower corner [m].
    pub low: [Quantity<Length>; 3],
    /// Upper corner in x and y [m].
    pub high: [Quantity<Length>; 2],
}

/// `[[walls]]`: a plane or a set of triangles.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Kind of wall.
    pub kind: WallKind,
    /// Name of its material.
    pub material: String,
    /// A point of a `plane` [m].
    pub point: Option<[Quantity<Length>; 3]>,
    /// Normal of a `plane`, towards the grains.
    pub normal: Option<[f64; 3]>,
    /// Vertices of `triangles` [m].
    pub vertices: Option<Vec<[Quantity<Length>; 3]>>,
    /// Vertex numbers of `triangles`, counted from 0.
    pub triangles: Option<Vec<[u32; 3]>>,
    /// Constant velocity [m/s]; default at rest.
    pub velocity: Option<[Quantity<Velocity>; 3]>,
}

/// Kind of a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WallKind {
    /// Infinite plane, one-sided.
    Plane,
    /// Triangles, two-sided.
    Triangles,
}

/// `[deposition]`: the filled grains fall and come to rest before the run proper.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Deposition {
    /// Longest time [s].
    pub max_time: Quantity<Time>,
    /// Settled when the root-mean-square speed of the grains stays below this [m/s]; default 5 mm/s.
    #[serde(default = "slow")]
    pub settled_speed: Quantity<Velocity>,
    /// Friction between grains while they settle, instead of their own: lower packs denser.
    pub friction: Option<f64>,
    /// Local non-viscous damping while they settle, 0–1; default 0.
    #[serde(default)]
    pub local_damping: f64,
    /// Grains whose centre lies above this height are taken away after settling [m]: a levelled bed.
    pub level: Option<Quantity<Length>>,
}

fn slow() -> Quantity<Velocity> {
    Quantity::new(5e-3)
}
