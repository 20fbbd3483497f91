//! Four lanes of numbers at a time, and one source for them and for single numbers.
//!
//! `Real` is what a formula needs: arithmetic, roots, comparisons to a mask, choice by mask. It is implemented for
//! `f64` (one lane), for `Portable` (an array of four that any processor can do) and for `Avx2` (a register of
//! four). `Four` adds what only four lanes have: loading and storing, and the transposition between four records of
//! four numbers and four lanes of each number. Every operation rounds as IEEE 754 says and products are never fused
//! with sums, so all three give the same bits.
//!
//! `Pack` is lanes of one group of four or of two at once (`Avx512`), for loops over lists of groups.
//!
//! A `Kernel` is a loop written once over `R: Pack`; `run` picks the implementation, and compiles the whole loop
//! with the processor's features on. Everything that a kernel calls must be `#[inline(always)]` as well: an operation
//! on `Avx2` that is not inlined below that entry becomes a call per operation, ten times slower. That rules out
//! closures with such operations in them, hence also `map` and `from_fn`.

#[cfg(target_arch = "x86_64")]
mod avx2;
mod portable;
pub(crate) mod record;
mod vector;
mod wide;

pub(crate) use portable::Portable;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};
pub use vector::V3;
pub(crate) use wide::Pack;

/// A number, or several side by side.
pub trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// One truth value per lane.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask> + Not<Output = Self::Mask>;

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

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;

/// Has the processor fetch a list into its second cache, where it can be told to.
#[inline]
pub(crate) fn prefetch<T>(list: &[T]) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
        let from = list.as_ptr().cast::<i8>();
        for line in (0..size_of_val(list)).step_by(64) {
            // SAFETY: the address lies in the list; a prefetch changes nothing that a program sees.
            unsafe { _mm_prefetch::<_MM_HINT_T1>(from.add(line)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = list;
}

/// The same for the first `count` of a list.
#[inline]
pub(crate) fn prefetch_first<T>(list: &[T], count: usize) {
    prefetch(&list[..list.len().min(count)]);
}

/// Has the processor fetch `count` of a list from place `at` on, which may lie beyond its end, into its first cache. Its own
/// foresight stops at every page.
#[inline(always)]
pub(crate) fn ahead<T>(list: &[T], at: usize, count: usize) {
    // `_MM_HINT_T0`.
    ahead_into::<T, 3>(list, at, count);
}

/// The same into its second cache.
#[inline(always)]
pub(crate) fn far_ahead<T>(list: &[T], at: usize, count: usize) {
    // `_MM_HINT_T1`.
    ahead_into::<T, 2>(list, at, count);
}

#[inline(always)]
fn ahead_into<T, const HINT: i32>(list: &[T], at: usize, count: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        let from = list.as_ptr().wrapping_add(at).cast::<i8>();
        for line in (0..count * size_of::<T>()).step_by(64) {
            // SAFETY: a prefetch of any address changes nothing that a program sees.
            unsafe { std::arch::x86_64::_mm_prefetch::<HINT>(from.wrapping_add(line)) };
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (list, at, count);
}

/// A loop over lanes.
pub(crate) trait Kernel {
    /// What it returns.
    type Output;
    /// Runs the loop; must be `#[inline(always)]`.
    fn run<R: Pack>(self) -> Self::Output;
}

/// Which lanes the processor is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Simd {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// Two groups of four lanes side by side.
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Simd {
    /// All that this processor has.
    #[cfg(test)]
    pub fn all() -> Vec<Simd> {
        #[cfg(target_arch = "x86_64")]
        {
            let mut all = vec![Simd::Portable];
            if Simd::best() != Simd::Portable {
                all.push(Simd::Avx2);
            }
            if Simd::best() == Simd::Avx512 {
                all.push(Simd::Avx512);
            }
            all
        }
        #[cfg(not(target_arch = "x86_64"))]
        vec![Simd::Portable]
    }

    /// The fastest that this processor has.
    pub fn best() -> Simd {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            let more = is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq");
            return if more { Simd::Avx512 } else { Simd::Avx2 };
        }
        Simd::Portable
    }
}

/// Runs a kernel on the lanes chosen; `simd` must come from [`Simd::best`] or be [`Simd::Portable`].
#[inline]
pub(crate) fn run<K: Kernel>(simd: Simd, kernel: K) -> K::Output {
    match simd {
        Simd::Portable => kernel.run::<Portable>(),
        #[cfg(target_arch = "x86_64")]
        // SAFETY: `Simd::best` found the feature.
        Simd::Avx2 => unsafe { with_avx2(kernel) },
        #[cfg(target_arch = "x86_64")]
        // SAFETY: as above.
        Simd::Avx512 => unsafe { with_avx512(kernel) },
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn with_avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx2>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,avx512f,avx512vl,avx512dq")]
fn with_avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<wide::Avx512>()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A formula that uses everything, on awkward numbers.
    struct Formula<'a>(&'a [[f64; 4]; 8]);

    #[inline(always)]
    fn formula<R: Real>([a, b, c, d]: [R; 4]) -> [R; 4] {
        let u = V3::new(a, b, c);
        let v = V3::new(d, a * b, c - R::splat(0.3));
        let w = u.cross(v) * (R::splat(1.0) / (u.norm2() + R::splat(1e-3))) - v;
        let big = w.x.abs().gt(w.y.abs()) & !(w.z.le(a) | w.y.equals(w.x));
        let s = V3::select(big, w, -u).only(a.lt(b) | big);
        let any = if R::any(big) { R::splat(1.0) } else { R::splat(0.0) };
        [s.x.abs().sqrt() + any.min(s.y), s.y.max(s.z), R::select(big, s.z, a / b), s.dot(w)]
    }

    impl Kernel for Formula<'_> {
        type Output = Vec<[f64; 4]>;
        #[inline(always)]
        fn run<P: Pack>(self) -> Vec<[f64; 4]> {
            self.four::<P::Quad>()
        }
    }

    impl Formula<'_> {
        #[inline(always)]
        fn four<R: Four>(self) -> Vec<[f64; 4]> {
            let mut out = Vec::new();
            for at in [[0, 1, 2, 3], [7, 2, 2, 5], [6, 4, 0, 1]] {
                let r = formula(R::gather(self.0, &at));
                out.extend(R::transpose(r).map(R::array));
                out.push([r[0].sum(), r[1].largest(), f64::from(R::bits(r[0].lt(r[1]))), 0.0]);
            }
            out
        }
    }

    #[test]
    fn all_lanes_give_the_same_bits() {
        let mut numbers = [[0.0; 4]; 8];
        for (k, x) in numbers.iter_mut().flatten().enumerate() {
            *x = (k as f64 * 0.7).sin() * 10.0_f64.powi(k as i32 % 7 - 3);
        }
        numbers[2] = [-0.0, 0.0, 1e308, -1e-308];
        numbers[5][1] = f64::NAN;
        let bits = |v: Vec<[f64; 4]>| -> Vec<u64> {
            v.into_iter().flatten().map(|x| if x.is_nan() { 1 } else { x.to_bits() }).collect()
        };
        let portable = bits(run(Simd::Portable, Formula(&numbers)));
        assert_eq!(portable, bits(run(Simd::best(), Formula(&numbers))));
        // One lane at a time. The group's `any` looks at all lanes, so take groups of four equal ones.
        for (k, r) in numbers.iter().enumerate() {
            let same = [*r; 8];
            let four = bits(run(Simd::best(), Formula(&same)));
            assert_eq!(four[..4], bits(vec![formula(*r)])[..], "record {k}");
        }
    }
}
