//! Scene table of a specimen between platens.

use super::units::{Length, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[specimen]`: stress and strain of a specimen between two platens.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Specimen {
    /// Kind of test.
    pub test: SpecimenTest,
    /// Recorded wall, or group with `prescribed_velocity`, at the lower end.
    pub bottom: String,
    /// Recorded wall, or group with `prescribed_velocity`, at the upper end.
    pub top: String,
    /// Axis of loading; default `"z"`.
    #[serde(default)]
    pub axis: SpecimenAxis,
    /// Distance of platens, or disc diameter [m]; > 0.
    pub length: Quantity<Length>,
    /// Cross-section [m²]; > 0; with `"compression"`.
    pub area: Option<f64>,
    /// Disc thickness [m]; > 0; with `"brazilian"`.
    pub thickness: Option<Quantity<Length>>,
    /// Recorded walls whose pressure confines; default none.
    #[serde(default)]
    pub sides: Vec<String>,
    /// Area of each side [m²]; > 0; with `sides`.
    pub side_area: Option<f64>,
    /// Groups of the specimen; default all without `prescribed_velocity`.
    pub groups: Option<Vec<String>>,
    /// Peak stress fractions of the elastic constants; default `[0.2, 0.5]`; 0–1, rising.
    pub between: Option<[f64; 2]>,
}

/// Which test a specimen is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpecimenTest {
    /// Force over `area`.
    Compression,
    /// Splitting, tension 2F/(πDt).
    Brazilian,
}

/// An axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpecimenAxis {
    /// x.
    X,
    /// y.
    Y,
    /// z.
    #[default]
    Z,
}

/// `[events]`: how breaks of bonds are joined to acoustic events.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Events {
    /// Largest distance of breaks in an event [m]; ≥ 0.
    pub distance: Quantity<Length>,
    /// Longest time between breaks in an event [s]; ≥ 0.
    pub time: Quantity<super::units::Time>,
}
