//! Gaussian process of a quantity over sampled parameters (Rasmussen and Williams 2006, chapters 2 and 5).
//!
//! Squared exponential covariance with a length per parameter, noise of unknown size, constant mean.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Largest number of points of a fit.
const MOST_POINTS: usize = 200;
/// Ratio of the largest value to the smallest, or to the median size, from which values are transformed.
const WIDE: f64 = 5.0;
/// Bounds of ln length and ln(noise variance over signal variance).
const BOUNDS: [[f64; 2]; 2] = [[-2.0, 4.0], [-14.0, 5.0]];
/// First and last step of the search for them.
const STEPS: [f64; 2] = [1.0, 0.1];

/// Values as fitted.
#[derive(Clone, Copy, Debug)]
enum Transform {
    /// As they are.
    Plain,
    /// Logarithm, of wide positive values.
    Log,
    /// Inverse hyperbolic sine of value over size, of wide values of both signs.
    Asinh(f64),
}

impl Transform {
    fn of(values: &[f64]) -> Transform {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let mut sizes: Vec<f64> = values.iter().map(|v| v.abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let (median, largest) = (sizes[sizes.len() / 2], sizes[sizes.len() - 1]);
        match least > 0.0 {
            true if largest > WIDE * least => Transform::Log,
            false if largest > WIDE * median && median > 0.0 => Transform::Asinh(median),
            _ => Transform::Plain,
        }
    }

    fn fitted(self, value: f64) -> f64 {
        match self {
            Transform::Plain => value,
            Transform::Log => libm::log(value),
            Transform::Asinh(size) => libm::asinh(value / size),
        }
    }

    fn value(self, fitted: f64) -> f64 {
        match self {
            Transform::Plain => fitted,
            Transform::Log => libm::exp(fitted),
            Transform::Asinh(size) => size * libm::sinh(fitted),
        }
    }

    /// Change of the fitted value per unit of the value.
    fn slope(self, value: f64) -> f64 {
        match self {
            Transform::Plain => 1.0,
            Transform::Log => 1.0 / value,
            Transform::Asinh(size) => 1.0 / libm::hypot(value, size),
        }
    }
}

/// Fit of a quantity; parameters in the unit cube.
#[derive(Clone, Debug)]
pub struct Emulator {
    points: Vec<Vec<f64>>,
    transform: Transform,
    mean: f64,
    /// Inverse squared lengths.
    weights: Vec<f64>,
    factor: Cholesky<f64, Dyn>,
    /// K⁻¹ (y − mean).
    solved: DVector<f64>,
    signal: f64,
    /// Standard deviation of the noise, in fitted values.
    pub noise: f64,
    /// Share of the variance that points explain of each other, left out in turn.
    pub explained: f64,
}

struct Covariance {
    factor: Cholesky<f64, Dyn>,
    solved: DVector<f64>,
    signal: f64,
    /// −ln likelihood with the signal variance of largest likelihood.
    cost: f64,
}

impl Emulator {
    /// Fits `values` at `points`; none for too few or equal values.
    pub fn fit(points: &[Vec<f64>], values: &[f64]) -> Option<Emulator> {
        let count = points.len().min(MOST_POINTS);
        let (points, values) = (&points[..count], &values[..count]);
        let dimensions = points.first()?.len();
        if dimensions == 0 || count < dimensions + 4 {
            return None;
        }
        let transform = Transform::of(values);
        let shown: Vec<f64> = values.iter().map(|v| transform.fitted(*v)).collect();
        let mean = shown.iter().sum::<f64>() / count as f64;
        let centred = DVector::from_iterator(count, shown.iter().map(|v| v - mean));
        let scale = centred.amax();
        if !(scale.is_finite() && scale > 1e-12 * mean.abs()) {
            return None;
        }
        let found = search(points, &centred, dimensions)?;
        let weights: Vec<f64> = found[..dimensions].iter().map(|l| libm::exp(-2.0 * l)).collect();
        let ratio = libm::exp(found[dimensions]);
        let Covariance { factor, solved, signal, .. } = covariance(points, &centred, &weights, ratio)?;
        let inverse = factor.inverse();
        let left_out: f64 = (0..count).map(|i| (solved[i] / inverse[(i, i)]).powi(2)).sum();
        Some(Emulator {
            points: points.to_vec(),
            transform,
            mean,
            weights,
            noise: (signal * ratio).sqrt(),
            explained: 1.0 - left_out / centred.norm_squared(),
            factor,
            solved,
            signal,
        })
    }

    /// Returns mean and standard deviation of the fit at `x`, in fitted values.
    pub fn at(&self, x: &[f64]) -> [f64; 2] {
        let near = |p: &Vec<f64>| libm::exp(-0.5 * distance(p, x, &self.weights));
        let near = DVector::from_iterator(self.points.len(), self.points.iter().map(near));
        let reduced = self.factor.l_dirty().solve_lower_triangular(&near);
        let explained = reduced.map_or(0.0, |r| r.norm_squared());
        let variance = self.signal * (1.0 - explained).max(0.0);
        [self.mean + near.dot(&self.solved), variance.sqrt()]
    }

    /// Returns the variance of the quantity for a variance of the fitted value at `fitted`.
    pub fn variance(&self, fitted: f64, variance: f64) -> f64 {
        let slope = self.transform.slope(self.transform.value(fitted));
        variance / (slope * slope)
    }

    /// Returns a standard deviation at `value` as fitted; none outside the range of the fit.
    pub fn fitted_deviation(&self, value: f64, deviation: f64) -> Option<f64> {
        let fitted = deviation * self.transform.slope(value);
        (self.transform.fitted(value).is_finite() && fitted.is_finite()).then_some(fitted)
    }

    /// Returns the quantity of a fitted value.
    pub fn value(&self, fitted: f64) -> f64 {
        self.transform.value(fitted)
    }
}

fn distance(a: &[f64], b: &[f64], weights: &[f64]) -> f64 {
    a.iter().zip(b).zip(weights).map(|((a, b), w)| w * (a - b) * (a - b)).sum()
}

/// Factor, solution and likelihood; `ratio`: noise over signal variance.
fn covariance(points: &[Vec<f64>], y: &DVector<f64>, weights: &[f64], ratio: f64) -> Option<Covariance> {
    let n = points.len();
    let mut matrix = DMatrix::zeros(n, n);
    for i in 0..n {
        for j in 0..i {
            let near = libm::exp(-0.5 * distance(&points[i], &points[j], weights));
            (matrix[(i, j)], matrix[(j, i)]) = (near, near);
        }
        matrix[(i, i)] = 1.0 + ratio;
    }
    let factor = matrix.cholesky()?;
    let solved = factor.solve(y);
    let signal = y.dot(&solved) / n as f64;
    let determinant: f64 = (0..n).map(|i| libm::log(factor.l_dirty()[(i, i)])).sum();
    let cost = 0.5 * n as f64 * libm::log(signal) + determinant;
    cost.is_finite().then_some(Covariance { factor, solved, signal, cost })
}

/// Logarithms of the lengths and of the noise ratio of largest likelihood, by pattern search.
fn search(points: &[Vec<f64>], y: &DVector<f64>, dimensions: usize) -> Option<Vec<f64>> {
    let cost = |at: &[f64]| {
        let weights: Vec<f64> = at[..dimensions].iter().map(|l| libm::exp(-2.0 * l)).collect();
        covariance(points, y, &weights, libm::exp(at[dimensions])).map_or(f64::INFINITY, |c| c.cost)
    };
    let mut at = vec![0.0; dimensions];
    at.push(-2.0);
    let mut least = cost(&at);
    let mut step = STEPS[0];
    while step > STEPS[1] {
        let mut improved = false;
        for k in 0..at.len() {
            let [low, high] = BOUNDS[usize::from(k == dimensions)];
            for other in [(at[k] - step).max(low), (at[k] + step).min(high)] {
                let mut trial = at.clone();
                trial[k] = other;
                let found = cost(&trial);
                if found < least - 1e-9 {
                    (at, least, improved) = (trial, found, true);
                }
            }
        }
        if !improved {
            step *= 0.5;
        }
    }
    least.is_finite().then_some(at)
}

#[cfg(test)]
mod tests {
    use super::super::design::sobol;
    use super::*;
    use trackbed_dem::random::Random;

    #[test]
    fn smooth_function_is_interpolated() {
        let points = sobol(60, 2, Some(3));
        let of = |x: &[f64]| libm::sin(4.0 * x[0]) + 0.5 * x[1] * x[1];
        let values: Vec<f64> = points.iter().map(|p| of(p)).collect();
        let fit = Emulator::fit(&points, &values).unwrap();
        assert!(fit.explained > 0.999 && fit.noise < 0.01, "{} {}", fit.explained, fit.noise);
        for x in [[0.3, 0.4], [0.7, 0.2], [0.5, 0.9]] {
            let [mean, deviation] = fit.at(&x);
            assert!((mean - of(&x)).abs() < 0.01, "{mean} {}", of(&x));
            assert!(deviation < 0.05, "{deviation}");
        }
        // Without points near by it is as uncertain as the quantity varies.
        assert!(fit.at(&[9.0, 9.0])[1] > 0.3);
    }

    #[test]
    fn noise_is_found() {
        let points = sobol(120, 2, Some(5));
        // Uniform noise of a standard deviation of 0.1.
        let noise = |k: usize| 0.1 * 12.0_f64.sqrt() * (Random::new(3, k as u64).uniform() - 0.5);
        let values: Vec<f64> = points.iter().enumerate().map(|(k, p)| p[0] + noise(k)).collect();
        let fit = Emulator::fit(&points, &values).unwrap();
        assert!((fit.noise - 0.1).abs() < 0.02, "{}", fit.noise);
        assert!((fit.at(&[0.5, 0.5])[0] - 0.5).abs() < 0.05);
        assert!(Emulator::fit(&points, &[1.0; 120]).is_none());
        assert!(Emulator::fit(&points[..4], &values[..4]).is_none());
    }

    #[test]
    fn wide_positive_values_are_logarithms() {
        let points = sobol(40, 1, Some(2));
        let values: Vec<f64> = points.iter().map(|p| libm::exp(5.0 * p[0])).collect();
        let fit = Emulator::fit(&points, &values).unwrap();
        assert!((fit.value(fit.at(&[0.5])[0]) / libm::exp(2.5) - 1.0).abs() < 0.01);
        assert!((fit.fitted_deviation(10.0, 1.0).unwrap() - 0.1).abs() < 1e-12);
        assert_eq!(fit.fitted_deviation(-1.0, 1.0), None);
        // A deviation of 0.1 of a logarithm is a tenth of the value.
        assert!((fit.variance(libm::log(10.0), 0.01) - 1.0).abs() < 1e-12);
        // Of both signs.
        let values: Vec<f64> = points.iter().map(|p| libm::sinh(8.0 * p[0] - 2.0)).collect();
        let fit = Emulator::fit(&points, &values).unwrap();
        assert!((fit.value(fit.at(&[0.3])[0]) / libm::sinh(0.4) - 1.0).abs() < 0.05);
        let Transform::Asinh(size) = fit.transform else { panic!("{:?}", fit.transform) };
        assert!((fit.fitted_deviation(-3.0, 0.1).unwrap() - 0.1 / libm::hypot(3.0, size)).abs() < 1e-12);
    }
}
