//! Scene table of run-out.

use super::units::{Length, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[runout]`: how far a slide runs and what it leaves.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Runout {
    /// Direction in plan `[x, y]`.
    pub direction: [f64; 2],
    /// Names of sliding groups; default all without `prescribed_velocity`.
    pub groups: Option<Vec<String>>,
    /// Cell of the depth map [m]; default twice mean diameter; > 0.
    pub cell: Option<Quantity<Length>>,
    /// Whether cells that grains pass are written to `passage.csv`; default false; with `cell`.
    #[serde(default)]
    pub passage: bool,
    /// Smallest depth of the deposit [m]; default half mean diameter; > 0.
    pub depth: Option<Quantity<Length>>,
    /// Mass fraction behind the front; default 0.99; 0.5–1.
    pub share: Option<f64>,
}
