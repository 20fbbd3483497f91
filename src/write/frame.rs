//! What a result file shows of one moment, as plain arrays: the solid, the grains, the contacts, the walls.

use super::choice::Choice;
use trackbed_fem::mesh::Mesh;

/// One moment of a run. A part that the run has not, or that no writer shows, is absent.
#[derive(Clone, Copy, Debug, Default)]
pub struct Frame<'a> {
    /// Number of the frame, from 0.
    pub number: usize,
    /// Simulated time [s].
    pub time: f64,
    /// Fields of the solid and of the grains that are written.
    pub fields: Choice<'a>,
    /// The solid.
    pub solid: Option<SolidFrame<'a>>,
    /// The grains, one item per sphere.
    pub grains: Option<&'a GrainFrame>,
    /// The contacts of the grains.
    pub chains: Option<&'a ChainFrame>,
    /// Walls and sleepers.
    pub walls: Option<&'a WallFrame>,
}

/// The solid at one moment. Coordinates are those of the undeformed mesh: warp by `displacement` to deform.
#[derive(Clone, Copy, Debug)]
pub struct SolidFrame<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Displacement [m]. Shape `[3 * nodes]`.
    pub displacement: &'a [f64],
    /// Velocity [m/s]. Shape `[3 * nodes]`.
    pub velocity: &'a [f64],
    /// Stress at the nodes, tension positive: xx, yy, zz, xy, yz, zx [Pa]. Shape `[nodes]`.
    pub stress: &'a [[f64; 6]],
    /// Von Mises stress at the nodes [Pa]. Shape `[nodes]`.
    pub von_mises: &'a [f64],
    /// Equivalent plastic strain at the nodes [1]. Shape `[nodes]`.
    pub equivalent_plastic_strain: &'a [f64],
    /// Yield function at the nodes, negative inside the surface [Pa]. Shape `[nodes]`.
    pub yield_function: &'a [f64],
    /// Tensors at the nodes that not every frame has, by name: xx, yy, zz, xy, yz, zx. Shape `[nodes]` each.
    pub tensors: &'a [(&'static str, Vec<[f64; 6]>)],
}

/// The grains at one moment: one item per sphere, the spheres of a clump with the `id` of their body.
/// `position` and every field have the shape `[spheres]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GrainFrame {
    /// Centre of the sphere [m].
    pub position: Vec<[f64; 3]>,
    /// Fields by name, as [`super::BODY_FIELDS`] lists them.
    pub fields: Vec<(&'static str, Values)>,
}

/// The values of a field.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Three numbers for each item.
    Vectors(Vec<[f64; 3]>),
    /// Four numbers for each item: a quaternion w, x, y, z.
    Quaternions(Vec<[f64; 4]>),
    /// A number for each item.
    Numbers(Vec<f64>),
    /// A whole number for each item.
    Counts(Vec<u32>),
}

/// Number of a partner that is no body: a wall, the solid.
pub const NO_BODY: u32 = u32::MAX;

/// The contacts at one moment. Every field has the shape `[contacts]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChainFrame {
    /// Centres of the two partners, or centre and contact point [m].
    pub ends: Vec<[[f64; 3]; 2]>,
    /// Normal force, compression positive [N].
    pub normal_force: Vec<f64>,
    /// Magnitude of the tangential force [N].
    pub tangential_force: Vec<f64>,
    /// Kind of contact, as the run numbers it.
    pub kind: Vec<u32>,
    /// 1 where the normal force is above the mean of all contacts, else 0.
    pub strong: Vec<u32>,
    /// Numbers of the two partners, as `id` of the grains; [`NO_BODY`] for what is no body.
    pub partners: Vec<[u32; 2]>,
}

/// The walls at one moment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WallFrame {
    /// Corner points [m].
    pub points: Vec<[f64; 3]>,
    /// Corners of each polygon, as indices of `points`.
    pub polygons: Vec<Vec<u32>>,
    /// Number of the wall that each polygon belongs to. Shape `[polygons]`.
    pub id: Vec<u32>,
    /// What each polygon is part of, a [`WallKind`] as its number. Shape `[polygons]`.
    pub kind: Vec<u32>,
    /// Fields of grains with faces by name, as those of [`GrainFrame`], for each polygon; zero for those of other things. None without such
    /// grains.
    pub grains: Vec<(&'static str, Values)>,
}

/// What a polygon of a [`WallFrame`] is part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallKind {
    /// A plane, which has no end: shown as a square as wide as the grains.
    Plane = 0,
    /// Any other wall.
    Wall = 1,
    /// A box: a rigid sleeper, a plate.
    Box = 2,
    /// A rail.
    Rail = 3,
    /// A grain with faces.
    Stone = 4,
}
