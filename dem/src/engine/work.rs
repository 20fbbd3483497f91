//! Scratch of the step: never saved, made anew from a state at any time without changing a bit of what follows.

use super::block_work::{BlockWork, Ground};
use super::candidates::Listed;
use super::state::State;
use super::wall_contacts::WallContacts;
use crate::base::Vec3;
use crate::bodies::members::Members;
use crate::bodies::sums::Sums;
use crate::bond::Held;
use crate::bond::pass::BondWork;
use crate::contact::planes::PlaneNow;
use crate::integrate::leapfrog::Applied;
use crate::lanes::Simd;
use crate::lanes::record::xyz;
use crate::pairs::buffers::Buffers;
use crate::pairs::cross::CrossForces;
use crate::pairs::merge::Merging;
use crate::spatial::patchwork::WallNow;
use crate::spatial::sheet::SheetFacet;
use crate::spatial::surface::SurfaceContact;
use nalgebra::UnitQuaternion;
use std::ops::Range;

/// What the search knows: whether the candidates exist, and where walls were when they were found.
#[derive(Clone, Debug, Default)]
pub(crate) struct Searched {
    pub listed: Option<Listed>,
    pub planes: Vec<Vec3>,
    pub walls: Vec<(Vec3, UnitQuaternion<f64>)>,
    pub surface_drift: f64,
    /// Searches, and near lists made from what they found.
    pub searches: u64,
    pub refreshes: u64,
}

/// The scratch. Build it with [`Work::new`] for one state; it follows that state from then on.
#[derive(Clone, Debug)]
pub struct Work {
    pub(crate) members: Vec<Members>,
    pub(crate) blocks: Vec<BlockWork>,
    pub(crate) cross: Vec<CrossForces>,
    /// Scratch of [`super::threads::through`].
    pub(crate) beyond: Vec<CrossForces>,
    pub(crate) bonds: BondWork,
    /// Pairs that are not for the ordinary contacts.
    pub(crate) held: Held,
    pub(crate) applied: Vec<Applied>,
    pub(crate) surface_contacts: Vec<SurfaceContact>,
    pub(crate) buffers: Buffers<Vec<Sums>>,
    pub(crate) merging: Buffers<Merging>,
    pub(crate) keep_forces: bool,
    pub(crate) searched: Searched,
    /// What the processor computes four lanes with.
    pub(crate) simd: Simd,
    pub(crate) planes: Vec<PlaneNow>,
    /// Walls of patches where they are, where bodies with faces may touch them.
    pub(crate) walls: Vec<WallNow>,
    pub(crate) wall_contacts: WallContacts,
    /// What each body of a block has of ground that is scarred.
    pub(crate) ground: Vec<Ground>,
    /// Scratch of cutting bodies.
    pub(crate) heights: Vec<f64>,
    /// The external surface where it is, likewise.
    pub(crate) sheet: Vec<SheetFacet>,
    /// The material of all bodies and of all planes, where there is only one.
    pub(crate) material: Option<u32>,
    pub(crate) plane_material: Option<u32>,
    /// Whether blocks are shared among threads.
    pub(crate) parallel: bool,
    /// The blocks that are searched and moved here: all, unless other ranks have the rest (see [`crate::ranks`]).
    pub(crate) own: Range<usize>,
    /// Bodies of other blocks that are known where they are (block, place), ascending.
    pub(crate) halo: Vec<[u32; 2]>,
}

impl Work {
    /// Contacts with the external surface in the last step, by block, then sphere, then patch.
    pub fn surface_contacts(&self) -> &[SurfaceContact] {
        &self.surface_contacts
    }

    /// Whether [`Work::contact_force`] and [`Work::contact_torque`] shall know the forces after a step; they take 64
    /// bytes per body.
    pub fn keep_forces(&mut self, keep: bool) {
        self.keep_forces = keep;
    }

    fn sums(&self, state: &State, body: usize) -> Option<&Sums> {
        let [b, k] = state.places[body];
        self.blocks[b as usize].tally.sums.get(k as usize)
    }

    /// Sum of the contact forces on a body in the last step, if kept; else zero [N].
    pub fn contact_force(&self, state: &State, body: usize) -> Vec3 {
        self.sums(state, body).map(|s| xyz(s.force())).unwrap_or_default()
    }

    /// Sum of the contact torques on a body about its centre in the last step, if kept; else zero [N m].
    pub fn contact_torque(&self, state: &State, body: usize) -> Vec3 {
        self.sums(state, body).map(|s| xyz(s.torque())).unwrap_or_default()
    }

    /// How often candidates were searched and how often the near list was made from them.
    pub fn rebuilds(&self) -> (u64, u64) {
        (self.searched.searches, self.searched.refreshes)
    }
}
