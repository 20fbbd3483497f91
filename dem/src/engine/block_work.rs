//! Scratch data of one block.

use crate::base::Vec3;
use crate::base::capacity::capacity_bytes;
use crate::bodies::sums::BlockTotals;
use crate::body_force::ForceWork;
use crate::bond::pass::ListWork;
use crate::contact::surface_contacts::PatchWork;
use crate::pairs::cross::{ImageName, Shares};
use crate::pairs::list::PairName;
use crate::pairs::patch_search::Candidate;
use crate::pairs::patches::PatchPair;
use crate::pairs::reference::Reference;

#[derive(Clone, Debug, Default)]
pub(crate) struct Candidates {
    pub reference: Reference,
    pub pairs: Vec<[u16; 2]>,
    pub cross: Vec<[u32; 3]>,
    /// Spheres of earlier, remote blocks: block, sphere, local sphere.
    pub earlier: Vec<[u32; 3]>,
    /// By pair type; empty for spheres and clumps only.
    pub kinds: Vec<Vec<PairName>>,
    pub images: Vec<ImageName>,
    pub planes: Vec<[u32; 2]>,
    pub walls: Vec<Candidate>,
    pub surface: Vec<Candidate>,
    pub row: Vec<u32>,
    pub patches: Vec<PatchPair>,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct BlockWork {
    pub candidates: Candidates,
    pub shares: Shares,
    pub totals: BlockTotals,
    pub patches: PatchWork,
    pub bonds: ListWork,
    pub body_forces: ForceWork,
}

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Ground {
    pub touches: bool,
    pub cuts: bool,
    /// Upward unit normal, height of the centre above the plane [m].
    pub plane: Option<(Vec3, f64)>,
    /// The triangle is beneath the centre.
    pub beneath: bool,
    pub wall: usize,
}

impl BlockWork {
    pub fn bytes(&self) -> usize {
        let c = &self.candidates;
        let spheres = capacity_bytes(&c.pairs)
            + capacity_bytes(&c.cross)
            + capacity_bytes(&c.earlier)
            + c.kinds.iter().map(capacity_bytes).sum::<usize>()
            + capacity_bytes(&c.images)
            + capacity_bytes(&c.planes);
        let reference = c.reference.len() * size_of::<[f32; 3]>();
        let patches = capacity_bytes(&c.walls) + capacity_bytes(&c.surface);
        let forces = capacity_bytes(&self.totals.sums) + self.body_forces.bytes();
        spheres + patches + reference + capacity_bytes(&self.shares.list) + forces + self.bonds.bytes()
    }
}
