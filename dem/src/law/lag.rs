//! The share of a dashpot's coefficient that acts, so that a delay of half a step does not change what it takes.
//!
//! In a leapfrog the dashpot sees the approach speed of half a step ago, which acts as if the effective mass m* were smaller
//! by the factor 1 − C dt/2m*, so that the damping ratio is larger by its root. With C/√(1 + x), x = C dt/2m*, in place of C
//! it is what it should be, and so is the restitution. In place of the root stands (4 + x)/(4 + 3x), which differs from it by
//! x³/32 (4e-5 of C at x = 0.1, more than a collision resolved as usual has) and whose division joins that of the
//! coefficient itself: no contact pays for a second root.
//!
//! Theory manual: equation (3.2) of `docs/theory/motion.md`.

use crate::lanes::Real;

/// Numerator and denominator of the share, given x = C dt/2m*.
#[inline(always)]
pub(crate) fn share<R: Real>(x: R) -> (R, R) {
    (R::splat(4.0) + x, R::splat(4.0) + R::splat(3.0) * x)
}

#[cfg(test)]
mod tests {
    #[test]
    fn is_the_inverse_root_to_third_order() {
        for x in [0.0, 1e-3, 0.01, 0.1, 0.3] {
            let (a, b) = super::share::<f64>(x);
            let error = (a / b - 1.0 / (1.0 + x).sqrt()).abs();
            assert!(error <= x.powi(3) / 32.0 + 1e-16, "{x}: {error}");
        }
    }
}
