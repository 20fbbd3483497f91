//! Lanes and prefetching of x86-64, with the instructions that the processor at hand has.

/// Calls of intrinsics, the one place that answers for them.
macro_rules! intrinsics {
    ($calls:expr) => {
        // SAFETY: the types of lanes are private to this folder and only named as the argument of a kernel below
        // `with_avx2` and `with_avx512`, which run after the processor was found to have the features. Pointers come from
        // references to as many numbers as are loaded or stored, and no alignment is asked for.
        unsafe { $calls }
    };
}

mod avx2;
mod avx512;

use super::portable::Portable;
use super::wide::Kernel;
use avx2::Avx2;
use avx512::Avx512;
use std::arch::x86_64::_mm_prefetch;

/// Which lanes the processor is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Simd {
    Portable,
    Avx2,
    /// Two groups of four lanes side by side.
    Avx512,
}

impl Simd {
    /// All that this processor has.
    #[cfg(test)]
    pub fn all() -> Vec<Simd> {
        match Simd::best() {
            Simd::Portable => vec![Simd::Portable],
            Simd::Avx2 => vec![Simd::Portable, Simd::Avx2],
            Simd::Avx512 => vec![Simd::Portable, Simd::Avx2, Simd::Avx512],
        }
    }

    /// The fastest that this processor has.
    pub fn best() -> Simd {
        if !is_x86_feature_detected!("avx2") {
            return Simd::Portable;
        }
        let more = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq");
        if more { Simd::Avx512 } else { Simd::Avx2 }
    }

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Simd::Portable => "four at a time (plain arrays)",
            Simd::Avx2 => "four at a time (AVX2)",
            Simd::Avx512 => "eight at a time (AVX-512)",
        }
    }
}

/// Runs a kernel on the lanes chosen; `simd` must come from [`Simd::best`] or be [`Simd::Portable`].
#[inline]
pub(crate) fn run<K: Kernel>(simd: Simd, kernel: K) -> K::Output {
    match simd {
        Simd::Portable => kernel.run::<Portable>(),
        // SAFETY: `Simd::best` found the feature.
        Simd::Avx2 => unsafe { with_avx2(kernel) },
        // SAFETY: `Simd::best` found the features.
        Simd::Avx512 => unsafe { with_avx512(kernel) },
    }
}

#[target_feature(enable = "avx2")]
fn with_avx2<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx2>()
}

#[target_feature(enable = "avx2,avx512f,avx512vl,avx512dq")]
fn with_avx512<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Avx512>()
}

/// Has the processor fetch so many bytes into the cache of this hint.
#[inline(always)]
pub(super) fn prefetch<const CACHE: i32>(from: *const i8, bytes: usize) {
    for line in (0..bytes).step_by(64) {
        // SAFETY: a prefetch of any address changes nothing that a program sees.
        unsafe { _mm_prefetch::<CACHE>(from.wrapping_add(line)) };
    }
}
