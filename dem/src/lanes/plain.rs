//! Lanes and prefetching of a processor of which nothing is known.

use super::portable::Portable;
use super::wide::Kernel;

/// Which lanes the processor is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Simd {
    Portable,
}

impl Simd {
    /// All that this processor has.
    #[cfg(test)]
    pub fn all() -> Vec<Simd> {
        vec![Simd::Portable]
    }

    /// The fastest that this processor has.
    pub fn best() -> Simd {
        Simd::Portable
    }

    /// In words.
    pub fn name(self) -> &'static str {
        "four at a time (plain arrays)"
    }
}

/// Runs a kernel on the lanes chosen.
#[inline]
pub(crate) fn run<K: Kernel>(_: Simd, kernel: K) -> K::Output {
    kernel.run::<Portable>()
}

/// Nothing: what to fetch is left to the processor.
#[inline(always)]
pub(super) fn prefetch<const CACHE: i32>(_: *const i8, _: usize) {}
