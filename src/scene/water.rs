//! Scene tables of water.

use super::units::{Angle, Density, Length, Quantity, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[water]`: water below a level, still, streaming or with waves; grains float, sink and drift in it, while they settle too.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Water {
    /// Level of still water [m]; default 0.
    #[serde(default = "nothing")]
    pub level: Quantity<Length>,
    /// Density (sea water 1025) [kg/m³]; default 1000; > 0, ≤ 20,000.
    #[serde(default = "fresh")]
    pub density: Quantity<Density>,
    /// Depth that waves feel, without bed [m]; default deep; > 0; with `wave`.
    pub depth: Option<Quantity<Length>>,
    /// Velocity `[x, y]` of the current [m/s]; default `[0, 0]`; ≤ 20.
    #[serde(default = "still")]
    pub current: [Quantity<Velocity>; 2],
    /// Linear (Airy) wave; default none.
    pub wave: Option<Wave>,
    /// Drag coefficient on `drag_area` (floes 0.6); 0–100.
    pub drag: f64,
    /// Drag area; default `"projected"`.
    #[serde(default)]
    pub drag_area: DragArea,
    /// Drag coefficient of the wet surface (ice 0.001–0.005); default 0; 0–100.
    #[serde(default)]
    pub skin_drag: f64,
    /// Coefficient of the moment against rotation; default 0.1; 0–100.
    #[serde(default = "turning")]
    pub drag_moment: f64,
    /// Added mass over wet volume's, translation only (sphere 0.5); default 0; 0–100.
    #[serde(default)]
    pub added_mass: f64,
}

/// Regular waves.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// Height from trough to crest [m]; > 0, ≤ 0.142 L tanh kh.
    pub height: Quantity<Length>,
    /// Period at a fixed position [s]; or `length`; > 0.
    pub period: Option<Quantity<Time>>,
    /// Wavelength L [m]; or `period`; > 0.
    pub length: Option<Quantity<Length>>,
    /// Direction, from x to y [rad]; default 0.
    #[serde(default = "ahead")]
    pub direction: Quantity<Angle>,
    /// Phase at origin and start, 0 crest [rad]; default 0.
    #[serde(default = "ahead")]
    pub phase: Quantity<Angle>,
}

/// Area that drag belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DragArea {
    /// Wet part seen by the flow.
    #[default]
    Projected,
    /// Whole wet surface, tenfold for floes.
    Wetted,
}

fn nothing() -> Quantity<Length> {
    Quantity::new(0.0)
}
fn fresh() -> Quantity<Density> {
    Quantity::new(1000.0)
}
fn still() -> [Quantity<Velocity>; 2] {
    [Quantity::new(0.0), Quantity::new(0.0)]
}
fn ahead() -> Quantity<Angle> {
    Quantity::new(0.0)
}
fn turning() -> f64 {
    0.1
}
