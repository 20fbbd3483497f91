//! A specimen between platens as written in a scene.

use super::units::{Length, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[specimen]`: stress and strain of a specimen between two platens.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Specimen {
    /// Which test it is.
    pub test: SpecimenTest,
    /// Recorded wall, or recorded group, at the lower end of the axis.
    pub bottom: String,
    /// The same at the upper end.
    pub top: String,
    /// Axis that it is loaded along; default z.
    #[serde(default)]
    pub axis: SpecimenAxis,
    /// Distance of the platens [m]; of the Brazilian test the diameter.
    pub length: Quantity<Length>,
    /// Of `compression`: section [m²].
    pub area: Option<f64>,
    /// Of `brazilian`: thickness of the disc [m].
    pub thickness: Option<Quantity<Length>>,
    /// Recorded walls at the sides, whose pressure is the confinement.
    #[serde(default)]
    pub sides: Vec<String>,
    /// Area of each of them [m²].
    pub side_area: Option<f64>,
    /// Groups of the specimen; default all that are not gripped by `motion`.
    pub groups: Option<Vec<String>>,
    /// Shares of the peak between which modulus and Poisson's ratio are taken; default 0.2 and 0.5.
    pub between: Option<[f64; 2]>,
}

/// Which test a specimen is in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SpecimenTest {
    /// Uniaxial or triaxial compression: force over section.
    Compression,
    /// Splitting of a disc across its diameter: tension 2 F/(π D t) in its middle.
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
    /// Largest distance of two breaks of one event [m].
    pub distance: Quantity<Length>,
    /// Longest time between them [s].
    pub time: Quantity<super::units::Time>,
}
