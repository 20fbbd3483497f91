//! Lanes and prefetching of x86-64.

/// The only place that calls intrinsics.
macro_rules! intrinsics {
    ($calls:expr) => {
        // SAFETY: lane types are private to this folder and used only in kernels below `with_avx2` and
        // `with_avx512`, run after feature detection. Pointers come from references of sufficient length;
        // alignment is not required.
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

/// Lane implementation. Other crates cannot name those with instructions of their own: they come from
/// [`Simd::best`] or [`Simd::all`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simd {
    Portable,
    #[non_exhaustive]
    Avx2,
    /// Two groups of four lanes.
    #[non_exhaustive]
    Avx512,
}

impl Simd {
    /// Implementations supported by this CPU.
    pub fn all() -> Vec<Simd> {
        match Simd::best() {
            Simd::Portable => vec![Simd::Portable],
            Simd::Avx2 => vec![Simd::Portable, Simd::Avx2],
            Simd::Avx512 => vec![Simd::Portable, Simd::Avx2, Simd::Avx512],
        }
    }

    /// Fastest supported implementation.
    pub fn best() -> Simd {
        if !is_x86_feature_detected!("avx2") {
            return Simd::Portable;
        }
        let more = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq");
        if more { Simd::Avx512 } else { Simd::Avx2 }
    }

    /// Whether contact loops are compiled for any law only: processors before AVX2.
    pub fn any_law_only(self) -> bool {
        self == Simd::Portable
    }

    pub fn name(self) -> &'static str {
        match self {
            Simd::Portable => "four at a time (plain arrays)",
            Simd::Avx2 => "four at a time (AVX2)",
            Simd::Avx512 => "eight at a time (AVX-512)",
        }
    }
}

/// Runs a kernel.
#[inline]
pub fn run<K: Kernel>(simd: Simd, kernel: K) -> K::Output {
    if simd.any_law_only() { kernel.run::<Portable>() } else { run_native(simd, kernel) }
}

/// As [`run`], without [`Simd::Portable`].
#[inline]
pub fn run_native<K: Kernel>(simd: Simd, kernel: K) -> K::Output {
    match simd {
        Simd::Portable => unreachable!("loops for any law serve processors before AVX2"),
        // SAFETY: `Simd::best` detected AVX2.
        Simd::Avx2 => unsafe { with_avx2(kernel) },
        // SAFETY: `Simd::best` detected AVX-512.
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

#[inline(always)]
pub(super) fn prefetch<const CACHE: i32>(from: *const i8, bytes: usize) {
    for line in (0..bytes).step_by(64) {
        // SAFETY: prefetching any address has no visible effect.
        unsafe { _mm_prefetch::<CACHE>(from.wrapping_add(line)) };
    }
}
