//! Inlets and outlets of grains as written in a scene.

use super::units::{Length, MassRate, Quantity, Rate, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `inlet` of a `[[grains]]`: where and how fast grains of the group come in during the run proper.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Inlet {
    /// Corners of the box that they come in at, each wholly inside and touching nothing [m].
    #[serde(rename = "box")]
    pub region: [[Quantity<Length>; 3]; 2],
    /// Mass per time [kg/s].
    pub rate: Option<Quantity<MassRate>>,
    /// In place of `rate`: number per time [1/s].
    pub grains_per_second: Option<Quantity<Rate>>,
    /// Velocity that they come in at [m/s]; default at rest.
    pub velocity: Option<[Quantity<Velocity>; 3]>,
    /// When the first may come in [s]; default 0.
    pub start: Option<Quantity<Time>>,
    /// When no more come in [s]; default never.
    pub stop: Option<Quantity<Time>>,
}

/// `[[outlet]]`: grains whose centre gets there are taken out.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Outlet {
    /// Name in reports; default `outlet<number>`, counted from 0.
    pub name: Option<String>,
    /// Corners of a box [m].
    #[serde(rename = "box")]
    pub region: Option<[[Quantity<Length>; 3]; 2]>,
    /// In place of a box: a point of a plane [m].
    pub point: Option<[Quantity<Length>; 3]>,
    /// Normal of that plane, towards the side where grains are taken out; any length but zero.
    pub normal: Option<[f64; 3]>,
    /// Names of the groups; default all that move freely.
    pub groups: Option<Vec<String>>,
    /// Whether grains taken out come in again at the inlet of their group; default false.
    #[serde(default)]
    pub again: bool,
}
