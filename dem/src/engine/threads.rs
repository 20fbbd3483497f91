//! Distribution of blocks over threads.
//!
//! Contacts between two blocks are computed with the first, before either moves. Threads process contiguous
//! ranges; contacts beyond a range come first, so no thread reads moving bodies.

use super::block_work::BlockWork;
use super::state::BlockLists;
use crate::bodies::block::Block;
use crate::bodies::block_bodies::BlockBodies;
use crate::bodies::block_slice::BlockSlice;
use crate::contact::dispatch;
use crate::contact::group_history::FAR;
use crate::contact::prefetch::Prefetch;
use crate::lanes;
use crate::pairs::cross::{Cross, CrossForces, Slots};
use std::ops::Range;
use std::sync::Mutex;

/// Large ranges first, small ones last for balance.
const SHARE: usize = if cfg!(test) { 1 } else { 2 };

/// Blocks that exceed the caches: prefetch pays.
const LARGE: usize = if cfg!(test) { 2 } else { 24 };

pub(crate) struct BlockArrays<'a> {
    pub blocks: &'a mut [Block],
    pub members: &'a mut [BlockBodies],
    pub lists: &'a mut [BlockLists],
    pub works: &'a mut [BlockWork],
    pub cross: &'a mut [Cross],
    pub slots: &'a mut [CrossForces],
}

impl<'a> BlockArrays<'a> {
    fn split_off(&mut self, size: usize) -> BlockArrays<'a> {
        BlockArrays {
            blocks: self.blocks.split_off_mut(..size).unwrap_or_default(),
            members: self.members.split_off_mut(..size).unwrap_or_default(),
            lists: self.lists.split_off_mut(..size).unwrap_or_default(),
            works: self.works.split_off_mut(..size).unwrap_or_default(),
            cross: self.cross.split_off_mut(..size).unwrap_or_default(),
            slots: self.slots.split_off_mut(..size).unwrap_or_default(),
        }
    }
}

/// View of one block.
pub(crate) struct BlockTask<'a> {
    pub block: &'a mut Block,
    pub members: &'a mut BlockBodies,
    pub lists: &'a mut BlockLists,
    pub work: &'a mut BlockWork,
}

pub(crate) type Bodies<'a> = (BlockSlice<'a, Block>, BlockSlice<'a, BlockBodies>);

/// `between`: contacts with later blocks; `within`: the rest; `beyond`: scratch.
pub(crate) fn run_blocks(
    threads: usize,
    own: &Range<usize>,
    all: BlockArrays<'_>,
    beyond: &mut Vec<CrossForces>,
    between: impl Fn(usize, Bodies<'_>, &mut Cross, &mut CrossForces) + Sync,
    within: impl Fn(usize, BlockTask<'_>, Slots<'_>, Prefetch<'_>) + Sync,
) {
    let count = all.blocks.len();
    if threads == 1 && own.len() == count {
        run(0, count, all, &[], &between, &within);
        return;
    }

    let bodies = (BlockSlice { first: 0, list: &*all.blocks }, BlockSlice { first: 0, list: &*all.members });
    let lists = ends(own, threads).zip(all.cross.iter_mut().zip(&mut *all.slots)).enumerate();
    let first = lists.filter(|(_, (end, (cross, _)))| reaches(cross, *end));
    share(threads, first, |(b, (_, (pairs, out)))| {
        dispatch::fetch(&bodies.0[b]);
        between(b, bodies, pairs, out);
    });

    beyond.resize_with(count, CrossForces::default);
    exchange(threads, own, all.cross, all.slots, beyond);
    let there = &beyond[..];
    let mut rest = BlockArrays {
        blocks: &mut *all.blocks,
        members: &mut *all.members,
        lists: &mut *all.lists,
        works: &mut *all.works,
        cross: &mut *all.cross,
        slots: &mut *all.slots,
    };
    rest.split_off(own.start);
    let parts = partition(own, threads).map(move |run| (run.start, rest.split_off(run.len())));
    share(threads, parts, |(first, lists)| run(first, own.len(), lists, there, &between, &within));
    exchange(threads, own, all.cross, all.slots, beyond);
}

fn run(
    first: usize,
    count: usize,
    run: BlockArrays<'_>,
    beyond: &[CrossForces],
    between: &(impl Fn(usize, Bodies<'_>, &mut Cross, &mut CrossForces) + Sync),
    within: &(impl Fn(usize, BlockTask<'_>, Slots<'_>, Prefetch<'_>) + Sync),
) {
    let large = count > LARGE;
    let end = if beyond.is_empty() { usize::MAX } else { first + run.blocks.len() };
    let BlockArrays { blocks, members, lists, works, cross, slots } = run;
    for k in 0..blocks.len() {
        let b = first + k;
        if k == 0 || !large {
            dispatch::fetch(&blocks[k]);
        }
        lanes::prefetch_first(&lists[k].pairs.groups, FAR);
        lanes::prefetch_first(&works[k].shares.list, 8 * FAR);
        if cross[k].last_block() < end {
            let bodies = (BlockSlice { first, list: &*blocks }, BlockSlice { first, list: &*members });
            between(b, bodies, &mut cross[k], &mut slots[k]);
        }
        let (done, later) = blocks.split_at_mut(k + 1);
        let mut following = Prefetch::default();
        if let Some(next) = later.first() {
            if large {
                following.blocks = BlockSlice { first: b + 1, list: later };
                if cross[k + 1].last_block() < end {
                    following.groups = &cross[k + 1].spheres.groups;
                    (following.slots, following.width) = (&slots[k + 1].slots, slots[k + 1].width);
                }
            } else {
                dispatch::fetch(next);
            }
            lanes::prefetch_first(&cross[k + 1].spheres.groups, FAR);
            lanes::prefetch_first(&slots[k + 1].slots, 2 * FAR);
        }
        let slots = Slots { own: BlockSlice { first, list: slots }, beyond };
        let one = BlockTask {
            block: &mut done[k],
            members: &mut members[k],
            lists: &mut lists[k],
            work: &mut works[k],
        };
        within(b, one, slots, following);
    }
}

fn partition(own: &Range<usize>, threads: usize) -> impl Iterator<Item = Range<usize>> + use<> {
    let (mut at, end) = (own.start, own.end);
    std::iter::from_fn(move || {
        let left = end.saturating_sub(at);
        let size = if threads == 1 { left } else { (left / (SHARE * threads)).max(1) };
        at += size;
        (left > 0).then(|| at - size..at)
    })
}

/// End of each block's range; zero before `own`.
fn ends(own: &Range<usize>, threads: usize) -> impl Iterator<Item = usize> + use<> {
    let runs = partition(own, threads).flat_map(|run| std::iter::repeat_n(run.end, run.len()));
    std::iter::repeat_n(0, own.start).chain(runs)
}

/// Zero includes all contacts.
fn reaches(cross: &Cross, end: usize) -> bool {
    cross.last_block() >= end.max(1)
}

fn exchange(
    threads: usize,
    own: &Range<usize>,
    cross: &[Cross],
    slots: &mut [CrossForces],
    beyond: &mut [CrossForces],
) {
    let lists = cross.iter().zip(slots.iter_mut().zip(beyond));
    for (end, (cross, (own, there))) in ends(own, threads).zip(lists) {
        if reaches(cross, end) {
            std::mem::swap(own, there);
        }
    }
}

/// Dynamic distribution for load balance, without waiting for busy threads.
fn share<I: Iterator + Send>(threads: usize, items: I, work: impl Fn(I::Item) + Sync) {
    let queue = Mutex::new(items);
    crew(threads, &|| {
        while let Some(item) = queue.lock().ok().and_then(|mut q| q.next()) {
            work(item);
        }
    });
}

fn crew(count: usize, work: &(impl Fn() + Sync)) {
    match count {
        0 | 1 => work(),
        _ => _ = rayon::join(|| crew(count / 2, work), || crew(count - count / 2, work)),
    }
}

#[cfg(test)]
mod tests {
    use crate::bodies::input::BodyInput;
    use crate::engine::input::ModelInput;
    use crate::engine::model::Model;
    use crate::engine::state::State;
    use crate::engine::work::Work;
    use crate::shape::Shape;
    use crate::spatial::surface::NoSurface;
    use crate::testing::{SOFT, push, shaft};
    use crate::{Material, Vec3};

    #[test]
    fn blocks_do_not_show() {
        for rolling_friction in [0.0, 0.1] {
            let run = |block: usize| {
                let material = Material { rolling_friction, ..SOFT };
                let mut input = ModelInput {
                    materials: vec![material],
                    planes: shaft(0.1, &[]),
                    ..ModelInput::default()
                };
                input.shapes.push(Shape::Sphere { radius: 0.01 });
                for k in 0..216_usize {
                    let cell = Vec3::new((k % 6) as f64, (k / 6 % 6) as f64, (k / 36) as f64 + 0.6);
                    input.bodies.push(BodyInput {
                        scale: 1.0 + 0.4 * push(k).x.signum(),
                        position: cell * 0.019,
                        spin: push(k) * 30.0,
                        ..BodyInput::default()
                    });
                }
                let mut model = Model::new(input).unwrap();
                model.block = block;
                let mut state = State::new(&model);
                let mut work = Work::new(&model, &state);
                assert_eq!(state.blocks.len(), 216_usize.div_ceil(block));
                for _ in 0..20 {
                    crate::step(&model, &mut state, &mut work, &NoSurface, &[]).unwrap();
                }
                let across: usize = state.cross.iter().map(|c| c.spheres.len()).sum();
                let motion = (0..216).map(|b| [state.velocity(b), state.spin(b) * 0.01]);
                (motion.collect::<Vec<_>>(), across)
            };
            let ((one, none), (many, across)) = (run(216), run(20));
            assert!(none == 0 && across > 100, "{none} {across}");
            let size = one.iter().flatten().map(Vec3::norm).fold(0.0, f64::max);
            let off = one.iter().flatten().zip(many.iter().flatten()).map(|(a, b)| (a - b).norm());
            let off = off.fold(0.0, f64::max);
            assert!(off < 1e-10 * size, "{off:e} of {size:e}");
        }
    }
}
