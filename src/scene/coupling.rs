//! Scene table `[coupling]`.

use super::units::{Angle, Length, Quantity, Time};
use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::{self, Deserializer, MapAccess, Visitor, value::MapAccessDeserializer};
use std::fmt;

/// DEM–FEM coupling.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coupling {
    /// DEM steps (as the first) in a window, or stable number up to 20; default 10; or `window`; 1–1000.
    pub substeps: Option<Substeps>,
    /// Length of a coupling window [s]; or `substeps`; > 0.
    pub window: Option<Quantity<Time>>,
    /// Coupling scheme; default `"predicted"`.
    #[serde(default)]
    pub scheme: SchemeName,
    /// Relative change of surface velocity at convergence; default 1e-4; > 0, < 1; with `"iterated"`.
    pub tolerance: Option<f64>,
    /// Largest number of passes, then the best; default 20; 2–1000; with `"iterated"`.
    pub max_passes: Option<u32>,
    /// Load transfer at points, or over discs; default `"point"`.
    #[serde(default)]
    pub transfer: TransferTable,
    /// Implicitness: 0.5 conserves energy, 1 backward Euler; default by contacts (0.5–0.633), 0.6 with meshed sleepers; 0.5–1.
    pub theta: Option<f64>,
    /// Name of the `[[material]]` of the surface.
    pub material: String,
    /// Direction that contact faces look in; default `[0, 0, 1]`.
    #[serde(default = "up")]
    pub direction: [f64; 3],
    /// Largest angle between normals and `direction` [rad]; default `"75 deg"`; > 0, ≤ π.
    #[serde(default = "steep")]
    pub max_angle: Quantity<Angle>,
    /// Geometry of ground faces; default `"curved"`, with polyhedra `"flat"`.
    pub faces: Option<FacesName>,
}

/// What grains touch of the faces of the ground.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum FacesName {
    /// As deformed (no polyhedra).
    Curved,
    /// Flat triangles, less accurate.
    Flat,
}

fn up() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}
fn steep() -> Quantity<Angle> {
    Quantity::new(75.0_f64.to_radians())
}

/// DEM sub-steps per FEM time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Substeps {
    /// Fixed number.
    Count(i64),
    /// Largest stable number, at most 20.
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

/// Coupling scheme.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq)]
#[serde(rename_all = "snake_case")]
pub enum SchemeName {
    /// Grains first, on predicted surface motion.
    #[default]
    Predicted,
    /// Solid first, with previous force.
    Lagged,
    /// Predicted with contact stiffness (linear solids without reduction, no polyhedra).
    Stiffened,
    /// Until both sides agree.
    Iterated,
}

/// Transfer of contact forces to the solid.
#[derive(Clone, Copy, Debug, Default)]
pub enum TransferTable {
    /// At the mapped contact point.
    #[default]
    Point,
    /// Distributed over discs.
    Spread(SpreadTable),
}

/// Size of the discs: one of both.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpreadTable {
    /// Radius of the discs [m]; or `spread_factor`; > 0.
    pub spread: Option<Quantity<Length>>,
    /// Radius over mean bounding radius of grains; or `spread`; > 0, ≤ 100.
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
