//! Scene tables of structures with recorded loads.

use super::units::{Length, Quantity};
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
}
