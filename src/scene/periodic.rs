//! Scene table of periodic axes.

use super::units::{Length, Quantity};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[periodic]`: lower and upper border [m] of the axes along which the grains repeat themselves.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Periodic {
    /// Borders `[low, high]` along x [m]; default not periodic.
    pub x: Option<[Quantity<Length>; 2]>,
    /// Borders `[low, high]` along y [m]; default not periodic.
    pub y: Option<[Quantity<Length>; 2]>,
    /// Borders `[low, high]` along z [m]; default not periodic.
    pub z: Option<[Quantity<Length>; 2]>,
}
