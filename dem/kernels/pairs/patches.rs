//! Sphere–patch contacts.

use crate::base::Vec3;
use crate::base::capacity::capacity_bytes;
use crate::law::History;
use serde::{Deserialize, Serialize};

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct PatchPair {
    pub i: u32,
    pub patch: u32,
    pub local: [f64; 2],
    /// Relative displacement possible before contact since the list was built [m]; negative in contact.
    pub spare: f64,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct PatchContact {
    pub i: u32,
    pub patch: u32,
    /// Contact point, normal, patch velocity, overlap.
    pub point: Vec3,
    pub normal: Vec3,
    pub velocity: Vec3,
    pub overlap: f64,
    /// Cosine between contact and patch normal: its sign gives the side.
    pub side: f64,
    pub history: History,
}

/// Sorted by sphere and patch.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct PatchList {
    pub pairs: Vec<PatchPair>,
    pub live: Vec<PatchContact>,
}

impl PatchList {
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty() && self.live.is_empty()
    }

    /// Copies without reallocation.
    pub fn copy_from(&mut self, other: &PatchList) {
        self.pairs.clone_from(&other.pairs);
        self.live.clone_from(&other.live);
    }
}

impl PatchList {
    pub fn bytes(&self) -> usize {
        capacity_bytes(&self.pairs) + capacity_bytes(&self.live)
    }
}
