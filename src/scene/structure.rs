//! Structures whose loads are recorded, as written in a scene.

use super::units::{Length, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[[structure]]`: walls and groups of grains that stand for one structure; the load on it goes to `history.csv`, whole, by sectors around a
/// vertical axis, and by height.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Structure {
    /// Name used in the column heads.
    pub name: String,
    /// Names of walls, other than plain planes, and of groups of grains.
    pub parts: Vec<String>,
    /// Where the vertical axis is, x and y [m].
    pub axis: [Quantity<Length>; 2],
    /// Height that moments refer to [m]; default 0.
    pub foot: Option<Quantity<Length>>,
    /// Sectors of equal angle around the axis, the first from x towards y; default none.
    pub sectors: Option<usize>,
    /// Heights between layers, ascending [m]; default none.
    pub levels: Option<Vec<Quantity<Length>>>,
}
