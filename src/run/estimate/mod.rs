//! How long a run will take. Its first seconds are carried out for real; what they do not reach follows from a column of the bed
//! that settles by itself, and from a few steps of the solid.

mod clock;
mod column;
mod rehearsal;
mod solid;

use crate::failure::Failure;
use crate::model::Job;
use crate::model::exchange::Windows;
use crate::model::grains::{GrainsPart, with_sleepers};
use crate::model::solid::Analysis;
use crate::run;
use crate::run::stages::{RUN, SETTLING, longest};
use column::Column;
use rehearsal::{Rehearsal, rehearse};
use serde::Serialize;
use std::path::Path;
use std::time::Duration;
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;

/// Settling of a column over rehearsals.
const SETTLE: u32 = 15;
/// Share of the steps that the cores besides the first take over.
const SPEED_UP: f64 = 0.8;

/// How a time is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Known {
    /// It was measured.
    Measured,
    /// It follows from what was measured.
    Expected,
    /// It is the most that the scene allows.
    AtMost,
    /// It is not known: the stage ends when its work is done.
    Unknown,
}

/// Time of a stage.
#[derive(Clone, Debug, Serialize)]
pub struct StageTime {
    /// Name, as in the summary of a run.
    pub name: String,
    /// Seconds: those of the processor on one thread, else by the clock.
    pub seconds: f64,
    /// How it is known.
    pub known: Known,
}

/// Time of a run, stage by stage.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// The stages in order.
    pub stages: Vec<StageTime>,
    /// Threads that it is for.
    pub threads: usize,
}

impl Estimate {
    /// Rehearses a run of the scene, which `job` is made of, for `budget` by the clock, and estimates the time of all of it; that
    /// takes up to some forty times as long.
    ///
    /// # Errors
    /// What the run itself ends with in its first seconds; contacts for which no step can be made.
    pub fn of(
        scene: &Path,
        set: &[String],
        job: &Job,
        threads: Option<usize>,
        budget: Duration,
    ) -> Result<Estimate, Failure> {
        let count = threads.unwrap_or_else(rayon::current_num_threads);
        if let Some(stages) = solid::statics(job, count) {
            return Ok(Estimate { stages, threads: count });
        }
        let rehearsed = rehearse(scene, set, job, threads, budget)?;
        let stages = if rehearsed.whole { Vec::new() } else { left(job, &rehearsed, count, budget)? };
        let measured = rehearsed.done.into_iter();
        let measured = measured.map(|(name, seconds)| StageTime { name, seconds, known: Known::Measured });
        Ok(Estimate { stages: measured.chain(stages).collect(), threads: count })
    }

    /// Seconds of all stages whose time is known.
    pub fn seconds(&self) -> f64 {
        self.stages.iter().map(|s| s.seconds).sum()
    }

    /// In words.
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

/// The stages that a rehearsal left.
fn left(
    job: &Job,
    rehearsed: &Rehearsal,
    threads: usize,
    budget: Duration,
) -> Result<Vec<StageTime>, Failure> {
    let expected = |name: &str, seconds| StageTime { name: name.into(), seconds, known: Known::Expected };
    let unknown = |name: String, seconds| StageTime { name, seconds, known: Known::Unknown };
    if let Some((time, pace)) = rehearsed.reached {
        return Ok(vec![expected(RUN, rehearsed.seconds + pace * (job.end - time))]);
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
        // Grains that have yet to grow show nothing of the bed that they will be.
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
    // On one thread: a column is too small to be shared among as many as the bed.
    let settle = || Column::settle(grains, deposition, ground.as_ref(), SETTLE * budget).ok();
    let Some(column) = run::thread_pool(Some(1))?.install(settle) else {
        // Some of the grains do not do what all of them do.
        return Ok(vec![unknown(RUN.into(), rehearsed.seconds)]);
    };
    let whole = column.share / cores(threads);
    // A bed that has just begun to fall has few contacts, as the column has then.
    let whole = whole * beside(&column, rehearsed, whole) / column.full;
    if let Some(plan) = deposition {
        // Each layer falls on those before it.
        let layers = f64::from(plan.layers);
        if plan.layers > 1 && !is_done("layers") {
            stages.push(expected("layers", 0.5 * (layers - 1.0) * whole * column.seconds));
        }
        // Where the clock ran out before the column lay at rest.
        let (known, left) = match column.rested {
            true => (Known::Expected, 0.0),
            false => (Known::AtMost, plan.max_time - column.rest),
        };
        let seconds = whole * (column.seconds + left * column.late);
        stages.push(StageTime { name: SETTLING.into(), seconds, known });
    }
    // What a compaction that was seen cost over what the column makes expect.
    let seen = rehearsed.compacting.map(|pace| (pace / (whole * column.first)).clamp(0.3, 5.0));
    let whole = whole * seen.unwrap_or(1.0);
    for (k, plan) in grains.packing.compaction.iter().enumerate() {
        let name = format!("compaction {}: {}", k + 1, plan.press.name());
        if !is_done(&name) {
            stages.push(expected(&name, whole * column.first * longest(plan)));
        }
    }
    let mut seconds = whole * column.pace * job.end;
    if let Some(solid) = &job.solid
        && let Some((window, theta)) = window(job, grains, ground.as_ref())
    {
        seconds += job.end / window * solid::step(solid, theta, window)?;
    }
    stages.push(expected(RUN, seconds));
    Ok(stages)
}

/// What the settling of the bed took over what the column's makes expect, as far as the rehearsal came: grains of many sizes, and
/// memory that caches do not hold, cost more in a bed than in a column.
fn beside(column: &Column, rehearsed: &Rehearsal, whole: f64) -> f64 {
    let pair = rehearsed.settling.and_then(|(stretch, took)| Some((took, column.between(stretch)?)));
    pair.map_or(1.0, |(took, seconds)| (took / (whole * seconds)).clamp(0.3, 5.0))
}

/// How many cores' worth of work some threads do.
fn cores(threads: usize) -> f64 {
    1.0 + SPEED_UP * (threads as f64 - 1.0)
}

/// Length of a window of grains and solid [s] and its theta; none where one of them is alone.
fn window(job: &Job, grains: &GrainsPart, ground: Option<&SolidSurface>) -> Option<(f64, f64)> {
    let (plan, solid) = (job.coupling.as_ref()?, job.solid.as_ref()?);
    let model = dem::Model::new(with_sleepers(grains)).ok()?;
    let Windows { substeps, theta, .. } = plan.windows(grains, &model, solid, ground?);
    Some((model.dt() * f64::from(substeps), theta))
}

/// A time for people.
fn duration(seconds: f64) -> String {
    if seconds < 100.0 {
        format!("{seconds:.1} s")
    } else if seconds < 6000.0 {
        format!("{:.0} min", seconds / 60.0)
    } else {
        format!("{:.1} h", seconds / 3600.0)
    }
}
