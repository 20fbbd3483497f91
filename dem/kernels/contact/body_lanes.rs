//! Contact partners in lanes.

use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::block_slice::BlockSlice;
use crate::bodies::sums::BlockTotals;
use crate::lanes::SimdPack;
use crate::lanes::vec4::Vec4;

/// Index per lane; with four lanes the others are unused.
pub type LaneIndices = [usize; 8];

/// Contact partner in lanes, with its body's motion.
pub trait BodyLanes {
    fn sphere(&self, lane: usize) -> &Vec4;
    fn centre(&self, lane: usize) -> &Vec4;
    fn velocity(&self, lane: usize) -> &Vec4;
    fn spin(&self, lane: usize) -> &Vec4;
}

pub struct LocalBodies<'a, const CLUMPS: bool> {
    spheres: &'a [Vec4],
    centre: &'a [Vec4],
    velocity: &'a [Vec4],
    spin: &'a [Vec4],
    names: [&'a [u32; 4]; 2],
    /// Clumps and boxes only.
    body: LaneIndices,
}

impl<'a, const CLUMPS: bool> LocalBodies<'a, CLUMPS> {
    /// `names`: spheres by lane.
    ///
    /// # Safety
    /// If `CLUMPS = false`, names are below the block's body count.
    #[inline(always)]
    pub unsafe fn new<R: SimdPack>(
        block: &'a Block,
        members: &'a BlockBodies,
        names: [&'a [u32; 4]; 2],
    ) -> LocalBodies<'a, CLUMPS> {
        let mut body = [0; 8];
        if CLUMPS {
            for l in 0..R::LANES {
                body[l] = members.body(names[l / 4][l % 4]) as usize;
            }
        }
        let Block { centre, velocity, spin, .. } = block;
        LocalBodies { spheres: members.spheres(block), centre, velocity, spin, names, body }
    }

    #[inline(always)]
    pub fn body(&self, lane: usize) -> usize {
        if CLUMPS { self.body[lane] } else { self.names[lane / 4][lane % 4] as usize }
    }

    #[inline(always)]
    fn of_body(&self, list: &'a [Vec4], lane: usize) -> &'a Vec4 {
        let k = self.body(lane);
        // SAFETY: promised by the caller of `new`; lists have equal length.
        if CLUMPS { &list[k] } else { unsafe { list.get_unchecked(k) } }
    }
}

/// Whether records and sums have equal length above `most`.
pub fn within(block: &Block, totals: &BlockTotals, most: u32) -> bool {
    let n = block.centre.len();
    block.velocity.len() == n && block.spin.len() == n && totals.sums.len() == n && (most as usize) < n
}

impl<const CLUMPS: bool> BodyLanes for LocalBodies<'_, CLUMPS> {
    #[inline(always)]
    fn sphere(&self, lane: usize) -> &Vec4 {
        if CLUMPS { &self.spheres[self.names[lane / 4][lane % 4] as usize] } else { self.centre(lane) }
    }
    #[inline(always)]
    fn centre(&self, lane: usize) -> &Vec4 {
        self.of_body(self.centre, lane)
    }
    #[inline(always)]
    fn velocity(&self, lane: usize) -> &Vec4 {
        self.of_body(self.velocity, lane)
    }
    #[inline(always)]
    fn spin(&self, lane: usize) -> &Vec4 {
        self.of_body(self.spin, lane)
    }
}

pub struct RemoteBodies<'a> {
    pub blocks: BlockSlice<'a, Block>,
    pub members: BlockSlice<'a, BlockBodies>,
    /// Whether clumps are possible.
    pub rigid: bool,
    pub block: [&'a [u32; 4]; 2],
    pub sphere: [&'a [u32; 4]; 2],
    pub body: LaneIndices,
}

impl<'a> RemoteBodies<'a> {
    #[inline(always)]
    pub fn block(&self, lane: usize) -> usize {
        self.block[lane / 4][lane % 4] as usize
    }
    #[inline(always)]
    fn body(&self, lane: usize) -> usize {
        if self.rigid { self.body[lane] } else { self.sphere[lane / 4][lane % 4] as usize }
    }
}

impl BodyLanes for RemoteBodies<'_> {
    #[inline(always)]
    fn sphere(&self, lane: usize) -> &Vec4 {
        if self.rigid {
            let block = self.block(lane);
            &self.members[block].spheres(&self.blocks[block])[self.sphere[lane / 4][lane % 4] as usize]
        } else {
            self.centre(lane)
        }
    }
    #[inline(always)]
    fn centre(&self, lane: usize) -> &Vec4 {
        &self.blocks[self.block(lane)].centre[self.body(lane)]
    }
    #[inline(always)]
    fn velocity(&self, lane: usize) -> &Vec4 {
        &self.blocks[self.block(lane)].velocity[self.body(lane)]
    }
    #[inline(always)]
    fn spin(&self, lane: usize) -> &Vec4 {
        &self.blocks[self.block(lane)].spin[self.body(lane)]
    }
}
