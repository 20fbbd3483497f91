//! Scene tables of grain inlets and outlets.

use super::units::{Length, MassRate, Quantity, Rate, Time, Velocity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `inlet` of a `[[grains]]`: where and how fast grains of the group are inserted during the main stage.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Inlet {
    /// Box `[low, high]` of contact-free positions, wider than a grain [m].
    #[serde(rename = "box")]
    pub region: [[Quantity<Length>; 3]; 2],
    /// Mass rate [kg/s]; or `grains_per_second`; > 0.
    pub rate: Option<Quantity<MassRate>>,
    /// Grain rate [1/s]; or `rate`; > 0.
    pub grains_per_second: Option<Quantity<Rate>>,
    /// Velocity of inserted grains, without spin [m/s]; default at rest.
    pub velocity: Option<[Quantity<Velocity>; 3]>,
    /// Time of the first insertion [s]; default 0; ≥ 0.
    pub start: Option<Quantity<Time>>,
    /// Time of the last insertion [s]; default none; > `start`.
    pub stop: Option<Quantity<Time>>,
}

/// `[[outlet]]`: grains whose centre gets there are taken out.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Outlet {
    /// Name in reports; default `outlet<number>`, from 0.
    pub name: Option<String>,
    /// Box `[low, high]` that removes centres inside [m]; or `point`.
    #[serde(rename = "box")]
    pub region: Option<[[Quantity<Length>; 3]; 2]>,
    /// Point of a plane that removes centres beyond [m]; or `box`.
    pub point: Option<[Quantity<Length>; 3]>,
    /// Normal towards removed grains; with `point`.
    pub normal: Option<[f64; 3]>,
    /// Names of removed groups; default all without `prescribed_velocity`.
    pub groups: Option<Vec<String>>,
    /// Whether removed grains queue at their inlet; default false.
    #[serde(default)]
    pub recycle: bool,
}
