//! Trial run in a temporary directory.

use super::clock::Clock;
use crate::checkpoint::Moment;
use crate::checkpoint_store::Trace;
use crate::stages::{self, COMPACTED, RUN, SETTLING};
use crate::{Interrupt, Options, Outcome, Verbosity};
use std::io;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{PoisonError, mpsc};
use std::thread;
use std::time::{Duration, Instant};
use trackbed_input::model::Job;
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;

/// Budgets up to the main loop with growth.
const GROWTH: u32 = 8;
/// Budgets up to the main loop without growth.
const PREPARATION: u32 = 3;
/// Fraction of the main loop to reach within [`LOOP`] budgets: a resting bed may flow once a wall has turned.
/// With moving walls or flow, [`MOVED`] budgets: a ship enters ice gradually.
const SEEN: f64 = 0.2;
/// With inlets and outlets: grains from the top arrive late and are fastest.
const FLOWN: f64 = 2.0 / 3.0;
const LOOP: u32 = 5;
const MOVED: u32 = 20;
/// Representative fraction with moving walls or flow.
const LATE: f64 = 0.75;
const LOOK: Duration = Duration::from_millis(100);

/// Extent of a trial run.
#[derive(Debug, Default)]
pub struct Rehearsal {
    /// Completed stages: name, wall time [s].
    pub done: Vec<(String, f64)>,
    /// Whether the run completed.
    pub whole: bool,
    /// Seconds in the stopped stage.
    pub seconds: f64,
    /// Simulated main-loop time [s], and seconds per simulated second in its second half (last quarter with
    /// moving walls or flow).
    pub reached: Option<(f64, f64)>,
    /// Seconds per simulated second of the stopped compaction.
    pub compacting: Option<f64>,
    /// Settling interval [s], and its seconds.
    pub settling: Option<([f64; 2], f64)>,
}

/// Runs a scene for about `budget`, half as long again after a stage change.
///
/// # Errors
/// Failures of the run; temporary directory not writable.
pub fn rehearse(
    document: &Document,
    set: &[String],
    job: &Job,
    threads: Option<usize>,
    budget: Duration,
) -> Result<Rehearsal, Failure> {
    let folder = Folder::new().map_err(|e| Failure::Other(format!("temporary directory: {e}")))?;
    let (interrupt, trace) = Interrupt::traced();
    let (ended, over) = mpsc::channel::<()>();
    let (watched, followed) = (interrupt.clone(), trace.clone());
    let flows = job.grains.as_ref().is_some_and(|g| g.flow.is_some());
    let seen = if flows { FLOWN } else { SEEN } * job.end;
    let grows = job.grains.as_ref().is_some_and(|g| !g.groups.growths.is_empty());
    let moves = flows || job.grains.as_ref().is_some_and(|g| g.walls.others.iter().any(|w| w.moves()));
    let begun = Instant::now();
    let clock = Clock::start(threads.unwrap_or_else(rayon::current_num_threads));
    let timer = thread::Builder::new().spawn(move || {
        let passes = |time| over.recv_timeout(time) == Err(mpsc::RecvTimeoutError::Timeout);
        let (mut on, most) = (true, if grows { GROWTH } else { PREPARATION });
        while on && begun.elapsed() < most * budget && come(&followed).is_none() {
            on = passes(LOOK);
        }
        // Not representative.
        on = on
            && passes(budget)
            && passes((budget / 2).saturating_sub(stage_age(&followed).unwrap_or(budget)));
        let most = if moves { MOVED } else { LOOP };
        let more = || {
            come(&followed).is_some_and(|time| time < seen)
                && stage_age(&followed).is_some_and(|age| age < most * budget)
        };
        while on && more() {
            on = passes(LOOK);
        }
        if on {
            watched.request();
        }
    });
    let timer = timer.map_err(Failure::thread)?;
    let options = Options {
        text: document.text_in_memory().map(String::from),
        out: Some(folder.0.clone()),
        threads,
        set: set.to_vec(),
        interrupt,
        verbosity: Verbosity::Quiet,
        ..Options::default()
    };
    let outcome = crate::run(document.file(), &options);
    // Wall time includes other programs.
    let (elapsed, share) = (clock.seconds(), clock.share());
    drop(ended);
    // The thread cannot fail.
    let _ = timer.join();
    match outcome {
        Ok(Outcome::Done(summary)) => {
            let stages = summary.stages.iter().map(|s| (s.name.clone(), share * s.seconds));
            Ok(Rehearsal { done: stages.collect(), whole: true, ..Rehearsal::default() })
        }
        Ok(Outcome::WasDone(_)) | Err(Failure::Interrupted(_)) => {
            let (stages, reached) = stages::reached(&folder.0, job);
            let trace = trace.lock().unwrap_or_else(PoisonError::into_inner);
            let from = if moves { LATE } else { 0.5 };
            let reached = reached.and_then(|time| Some((time, share * pace(&trace, from)?)));
            let done: Vec<_> = stages.into_iter().map(|s| (s.name, share * s.seconds)).collect();
            let before: f64 = done.iter().map(|(_, seconds)| seconds).sum();
            let seconds = (elapsed - before).max(0.0);
            let compacting = trace.last().is_some_and(|(_, moment)| moment.stage == COMPACTED);
            let compacting = if compacting { compacting_pace(&trace).map(|pace| share * pace) } else { None };
            let settling = settling(&trace).map(|(stretch, took)| (stretch, share * took));
            Ok(Rehearsal { done, whole: false, seconds, reached, compacting, settling })
        }
        Err(failure) => Err(failure),
    }
}

/// Wall seconds per simulated second, from a fraction of the samples on.
fn pace(trace: &[(Instant, Moment)], share: f64) -> Option<f64> {
    let begun = trace.iter().position(|(_, moment)| moment.stage == RUN)?;
    let from = begun + (share * (trace.len() - begun) as f64) as usize;
    let (middle, end) = (trace.get(from)?, trace.last()?);
    let (middle, time) = match end.1.time - middle.1.time {
        0.0 => (trace.get(begun)?, end.1.time - trace.get(begun)?.1.time),
        time => (middle, time),
    };
    (time > 0.0).then(|| (end.0 - middle.0).as_secs_f64() / time)
}

fn come(trace: &Trace) -> Option<f64> {
    let trace = trace.lock().unwrap_or_else(PoisonError::into_inner);
    trace.last().filter(|(_, moment)| moment.stage == RUN).map(|(_, moment)| moment.time)
}

fn stage_age(trace: &Trace) -> Option<Duration> {
    let trace = trace.lock().unwrap_or_else(PoisonError::into_inner);
    let now = &trace.last()?.1.stage;
    let first = trace.iter().rev().take_while(|(_, moment)| moment.stage == *now).last()?;
    Some(first.0.elapsed())
}

/// Second half of the trace. Time restarts with each bed.
fn compacting_pace(trace: &[(Instant, Moment)]) -> Option<f64> {
    let begun = trace.iter().position(|(_, moment)| moment.stage == COMPACTED)?;
    let steps = trace[(begun + trace.len()) / 2..].windows(2);
    let passed = steps.map(|w| ((w[1].0 - w[0].0).as_secs_f64(), w[1].1.time - w[0].1.time));
    let sum = |[s, t]: [f64; 2], (clock, time): (f64, f64)| [s + clock, t + time];
    let [clock, time] = passed.filter(|(_, time)| *time > 0.0).fold([0.0, 0.0], sum);
    (time > 0.0).then(|| clock / time)
}

fn settling(trace: &[(Instant, Moment)]) -> Option<([f64; 2], f64)> {
    let mut moments = trace.iter().filter(|(_, moment)| moment.stage == SETTLING);
    let (first, last) = (moments.next()?, moments.next_back()?);
    Some(([first.1.time, last.1.time], (last.0 - first.0).as_secs_f64()))
}

struct Folder(PathBuf);

impl Folder {
    fn new() -> io::Result<Folder> {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        loop {
            let number = NUMBER.fetch_add(1, Ordering::Relaxed);
            let dir = std::env::temp_dir().join(format!("trackbed-{}-{number}", std::process::id()));
            match std::fs::create_dir(&dir) {
                // Of a process with the same id.
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
                made => return made.map(|()| Folder(dir)),
            }
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // The system cleans up the rest.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measures_pace_of_last_samples() {
        let begun = Instant::now();
        let at = |stage: &str, clock: f64, time: f64| {
            let moment = Moment { stage: stage.into(), step: 0, time };
            (begun + Duration::from_secs_f64(clock), moment)
        };
        let settling = (0..4).map(|k| at(SETTLING, 7.0 * f64::from(k), f64::from(k)));
        let running = (0..=8).map(|k| {
            let k = f64::from(k);
            at(RUN, 30.0 + k + 2.0 * (k - 6.0).max(0.0), k)
        });
        let trace: Vec<_> = settling.chain(running).collect();
        let found = [0.5, LATE].map(|share| pace(&trace, share).unwrap());
        assert!((found[0] - 2.0).abs() < 1e-9 && (found[1] - 3.0).abs() < 1e-9, "{found:?}");
        assert!(pace(&trace[..4], LATE).is_none() && pace(&trace[..5], LATE).is_none());
    }
}
