//! The mesh of a solid as written in a scene.

use crate::scene::units::{Length, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[solid.block]`: bricks between grid planes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Grid along x.
    pub x: Axis,
    /// Grid along y.
    pub y: Axis,
    /// Grid along z.
    pub z: Axis,
    /// Where the top begins and ends along x [m]: an embankment or a slope with straight sides. Default: a box.
    pub crest: Option<[Quantity<Length>; 2]>,
    /// Materials by layers from below; the last reaches the top. Default: material 1 everywhere.
    #[serde(default)]
    pub layer: Vec<Layer>,
}

/// Grid planes along one axis.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Ascending coordinates [m] that become grid planes.
    pub lines: Vec<Quantity<Length>>,
    /// Number of elements between each two of them.
    pub counts: Vec<usize>,
    /// Length of the last element over that of the first, for each interval; default 1.
    pub ratios: Option<Vec<f64>>,
}

/// A layer of one material.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// Material number.
    pub material: u32,
    /// Height of its top [m]; elements with their centre below it (and above the layer beneath) belong to it.
    pub top: Option<Quantity<Length>>,
}

/// Elements with or without mid-side nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// Corners only: 8-node hexahedra with mean dilatation and their companions.
    Linear,
    /// With mid-side nodes: 20-node hexahedra and their companions.
    Quadratic,
}
