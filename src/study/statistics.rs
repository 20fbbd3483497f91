//! Sensitivity: standardized linear regression, rank correlation of Spearman.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Smallest eigenvalue of the correlation matrix of independent parameters.
const INDEPENDENT: f64 = 1e-8;
/// Smallest spread, relative to the largest value.
const SPREAD: f64 = 1e-12;

/// Linear regression on standardized variables.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Regression {
    /// Standardized regression coefficient by parameter.
    pub coefficients: Vec<f64>,
    /// Standard error of the coefficients.
    pub standard_errors: Vec<f64>,
    /// Change of the result per unit of each parameter.
    pub slopes: Vec<f64>,
    /// Result at the origin of the parameters.
    pub intercept: f64,
    /// Coefficient of determination R².
    pub r_squared: f64,
}

impl Regression {
    /// Fits y to the columns `x`; none for too few points, constant or dependent columns.
    pub fn fit(x: &[Vec<f64>], y: &[f64]) -> Option<Regression> {
        let (p, n) = (x.len(), y.len());
        if p == 0 || n < p + 2 {
            return None;
        }
        let columns = x.iter().map(|column| Standardized::of(column)).collect::<Option<Vec<_>>>()?;
        let result = Standardized::of(y)?;
        let correlation = |a: &Standardized, b: &Standardized| dot(&a.values, &b.values) / (n - 1) as f64;
        let matrix = DMatrix::from_fn(p, p, |i, j| correlation(&columns[i], &columns[j]));
        let right = DVector::from_fn(p, |i, _| correlation(&columns[i], &result));
        if matrix.clone().symmetric_eigenvalues().min() < INDEPENDENT {
            return None;
        }
        let inverse = matrix.cholesky()?.inverse();
        let coefficients: Vec<f64> = (&inverse * &right).iter().copied().collect();
        let r_squared = dot(&coefficients, right.as_slice()).clamp(0.0, 1.0);
        let residual = (1.0 - r_squared) / (n - p - 1) as f64;
        let standard_errors = (0..p).map(|j| (residual * inverse[(j, j)]).sqrt()).collect();
        let slopes: Vec<f64> =
            coefficients.iter().zip(&columns).map(|(b, c)| b * result.deviation / c.deviation).collect();
        let means: Vec<f64> = columns.iter().map(|c| c.mean).collect();
        let intercept = result.mean - dot(&slopes, &means);
        Some(Regression { coefficients, standard_errors, slopes, intercept, r_squared })
    }

    /// Fits y to the columns that are `fitted`; the others have coefficients of zero.
    pub fn fit_some(x: &[Vec<f64>], fitted: &[bool], y: &[f64]) -> Option<Regression> {
        let some: Vec<Vec<f64>> = x.iter().zip(fitted).filter(|(_, f)| **f).map(|(x, _)| x.clone()).collect();
        let mut fit = Regression::fit(&some, y)?;
        for list in [&mut fit.coefficients, &mut fit.standard_errors, &mut fit.slopes] {
            let mut own = std::mem::take(list).into_iter();
            list.extend(fitted.iter().map(|f| if *f { own.next().unwrap_or(0.0) } else { 0.0 }));
        }
        Some(fit)
    }

    /// Returns the result of the fit at `x`.
    pub fn at(&self, x: &[f64]) -> f64 {
        self.intercept + dot(&self.slopes, x)
    }
}

struct Standardized {
    mean: f64,
    deviation: f64,
    values: Vec<f64>,
}

impl Standardized {
    /// None for constant values.
    fn of(values: &[f64]) -> Option<Standardized> {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let deviation = (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (n - 1.0)).sqrt();
        let largest = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let varies = deviation.is_finite() && deviation > SPREAD * largest;
        varies.then(|| Standardized {
            mean,
            deviation,
            values: values.iter().map(|v| (v - mean) / deviation).collect(),
        })
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns the rank correlation of Spearman; none for less than three points or constant values.
pub fn rank_correlation(x: &[f64], y: &[f64]) -> Option<f64> {
    if x.len() < 3 {
        return None;
    }
    let (x, y) = (Standardized::of(&ranks(x))?, Standardized::of(&ranks(y))?);
    Some((dot(&x.values, &y.values) / (x.values.len() - 1) as f64).clamp(-1.0, 1.0))
}

/// Ranks from 1; equal values share their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for group in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let rank = first as f64 + 0.5 * (group.len() + 1) as f64;
        group.iter().for_each(|k| ranks[*k] = rank);
        first += group.len();
    }
    ranks
}

/// Returns the rank correlation that 95 % of independent samples stay below (normal approximation).
pub fn significant_correlation(count: usize) -> f64 {
    1.96 / (count.max(2) as f64 - 1.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::design::{latin_hypercube, sobol};
    use super::*;
    use approx::assert_relative_eq;

    fn columns(points: &[Vec<f64>]) -> Vec<Vec<f64>> {
        (0..points[0].len()).map(|d| points.iter().map(|p| p[d]).collect()).collect()
    }

    #[test]
    fn regression_recovers_linear_response() {
        let points = latin_hypercube(20, 3, 4);
        let y: Vec<f64> = points.iter().map(|p| 5.0 + 2.0 * p[0] - 3e-4 * p[1] + 1e3 * p[2]).collect();
        let fit = Regression::fit(&columns(&points), &y).unwrap();
        assert_relative_eq!(fit.intercept, 5.0, max_relative = 1e-9);
        for (slope, expected) in fit.slopes.iter().zip([2.0, -3e-4, 1e3]) {
            assert_relative_eq!(*slope, expected, max_relative = 1e-6);
        }
        assert_relative_eq!(fit.r_squared, 1.0, max_relative = 1e-12);
        assert!(fit.standard_errors.iter().all(|s| *s < 1e-6), "{fit:?}");
        assert_relative_eq!(fit.at(&[0.0, 0.0, 2.0]), 2005.0, max_relative = 1e-9);
        let deviation = |v: &[f64]| Standardized::of(v).unwrap().deviation;
        let expected = 2.0 * deviation(&columns(&points)[0]) / deviation(&y);
        assert_relative_eq!(fit.coefficients[0], expected, max_relative = 1e-6);
    }

    #[test]
    fn regression_of_one_parameter_is_correlation() {
        let (x, y) = (vec![1.0, 2.0, 3.0, 4.0], [1.0, 3.0, 2.0, 4.0]);
        let fit = Regression::fit(std::slice::from_ref(&x), &y).unwrap();
        assert_relative_eq!(fit.coefficients[0], 0.8, max_relative = 1e-12);
        assert_relative_eq!(fit.r_squared, 0.64, max_relative = 1e-12);
        assert_relative_eq!(fit.standard_errors[0], (0.36_f64 / 2.0).sqrt(), max_relative = 1e-12);
        assert_relative_eq!(fit.slopes[0], 0.8, max_relative = 1e-12);
        assert_relative_eq!(fit.intercept, 0.5, max_relative = 1e-12);
    }

    #[test]
    fn regression_needs_independent_parameters() {
        let points = sobol(8, 2, None);
        let x = columns(&points);
        assert!(Regression::fit(&[x[0].clone(), x[0].clone()], &x[1]).is_none());
        assert!(Regression::fit(&[x[0].clone(), vec![3.0; 8]], &x[1]).is_none());
        assert!(Regression::fit(&x, &[2.0; 8]).is_none());
        assert!(Regression::fit(&[x[0][..3].to_vec(), x[1][..3].to_vec()], &[1.0, 2.0, 4.0]).is_none());
    }

    #[test]
    fn rank_correlation_matches_closed_form() {
        let x = [1.0, 20.0, 30.0, 41.0, 500.0];
        let y = [0.2, 0.1, 0.5, 0.3, 0.9];
        let squares = 1.0 + 1.0 + 1.0 + 1.0 + 0.0;
        assert_relative_eq!(
            rank_correlation(&x, &y).unwrap(),
            1.0 - 6.0 * squares / (5.0 * 24.0),
            max_relative = 1e-12
        );
        let cubes: Vec<f64> = x.iter().map(|v| -v * v * v).collect();
        assert_relative_eq!(rank_correlation(&x, &cubes).unwrap(), -1.0, max_relative = 1e-12);
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 2.0]), [3.5, 1.0, 3.5, 2.0]);
        assert_eq!(rank_correlation(&x, &[1.0; 5]), None);
        assert_relative_eq!(significant_correlation(101), 0.196, max_relative = 1e-12);
    }
}
