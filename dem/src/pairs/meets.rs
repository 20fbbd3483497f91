//! Memory of the points in which two walls touch.

use super::list::PointMemory;
use serde::{Deserialize, Serialize};

/// A point in which a wall touches another one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Meet {
    /// Number of the other wall.
    pub other: u32,
    /// What presses, and what is pressed into.
    pub name: [u32; 2],
    pub memory: PointMemory,
}
