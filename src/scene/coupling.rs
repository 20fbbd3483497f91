//! `[coupling]`: the exchange between grains and solid.

use super::units::{Angle, Length, Quantity, Time};
use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::{self, Deserializer, MapAccess, Visitor, value::MapAccessDeserializer};
use std::fmt;

/// Exchange between grains and solid.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coupling {
    /// Steps of the grains, as long as the first, per step of the solid, 1–1000, or `"auto"`; default 10.
    pub substeps: Option<Substeps>,
    /// Step of the solid [s], in place of `substeps`.
    pub window: Option<Quantity<Time>>,
    /// Order of the exchange.
    #[serde(default)]
    pub scheme: SchemeName,
    /// Largest relative change of the surface's motion between passes of the iterated scheme; default 1e-4.
    pub tolerance: Option<f64>,
    /// Passes of the iterated scheme at most; default 20.
    pub max_passes: Option<u32>,
    /// How contact forces reach the solid.
    #[serde(default)]
    pub transfer: TransferTable,
    /// Implicitness of the solid's window step, 0.5–1; 0.5 is Newmark ¼, ½ and conserves energy. Default 0.5, with meshed
    /// sleepers 0.6.
    pub theta: Option<f64>,
    /// Name of the `[[material]]` that grains feel when they touch the solid.
    pub material: String,
    /// Direction that the touched faces look to; default up (0, 0, 1).
    #[serde(default = "up")]
    pub direction: [f64; 3],
    /// Largest angle between a face's normal and `direction` [rad]; default 75 degrees.
    #[serde(default = "steep")]
    pub max_angle: Quantity<Angle>,
    /// What grains touch of the faces of the ground; default `curved`, with polyhedra `flat`.
    pub faces: Option<FacesName>,
}

/// What grains touch of the faces of the ground.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum FacesName {
    /// The faces themselves, with the curvature that their mid-side nodes and the deformation give them.
    Curved,
    /// Flat triangles between the nodes of the faces.
    Flat,
}

fn up() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}
fn steep() -> Quantity<Angle> {
    Quantity::new(75.0_f64.to_radians())
}

/// Steps of the grains per step of the solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Substeps {
    /// So many.
    Count(i64),
    /// As many as are stable, 20 at most.
    Auto,
}

impl Default for Substeps {
    fn default() -> Substeps {
        Substeps::Count(10)
    }
}

impl<'de> Deserialize<'de> for Substeps {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Substeps, D::Error> {
        struct Reader;
        impl Visitor<'_> for Reader {
            type Value = Substeps;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("1 to 1000, or \"auto\"")
            }
            fn visit_i64<E: de::Error>(self, count: i64) -> Result<Substeps, E> {
                Ok(Substeps::Count(count))
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<Substeps, E> {
                match text {
                    "auto" => Ok(Substeps::Auto),
                    _ => Err(E::invalid_value(de::Unexpected::Str(text), &self)),
                }
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// Order of the exchange.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum SchemeName {
    /// Grains first on the predicted motion of the surface.
    #[default]
    Predicted,
    /// Solid first with the force of the window before.
    Lagged,
    /// As predicted, the prediction knowing the stiffness of the contacts.
    Stiffened,
    /// Windows are repeated until both sides agree.
    Iterated,
}

/// How contact forces reach the solid.
#[derive(Clone, Copy, Debug, Default)]
pub enum TransferTable {
    /// At the mapped contact point.
    #[default]
    Point,
    /// Spread over discs.
    Spread(SpreadTable),
}

/// Size of the discs: one of both.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpreadTable {
    /// Radius of the discs [m].
    pub spread: Option<Quantity<Length>>,
    /// Radius of the discs over the mean radius of the stones.
    pub spread_factor: Option<f64>,
}

impl<'de> Deserialize<'de> for TransferTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<TransferTable, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = TransferTable;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("\"point\", or a table with `spread` or `spread_factor`")
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<TransferTable, E> {
                match text {
                    "point" => Ok(TransferTable::Point),
                    _ => Err(E::invalid_value(de::Unexpected::Str(text), &self)),
                }
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<TransferTable, A::Error> {
                SpreadTable::deserialize(MapAccessDeserializer::new(map)).map(TransferTable::Spread)
            }
        }
        deserializer.deserialize_any(Reader)
    }
}
