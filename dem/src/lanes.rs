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

mod wide;

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};
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

/// Four lanes that any processor can do.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable([f64; 4]);

/// Truth values of [`Portable`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct PortableMask([bool; 4]);

macro_rules! lanewise {
    ($trait:ident, $f:ident, $op:tt) => {
        impl $trait for Portable {
            type Output = Portable;
            #[inline(always)]
            fn $f(self, o: Portable) -> Portable {
                let (a, b) = (self.0, o.0);
                Portable([a[0] $op b[0], a[1] $op b[1], a[2] $op b[2], a[3] $op b[3]])
            }
        }
    };
}
lanewise!(Add, add, +);
lanewise!(Sub, sub, -);
lanewise!(Mul, mul, *);
lanewise!(Div, div, /);

impl Neg for Portable {
    type Output = Portable;
    #[inline(always)]
    fn neg(self) -> Portable {
        Portable(self.0.map(|x| -x))
    }
}

impl BitAnd for PortableMask {
    type Output = PortableMask;
    #[inline(always)]
    fn bitand(self, o: PortableMask) -> PortableMask {
        PortableMask(std::array::from_fn(|k| self.0[k] & o.0[k]))
    }
}

impl BitOr for PortableMask {
    type Output = PortableMask;
    #[inline(always)]
    fn bitor(self, o: PortableMask) -> PortableMask {
        PortableMask(std::array::from_fn(|k| self.0[k] | o.0[k]))
    }
}

impl Not for PortableMask {
    type Output = PortableMask;
    #[inline(always)]
    fn not(self) -> PortableMask {
        PortableMask(self.0.map(|x| !x))
    }
}

impl Portable {
    #[inline(always)]
    fn with(self, o: Portable, f: impl Fn(f64, f64) -> f64) -> Portable {
        Portable(std::array::from_fn(|k| f(self.0[k], o.0[k])))
    }
    #[inline(always)]
    fn test(self, o: Portable, f: impl Fn(f64, f64) -> bool) -> PortableMask {
        PortableMask(std::array::from_fn(|k| f(self.0[k], o.0[k])))
    }
}

impl Real for Portable {
    type Mask = PortableMask;

    #[inline(always)]
    fn splat(x: f64) -> Portable {
        Portable([x; 4])
    }
    #[inline(always)]
    fn sqrt(self) -> Portable {
        Portable(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn abs(self) -> Portable {
        Portable(self.0.map(f64::abs))
    }
    #[inline(always)]
    fn min(self, other: Portable) -> Portable {
        self.with(other, Real::min)
    }
    #[inline(always)]
    fn max(self, other: Portable) -> Portable {
        self.with(other, Real::max)
    }
    #[inline(always)]
    fn lt(self, other: Portable) -> PortableMask {
        self.test(other, |a, b| a < b)
    }
    #[inline(always)]
    fn le(self, other: Portable) -> PortableMask {
        self.test(other, |a, b| a <= b)
    }
    #[inline(always)]
    fn equals(self, other: Portable) -> PortableMask {
        self.test(other, |a, b| a == b)
    }
    #[inline(always)]
    fn select(mask: PortableMask, yes: Portable, no: Portable) -> Portable {
        Portable(std::array::from_fn(|k| if mask.0[k] { yes.0[k] } else { no.0[k] }))
    }
    #[inline(always)]
    fn any(mask: PortableMask) -> bool {
        mask.0[0] | mask.0[1] | mask.0[2] | mask.0[3]
    }
    #[inline(always)]
    fn all(mask: PortableMask) -> bool {
        mask.0[0] & mask.0[1] & mask.0[2] & mask.0[3]
    }
}

impl Four for Portable {
    #[inline(always)]
    fn load(x: &[f64; 4]) -> Portable {
        Portable(*x)
    }
    #[inline(always)]
    fn store(self, to: &mut [f64; 4]) {
        *to = self.0;
    }
    #[inline(always)]
    fn transpose(r: [Portable; 4]) -> [Portable; 4] {
        std::array::from_fn(|k| Portable([r[0].0[k], r[1].0[k], r[2].0[k], r[3].0[k]]))
    }
    #[inline(always)]
    fn bits(mask: PortableMask) -> u32 {
        mask.0.iter().enumerate().map(|(k, &m)| u32::from(m) << k).sum()
    }
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    //! SAFETY of every block here: [`Avx2`] is private to the crate and only named as the argument of a kernel below
    //! [`super::with_avx2`], which runs after the processor was found to have AVX2.

    use super::{Four, Real};
    use std::arch::x86_64::*;
    use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

    /// A register of four lanes.
    #[derive(Clone, Copy, Debug)]
    pub(crate) struct Avx2(__m256d);

    /// Truth values of [`Avx2`]: all bits of a lane, or none.
    #[derive(Clone, Copy, Debug)]
    pub(crate) struct Avx2Mask(__m256d);

    impl Avx2 {
        #[inline(always)]
        pub(super) fn of(x: __m256d) -> Avx2 {
            Avx2(x)
        }
    }

    macro_rules! lanewise {
        ($type:ident, $trait:ident, $f:ident, $op:ident) => {
            impl $trait for $type {
                type Output = $type;
                #[inline(always)]
                fn $f(self, o: $type) -> $type {
                    $type(unsafe { $op(self.0, o.0) })
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
            Avx2(unsafe { _mm256_xor_pd(self.0, _mm256_set1_pd(-0.0)) })
        }
    }

    impl Not for Avx2Mask {
        type Output = Avx2Mask;
        #[inline(always)]
        fn not(self) -> Avx2Mask {
            Avx2Mask(unsafe { _mm256_xor_pd(self.0, _mm256_castsi256_pd(_mm256_set1_epi64x(-1))) })
        }
    }

    impl Real for Avx2 {
        type Mask = Avx2Mask;

        #[inline(always)]
        fn splat(x: f64) -> Avx2 {
            Avx2(unsafe { _mm256_set1_pd(x) })
        }
        #[inline(always)]
        fn sqrt(self) -> Avx2 {
            Avx2(unsafe { _mm256_sqrt_pd(self.0) })
        }
        #[inline(always)]
        fn abs(self) -> Avx2 {
            Avx2(unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), self.0) })
        }
        #[inline(always)]
        fn min(self, other: Avx2) -> Avx2 {
            Avx2(unsafe { _mm256_min_pd(self.0, other.0) })
        }
        #[inline(always)]
        fn max(self, other: Avx2) -> Avx2 {
            Avx2(unsafe { _mm256_max_pd(self.0, other.0) })
        }
        #[inline(always)]
        fn lt(self, other: Avx2) -> Avx2Mask {
            Avx2Mask(unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0) })
        }
        #[inline(always)]
        fn le(self, other: Avx2) -> Avx2Mask {
            Avx2Mask(unsafe { _mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0) })
        }
        #[inline(always)]
        fn equals(self, other: Avx2) -> Avx2Mask {
            Avx2Mask(unsafe { _mm256_cmp_pd::<_CMP_EQ_OQ>(self.0, other.0) })
        }
        #[inline(always)]
        fn select(mask: Avx2Mask, yes: Avx2, no: Avx2) -> Avx2 {
            Avx2(unsafe { _mm256_blendv_pd(no.0, yes.0, mask.0) })
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

    impl Four for Avx2 {
        #[inline(always)]
        fn load(x: &[f64; 4]) -> Avx2 {
            Avx2(unsafe { _mm256_loadu_pd(x.as_ptr()) })
        }
        #[inline(always)]
        fn store(self, to: &mut [f64; 4]) {
            unsafe { _mm256_storeu_pd(to.as_mut_ptr(), self.0) }
        }
        #[inline(always)]
        fn transpose(rows: [Avx2; 4]) -> [Avx2; 4] {
            let [Avx2(a), Avx2(b), Avx2(c), Avx2(d)] = rows;
            unsafe {
                let (ab_even, ab_odd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
                let (cd_even, cd_odd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
                [
                    Avx2(_mm256_permute2f128_pd::<0x20>(ab_even, cd_even)),
                    Avx2(_mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd)),
                    Avx2(_mm256_permute2f128_pd::<0x31>(ab_even, cd_even)),
                    Avx2(_mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd)),
                ]
            }
        }
        #[inline(always)]
        fn bits(mask: Avx2Mask) -> u32 {
            (unsafe { _mm256_movemask_pd(mask.0) }) as u32
        }
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

/// A vector of three lanes-full of numbers.
#[derive(Clone, Copy, Debug)]
pub struct V3<R> {
    /// First component.
    pub x: R,
    /// Second component.
    pub y: R,
    /// Third component.
    pub z: R,
}

impl<R: Real> V3<R> {
    /// A vector of its components.
    #[inline(always)]
    pub fn new(x: R, y: R, z: R) -> V3<R> {
        V3 { x, y, z }
    }

    /// The zero vector.
    #[inline(always)]
    pub fn zero() -> V3<R> {
        V3 { x: R::zero(), y: R::zero(), z: R::zero() }
    }

    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat(v: &crate::Vec3) -> V3<R> {
        V3 { x: R::splat(v.x), y: R::splat(v.y), z: R::splat(v.z) }
    }

    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, o: V3<R>) -> R {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, o: V3<R>) -> V3<R> {
        V3 { x: self.y * o.z - self.z * o.y, y: self.z * o.x - self.x * o.z, z: self.x * o.y - self.y * o.x }
    }

    /// The components.
    #[inline(always)]
    pub fn array(self) -> [R; 3] {
        [self.x, self.y, self.z]
    }

    /// Square of the length.
    #[inline(always)]
    pub fn norm2(self) -> R {
        self.dot(self)
    }

    /// `yes` where the mask holds, else `no`.
    #[inline(always)]
    pub fn select(mask: R::Mask, yes: V3<R>, no: V3<R>) -> V3<R> {
        V3 {
            x: R::select(mask, yes.x, no.x),
            y: R::select(mask, yes.y, no.y),
            z: R::select(mask, yes.z, no.z),
        }
    }

    /// `self` where the mask holds, else zero.
    #[inline(always)]
    pub fn only(self, mask: R::Mask) -> V3<R> {
        V3 { x: self.x.only(mask), y: self.y.only(mask), z: self.z.only(mask) }
    }
}

impl<R: Real> Add for V3<R> {
    type Output = V3<R>;
    #[inline(always)]
    fn add(self, o: V3<R>) -> V3<R> {
        V3 { x: self.x + o.x, y: self.y + o.y, z: self.z + o.z }
    }
}

impl<R: Real> Sub for V3<R> {
    type Output = V3<R>;
    #[inline(always)]
    fn sub(self, o: V3<R>) -> V3<R> {
        V3 { x: self.x - o.x, y: self.y - o.y, z: self.z - o.z }
    }
}

impl<R: Real> Neg for V3<R> {
    type Output = V3<R>;
    #[inline(always)]
    fn neg(self) -> V3<R> {
        V3 { x: -self.x, y: -self.y, z: -self.z }
    }
}

/// Vector times number.
impl<R: Real> Mul<R> for V3<R> {
    type Output = V3<R>;
    #[inline(always)]
    fn mul(self, s: R) -> V3<R> {
        V3 { x: self.x * s, y: self.y * s, z: self.z * s }
    }
}

impl V3<f64> {
    /// From the crate's vector.
    #[inline(always)]
    pub fn from_vec(v: &crate::Vec3) -> V3<f64> {
        V3 { x: v.x, y: v.y, z: v.z }
    }

    /// To the crate's vector.
    #[inline(always)]
    pub fn to_vec(self) -> crate::Vec3 {
        crate::Vec3::new(self.x, self.y, self.z)
    }
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
