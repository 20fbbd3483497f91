//! Water as written in a scene.

use super::units::{Angle, Density, Length, Quantity, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[water]`: water below a level, still, streaming or with waves; grains float, sink and drift in it, while they settle too.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Water {
    /// Height of still water [m]; default 0.
    #[serde(default = "nothing")]
    pub level: Quantity<Length>,
    /// Density [kg/m³]; default 1000.
    #[serde(default = "fresh")]
    pub density: Quantity<Density>,
    /// Depth of still water [m], which waves feel; default deeper than that. No bed: grains need a wall there.
    pub depth: Option<Quantity<Length>>,
    /// Velocity along x and y [m/s]; default still.
    #[serde(default = "still")]
    pub current: [Quantity<Velocity>; 2],
    /// Waves; default none.
    pub wave: Option<Wave>,
    /// Drag coefficient [-] of `drag_area`.
    pub drag: f64,
    /// Area that drag belongs to; default what the wet part shows to the flow.
    #[serde(default)]
    pub drag_area: DragArea,
    /// Drag coefficient of the whole wet surface beside it [-]; default 0.
    #[serde(default)]
    pub skin_drag: f64,
    /// Coefficient of the moment that brakes turning [-]; default 0.1.
    #[serde(default = "turning")]
    pub drag_moment: f64,
    /// Mass of water that a grain takes along, over that of its wet volume [-]; default 0.
    #[serde(default)]
    pub added_mass: f64,
}

/// Regular waves.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// From trough to crest [m].
    pub height: Quantity<Length>,
    /// Period, as seen from a fixed place [s]; this or `length`.
    pub period: Option<Quantity<Time>>,
    /// From crest to crest [m]; this or `period`.
    pub length: Option<Quantity<Length>>,
    /// Where it runs, from x to y [rad]; default along x.
    #[serde(default = "ahead")]
    pub direction: Quantity<Angle>,
    /// Phase at the origin at the start [rad]; default 0, a crest.
    #[serde(default = "ahead")]
    pub phase: Quantity<Angle>,
}

/// Area that drag belongs to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DragArea {
    /// What the wet part shows to the flow.
    #[default]
    Projected,
    /// The whole wet surface.
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
