//! Output intervals of a run.

use crate::model::Job;
use trackbed_coupling::track::CyclicLoad;

const CHECKS: f64 = 1000.0;

pub(super) struct Cadence {
    /// Window length [s].
    pub window: f64,
    /// Without a separate last part.
    frames: u64,
    last: Option<(u64, u64)>,
    /// Windows per history row.
    pub every: u64,
    /// Windows per energy check.
    pub checked: u64,
    /// Windows after the last cycle.
    pub tail: u64,
    /// Whether cycles are jumped over; steps then measure no progress.
    pub jumps: bool,
}

impl Cadence {
    /// Creates intervals for `windows` of length `window` [s]; `jumps`: over cycles of `load`.
    pub fn new(job: &Job, window: f64, windows: u64, load: Option<&CyclicLoad>, jumps: bool) -> Cadence {
        let every = |interval: f64| ((interval / window).round() as u64).max(1);
        Cadence {
            window,
            frames: u64::from(job.output.frames).min(windows),
            last: job.output.last.map(|(time, frames)| {
                let begin = (((job.end - time) / window).floor().max(0.0) as u64).min(windows - 1);
                (begin, u64::from(frames).min(windows - begin))
            }),
            every: every(job.output.history_interval),
            checked: every(job.end / CHECKS),
            tail: load.map_or(0, |l| (((job.end - l.end()) / window).ceil() as u64).min(windows)),
            jumps,
        }
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
