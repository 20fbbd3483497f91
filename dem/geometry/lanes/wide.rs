//! Lanes of groups of four contacts: one, or two in AVX-512.

use super::real::{Real, Simd4};
use crate::lanes::vec4::Vec4;

pub trait SimdPack: Real {
    type Quad: Simd4;
    /// Eight numbers per lane.
    type Vec4Pair: Copy;
    const GROUPS: usize;
    const LANES: usize = 4 * Self::GROUPS;

    /// One group: `second` is unused.
    fn join(first: &[f64; 4], second: &[f64; 4]) -> Self;
    /// One group: `second` is unchanged.
    fn split(self, first: &mut [f64; 4], second: &mut [f64; 4]);
    /// One group after the other.
    fn add_to(self, sum: Self::Quad) -> Self::Quad;
    /// A single group is repeated.
    fn quads(self) -> [Self::Quad; 2];
    fn twice(quad: Self::Quad) -> Self;
    /// Broadcasts lane K within each group.
    fn spread<const K: usize>(self) -> Self;
    /// Surplus numbers are ignored.
    fn of(x: &[f64; 8]) -> Self;
    /// Stores the lanes, then zeros.
    fn numbers(self) -> [f64; 8];
    /// Bit l: lane l of a mask.
    fn mask_bits(mask: Self::Mask) -> u32;
    /// A record per lane, in the order of [`SimdPack::columns`].
    fn rows<'a>(record: impl Fn(usize) -> &'a Vec4) -> [Self; 4];
    /// Two records per lane.
    fn two_rows<'a>(records: impl Fn(usize) -> (&'a Vec4, &'a Vec4)) -> ([Self; 4], [Self; 4]);
    /// Lanes below `count`.
    fn below(count: usize) -> Self::Mask;
    /// Transposes: number k of each lane's record.
    fn columns(rows: [Self; 4]) -> [Self; 4];
    /// Eight numbers per lane.
    fn records(first: [Self; 4], second: [Self; 4]) -> [Self::Vec4Pair; 8];
    /// `force` and `torque_a`; −`force` and `torque_b`; fourth numbers zero.
    #[inline(always)]
    fn opposed(
        force: [Self; 3],
        torque_a: [Self; 3],
        torque_b: [Self; 3],
    ) -> ([Self::Vec4Pair; 8], [Self::Vec4Pair; 8]) {
        let zero = Self::zero();
        let ([x, y, z], [a, b, c], [d, e, f]) = (force, torque_a, torque_b);
        (Self::records([x, y, z, zero], [a, b, c, zero]), Self::records([-x, -y, -z, zero], [d, e, f, zero]))
    }
    fn add_record(record: Self::Vec4Pair, to: &mut [Vec4; 2]);
    fn store_record(record: Self::Vec4Pair, to: &mut [Vec4; 2]);

    /// Exact product: signs are 1, 0, −1.
    #[inline(always)]
    fn less(self, o: Self, sign: Self) -> Self {
        self - o * sign
    }

    #[inline(always)]
    fn record(x: &[f64; 4]) -> Self {
        Self::join(x, x)
    }
}

impl<F: Simd4> SimdPack for F {
    type Quad = F;
    type Vec4Pair = (F, F);
    const GROUPS: usize = 1;

    #[inline(always)]
    fn join(first: &[f64; 4], _: &[f64; 4]) -> F {
        F::load(first)
    }
    #[inline(always)]
    fn split(self, first: &mut [f64; 4], _: &mut [f64; 4]) {
        self.store(first);
    }
    #[inline(always)]
    fn add_to(self, sum: F) -> F {
        sum + self
    }
    #[inline(always)]
    fn quads(self) -> [F; 2] {
        [self, self]
    }
    #[inline(always)]
    fn twice(quad: F) -> F {
        quad
    }
    #[inline(always)]
    fn spread<const K: usize>(self) -> F {
        F::splat(self.array()[K])
    }
    #[inline(always)]
    fn of(x: &[f64; 8]) -> F {
        F::load(&[x[0], x[1], x[2], x[3]])
    }
    #[inline(always)]
    fn numbers(self) -> [f64; 8] {
        let [a, b, c, d] = self.array();
        [a, b, c, d, 0.0, 0.0, 0.0, 0.0]
    }
    #[inline(always)]
    fn mask_bits(mask: F::Mask) -> u32 {
        F::bits(mask)
    }
    #[inline(always)]
    fn rows<'a>(record: impl Fn(usize) -> &'a Vec4) -> [F; 4] {
        [F::load(record(0)), F::load(record(1)), F::load(record(2)), F::load(record(3))]
    }
    #[inline(always)]
    fn two_rows<'a>(records: impl Fn(usize) -> (&'a Vec4, &'a Vec4)) -> ([F; 4], [F; 4]) {
        let (p, q, r, s) = (records(0), records(1), records(2), records(3));
        (
            [F::load(p.0), F::load(q.0), F::load(r.0), F::load(s.0)],
            [F::load(p.1), F::load(q.1), F::load(r.1), F::load(s.1)],
        )
    }
    #[inline(always)]
    fn below(count: usize) -> F::Mask {
        F::load(&[0.0, 1.0, 2.0, 3.0]).lt(F::splat(count as f64))
    }
    #[inline(always)]
    fn columns(rows: [F; 4]) -> [F; 4] {
        F::transpose(rows)
    }
    #[inline(always)]
    fn records(first: [F; 4], second: [F; 4]) -> [(F, F); 8] {
        let ([a, b, c, d], [p, q, r, s]) = (F::transpose(first), F::transpose(second));
        [(a, p), (b, q), (c, r), (d, s), (a, p), (b, q), (c, r), (d, s)]
    }
    #[inline(always)]
    fn add_record(record: (F, F), to: &mut [Vec4; 2]) {
        (F::load(&to[0]) + record.0).store(&mut to[0]);
        (F::load(&to[1]) + record.1).store(&mut to[1]);
    }
    #[inline(always)]
    fn store_record(record: (F, F), to: &mut [Vec4; 2]) {
        record.0.store(&mut to[0]);
        record.1.store(&mut to[1]);
    }
}

/// Loop over lanes.
pub trait Kernel {
    type Output;
    /// Must be `#[inline(always)]`.
    fn run<R: SimdPack>(self) -> Self::Output;
}
