//! How threads share the blocks.
//!
//! A contact between two blocks is computed with the first of them, while neither has moved; a block moves once all its
//! contacts are known. So one thread can go through blocks in their order: contacts with later blocks, then all that
//! concerns this block alone, its motion included, then the next. What a block reads then lies in the cache still, or
//! has been fetched meanwhile.
//!
//! Several threads take runs of neighbouring blocks, each of which is gone through like that. Contacts that reach beyond
//! their run come first, for all runs: then no thread reads a body that another one moves.

use super::block_work::BlockWork;
use super::state::BlockLists;
use crate::bodies::block::Block;
use crate::bodies::members::Members;
use crate::bodies::part::Part;
use crate::contact::dispatch;
use crate::contact::group_memory::FAR;
use crate::contact::prefetch::Prefetch;
use crate::lanes;
use crate::pairs::cross::{Cross, CrossForces, Slots};
use std::ops::Range;
use std::sync::Mutex;

/// A run is this share of what is left for each thread: large runs first, so that little reaches beyond them, and small
/// ones last, so that threads end together. Unit tests have small beds.
const SHARE: usize = if cfg!(test) { 1 } else { 2 };

/// Blocks in beds that caches do not hold: what a block reads is fetched while the one before it is computed.
const LARGE: usize = if cfg!(test) { 2 } else { 24 };

/// Lists by block: arrays of motion, constants, contacts within and their scratch; contacts with others and their slots.
pub(crate) struct Lists<'a> {
    pub blocks: &'a mut [Block],
    pub members: &'a mut [Members],
    pub lists: &'a mut [BlockLists],
    pub works: &'a mut [BlockWork],
    pub cross: &'a mut [Cross],
    pub slots: &'a mut [CrossForces],
}

impl<'a> Lists<'a> {
    /// Splits the first blocks off.
    fn split_off(&mut self, size: usize) -> Lists<'a> {
        Lists {
            blocks: self.blocks.split_off_mut(..size).unwrap_or_default(),
            members: self.members.split_off_mut(..size).unwrap_or_default(),
            lists: self.lists.split_off_mut(..size).unwrap_or_default(),
            works: self.works.split_off_mut(..size).unwrap_or_default(),
            cross: self.cross.split_off_mut(..size).unwrap_or_default(),
            slots: self.slots.split_off_mut(..size).unwrap_or_default(),
        }
    }
}

/// One block, as what concerns it alone sees it.
pub(crate) struct One<'a> {
    pub block: &'a mut Block,
    pub members: &'a mut Members,
    pub lists: &'a mut BlockLists,
    pub work: &'a mut BlockWork,
}

/// The bodies of neighbouring blocks and their constants.
pub(crate) type Bodies<'a> = (Part<'a, Block>, Part<'a, Members>);

/// Goes through the blocks `own` of all on so many threads. `between` computes a block's contacts with later ones, `within` all
/// else; `beyond` is scratch. Earlier blocks only have their contacts with these computed; none of them moves.
pub(crate) fn through(
    threads: usize,
    own: &Range<usize>,
    all: Lists<'_>,
    beyond: &mut Vec<CrossForces>,
    between: impl Fn(usize, Bodies<'_>, &mut Cross, &mut CrossForces) + Sync,
    within: impl Fn(usize, One<'_>, Slots<'_>, Prefetch<'_>) + Sync,
) {
    let count = all.blocks.len();
    if threads == 1 && own.len() == count {
        run(0, count, all, &[], &between, &within);
        return;
    }

    let bodies = (Part { first: 0, list: &*all.blocks }, Part { first: 0, list: &*all.members });
    let lists = ends(own, threads).zip(all.cross.iter_mut().zip(&mut *all.slots)).enumerate();
    let first = lists.filter(|(_, (end, (cross, _)))| reaches(cross, *end));
    share(threads, first, |(b, (_, (pairs, out)))| {
        dispatch::fetch(&bodies.0[b]);
        between(b, bodies, pairs, out);
    });

    beyond.resize_with(count, CrossForces::default);
    exchange(threads, own, all.cross, all.slots, beyond);
    let there = &beyond[..];
    let mut rest = Lists {
        blocks: &mut *all.blocks,
        members: &mut *all.members,
        lists: &mut *all.lists,
        works: &mut *all.works,
        cross: &mut *all.cross,
        slots: &mut *all.slots,
    };
    rest.split_off(own.start);
    let parts = runs(own, threads).map(move |run| (run.start, rest.split_off(run.len())));
    share(threads, parts, |(first, lists)| run(first, own.len(), lists, there, &between, &within));
    exchange(threads, own, all.cross, all.slots, beyond);
}

/// Goes through one run of `count` blocks, which begins with block `first`.
fn run(
    first: usize,
    count: usize,
    run: Lists<'_>,
    beyond: &[CrossForces],
    between: &(impl Fn(usize, Bodies<'_>, &mut Cross, &mut CrossForces) + Sync),
    within: &(impl Fn(usize, One<'_>, Slots<'_>, Prefetch<'_>) + Sync),
) {
    let large = count > LARGE;
    let end = if beyond.is_empty() { usize::MAX } else { first + run.blocks.len() };
    let Lists { blocks, members, lists, works, cross, slots } = run;
    for k in 0..blocks.len() {
        let b = first + k;
        if k == 0 || !large {
            dispatch::fetch(&blocks[k]);
        }
        lanes::prefetch_first(&lists[k].pairs.groups, FAR);
        lanes::prefetch_first(&works[k].shares.list, 8 * FAR);
        if cross[k].last_block() < end {
            let bodies = (Part { first, list: &*blocks }, Part { first, list: &*members });
            between(b, bodies, &mut cross[k], &mut slots[k]);
        }
        let (done, later) = blocks.split_at_mut(k + 1);
        let mut following = Prefetch::default();
        if let Some(next) = later.first() {
            if large {
                following.blocks = Part { first: b + 1, list: later };
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
        let slots = Slots { own: Part { first, list: slots }, beyond };
        let one =
            One { block: &mut done[k], members: &mut members[k], lists: &mut lists[k], work: &mut works[k] };
        within(b, one, slots, following);
    }
}

/// Runs of the blocks `own` for so many threads; one thread has one.
fn runs(own: &Range<usize>, threads: usize) -> impl Iterator<Item = Range<usize>> + use<> {
    let (mut at, end) = (own.start, own.end);
    std::iter::from_fn(move || {
        let left = end.saturating_sub(at);
        let size = if threads == 1 { left } else { (left / (SHARE * threads)).max(1) };
        at += size;
        (left > 0).then(|| at - size..at)
    })
}

/// Of each block up to the last of `own`, where its run ends; of those before them zero.
fn ends(own: &Range<usize>, threads: usize) -> impl Iterator<Item = usize> + use<> {
    let runs = runs(own, threads).flat_map(|run| std::iter::repeat_n(run.end, run.len()));
    std::iter::repeat_n(0, own.start).chain(runs)
}

/// Whether a block has contacts with blocks at or behind `end`, which is zero for blocks whose contacts all are such.
fn reaches(cross: &Cross, end: usize) -> bool {
    cross.last_block() >= end.max(1)
}

/// Exchanges the contacts of blocks that reach beyond their run.
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

/// Shares items among the threads of the current pool: each takes the next one when it is through with its last, so that
/// one with dear items gets few of them. Threads that do something else are not waited for.
fn share<I: Iterator + Send>(threads: usize, items: I, work: impl Fn(I::Item) + Sync) {
    let queue = Mutex::new(items);
    crew(threads, &|| {
        while let Some(item) = queue.lock().ok().and_then(|mut q| q.next()) {
            work(item);
        }
    });
}

/// Does `work` `count` times, on as many threads as are free.
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

    /// Spinning spheres of unlike sizes: forces and torques across blocks are those within a block, to rounding.
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
