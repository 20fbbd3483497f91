//! Run-out as written in a scene.

use super::units::{Length, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[runout]`: how far a slide runs and what it leaves.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Runout {
    /// Direction of the slide in plan, any length but zero.
    pub direction: [f64; 2],
    /// Groups that slide; default all that are not gripped by `motion`.
    pub groups: Option<Vec<String>>,
    /// Side of the cells of the depth map [m]; default twice the mean diameter.
    pub cell: Option<Quantity<Length>>,
    /// Depth above which a cell belongs to the deposit [m]; default half the mean diameter.
    pub depth: Option<Quantity<Length>>,
    /// Share of the mass, from behind, at which the front is taken; 0.5–1, default 0.99.
    pub share: Option<f64>,
}
