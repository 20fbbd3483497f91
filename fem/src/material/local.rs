//! Scalar equation of hardening: `g(kappa) = kappa - kappa_n - h(kappa) = 0`.
//!
//! `h(kappa)` is the equivalent plastic strain of the perfectly plastic return. The root is unique if
//! `dh/dkappa < 1`; beyond that the point snaps back.

use super::law::ReturnError;

/// Root of `g` by bracketed Newton; `plastic(kappa)` returns `h` and `dh/dkappa`.
pub(super) fn solve_kappa(
    start: f64,
    mut plastic: impl FnMut(f64) -> (f64, f64),
) -> Result<f64, ReturnError> {
    let (mut low, mut high) = (start, f64::INFINITY);
    let mut kappa = start;
    for iteration in 0..80 {
        let (h, slope) = plastic(kappa);
        let g = kappa - start - h;
        if !g.is_finite() {
            return Err(ReturnError::NotFinite);
        }
        let steep = slope >= 1.0;
        if g.abs() <= 1e-14 * h + 2.0 * f64::EPSILON * kappa {
            return if steep { Err(ReturnError::Softening { kappa }) } else { Ok(kappa) };
        }
        if steep && iteration == 0 {
            return Err(ReturnError::Softening { kappa });
        }
        if g < 0.0 {
            low = low.max(kappa);
        } else {
            high = high.min(kappa);
        }
        let newton = if steep { f64::NAN } else { kappa - g / (1.0 - slope) };
        let next = if newton > low && newton < high {
            newton
        } else if high.is_finite() {
            0.5 * (low + high)
        } else {
            start + 2.0 * (kappa - start) + h
        };
        // No better kappa: the bracket is one ulp wide.
        if next == kappa || next <= low || next >= high {
            plastic(kappa);
            return if g.abs() <= 1e-9 * h { Ok(kappa) } else { Err(ReturnError::NotConverged { kappa }) };
        }
        kappa = next;
    }
    Err(ReturnError::NotConverged { kappa })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_root_or_reports_snapback() {
        let linear = solve_kappa(0.5, |k| (0.1 - 3.0 * (k - 0.5), -3.0)).unwrap();
        assert!((linear - 0.525).abs() < 1e-15);
        let kinked =
            solve_kappa(0.0, |k| if k < 0.01 { (1.0 - 50.0 * k, -50.0) } else { (0.5, 0.0) }).unwrap();
        assert!((kinked - 0.5).abs() < 1e-15);
        let soft = solve_kappa(0.0, |k| (0.1 + 0.9 * k, 0.9)).unwrap();
        assert!((soft - 1.0).abs() < 1e-13);
        let snap = solve_kappa(0.0, |k| (0.1 + 1.1 * k, 1.1));
        assert!(matches!(snap, Err(ReturnError::Softening { .. })));
        assert_eq!(solve_kappa(0.0, |_| (f64::NAN, 0.0)), Err(ReturnError::NotFinite));
    }
}
