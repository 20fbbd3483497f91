//! Scene tables of solid meshes.

use crate::units::{Length, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[solid.block]`: bricks between grid planes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Grid planes along x.
    pub x: Axis,
    /// Grid planes along y.
    pub y: Axis,
    /// Grid planes along z.
    pub z: Axis,
    /// Start and end of the top along x, for slopes [m]; default box.
    pub crest: Option<[Quantity<Length>; 2]>,
    /// Layers from below; default material 1.
    #[serde(default)]
    pub layer: Vec<Layer>,
}

/// Grid planes along one axis.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// Two or more ascending coordinates [m].
    pub lines: Vec<Quantity<Length>>,
    /// Elements in each interval; ≥ 1, ≤ 20 million in all.
    pub counts: Vec<usize>,
    /// Last over first element length in each interval; default 1; > 0.
    pub ratios: Option<Vec<f64>>,
}

/// A layer of one material.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// Material number.
    pub material: u32,
    /// Height of the top [m]; needed except in the last.
    pub top: Option<Quantity<Length>>,
}

/// Elements with or without mid-side nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// Corners only, fast.
    Linear,
    /// With mid-side nodes, file constraints at corners.
    Quadratic,
}
