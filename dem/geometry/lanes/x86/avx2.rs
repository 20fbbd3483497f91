//! Four lanes in an AVX2 register.

use crate::lanes::real::{Real, Simd4};
use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

#[derive(Clone, Copy, Debug)]
pub struct Avx2(__m256d);

/// Mask: all bits of a lane, or none.
#[derive(Clone, Copy, Debug)]
pub struct Avx2Mask(__m256d);

impl Avx2 {
    #[inline(always)]
    pub(super) fn of(x: __m256d) -> Avx2 {
        Avx2(x)
    }

    #[inline(always)]
    pub(super) fn register(self) -> __m256d {
        self.0
    }
}

macro_rules! lanewise {
    ($type:ident, $trait:ident, $f:ident, $op:ident) => {
        impl $trait for $type {
            type Output = $type;
            #[inline(always)]
            fn $f(self, o: $type) -> $type {
                $type(intrinsics!($op(self.0, o.0)))
            }
        }
    };
}
lanewise!(Avx2, Add, add, _mm256_add_pd);
lanewise!(Avx2, Sub, sub, _mm256_sub_pd);
lanewise!(Avx2, Mul, mul, _mm256_mul_pd);
lanewise!(Avx2, Div, div, _mm256_div_pd);
lanewise!(Avx2Mask, BitAnd, bitand, _mm256_and_pd);
lanewise!(Avx2Mask, BitOr, bitor, _mm256_or_pd);

impl Neg for Avx2 {
    type Output = Avx2;
    #[inline(always)]
    fn neg(self) -> Avx2 {
        Avx2(intrinsics!(_mm256_xor_pd(self.0, _mm256_set1_pd(-0.0))))
    }
}

impl Not for Avx2Mask {
    type Output = Avx2Mask;
    #[inline(always)]
    fn not(self) -> Avx2Mask {
        Avx2Mask(intrinsics!(_mm256_xor_pd(self.0, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)))))
    }
}

impl Real for Avx2 {
    type Mask = Avx2Mask;
    const NUMBERS: usize = 4;

    #[inline(always)]
    fn splat(x: f64) -> Avx2 {
        Avx2(intrinsics!(_mm256_set1_pd(x)))
    }
    #[inline(always)]
    fn sqrt(self) -> Avx2 {
        Avx2(intrinsics!(_mm256_sqrt_pd(self.0)))
    }
    #[inline(always)]
    fn abs(self) -> Avx2 {
        Avx2(intrinsics!(_mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0)))
    }
    #[inline(always)]
    fn min(self, other: Avx2) -> Avx2 {
        Avx2(intrinsics!(_mm256_min_pd(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Avx2) -> Avx2 {
        Avx2(intrinsics!(_mm256_max_pd(self.0, other.0)))
    }
    #[inline(always)]
    fn lt(self, other: Avx2) -> Avx2Mask {
        Avx2Mask(intrinsics!(_mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn le(self, other: Avx2) -> Avx2Mask {
        Avx2Mask(intrinsics!(_mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn equals(self, other: Avx2) -> Avx2Mask {
        Avx2Mask(intrinsics!(_mm256_cmp_pd::<_CMP_EQ_OQ>(self.0, other.0)))
    }
    #[inline(always)]
    fn select(mask: Avx2Mask, yes: Avx2, no: Avx2) -> Avx2 {
        Avx2(intrinsics!(_mm256_blendv_pd(no.0, yes.0, mask.0)))
    }
    #[inline(always)]
    fn any(mask: Avx2Mask) -> bool {
        Avx2::bits(mask) != 0
    }
    #[inline(always)]
    fn all(mask: Avx2Mask) -> bool {
        Avx2::bits(mask) == 15
    }
}

impl Simd4 for Avx2 {
    #[inline(always)]
    fn load(x: &[f64; 4]) -> Avx2 {
        Avx2(intrinsics!(_mm256_loadu_pd(x.as_ptr())))
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 4]) {
        intrinsics!(_mm256_storeu_pd(to.as_mut_ptr(), self.0))
    }
    #[inline(always)]
    fn transpose(rows: [Avx2; 4]) -> [Avx2; 4] {
        let [Avx2(a), Avx2(b), Avx2(c), Avx2(d)] = rows;
        intrinsics!({
            let (ab_even, ab_odd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
            let (cd_even, cd_odd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
            [
                Avx2(_mm256_permute2f128_pd::<0x20>(ab_even, cd_even)),
                Avx2(_mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd)),
                Avx2(_mm256_permute2f128_pd::<0x31>(ab_even, cd_even)),
                Avx2(_mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd)),
            ]
        })
    }
    #[inline(always)]
    fn bits(mask: Avx2Mask) -> u32 {
        intrinsics!(_mm256_movemask_pd(mask.0)) as u32
    }
}
