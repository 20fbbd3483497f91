//! Posterior of sampled parameters given the targets (Kennedy and O'Hagan 2001, without model discrepancy).
//!
//! Prior uniform over the ranges; each quantity by an emulator; likelihood normal, with the tolerance of the target,
//! the scatter of specimens and the uncertainty of the emulator, all in units of the quantity.

use super::design::{SOBOL_DIMENSIONS, sobol};
use super::emulator::Emulator;
use super::factor::Factor;
use super::layout::{Cell, Table};
use super::point::{Column, Point};
use super::target::Target;
use serde::{Deserialize, Serialize};

/// Points at which the posterior is evaluated.
const POINTS: usize = 1 << 14;
/// Effective points below which they are placed again, closer to the posterior.
const ENOUGH: f64 = 500.0;
/// Effective points below which nothing is determined.
const FEWEST: f64 = 50.0;
/// Largest number of such rounds.
const ROUNDS: usize = 4;
/// Weight outside the box of the next round, on each side of each parameter.
const OUTSIDE: f64 = 1e-3;
/// Ratio to the standard deviation of the prior above which a parameter is undetermined.
const UNDETERMINED: f64 = 0.8;
/// Median deviation of a target above which it is not reached.
const MISSED: f64 = 2.5;
/// Correlation from which a pair of parameters is reported.
const CORRELATED: f64 = 0.4;
/// Lower and upper quantile of the bands.
const BAND: [f64; 2] = [0.05, 0.95];

/// Posterior of the parameters and predictions from it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Posterior {
    /// Parameters.
    pub parameters: Vec<Marginal>,
    /// Quantities with and without targets.
    pub predictions: Vec<Prediction>,
    /// Pairs of correlated parameters, and their correlation.
    pub correlations: Vec<(String, String, f64)>,
    /// Effective number of points.
    pub effective: f64,
    /// Targets out of reach, with their deviation in tolerances and scatter.
    #[serde(default)]
    pub missed: Vec<(String, f64)>,
}

/// Distribution of a parameter.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Marginal {
    /// Name and unit.
    pub parameter: String,
    /// Range of the prior.
    pub range: [f64; 2],
    /// Median.
    pub median: f64,
    /// 5 % and 95 % quantile.
    pub band: [f64; 2],
    /// Standard deviation over the prior's.
    pub deviation: f64,
}

impl Marginal {
    /// Whether the targets leave the parameter as uncertain as before.
    pub fn is_undetermined(&self) -> bool {
        self.deviation > UNDETERMINED
    }
}

/// Quantity of one specimen with the parameters of the posterior.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Prediction {
    /// Name and unit.
    pub quantity: String,
    /// Measured value.
    pub target: Option<f64>,
    /// Median.
    pub median: f64,
    /// 5 % and 95 % quantile, with the scatter of specimens.
    pub band: [f64; 2],
    /// The same with the parameters of the prior.
    pub prior: [f64; 2],
    /// Share of the variance that the emulator explains of samples left out.
    pub explained: f64,
}

struct Fitted<'a> {
    column: &'a Column,
    target: Option<&'a Target>,
    emulator: Emulator,
    /// Variance of a single specimen, in fitted values.
    scatter: f64,
}

struct Sampled {
    points: Vec<Vec<f64>>,
    weights: Vec<f64>,
}

impl Posterior {
    /// Evaluates sampled parameters with targets; else the reason why not.
    pub fn of(
        factors: &[Factor],
        points: &[Point],
        results: &[Column],
        targets: &[Target],
    ) -> Result<Posterior, String> {
        let varied: Vec<usize> =
            (0..factors.len()).filter(|k| factors[*k].categories.is_empty() && !factors[*k].random).collect();
        if !(1..=SOBOL_DIMENSIONS).contains(&varied.len()) {
            return Err(format!("{} parameters, expected 1 to {SOBOL_DIMENSIONS}", varied.len()));
        }
        if let Some(factor) = factors.iter().find(|f| !f.categories.is_empty()) {
            return Err(format!("{} has categories", factor.name));
        }
        let fit = |q: usize| fitted(factors, &varied, points, &results[q], q, targets);
        let fits: Vec<Fitted<'_>> = (0..results.len()).filter_map(fit).collect();
        let has = |t: &&Target| fits.iter().all(|f| f.target.is_none_or(|own| own.quantity != t.quantity));
        if let Some(target) = targets.iter().find(has) {
            let name = &results[target.quantity].name;
            return Err(format!("{name} is constant, or has fewer than {} values", varied.len() + 4));
        }
        let sampled = sample(&fits, varied.len());
        let effective = effective(&sampled.weights);
        let marginal = |(d, k): (usize, &usize)| marginal(&factors[*k], &sampled, d);
        Ok(Posterior {
            parameters: varied.iter().enumerate().map(marginal).collect(),
            predictions: fits.iter().map(|fit| predict(fit, &sampled, varied.len())).collect(),
            correlations: correlations(factors, &varied, &sampled),
            missed: missed(&fits, &sampled),
            effective,
        })
    }

    /// Returns the table of the parameters.
    pub fn parameter_table(&self) -> Table {
        let heads = [
            "parameter",
            "range",
            "5 %",
            "median",
            "95 %",
            "deviation over prior's",
            "determined by targets",
        ];
        let row = |m: &Marginal| {
            let range = m.range.map(super::layout::four_digits).join(" – ");
            let known = match (self.is_reliable(), m.is_undetermined()) {
                (false, _) => "–",
                (true, true) => "no",
                (true, false) => "yes",
            };
            let mut row = vec![Cell::text(&m.parameter), Cell::Text(range)];
            row.extend([m.band[0], m.median, m.band[1], m.deviation].map(|v| Cell::Number(v, None)));
            row.push(Cell::text(known));
            row
        };
        Table { heads: heads.map(String::from).to_vec(), rows: self.parameters.iter().map(row).collect() }
    }

    /// Returns the table of the quantities.
    pub fn prediction_table(&self) -> Table {
        let heads = [
            "quantity of one specimen",
            "target",
            "5 %",
            "median",
            "95 %",
            "5 % of the prior",
            "95 % of the prior",
            "explained by the emulator",
        ];
        let row = |p: &Prediction| {
            let mut row = vec![Cell::text(&p.quantity), Cell::number(p.target)];
            let numbers = [p.band[0], p.median, p.band[1], p.prior[0], p.prior[1], p.explained];
            row.extend(numbers.map(|v| Cell::Number(v, None)));
            row
        };
        Table { heads: heads.map(String::from).to_vec(), rows: self.predictions.iter().map(row).collect() }
    }

    /// Whether the targets are reached by enough points.
    pub fn is_reliable(&self) -> bool {
        self.missed.is_empty() && self.effective >= FEWEST
    }

    /// Returns notes on undetermined and correlated parameters.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        for (quantity, off) in &self.missed {
            notes.push(format!(
                "target of {quantity} not reached within the ranges: {off:.1} times tolerance and scatter off. The parameters are not determined"
            ));
        }
        if self.missed.is_empty() && self.effective < FEWEST {
            notes.push(format!(
                "only {:.0} effective points: the parameters are not determined",
                self.effective
            ));
        }
        let free: Vec<&str> =
            self.parameters.iter().filter(|m| m.is_undetermined()).map(|m| m.parameter.as_str()).collect();
        if self.is_reliable() && !free.is_empty() {
            notes.push(format!("not determined by the targets: {}", free.join(", ")));
        }
        let pair = |(a, b, r): &(String, String, f64)| format!("{a} and {b} {r:.2}");
        if self.is_reliable() && !self.correlations.is_empty() {
            let pairs: Vec<String> = self.correlations.iter().map(pair).collect();
            notes.push(format!("correlated, so determined only together: {}", pairs.join(", ")));
        }
        let poor: Vec<&str> =
            self.predictions.iter().filter(|p| p.explained < 0.5).map(|p| p.quantity.as_str()).collect();
        if !poor.is_empty() {
            notes
                .push(format!("the emulator explains less than half of the variance of {}", poor.join(", ")));
        }
        notes
    }
}

/// Value in the unit interval of the range.
fn unit(factor: &Factor, value: f64) -> f64 {
    let [low, high] = factor.range.map(|v| factor.regressor(v));
    (factor.regressor(value) - low) / (high - low)
}

fn of_unit(factor: &Factor, u: f64) -> f64 {
    let [low, high] = factor.range;
    if factor.log { low * libm::pow(high / low, u) } else { low + u * (high - low) }
}

fn fitted<'a>(
    factors: &[Factor],
    varied: &[usize],
    points: &[Point],
    column: &'a Column,
    index: usize,
    targets: &'a [Target],
) -> Option<Fitted<'a>> {
    let place = |p: &Point| -> Option<Vec<f64>> {
        varied.iter().map(|k| p.values[*k].map(|v| unit(&factors[*k], v))).collect()
    };
    let known = points.iter().filter_map(|p| Some((place(p)?, p.results[index][0]?)));
    let (places, values): (Vec<Vec<f64>>, Vec<f64>) = known.unzip();
    let emulator = Emulator::fit(&places, &values)?;
    let deviations = points.iter().filter_map(|p| {
        let [mean, deviation, _] = p.results[index];
        Some(emulator.fitted_deviation(mean?, deviation?)?.powi(2))
    });
    let squares: Vec<f64> = deviations.collect();
    let scatter = match squares.len() {
        0 => emulator.noise * emulator.noise,
        n => squares.iter().sum::<f64>() / n as f64,
    };
    let target = targets.iter().find(|t| t.quantity == index);
    Some(Fitted { column, target, emulator, scatter })
}

/// Deviation from the target and variance without the target's, in units of the quantity.
fn deviation(fit: &Fitted<'_>, target: &Target, x: &[f64]) -> [f64; 2] {
    let [mean, deviation] = fit.emulator.at(x);
    let variance = fit.emulator.variance(mean, fit.scatter + deviation * deviation);
    [target.value - fit.emulator.value(mean), variance]
}

/// Logarithm of the likelihood at `x`.
fn likelihood(fits: &[Fitted<'_>], x: &[f64]) -> f64 {
    let one = |fit: &Fitted<'_>| {
        let target = fit.target?;
        let [off, own] = deviation(fit, target, x);
        let variance = target.tolerance * target.tolerance + own;
        Some(-0.5 * (off * off / variance + libm::log(variance)))
    };
    fits.iter().filter_map(one).sum()
}

/// Targets that the posterior misses, with the median of their deviation in tolerances and scatter.
fn missed(fits: &[Fitted<'_>], sampled: &Sampled) -> Vec<(String, f64)> {
    let one = |fit: &Fitted<'_>| {
        let target = fit.target?;
        let off = |x: &Vec<f64>| {
            let [mean, _] = fit.emulator.at(x);
            let scatter = fit.emulator.variance(mean, fit.scatter);
            let variance = target.tolerance * target.tolerance + scatter;
            (target.value - fit.emulator.value(mean)).abs() / variance.sqrt()
        };
        let all: Vec<f64> = sampled.points.iter().map(off).collect();
        let median = quantile(&all, &sampled.weights, 0.5);
        (median > MISSED).then(|| (fit.column.head(), median))
    };
    fits.iter().filter_map(one).collect()
}

/// Points of the prior with weights, again in the box of most weight until enough of them count.
fn sample(fits: &[Fitted<'_>], dimensions: usize) -> Sampled {
    let mut region = vec![[0.0, 1.0]; dimensions];
    let mut sampled = Sampled { points: Vec::new(), weights: Vec::new() };
    for round in 0..ROUNDS {
        let place = |p: Vec<f64>| p.iter().zip(&region).map(|(u, [a, b])| a + u * (b - a)).collect();
        sampled.points = sobol(POINTS, dimensions, Some(1 + round as u64)).into_iter().map(place).collect();
        let all: Vec<f64> = sampled.points.iter().map(|x| likelihood(fits, x)).collect();
        let largest = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        sampled.weights = all.iter().map(|l| libm::exp(l - largest)).collect();
        if effective(&sampled.weights) > ENOUGH {
            break;
        }
        for (d, side) in region.iter_mut().enumerate() {
            let column: Vec<f64> = sampled.points.iter().map(|p| p[d]).collect();
            let width = 0.1 * (side[1] - side[0]);
            let ends = [OUTSIDE, 1.0 - OUTSIDE].map(|q| quantile(&column, &sampled.weights, q));
            *side = [(ends[0] - width).max(side[0]), (ends[1] + width).min(side[1])];
        }
    }
    sampled
}

fn effective(weights: &[f64]) -> f64 {
    let sum: f64 = weights.iter().sum();
    let squares: f64 = weights.iter().map(|w| w * w).sum();
    if squares > 0.0 { sum * sum / squares } else { 0.0 }
}

fn quantile(values: &[f64], weights: &[f64], share: f64) -> f64 {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let limit = share * weights.iter().sum::<f64>();
    let mut sum = 0.0;
    for k in &order {
        sum += weights[*k];
        if sum >= limit {
            return values[*k];
        }
    }
    order.last().map_or(f64::NAN, |k| values[*k])
}

fn moments(values: &[f64], weights: &[f64]) -> [f64; 2] {
    let sum: f64 = weights.iter().sum();
    let mean = values.iter().zip(weights).map(|(v, w)| v * w).sum::<f64>() / sum;
    let square = values.iter().zip(weights).map(|(v, w)| (v - mean) * (v - mean) * w).sum::<f64>() / sum;
    [mean, square.sqrt()]
}

fn marginal(factor: &Factor, sampled: &Sampled, dimension: usize) -> Marginal {
    let column: Vec<f64> = sampled.points.iter().map(|p| p[dimension]).collect();
    let at = |share: f64| of_unit(factor, quantile(&column, &sampled.weights, share));
    let uniform = (1.0_f64 / 12.0).sqrt();
    Marginal {
        parameter: factor.head(),
        range: factor.range,
        median: at(0.5),
        band: BAND.map(at),
        deviation: moments(&column, &sampled.weights)[1] / uniform,
    }
}

fn correlations(factors: &[Factor], varied: &[usize], sampled: &Sampled) -> Vec<(String, String, f64)> {
    let column = |d: usize| sampled.points.iter().map(|p| p[d]).collect::<Vec<f64>>();
    let pair = |a: usize, b: usize| {
        let (x, y) = (column(a), column(b));
        let ([mx, sx], [my, sy]) = (moments(&x, &sampled.weights), moments(&y, &sampled.weights));
        let product: Vec<f64> = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my) / (sx * sy)).collect();
        moments(&product, &sampled.weights)[0]
    };
    let pairs = (0..varied.len()).flat_map(|a| (a + 1..varied.len()).map(move |b| (a, b)));
    pairs
        .map(|(a, b)| (factors[varied[a]].head(), factors[varied[b]].head(), pair(a, b)))
        .filter(|(_, _, r)| r.abs() > CORRELATED)
        .collect()
}

/// Normal deviates of equal probability stand for scatter and uncertainty at each point.
fn predict(fit: &Fitted<'_>, sampled: &Sampled, dimensions: usize) -> Prediction {
    const DEVIATES: [f64; 5] = [-1.2816, -0.5244, 0.0, 0.5244, 1.2816];
    // The standard deviation of the five deviates.
    const THEIRS: f64 = 0.8756;
    let all = |points: &[Vec<f64>], weights: &[f64]| -> (Vec<f64>, Vec<f64>) {
        let spread = points.iter().zip(weights).flat_map(|(x, w)| {
            let [mean, deviation] = fit.emulator.at(x);
            let spread = (fit.scatter + deviation * deviation).sqrt() / THEIRS;
            DEVIATES.map(|z| (fit.emulator.value(mean + z * spread), *w))
        });
        spread.unzip()
    };
    let prior = sobol(POINTS / 8, dimensions, Some(1));
    let (before, equal) = all(&prior, &vec![1.0; prior.len()]);
    let (values, weights) = all(&sampled.points, &sampled.weights);
    Prediction {
        quantity: fit.column.head(),
        target: fit.target.map(|t| t.value),
        median: quantile(&values, &weights, 0.5),
        band: BAND.map(|share| quantile(&values, &weights, share)),
        prior: BAND.map(|share| quantile(&before, &equal, share)),
        explained: fit.emulator.explained,
    }
}

#[cfg(test)]
#[path = "posterior_tests.rs"]
mod tests;
