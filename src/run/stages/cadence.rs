//! When a run writes what.

use crate::model::Job;
use trackbed_coupling::track::CyclicLoad;

/// Checks of the energy balance in a run.
const CHECKS: f64 = 1000.0;

/// When something is written, in windows.
pub(super) struct Cadence {
    /// Length of a window [s].
    pub window: f64,
    /// Frames over the run, but for its last part where that has its own.
    frames: u64,
    /// Window that the last part begins with, and its frames.
    last: Option<(u64, u64)>,
    /// Windows between two rows of the history.
    pub every: u64,
    /// Windows between two checks of the energy balance: the outcome of a run does not depend on the rows of its history.
    pub checked: u64,
    /// Windows after the last cycle, whenever that ends.
    pub tail: u64,
    /// Whether cycles are jumped over: then neither time nor steps show how far a run is.
    pub jumps: bool,
}

impl Cadence {
    /// Of a run of `windows` windows of length `window` [s]; `jumps` says whether cycles of the `load` are jumped over.
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

    /// The frame after the next one, `next`, when that is due at the window `reached` of `whole`.
    pub fn frame_after(&self, next: u64, reached: u64, whole: u64) -> Option<u64> {
        // Frames of the first part are counted before those of the last.
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
