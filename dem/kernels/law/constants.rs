//! Constants of laws, scalar and in lanes.

use crate::lanes::Real;

/// Pair constants, scalar and in lanes.
pub trait Constants: Copy + Send + Sync {
    /// Constants in lanes.
    type Lanes<R: Real>: Copy;

    /// All zero, for lanes of other laws.
    const ZERO: Self;

    /// Broadcasts the constants to all lanes.
    fn splat<R: Real>(&self) -> Self::Lanes<R>;

    /// Joins per-lane constants.
    fn mixed<R: Real>(all: [&Self; 8], join: fn(&[f64; 8]) -> R) -> Self::Lanes<R>;
}

/// Implements [`Constants`] field by field.
macro_rules! constants {
    ($part:ident { $($field:ident),+ $(,)? }) => {
        impl $crate::law::constants::Constants for $part {
            type Lanes<R: $crate::lanes::Real> = $part<R>;

            const ZERO: $part = $part { $($field: 0.0),+ };

            #[inline(always)]
            fn splat<R: $crate::lanes::Real>(&self) -> $part<R> {
                $part { $($field: R::splat(self.$field)),+ }
            }

            #[inline(always)]
            fn mixed<R: $crate::lanes::Real>(all: [&$part; 8], join: fn(&[f64; 8]) -> R) -> $part<R> {
                $part { $($field: join(&all.map(|p| p.$field))),+ }
            }
        }
    };
}
pub(crate) use constants;
