//! Scratch of one block.

use crate::base::Vec3;
use crate::base::held::held;
use crate::bodies::sums::Tally;
use crate::body_force::ForceWork;
use crate::bond::pass::ListWork;
use crate::contact::patches::PatchWork;
use crate::pairs::cross::{ImageName, Shares};
use crate::pairs::list::PairName;
use crate::pairs::patch_search::Candidate;
use crate::pairs::patches::PatchPair;
use crate::pairs::reference::Reference;

/// Pairs within the skin of touching, valid while no sphere has moved further than the skin allows.
#[derive(Clone, Debug, Default)]
pub(crate) struct Candidates {
    pub reference: Reference,
    pub pairs: Vec<[u16; 2]>,
    pub cross: Vec<[u32; 3]>,
    /// With spheres of earlier blocks that others search: block and sphere there, sphere here.
    pub earlier: Vec<[u32; 3]>,
    /// Of each kind of pair; empty where a model has no bodies but those made of spheres.
    pub kinds: Vec<Vec<PairName>>,
    pub images: Vec<ImageName>,
    pub planes: Vec<[u32; 2]>,
    pub walls: Vec<Candidate>,
    pub surface: Vec<Candidate>,
    /// Scratch of the search and of the near list.
    pub row: Vec<u32>,
    pub patches: Vec<PatchPair>,
}

/// Scratch of one block.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockWork {
    pub candidates: Candidates,
    /// What its bodies gather from slots.
    pub shares: Shares,
    pub tally: Tally,
    pub patches: PatchWork,
    pub bonds: ListWork,
    pub body_forces: ForceWork,
}

/// What a body has of ground that it scars (`scarring.rs`).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Ground {
    pub touches: bool,
    pub cuts: bool,
    /// The plane of the surface: its upward unit normal, and the height of the body's centre above it [m].
    pub plane: Option<(Vec3, f64)>,
    /// Whether that is beneath the centre.
    pub beneath: bool,
    pub wall: usize,
}

impl BlockWork {
    /// Bytes held between steps.
    pub fn bytes(&self) -> usize {
        let c = &self.candidates;
        let spheres = held(&c.pairs)
            + held(&c.cross)
            + held(&c.earlier)
            + c.kinds.iter().map(held).sum::<usize>()
            + held(&c.images)
            + held(&c.planes);
        // Where the spheres were at the last search.
        let reference = c.reference.len() * size_of::<[f32; 3]>();
        let patches = held(&c.walls) + held(&c.surface);
        let forces = held(&self.tally.sums) + self.body_forces.bytes();
        spheres + patches + reference + held(&self.shares.list) + forces + self.bonds.bytes()
    }
}
