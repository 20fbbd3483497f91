//! Contact partners in lanes.

use crate::bodies::block::Block;
use crate::bodies::members::Members;
use crate::bodies::part::Part;
use crate::bodies::sums::Tally;
use crate::lanes::Pack;
use crate::lanes::record::Record;

/// Index per lane; with four lanes the others are unused.
pub(crate) type Names = [usize; 8];

/// Contact partner in lanes, with its body's motion.
pub(crate) trait End {
    fn sphere(&self, lane: usize) -> &Record;
    fn centre(&self, lane: usize) -> &Record;
    fn velocity(&self, lane: usize) -> &Record;
    fn spin(&self, lane: usize) -> &Record;
}

pub(crate) struct Own<'a, const RIGID: bool> {
    spheres: &'a [Record],
    centre: &'a [Record],
    velocity: &'a [Record],
    spin: &'a [Record],
    names: [&'a [u32; 4]; 2],
    /// Clumps and boxes only.
    body: Names,
}

impl<'a, const RIGID: bool> Own<'a, RIGID> {
    /// `names`: spheres by lane.
    ///
    /// # Safety
    /// If `RIGID = false`, names are below the block's body count.
    #[inline(always)]
    pub unsafe fn new<R: Pack>(
        block: &'a Block,
        members: &'a Members,
        names: [&'a [u32; 4]; 2],
    ) -> Own<'a, RIGID> {
        let mut body = [0; 8];
        if RIGID {
            for l in 0..R::LANES {
                body[l] = members.body(names[l / 4][l % 4]) as usize;
            }
        }
        let Block { centre, velocity, spin, .. } = block;
        Own { spheres: members.spheres(block), centre, velocity, spin, names, body }
    }

    #[inline(always)]
    pub fn body(&self, lane: usize) -> usize {
        if RIGID { self.body[lane] } else { self.names[lane / 4][lane % 4] as usize }
    }

    #[inline(always)]
    fn of_body(&self, list: &'a [Record], lane: usize) -> &'a Record {
        let k = self.body(lane);
        // SAFETY: promised by the caller of `new`; lists have equal length.
        if RIGID { &list[k] } else { unsafe { list.get_unchecked(k) } }
    }
}

/// Whether records and sums have equal length above `most`.
pub(crate) fn within(block: &Block, tally: &Tally, most: u32) -> bool {
    let n = block.centre.len();
    block.velocity.len() == n && block.spin.len() == n && tally.sums.len() == n && (most as usize) < n
}

impl<const RIGID: bool> End for Own<'_, RIGID> {
    #[inline(always)]
    fn sphere(&self, lane: usize) -> &Record {
        if RIGID { &self.spheres[self.names[lane / 4][lane % 4] as usize] } else { self.centre(lane) }
    }
    #[inline(always)]
    fn centre(&self, lane: usize) -> &Record {
        self.of_body(self.centre, lane)
    }
    #[inline(always)]
    fn velocity(&self, lane: usize) -> &Record {
        self.of_body(self.velocity, lane)
    }
    #[inline(always)]
    fn spin(&self, lane: usize) -> &Record {
        self.of_body(self.spin, lane)
    }
}

pub(crate) struct Far<'a> {
    pub blocks: Part<'a, Block>,
    pub members: Part<'a, Members>,
    /// Whether clumps are possible.
    pub rigid: bool,
    pub block: [&'a [u32; 4]; 2],
    pub sphere: [&'a [u32; 4]; 2],
    pub body: Names,
}

impl<'a> Far<'a> {
    #[inline(always)]
    pub fn block(&self, lane: usize) -> usize {
        self.block[lane / 4][lane % 4] as usize
    }
    #[inline(always)]
    fn body(&self, lane: usize) -> usize {
        if self.rigid { self.body[lane] } else { self.sphere[lane / 4][lane % 4] as usize }
    }
}

impl End for Far<'_> {
    #[inline(always)]
    fn sphere(&self, lane: usize) -> &Record {
        if self.rigid {
            let block = self.block(lane);
            &self.members[block].spheres(&self.blocks[block])[self.sphere[lane / 4][lane % 4] as usize]
        } else {
            self.centre(lane)
        }
    }
    #[inline(always)]
    fn centre(&self, lane: usize) -> &Record {
        &self.blocks[self.block(lane)].centre[self.body(lane)]
    }
    #[inline(always)]
    fn velocity(&self, lane: usize) -> &Record {
        &self.blocks[self.block(lane)].velocity[self.body(lane)]
    }
    #[inline(always)]
    fn spin(&self, lane: usize) -> &Record {
        &self.blocks[self.block(lane)].spin[self.body(lane)]
    }
}
