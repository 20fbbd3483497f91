//! Output intervals of a run.

use trackbed_input::model::{Job, OutputPlan};
use trackbed_track::CyclicLoad;

const CHECKS: f64 = 1000.0;

pub(super) struct Cadence {
    /// Window length [s].
    pub window: f64,
    /// Without a separate last part.
    frames: u64,
    last: Option<(u64, u64)>,
    /// Windows with an additional frame, ascending.
    extra: Vec<u64>,
    /// Windows per history row.
    pub every: u64,
    /// Windows per energy check.
    pub checked: u64,
    /// Windows after the last cycle.
    pub tail: u64,
    /// Whether cycles are jumped over; steps then measure no progress.
    pub jumps: bool,
    /// Whether history rows read the motion inside the solid.
    pub reads_solid: bool,
}

impl Cadence {
    /// Creates intervals for `windows` of length `window` [s]; `jumps`: over cycles of the load on the observed
    /// sleeper.
    pub fn new(
        job: &Job,
        (window, windows): (f64, u64),
        observed: Option<(&CyclicLoad, usize)>,
        jumps: bool,
    ) -> Cadence {
        let load = observed.map(|(load, _)| load);
        let every = |interval: f64| ((interval / window).round() as u64).max(1);
        Cadence {
            window,
            frames: u64::from(job.output.frames).min(windows),
            last: job.output.last.map(|(time, frames)| {
                let begin = (((job.end - time) / window).floor().max(0.0) as u64).min(windows - 1);
                (begin, u64::from(frames).min(windows - begin))
            }),
            extra: extra(&job.output, (window, windows), observed),
            every: every(job.output.history_interval),
            checked: every(job.end / CHECKS),
            tail: load.map_or(0, |l| (((job.end - l.end()) / window).ceil() as u64).min(windows)),
            jumps,
            reads_solid: job.probes.iter().any(|(_, observed)| observed.is_of_solid())
                || job.solid.as_ref().is_some_and(|part| !part.supports.named.is_empty()),
        }
    }

    /// Whether window `k` has an additional frame.
    pub fn has_extra_frame(&self, k: u64) -> bool {
        self.extra.binary_search(&k).is_ok()
    }

    /// Returns the frame after `next`, if due at `reached` of `whole`.
    pub fn frame_after(&self, next: u64, reached: u64, whole: u64) -> Option<u64> {
        // The first part is counted first.
        let (begin, last) = self.last.unwrap_or((whole, 0));
        let first = if begin > 0 { self.frames } else { 0 };
        let (count, from, done, of) = if next > first && last > 0 {
            (last, first, reached.saturating_sub(begin), whole - begin)
        } else {
            (first, 0, reached.min(begin), begin)
        };
        let place = next - from;
        (count > 0 && place <= count && done * count >= place * of).then(|| from + done * count / of + 1)
    }
}

/// Windows of `frames_at`, and of the largest load of each cycle if requested.
fn extra(
    output: &OutputPlan,
    (window, windows): (f64, u64),
    observed: Option<(&CyclicLoad, usize)>,
) -> Vec<u64> {
    let mut times = output.frames_at.clone();
    if let (Some((load, sleeper)), true) = (observed, output.frames_at_peaks) {
        let first = load.cycles_begin() + load.peak_in_cycle(sleeper);
        times.extend((0..load.cycles()).map(|cycle| first + f64::from(cycle) * load.period()));
    }
    let mut extra: Vec<u64> = times.into_iter().map(|t| ((t / window).round() as u64).max(1)).collect();
    extra.retain(|k| *k <= windows);
    extra.sort_unstable();
    extra.dedup();
    extra
}
