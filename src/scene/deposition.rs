//! Settling of filled grains as written in a scene.

use super::units::{Length, Quantity, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[deposition]`: the filled grains fall and come to rest before the run proper.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Deposition {
    /// Longest time [s].
    pub max_time: Quantity<Time>,
    /// Settled when the root-mean-square speed of the grains stays below this [m/s]; default 5 mm/s.
    pub settled_speed: Option<Quantity<Velocity>>,
    /// Settled when instead the mean unbalanced force over the mean contact force is below this, above 0 and below 1.
    pub unbalanced_ratio: Option<f64>,
    /// Parts that the grains are dropped in, each on the settled ones before, 1 to 1000; default 1: all at once.
    #[serde(default = "one")]
    pub layers: u32,
    /// Friction between grains while they settle, instead of their own: lower packs denser.
    pub friction: Option<f64>,
    /// Contact stiffness while they settle, as a share of their own; default 1. Lower takes longer steps.
    pub stiffness_factor: Option<f64>,
    /// Local non-viscous damping while they settle, 0–1; default 0.
    #[serde(default)]
    pub local_damping: f64,
    /// Grains whose centre lies above this height are taken away after settling [m]: a levelled bed.
    pub level: Option<Quantity<Length>>,
}

fn one() -> u32 {
    1
}
