//! Half-step correction of dashpots in a leapfrog scheme.
//!
//! C/√(1 + x), x = C dt/2m*, corrects the coefficient; (4 + x)/(4 + 3x) approximates the root without its
//! cost, error x³/32 (4e-5 of C at x = 0.1, above usual x).
//!
//! Theory manual: eq. (3.2), `docs/theory/motion.md`.

use crate::lanes::Real;

/// Numerator and denominator of the correction.
#[inline(always)]
pub fn share<R: Real>(x: R) -> (R, R) {
    (R::splat(4.0) + x, R::splat(4.0) + R::splat(3.0) * x)
}

#[cfg(test)]
mod tests {
    #[test]
    fn matches_inverse_root_to_third_order() {
        for x in [0.0, 1e-3, 0.01, 0.1, 0.3] {
            let (a, b) = super::share::<f64>(x);
            let error = (a / b - 1.0 / (1.0 + x).sqrt()).abs();
            assert!(error <= x.powi(3) / 32.0 + 1e-16, "{x}: {error}");
        }
    }
}
