//! Four lanes in an array, for any CPU.

use super::real::{Real, Simd4};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Portable([f64; 4]);

/// Mask of [`Portable`].
#[derive(Clone, Copy, Debug)]
pub struct PortableMask([bool; 4]);

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
    const NUMBERS: usize = 4;

    /// Serves processors before AVX2 there.
    const CALLS: bool = cfg!(all(target_arch = "x86_64", not(feature = "portable")));

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

impl Simd4 for Portable {
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
