//! Influence lines: force on a sleeper against axle distance, in closed form.
//!
//! Winkler, Die Lehre von der Elasticität und Festigkeit, 1867; Zimmermann, Die Berechnung des
//! Eisenbahnoberbaues, 1888; Hetényi, Beams on Elastic Foundation, 1946, section 3. Theory manual: eqs.
//! (6.3), (6.6). Quasi-static; the foundation also pulls.

/// Beam on a continuous elastic foundation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Winkler {
    /// β = (k/(4 EI))^¼ [1/m].
    pub beta: f64,
    /// Sleeper spacing s [m].
    pub spacing: f64,
}

impl Winkler {
    /// Rail of `ei` [N m²] on springs `foundation` [N/m] at `spacing` [m].
    pub fn new(ei: f64, foundation: f64, spacing: f64) -> Winkler {
        Winkler { beta: libm::pow(foundation / spacing / (4.0 * ei), 0.25), spacing }
    }

    /// Normalised deflection e^(−β|x|) (cos β|x| + sin β|x|).
    pub fn shape(&self, x: f64) -> f64 {
        let b = self.beta * x.abs();
        libm::exp(-b) * (libm::cos(b) + libm::sin(b))
    }

    /// Axle load share at distance `x` [m]: β s/2 · shape.
    pub fn share(&self, x: f64) -> f64 {
        0.5 * self.beta * self.spacing * self.shape(x)
    }

    /// Distance beyond which the shape is below 1e-4 [m].
    pub fn reach(&self) -> f64 {
        3.0 * std::f64::consts::PI / self.beta
    }
}

/// Gaussian pulse exp(−(x/ℓ)²).
pub fn gauss(x: f64, width: f64) -> f64 {
    libm::exp(-(x / width).powi(2))
}

/// Widths beyond which a Gaussian pulse is below 2e-4.
pub const GAUSS_REACH: f64 = 3.0;

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn area(f: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
        let n = 20_000;
        let h = (to - from) / f64::from(n);
        (0..n).map(|i| h * f(from + (f64::from(i) + 0.5) * h)).sum()
    }

    /// Hetényi (1946): zero deflection at βx = 3π/4, minimum −e^(−π) at π.
    #[test]
    fn the_foundation_carries_the_load() {
        let w = Winkler::new(6.4e6, 40e6, 0.6);
        assert!((w.beta - (40e6_f64 / 0.6 / 25.6e6).powf(0.25)).abs() < 1e-14);
        let all = area(|x| w.share(x), -30.0, 30.0) / w.spacing;
        assert!((all - 1.0).abs() < 1e-7, "{all}");
        assert!((w.share(0.0) - 0.5 * w.beta * 0.6).abs() < 1e-15);
        assert!(w.shape(0.75 * PI / w.beta).abs() < 1e-15);
        assert!((w.shape(PI / w.beta) + (-PI).exp()).abs() < 1e-15);
        assert!(w.shape(w.reach()).abs() < 1e-4);
        // Shares of one axle sum to 1.
        for x in [0.0, 0.13, 0.3] {
            let sum: f64 = (-60..=60).map(|i| w.share(0.6 * f64::from(i) - x)).sum();
            assert!((sum - 1.0).abs() < 2e-3, "{sum}");
        }
    }

    #[test]
    fn gaussian_pulse_area_matches_closed_form() {
        let all = area(|x| gauss(x, 0.7), -10.0, 10.0);
        assert!((all - 0.7 * PI.sqrt()).abs() < 1e-9);
        assert!(gauss(GAUSS_REACH, 1.0) < 2e-4);
    }
}
