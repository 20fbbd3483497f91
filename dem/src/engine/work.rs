//! Scratch data of the step, rebuilt from a state with bitwise identical results.

use super::block_work::{BlockWork, Ground};
use super::broad_phase::Listed;
use super::state::State;
use super::wall_contacts::WallContacts;
use crate::base::Vec3;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::sums::ForceTorque;
use crate::bond::BondedPairs;
use crate::bond::pass::BondWork;
use crate::contact::planes::PlanePose;
use crate::integrate::leapfrog::Applied;
use crate::lanes::Simd;
use crate::lanes::vec4::xyz;
use crate::pairs::buffers::Buffers;
use crate::pairs::cross::CrossForces;
use crate::pairs::merge::Merging;
use crate::spatial::patchwork::WallView;
use crate::spatial::sheet::SheetFacet;
use crate::spatial::surface::SurfaceContact;
use nalgebra::UnitQuaternion;
use std::ops::Range;

#[derive(Clone, Debug, Default)]
pub(crate) struct Searched {
    pub listed: Option<Listed>,
    pub planes: Vec<Vec3>,
    pub walls: Vec<(Vec3, UnitQuaternion<f64>)>,
    pub surface_travel: f64,
    /// Searches, neighbour list builds.
    pub searches: u64,
    pub refreshes: u64,
}

/// Scratch data of one state ([`Work::new`]).
#[derive(Clone, Debug)]
pub struct Work {
    pub(crate) members: Vec<BlockBodies>,
    pub(crate) blocks: Vec<BlockWork>,
    pub(crate) cross: Vec<CrossForces>,
    pub(crate) beyond: Vec<CrossForces>,
    pub(crate) bonds: BondWork,
    pub(crate) held: BondedPairs,
    pub(crate) applied: Vec<Applied>,
    pub(crate) surface_contacts: Vec<SurfaceContact>,
    pub(crate) buffers: Buffers<Vec<ForceTorque>>,
    pub(crate) merging: Buffers<Merging>,
    pub(crate) keep_forces: bool,
    pub(crate) searched: Searched,
    pub(crate) simd: Simd,
    pub(crate) planes: Vec<PlanePose>,
    pub(crate) walls: Vec<WallView>,
    pub(crate) wall_contacts: WallContacts,
    /// Surface below each body.
    pub(crate) ground: Vec<Ground>,
    pub(crate) heights: Vec<f64>,
    pub(crate) sheet: Vec<SheetFacet>,
    /// Common material of bodies and of planes.
    pub(crate) material: Option<u32>,
    pub(crate) plane_material: Option<u32>,
    pub(crate) parallel: bool,
    /// Local blocks ([`crate::ranks`]).
    pub(crate) own: Range<usize>,
    /// Known bodies of other blocks (block, slot), ascending.
    pub(crate) halo: Vec<[u32; 2]>,
}

impl Work {
    /// Contacts with the external surface in the last step, by block, sphere, patch.
    pub fn surface_contacts(&self) -> &[SurfaceContact] {
        &self.surface_contacts
    }

    /// Enables [`Work::contact_force`] and [`Work::contact_torque`] (64 bytes per body).
    pub fn keep_forces(&mut self, keep: bool) {
        self.keep_forces = keep;
    }

    fn sums(&self, state: &State, body: usize) -> Option<&ForceTorque> {
        let [b, k] = state.places[body];
        self.blocks[b as usize].totals.sums.get(k as usize)
    }

    /// Contact force on a body [N]; zero if not kept.
    pub fn contact_force(&self, state: &State, body: usize) -> Vec3 {
        self.sums(state, body).map(|s| xyz(s.force())).unwrap_or_default()
    }

    /// Contact torque about the centre [N m]; zero if not kept.
    pub fn contact_torque(&self, state: &State, body: usize) -> Vec3 {
        self.sums(state, body).map(|s| xyz(s.torque())).unwrap_or_default()
    }

    /// Number of searches and of neighbour list builds.
    pub fn rebuilds(&self) -> (u64, u64) {
        (self.searched.searches, self.searched.refreshes)
    }
}
