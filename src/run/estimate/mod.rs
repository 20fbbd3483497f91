//! Run time estimate from a trial run, a column of the bed, and some solid steps.

mod clock;
mod column;
mod rehearsal;
mod solid;

use crate::stages::{RUN, SETTLING, longest};
use column::Column;
use rehearsal::{Rehearsal, rehearse};
use serde::Serialize;
use std::time::Duration;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_input::model::Job;
use trackbed_input::model::exchange::Windows;
use trackbed_input::model::grains::{GrainsPart, with_sleepers};
use trackbed_input::model::solid::Analysis;
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;

const SETTLE: u32 = 15;
/// Parallel efficiency of additional cores.
const SPEED_UP: f64 = 0.8;

/// Certainty of a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Known {
    /// Measured.
    Measured,
    /// Extrapolated from measurements.
    Expected,
    /// Upper bound.
    AtMost,
    /// Unknown.
    Unknown,
}

/// Time of a stage.
#[derive(Clone, Debug, Serialize)]
pub struct StageTime {
    /// Stage name, as in the summary.
    pub name: String,
    /// CPU seconds on one thread, else wall time.
    pub seconds: f64,
    /// Certainty.
    pub known: Known,
}

/// Estimated run time by stage.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Stages in order.
    pub stages: Vec<StageTime>,
    /// Number of threads.
    pub threads: usize,
}

impl Estimate {
    /// Estimates the run time of `job` by a trial run of `budget`; takes up to forty times `budget`.
    ///
    /// # Errors
    /// Failures of the trial run; no stable time step.
    pub fn of(
        document: &Document,
        set: &[String],
        job: &Job,
        threads: Option<usize>,
        budget: Duration,
    ) -> Result<Estimate, Failure> {
        let count = threads.unwrap_or_else(rayon::current_num_threads);
        if let Some(stages) = solid::statics(job, count) {
            return Ok(Estimate { stages, threads: count });
        }
        let rehearsed = rehearse(document, set, job, threads, budget)?;
        let stages = if rehearsed.whole { Vec::new() } else { left(job, &rehearsed, count, budget)? };
        let measured = rehearsed.done.into_iter();
        let measured = measured.map(|(name, seconds)| StageTime { name, seconds, known: Known::Measured });
        Ok(Estimate { stages: measured.chain(stages).collect(), threads: count })
    }

    /// Returns the sum of known stage times.
    pub fn seconds(&self) -> f64 {
        self.stages.iter().map(|s| s.seconds).sum()
    }

    /// Formats the estimate.
    pub fn line(&self) -> String {
        let stage = |s: &StageTime| match s.known {
            Known::Measured => format!("{} {}", s.name, duration(s.seconds)),
            Known::Expected => format!("{} about {}", s.name, duration(s.seconds)),
            Known::AtMost => format!("{} at most {}", s.name, duration(s.seconds)),
            Known::Unknown => format!("{} more than {}", s.name, duration(s.seconds)),
        };
        let about = if self.stages.iter().any(|s| s.known == Known::Unknown) { "more than" } else { "about" };
        let stages: Vec<String> = self.stages.iter().map(stage).collect();
        let threads = if self.threads == 1 { "1 thread".into() } else { format!("{} threads", self.threads) };
        format!(
            "run time on {threads}, from a trial run: {about} {} ({})",
            duration(self.seconds()),
            stages.join(", ")
        )
    }
}

fn left(
    job: &Job,
    rehearsed: &Rehearsal,
    threads: usize,
    budget: Duration,
) -> Result<Vec<StageTime>, Failure> {
    let expected = |name: &str, seconds| StageTime { name: name.into(), seconds, known: Known::Expected };
    let unknown = |name: String, seconds| StageTime { name, seconds, known: Known::Unknown };
    if let Some((time, pace)) = rehearsed.reached {
        return Ok(vec![expected(RUN, rehearsed.seconds + pace * (simulated(job) - time).max(0.0))]);
    }
    let Some(grains) = &job.grains else {
        let name = match job.solid.as_ref().map(|s| &s.analysis) {
            Some(Analysis::Static) => "static",
            Some(Analysis::StrengthReduction(_)) => "strength reduction",
            _ => RUN,
        };
        return Ok(vec![unknown(name.into(), rehearsed.seconds)]);
    };
    let is_done = |name: &str| rehearsed.done.iter().any(|(done, _)| done == name);
    let growing =
        grains.groups.growths.iter().map(|g| format!("growing {}", g.group)).filter(|g| !is_done(g));
    if !grains.groups.growths.is_empty() {
        // Not representative of the final bed.
        let names = growing.chain([RUN.to_string()]);
        return Ok(names
            .enumerate()
            .map(|(k, n)| unknown(n, if k == 0 { rehearsed.seconds } else { 0.0 }))
            .collect());
    }
    let mut stages = Vec::new();
    let ground = match (&job.coupling, &job.solid) {
        (Some(plan), Some(solid)) => Some(plan.ground(solid, grains)),
        _ => None,
    };
    let deposition = grains.packing.deposition.as_ref().filter(|_| !is_done(SETTLING));
    // A column is too small to parallelise.
    let settle = || Column::settle(grains, deposition, ground.as_ref(), SETTLE * budget).ok();
    let Some(column) = crate::thread_pool(Some(1))?.install(settle) else {
        // Some grains behave differently from the rest.
        return Ok(vec![unknown(RUN.into(), rehearsed.seconds)]);
    };
    let whole = column.share / cores(threads);
    // Few contacts at first, in bed and column.
    let whole = whole * beside(&column, rehearsed, whole) / column.full;
    if let Some(plan) = deposition {
        // Each layer falls on the previous ones.
        let layers = f64::from(plan.layers);
        if plan.layers > 1 && !is_done("layers") {
            stages.push(expected("layers", 0.5 * (layers - 1.0) * whole * column.seconds));
        }
        // Budget exhausted.
        let (known, left) = match column.rested {
            true => (Known::Expected, 0.0),
            false => (Known::AtMost, plan.max_time - column.rest),
        };
        let seconds = whole * (column.seconds + left * column.late);
        stages.push(StageTime { name: SETTLING.into(), seconds, known });
    }
    // Measured over expected cost of a compaction.
    let seen = rehearsed.compacting.map(|pace| (pace / (whole * column.first)).clamp(0.3, 5.0));
    let whole = whole * seen.unwrap_or(1.0);
    for (k, plan) in grains.packing.compaction.iter().enumerate() {
        let name = format!("compaction {}: {}", k + 1, plan.press.name());
        if !is_done(&name) {
            stages.push(expected(&name, whole * column.first * longest(plan)));
        }
    }
    let end = simulated(job);
    let mut seconds = whole * column.pace * end;
    if let Some(solid) = &job.solid
        && let Some((window, theta)) = window(job, grains, ground.as_ref())
    {
        let (windows, step) = (end / window, solid::step(solid, theta, window)?);
        seconds +=
            step * ground.as_ref().map_or(windows, |ground| solid::steps(solid, ground, grains, windows));
    }
    stages.push(expected(RUN, seconds));
    Ok(stages)
}

/// Simulated time [s], if cycle jumps are not shortened.
fn simulated(job: &Job) -> f64 {
    let track = job.grains.as_ref().map(|grains| &grains.track);
    let jumps = track.and_then(|t| Some((t.after.jump.as_ref()?, t.load.as_ref()?)));
    jumps.map_or(job.end, |(jump, load)| {
        let skipped = load.cycles() - jump.fewest_simulated(load.cycles());
        job.end - f64::from(skipped) * load.period()
    })
}

/// Grading and cache misses cost more in a bed than in a column.
fn beside(column: &Column, rehearsed: &Rehearsal, whole: f64) -> f64 {
    let pair = rehearsed.settling.and_then(|(stretch, took)| Some((took, column.between(stretch)?)));
    pair.map_or(1.0, |(took, seconds)| (took / (whole * seconds)).clamp(0.3, 5.0))
}

fn cores(threads: usize) -> f64 {
    1.0 + SPEED_UP * (threads as f64 - 1.0)
}

fn window(job: &Job, grains: &GrainsPart, ground: Option<&SolidSurface>) -> Option<(f64, f64)> {
    let (plan, solid) = (job.coupling.as_ref()?, job.solid.as_ref()?);
    let model = dem::Model::new(with_sleepers(grains)).ok()?;
    let Windows { substeps, theta, .. } = plan.windows(grains, &model, solid, ground?);
    Some((model.dt() * f64::from(substeps), theta))
}

fn duration(seconds: f64) -> String {
    if seconds < 100.0 {
        format!("{seconds:.1} s")
    } else if seconds < 6000.0 {
        format!("{:.0} min", seconds / 60.0)
    } else {
        format!("{:.1} h", seconds / 3600.0)
    }
}
