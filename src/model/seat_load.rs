//! The cyclic load on a sleeper as a function of time.

use crate::scene::track::{SeatLoad, SeatLoadKind};
use std::f64::consts::{PI, TAU};

/// Downward force on the sleeper: rest, smooth ramp to the first value, then whole cycles.
#[derive(Clone, Debug)]
pub struct CyclicLoad {
    kind: SeatLoadKind,
    minimum: f64,
    maximum: f64,
    frequency: f64,
    cycles: u32,
    rest: f64,
    ramp: f64,
}

impl CyclicLoad {
    /// The load that a checked scene asks for.
    pub fn new(load: &SeatLoad) -> CyclicLoad {
        CyclicLoad {
            kind: load.kind,
            minimum: load.minimum.si,
            maximum: load.maximum.si,
            frequency: load.frequency.si,
            cycles: load.cycles,
            rest: load.rest.si,
            ramp: load.ramp.si,
        }
    }

    /// Downward force at time `t` [N].
    pub fn force(&self, t: f64) -> f64 {
        let first = self.in_cycle(0.0);
        let since = t - self.rest;
        if since <= 0.0 {
            0.0
        } else if since < self.ramp {
            first * 0.5 * (1.0 - (PI * since / self.ramp).cos())
        } else {
            self.in_cycle((since - self.ramp) * self.frequency)
        }
    }

    /// Force at a phase counted in cycles.
    fn in_cycle(&self, phase: f64) -> f64 {
        let range = self.maximum - self.minimum;
        match self.kind {
            SeatLoadKind::Sine => self.minimum + 0.5 * range * (1.0 + (TAU * phase).sin()),
            SeatLoadKind::Haversine => self.minimum + 0.5 * range * (1.0 - (TAU * phase).cos()),
        }
    }

    /// Time at which the first cycle begins [s].
    pub fn cycles_begin(&self) -> f64 {
        self.rest + self.ramp
    }

    /// Time at which the last cycle ends [s].
    pub fn end(&self) -> f64 {
        self.cycles_begin() + f64::from(self.cycles) / self.frequency
    }

    /// Smallest and largest force [N].
    pub fn range(&self) -> [f64; 2] {
        [self.minimum, self.maximum]
    }

    /// Number of cycles.
    pub fn cycles(&self) -> u32 {
        self.cycles
    }

    /// Length of a cycle [s].
    pub fn period(&self) -> f64 {
        1.0 / self.frequency
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(kind: SeatLoadKind) -> CyclicLoad {
        CyclicLoad { kind, minimum: 5.0, maximum: 65.0, frequency: 10.0, cycles: 3, rest: 0.1, ramp: 0.2 }
    }

    #[test]
    fn haversine_starts_at_the_minimum_and_peaks_at_half_a_cycle() {
        let f = load(SeatLoadKind::Haversine);
        assert_eq!(f.force(0.05), 0.0);
        assert!((f.force(0.2) - 2.5).abs() < 1e-12, "half way up the ramp to the minimum");
        assert!((f.force(0.3) - 5.0).abs() < 1e-12);
        assert!((f.force(0.35) - 65.0).abs() < 1e-9);
        assert!((f.end() - 0.6).abs() < 1e-12);
    }

    #[test]
    fn sine_starts_at_the_mean_and_reaches_both_ends() {
        let f = load(SeatLoadKind::Sine);
        assert!((f.force(0.3) - 35.0).abs() < 1e-9);
        assert!((f.force(0.325) - 65.0).abs() < 1e-9);
        assert!((f.force(0.375) - 5.0).abs() < 1e-9);
    }
}
