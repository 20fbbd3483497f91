//! Scene tables of supports and absorbing boundaries.

use crate::history::History;
use crate::units::{Length, Quantity};
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
    /// Name of the recorded reaction sum; default not recorded.
    pub name: Option<String>,
    /// Side of the bounding box; or `nodes_in`, `set`, `node`.
    pub side: Option<Side>,
    /// Box `[low, high]` of nodes [m]; or `side`.
    pub nodes_in: Option<[[Quantity<Length>; 3]; 2]>,
    /// Node set of the mesh; or `side`.
    pub set: Option<String>,
    /// Node number; or `side`.
    pub node: Option<u32>,
    /// Fixed directions, of `"x"`, `"y"`, `"z"`.
    pub directions: Vec<String>,
    /// Displacement in each direction [m]; default 0.
    pub displacement: Option<Quantity<Length>>,
    /// Time history; default constant.
    pub history: Option<History>,
}

/// `[[solid.absorbing]]`: dashpots that absorb waves at normal incidence. Exactly one of `side`, `faces_in` and `set`
/// chooses the faces.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Absorbing {
    /// Side of the bounding box; or `faces_in`, `set`.
    pub side: Option<Side>,
    /// Box `[low, high]` of face centres [m]; or `side`.
    pub faces_in: Option<[[Quantity<Length>; 3]; 2]>,
    /// Face set, or node set around faces; or `side`.
    pub set: Option<String>,
    /// Factor on normal dashpots ρ c_p; default 1; ≥ 0.
    #[serde(default = "one")]
    pub normal: f64,
    /// Factor on tangential dashpots ρ c_s; default 1; ≥ 0.
    #[serde(default = "one")]
    pub tangential: f64,
    /// Distance of the wave source, for springs [m]; default no springs; > 0.
    pub radius: Option<Quantity<Length>>,
}

fn one() -> f64 {
    1.0
}
