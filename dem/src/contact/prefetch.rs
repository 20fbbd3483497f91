//! What the next block's contacts with others will read, fetched a little at a time while this block's are computed:
//! memory gives it up far more slowly than the arithmetic between two blocks takes, and in no order that the processor could predict.

use crate::bodies::block::Block;
use crate::bodies::part::Part;
use crate::lanes;
use crate::lanes::record::Record;
use crate::pairs::groups::Group;

/// The next block and those after it, its contacts with them, and their slots of `width` records each. By default nothing.
#[derive(Clone, Copy, Default)]
pub(crate) struct Prefetch<'a> {
    pub blocks: Part<'a, Block>,
    pub groups: &'a [Group<3>],
    pub slots: &'a [Record],
    pub width: usize,
}

/// The same in so many portions.
pub(crate) struct Portions<'a> {
    of: Prefetch<'a>,
    /// The next body to fetch, and how many per portion.
    body: usize,
    bodies: usize,
    /// The next group to fetch, how many 65536ths of one are due, and how many come with each portion.
    group: usize,
    due: usize,
    rate: usize,
}

/// Groups whose names are fetched before their partners.
const NAMES: usize = 4;

impl<'a> Prefetch<'a> {
    /// Whether there is nothing to fetch.
    pub fn is_empty(&self) -> bool {
        self.blocks.list.is_empty()
    }

    /// Splits it.
    #[inline(always)]
    pub fn portions(self, count: usize) -> Portions<'a> {
        let own = self.blocks.list.first().map_or(0, |b| b.centre.len());
        let rate = (self.groups.len() << 16) / count.max(1);
        // Two bodies share a line.
        let bodies = own.div_ceil(count.max(1)).next_multiple_of(2);
        Portions { of: self, body: 0, bodies, group: 0, due: 0, rate }
    }
}

impl Portions<'_> {
    /// Fetches the next portion. `RIGID`: spheres are not the bodies, and whose they are would have to be read first.
    #[inline(always)]
    pub fn fetch<const RIGID: bool>(&mut self) {
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
            if let (false, Some(group)) = (RIGID, groups.get(self.group)) {
                partners(blocks, group);
            }
            self.group += 1;
        }
    }
}

/// Has the records of single spheres in other blocks fetched, as far as these are given.
#[inline(always)]
pub(crate) fn partners(blocks: Part<'_, Block>, group: &Group<3>) {
    let [_, block, sphere] = group.names();
    for l in 0..4 {
        let Some(other) = blocks.get(block[l] as usize) else { continue };
        for list in [&other.centre, &other.velocity, &other.spin] {
            lanes::far_ahead(list, sphere[l] as usize, 1);
        }
    }
}
