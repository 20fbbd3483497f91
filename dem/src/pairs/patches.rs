//! Contacts of spheres with the patches of a surface.

use crate::base::Vec3;
use crate::base::held::held;
use crate::law::History;
use serde::{Deserialize, Serialize};

/// A sphere that touches a patch of a surface or nearly does.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct PatchPair {
    pub i: u32,
    pub patch: u32,
    pub local: [f64; 2],
    /// Way that sphere and patch can come together before they may touch, counted from when the near list was made
    /// [m]; negative in touch.
    pub spare: f64,
}

/// A sphere in touch with a patch, and what is remembered of the last step.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct PatchContact {
    pub i: u32,
    pub patch: u32,
    /// Where the patch was touched, the normal, the patch's velocity and the overlap there.
    pub point: Vec3,
    pub normal: Vec3,
    pub velocity: Vec3,
    pub overlap: f64,
    /// Cosine between the contact's and the patch's own normal: its sign tells the side.
    pub side: f64,
    pub history: History,
}

/// Spheres near the patches of a surface, and those in touch; both in order of sphere and patch.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct PatchList {
    pub pairs: Vec<PatchPair>,
    pub live: Vec<PatchContact>,
}

impl PatchList {
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty() && self.live.is_empty()
    }

    /// Becomes the same as another, in its own memory.
    pub fn copy_from(&mut self, other: &PatchList) {
        self.pairs.clone_from(&other.pairs);
        self.live.clone_from(&other.live);
    }
}

impl PatchList {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        held(&self.pairs) + held(&self.live)
    }
}
