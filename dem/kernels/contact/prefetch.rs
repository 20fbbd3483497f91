//! Prefetches the next block's inter-block contact data.

use crate::bodies::block::Block;
use crate::bodies::block_slice::BlockSlice;
use crate::lanes;
use crate::lanes::vec4::Vec4;
use crate::pairs::groups::Group;

/// Following blocks, contacts, slots of `width` records.
#[derive(Clone, Copy, Default)]
pub struct Prefetch<'a> {
    pub blocks: BlockSlice<'a, Block>,
    pub groups: &'a [Group<3>],
    pub slots: &'a [Vec4],
    pub width: usize,
}

pub struct Portions<'a> {
    of: Prefetch<'a>,
    /// Next body, bodies per portion.
    body: usize,
    bodies: usize,
    /// Next group, fraction due and rate [1/65536 group].
    group: usize,
    due: usize,
    rate: usize,
}

/// Prefetch distance of names before partners.
const NAMES: usize = 4;

impl<'a> Prefetch<'a> {
    pub fn is_empty(&self) -> bool {
        self.blocks.list.is_empty()
    }

    #[inline(always)]
    pub fn portions(self, count: usize) -> Portions<'a> {
        let own = self.blocks.list.first().map_or(0, |b| b.centre.len());
        let rate = (self.groups.len() << 16) / count.max(1);
        // Two bodies share a cache line.
        let bodies = own.div_ceil(count.max(1)).next_multiple_of(2);
        Portions { of: self, body: 0, bodies, group: 0, due: 0, rate }
    }
}

impl Portions<'_> {
    /// `CLUMPS`: skips partners, whose bodies would have to be read first.
    #[inline(always)]
    pub fn fetch<const CLUMPS: bool>(&mut self) {
        let Prefetch { blocks, groups, slots, width } = self.of;
        let Some(own) = blocks.list.first() else { return };
        for list in [&own.centre, &own.velocity, &own.spin] {
            lanes::far_ahead(list, self.body, self.bodies);
        }
        self.body += self.bodies;
        self.due += self.rate;
        while self.due >= 1 << 16 {
            self.due -= 1 << 16;
            lanes::far_ahead(groups, self.group + NAMES, 1);
            lanes::far_ahead(slots, 4 * self.group * width, 4 * width);
            if let (false, Some(group)) = (CLUMPS, groups.get(self.group)) {
                partners(blocks, group);
            }
            self.group += 1;
        }
    }
}

#[inline(always)]
pub fn partners(blocks: BlockSlice<'_, Block>, group: &Group<3>) {
    let [_, block, sphere] = group.names();
    for l in 0..4 {
        let Some(other) = blocks.get(block[l] as usize) else { continue };
        for list in [&other.centre, &other.velocity, &other.spin] {
            lanes::far_ahead(list, sphere[l] as usize, 1);
        }
    }
}
