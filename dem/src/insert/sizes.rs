//! Size distributions: monodisperse, bidisperse, uniform, truncated normal and log-normal.
//!
//! Newton's method on the quantiles. Φ near 0: Abramowitz & Stegun 1964, 26.2.11; beyond 3: 26.2.14.

use crate::base::random::Random;
use std::f64::consts::TAU;

const PURPOSE: u64 = 3;

/// Size distribution [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SizeLaw {
    /// Monodisperse.
    Equal(f64),
    /// Bidisperse.
    Two {
        /// Small size [m].
        small: f64,
        /// Large size [m].
        large: f64,
        /// Volume fraction of large grains [-].
        large_share: f64,
    },
    /// Uniform by number.
    ByNumber {
        /// Smallest [m].
        low: f64,
        /// Largest [m].
        high: f64,
    },
    /// Uniform by volume.
    ByVolume {
        /// Smallest [m].
        low: f64,
        /// Largest [m].
        high: f64,
    },
    /// Truncated normal, by number.
    Normal {
        /// Untruncated mean [m].
        mean: f64,
        /// Untruncated standard deviation [m].
        deviation: f64,
        /// Smallest [m].
        low: f64,
        /// Largest [m].
        high: f64,
    },
    /// Truncated log-normal, by number.
    LogNormal {
        /// Untruncated median [m].
        median: f64,
        /// Untruncated standard deviation of ln(size) [-].
        deviation: f64,
        /// Smallest [m].
        low: f64,
        /// Largest [m].
        high: f64,
    },
}

/// Invalid size distribution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SizeError {
    /// Size not positive and finite.
    #[error("the size {0} m is not positive and finite")]
    Size(f64),
    /// Limits not ascending.
    #[error("sizes from {0} m to {1} m: the first must be the smaller")]
    Order(f64, f64),
    /// Fraction out of range.
    #[error("the fraction {0} of the large size must lie in 0..1")]
    Share(f64),
    /// Deviation not positive.
    #[error("the standard deviation {0} must be positive and finite")]
    Deviation(f64),
    /// Truncation leaves almost nothing.
    #[error("almost nothing of the distribution lies between {0} m and {1} m")]
    Cut(f64, f64),
}

impl SizeLaw {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`SizeError`] of the first invalid value.
    pub fn check(&self) -> Result<(), SizeError> {
        let size = |d: f64| if d > 0.0 && d.is_finite() { Ok(()) } else { Err(SizeError::Size(d)) };
        let range = |low: f64, high: f64| {
            size(low).and(size(high))?;
            if low <= high { Ok(()) } else { Err(SizeError::Order(low, high)) }
        };
        let spread = |s: f64| if s > 0.0 && s.is_finite() { Ok(()) } else { Err(SizeError::Deviation(s)) };
        match *self {
            SizeLaw::Equal(d) => size(d),
            SizeLaw::Two { small, large, large_share } => {
                range(small, large)?;
                if (0.0..=1.0).contains(&large_share) { Ok(()) } else { Err(SizeError::Share(large_share)) }
            }
            SizeLaw::ByNumber { low, high } | SizeLaw::ByVolume { low, high } => range(low, high),
            SizeLaw::Normal { deviation, low, high, mean } => {
                size(mean).and(range(low, high)).and(spread(deviation))?;
                self.cut(low, high)
            }
            SizeLaw::LogNormal { deviation, low, high, median } => {
                size(median).and(range(low, high)).and(spread(deviation))?;
                self.cut(low, high)
            }
        }
    }

    fn cut(&self, low: f64, high: f64) -> Result<(), SizeError> {
        let [a, b] = self.ends();
        if normal(b) - normal(a) > 1e-6 { Ok(()) } else { Err(SizeError::Cut(low, high)) }
    }

    /// Truncation limits in standard deviations.
    fn ends(&self) -> [f64; 2] {
        match *self {
            SizeLaw::Normal { mean, deviation, low, high } => {
                [(low - mean) / deviation, (high - mean) / deviation]
            }
            SizeLaw::LogNormal { median, deviation, low, high } => {
                [libm::log(low / median) / deviation, libm::log(high / median) / deviation]
            }
            _ => [0.0; 2],
        }
    }

    /// Size at number fraction `q` [m].
    pub fn quantile(&self, q: f64) -> f64 {
        match *self {
            SizeLaw::Equal(d) => d,
            SizeLaw::Two { small, large, large_share } => {
                // Number: volume fraction over grain volume.
                let (s, l) = ((1.0 - large_share) / small.powi(3), large_share / large.powi(3));
                if q * (s + l) < s { small } else { large }
            }
            SizeLaw::ByNumber { low, high } => low + q * (high - low),
            SizeLaw::ByVolume { low, high } => {
                libm::pow(low.powi(-2) + q * (high.powi(-2) - low.powi(-2)), -0.5).clamp(low, high)
            }
            SizeLaw::Normal { mean, deviation, low, high } => {
                (mean + deviation * self.cut_quantile(q)).clamp(low, high)
            }
            SizeLaw::LogNormal { median, deviation, low, high } => {
                (median * libm::exp(deviation * self.cut_quantile(q))).clamp(low, high)
            }
        }
    }

    fn cut_quantile(&self, q: f64) -> f64 {
        let [a, b] = self.ends();
        let (pa, pb) = (normal(a), normal(b));
        let target = pa + q * (pb - pa);
        let (mut low, mut high) = (a.max(-9.0), b.min(9.0));
        let mut x = 0.5 * (low + high);
        for _ in 0..80 {
            let error = normal(x) - target;
            if error > 0.0 {
                high = x
            } else {
                low = x
            }
            let next = x - error / density(x);
            let new = if next > low && next < high { next } else { 0.5 * (low + high) };
            if (new - x).abs() <= 1e-15 * x.abs().max(1.0) {
                return new;
            }
            x = new;
        }
        x
    }

    /// Draws `n` sizes [m] in random order, reproducible by `seed`.
    pub fn sample(&self, n: usize, seed: u64) -> Vec<f64> {
        let mut random = Random::new(seed, PURPOSE);
        let sorted: Vec<f64> =
            (0..n).map(|i| self.quantile((i as f64 + random.uniform()) / n as f64)).collect();
        random.permutation(n).into_iter().map(|i| sorted[i]).collect()
    }
}

fn density(x: f64) -> f64 {
    libm::exp(-0.5 * x * x) / TAU.sqrt()
}

fn normal(x: f64) -> f64 {
    if x.abs() > 3.0 {
        let y = x.abs();
        let tail = density(y) / (1..=120).rev().fold(y, |f, k| y + f64::from(k) / f);
        return if x > 0.0 { 1.0 - tail } else { tail };
    }
    let (mut term, mut sum, mut k) = (x, x, 1.0);
    while term.abs() > 1e-17 * sum.abs() {
        k += 2.0;
        term *= x * x / k;
        sum += term;
    }
    0.5 + density(x) * sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Abramowitz & Stegun 1964, table 26.1; symmetry, both branches.
    #[test]
    fn normal_distribution_function() {
        for (x, p) in [
            (0.0, 0.5),
            (0.5, 0.691_462_461_274_013),
            (1.0, 0.841_344_746_068_543),
            (2.0, 0.977_249_868_051_821),
            (3.0, 0.998_650_101_968_370),
            (4.0, 0.999_968_328_758_167),
        ] {
            assert_relative_eq!(normal(x), p, epsilon = 1e-14);
            assert_relative_eq!(normal(-x), 1.0 - p, epsilon = 1e-14);
        }
        assert_relative_eq!(normal(-3.0 - 1e-9), normal(-3.0 + 1e-9), max_relative = 1e-7);
    }

    fn moments(d: &[f64]) -> (f64, f64) {
        let mean = d.iter().sum::<f64>() / d.len() as f64;
        (mean, (d.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / d.len() as f64).sqrt())
    }

    #[test]
    fn samples_match_distribution_moments() {
        let n = 4000;
        let d = SizeLaw::ByNumber { low: 0.02, high: 0.05 }.sample(n, 1);
        assert_relative_eq!(moments(&d).0, 0.035, max_relative = 1e-3);
        assert_relative_eq!(moments(&d).1, 0.03 / 12.0_f64.sqrt(), max_relative = 1e-3);

        let wide = SizeLaw::Normal { mean: 0.04, deviation: 0.005, low: 0.001, high: 0.2 };
        let (mean, deviation) = moments(&wide.sample(n, 2));
        assert_relative_eq!(mean, 0.04, max_relative = 1e-3);
        assert_relative_eq!(deviation, 0.005, max_relative = 5e-3);
        // Truncated at ±1 deviation (Johnson et al. 1994).
        let cut = SizeLaw::Normal { mean: 0.04, deviation: 0.005, low: 0.035, high: 0.045 };
        let d = cut.sample(n, 3);
        assert_relative_eq!(moments(&d).1, 0.005 * 0.291_125_f64.sqrt(), max_relative = 2e-3);
        assert!(d.iter().all(|x| (0.035..=0.045).contains(x)));

        let log = SizeLaw::LogNormal { median: 0.03, deviation: 0.3, low: 1e-4, high: 1.0 };
        let d = log.sample(n, 4);
        assert_relative_eq!(moments(&d).0, 0.03 * (0.045_f64).exp(), max_relative = 2e-3);
        let logs: Vec<f64> = d.iter().map(|x| x.ln()).collect();
        assert_relative_eq!(moments(&logs).1, 0.3, max_relative = 5e-3);
        assert_relative_eq!(log.quantile(0.5), 0.03, max_relative = 1e-12);
    }

    #[test]
    fn volume_laws_match_volume_fractions() {
        let n = 20_000;
        let d = SizeLaw::Two { small: 0.02, large: 0.05, large_share: 0.6 }.sample(n, 7);
        let volume =
            |keep: &dyn Fn(f64) -> bool| d.iter().filter(|x| keep(**x)).map(|x| x.powi(3)).sum::<f64>();
        assert!((volume(&|x| x > 0.03) / volume(&|_| true) - 0.6).abs() < 1e-3);
        let d = SizeLaw::ByVolume { low: 0.02, high: 0.06 }.sample(n, 8);
        let volume = |to: f64| d.iter().filter(|x| **x <= to).map(|x| x.powi(3)).sum::<f64>();
        for share in [0.25, 0.5, 0.75] {
            assert!((volume(0.02 + 0.04 * share) / volume(0.06) - share).abs() < 1e-3);
        }
        assert!(
            SizeLaw::Two { small: 0.02, large: 0.05, large_share: 0.0 }
                .sample(9, 1)
                .iter()
                .all(|d| *d == 0.02)
        );
        assert!(
            SizeLaw::Two { small: 0.02, large: 0.05, large_share: 1.0 }
                .sample(9, 1)
                .iter()
                .all(|d| *d == 0.05)
        );
    }

    #[test]
    fn seeds_and_refusals() {
        let law = SizeLaw::LogNormal { median: 0.03, deviation: 0.3, low: 0.01, high: 0.1 };
        assert_eq!(law.sample(50, 1), law.sample(50, 1));
        assert_ne!(law.sample(50, 1), law.sample(50, 2));
        assert_eq!(SizeLaw::Equal(0.0).check(), Err(SizeError::Size(0.0)));
        assert_eq!(SizeLaw::ByNumber { low: 2.0, high: 1.0 }.check(), Err(SizeError::Order(2.0, 1.0)));
        let two = SizeLaw::Two { small: 1.0, large: 2.0, large_share: 1.1 };
        assert_eq!(two.check(), Err(SizeError::Share(1.1)));
        let flat = SizeLaw::Normal { mean: 1.0, deviation: 0.0, low: 0.5, high: 2.0 };
        assert_eq!(flat.check(), Err(SizeError::Deviation(0.0)));
        let off = SizeLaw::Normal { mean: 1.0, deviation: 0.01, low: 2.0, high: 3.0 };
        assert_eq!(off.check(), Err(SizeError::Cut(2.0, 3.0)));
        assert_eq!(law.check(), Ok(()));
    }
}
