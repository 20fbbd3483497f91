//! Number type of formulas: a single number, or lanes.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A number, or several in lanes.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Truth value of each lane.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;

    /// Whether operations are recorded instead of computed, for GPU kernels.
    const RECORDS: bool = false;

    /// Numbers that the type consists of, in memory; 0: others.
    const NUMBERS: usize = 0;

    /// Whether large formulas are called instead of inlined: smaller code where speed matters little.
    const CALLS: bool = false;

    /// The same number in every lane.
    fn splat(x: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// Smaller value; `other` if either is NaN.
    fn min(self, other: Self) -> Self;
    /// Larger value; `other` if either is NaN.
    fn max(self, other: Self) -> Self;
    /// `self` < `other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self` ≤ `other`.
    fn le(self, other: Self) -> Self::Mask;
    /// `self` = `other`.
    fn equals(self, other: Self) -> Self::Mask;
    /// `yes` if set, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Whether any lane is set.
    fn any(mask: Self::Mask) -> bool;
    /// Whether all lanes are set.
    fn all(mask: Self::Mask) -> bool;

    /// `self` > `other`.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }

    /// Zero in every lane.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    /// `self` if set, else zero.
    #[inline(always)]
    fn only(self, mask: Self::Mask) -> Self {
        Self::select(mask, self, Self::zero())
    }
}

impl Real for f64 {
    type Mask = bool;
    const NUMBERS: usize = 1;

    #[inline(always)]
    fn splat(x: f64) -> f64 {
        x
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> f64 {
        f64::abs(self)
    }
    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn lt(self, other: f64) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: f64) -> bool {
        self <= other
    }
    #[inline(always)]
    fn equals(self, other: f64) -> bool {
        self == other
    }
    #[inline(always)]
    fn select(mask: bool, yes: f64, no: f64) -> f64 {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }
    #[inline(always)]
    fn all(mask: bool) -> bool {
        mask
    }
}

#[doc(hidden)]
pub trait Simd4: Real {
    fn load(x: &[f64; 4]) -> Self;
    fn store(self, to: &mut [f64; 4]);
    /// Lane l of result k is element k of row l.
    fn transpose(rows: [Self; 4]) -> [Self; 4];
    /// Bit l: lane l of a mask.
    fn bits(mask: Self::Mask) -> u32;

    /// Transposed records: result k holds number k of the records `at`.
    #[inline(always)]
    #[cfg_attr(not(test), allow(dead_code))]
    fn gather(records: &[[f64; 4]], at: &[u32; 4]) -> [Self; 4] {
        let [a, b, c, d] = *at;
        Self::transpose([
            Self::load(&records[a as usize]),
            Self::load(&records[b as usize]),
            Self::load(&records[c as usize]),
            Self::load(&records[d as usize]),
        ])
    }

    #[inline(always)]
    fn array(self) -> [f64; 4] {
        let mut out = [0.0; 4];
        self.store(&mut out);
        out
    }

    /// Sum of the lanes, in fixed order.
    #[inline(always)]
    fn sum(self) -> f64 {
        let [a, b, c, d] = self.array();
        (a + b) + (c + d)
    }

    #[inline(always)]
    fn largest(self) -> f64 {
        let [a, b, c, d] = self.array();
        Real::max(Real::max(a, b), Real::max(c, d))
    }
}
