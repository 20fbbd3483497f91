//! Error and cost of each parameter set.

use super::axis::Setting;
use super::curve::{self, Sample};
use super::extreme::{Extreme, ExtremeRow};
use super::file::Norm;
use super::plan::{Plan, Run};
use super::quantity::Quantity;
use super::sample;
use super::store::{Found, Record, Store};
use super::table::head;
use serde::Serialize;

/// Mean cost of a set's runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// CPU time, all threads [s].
    pub cpu_seconds: Option<f64>,
    /// Wall time with concurrent runs [s].
    pub wall_seconds: f64,
    /// DEM and FEM steps of all stages.
    pub steps: f64,
    /// Peak resident memory of any run [bytes].
    pub peak_memory: Option<u64>,
}

/// Quantity of a set.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Cell {
    /// Mean over seeds; RMS of a curve.
    pub value: Option<f64>,
    /// Standard deviation over seeds.
    pub standard_deviation: Option<f64>,
    /// Standard error of the value over seeds.
    pub standard_error: Option<f64>,
    /// Error against reference or exact value.
    pub error: Option<f64>,
    /// Standard error of the error over seeds.
    pub error_standard_error: Option<f64>,
    /// Whether the error exceeds its standard error.
    pub significant: bool,
    /// Reason for missing data.
    pub remark: Option<String>,
}

/// Parameter set with results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Label.
    pub case: String,
    /// Axis value labels.
    pub levels: Vec<String>,
    /// Overrides.
    pub set: Vec<String>,
    /// Planned runs.
    pub runs: usize,
    /// Completed runs.
    pub done: usize,
    /// Reasons of incomplete runs.
    pub reasons: Vec<String>,
    /// Costs; none without completed runs.
    pub cost: Option<Cost>,
    /// CPU time, reference over set.
    pub speed_up: Option<f64>,
    /// Quantities.
    pub quantities: Vec<Cell>,
    /// Largest error over tolerance.
    pub error_over_tolerance: Option<f64>,
    /// Whether all errors are within tolerance.
    pub within: bool,
}

/// Results of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Sets in plan order.
    pub rows: Vec<Row>,
    /// Units.
    pub units: Vec<String>,
    /// Reference index.
    pub reference: usize,
    /// Cheapest set within tolerance.
    pub recommended: Option<usize>,
    /// Pareto front, cheapest first.
    pub front: Vec<usize>,
    /// Values of return periods.
    pub extremes: Vec<ExtremeRow>,
}

struct Gathered {
    samples: Vec<Vec<Sample>>,
    means: Vec<Option<Sample>>,
    row: Row,
}

impl Outcome {
    /// Evaluates a study directory; `found`: one entry per run.
    pub fn of(plan: &Plan, store: &Store, found: &[Found]) -> Outcome {
        let mut units = vec![String::new(); plan.quantities.len()];
        let gathered: Vec<Gathered> =
            (0..plan.settings.len()).map(|k| gather(plan, store, found, k, &mut units)).collect();
        let reference = &gathered[plan.reference];
        let cells: Vec<Vec<Cell>> = gathered
            .iter()
            .map(|g| (0..plan.quantities.len()).map(|q| cell(plan, q, g, reference)).collect())
            .collect();
        let extremes = extremes(plan, &gathered, &units);
        let base = reference.row.cost.as_ref().and_then(|c| c.cpu_seconds);
        let mut rows: Vec<Row> = gathered.into_iter().map(|g| g.row).collect();
        for (row, cells) in rows.iter_mut().zip(cells) {
            let own = row.cost.as_ref().and_then(|c| c.cpu_seconds);
            row.speed_up = base
                .filter(|_| plan.has_reference())
                .zip(own)
                .filter(|(_, own)| *own > 0.0)
                .map(|(base, own)| base / own);
            let over = cells.iter().zip(&plan.quantities).map(|(c, q)| Some(c.error? / q.tolerance));
            row.error_over_tolerance =
                over.collect::<Option<Vec<f64>>>().map(|all| all.into_iter().fold(0.0, f64::max));
            let good = |c: &Cell, q: &Quantity| {
                c.error.is_some_and(|e| e + c.error_standard_error.unwrap_or(0.0) <= q.tolerance)
            };
            row.within = plan.has_reference()
                && row.done == row.runs
                && cells.iter().zip(&plan.quantities).all(|(c, q)| good(c, q));
            row.quantities = cells;
        }
        let recommended = cheapest(&rows);
        let front = front(&rows);
        Outcome { rows, units, reference: plan.reference, recommended, front, extremes }
    }
}

fn extremes(plan: &Plan, gathered: &[Gathered], units: &[String]) -> Vec<ExtremeRow> {
    let row = |g: &Gathered, extreme: &Extreme| {
        let k = extreme.quantity;
        extreme.row(&g.row.case, head(&plan.quantities[k], &units[k]), &g.samples[k])
    };
    gathered.iter().flat_map(|g| plan.extremes.iter().map(move |extreme| row(g, extreme))).collect()
}

/// Returns the mean CPU time [s].
pub fn cpu(row: &Row) -> Option<f64> {
    row.cost.as_ref().and_then(|c| c.cpu_seconds)
}

fn cheapest(rows: &[Row]) -> Option<usize> {
    let within = (0..rows.len()).filter(|k| rows[*k].within && cpu(&rows[*k]).is_some());
    within.min_by(|a, b| cpu(&rows[*a]).partial_cmp(&cpu(&rows[*b])).unwrap_or(std::cmp::Ordering::Equal))
}

fn front(rows: &[Row]) -> Vec<usize> {
    let place = |k: usize| Some((k, cpu(&rows[k])?, rows[k].error_over_tolerance?));
    let mut all: Vec<(usize, f64, f64)> = (0..rows.len()).filter_map(place).collect();
    all.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2)));
    let mut least = f64::INFINITY;
    let mut front = Vec::new();
    for (k, _, error) in all {
        if error < least {
            least = error;
            front.push(k);
        }
    }
    front
}

fn gather(plan: &Plan, store: &Store, found: &[Found], setting: usize, units: &mut [String]) -> Gathered {
    let mut samples: Vec<Vec<Sample>> = vec![Vec::new(); plan.quantities.len()];
    let mut remarks: Vec<Option<String>> = vec![None; plan.quantities.len()];
    let (mut costs, mut reasons, mut count) = (Vec::new(), Vec::new(), 0);
    for (run, found) in plan.runs.iter().zip(found).filter(|(run, _)| run.setting == setting) {
        count += 1;
        match found {
            Found::Done(record, summary) => {
                costs.push(cost_of(record, summary));
                for (k, quantity) in plan.quantities.iter().enumerate() {
                    match sample::read(quantity, &store.results(run)) {
                        Ok((sample, unit)) => {
                            samples[k].push(sample);
                            units[k] = unit;
                        }
                        Err(fault) => remarks[k] = Some(fault),
                    }
                }
            }
            other => reasons.push(format!("{}: {}", run.label, why(other))),
        }
    }
    // A mean over some seeds would mislead.
    let mean = |(samples, remark): (&Vec<Sample>, &Option<String>)| match remark {
        None => curve::mean(samples),
        Some(_) => None,
    };
    let means = samples.iter().zip(&remarks).map(mean).collect();
    let Setting { label, levels, set } = plan.settings[setting].clone();
    let row = Row {
        case: label,
        levels,
        set,
        runs: count,
        done: costs.len(),
        reasons,
        cost: mean_cost(&costs),
        speed_up: None,
        quantities: remarks.into_iter().map(|remark| Cell { remark, ..Cell::default() }).collect(),
        error_over_tolerance: None,
        within: false,
    };
    Gathered { samples, means, row }
}

/// Returns the reason for missing results.
pub fn why(found: &Found) -> String {
    match found {
        Found::Nothing => "missing".into(),
        Found::Done(..) => "done".into(),
        Found::Unfinished(record, _) | Found::Failed(record) => match record.exit_code {
            None => "not finished".into(),
            Some(130) => "interrupted".into(),
            Some(0) => "scene changed during the study".into(),
            Some(code) => format!("failed, exit code {code}: {}", record.message),
        },
    }
}

fn cost_of(record: &Record, summary: &serde_json::Value) -> Cost {
    let stages = summary["stages"].as_array().into_iter().flatten();
    let steps = stages.flat_map(|s| [s["grain_steps"].as_f64(), s["solid_steps"].as_f64()]);
    Cost {
        cpu_seconds: record.cpu_seconds,
        wall_seconds: record.wall_seconds,
        steps: steps.flatten().sum(),
        peak_memory: summary["peak_memory"].as_u64(),
    }
}

fn mean_cost(costs: &[Cost]) -> Option<Cost> {
    let count = costs.len() as f64;
    let mean = |of: &dyn Fn(&Cost) -> Option<f64>| Some(costs.iter().map(of).sum::<Option<f64>>()? / count);
    (!costs.is_empty()).then(|| Cost {
        cpu_seconds: mean(&|c| c.cpu_seconds),
        wall_seconds: mean(&|c| Some(c.wall_seconds)).unwrap_or(0.0),
        steps: mean(&|c| Some(c.steps)).unwrap_or(0.0),
        peak_memory: costs.iter().filter_map(|c| c.peak_memory).max(),
    })
}

fn cell(plan: &Plan, index: usize, own: &Gathered, reference: &Gathered) -> Cell {
    let quantity = &plan.quantities[index];
    let remark = own.row.quantities[index].remark.clone();
    let Some(mean) = &own.means[index] else { return Cell { remark, ..Cell::default() } };
    let standard_deviation = curve::deviation(&own.samples[index], mean);
    let standard_error = standard_deviation.map(|d| d / (own.samples[index].len() as f64).sqrt());
    let cell =
        Cell { value: Some(mean.shown()), standard_deviation, standard_error, remark, ..Cell::default() };
    if !plan.has_reference() {
        return cell;
    }
    let is_reference = std::ptr::eq(own, reference);
    let variance = |of: &Gathered| {
        let deviation = of.means[index].as_ref().and_then(|mean| curve::deviation(&of.samples[index], mean));
        deviation.map(|d| d * d / of.samples[index].len() as f64)
    };
    let (against, theirs) = match quantity.exact {
        Some(exact) => (Sample::Number(exact), Some(0.0)),
        None => match &reference.means[index] {
            Some(mean) => (mean.clone(), if is_reference { Some(0.0) } else { variance(reference) }),
            None => return Cell { remark: Some("no value in the reference".into()), ..cell },
        },
    };
    let Some((difference, size)) = curve::difference(mean, &against) else {
        return Cell { remark: Some("no abscissa in common with the reference".into()), ..cell };
    };
    let unit = match (quantity.norm, quantity.scale) {
        (Norm::Absolute, _) => 1.0,
        (Norm::Relative, Some(scale)) => scale,
        (Norm::Relative, None) => size,
    };
    if unit == 0.0 {
        let remark = "reference value 0: set `scale`, or norm = \"absolute\"";
        return Cell { remark: Some(remark.into()), ..cell };
    }
    let error = difference / unit;
    let error_standard_error = variance(own).zip(theirs).map(|(own, theirs)| (own + theirs).sqrt() / unit);
    let significant = is_reference || error_standard_error.is_none_or(|s| error >= s);
    Cell { error: Some(error), error_standard_error, significant, ..cell }
}

/// Returns runs not yet completed.
pub fn missing<'a>(plan: &'a Plan, found: &[Found]) -> Vec<&'a Run> {
    let missing = |found: &Found| matches!(found, Found::Nothing | Found::Unfinished(..));
    plan.runs.iter().zip(found).filter(|(_, found)| missing(found)).map(|(run, _)| run).collect()
}
