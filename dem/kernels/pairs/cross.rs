//! Contacts between blocks: lists, force slots, gathering.

use super::groups::Groups;
use super::list::PairList;
use crate::base::Vec3;
use crate::base::balance_terms::Impulse;
use crate::base::capacity::capacity_bytes;
use crate::base::failure::Failure;
use crate::bodies::block_slice::BlockSlice;
use crate::bodies::sums::WallSum;
use crate::lanes::vec4::Vec4;
use crate::law::History;
use crate::spatial::surface::SurfaceContact;
use serde::{Deserialize, Serialize};

#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Cross {
    /// Local sphere, other block, sphere there.
    pub spheres: Groups<3>,
    /// By pair type; empty for spheres only.
    pub kinds: Vec<PairList>,
    /// Local sphere and periodic image.
    #[serde(default)]
    pub images: Vec<ImagePair>,
}

/// Sphere, other block, sphere there, box lengths to the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct ImageName {
    pub i: u32,
    pub block: u32,
    pub j: u32,
    pub shift: [i32; 3],
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct ImagePair {
    pub name: ImageName,
    pub history: History,
}

impl ImagePair {
    pub fn new(name: ImageName) -> ImagePair {
        ImagePair { name, history: History::NONE }
    }
}

impl Cross {
    /// `turning`: rolling and twisting history; `kinds`: empty lists by type.
    pub fn new(turning: bool, kinds: Vec<PairList>) -> Cross {
        Cross { spheres: Groups::new(turning), kinds, images: Vec::new() }
    }

    /// Bound on partner blocks.
    pub fn last_block(&self) -> usize {
        let images = self.images.iter().map(|p| p.name.block).max().unwrap_or(0);
        let kinds = self.kinds.iter().map(|list| list.last_block()).max().unwrap_or(0);
        self.spheres.most()[1].max(kinds).max(images) as usize
    }
}

#[derive(Clone, Debug, Default)]
pub struct CrossForces {
    /// Contact records of spheres and images, `width` each: three (force on the first, both torques), or two
    /// for single spheres (force and lever arm; moment per lever arm and second lever arm).
    pub slots: Vec<Vec4>,
    pub width: usize,
    /// First record of pair types, of images.
    pub kinds_at: usize,
    pub images_at: usize,
    pub dashpot: f64,
    pub friction: f64,
    /// Plane work on bodies not made of spheres, and impulse.
    pub work_walls: f64,
    pub walls: Impulse,
    /// Patch wall loads on those bodies; empty without walls.
    pub wall_sums: Vec<WallSum>,
    /// Angular impulse about the origin from periodic contacts.
    pub couple: Vec3,
    /// Of those bodies.
    pub surface: SurfaceTotals,
    pub failure: Option<Failure>,
}

/// Surface contacts, work [J], impulse.
#[derive(Clone, Debug, Default)]
pub struct SurfaceTotals {
    pub contacts: Vec<SurfaceContact>,
    pub work: f64,
    pub impulse: Impulse,
}

impl CrossForces {
    pub fn clear_totals(&mut self) {
        (self.dashpot, self.friction, self.work_walls) = (0.0, 0.0, 0.0);
        self.wall_sums.clear();
        self.surface.contacts.clear();
        (self.surface.work, self.surface.impulse) = (0.0, Impulse::default());
        (self.walls, self.couple, self.failure) = (Impulse::default(), Vec3::zeros(), None);
    }

    /// Allocates slots; `clumps`: torques do not follow from lever arms.
    pub fn lay_out(&mut self, lists: &Cross, clumps: bool) {
        self.width = if clumps || lists.spheres.turning { 3 } else { 2 };
        self.kinds_at = lists.spheres.len() * self.width;
        self.images_at = self.kinds_at + 3 * lists.kinds.iter().map(PairList::len).sum::<usize>();
        let count = self.images_at + lists.images.len() * self.width;
        self.slots.clear();
        self.slots.reserve_exact(count);
        self.slots.resize(count, Vec4::default());
    }
}

#[derive(Clone, Copy)]
pub struct Slots<'a> {
    pub own: BlockSlice<'a, CrossForces>,
    pub beyond: &'a [CrossForces],
}

impl Slots<'_> {
    #[inline(always)]
    pub fn of(&self, block: usize) -> &CrossForces {
        match self.beyond.get(block) {
            Some(there) if !there.slots.is_empty() => there,
            _ => &self.own[block],
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Gather {
    pub place: u32,
    pub block: u32,
    /// Four times the first record; +2 with three records, +1 for the second partner.
    slot: u32,
}

impl Gather {
    pub fn new(place: u32, block: u32, (record, width): (usize, usize), first: bool) -> Gather {
        Gather { place, block, slot: 4 * record as u32 + 2 * u32::from(width == 3) + u32::from(!first) }
    }

    #[inline(always)]
    pub fn record(&self) -> usize {
        (self.slot >> 2) as usize
    }

    #[inline(always)]
    pub fn wide(&self) -> bool {
        self.slot & 2 != 0
    }

    #[inline(always)]
    pub fn first(&self) -> bool {
        self.slot & 1 == 0
    }
}

/// Contributions to a block's bodies, in summation order.
#[derive(Clone, Debug, Default)]
pub struct Shares {
    pub list: Vec<Gather>,
    /// Some slot has three records.
    pub wide: bool,
}

impl Shares {
    #[inline(always)]
    pub fn push(&mut self, share: Gather) {
        self.wide |= share.wide();
        self.list.push(share);
    }
}

/// Replaces image pairs by ascending `names`; history is kept.
pub fn merge(list: &mut Vec<ImagePair>, names: impl Iterator<Item = ImageName>) {
    let mut old = std::mem::take(list).into_iter().peekable();
    for name in names {
        while old.next_if(|p| p.name < name).is_some() {}
        list.push(old.next_if(|p| p.name == name).unwrap_or(ImagePair::new(name)));
    }
}

impl Cross {
    pub fn bytes(&self) -> usize {
        let kinds: usize = self.kinds.iter().map(PairList::bytes).sum();
        self.spheres.bytes() + kinds + capacity_bytes(&self.images)
    }
}
