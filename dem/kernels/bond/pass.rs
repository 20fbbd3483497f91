//! Bond passes of a step: between blocks (slots), within blocks, then breakage.

use super::kernel::{self, COUNT, Motion, respond, update_frame};
use super::loops::{Bonds, InterBlock, IntraBlock};
use super::slot::BondSlot;
use super::store::{BondList, BondState, Entry};
use super::{BreakMode, Constants, debonded};
use crate::base::Vec3;
use crate::base::capacity::capacity_bytes;
use crate::base::failure::Failure;
use crate::bodies::block::Block;
use crate::bodies::sums::ForceTorque;
use crate::lanes::vec4::Vec4;
use crate::lanes::{self, Simd, V3};
use crate::law::Laws;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Debonded pairs follow bonds.
#[derive(Clone, Copy, Debug)]
pub struct BondForces {
    pub place: u32,
    pub block: u32,
    pub slot: u32,
    pub first: bool,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Broken {
    pub at: u32,
    pub mode: BreakMode,
    /// Energy half a step ago [J].
    pub energy: f64,
    /// Spring compression and its energy [N, J].
    pub pressure: f64,
    pub pressed: f64,
    /// Approach speed [m/s].
    pub approach: f64,
    pub place: Vec3,
}

#[derive(Clone, Debug, Default)]
pub struct ListWork {
    pub constants: Vec<[Vec4; COUNT]>,
    pub slots: Vec<BondSlot>,
    pub found: Vec<u32>,
    pub broken: Vec<Broken>,
    pub power: f64,
    pub dashpot: f64,
    pub friction: f64,
    pub failure: Option<Failure>,
}

#[derive(Clone, Debug)]
pub struct BondWork {
    pub simd: Simd,
    pub cross: Vec<ListWork>,
    shares: Vec<Vec<BondForces>>,
}

impl Default for BondWork {
    fn default() -> BondWork {
        BondWork { simd: Simd::best(), cross: Vec::new(), shares: Vec::new() }
    }
}

impl BondWork {
    /// Contributions of bonds between blocks, in summation order.
    pub fn shares(&self, block: usize) -> &[BondForces] {
        self.shares.get(block).map_or(&[], |s| s)
    }

    /// Arranges constants and slots; `inner`: list and scratch data of each block.
    pub fn arrange<'a>(
        &mut self,
        bonds: &[Constants],
        inner: impl ExactSizeIterator<Item = (&'a BondList, &'a mut ListWork)>,
        state: &BondState,
    ) {
        self.cross.resize_with(inner.len(), ListWork::default);
        self.shares.resize_with(inner.len(), Vec::new);
        if bonds.is_empty() {
            return;
        }
        for (list, w) in inner {
            list.constants(bonds, &mut w.constants);
        }
        for (w, list) in self.cross.iter_mut().zip(&state.cross) {
            list.constants(bonds, &mut w.constants);
        }
        link(&state.cross, self);
    }
}

pub fn link(cross: &[BondList], work: &mut BondWork) {
    work.shares.iter_mut().for_each(Vec::clear);
    for (b, (list, w)) in cross.iter().zip(&mut work.cross).enumerate() {
        w.slots.clear();
        let debonded = list.debonded.iter().map(|r| (r.i, r.block, r.j));
        for (slot, (i, block, j)) in list.iter().map(|e| (e.i, e.block, e.j)).chain(debonded).enumerate() {
            w.slots.push(BondSlot::default());
            let share = BondForces { place: i, block: b as u32, slot: slot as u32, first: true };
            work.shares[b].push(share);
            work.shares[block as usize].push(BondForces { place: j, first: false, ..share });
        }
    }
}

fn motion(block: &Block, k: usize) -> Motion<f64> {
    let vector = |v: &Vec4| V3::new(v[0], v[1], v[2]);
    Motion { x: vector(&block.centre[k]), v: vector(&block.velocity[k]), w: vector(&block.spin[k]) }
}

fn describe(parts: &Parts<'_>, at: u32, e: &Entry, own: &Block, other: &Block) -> Broken {
    let k = &parts.bonds[e.number as usize].values;
    let (a, b) = (motion(own, e.i as usize), motion(other, e.j as usize));
    let mut memory = e.memory;
    let frame = update_frame(k[kernel::OFFSET], &a, &b, &mut memory, 0.0);
    let r = respond(k, &a, &b, &frame, &memory);
    let stretch = frame.length - k[kernel::LENGTH];
    let stiffness = k[kernel::STIFFNESS];
    Broken {
        at,
        mode: if r.tensile >= r.shearing { BreakMode::Tension } else { BreakMode::Shear },
        energy: kernel::half_step_energy(k, &a, &b, &e.memory, parts.dt, -0.5 * parts.dt),
        pressure: (-stiffness * stretch).max(0.0),
        pressed: 0.5 * stiffness * stretch * stretch,
        approach: -(a.v - b.v).dot(frame.normal),
        place: ((a.x + b.x) * 0.5).to_vec(),
    }
}

impl ListWork {
    pub fn reset(&mut self) {
        self.found.clear();
        self.broken.clear();
        (self.power, self.dashpot, self.friction, self.failure) = (0.0, 0.0, 0.0, None);
    }
}

#[derive(Clone, Copy)]
pub struct Parts<'a> {
    pub bonds: &'a [Constants],
    pub laws: &'a Laws,
    /// Time step [s].
    pub dt: f64,
    /// No step yet: previous motion is ignored.
    pub fresh: bool,
}

impl Parts<'_> {
    /// Time since the last step [s].
    pub fn since(&self) -> f64 {
        if self.fresh { 0.0 } else { self.dt }
    }
}

pub fn cross(
    parts: &Parts<'_>,
    blocks: &[Block],
    lists: &mut [BondList],
    work: &mut BondWork,
    parallel: bool,
) {
    let simd = work.simd;
    let one = |(b, (list, w)): (usize, (&mut BondList, &mut ListWork))| {
        w.reset();
        if list.count > 0 {
            let kernel = Bonds {
                groups: &mut list.groups,
                constants: &w.constants,
                count: list.count as usize,
                bodies: InterBlock { own: &blocks[b], blocks, slots: &mut w.slots },
                found: &mut w.found,
                dt: parts.since(),
            };
            w.power = lanes::run(simd, kernel);
        }
        for at in &w.found {
            let e = list.get(*at as usize);
            w.broken.push(describe(parts, *at, &e, &blocks[b], &blocks[e.block as usize]));
        }
        for (k, r) in list.debonded.iter_mut().enumerate() {
            let f = debonded::contact(parts.laws, &blocks[b], &blocks[r.block as usize], r, parts.dt);
            w.slots[list.count as usize + k] = f.slot;
            w.add_work(&f);
        }
    };
    if parallel {
        lists.par_iter_mut().zip(&mut work.cross).enumerate().for_each(one);
    } else {
        lists.iter_mut().zip(&mut work.cross).enumerate().for_each(one);
    }
}

impl ListWork {
    fn add_work(&mut self, f: &debonded::PairForces) {
        self.dashpot += f.dashpot;
        self.friction += f.friction;
        self.failure = self.failure.or(f.failure);
    }
}

pub fn within(
    parts: &Parts<'_>,
    b: usize,
    block: &Block,
    list: &mut BondList,
    sums: &mut [ForceTorque],
    w: &mut ListWork,
    shared: &BondWork,
) {
    for share in &shared.shares[b] {
        let slot = &shared.cross[share.block as usize].slots[share.slot as usize];
        slot.share(&mut sums[share.place as usize], share.first);
    }
    w.reset();
    if list.count > 0 {
        let kernel = Bonds {
            groups: &mut list.groups,
            constants: &w.constants,
            count: list.count as usize,
            bodies: IntraBlock { block, sums },
            found: &mut w.found,
            dt: parts.since(),
        };
        w.power = lanes::run(shared.simd, kernel);
    }
    for at in &w.found {
        let e = list.get(*at as usize);
        w.broken.push(describe(parts, *at, &e, block, block));
    }
    for r in &mut list.debonded {
        let f = debonded::contact(parts.laws, block, block, r, parts.dt);
        f.slot.share(&mut sums[r.i as usize], true);
        f.slot.share(&mut sums[r.j as usize], false);
        w.add_work(&f);
    }
}

impl ListWork {
    pub fn bytes(&self) -> usize {
        capacity_bytes(&self.constants)
            + capacity_bytes(&self.slots)
            + capacity_bytes(&self.found)
            + capacity_bytes(&self.broken)
    }
}

impl BondWork {
    pub fn bytes(&self) -> usize {
        self.cross.iter().map(ListWork::bytes).sum::<usize>()
            + self.shares.iter().map(capacity_bytes).sum::<usize>()
    }
}
