//! Damping ratio of a linear spring–dashpot from restitution.
//!
//! F = K d + C ḋ is clipped at zero (Schwager & Pöschel, Granular Matter 9, 2007). Bisection inverts e(ζ);
//! series near ζ = 1, where both forms lose digits.
//!
//! Theory manual: eq. (1.4), `docs/theory/contacts.md`.

pub(super) const SOURCE: &str =
    "restitution of the clipped dashpot: Schwager & Poschel, Granular Matter 9, 2007";

/// Returns the restitution for damping ratio `zeta` ≥ 0.
pub fn restitution(zeta: f64) -> f64 {
    let gap = 1.0 - zeta * zeta;
    // exp(−2 − (4/3)(ζ − 1) + …).
    if gap.abs() < 1e-8 {
        libm::exp(-2.0 - 4.0 / 3.0 * (zeta - 1.0))
    } else if gap > 0.0 {
        let w = gap.sqrt();
        libm::exp(-(zeta / w) * (std::f64::consts::PI - libm::atan2(2.0 * zeta * w, 1.0 - 2.0 * zeta * zeta)))
    } else {
        let s = (-gap).sqrt();
        libm::exp(-(2.0 * zeta / s) * libm::log(zeta + s))
    }
}

/// Returns the damping ratio for `e` in (0, 1].
pub fn damping_ratio(e: f64) -> f64 {
    if e >= 1.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    while restitution(high) > e {
        high *= 2.0;
    }
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if restitution(middle) > e {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounce(zeta: f64) -> f64 {
        let (mut x, mut v, h) = (0.0_f64, 1.0_f64, 1e-5);
        let force = |x: f64, v: f64| -(x + 2.0 * zeta * v);
        // Fourth-order Runge–Kutta.
        while force(x, v) < 0.0 || x == 0.0 {
            let (a1, v1) = (force(x, v), v);
            let (a2, v2) = (force(x + 0.5 * h * v1, v + 0.5 * h * a1), v + 0.5 * h * a1);
            let (a3, v3) = (force(x + 0.5 * h * v2, v + 0.5 * h * a2), v + 0.5 * h * a2);
            let (a4, v4) = (force(x + h * v3, v + h * a3), v + h * a3);
            x += h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
            v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
        }
        -v
    }

    #[test]
    fn formula_agrees_with_integration() {
        for zeta in [0.01, 0.1, 0.3, 0.6, 0.9, 1.0, 1.2, 2.0] {
            let (exact, found) = (restitution(zeta), bounce(zeta));
            assert!((exact - found).abs() < 2e-5, "zeta {zeta}: {exact} against {found}");
        }
    }

    #[test]
    fn branches_join_and_invert() {
        assert!((restitution(1.0 - 1e-5) - restitution(1.0 + 1e-5)).abs() < 1e-5);
        assert!((restitution(1.0) - (-2.0_f64).exp()).abs() < 1e-12);
        for e in [1e-3, 0.05, 0.1353, 0.2, 0.5, 0.8, 0.95, 0.999, 1.0] {
            assert!((restitution(damping_ratio(e)) - e).abs() < 1e-9, "{e}");
        }
    }
}
