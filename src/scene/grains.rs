//! Scene tables of grain groups.

use super::units::{Length, Mass, Quantity, Spin, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

/// `[[grains]]`: a group of grains.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grains {
    /// Name in reports.
    pub name: String,
    /// Shape (and sources).
    pub shape: GrainShape,
    /// Name of a `[[material]]` with density.
    pub material: String,
    /// Stone library; with `"clump"`, `"bonded"`, `"polyhedron"`; not with `floes`, `frustum`.
    #[schemars(extend("format" = "path"))]
    pub library: Option<PathBuf>,
    /// Spheres `[[x, y, z, r], …]` [m]; or another source; > 0 (r).
    pub spheres: Option<Vec<[Quantity<Length>; 4]>>,
    /// CSV file as of `output.packing`; or another source; columns `x, y, z, r` or `x, y, z, qw, qx, qy, qz, scale, stone` (disks:
    /// diameter, 0).
    #[schemars(extend("format" = "path"))]
    pub packing: Option<PathBuf>,
    /// Regular packing of spheres; or another source.
    pub lattice: Option<LatticeFill>,
    /// Field of ice floes; or another source.
    pub floes: Option<Floes>,
    /// Pile or cone, a polyhedron; or another source.
    pub frustum: Option<Frustum>,
    /// Net or geogrid of bonded spheres; or another source.
    pub net: Option<Net>,
    /// Container with grains at random; or another source.
    pub region: Option<Region>,
    /// Solid fraction, 0.3 at random positions; or `count`; > 0, < 1; with `region`; not with `growth`.
    pub solid_fraction: Option<f64>,
    /// Thickness over diameter; > 0, < 1; with `"disk"`; not with `floes`.
    pub aspect: Option<f64>,
    /// Radius expansion to a porosity; default none; with `region`.
    pub growth: Option<GrowthSource>,
    /// Number of grains; or `solid_fraction`, `target_height`, `target_mass`; 1–10,000,000; with `fill`, `region`, only an `inlet` (queue); optional with `growth`.
    pub count: Option<usize>,
    /// Sieve table; or `size`, `sizes`; with `fill`, `region`, only an `inlet`, floes of disks.
    pub gradation: Option<GradationSource>,
    /// Smallest and largest size, uniform in number [m]; or `gradation`; > 0.
    pub size: Option<[Quantity<Length>; 2]>,
    /// Law of sizes; or `gradation`.
    pub sizes: Option<Sizes>,
    /// Box with a contact-free stack up to 200 m; or another source.
    pub fill: Option<FillBox>,
    /// Expected height of the settled bed above its floor [m]; or `count`; > 0, ≤ 200; with `fill`.
    pub target_height: Option<Quantity<Length>>,
    /// Total mass, met within one grain [kg]; or `count`; > 0; with `fill`.
    pub target_mass: Option<Quantity<Mass>>,
    /// Expected porosity of the settled bed; default 0.4, more between walls; > 0, < 1; with `fill`.
    pub porosity: Option<f64>,
    /// Seed of sizes, positions, orientations; default 1.
    #[serde(default = "one")]
    pub seed: u64,
    /// Name of a `[[bond]]`; default none; with `"bonded"` (needed), polyhedral `floes`, `net`.
    pub bond: Option<String>,
    /// Without rotation, 0 during deposition [m/s]; default free.
    pub prescribed_velocity: Option<[Quantity<Velocity>; 3]>,
    /// Whether mean position and force are recorded; default true with `prescribed_velocity`.
    pub record: Option<bool>,
    /// Insertion during the run; default none.
    pub inlet: Option<super::flow::Inlet>,
    /// Whether grains are fines in voids, for the summary; default false.
    #[serde(default)]
    pub fouling: bool,
    /// Whether initial overlaps may exceed 10 % of a radius; default false.
    #[serde(default)]
    pub accept_overlap: bool,
    /// Initial velocity [m/s]; default at rest; not with `prescribed_velocity`.
    pub velocity: Option<[Quantity<Velocity>; 3]>,
    /// Initial angular velocity [rad/s]; default none; not with `prescribed_velocity`.
    pub spin: Option<[Quantity<Spin>; 3]>,
}

fn one() -> u64 {
    1
}

/// Shape of a group of grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GrainShape {
    /// Sphere.
    Sphere,
    /// Rigid cluster of spheres (`fill`, `region`, `packing`).
    Clump,
    /// Breakable cluster of spheres (`fill`).
    Bonded,
    /// Dilated convex body (`fill`, `region`, `packing`, `floes`, `frustum`).
    Polyhedron,
    /// Flat round body (`fill`, `region`, `packing`, `floes`).
    Disk,
}

/// A row set of a gradation table.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GradationSource {
    /// CSV file: `standard`, `grade`, `sieve_mm`, `passing_lo_pct`, `passing_hi_pct`; limits averaged.
    #[schemars(extend("format" = "path"))]
    pub file: PathBuf,
    /// Value of that column, without regard to blanks, dashes, case.
    pub standard: String,
    /// Value of that column, likewise.
    pub grade: String,
    /// Factor on sieve sizes; default 1; > 0.
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
    /// Lower corner `[x, y, z]` [m].
    pub low: [Quantity<Length>; 3],
    /// Upper corner `[x, y]` [m].
    pub high: [Quantity<Length>; 2],
}

/// Equal spheres on a lattice.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LatticeFill {
    /// Packing, and its porosity.
    pub kind: LatticeKind,
    /// Diameter [m]; > 0.
    pub size: Quantity<Length>,
    /// Lower corner of the box [m].
    pub low: [Quantity<Length>; 3],
    /// Upper corner of the box [m]; or `counts`.
    pub high: Option<[Quantity<Length>; 3]>,
    /// Numbers of columns, rows, layers; or `high`.
    pub counts: Option<[usize; 3]>,
}

/// Rectangular meshes of spheres along ribs. Groups of equal meshes, place and bond form one net. Sides: `"start"`, `"end"` along; `"left"`, `"right"` across.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Net {
    /// Corner between `"start"` and `"left"` [m].
    pub corner: [Quantity<Length>; 3],
    /// Vector of the first side [m].
    pub along: [Quantity<Length>; 3],
    /// Vector of the second side [m]; with meshes across.
    pub across: Option<[Quantity<Length>; 3]>,
    /// Numbers of meshes along and across; ≥ 1, ≥ 0 (0: one strand).
    pub meshes: [usize; 2],
    /// Spheres per rib, one node included; default 1; 1–100.
    pub spheres_per_rib: Option<usize>,
    /// Radius of spheres [m]; > 0, ≤ half their distance.
    pub radius: Quantity<Length>,
    /// Sides that the group consists of; default all spheres.
    #[serde(default)]
    pub only: Vec<NetSide>,
    /// Sides left out; default none.
    #[serde(default)]
    pub without: Vec<NetSide>,
}

/// Side of a net.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NetSide {
    /// Start of `along`.
    Start,
    /// End of `along`.
    End,
    /// Start of `across`.
    Left,
    /// End of `across`.
    Right,
}

/// A field of ice floes: prisms from the Voronoi cells of random sites in a box, each made smaller about its centroid; or round ones.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Floes {
    /// Lower corner `[x, y]` of the field [m].
    pub low: [Quantity<Length>; 2],
    /// Upper corner `[x, y]` [m]; > `low`.
    pub high: [Quantity<Length>; 2],
    /// Number of Voronoi cells; 1–100,000; with `"polyhedron"`.
    pub count: Option<usize>,
    /// Floe area before rounding over field area, disks without `clear`; or `gap`; > 0, < 1 (disks 0.75).
    pub concentration: Option<f64>,
    /// Distance between neighbours [m]; or `concentration`; > 0; with `"polyhedron"`.
    pub gap: Option<Quantity<Length>>,
    /// Moves to cell centroids: uniform floes; default 0; 0–10,000; with `"polyhedron"`.
    pub relax: Option<usize>,
    /// Thickness [m]; > 2 `radius`, of disks < smallest diameter.
    pub thickness: Quantity<Length>,
    /// Rounding radius, of disks half thickness [m]; > 0; with `"polyhedron"`.
    pub radius: Option<Quantity<Length>>,
    /// Height of the mid-plane [m]; default 0.
    pub elevation: Option<Quantity<Length>>,
    /// Circles `[[x, y, r], …]` without floes [m]; default none; ≥ 0 (r).
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
    /// Mean of inscribed, circumscribed radius at `from`, `to` [m]; > 0.
    pub radii: [Quantity<Length>; 2],
    /// Number of sides; default 24; 6–32.
    pub sides: Option<usize>,
    /// Rounding radius of edges [m]; default tenth of smaller; > 0, < half the length.
    pub radius: Option<Quantity<Length>>,
}

/// Kind of a lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LatticeKind {
    /// Simple cubic, 0.4764.
    Loose,
    /// 0.2595.
    Hexagonal,
    /// 0.2595.
    FaceCentred,
}

/// A container: one of its keys.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// Box `[low, high]` [m]; or `cone`, `surface`.
    #[serde(rename = "box")]
    pub cuboid: Option<[[Quantity<Length>; 3]; 2]>,
    /// Cylinder or cut cone; or `box`.
    pub cone: Option<ConeRegion>,
    /// File of a closed surface, or mesh; or `box`.
    #[schemars(extend("format" = "path"))]
    pub surface: Option<PathBuf>,
    /// Factor on coordinates; default 1; > 0; with `surface`.
    pub scale: Option<f64>,
    /// Shift after scaling [m]; default none; with `surface`.
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
    /// Radii at `from` and `to` [m]; ≥ 0, one > 0.
    pub radii: [Quantity<Length>; 2],
}

/// Growth of grains to a porosity.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrowthSource {
    /// Final porosity of the container; > 0, < 1; `count` scales sizes.
    pub porosity: f64,
    /// Growth steps, each relaxed; default 20; 1–1000.
    pub rounds: Option<usize>,
    /// Friction meanwhile: more packs looser; default 0; ≥ 0.
    pub friction: Option<f64>,
    /// Final unbalanced over contact force, means; default 1e-3; > 0, < 1.
    pub unbalanced_ratio: Option<f64>,
}

/// A law of sizes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "snake_case", deny_unknown_fields)]
pub enum Sizes {
    /// One size.
    Monodisperse {
        /// Size [m].
        size: Quantity<Length>,
    },
    /// Two sizes.
    Bidisperse {
        /// Small size [m].
        small: Quantity<Length>,
        /// Large size [m].
        large: Quantity<Length>,
        /// Volume fraction of large grains; 0–1.
        large_share: f64,
    },
    /// Uniform.
    Uniform {
        /// Smallest size [m].
        low: Quantity<Length>,
        /// Largest size [m].
        high: Quantity<Length>,
        /// Distributed quantity; default `"number"`.
        #[serde(default)]
        by: Share,
    },
    /// In number, truncated.
    Normal {
        /// Mean [m].
        mean: Quantity<Length>,
        /// Standard deviation [m].
        deviation: Quantity<Length>,
        /// Smallest size [m].
        low: Quantity<Length>,
        /// Largest size [m].
        high: Quantity<Length>,
    },
    /// In number, truncated.
    LogNormal {
        /// Median [m].
        median: Quantity<Length>,
        /// Standard deviation of ln(size).
        deviation: f64,
        /// Smallest size [m].
        low: Quantity<Length>,
        /// Largest size [m].
        high: Quantity<Length>,
    },
}

/// What a uniform law is uniform in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Share {
    /// Number.
    #[default]
    Number,
    /// Volume.
    Volume,
}
