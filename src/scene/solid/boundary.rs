//! Supports and absorbing boundaries of the solid as written in a scene.

use crate::scene::history::History;
use crate::scene::units::{Length, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// A side of the bounding box of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
pub enum Side {
    /// Smallest x.
    #[serde(rename = "x-")]
    XLow,
    /// Largest x.
    #[serde(rename = "x+")]
    XHigh,
    /// Smallest y.
    #[serde(rename = "y-")]
    YLow,
    /// Largest y.
    #[serde(rename = "y+")]
    YHigh,
    /// Smallest z.
    #[serde(rename = "z-")]
    ZLow,
    /// Largest z.
    #[serde(rename = "z+")]
    ZHigh,
}

impl Side {
    /// Axis 0–2, and whether it is the upper side.
    pub fn axis(self) -> (usize, bool) {
        match self {
            Side::XLow => (0, false),
            Side::XHigh => (0, true),
            Side::YLow => (1, false),
            Side::YHigh => (1, true),
            Side::ZLow => (2, false),
            Side::ZHigh => (2, true),
        }
    }
}

/// `[[solid.support]]`: nodes whose displacement is given. Exactly one of `side`, `nodes_in`, `set` and `node` chooses
/// them.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Support {
    /// Name, under which the sum of its reactions is recorded; default not recorded.
    pub name: Option<String>,
    /// All nodes on this side of the bounding box.
    pub side: Option<Side>,
    /// All nodes in this box [m], [[x, y, z] low, high].
    pub nodes_in: Option<[[Quantity<Length>; 3]; 2]>,
    /// All nodes of this set of the mesh file.
    pub set: Option<String>,
    /// One node, by its number.
    pub node: Option<u32>,
    /// Directions that are held, out of "x", "y", "z".
    pub directions: Vec<String>,
    /// Displacement in each of them [m]; default 0.
    pub displacement: Option<Quantity<Length>>,
    /// How the displacement varies in time; default constant.
    pub history: Option<History>,
}

/// `[[solid.absorbing]]`: dashpots that take up waves at normal incidence. Exactly one of `side`, `faces_in` and `set`
/// chooses the faces.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Absorbing {
    /// All boundary faces on this side of the bounding box.
    pub side: Option<Side>,
    /// All boundary faces with their centre in this box [m], [[x, y, z] low, high].
    pub faces_in: Option<[[Quantity<Length>; 3]; 2]>,
    /// All boundary faces whose nodes belong to this node set of the mesh file.
    pub set: Option<String>,
    /// Factor on ρ c_p, the dashpot along the normal; default 1.
    #[serde(default = "one")]
    pub normal: f64,
    /// Factor on ρ c_s, the dashpot across the normal; default 1.
    #[serde(default = "one")]
    pub tangential: f64,
    /// Distance of the source of the waves [m]: adds springs that carry the static load of the ground beyond.
    pub radius: Option<Quantity<Length>>,
}

fn one() -> f64 {
    1.0
}
