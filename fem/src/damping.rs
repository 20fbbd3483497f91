//! Rayleigh damping `C = alpha_m M + beta_k K`, without boundary dashpots.
//!
//! Damping ratio `zeta = alpha_m/(2 w) + beta_k w/2` (Clough and Penzien 1993, section 12-5). Limits:
//! `alpha_m M` also damps rigid motion.
//!
//! Theory manual: equation (4.9) of `docs/theory/solid.md`.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Rayleigh constants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rayleigh {
    /// Mass factor [1/s], 0 or above.
    pub alpha_m: f64,
    /// Stiffness factor [s], 0 or above.
    pub beta_k: f64,
}

/// Frequencies or ratios without non-negative constants.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum DampingError {
    /// Frequency not above 0, ratio below 0, or equal frequencies.
    #[error(
        "damping needs two different frequencies above 0 and ratios of 0 or above, found {frequencies:?} Hz with \
         ratios {ratios:?}"
    )]
    Range {
        /// Frequencies [Hz].
        frequencies: [f64; 2],
        /// Damping ratios [-].
        ratios: [f64; 2],
    },
    /// Ratios that need a negative constant, which would add energy.
    #[error(
        "ratios {ratios:?} at {frequencies:?} Hz require a negative damping constant (alpha_m = {alpha_m} 1/s, \
         beta_k = {beta_k} s)"
    )]
    Negative {
        /// Frequencies [Hz].
        frequencies: [f64; 2],
        /// Damping ratios [-].
        ratios: [f64; 2],
        /// Computed constant [1/s].
        alpha_m: f64,
        /// Computed constant [s].
        beta_k: f64,
    },
}

impl Rayleigh {
    /// Computes the constants from `ratios` [-] at two `frequencies` [Hz].
    ///
    /// # Errors
    /// Input out of range, or a negative constant.
    pub fn from_frequencies(frequencies: [f64; 2], ratios: [f64; 2]) -> Result<Rayleigh, DampingError> {
        let usable = frequencies.iter().all(|f| *f > 0.0 && f.is_finite())
            && ratios.iter().all(|z| *z >= 0.0 && z.is_finite())
            && frequencies[0] != frequencies[1];
        if !usable {
            return Err(DampingError::Range { frequencies, ratios });
        }
        let w = frequencies.map(|f| std::f64::consts::TAU * f);
        let denominator = w[1] * w[1] - w[0] * w[0];
        let alpha_m = 2.0 * w[0] * w[1] * (ratios[0] * w[1] - ratios[1] * w[0]) / denominator;
        let beta_k = 2.0 * (ratios[1] * w[1] - ratios[0] * w[0]) / denominator;
        if alpha_m < 0.0 || beta_k < 0.0 {
            return Err(DampingError::Negative { frequencies, ratios, alpha_m, beta_k });
        }
        Ok(Rayleigh { alpha_m, beta_k })
    }

    /// Damping ratio [-] at `frequency` [Hz].
    pub fn ratio(&self, frequency: f64) -> f64 {
        let w = std::f64::consts::TAU * frequency;
        self.alpha_m / (2.0 * w) + self.beta_k * w / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_frequencies_get_their_ratio() {
        let c = Rayleigh::from_frequencies([8.0, 50.0], [0.05, 0.07]).unwrap();
        assert!((c.ratio(8.0) - 0.05).abs() < 1e-15 && (c.ratio(50.0) - 0.07).abs() < 1e-15);
        assert!(c.ratio(20.0) < 0.05);
    }

    #[test]
    fn impossible_pairs_are_refused() {
        assert!(matches!(
            Rayleigh::from_frequencies([5.0, 5.0], [0.1, 0.1]),
            Err(DampingError::Range { .. })
        ));
        assert!(matches!(
            Rayleigh::from_frequencies([5.0, 6.0], [0.5, 0.01]),
            Err(DampingError::Negative { .. })
        ));
    }
}
