//! Contacts between blocks: lists, the slots that their forces go to, and who gathers them.

use super::groups::Groups;
use super::list::PairList;
use crate::base::Vec3;
use crate::base::failure::Failure;
use crate::base::held::held;
use crate::base::ledger::Impulse;
use crate::bodies::part::Part;
use crate::bodies::sums::WallSum;
use crate::lanes::record::Record;
use crate::law::History;
use crate::spatial::surface::SurfaceContact;
use serde::{Deserialize, Serialize};

/// Contacts of a block's spheres with bodies of other blocks.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Cross {
    /// Sphere of this block, other block, sphere there.
    pub spheres: Groups<3>,
    /// Pairs of bodies that are not made of spheres, by kind; empty where a model has none.
    pub kinds: Vec<PairList>,
    /// Sphere of this block and the image of one of any block across a periodic border.
    #[serde(default)]
    pub images: Vec<ImagePair>,
}

/// Sphere of a block, other block, sphere there, and how many box lengths the image is away from that sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(crate) struct ImageName {
    pub i: u32,
    pub block: u32,
    pub j: u32,
    pub shift: [i32; 3],
}

/// Two spheres that touch across a periodic border or nearly do.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct ImagePair {
    pub name: ImageName,
    pub history: History,
}

impl ImagePair {
    /// A pair that has not touched.
    pub fn new(name: ImageName) -> ImagePair {
        ImagePair { name, history: History::NONE }
    }
}

impl Cross {
    /// No contacts; `turning`: those of spheres remember rolling and twisting. `kinds`: empty lists of other pairs.
    pub fn new(turning: bool, kinds: Vec<PairList>) -> Cross {
        Cross { spheres: Groups::new(turning), kinds, images: Vec::new() }
    }

    /// No partner lies in a later block than this.
    pub fn last_block(&self) -> usize {
        let images = self.images.iter().map(|p| p.name.block).max().unwrap_or(0);
        let kinds = self.kinds.iter().map(|list| list.last_block()).max().unwrap_or(0);
        self.spheres.most()[1].max(kinds).max(images) as usize
    }
}

/// Contacts of a block with others: their forces, what they dissipated, and the first failure.
#[derive(Clone, Debug, Default)]
pub(crate) struct CrossForces {
    /// Records of all contacts. Of spheres and images `width` each: three (the force on the first partner and the torques
    /// on both), or of single spheres two (the force and its lever on the first, the moment per lever and that on the
    /// second). Of pairs of kinds three each.
    pub slots: Vec<Record>,
    pub width: usize,
    /// Where the records of the kinds and of images begin.
    pub kinds_at: usize,
    pub images_at: usize,
    pub dashpot: f64,
    pub friction: f64,
    /// Work that planes do on bodies that are not made of spheres, and their impulse.
    pub work_walls: f64,
    pub walls: Impulse,
    /// What those bodies felt from each wall of patches; empty in blocks near none.
    pub wall_sums: Vec<WallSum>,
    /// Angular impulse about the origin that contacts across periodic borders give in this step.
    pub couple: Vec3,
    /// Contacts of those bodies with the external surface.
    pub surface: SurfaceBook,
    pub failure: Option<Failure>,
}

/// Contacts with the external surface, the work that it does [J], and the impulse that it gives.
#[derive(Clone, Debug, Default)]
pub(crate) struct SurfaceBook {
    pub contacts: Vec<SurfaceContact>,
    pub work: f64,
    pub impulse: Impulse,
}

impl CrossForces {
    /// Begins a step: nothing is dissipated yet.
    pub fn clear_books(&mut self) {
        (self.dashpot, self.friction, self.work_walls) = (0.0, 0.0, 0.0);
        self.wall_sums.clear();
        self.surface.contacts.clear();
        (self.surface.work, self.surface.impulse) = (0.0, Impulse::default());
        (self.walls, self.couple, self.failure) = (Impulse::default(), Vec3::zeros(), None);
    }

    /// Makes room for the contacts of a list; `clumps`: partners may be clumps, whose torques differ from a lever's.
    pub fn lay_out(&mut self, lists: &Cross, clumps: bool) {
        self.width = if clumps || lists.spheres.turning { 3 } else { 2 };
        self.kinds_at = lists.spheres.len() * self.width;
        self.images_at = self.kinds_at + 3 * lists.kinds.iter().map(PairList::len).sum::<usize>();
        let count = self.images_at + lists.images.len() * self.width;
        self.slots.clear();
        self.slots.reserve_exact(count);
        self.slots.resize(count, Record::default());
    }
}

/// Contacts of blocks with others, as those who gather them see them: of the run's own blocks, and of all whose contacts reach
/// beyond their run.
#[derive(Clone, Copy)]
pub(crate) struct Slots<'a> {
    pub own: Part<'a, CrossForces>,
    pub beyond: &'a [CrossForces],
}

impl Slots<'_> {
    /// Those of a block.
    #[inline(always)]
    pub fn of(&self, block: usize) -> &CrossForces {
        match self.beyond.get(block) {
            Some(there) if !there.slots.is_empty() => there,
            _ => &self.own[block],
        }
    }
}

/// One body's share in a slot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gather {
    pub place: u32,
    pub block: u32,
    /// Four times the slot's first record; plus two where it has three of them, and one for the second partner.
    slot: u32,
}

impl Gather {
    pub fn new(place: u32, block: u32, (record, width): (usize, usize), first: bool) -> Gather {
        Gather { place, block, slot: 4 * record as u32 + 2 * u32::from(width == 3) + u32::from(!first) }
    }

    /// The slot's first record.
    #[inline(always)]
    pub fn record(&self) -> usize {
        (self.slot >> 2) as usize
    }

    /// Whether the slot has three records.
    #[inline(always)]
    pub fn wide(&self) -> bool {
        self.slot & 2 != 0
    }

    /// Whether the body is the first partner.
    #[inline(always)]
    pub fn first(&self) -> bool {
        self.slot & 1 == 0
    }
}

/// The shares of a block's bodies, in the order in which they are added.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shares {
    pub list: Vec<Gather>,
    /// Whether any slot has three records.
    pub wide: bool,
}

impl Shares {
    #[inline(always)]
    pub fn push(&mut self, share: Gather) {
        self.wide |= share.wide();
        self.list.push(share);
    }
}

/// Replaces a list of image pairs, keeping the memory of those that were there. Names ascend.
pub(crate) fn merge(list: &mut Vec<ImagePair>, names: impl Iterator<Item = ImageName>) {
    let mut old = std::mem::take(list).into_iter().peekable();
    for name in names {
        while old.next_if(|p| p.name < name).is_some() {}
        list.push(old.next_if(|p| p.name == name).unwrap_or(ImagePair::new(name)));
    }
}

impl Cross {
    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let kinds: usize = self.kinds.iter().map(PairList::bytes).sum();
        self.spheres.bytes() + kinds + held(&self.images)
    }
}
