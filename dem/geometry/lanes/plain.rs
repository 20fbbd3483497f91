//! Lanes and prefetching for an unknown CPU.

use super::portable::Portable;
use super::wide::Kernel;

/// Lane implementation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Simd {
    Portable,
}

impl Simd {
    /// Implementations available.
    pub fn all() -> Vec<Simd> {
        vec![Simd::Portable]
    }

    /// Fastest implementation.
    pub fn best() -> Simd {
        Simd::Portable
    }

    /// Whether contact loops are compiled for any law only.
    pub fn any_law_only(self) -> bool {
        false
    }

    pub fn name(self) -> &'static str {
        "four at a time (plain arrays)"
    }
}

#[inline]
pub fn run<K: Kernel>(_: Simd, kernel: K) -> K::Output {
    kernel.run::<Portable>()
}

/// As [`run`].
#[inline]
pub fn run_native<K: Kernel>(simd: Simd, kernel: K) -> K::Output {
    run(simd, kernel)
}

/// Left to the CPU.
#[inline(always)]
pub(super) fn prefetch<const CACHE: i32>(_: *const i8, _: usize) {}
