//! Responses, sensitivities and misfits of a study.

use super::factor::Factor;
use super::file::Combine;
use super::hazard::CaseMaps;
use super::outcome::Outcome;
use super::plan::Plan;
use super::point::{Column, Point};
use super::posterior::Posterior;
use super::statistics::{Regression, rank_correlation};
use super::target::{Target, misfit};
use serde::{Deserialize, Serialize};

/// Result of the analysis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Analysis {
    /// Varied parameters.
    pub factors: Vec<Factor>,
    /// Quantities.
    pub results: Vec<Column>,
    /// Targets.
    pub targets: Vec<Target>,
    /// Cases in plan order.
    pub points: Vec<Point>,
    /// Sensitivity of each quantity.
    pub sensitivities: Vec<Sensitivity>,
    /// Cases by misfit, smallest first.
    pub best: Vec<usize>,
    /// Label and reason of runs without results.
    pub failed: Vec<String>,
    /// Whether the parameters are sampled.
    pub sampled: bool,
    /// Hazard maps of cases.
    #[serde(default)]
    pub hazard: Vec<CaseMaps>,
    /// Posterior of sampled parameters with targets.
    #[serde(default)]
    pub posterior: Option<Posterior>,
    /// Reason of a missing posterior.
    #[serde(default)]
    pub without_posterior: Option<String>,
}

/// Sensitivity of a quantity to the parameters.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sensitivity {
    /// Result at the base case, or at the middle of all ranges.
    pub centre: Option<f64>,
    /// Linear regression on all parameters.
    pub regression: Option<Regression>,
    /// Rank correlation by parameter.
    pub rank_correlations: Vec<Option<f64>>,
    /// Result against each parameter with the others constant or averaged.
    pub responses: Vec<Vec<[f64; 2]>>,
}

impl Sensitivity {
    /// Returns value and result at both ends of parameter `index`.
    pub fn ends(&self, index: usize, factor: &Factor) -> Option<[[f64; 2]; 2]> {
        let is_finite = |line: &[[f64; 2]]| line.as_flattened().iter().all(|v| v.is_finite());
        let line = self.responses.get(index).filter(|line| line.len() > 1 && is_finite(line))?;
        let by = |p: &&[f64; 2], q: &&[f64; 2]| {
            let axis = usize::from(!factor.categories.is_empty());
            p[axis].total_cmp(&q[axis])
        };
        Some([*line.iter().min_by(by)?, *line.iter().max_by(by)?])
    }

    /// Returns the change of the result between both ends of parameter `index`.
    pub fn effect(&self, index: usize, factor: &Factor) -> Option<f64> {
        self.ends(index, factor).map(|[low, high]| high[1] - low[1])
    }
}

impl Analysis {
    /// Analyses the outcome of a plan.
    pub fn of(plan: &Plan, outcome: &Outcome) -> Analysis {
        let results: Vec<Column> = plan
            .quantities
            .iter()
            .zip(&outcome.units)
            .map(|(q, unit)| Column { name: q.name.clone(), unit: unit.clone() })
            .collect();
        let point = |(k, row): (usize, &super::outcome::Row)| {
            let cells = &row.quantities;
            let values: Vec<Option<f64>> = cells.iter().map(|c| c.value).collect();
            Point {
                case: row.case.clone(),
                values: plan.coordinates[k].clone(),
                runs: row.runs,
                done: row.done,
                misfit: misfit(&plan.targets, &values),
                results: cells.iter().map(|c| [c.value, c.standard_deviation, c.standard_error]).collect(),
            }
        };
        let points: Vec<Point> = outcome.rows.iter().enumerate().map(point).collect();
        let sensitivities =
            (0..results.len()).map(|q| sensitivity(&plan.factors, plan.combine, &points, q)).collect();
        let mut best: Vec<usize> = (0..points.len()).filter(|k| points[*k].misfit.is_some()).collect();
        best.sort_by(|a, b| {
            points[*a].misfit.partial_cmp(&points[*b].misfit).unwrap_or(std::cmp::Ordering::Equal)
        });
        let sampled = plan.combine.is_none();
        let wanted = sampled && !plan.targets.is_empty();
        let posterior = wanted.then(|| Posterior::of(&plan.factors, &points, &results, &plan.targets));
        let (posterior, without_posterior) = match posterior {
            None => (None, None),
            Some(Ok(posterior)) => (Some(posterior), None),
            Some(Err(reason)) => (None, Some(reason)),
        };
        Analysis {
            factors: plan.factors.clone(),
            targets: plan.targets.clone(),
            failed: outcome.rows.iter().flat_map(|row| row.reasons.iter().cloned()).collect(),
            sampled,
            results,
            points,
            sensitivities,
            best,
            hazard: Vec::new(),
            posterior,
            without_posterior,
        }
    }
}

/// `combine`: none for sampled parameters.
fn sensitivity(
    factors: &[Factor],
    combine: Option<Combine>,
    points: &[Point],
    quantity: usize,
) -> Sensitivity {
    let known = points.iter().filter_map(|p| Some((p.complete()?, p.results[quantity][0]?)));
    let (values, results): (Vec<Vec<f64>>, Vec<f64>) = known.unzip();
    let column = |j: usize| values.iter().map(|v| factors[j].regressor(v[j])).collect::<Vec<f64>>();
    let columns: Vec<Vec<f64>> = (0..factors.len()).map(column).collect();
    let numbers: Vec<bool> = factors.iter().map(|f| f.categories.is_empty()).collect();
    // Every category has all samples, hence no part in the slopes.
    let fits = combine.is_none() || numbers.iter().all(|n| *n);
    let regression = fits.then(|| Regression::fit_some(&columns, &numbers, &results)).flatten();
    let ranked = !matches!(combine, Some(Combine::OneAtATime | Combine::List)) || factors.len() == 1;
    let rank = |j: usize| rank_correlation(&columns[j], &results);
    let rank_correlations =
        (0..factors.len()).map(|j| (ranked && factors[j].categories.is_empty()).then(|| rank(j)).flatten());
    let base = points.iter().find_map(Point::complete);
    let (centre, responses) = match (combine, &regression) {
        (None, None) => (None, vec![Vec::new(); factors.len()]),
        (None, Some(fit)) => {
            let (centre, mut lines) = fitted(factors, fit);
            for j in (0..factors.len()).filter(|j| !numbers[*j]) {
                lines[j] = level_means(&values, &results, j, |_| true);
            }
            (centre, lines)
        }
        // Axes that vary together have no separate effects.
        (Some(Combine::List), _) if factors.len() > 1 => (None, vec![Vec::new(); factors.len()]),
        (Some(Combine::OneAtATime), _) => {
            let base = base.unwrap_or_default();
            let differs = |v: &Vec<f64>, j: usize| (0..v.len()).any(|k| k != j && v[k] != base[k]);
            let line = |j: usize| level_means(&values, &results, j, |v| !differs(v, j));
            let centre = values.iter().position(|v| *v == base).map(|k| results[k]);
            (centre, (0..factors.len()).map(line).collect())
        }
        (Some(_), _) => {
            let mean = results.iter().sum::<f64>() / results.len().max(1) as f64;
            let line = |j: usize| level_means(&values, &results, j, |_| true);
            ((!results.is_empty()).then_some(mean), (0..factors.len()).map(line).collect())
        }
    };
    Sensitivity { centre, rank_correlations: rank_correlations.collect(), regression, responses }
}

/// Lines of the fit with the other parameters in the middle of their ranges.
fn fitted(factors: &[Factor], fit: &Regression) -> (Option<f64>, Vec<Vec<[f64; 2]>>) {
    let ends: Vec<[f64; 2]> = factors.iter().map(|f| f.range.map(|v| f.regressor(v))).collect();
    let middle: Vec<f64> = ends.iter().map(|e| 0.5 * (e[0] + e[1])).collect();
    let line = |j: usize| {
        let end = |k: usize| {
            let mut x = middle.clone();
            x[j] = ends[j][k];
            [factors[j].range[k], fit.at(&x)]
        };
        vec![end(0), end(1)]
    };
    (Some(fit.at(&middle)), (0..factors.len()).map(line).collect())
}

/// Mean result at each level of parameter `j` over the accepted cases, by ascending level.
fn level_means(
    values: &[Vec<f64>],
    results: &[f64],
    j: usize,
    accepted: impl Fn(&Vec<f64>) -> bool,
) -> Vec<[f64; 2]> {
    let mut pairs: Vec<[f64; 2]> =
        values.iter().zip(results).filter(|(v, _)| accepted(v)).map(|(v, y)| [v[j], *y]).collect();
    pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mean = |group: &[[f64; 2]]| group.iter().map(|p| p[1]).sum::<f64>() / group.len() as f64;
    pairs.chunk_by(|a, b| a[0] == b[0]).map(|group| [group[0][0], mean(group)]).collect()
}

#[cfg(test)]
#[path = "analysis_tests.rs"]
mod tests;
