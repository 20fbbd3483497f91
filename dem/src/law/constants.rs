//! Constants of laws, one by one and in lanes.

use crate::lanes::Real;

/// Constants of one pair of materials, of a law or of a part of one, and the same in lanes.
pub trait Constants: Copy + Send + Sync {
    /// The constants in lanes.
    type Lanes<R: Real>: Copy;

    /// All zero: for lanes of other laws, where nothing is made of them.
    const ZERO: Self;

    /// The same constants in every lane.
    fn splat<R: Real>(&self) -> Self::Lanes<R>;

    /// Constants per lane (of as many as there are), put together by `join`.
    fn mixed<R: Real>(all: [&Self; 8], join: fn(&[f64; 8]) -> R) -> Self::Lanes<R>;
}

/// [`Constants`] of a struct of numbers, field by field.
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
