//! How threads share the blocks.
//!
//! A contact between two blocks is reckoned with the first of them, while neither has moved; a block moves once all its
//! contacts are known. So one thread can go through blocks in their order: contacts with later blocks, then all that
//! concerns this block alone, its motion included, then the next. What a block reads then lies in the cache still, or
//! has been fetched meanwhile.
//!
//! Several threads take runs of neighbouring blocks, each of which is gone through like that. Contacts that reach beyond
//! their run come first, for all runs: then no thread reads a body that another one moves.

use crate::contact::coming::Coming;
use crate::contact::pass::FAR;
use crate::contact::passes;
use crate::lanes;
use crate::state::{Block, Cross};
use crate::work::{BlockWork, CrossWork};
use std::ops::Range;
use std::sync::Mutex;

/// A run is this share of what is left for each thread: large runs first, so that little reaches beyond them, and small
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
pub(crate) struct Lists<'a> {
    pub blocks: &'a mut [Block],
    pub works: &'a mut [BlockWork],
    pub cross: &'a mut [Cross],
    pub slots: &'a mut [CrossWork],
}

/// Goes through all blocks on so many threads. `between` reckons a block's contacts with later ones, `within` all else; `beyond`
/// is scratch, and `width` that of a slot.
pub(crate) fn through(
    threads: usize,
    lists: Lists<'_>,
    beyond: &mut Vec<CrossWork>,
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

    let (all, scratch) = (Part { first: 0, list: &*blocks }, Part { first: 0, list: &*works });
    let lists = ends(count, threads).zip(cross.iter_mut().zip(&mut *slots)).enumerate();
    let first = lists.filter(|(_, (end, (cross, _)))| cross.last_block() >= *end);
    share(threads, first, |(b, (_, (pairs, out)))| {
        passes::fetch(&all[b]);
        between(b, all, scratch, pairs, out);
    });

    beyond.resize_with(count, CrossWork::default);
    exchange(threads, cross, slots, beyond);
    let (mut rest, there) = ((&mut *blocks, works, &mut *cross, &mut *slots), &beyond[..]);
    let parts = runs(count, threads).map(move |run| {
        let size = run.len();
        let lists = Lists {
            blocks: rest.0.split_off_mut(..size).unwrap_or_default(),
            works: rest.1.split_off_mut(..size).unwrap_or_default(),
            cross: rest.2.split_off_mut(..size).unwrap_or_default(),
            slots: rest.3.split_off_mut(..size).unwrap_or_default(),
        };
        (run.start, lists)
    });
    share(threads, parts, |(first, lists)| go(first, lists, there));
    exchange(threads, cross, slots, beyond);
}

/// Runs of so many blocks for so many threads.
fn runs(count: usize, threads: usize) -> impl Iterator<Item = Range<usize>> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let size = ((count - at) / (SHARE * threads)).max(1);
        at += size;
        (at <= count).then(|| at - size..at)
    })
}

/// Of each block, where its run ends.
fn ends(count: usize, threads: usize) -> impl Iterator<Item = usize> {
    runs(count, threads).flat_map(|run| std::iter::repeat_n(run.end, run.len()))
}

/// Exchanges the contacts of blocks that reach beyond their run.
fn exchange(threads: usize, cross: &[Cross], slots: &mut [CrossWork], beyond: &mut [CrossWork]) {
    let lists = cross.iter().zip(slots.iter_mut().zip(beyond));
    for (end, (cross, (own, there))) in ends(cross.len(), threads).zip(lists) {
        if cross.last_block() >= end {
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
    use crate::input::{BodyInput, ModelInput};
    use crate::model::Model;
    use crate::shape::Shape;
    use crate::state::State;
    use crate::surface::NoSurface;
    use crate::testing::{SOFT, push, shaft};
    use crate::work::Work;
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
