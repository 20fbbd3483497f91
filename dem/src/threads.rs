//! How threads share the blocks.
//!
//! A contact between two blocks is reckoned with the first of them, while neither has moved; a block moves once all its
//! contacts are known. So one thread can go through blocks in their order: contacts with later blocks, then all that
//! concerns this block alone, its motion included, then the next. What a block reads then lies in the cache still, or
//! has been fetched meanwhile.
//!
//! Several threads take runs of neighbouring blocks, each of which is gone through like that. Contacts that reach beyond
//! their run come first, for all runs: then no thread reads a body that another one moves. Each thread has a share of the runs, the
//! same in every step, so that its caches hold it still; one that is through with its own helps where most is left.

use crate::contact::coming::Coming;
use crate::contact::pass::FAR;
use crate::contact::passes;
use crate::lanes;
use crate::state::{Block, Cross};
use crate::work::{BlockWork, CrossWork};
use std::ops::Range;
use std::sync::Mutex;

/// A run is this part of what is left of a thread's share: large runs first, so that little reaches beyond them, and small
/// ones last, so that threads end together. Unit tests have small beds.
const SHARE: usize = if cfg!(test) { 1 } else { 2 };

/// Blocks in beds that caches do not hold: what a block reads is fetched while the one before it is reckoned.
const LARGE: usize = if cfg!(test) { 2 } else { 24 };

/// Neighbouring items of a list, by their places in the whole.
#[derive(Debug)]
pub(crate) struct Part<'a, T> {
    pub first: usize,
    pub list: &'a [T],
}

impl<T> Clone for Part<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Part<'_, T> {}

impl<T> Default for Part<'_, T> {
    fn default() -> Self {
        Part { first: 0, list: &[] }
    }
}

impl<T> Part<'_, T> {
    /// The item at a place of the whole, if it is of this part.
    #[inline(always)]
    pub fn get(&self, at: usize) -> Option<&T> {
        self.list.get(at.wrapping_sub(self.first))
    }
}

impl<T> std::ops::Index<usize> for Part<'_, T> {
    type Output = T;
    #[inline(always)]
    fn index(&self, at: usize) -> &T {
        &self.list[at.wrapping_sub(self.first)]
    }
}

/// Contacts of blocks with others, as those who gather them see them: of the run's own blocks, and of all whose contacts reach
/// beyond their run.
#[derive(Clone, Copy)]
pub(crate) struct Slots<'a> {
    own: Part<'a, CrossWork>,
    beyond: &'a [CrossWork],
}

impl Slots<'_> {
    /// Those of a block.
    #[inline(always)]
    pub fn of(&self, block: usize) -> &CrossWork {
        match self.beyond.get(block) {
            Some(there) if !there.slots.is_empty() => there,
            _ => &self.own[block],
        }
    }
}

/// Lists by block: the blocks, their scratch, and their contacts with others.
#[derive(Default)]
pub(crate) struct Lists<'a> {
    pub blocks: &'a mut [Block],
    pub works: &'a mut [BlockWork],
    pub cross: &'a mut [Cross],
    pub slots: &'a mut [CrossWork],
}

/// Scratch of [`through`].
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    /// Contacts of blocks that reach beyond their run.
    beyond: Vec<CrossWork>,
    runs: Runs,
}

/// Goes through all blocks on so many threads. `between` reckons a block's contacts with later ones, `within` all else; `width` is
/// that of a slot.
pub(crate) fn through(
    threads: usize,
    lists: Lists<'_>,
    scratch: &mut Scratch,
    width: usize,
    between: impl Fn(usize, Part<'_, Block>, Part<'_, BlockWork>, &mut Cross, &mut CrossWork) + Sync,
    within: impl Fn(usize, &mut Block, &mut BlockWork, Slots<'_>, Coming<'_>) + Sync,
) {
    let Lists { blocks, works, cross, slots } = lists;
    let count = blocks.len();
    let large = count > LARGE;
    let go = |first: usize, lists: Lists<'_>, beyond: &[CrossWork]| {
        let end = if beyond.is_empty() { usize::MAX } else { first + lists.blocks.len() };
        let Lists { blocks, works, cross, slots } = lists;
        for k in 0..blocks.len() {
            let b = first + k;
            if k == 0 || !large {
                passes::fetch(&blocks[k]);
            }
            lanes::prefetch_first(&blocks[k].pairs.groups, FAR);
            lanes::prefetch_first(&works[k].gather, 8 * FAR);
            if cross[k].last_block() < end {
                let (all, scratch) = (Part { first, list: &*blocks }, Part { first, list: &*works });
                between(b, all, scratch, &mut cross[k], &mut slots[k]);
            }
            let (done, later) = blocks.split_at_mut(k + 1);
            let mut coming = Coming::default();
            if let Some(next) = later.first() {
                if large {
                    coming.blocks = Part { first: b + 1, list: later };
                    if cross[k + 1].last_block() < end {
                        coming.groups = &cross[k + 1].spheres.groups;
                        (coming.slots, coming.width) = (&slots[k + 1].slots, width);
                    }
                } else {
                    passes::fetch(next);
                }
                lanes::prefetch_first(&cross[k + 1].spheres.groups, FAR);
                lanes::prefetch_first(&slots[k + 1].slots, 2 * FAR);
            }
            let slots = Slots { own: Part { first, list: slots }, beyond };
            within(b, &mut done[k], &mut works[k], slots, coming);
        }
    };
    if threads == 1 {
        go(0, Lists { blocks, works, cross, slots }, &[]);
        return;
    }

    let Scratch { beyond, runs } = scratch;
    runs.lay_out(count, threads);
    let runs = &*runs;
    let (all, works_of_all) = (Part { first: 0, list: &*blocks }, Part { first: 0, list: &*works });
    share(runs, Outer { cross: &mut *cross, slots: &mut *slots }, |run, Outer { cross, slots }| {
        for (b, (pairs, out)) in run.clone().zip(cross.iter_mut().zip(slots)) {
            if pairs.last_block() >= run.end {
                passes::fetch(&all[b]);
                between(b, all, works_of_all, pairs, out);
            }
        }
    });
    beyond.resize_with(count, CrossWork::default);
    exchange(runs, cross, slots, beyond);
    let there = &beyond[..];
    let lists = Lists { blocks, works, cross: &mut *cross, slots: &mut *slots };
    share(runs, lists, |run, lists| go(run.start, lists, there));
    exchange(runs, cross, slots, beyond);
}

/// Runs of neighbouring blocks, and whose they are.
#[derive(Clone, Debug, Default)]
struct Runs {
    blocks: usize,
    list: Vec<Range<usize>>,
    /// Places in the list, by thread.
    shares: Vec<Range<usize>>,
}

impl Runs {
    /// So many blocks for so many threads.
    fn lay_out(&mut self, blocks: usize, threads: usize) {
        if (self.blocks, self.shares.len()) == (blocks, threads) {
            return;
        }
        self.blocks = blocks;
        self.list.clear();
        self.shares.clear();
        for thread in 0..threads {
            let first = self.list.len();
            let (mut at, end) = (blocks * thread / threads, blocks * (thread + 1) / threads);
            while at < end {
                let size = ((end - at) / SHARE).max(1);
                self.list.push(at..at + size);
                at += size;
            }
            self.shares.push(first..self.list.len());
        }
    }
}

/// Exchanges the contacts of blocks that reach beyond their run.
fn exchange(runs: &Runs, cross: &[Cross], slots: &mut [CrossWork], beyond: &mut [CrossWork]) {
    for run in &runs.list {
        for b in run.clone().filter(|&b| cross[b].last_block() >= run.end) {
            std::mem::swap(&mut slots[b], &mut beyond[b]);
        }
    }
}

/// Lists by block that are cut into runs.
trait Piece: Default + Send {
    /// The first so many blocks, and the rest.
    fn split(self, count: usize) -> (Self, Self);
}

impl Piece for Lists<'_> {
    fn split(self, count: usize) -> (Self, Self) {
        let Lists { blocks, works, cross, slots } = self;
        let (blocks, works) = (blocks.split_at_mut(count), works.split_at_mut(count));
        let (cross, slots) = (cross.split_at_mut(count), slots.split_at_mut(count));
        (
            Lists { blocks: blocks.0, works: works.0, cross: cross.0, slots: slots.0 },
            Lists { blocks: blocks.1, works: works.1, cross: cross.1, slots: slots.1 },
        )
    }
}

/// Contacts with other blocks, and their slots.
#[derive(Default)]
struct Outer<'a> {
    cross: &'a mut [Cross],
    slots: &'a mut [CrossWork],
}

impl Piece for Outer<'_> {
    fn split(self, count: usize) -> (Self, Self) {
        let (cross, slots) = (self.cross.split_at_mut(count), self.slots.split_at_mut(count));
        (Outer { cross: cross.0, slots: slots.0 }, Outer { cross: cross.1, slots: slots.1 })
    }
}

/// What is left of a thread's share: places of runs, and their lists.
struct Left<P> {
    runs: Range<usize>,
    lists: P,
}

/// Takes the next run for thread `own`: the first of its share, or, when it has none, the last of the longest.
fn next<P: Piece>(left: &mut [Left<P>], own: usize, runs: &Runs) -> Option<(Range<usize>, P)> {
    let longest = || (0..left.len()).max_by_key(|&k| left[k].runs.len());
    let of = if left[own].runs.is_empty() { longest()? } else { own };
    let Left { runs: places, lists } = &mut left[of];
    let rest = std::mem::take(lists);
    if of == own {
        let run = runs.list[places.next()?].clone();
        let (first, rest) = rest.split(run.len());
        *lists = rest;
        Some((run, first))
    } else {
        let run = runs.list[places.next_back()?].clone();
        let before = if places.start < places.end { run.start - runs.list[places.start].start } else { 0 };
        let (rest, last) = rest.split(before);
        *lists = rest;
        Some((run, last))
    }
}

/// Shares runs among the threads of the current pool. Threads that do something else are not waited for.
fn share<P: Piece>(runs: &Runs, whole: P, work: impl Fn(Range<usize>, P) + Sync) {
    let threads = runs.shares.len();
    let mut rest = whole;
    let shares = runs.shares.iter().map(|places| {
        let (lists, after) =
            std::mem::take(&mut rest).split(runs.list[places.clone()].iter().map(Range::len).sum());
        rest = after;
        Left { runs: places.clone(), lists }
    });
    let left = Mutex::new(shares.collect::<Vec<_>>());
    crew(threads, &|| {
        let own = rayon::current_thread_index().unwrap_or(0) % threads;
        while let Some((run, lists)) = left.lock().ok().and_then(|mut left| next(&mut left, own, runs)) {
            work(run, lists);
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
    use super::{Left, Piece, Runs, next};
    use crate::input::{BodyInput, ModelInput};
    use crate::model::Model;
    use crate::shape::Shape;
    use crate::state::State;
    use crate::surface::NoSurface;
    use crate::testing::{SOFT, push, shaft};
    use crate::work::Work;
    use crate::{Material, Vec3};

    impl Piece for Vec<usize> {
        fn split(mut self, count: usize) -> (Self, Self) {
            let rest = self.split_off(count);
            (self, rest)
        }
    }

    /// Whoever asks: each run is given out once, with the blocks that it names; a thread gets its own first, in their order.
    #[test]
    fn every_run_is_taken_once() {
        for (blocks, threads) in [(1, 2), (10, 2), (37, 3), (5, 7), (64, 7)] {
            let mut runs = Runs::default();
            runs.lay_out(blocks, threads);
            for asked in 0..20 {
                let mut left: Vec<_> = runs
                    .shares
                    .iter()
                    .map(|own| {
                        let lists: Vec<usize> = runs.list[own.clone()].iter().cloned().flatten().collect();
                        Left { runs: own.clone(), lists }
                    })
                    .collect();
                let (mut taken, mut of_first, mut turn) = (Vec::new(), Vec::new(), 1_usize);
                loop {
                    // Always the first thread, or each in some order.
                    turn = turn.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(asked);
                    let own = if asked == 0 { 0 } else { (turn >> 33) % threads };
                    let Some((run, lists)) = next(&mut left, own, &runs) else { break };
                    assert_eq!(run.clone().collect::<Vec<_>>(), lists);
                    if own == 0 {
                        of_first.push(run.start);
                    }
                    taken.extend(run);
                }
                let share: Vec<_> = runs.list[runs.shares[0].clone()].iter().map(|run| run.start).collect();
                assert!(asked > 0 || of_first.starts_with(&share), "{of_first:?} {share:?}");
                taken.sort_unstable();
                assert_eq!(taken, (0..blocks).collect::<Vec<_>>(), "{blocks} blocks, {threads} threads");
            }
        }
    }

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
