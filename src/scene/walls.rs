//! Walls as written in a scene.

use super::units::{Length, Quantity, Velocity};
use serde::Deserialize;

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
