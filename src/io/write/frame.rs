//! Plain arrays of a run's state, for result files.

use super::choice::Choice;
use std::borrow::Cow;
use trackbed_fem::mesh::Mesh;

/// Snapshot; absent parts are `None`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Frame<'a> {
    /// Index from 0.
    pub number: usize,
    /// Simulated time [s].
    pub time: f64,
    /// Selected fields.
    pub fields: Choice<'a>,
    /// Solid.
    pub solid: Option<&'a SolidFrame<'a>>,
    /// Grains, one item per sphere.
    pub grains: Option<&'a GrainFrame>,
    /// Grain contacts.
    pub chains: Option<&'a ChainFrame>,
    /// Walls and sleepers.
    pub walls: Option<&'a WallFrame>,
}

/// Solid in undeformed coordinates; add `displacement` for the deformed shape.
#[derive(Clone, Debug)]
pub struct SolidFrame<'a> {
    /// Mesh.
    pub mesh: &'a Mesh,
    /// Nodal fields by name, see [`super::SOLID_FIELDS`]; all writers take theirs from here.
    pub fields: Vec<(&'static str, NodalValues<'a>)>,
}

/// Values of a nodal field.
#[derive(Clone, Debug)]
pub enum NodalValues<'a> {
    /// Number per node.
    Numbers(Cow<'a, [f64]>),
    /// Three numbers per node. Shape `[3 * nodes]`.
    Vectors(Cow<'a, [f64]>),
    /// Symmetric tensor per node: xx, yy, zz, xy, yz, zx.
    Tensors(Cow<'a, [[f64; 6]]>),
}

impl<'a> SolidFrame<'a> {
    /// Returns the integers per element by name.
    pub fn element_fields(&self) -> [(&'static str, &'a [u32]); 2] {
        [("material", &self.mesh.materials), ("element_id", &self.mesh.element_ids)]
    }
}

/// Grains, one item per sphere, with the `id` of its body. Shape of all arrays `[spheres]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GrainFrame {
    /// Sphere centre [m].
    pub position: Vec<[f64; 3]>,
    /// Fields by name, see [`super::BODY_FIELDS`].
    pub fields: Vec<(&'static str, Values)>,
}

/// Values of a field.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Three numbers per item.
    Vectors(Vec<[f64; 3]>),
    /// Quaternion w, x, y, z per item.
    Quaternions(Vec<[f64; 4]>),
    /// Number per item.
    Numbers(Vec<f64>),
    /// Integer per item.
    Counts(Vec<u32>),
}

/// Partner without body: wall, solid.
pub const NO_BODY: u32 = u32::MAX;

/// Contacts. Every field has the shape `[contacts]`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChainFrame {
    /// Centres of both partners, or centre and contact [m].
    pub ends: Vec<[[f64; 3]; 2]>,
    /// Normal force, compression positive [N].
    pub normal_force: Vec<f64>,
    /// Magnitude of the tangential force [N].
    pub tangential_force: Vec<f64>,
    /// Contact kind of the run.
    pub kind: Vec<u32>,
    /// 1 if the normal force exceeds the mean, else 0.
    pub strong: Vec<u32>,
    /// Grain `id` of both partners, or [`NO_BODY`].
    pub partners: Vec<[u32; 2]>,
}

/// Walls as polygons.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WallFrame {
    /// Points [m].
    pub points: Vec<[f64; 3]>,
    /// Corner indices of each polygon in `points`.
    pub polygons: Vec<Vec<u32>>,
    /// Wall id. Shape `[polygons]`.
    pub id: Vec<u32>,
    /// [`WallKind`] as number. Shape `[polygons]`.
    pub kind: Vec<u32>,
    /// Fields of polyhedral grains by name, per polygon; zero for others.
    pub grains: Vec<(&'static str, Values)>,
}

/// Object of a [`WallFrame`] polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WallKind {
    /// Infinite plane, drawn as a square.
    Plane = 0,
    /// Other wall.
    Wall = 1,
    /// Box: rigid sleeper, plate.
    Box = 2,
    /// Rail.
    Rail = 3,
    /// Polyhedral grain.
    Stone = 4,
}
