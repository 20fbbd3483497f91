//! Eight lanes in an AVX-512 register: two groups of four.

use super::avx2::Avx2;
use crate::lanes::real::{Real, Simd4};
use crate::lanes::vec4::Vec4;
use crate::lanes::wide::SimdPack;
use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

#[derive(Clone, Copy, Debug)]
pub struct Avx512(__m512d);

/// Mask: a bit per lane.
#[derive(Clone, Copy, Debug)]
pub struct Avx512Mask(__mmask8);

macro_rules! lanewise {
    ($trait:ident, $f:ident, $op:ident) => {
        impl $trait for Avx512 {
            type Output = Avx512;
            #[inline(always)]
            fn $f(self, o: Avx512) -> Avx512 {
                Avx512(intrinsics!($op(self.0, o.0)))
            }
        }
    };
}
lanewise!(Add, add, _mm512_add_pd);
lanewise!(Sub, sub, _mm512_sub_pd);
lanewise!(Mul, mul, _mm512_mul_pd);
lanewise!(Div, div, _mm512_div_pd);

impl Neg for Avx512 {
    type Output = Avx512;
    #[inline(always)]
    fn neg(self) -> Avx512 {
        Avx512(intrinsics!(_mm512_xor_pd(self.0, _mm512_set1_pd(-0.0))))
    }
}

impl BitAnd for Avx512Mask {
    type Output = Avx512Mask;
    #[inline(always)]
    fn bitand(self, o: Avx512Mask) -> Avx512Mask {
        Avx512Mask(self.0 & o.0)
    }
}

impl BitOr for Avx512Mask {
    type Output = Avx512Mask;
    #[inline(always)]
    fn bitor(self, o: Avx512Mask) -> Avx512Mask {
        Avx512Mask(self.0 | o.0)
    }
}

impl Not for Avx512Mask {
    type Output = Avx512Mask;
    #[inline(always)]
    fn not(self) -> Avx512Mask {
        Avx512Mask(!self.0)
    }
}

impl Real for Avx512 {
    type Mask = Avx512Mask;
    const NUMBERS: usize = 8;

    #[inline(always)]
    fn splat(x: f64) -> Avx512 {
        Avx512(intrinsics!(_mm512_set1_pd(x)))
    }
    #[inline(always)]
    fn sqrt(self) -> Avx512 {
        Avx512(intrinsics!(_mm512_sqrt_pd(self.0)))
    }
    #[inline(always)]
    fn abs(self) -> Avx512 {
        Avx512(intrinsics!(_mm512_abs_pd(self.0)))
    }
    #[inline(always)]
    fn min(self, other: Avx512) -> Avx512 {
        Avx512(intrinsics!(_mm512_min_pd(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Avx512) -> Avx512 {
        Avx512(intrinsics!(_mm512_max_pd(self.0, other.0)))
    }
    #[inline(always)]
    fn lt(self, other: Avx512) -> Avx512Mask {
        Avx512Mask(intrinsics!(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn le(self, other: Avx512) -> Avx512Mask {
        Avx512Mask(intrinsics!(_mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn equals(self, other: Avx512) -> Avx512Mask {
        Avx512Mask(intrinsics!(_mm512_cmp_pd_mask::<_CMP_EQ_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn select(mask: Avx512Mask, yes: Avx512, no: Avx512) -> Avx512 {
        Avx512(intrinsics!(_mm512_mask_blend_pd(mask.0, no.0, yes.0)))
    }
    #[inline(always)]
    fn any(mask: Avx512Mask) -> bool {
        mask.0 != 0
    }
    #[inline(always)]
    fn all(mask: Avx512Mask) -> bool {
        mask.0 == 255
    }
}

/// Concatenates two records.
#[inline(always)]
fn both(low: &[f64; 4], high: &[f64; 4]) -> Avx512 {
    Avx512(intrinsics!({
        let low = _mm512_castpd256_pd512(_mm256_loadu_pd(low.as_ptr()));
        _mm512_insertf64x4::<1>(low, _mm256_loadu_pd(high.as_ptr()))
    }))
}

/// Numbers of lanes (0, 2), (1, 3), (4, 6), (5, 7), as two pairs of the first and two of the last numbers.
#[inline(always)]
fn halves([Avx512(a), Avx512(b), Avx512(c), Avx512(d)]: [Avx512; 4]) -> [Avx512; 4] {
    intrinsics!({
        let (ab_even, ab_odd) = (_mm512_unpacklo_pd(a, b), _mm512_unpackhi_pd(a, b));
        let (cd_even, cd_odd) = (_mm512_unpacklo_pd(c, d), _mm512_unpackhi_pd(c, d));
        [
            Avx512(_mm512_shuffle_f64x2::<0x44>(ab_even, cd_even)),
            Avx512(_mm512_shuffle_f64x2::<0x44>(ab_odd, cd_odd)),
            Avx512(_mm512_shuffle_f64x2::<0xee>(ab_even, cd_even)),
            Avx512(_mm512_shuffle_f64x2::<0xee>(ab_odd, cd_odd)),
        ]
    })
}

/// Eight numbers per lane, from two results of [`halves`].
#[inline(always)]
fn join(p: [Avx512; 4], q: [Avx512; 4]) -> [Avx512; 8] {
    intrinsics!({
        [
            Avx512(_mm512_shuffle_f64x2::<0x88>(p[0].0, q[0].0)),
            Avx512(_mm512_shuffle_f64x2::<0x88>(p[1].0, q[1].0)),
            Avx512(_mm512_shuffle_f64x2::<0xdd>(p[0].0, q[0].0)),
            Avx512(_mm512_shuffle_f64x2::<0xdd>(p[1].0, q[1].0)),
            Avx512(_mm512_shuffle_f64x2::<0x88>(p[2].0, q[2].0)),
            Avx512(_mm512_shuffle_f64x2::<0x88>(p[3].0, q[3].0)),
            Avx512(_mm512_shuffle_f64x2::<0xdd>(p[2].0, q[2].0)),
            Avx512(_mm512_shuffle_f64x2::<0xdd>(p[3].0, q[3].0)),
        ]
    })
}

impl SimdPack for Avx512 {
    type Quad = Avx2;
    type Vec4Pair = Avx512;
    const GROUPS: usize = 2;

    #[inline(always)]
    fn join(first: &[f64; 4], second: &[f64; 4]) -> Avx512 {
        both(first, second)
    }
    #[inline(always)]
    fn less(self, o: Avx512, sign: Avx512) -> Avx512 {
        // One rounding: the product is exact.
        Avx512(intrinsics!(_mm512_fnmadd_pd(o.0, sign.0, self.0)))
    }
    #[inline(always)]
    fn split(self, first: &mut [f64; 4], second: &mut [f64; 4]) {
        let [low, high] = self.quads();
        low.store(first);
        high.store(second);
    }
    #[inline(always)]
    fn add_to(self, sum: Avx2) -> Avx2 {
        let [low, high] = self.quads();
        sum + low + high
    }
    #[inline(always)]
    fn quads(self) -> [Avx2; 2] {
        intrinsics!({
            [Avx2::of(_mm512_castpd512_pd256(self.0)), Avx2::of(_mm512_extractf64x4_pd::<1>(self.0))]
        })
    }
    #[inline(always)]
    fn twice(quad: Avx2) -> Avx512 {
        Avx512(intrinsics!(_mm512_broadcast_f64x4(quad.register())))
    }
    #[inline(always)]
    fn spread<const K: usize>(self) -> Avx512 {
        Avx512(intrinsics!({
            match K {
                0 => _mm512_permutex_pd::<0x00>(self.0),
                1 => _mm512_permutex_pd::<0x55>(self.0),
                2 => _mm512_permutex_pd::<0xaa>(self.0),
                _ => _mm512_permutex_pd::<0xff>(self.0),
            }
        }))
    }
    #[inline(always)]
    fn of(x: &[f64; 8]) -> Avx512 {
        Avx512(intrinsics!(_mm512_loadu_pd(x.as_ptr())))
    }
    #[inline(always)]
    fn numbers(self) -> [f64; 8] {
        let mut out = [0.0; 8];
        intrinsics!(_mm512_storeu_pd(out.as_mut_ptr(), self.0));
        out
    }
    #[inline(always)]
    fn mask_bits(mask: Avx512Mask) -> u32 {
        u32::from(mask.0)
    }
    #[inline(always)]
    fn rows<'a>(record: impl Fn(usize) -> &'a Vec4) -> [Avx512; 4] {
        [
            both(record(0), record(2)),
            both(record(1), record(3)),
            both(record(4), record(6)),
            both(record(5), record(7)),
        ]
    }
    #[inline(always)]
    fn two_rows<'a>(records: impl Fn(usize) -> (&'a Vec4, &'a Vec4)) -> ([Avx512; 4], [Avx512; 4]) {
        let (a, c) = (records(0), records(2));
        let (p, x) = (both(a.0, c.0), both(a.1, c.1));
        let (b, d) = (records(1), records(3));
        let (q, y) = (both(b.0, d.0), both(b.1, d.1));
        let (e, g) = (records(4), records(6));
        let (r, z) = (both(e.0, g.0), both(e.1, g.1));
        let (f, h) = (records(5), records(7));
        let (s, w) = (both(f.0, h.0), both(f.1, h.1));
        ([p, q, r, s], [x, y, z, w])
    }
    #[inline(always)]
    fn below(count: usize) -> Avx512Mask {
        Avx512Mask(if count < 8 { (1 << count) - 1 } else { 255 })
    }
    #[inline(always)]
    fn columns(rows: [Avx512; 4]) -> [Avx512; 4] {
        let [Avx512(a), Avx512(b), Avx512(c), Avx512(d)] = rows;
        intrinsics!({
            let (ab_even, ab_odd) = (_mm512_unpacklo_pd(a, b), _mm512_unpackhi_pd(a, b));
            let (cd_even, cd_odd) = (_mm512_unpacklo_pd(c, d), _mm512_unpackhi_pd(c, d));
            [
                Avx512(_mm512_shuffle_f64x2::<0x88>(ab_even, cd_even)),
                Avx512(_mm512_shuffle_f64x2::<0x88>(ab_odd, cd_odd)),
                Avx512(_mm512_shuffle_f64x2::<0xdd>(ab_even, cd_even)),
                Avx512(_mm512_shuffle_f64x2::<0xdd>(ab_odd, cd_odd)),
            ]
        })
    }
    #[inline(always)]
    fn records(first: [Avx512; 4], second: [Avx512; 4]) -> [Avx512; 8] {
        join(halves(first), halves(second))
    }
    #[inline(always)]
    fn opposed(
        force: [Avx512; 3],
        torque_a: [Avx512; 3],
        torque_b: [Avx512; 3],
    ) -> ([Avx512; 8], [Avx512; 8]) {
        let zero = Avx512::zero();
        let ([x, y, z], [a, b, c], [d, e, f]) = (force, torque_a, torque_b);
        let [p, q, r, s] = halves([x, y, z, zero]);
        // Fourth numbers become −0, neutral in sums.
        let back = [-p, -q, -r, -s];
        (join([p, q, r, s], halves([a, b, c, zero])), join(back, halves([d, e, f, zero])))
    }
    #[inline(always)]
    fn add_record(record: Avx512, to: &mut [Vec4; 2]) {
        let to = to.as_mut_ptr().cast::<f64>();
        intrinsics!(_mm512_storeu_pd(to, _mm512_add_pd(_mm512_loadu_pd(to), record.0)))
    }
    #[inline(always)]
    fn store_record(record: Avx512, to: &mut [Vec4; 2]) {
        intrinsics!(_mm512_storeu_pd(to.as_mut_ptr().cast::<f64>(), record.0))
    }
}
