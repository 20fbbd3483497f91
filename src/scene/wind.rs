//! Air or another fluid that streams past grains, as written in a scene.

use super::units::{Density, Quantity, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[wind]`: a fluid with one velocity everywhere, which drags grains along or holds them back during the run proper.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wind {
    /// Velocity [m/s]; default still.
    #[serde(default = "still")]
    pub velocity: [Quantity<Velocity>; 3],
    /// Density [kg/m³]; default 1.225, dry air of 15 °C at sea level (ISO 2533).
    #[serde(default = "air")]
    pub density: Quantity<Density>,
    /// Drag coefficient of the sphere of a grain's volume [-].
    pub drag: f64,
}

fn still() -> [Quantity<Velocity>; 3] {
    [Quantity::new(0.0), Quantity::new(0.0), Quantity::new(0.0)]
}
fn air() -> Quantity<Density> {
    Quantity::new(1.225)
}
