//! Scene table of air or another fluid flowing past grains.

use super::units::{Density, Quantity, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[wind]`: a fluid with one velocity everywhere, which drags grains along or holds them back during the main stage.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wind {
    /// Velocity of the fluid [m/s]; default `[0, 0, 0]`; ≤ 1000.
    #[serde(default = "still")]
    pub velocity: [Quantity<Velocity>; 3],
    /// Density of the fluid [kg/m³]; default 1.225; > 0, ≤ 20,000.
    #[serde(default = "air")]
    pub density: Quantity<Density>,
    /// Drag coefficient C, sphere of equal volume; > 0, ≤ 100.
    pub drag: f64,
}

fn still() -> [Quantity<Velocity>; 3] {
    [Quantity::new(0.0), Quantity::new(0.0), Quantity::new(0.0)]
}
fn air() -> Quantity<Density> {
    Quantity::new(1.225)
}
