//! Scene table of the deposition of filled grains.

use super::units::{Length, Quantity, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[deposition]`: the filled grains fall and come to rest before the main stage.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Deposition {
    /// Longest duration, then a warning [s]; > 0.
    pub max_time: Quantity<Time>,
    /// Root-mean-square speed at rest [m/s]; default 0.005; > 0.
    pub settled_speed: Option<Quantity<Velocity>>,
    /// Mean unbalanced over contact force at rest, for or with `settled_speed`; default none; > 0, < 1.
    pub unbalanced_ratio: Option<f64>,
    /// Equal parts dropped successively, `max_time` each; default 1; 1–1000.
    #[serde(default = "one")]
    pub layers: u32,
    /// Friction between grains: lower packs denser; default unchanged; ≥ 0.
    pub friction: Option<f64>,
    /// Factor on contact stiffness, not corner strength; default 1; > 0, ≤ 1.
    pub stiffness_factor: Option<f64>,
    /// Non-viscous damping, above 0.4 with shorter steps; default 0; ≥ 0, < 1.
    #[serde(default)]
    pub local_damping: f64,
    /// Height above which centres are removed afterwards [m]; default none.
    pub level: Option<Quantity<Length>>,
}

fn one() -> u32 {
    1
}
