//! Groups of grains as written in a scene.

use super::units::{Length, Quantity, Spin, Velocity};
use serde::Deserialize;
use std::path::PathBuf;

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
