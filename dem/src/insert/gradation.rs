//! Grading curve and grain sizes drawn from it.
//!
//! ```text
//! dn = M / ln(b/a) · d⁻⁴ dd,    n(d) − n(a) = M / (3 ln(b/a)) · (a⁻³ − d⁻³),
//! ```
//!
//! Mass is uniform over ln d between sieves a < b with mass fraction M. Stratified quantiles of n grains have
//! a passing error of about 1/n instead of 1/√n.
//!
//! Theory manual: equation (2.2) of `docs/theory/shapes.md`.

use crate::base::random::Random;
use serde::{Deserialize, Serialize};

const PURPOSE: u64 = 1;

/// Invalid grading.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GradationError {
    /// Unequal columns, or fewer than two sieves.
    #[error(
        "a gradation needs at least two sieves and one passing value for each: {sizes} sizes, {passing} values"
    )]
    Length {
        /// Number of sieve sizes.
        sizes: usize,
        /// Number of passing values.
        passing: usize,
    },
    /// Size not positive and finite, or not ascending.
    #[error("sieve {index}: size {size} m; sizes must be positive and strictly rising")]
    Size {
        /// Row index, ascending size.
        index: usize,
        /// Size [m].
        size: f64,
    },
    /// Passing fraction outside 0–1 or descending.
    #[error(
        "sieve {index}: passing fraction {passing}; fractions must lie in 0..1 and never fall with rising size"
    )]
    Passing {
        /// Row index, ascending size.
        index: usize,
        /// Fraction [-].
        passing: f64,
    },
    /// Lower above upper limit.
    #[error("sieve {index}: lower limit {lo} is above the upper limit {hi}")]
    Limits {
        /// Row index, ascending size.
        index: usize,
        /// Lower limit [-].
        lo: f64,
        /// Upper limit [-].
        hi: f64,
    },
    /// Passing below 1 at the largest sieve.
    #[error("only the fraction {0} passes the largest sieve; it must be 1, add a larger sieve")]
    Oversize(f64),
    /// Passing above 0 at the smallest sieve.
    #[error(
        "the fraction {0} passes the smallest sieve; add a finest size with nothing passing, or cut the fines"
    )]
    Fines(f64),
}

/// Grading curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Gradation {
    sizes: Vec<f64>,
    passing: Vec<f64>,
}

impl Gradation {
    /// Builds a curve from ascending sieve sizes [m] and mass fractions passing [-], 0 to 1.
    ///
    /// # Errors
    /// [`GradationError`] with the row.
    pub fn new(sizes: &[f64], passing: &[f64]) -> Result<Gradation, GradationError> {
        let n = sizes.len();
        if n < 2 || passing.len() != n {
            return Err(GradationError::Length { sizes: n, passing: passing.len() });
        }
        for i in 0..n {
            let above = i == 0 || sizes[i] > sizes[i - 1];
            if !(sizes[i] > 0.0 && sizes[i].is_finite() && above) {
                return Err(GradationError::Size { index: i, size: sizes[i] });
            }
            if !((0.0..=1.0).contains(&passing[i]) && (i == 0 || passing[i] >= passing[i - 1])) {
                return Err(GradationError::Passing { index: i, passing: passing[i] });
            }
        }
        if passing[n - 1] != 1.0 {
            return Err(GradationError::Oversize(passing[n - 1]));
        }
        if passing[0] != 0.0 {
            return Err(GradationError::Fines(passing[0]));
        }
        Ok(Gradation { sizes: sizes.to_vec(), passing: passing.to_vec() })
    }

    /// Mean of a standard's limits: ascending sieve sizes [m], lower and upper mass fractions passing. Grains
    /// below the first sieve extend to `finest` [m], or are cut (`None`).
    ///
    /// # Errors
    /// [`GradationError`] with the row of the extended table.
    pub fn from_limits(
        sizes: &[f64],
        lo: &[f64],
        hi: &[f64],
        finest: Option<f64>,
    ) -> Result<Gradation, GradationError> {
        if lo.len() != sizes.len() || hi.len() != sizes.len() || sizes.is_empty() {
            return Err(GradationError::Length { sizes: sizes.len(), passing: lo.len().min(hi.len()) });
        }
        if let Some(index) = (0..lo.len()).find(|&i| lo[i] > hi[i]) {
            return Err(GradationError::Limits { index, lo: lo[index], hi: hi[index] });
        }
        let mut sizes = sizes.to_vec();
        let mut passing: Vec<f64> = lo.iter().zip(hi).map(|(a, b)| 0.5 * (a + b)).collect();
        match finest {
            Some(size) if passing[0] > 0.0 => {
                sizes.insert(0, size);
                passing.insert(0, 0.0);
            }
            _ if passing[0] < 1.0 => {
                let fines = passing[0];
                passing.iter_mut().for_each(|p| *p = (*p - fines) / (1.0 - fines));
            }
            _ => {}
        }
        Gradation::new(&sizes, &passing)
    }

    /// Sieve sizes [m], ascending.
    pub fn sizes(&self) -> &[f64] {
        &self.sizes
    }

    /// Mass fraction passing each sieve [-].
    pub fn passing(&self) -> &[f64] {
        &self.passing
    }

    /// Scales sizes by `s` > 0.
    pub fn scaled(&self, s: f64) -> Gradation {
        Gradation { sizes: self.sizes.iter().map(|d| d * s).collect(), passing: self.passing.clone() }
    }

    /// Mass fraction finer than `size` [m], linear in ln(size).
    pub fn passing_at(&self, size: f64) -> f64 {
        let k = self.sizes.partition_point(|&d| d <= size);
        if k == 0 {
            return 0.0;
        }
        if k == self.sizes.len() {
            return 1.0;
        }
        let t = libm::log(size / self.sizes[k - 1]) / libm::log(self.sizes[k] / self.sizes[k - 1]);
        self.passing[k - 1] + t * (self.passing[k] - self.passing[k - 1])
    }

    /// Number mean of size³ [m³].
    pub fn mean_cube(&self) -> f64 {
        1.0 / self.number_weights().iter().sum::<f64>()
    }

    /// Grains per class and unit of Σ d³ [m⁻³].
    fn number_weights(&self) -> Vec<f64> {
        let class = |k: usize| {
            let (a, b) = (self.sizes[k], self.sizes[k + 1]);
            (self.passing[k + 1] - self.passing[k]) * (a.powi(-3) - b.powi(-3)) / (3.0 * libm::log(b / a))
        };
        (0..self.sizes.len() - 1).map(class).collect()
    }

    /// Draws `n` sizes [m] in random order, reproducible by `seed`.
    pub fn sample(&self, n: usize, seed: u64) -> Vec<f64> {
        let mut random = Random::new(seed, PURPOSE);
        let weights = self.number_weights();
        let total: f64 = weights.iter().sum();
        let mut class = 0;
        let mut below = 0.0; // number weight of classes passed
        let mut sorted = Vec::with_capacity(n);
        for i in 0..n {
            let at = total * (i as f64 + random.uniform()) / n as f64;
            while class + 1 < weights.len() && at >= below + weights[class] {
                below += weights[class];
                class += 1;
            }
            let (a, b) = (self.sizes[class].powi(-3), self.sizes[class + 1].powi(-3));
            let share = ((at - below) / weights[class]).clamp(0.0, 1.0);
            sorted.push(libm::pow(a - share * (a - b), -1.0 / 3.0));
        }
        random.permutation(n).into_iter().map(|i| sorted[i]).collect()
    }
}

/// Mass fraction [-] of grains (size [m], mass [kg]) passing `sieves` [m], equal size included; zero without
/// mass.
pub fn achieved_passing(sieves: &[f64], stones: &[(f64, f64)]) -> Vec<f64> {
    let total: f64 = stones.iter().map(|s| s.1).sum();
    let finer = |sieve: f64| stones.iter().filter(|s| s.0 <= sieve).fold(0.0, |sum, s| sum + s.1);
    sieves.iter().map(|&s| if total > 0.0 { finer(s) / total } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const SIEVES: [f64; 6] = [0.0224, 0.0315, 0.040, 0.050, 0.063, 0.080];
    const LO: [f64; 6] = [0.0, 0.01, 0.30, 0.70, 1.0, 1.0];
    const HI: [f64; 6] = [0.03, 0.25, 0.65, 0.99, 1.0, 1.0];

    fn cubes(sizes: &[f64]) -> Vec<(f64, f64)> {
        sizes.iter().map(|d| (*d, d.powi(3))).collect()
    }

    #[test]
    fn two_thousand_stones_meet_the_curve() {
        for finest in [None, Some(0.016)] {
            let g = Gradation::from_limits(&SIEVES, &LO, &HI, finest).unwrap();
            let stones = cubes(&g.sample(2000, 7));
            let sieves: Vec<f64> = (0..60).map(|i| 0.016 * 1.03_f64.powi(i)).collect();
            for (s, achieved) in sieves.iter().zip(achieved_passing(&sieves, &stones)) {
                assert!((achieved - g.passing_at(*s)).abs() < 2e-3, "{s}: {achieved} {}", g.passing_at(*s));
            }
        }
    }

    #[test]
    fn limits_average_and_fines_cut() {
        let kept = Gradation::from_limits(&SIEVES, &LO, &HI, Some(0.016)).unwrap();
        assert_relative_eq!(kept.passing_at(0.040), 0.475, max_relative = 1e-14);
        assert_relative_eq!(kept.passing_at(0.0224), 0.015, max_relative = 1e-14);
        let cut = Gradation::from_limits(&SIEVES, &LO, &HI, None).unwrap();
        assert_relative_eq!(cut.passing_at(0.040), (0.475 - 0.015) / 0.985, max_relative = 1e-14);
        assert!(cut.sample(500, 1).iter().all(|d| (0.0224..=0.063).contains(d)));
        assert_relative_eq!(cut.scaled(2.0).passing_at(0.080), cut.passing_at(0.040), max_relative = 1e-12);
    }

    #[test]
    fn mean_cube_matches_sample() {
        let g = Gradation::from_limits(&SIEVES, &LO, &HI, None).unwrap();
        let mean = cubes(&g.sample(4000, 3)).iter().map(|s| s.1).sum::<f64>() / 4000.0;
        assert_relative_eq!(mean, g.mean_cube(), max_relative = 1e-3);
        let narrow = Gradation::new(&[0.05, 0.050001], &[0.0, 1.0]).unwrap();
        assert_relative_eq!(narrow.mean_cube(), 0.05_f64.powi(3), max_relative = 1e-4);
    }

    #[test]
    fn sampling_is_reproducible_and_shuffled() {
        let g = Gradation::from_limits(&SIEVES, &LO, &HI, None).unwrap();
        let a = g.sample(300, 5);
        assert!(a.iter().zip(g.sample(300, 5)).all(|(x, y)| x.to_bits() == y.to_bits()));
        assert_ne!(a, g.sample(300, 6));
        let half = |s: &[f64]| s.iter().sum::<f64>() / s.len() as f64;
        assert_relative_eq!(half(&a[..150]), half(&a[150..]), max_relative = 0.1);
    }

    #[test]
    fn bad_tables_are_refused_by_row() {
        let length = GradationError::Length { sizes: 1, passing: 1 };
        assert_eq!(Gradation::new(&[1.0], &[1.0]), Err(length));
        let size = GradationError::Size { index: 1, size: 0.02 };
        assert_eq!(Gradation::new(&[0.02, 0.02], &[0.0, 1.0]), Err(size));
        let falls = GradationError::Passing { index: 2, passing: 0.4 };
        assert_eq!(Gradation::new(&[0.1, 0.2, 0.3, 0.4], &[0.0, 0.5, 0.4, 1.0]), Err(falls));
        assert_eq!(Gradation::new(&[0.1, 0.2], &[0.0, 0.9]), Err(GradationError::Oversize(0.9)));
        assert_eq!(Gradation::new(&[0.1, 0.2], &[0.1, 1.0]), Err(GradationError::Fines(0.1)));
        let nan = Gradation::new(&[0.1, 0.2], &[f64::NAN, 1.0]);
        assert!(matches!(nan, Err(GradationError::Passing { index: 0, .. })));
        let limits = GradationError::Limits { index: 1, lo: 1.0, hi: 0.5 };
        assert_eq!(Gradation::from_limits(&[0.1, 0.2], &[0.0, 1.0], &[0.0, 0.5], None), Err(limits));
    }
}
