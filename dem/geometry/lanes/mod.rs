//! SIMD lanes: one source for single numbers and four lanes.
//!
//! `Real` is implemented for `f64`, `Portable` and `Avx2`, with IEEE 754 rounding and no fused multiply-add:
//! all give the same bits. `SimdPack` is one group of four lanes, or two.
//!
//! A `Kernel` is a loop over `R: SimdPack`. Its functions must be `#[inline(always)]`, as calls on `Avx2` are
//! ten times slower; this excludes closures, `map` and `from_fn`.

#[cfg(not(all(target_arch = "x86_64", not(feature = "portable"))))]
#[doc(hidden)]
mod plain;
mod portable;
mod prefetch;
#[doc(hidden)]
pub mod quaternion;
mod real;
#[doc(hidden)]
pub mod vec4;
mod vector;
#[doc(hidden)]
mod wide;
#[cfg(all(target_arch = "x86_64", not(feature = "portable")))]
#[doc(hidden)]
mod x86;

pub use machine::{Simd, run, run_native};
#[cfg(not(all(target_arch = "x86_64", not(feature = "portable"))))]
use plain as machine;
pub use portable::Portable;
pub use prefetch::{ahead, far_ahead, prefetch, prefetch_first};
pub use real::Real;
pub use real::Simd4;
pub use vector::V3;
pub use wide::{Kernel, SimdPack};
#[cfg(all(target_arch = "x86_64", not(feature = "portable")))]
use x86 as machine;

#[cfg(test)]
mod tests {
    use super::*;

    /// All operations, on awkward numbers.
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
        fn run<P: SimdPack>(self) -> Vec<[f64; 4]> {
            self.four::<P::Quad>()
        }
    }

    impl Formula<'_> {
        #[inline(always)]
        fn four<R: Simd4>(self) -> Vec<[f64; 4]> {
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
        for (k, r) in numbers.iter().enumerate() {
            let same = [*r; 8];
            let four = bits(run(Simd::best(), Formula(&same)));
            assert_eq!(four[..4], bits(vec![formula(*r)])[..], "record {k}");
        }
    }
}
