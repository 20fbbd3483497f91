//! Numbers that formulas are written over: one at a time, or four lanes.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A number, or several side by side.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// One truth value per lane.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;

    /// Whether operations are written down in place of being computed ([`crate::device`]).
    const RECORDS: bool = false;

    /// The same number in every lane.
    fn splat(x: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Magnitude.
    fn abs(self) -> Self;
    /// `self` where it is the smaller, else `other` (so `other` where one is not a number).
    fn min(self, other: Self) -> Self;
    /// `self` where it is the larger, else `other`.
    fn max(self, other: Self) -> Self;
    /// Where `self` is less.
    fn lt(self, other: Self) -> Self::Mask;
    /// Where `self` is less or equal.
    fn le(self, other: Self) -> Self::Mask;
    /// Where both are equal.
    fn equals(self, other: Self) -> Self::Mask;
    /// `yes` where the mask holds, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Whether the mask holds in any lane.
    fn any(mask: Self::Mask) -> bool;
    /// Whether the mask holds in all lanes.
    fn all(mask: Self::Mask) -> bool;

    /// Where `self` is greater.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }

    /// Zero in every lane.
    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    /// `self` where the mask holds, else zero.
    #[inline(always)]
    fn only(self, mask: Self::Mask) -> Self {
        Self::select(mask, self, Self::zero())
    }
}

impl Real for f64 {
    type Mask = bool;

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

/// Four lanes.
pub(crate) trait Four: Real {
    fn load(x: &[f64; 4]) -> Self;
    fn store(self, to: &mut [f64; 4]);
    /// Lane l of the result's k-th element is element k of the l-th row.
    fn transpose(rows: [Self; 4]) -> [Self; 4];
    /// Bit l tells lane l of a mask.
    fn bits(mask: Self::Mask) -> u32;

    /// The four numbers of a record as four lanes of each number: element k holds number k of the records `at`.
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

    /// Sum of the lanes, in one fixed order.
    #[inline(always)]
    fn sum(self) -> f64 {
        let [a, b, c, d] = self.array();
        (a + b) + (c + d)
    }

    /// Largest lane.
    #[inline(always)]
    fn largest(self) -> f64 {
        let [a, b, c, d] = self.array();
        Real::max(Real::max(a, b), Real::max(c, d))
    }
}
