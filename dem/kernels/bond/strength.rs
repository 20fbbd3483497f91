//! Random bond strengths.
//!
//! Source: Weibull, J. Appl. Mech. 18, 1951; Box & Muller, Ann. Math. Statist. 29, 1958.
//!
//! Theory manual: equation (2.13) of `docs/theory/shapes.md`.

use crate::base::random::Random;
use std::f64::consts::TAU;

/// Distribution of strength factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spread {
    /// Uniform strength.
    Constant,
    /// Normal, truncated at zero.
    Normal {
        /// Coefficient of variation [-].
        deviation: f64,
    },
    /// Weibull.
    Weibull {
        /// Modulus m [-].
        modulus: f64,
    },
}

/// Strength factors of `count` bonds, in order; `purpose` separates tension and shear.
pub fn factors(spread: Spread, seed: u64, purpose: u64, count: usize) -> Vec<f64> {
    let mut random = Random::new(seed, 0x0b00 + purpose);
    // 1 − u in (0, 1]: finite logarithm.
    (0..count)
        .map(|_| match spread {
            Spread::Constant => 1.0,
            Spread::Normal { deviation } => loop {
                let radius = (-2.0 * libm::log(1.0 - random.uniform())).sqrt();
                let x = 1.0 + deviation * radius * libm::cos(TAU * random.uniform());
                if x > 0.0 {
                    break x;
                }
            },
            Spread::Weibull { modulus } => loop {
                let x = libm::pow(-libm::log(1.0 - random.uniform()), 1.0 / modulus);
                if x > 0.0 {
                    break x;
                }
            },
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const N: usize = 200_000;

    fn share_below(f: &[f64], x: f64) -> f64 {
        f.iter().filter(|f| **f < x).count() as f64 / f.len() as f64
    }

    /// Standard error of a fraction of 200,000: at most 0.0011.
    #[test]
    fn distributions() {
        let weibull = factors(Spread::Weibull { modulus: 4.0 }, 7, 0, N);
        for x in [0.3_f64, 0.7, 1.0, 1.2] {
            let expected = 1.0 - (-x.powi(4)).exp();
            assert!((share_below(&weibull, x) - expected).abs() < 0.005, "Weibull at {x}");
        }
        let normal = factors(Spread::Normal { deviation: 0.3 }, 7, 0, N);
        for (x, expected) in [(0.7, 0.15866), (1.0, 0.5), (1.3, 0.84134), (1.6, 0.97725)] {
            assert!((share_below(&normal, x) - expected).abs() < 0.005, "normal at {x}");
        }
        let wide = factors(Spread::Normal { deviation: 2.0 }, 7, 0, N);
        assert!(wide.iter().all(|f| *f > 0.0));
        // Truncated at −0.5 deviations: median Φ = (1 + Φ(−0.5))/2 = 0.65427, x = 1 + 2 · 0.3968.
        assert!((share_below(&wide, 1.7936) - 0.5).abs() < 0.005);
    }

    #[test]
    fn seed_purpose_and_number_decide() {
        let f = |seed, purpose, n| factors(Spread::Weibull { modulus: 2.0 }, seed, purpose, n);
        assert_eq!(f(3, 0, 10), f(3, 0, 1000)[..10]);
        assert!(f(3, 0, 10) != f(4, 0, 10) && f(3, 0, 10) != f(3, 1, 10));
        assert_eq!(factors(Spread::Constant, 1, 0, 2), [1.0, 1.0]);
    }
}
