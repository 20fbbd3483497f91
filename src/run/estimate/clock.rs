//! CPU time on one thread, unaffected by other programs; wall time on several.

use std::time::Instant;
use trackbed_io::system;

/// Running clock.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    begun: Instant,
    /// CPU time [s]; none for wall time.
    used: Option<f64>,
}

impl Clock {
    /// Starts a clock for work on `threads` threads.
    pub fn start(threads: usize) -> Clock {
        let used = if threads == 1 { system::cpu_seconds() } else { None };
        Clock { begun: Instant::now(), used }
    }

    /// Returns elapsed seconds.
    pub fn seconds(&self) -> f64 {
        let used = self.used.zip(system::cpu_seconds()).map(|(before, now)| now - before);
        let elapsed = self.begun.elapsed().as_secs_f64();
        // The rest is from other threads.
        used.map_or(elapsed, |used| used.min(elapsed))
    }

    /// Returns elapsed over wall time.
    pub fn share(&self) -> f64 {
        self.seconds() / self.begun.elapsed().as_secs_f64().max(f64::MIN_POSITIVE)
    }
}
