//! SIMD loop over the bonds of a list.

use super::kernel::{self, BondHistory, COUNT, Motion, respond, update_frame};
use super::slot::BondSlot;
use super::store::Group;
use crate::bodies::block::Block;
use crate::bodies::sums::ForceTorque;
use crate::lanes::vec4::Vec4;
use crate::lanes::{Kernel, Real, Simd4, SimdPack, V3};

pub(super) struct Outcome<P: SimdPack> {
    force: V3<P>,
    torque_a: V3<P>,
    torque_b: V3<P>,
    holds: P::Mask,
}

#[inline(always)]
fn bonds<P: SimdPack>(
    a: &Motion<P>,
    b: &Motion<P>,
    constants: (&[Vec4; COUNT], &[Vec4; COUNT]),
    (g, h): (&mut Group, &mut Group),
    dt: P,
    power: &mut P::Quad,
) -> Outcome<P> {
    let mut k = [P::zero(); COUNT];
    for (k, (p, q)) in k.iter_mut().zip(constants.0.iter().zip(constants.1)) {
        *k = P::join(p, q);
    }
    let mut memory = BondHistory { shear: load::<P>(&g.shear, &h.shear), turn: load(&g.turn, &h.turn) };
    let frame = update_frame(k[kernel::OFFSET], a, b, &mut memory, dt);
    store(memory.shear, &mut g.shear, &mut h.shear);
    store(memory.turn, &mut g.turn, &mut h.turn);
    let r = respond(&k, a, b, &frame, &memory);
    let holds = kernel::holds(&r);
    *power = r.power.only(holds).add_to(*power);
    Outcome {
        force: r.force.only(holds),
        torque_a: r.torque_a.only(holds),
        torque_b: r.torque_b.only(holds),
        holds,
    }
}

#[inline(always)]
fn load<P: SimdPack>(v: &[Vec4; 3], w: &[Vec4; 3]) -> V3<P> {
    V3::new(P::join(&v[0], &w[0]), P::join(&v[1], &w[1]), P::join(&v[2], &w[2]))
}

#[inline(always)]
fn store<P: SimdPack>(v: V3<P>, to: &mut [Vec4; 3], and: &mut [Vec4; 3]) {
    v.x.split(&mut to[0], &mut and[0]);
    v.y.split(&mut to[1], &mut and[1]);
    v.z.split(&mut to[2], &mut and[2]);
}

#[inline(always)]
fn vectors<P: SimdPack>(rows: [P; 4]) -> V3<P> {
    let [x, y, z, _] = P::columns(rows);
    V3::new(x, y, z)
}

#[inline(always)]
fn own<P: SimdPack>(block: &Block, at: [&[u32; 4]; 2]) -> Motion<P> {
    let (x, v, w) = (&block.centre[..], &block.velocity[..], &block.spin[..]);
    Motion {
        x: vectors(P::rows(|l| &x[at[l / 4][l % 4] as usize])),
        v: vectors(P::rows(|l| &v[at[l / 4][l % 4] as usize])),
        w: vectors(P::rows(|l| &w[at[l / 4][l % 4] as usize])),
    }
}

#[inline(always)]
fn far<P: SimdPack>(blocks: &[Block], block: [&[u32; 4]; 2], at: [&[u32; 4]; 2]) -> Motion<P> {
    Motion {
        x: vectors(P::rows(|l| &blocks[block[l / 4][l % 4] as usize].centre[at[l / 4][l % 4] as usize])),
        v: vectors(P::rows(|l| &blocks[block[l / 4][l % 4] as usize].velocity[at[l / 4][l % 4] as usize])),
        w: vectors(P::rows(|l| &blocks[block[l / 4][l % 4] as usize].spin[at[l / 4][l % 4] as usize])),
    }
}

/// A trait, as closures with SIMD operations are not inlined into the kernel entry.
pub(super) trait Ends {
    fn motions<P: SimdPack>(&self, groups: [&Group; 2]) -> (Motion<P>, Motion<P>);
    fn take<P: SimdPack>(&mut self, groups: [&Group; 2], out: &Outcome<P>, first: usize, count: usize);
}

pub(super) struct IntraBlock<'a> {
    pub block: &'a Block,
    pub sums: &'a mut [ForceTorque],
}

impl Ends for IntraBlock<'_> {
    #[inline(always)]
    fn motions<P: SimdPack>(&self, [g, h]: [&Group; 2]) -> (Motion<P>, Motion<P>) {
        (own(self.block, [&g.i, &h.i]), own(self.block, [&g.j, &h.j]))
    }

    #[inline(always)]
    fn take<P: SimdPack>(&mut self, [g, h]: [&Group; 2], out: &Outcome<P>, _: usize, count: usize) {
        let (on_a, on_b) = P::opposed(out.force.array(), out.torque_a.array(), out.torque_b.array());
        let (i, j) = ([&g.i, &h.i], [&g.j, &h.j]);
        for l in 0..count {
            P::add_record(on_a[l], &mut self.sums[i[l / 4][l % 4] as usize].0);
            P::add_record(on_b[l], &mut self.sums[j[l / 4][l % 4] as usize].0);
        }
    }
}

/// First body in this block, second in any.
pub(super) struct InterBlock<'a> {
    pub own: &'a Block,
    pub blocks: &'a [Block],
    pub slots: &'a mut [BondSlot],
}

impl Ends for InterBlock<'_> {
    #[inline(always)]
    fn motions<P: SimdPack>(&self, [g, h]: [&Group; 2]) -> (Motion<P>, Motion<P>) {
        (own(self.own, [&g.i, &h.i]), far(self.blocks, [&g.block, &h.block], [&g.j, &h.j]))
    }

    #[inline(always)]
    fn take<P: SimdPack>(&mut self, _: [&Group; 2], out: &Outcome<P>, first: usize, count: usize) {
        let zero = P::zero();
        let [f, a, b] = [out.force, out.torque_a, out.torque_b];
        let on_a = P::records([f.x, f.y, f.z, zero], [a.x, a.y, a.z, zero]);
        let on_b = P::records([b.x, b.y, b.z, zero], [zero; 4]);
        for (l, slot) in self.slots[first..][..count].iter_mut().enumerate() {
            let (mut a, mut b) = ([Vec4::default(); 2], [Vec4::default(); 2]);
            P::store_record(on_a[l], &mut a);
            P::store_record(on_b[l], &mut b);
            *slot = BondSlot { force: a[0], torque_a: a[1], torque_b: b[0] };
        }
    }
}

/// Returns dashpot power.
pub(super) struct Bonds<'a, B> {
    pub groups: &'a mut [Group],
    pub constants: &'a [[Vec4; COUNT]],
    pub count: usize,
    pub bodies: B,
    /// Positions of breaking bonds.
    pub found: &'a mut Vec<u32>,
    /// Time since the last step [s].
    pub dt: f64,
}

impl<B: Ends> Kernel for Bonds<'_, B> {
    type Output = f64;

    #[inline(always)]
    fn run<P: SimdPack>(self) -> f64 {
        let Bonds { groups, constants, count, mut bodies, found, dt } = self;
        let Some(&spare) = groups.first() else { return 0.0 };
        // Unused lanes repeat a real pair with zero constants.
        let (mut spare, none) = (spare, [Vec4::default(); COUNT]);
        let constants = &constants[..groups.len()];
        let dt = P::splat(dt);
        let mut power = P::Quad::zero();
        for number in (0..groups.len()).step_by(P::GROUPS) {
            let k = (&constants[number], constants.get(number + 1).unwrap_or(&none));
            let (g, h) = match &mut groups[number..] {
                [g, h, ..] => (g, h),
                [g] => (g, &mut spare),
                [] => break,
            };
            let (a, b) = bodies.motions([g, h]);
            let live = (count - 4 * number).min(P::LANES);
            let out = bonds(&a, &b, k, (g, h), dt, &mut power);
            bodies.take([g, h], &out, 4 * number, live);
            if !P::all(out.holds) {
                let holds = P::mask_bits(out.holds);
                found.extend((0..live).filter(|l| holds >> l & 1 == 0).map(|l| (4 * number + l) as u32));
            }
        }
        power.sum()
    }
}
