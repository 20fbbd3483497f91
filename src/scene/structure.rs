//! Scene tables of structures with recorded loads.

use super::units::{Angle, Density, Force, Length, Quantity, Stress, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[[structure]]`: walls and groups of grains that stand for one structure; the load on it goes to `history.csv`, whole, by sectors around a
/// vertical axis, and by height.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Structure {
    /// Prefix of columns, each once.
    pub name: String,
    /// Names of groups and walls (planes recorded); at most one rigid body.
    pub parts: Vec<String>,
    /// Position `[x, y]` of the fixed axis [m].
    pub axis: [Quantity<Length>; 2],
    /// Height that moments refer to [m]; default 0.
    pub foot: Option<Quantity<Length>>,
    /// Sectors of equal angle, from x towards y; default 0; 0–360.
    pub sectors: Option<usize>,
    /// Ascending heights between layers [m]; default none.
    pub levels: Option<Vec<Quantity<Length>>>,
    /// Statistics of the horizontal load, warning levels; default none.
    pub hazard: Option<Hazard>,
}

/// Statistics of the horizontal load on a structure: exceedance, peaks with a fitted law, loads of return periods, warning levels.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hazard {
    /// Load above which peaks are fitted [N]; > 0.
    pub threshold: Quantity<Force>,
    /// Ascending loads whose exceedance is recorded [N]; default none; > 0.
    pub loads: Option<Vec<Quantity<Force>>>,
    /// Shortest time below the threshold between two peaks [s]; default 0; ≥ 0.
    pub separation: Option<Quantity<Time>>,
    /// Beginning of the statistics [s]; default 0; ≥ 0.
    pub start: Option<Quantity<Time>>,
    /// Law of the peaks; default `"weibull"`.
    #[serde(default)]
    pub law: PeakLaw,
    /// Confidence of the intervals; default 0.9; > 0, < 1.
    pub confidence: Option<f64>,
    /// Time in ice per year [s]; > 0; with `return_periods`.
    pub exposure: Option<Quantity<Time>>,
    /// Return periods in years; default none; > 0; with `exposure`.
    pub return_periods: Option<Vec<f64>>,
    /// Load of the amber warning [N]; default none; > 0.
    pub amber: Option<Quantity<Force>>,
    /// Load of the red warning [N]; default none; > `amber`.
    pub red: Option<Quantity<Force>>,
    /// Level ice whose load is the reference; default none.
    pub level_ice: Option<LevelIce>,
}

/// Law of peaks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PeakLaw {
    /// Of the excess over the threshold.
    #[default]
    Weibull,
    /// Of the peaks.
    Gumbel,
}

/// Level ice: crushing with `strength`, bending on a cone with `flexural_strength`, or on a ship with `hull` too.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelIce {
    /// Ice thickness [m]; > 0.
    pub thickness: Quantity<Length>,
    /// Width at the waterline [m]; > 0.
    pub width: Quantity<Length>,
    /// Strength coefficient of crushing after ISO 19906 [Pa]; or `flexural_strength`; > 0.
    pub strength: Option<Quantity<Stress>>,
    /// Flexural strength [Pa]; or `strength`; > 0.
    pub flexural_strength: Option<Quantity<Stress>>,
    /// Slope of the cone from the horizontal [rad]; > 0, < π/2; with `flexural_strength`, not `hull`.
    pub angle: Option<Quantity<Angle>>,
    /// Width at the top of the cone [m]; ≥ 0, < `width`; with `angle`.
    pub top_width: Option<Quantity<Length>>,
    /// Friction of ice on cone or hull; ≥ 0; with `flexural_strength`.
    pub friction: Option<f64>,
    /// Density of the ice [kg/m³]; > 0; with `flexural_strength`.
    pub density: Option<Quantity<Density>>,
    /// Thickness of the ridden-up ice [m]; default `thickness`; ≥ 0; with `angle`.
    pub ride_up: Option<Quantity<Length>>,
    /// Ship, after Lindqvist; default none; with `flexural_strength`, not `angle`.
    pub hull: Option<HullForm>,
}

/// Ship of beam `width` in level ice, for its resistance after Lindqvist (1989).
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HullForm {
    /// Length of the waterline [m]; > 0.
    pub length: Quantity<Length>,
    /// Draught [m]; > 0.
    pub draught: Quantity<Length>,
    /// Stem from the horizontal [rad]; > 0, < π/2.
    pub stem_angle: Quantity<Angle>,
    /// Waterline from the centre plane [rad]; > 0, < π/2.
    pub entrance_angle: Quantity<Angle>,
    /// Speed [m/s]; ≥ 0.
    pub speed: Quantity<Velocity>,
    /// Young's modulus of the ice [Pa]; > 0.
    pub young: Quantity<Stress>,
}
