//! Groups of grains as written in a scene.

use super::units::{Length, Quantity, Spin, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// `[[grains]]`: a group of grains.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grains {
    /// Name for reports.
    pub name: String,
    /// Shape of the grains.
    pub shape: GrainShape,
    /// Name of their material.
    pub material: String,
    /// Stone library of `clump`, `bonded` and `polyhedron` grains.
    pub library: Option<PathBuf>,
    /// Spheres by hand: `[[x, y, z, r], …]` [m].
    pub spheres: Option<Vec<[Quantity<Length>; 4]>>,
    /// Grains of an earlier run from a CSV file: spheres as x, y, z, r; clumps and polyhedra as x, y, z, qw, qx, qy, qz, scale, stone.
    pub packing: Option<PathBuf>,
    /// Equal spheres on a lattice.
    pub lattice: Option<LatticeFill>,
    /// A field of ice floes.
    pub floes: Option<Floes>,
    /// One body: a pile or a cone with flat sides.
    pub frustum: Option<Frustum>,
    /// Container that grains are scattered in, or grown in.
    pub region: Option<Region>,
    /// Share of the container's volume that scattered grains fill, in place of `count`.
    pub concentration: Option<f64>,
    /// Thickness of `disk` grains over their diameter, above 0 and below 1.
    pub aspect: Option<f64>,
    /// Growth of the grains in a `region` to a porosity.
    pub growth: Option<GrowthSource>,
    /// Number of grains to fill in.
    pub count: Option<usize>,
    /// Sizes of filled grains from a sieve table.
    pub gradation: Option<GradationSource>,
    /// Instead of a gradation: smallest and largest size [m], uniform in number.
    pub size: Option<[Quantity<Length>; 2]>,
    /// Instead of a gradation: a law of sizes.
    pub sizes: Option<Sizes>,
    /// Box that filled grains start in: [[x, y, z] low, [x, y] high]; they are stacked upwards as high as needed.
    pub fill: Option<FillBox>,
    /// Seed of the random sizes, places and orientations; default 1.
    #[serde(default = "one")]
    pub seed: u64,
    /// Name of the `[[bond]]` that holds `bonded` stones, or the floes of a sheet, together.
    pub bond: Option<String>,
    /// Velocity that the grains keep whatever the forces, without turning: a grip [m/s]. They stand while others settle.
    pub motion: Option<[Quantity<Velocity>; 3]>,
    /// Whether the mean place of the grains and the force on them go to `history.csv`; default: with `motion`.
    pub record: Option<bool>,
    /// Where and how fast grains of the group come in during the run proper.
    pub inlet: Option<super::flow::Inlet>,
    /// Whether these grains foul the bed: fines in the voids of the others; default false.
    #[serde(default)]
    pub fouling: bool,
    /// Whether these grains may overlap at the start by more than a tenth of a radius, as prestressed ones do; default false.
    #[serde(default)]
    pub accept_overlap: bool,
    /// Initial velocity [m/s].
    pub velocity: Option<[Quantity<Velocity>; 3]>,
    /// Initial angular velocity [rad/s].
    pub spin: Option<[Quantity<Spin>; 3]>,
}

fn one() -> u64 {
    1
}

/// Shape of a group of grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GrainShape {
    /// Single spheres.
    Sphere,
    /// Rigid clumps from a stone library.
    Clump,
    /// Stones of bonded spheres from a stone library, which can break.
    Bonded,
    /// Dilated polyhedra: of a stone library, ice floes, or a frustum.
    Polyhedron,
    /// Dilated disks: flat and round, with a rounded rim.
    Disk,
}

/// A row set of a gradation table.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
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
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FillBox {
    /// Lower corner [m].
    pub low: [Quantity<Length>; 3],
    /// Upper corner in x and y [m].
    pub high: [Quantity<Length>; 2],
}

/// Equal spheres on a lattice.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LatticeFill {
    /// Kind of lattice.
    pub kind: LatticeKind,
    /// Diameter of the spheres [m].
    pub size: Quantity<Length>,
    /// Lower corner of the box around the lattice [m].
    pub low: [Quantity<Length>; 3],
    /// Upper corner [m]: as many spheres as fit.
    pub high: Option<[Quantity<Length>; 3]>,
    /// In place of `high`: number of columns, rows and layers.
    pub counts: Option<[usize; 3]>,
}

/// A field of ice floes: prisms from the Voronoi cells of random sites in a box, each made smaller about its centroid; or round ones.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Floes {
    /// Lower corner of the box in x and y [m].
    pub low: [Quantity<Length>; 2],
    /// Upper corner [m].
    pub high: [Quantity<Length>; 2],
    /// Of polyhedra: number of cells, 1 to 100000.
    pub count: Option<usize>,
    /// Area of the floes, before their corners are rounded, over that of the box; above 0 and below 1. Of disks: over that of the box less the
    /// circles that are clear.
    pub concentration: Option<f64>,
    /// Of polyhedra, instead: distance between neighbouring floes [m].
    pub gap: Option<Quantity<Length>>,
    /// Of polyhedra: how often sites are moved to the centroids of their cells, which makes floes alike; 0 to 10000, default 0.
    pub relax: Option<usize>,
    /// Thickness [m]: of polyhedra above twice the radius, of disks below their diameter.
    pub thickness: Quantity<Length>,
    /// Of polyhedra: radius that edges and corners are rounded with [m]. Disks are rounded with half of their thickness.
    pub radius: Option<Quantity<Length>>,
    /// Height of the mid-plane [m]; default 0.
    pub elevation: Option<Quantity<Length>>,
    /// Circles that floes must not reach: `[[x, y, r], …]` [m].
    #[serde(default)]
    pub clear: Vec<[Quantity<Length>; 3]>,
}

/// A frustum with regular ends.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Frustum {
    /// Middle of one end [m].
    pub from: [Quantity<Length>; 3],
    /// Middle of the other end [m].
    pub to: [Quantity<Length>; 3],
    /// Radius at `from` and at `to` [m], the mean of those of the inscribed and the circumscribed circle.
    pub radii: [Quantity<Length>; 2],
    /// Number of sides, 6 to 32; default 24.
    pub sides: Option<usize>,
    /// Radius that edges and corners are rounded with [m]; default a tenth of the smaller of `radii`.
    pub radius: Option<Quantity<Length>>,
}

/// Kind of a lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LatticeKind {
    /// Simple cubic.
    Loose,
    /// Hexagonal close packed.
    Hexagonal,
    /// Face-centred cubic.
    FaceCentred,
}

/// A container: one of its keys.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Corners of a box along the axes [m].
    #[serde(rename = "box")]
    pub cuboid: Option<[[Quantity<Length>; 3]; 2]>,
    /// A cylinder or a cut cone.
    pub cone: Option<ConeRegion>,
    /// File of a closed triangle surface: STL, OBJ, or lists of vertices and triangles.
    pub surface: Option<PathBuf>,
    /// With `surface`: factor on its coordinates; default 1.
    pub scale: Option<f64>,
    /// With `surface`: displacement after scaling [m]; default none.
    pub shift: Option<[Quantity<Length>; 3]>,
}

/// A cylinder or a cone that is cut off at both ends.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConeRegion {
    /// Middle of one end [m].
    pub from: [Quantity<Length>; 3],
    /// Middle of the other end [m].
    pub to: [Quantity<Length>; 3],
    /// Radius at `from` and at `to` [m].
    pub radii: [Quantity<Length>; 2],
}

/// Growth of grains to a porosity.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrowthSource {
    /// Porosity of the container at the end, above 0 and below 1.
    pub porosity: f64,
    /// Rounds of growing and relaxing, 1 to 1000; default 20.
    pub rounds: Option<usize>,
    /// Friction while growing, 0 or more; default 0.
    pub friction: Option<f64>,
    /// Unbalanced-force ratio that ends the last relaxation, above 0 and below 1; default 1e-3.
    pub unbalanced_ratio: Option<f64>,
}

/// A law of sizes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "snake_case", deny_unknown_fields)]
pub enum Sizes {
    /// All alike.
    Equal {
        /// The size [m].
        size: Quantity<Length>,
    },
    /// Two sizes.
    Two {
        /// The small size [m].
        small: Quantity<Length>,
        /// The large size [m].
        large: Quantity<Length>,
        /// Share of the large grains in the volume of all, 0 to 1.
        large_share: f64,
    },
    /// Uniform between two sizes.
    Uniform {
        /// Smallest [m].
        low: Quantity<Length>,
        /// Largest [m].
        high: Quantity<Length>,
        /// Whether equal steps of size hold equal number (default) or equal volume.
        #[serde(default)]
        by: Share,
    },
    /// Normal in number, cut at both ends.
    Normal {
        /// Mean before cutting [m].
        mean: Quantity<Length>,
        /// Standard deviation before cutting [m].
        deviation: Quantity<Length>,
        /// Smallest [m].
        low: Quantity<Length>,
        /// Largest [m].
        high: Quantity<Length>,
    },
    /// Log-normal in number, cut at both ends.
    LogNormal {
        /// Median before cutting [m].
        median: Quantity<Length>,
        /// Standard deviation of the natural logarithm of the size before cutting.
        deviation: f64,
        /// Smallest [m].
        low: Quantity<Length>,
        /// Largest [m].
        high: Quantity<Length>,
    },
}

/// What a uniform law is uniform in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Share {
    /// Number of grains.
    #[default]
    Number,
    /// Volume of grains.
    Volume,
}
