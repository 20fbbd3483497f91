//! Time that work takes: seconds of the processor where one thread does it, which other programs on the machine do not lengthen; by the clock
//! where several do.

use crate::machine;
use std::time::Instant;

/// A clock that was started.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    begun: Instant,
    /// Processor time of the process at the start [s]; none where the clock counts.
    used: Option<f64>,
}

impl Clock {
    /// Starts it for work on so many threads.
    pub fn start(threads: usize) -> Clock {
        let used = if threads == 1 { machine::cpu_seconds() } else { None };
        Clock { begun: Instant::now(), used }
    }

    /// Seconds since the start.
    pub fn seconds(&self) -> f64 {
        let used = self.used.zip(machine::cpu_seconds()).map(|(before, now)| now - before);
        let elapsed = self.begun.elapsed().as_secs_f64();
        // A process cannot take more on one thread; what others of its threads take is no part of the work.
        used.map_or(elapsed, |used| used.min(elapsed))
    }

    /// These seconds over those by the clock.
    pub fn share(&self) -> f64 {
        self.seconds() / self.begun.elapsed().as_secs_f64().max(f64::MIN_POSITIVE)
    }
}
