//! History of contact points between walls.

use super::list::ContactHistory;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WallContactHistory {
    /// Other wall.
    pub other: u32,
    /// Indenting and indented feature.
    pub name: [u32; 2],
    pub memory: ContactHistory,
}
