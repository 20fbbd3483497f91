//! Results of the runs: settlement, stiffness and lateral resistance over traffic.

use super::chain::Chain;
use super::plan::Plan;
use serde::{Deserialize, Serialize};
use trackbed_io::columns::{cycles, history};
use trackbed_io::failure::Failure;
use trackbed_report::RunData;
use trackbed_track::extrapolation::Forecast;
use trackbed_track::settlement;

/// Period of traffic of one packing.
#[derive(Clone, Debug, Serialize)]
pub struct Period {
    /// Number of the packing, from 1.
    pub packing: usize,
    /// Number of the period, from 1.
    pub period: usize,
    /// Load cycles.
    pub cycles: u32,
    /// Simulated load cycles.
    pub simulated: u32,
    /// Settlement [m].
    pub settlement: f64,
    /// Lowering from the end of the run before to the first cycle [m].
    pub before_cycles: f64,
    /// Settlement after the cycles before the first jump [m].
    pub before_jumps: Option<f64>,
    /// Cycles before the first jump.
    #[serde(skip)]
    pub first: Option<f64>,
    /// Estimated error of cycle jumps [m].
    pub jump_error: f64,
    /// Forecasts of the last simulated cycle from earlier ones.
    pub forecasts: Vec<Forecast>,
    /// Jumps delayed by changes.
    pub delays: usize,
    /// Bed stiffness after the last cycle [N/m]; 0 if not reached.
    pub bed_stiffness: f64,
    /// CPU time [s].
    pub cpu_seconds: f64,
    /// Peak memory [B].
    pub peak_memory: f64,
    /// Cycle and settlement [m].
    #[serde(skip)]
    pub rows: Vec<[f64; 2]>,
}

/// Tamping of one packing.
#[derive(Clone, Debug, Serialize)]
pub struct Tamped {
    /// Number of the packing, from 1.
    pub packing: usize,
    /// Number of the tamping, from 1.
    pub tamping: usize,
    /// Mean rise of the sleepers, after a rest [m].
    pub raised: f64,
    /// Largest force of a blade entering and closing [N]; none without tines.
    pub forces: Option<[f64; 2]>,
    /// Porosity of the measured box before the first and after the last stage.
    pub porosity: [f64; 2],
    /// CPU time [s].
    pub cpu_seconds: f64,
}

/// Lateral resistance of one packing.
#[derive(Clone, Debug, Serialize)]
pub struct Resistance {
    /// Number of the packing, from 1.
    pub packing: usize,
    /// Run after which it is measured.
    pub after: String,
    /// Traffic so far [MGT].
    pub traffic: f64,
    /// Force at 2 mm [N]; none if not reached.
    pub force: Option<f64>,
}

/// Law fitted before the first jump, extrapolated to the end of the first period.
#[derive(Clone, Debug, Serialize)]
pub struct LawAlone {
    /// Law.
    pub law: String,
    /// Extrapolated settlement, mean of the packings [m].
    pub settlement: f64,
    /// Over the settlement of the runs.
    pub ratio: f64,
}

/// Judgement of the jumps of a period.
#[derive(Clone, Debug, Serialize)]
pub struct Agreement {
    /// Number of the period, from 1.
    pub period: usize,
    /// Difference of the packings in settlement during jumps, over its mean.
    pub difference: f64,
    /// Whether within the tolerance.
    pub agreed: bool,
    /// Repetitions with shorter jumps.
    pub repetitions: u32,
}

/// Reads a period.
///
/// # Errors
/// Missing results.
pub fn period(
    chain: &Chain<'_>,
    packing: usize,
    (period, name, before): (usize, &str, &str),
) -> Result<Period, Failure> {
    let dir = chain.folder(packing, name);
    let run = RunData::read(&dir)?;
    let rows = run.table("cycles").and_then(|t| t.points(cycles::CYCLE, cycles::SETTLEMENT));
    let Some(last) = rows.as_ref().and_then(|rows| rows.last()).copied() else {
        return Err(Failure::Other(format!("{}: no load cycles in cycles.csv", dir.display())));
    };
    let rows = rows.unwrap_or_default();
    let jumped = f64::from(rows.len() as u32) < last[0];
    let first = chain.plan.jump.map(|(first, _)| f64::from(first)).filter(|_| jumped);
    let earlier = heights(&RunData::read(&chain.folder(packing, before))?, None)?;
    let load = run.scene.as_ref().and_then(|scene| scene.track.as_ref()?.load.as_ref());
    let start = load.map_or(0.0, |load| {
        let seating = load.seating.as_ref();
        load.rest.si + load.ramp.si + seating.map_or(0.0, |s| f64::from(s.cycles) / s.frequency.si)
    });
    let at = |n: f64| rows.iter().rev().find(|row| row[0] <= n).map(|row| row[1]);
    let stiffness = run.table("cycles").and_then(|t| t.points(cycles::CYCLE, cycles::BED_STIFFNESS));
    Ok(Period {
        packing: packing + 1,
        period: period + 1,
        cycles: last[0] as u32,
        simulated: rows.len() as u32,
        settlement: last[1],
        before_cycles: earlier - heights(&run, Some(start))?,
        before_jumps: first.and_then(at),
        first,
        jump_error: run.number("settlement.jump.error_estimate").unwrap_or(0.0),
        forecasts: run
            .list("settlement.jump.forecasts")
            .iter()
            .filter_map(|f| Forecast::deserialize(f).ok())
            .collect(),
        delays: run.list("settlement.jump.delays").len(),
        bed_stiffness: stiffness.and_then(|s| s.last().map(|p| p[1])).unwrap_or(0.0),
        cpu_seconds: run.number("cpu_seconds").unwrap_or(0.0),
        peak_memory: run.number("peak_memory").unwrap_or(0.0),
        rows,
    })
}

/// Reads a tamping.
///
/// # Errors
/// Missing results.
pub fn tamped(
    chain: &Chain<'_>,
    packing: usize,
    (tamping, before): (usize, &str),
) -> Result<Tamped, Failure> {
    let dir = chain.folder(packing, &format!("tamped-{}", tamping + 1));
    let run = RunData::read(&dir)?;
    let of = |record: &serde_json::Value, key: &str| record[key].as_f64().unwrap_or(0.0);
    let sleepers = run.list("tamping");
    let earlier = heights(&RunData::read(&chain.folder(packing, before))?, None)?;
    let raised = heights(&run, None)? - earlier;
    let largest = |key: &str| sleepers.iter().map(|s| of(s, key)).fold(0.0, f64::max);
    let stages = run.list("compaction");
    let ends = [stages.first(), stages.last()];
    Ok(Tamped {
        packing: packing + 1,
        tamping: tamping + 1,
        raised,
        forces: (!sleepers.is_empty()).then(|| ["insertion_force", "squeeze_force"].map(largest)),
        porosity: [
            ends[0].map_or(0.0, |s| of(s, "porosity_before")),
            ends[1].map_or(0.0, |s| of(s, "porosity_after")),
        ],
        cpu_seconds: run.number("cpu_seconds").unwrap_or(0.0),
    })
}

/// Mean height of the sleepers [m] at a time, else at the end.
fn heights(run: &RunData, time: Option<f64>) -> Result<f64, Failure> {
    let missing = || Failure::Other(format!("{}: no sleepers in history.csv", run.dir.display()));
    let table = run.table("history").ok_or_else(missing)?;
    let of = |number: &str| table.points(history::TIME, history::SLEEPER.of(number).at(2));
    let all: Vec<Vec<[f64; 2]>> =
        table.items(history::SLEEPER_TILT).into_iter().filter_map(of).filter(|z| !z.is_empty()).collect();
    if all.is_empty() {
        return Err(missing());
    }
    let at = |z: &Vec<[f64; 2]>| {
        let after = z.partition_point(|row| time.is_none_or(|time| row[0] < time));
        match (after.checked_sub(1), z.get(after)) {
            (Some(k), Some(b)) => {
                let (a, time) = (z[k], time.unwrap_or(z[k][0]));
                a[1] + (b[1] - a[1]) * (time - a[0]) / (b[0] - a[0])
            }
            (Some(k), None) => z[k][1],
            (None, _) => z[0][1],
        }
    };
    Ok(all.iter().map(at).sum::<f64>() / all.len() as f64)
}

/// Reads a push.
///
/// # Errors
/// Missing results.
pub fn pushed(chain: &Chain<'_>, packing: usize, after: &str, traffic: f64) -> Result<Resistance, Failure> {
    let run = RunData::read(&chain.folder(packing, &format!("push-{after}")))?;
    let force = run.number("push.resistance_at_2_mm");
    Ok(Resistance { packing: packing + 1, after: after.into(), traffic, force })
}

/// Difference of the packings in the settlement during jumps, over its mean.
pub fn difference(periods: &[Period]) -> f64 {
    let jumped: Vec<f64> = periods.iter().map(|p| p.settlement - p.before_jumps.unwrap_or(0.0)).collect();
    let mean = jumped.iter().sum::<f64>() / jumped.len() as f64;
    let [low, high] = range(jumped.iter().copied());
    if high == low { 0.0 } else { (high - low) / mean.abs() }
}

/// Smallest and largest value.
pub fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)])
}

/// Extrapolates the laws that fit the cycles before the first jump; `periods`: first ones of all packings.
pub fn laws_alone(plan: &Plan, periods: &[Period]) -> Vec<LawAlone> {
    let jumped = periods.iter().any(|p| p.before_jumps.is_some());
    let Some((first, _)) = plan.jump.filter(|_| jumped) else { return Vec::new() };
    let end = f64::from(plan.cycles[0]);
    let mut sums: Vec<(String, f64, usize)> = Vec::new();
    for period in periods {
        let early: Vec<[f64; 2]> =
            period.rows.iter().copied().filter(|row| row[0] <= f64::from(first)).collect();
        for fit in settlement::fits(&early, 1.0) {
            let values: Vec<f64> = fit.parameters.iter().map(|p| p.1).collect();
            let Some(value) = settlement::settlement_after(fit.law, &values, end) else { continue };
            match sums.iter_mut().find(|(law, ..)| law == fit.law) {
                Some((_, sum, count)) => (*sum, *count) = (*sum + value, *count + 1),
                None => sums.push((fit.law.into(), value, 1)),
            }
        }
    }
    let run = periods.iter().map(|p| p.settlement).sum::<f64>() / periods.len().max(1) as f64;
    let all = sums.into_iter().filter(|(.., count)| *count == periods.len());
    all.map(|(law, sum, count)| {
        let settlement = sum / count as f64;
        LawAlone { law, settlement, ratio: settlement / run }
    })
    .collect()
}
