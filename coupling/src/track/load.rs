//! The load on a row of sleepers as a function of time.
//!
//! Rest without load, a smooth ramp to the load of the first instant, pulses that seat the sleepers where a scene has them, then
//! whole cycles. A cycle is a period of a force
//! that acts on all sleepers at once, or a pass of wheels or pulses that reach one sleeper after the other.
//!
//! Sources: an axle is shared among the sleepers by the laws of [`influence`](super::influence) or by a [rail with
//! mass](super::rail). A wheel that follows a rail of the shape a sin wt without losing contact needs the inertia force
//! M a w² of its unsprung mass (Newton's law), so that its force is F = P + Σ M a w² sin wt; the vehicle's own suspension is left
//! out.
//!
//! Theory manual: equations (6.1), (6.2), (6.4) of `docs/theory/track.md`.

use super::influence::{GAUSS_REACH, Winkler, gauss};
use super::rail::Wheel;
use std::f64::consts::{PI, TAU};

/// Downward forces on the sleepers.
#[derive(Clone, Debug)]
pub struct CyclicLoad {
    /// What happens in a cycle.
    pub waveform: Waveform,
    /// Number of cycles.
    pub cycles: u32,
    /// Time without load [s].
    pub rest: f64,
    /// Time of the ramp [s].
    pub ramp: f64,
    /// Pulses before the first cycle, which do not count.
    pub seating: Option<Seating>,
    /// Places of the sleepers along the track, the first at 0 [m].
    pub places: Vec<f64>,
}

/// Pulses that press the sleepers into the bed before the cycles: each from the load of the first instant to `maximum` and back,
/// a whole cosine, on all sleepers at once. What settles meanwhile is a result of its own.
#[derive(Clone, Copy, Debug)]
pub struct Seating {
    /// Number of pulses.
    pub cycles: u32,
    /// Largest force on a sleeper [N].
    pub maximum: f64,
    /// Pulses per second [Hz].
    pub frequency: f64,
}

impl Seating {
    /// Time that all pulses take [s].
    pub fn duration(&self) -> f64 {
        f64::from(self.cycles) / self.frequency
    }

    /// Force at a time since the first pulse began, from `base` up [N].
    fn force(&self, base: f64, since: f64) -> f64 {
        base + 0.5 * (self.maximum - base) * (1.0 - libm::cos(TAU * since * self.frequency))
    }
}

/// What happens in a cycle.
#[derive(Clone, Debug)]
pub enum Waveform {
    /// Mean plus amplitude times sin 2πft, or minimum plus range times (1 − cos 2πft)/2.
    Wave {
        /// Whether it starts at the mean.
        sine: bool,
        /// Smallest force [N].
        minimum: f64,
        /// Largest force [N].
        maximum: f64,
        /// Cycles per second [Hz].
        frequency: f64,
    },
    /// Rise from the smallest to the largest force, hold, fall, each flank half a cosine.
    Ramp {
        /// Smallest force [N].
        minimum: f64,
        /// Largest force [N].
        maximum: f64,
        /// Time of the rise [s].
        rise: f64,
        /// Time at the largest force [s].
        hold: f64,
        /// Time of the fall, where there is one [s].
        fall: Option<f64>,
    },
    /// A measured force; the first row is at the start of the cycle.
    Measured {
        /// (Time [s], force [N]), times ascending from 0.
        points: Vec<(f64, f64)>,
        /// Speed at which it runs along the sleepers [m/s]; without it all have it at once.
        speed: Option<f64>,
    },
    /// Wheels or pulses that run along the track.
    Pass(Pass),
}

/// Wheels or pulses that run along the track.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Speed [m/s].
    pub speed: f64,
    /// Distance behind the first axle [m] and force [N] of each axle.
    pub axles: Vec<[f64; 2]>,
    /// Place of the first axle when a pass begins [m].
    pub begin: f64,
    /// Distance that the first axle travels in a pass [m].
    pub distance: f64,
    /// How the force of an axle is shared among the sleepers.
    pub spread: AxleSpread,
    /// Waves of an uneven rail: force amplitude [N] and wave length [m].
    pub waves: Vec<[f64; 2]>,
}

/// How the force of an axle is shared among the sleepers.
#[derive(Clone, Copy, Debug)]
pub enum AxleSpread {
    /// As a Gaussian pulse of this width ℓ [m].
    Gauss(f64),
    /// By the formula of a beam on an elastic foundation.
    Winkler(Winkler),
    /// Through a rail with mass from `ends[0]` to `ends[1]` [m], onto which wheels roll within `taper` [m].
    Beam {
        /// Ends of the rail [m].
        ends: [f64; 2],
        /// Length at each end over which the load of a wheel grows from zero.
        taper: f64,
    },
}

impl AxleSpread {
    /// Distance from an axle beyond which its force is negligible [m].
    pub fn reach(&self) -> f64 {
        match self {
            AxleSpread::Gauss(width) => GAUSS_REACH * width,
            AxleSpread::Winkler(w) => w.reach(),
            AxleSpread::Beam { .. } => 0.0,
        }
    }
}

impl Pass {
    /// Axles of these distances behind the first [m] and forces [N] over sleepers at `places` [m], from beyond the reach of
    /// the first sleeper to beyond that of the last.
    pub fn over(
        places: &[f64],
        speed: f64,
        axles: Vec<[f64; 2]>,
        spread: AxleSpread,
        waves: Vec<[f64; 2]>,
    ) -> Pass {
        let last = places.last().copied().unwrap_or(0.0);
        let [from, to] = match spread {
            AxleSpread::Beam { ends, .. } => ends,
            _ => [-spread.reach(), last + spread.reach()],
        };
        let behind = axles.last().map_or(0.0, |a| a[0]);
        Pass { speed, axles, begin: from, distance: to - from + behind, spread, waves }
    }

    /// Place of an axle at time `t` of a pass.
    fn place(&self, behind: f64, t: f64) -> f64 {
        self.begin + self.speed * t - behind
    }

    /// Whether the pulses are Gaussian, and not those of axles on a rail.
    pub fn gaussian(&self) -> bool {
        matches!(self.spread, AxleSpread::Gauss(_))
    }

    /// Force of an axle at a place: F = P + Σ M a w² sin wt, with wt = 2πx/L.
    fn axle(&self, force: f64, place: f64) -> f64 {
        force
            + self
                .waves
                .iter()
                .map(|[amplitude, length]| amplitude * libm::sin(TAU * place / length))
                .sum::<f64>()
    }

    /// Force on a sleeper at `place`.
    fn on(&self, place: f64, t: f64) -> f64 {
        let each = |[behind, force]: &[f64; 2]| {
            let x = self.place(*behind, t);
            let share = match self.spread {
                AxleSpread::Gauss(width) => gauss(place - x, width),
                AxleSpread::Winkler(w) => w.share(place - x),
                AxleSpread::Beam { .. } => return 0.0,
            };
            self.axle(*force, x) * share
        };
        self.axles.iter().map(each).sum()
    }
}

impl CyclicLoad {
    /// Frequencies that the load excites the ground with for many periods [Hz]: of waves, of flanks without a pause, of an uneven rail.
    /// Of measured forces none are known.
    pub fn frequencies(&self) -> Vec<f64> {
        match &self.waveform {
            Waveform::Wave { frequency, .. } => vec![*frequency],
            Waveform::Ramp { rise, hold, fall: Some(fall), .. } => vec![1.0 / (rise + hold + fall)],
            Waveform::Ramp { .. } | Waveform::Measured { .. } => Vec::new(),
            Waveform::Pass(pass) => pass.waves.iter().map(|[_, length]| pass.speed / length).collect(),
        }
    }

    /// Downward force on sleeper `k` at time `t` [N], that of a rail with mass excepted.
    pub fn on(&self, k: usize, t: f64) -> f64 {
        let since = t - self.rest;
        if since <= 0.0 {
            0.0
        } else if since < self.ramp {
            self.in_cycles(k, 0.0) * self.applied_share(t)
        } else {
            match &self.seating {
                Some(s) if t < self.cycles_begin() => s.force(self.in_cycles(k, 0.0), since - self.ramp),
                _ => self.in_cycles(k, t - self.cycles_begin()),
            }
        }
    }

    /// Share of the load of the first instant, and of the rail's weight, that acts at time `t`.
    pub fn applied_share(&self, t: f64) -> f64 {
        let since = t - self.rest;
        if since <= 0.0 {
            0.0
        } else if since < self.ramp {
            0.5 * (1.0 - libm::cos(PI * since / self.ramp))
        } else {
            1.0
        }
    }

    /// Wheels on the rail at time `t`, their loads divided among `rails`; `out` is emptied first.
    pub fn wheels(&self, t: f64, rails: usize, out: &mut Vec<Wheel>) {
        self.wheels_with(t, rails, Pass::axle, out);
    }

    /// The same without the waves of an uneven rail.
    pub fn steady_wheels(&self, t: f64, rails: usize, out: &mut Vec<Wheel>) {
        self.wheels_with(t, rails, |_, force, _| force, out);
    }

    fn wheels_with(&self, t: f64, rails: usize, axle: impl Fn(&Pass, f64, f64) -> f64, out: &mut Vec<Wheel>) {
        out.clear();
        let (Waveform::Pass(pass), since) = (&self.waveform, t - self.cycles_begin()) else { return };
        let AxleSpread::Beam { ends, taper } = pass.spread else { return };
        if since < 0.0 || t >= self.end() {
            return;
        }
        let t = since % self.period();
        for [behind, force] in &pass.axles {
            let at = pass.place(*behind, t);
            let inside = (at - ends[0]).min(ends[1] - at);
            if inside > 0.0 {
                let share = if inside < taper { 0.5 * (1.0 - libm::cos(PI * inside / taper)) } else { 1.0 };
                out.push(Wheel { at, force: share * axle(pass, *force, at) / rails as f64 });
            }
        }
    }

    /// Force on sleeper `k` at a time after the cycles began.
    fn in_cycles(&self, k: usize, since: f64) -> f64 {
        let place = self.places.get(k).copied().unwrap_or(0.0);
        match &self.waveform {
            &Waveform::Wave { sine, minimum, maximum, frequency } => {
                let (range, phase) = (maximum - minimum, since * frequency);
                if sine {
                    minimum + 0.5 * range * (1.0 + libm::sin(TAU * phase))
                } else {
                    minimum + 0.5 * range * (1.0 - libm::cos(TAU * phase))
                }
            }
            &Waveform::Ramp { minimum, maximum, rise, hold, fall } => {
                let t = self.in_cycle(since);
                let part = if t < rise {
                    0.5 * (1.0 - libm::cos(PI * t / rise))
                } else if t <= rise + hold {
                    1.0
                } else {
                    fall.map_or(1.0, |fall| 0.5 * (1.0 + libm::cos(PI * ((t - rise - hold) / fall).min(1.0))))
                };
                minimum + (maximum - minimum) * part
            }
            Waveform::Measured { points, speed } => {
                let delay = speed.map_or(0.0, |v| place / v);
                between(points, self.in_cycle(since) - delay)
            }
            Waveform::Pass(pass) => pass.on(place, self.in_cycle(since)),
        }
    }

    /// Time since the present cycle began, the end of the last cycle going on for ever.
    fn in_cycle(&self, since: f64) -> f64 {
        let period = self.period();
        // A time that rounding has put just before the end of a cycle is its end.
        let number = (since / period + 1e-9).floor().clamp(0.0, f64::from(self.cycles - 1));
        (since - number * period).max(0.0)
    }

    /// Time at which the load of the first instant is there, and seating begins [s].
    pub fn seating_begins(&self) -> f64 {
        self.rest + self.ramp
    }

    /// Time at which the first cycle begins [s].
    pub fn cycles_begin(&self) -> f64 {
        self.seating_begins() + self.seating.map_or(0.0, |s| s.duration())
    }

    /// Time at which the last cycle ends [s].
    pub fn end(&self) -> f64 {
        self.cycles_begin() + f64::from(self.cycles) * self.period()
    }

    /// Smallest and largest force on the middle sleeper in a cycle [N]. The share of an axle that a rail with mass passes on is a
    /// result of the run: half of the heaviest axle is assumed.
    pub fn range(&self) -> [f64; 2] {
        let ends = |forces: &mut dyn Iterator<Item = f64>| {
            forces.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], f| [a.min(f), b.max(f)])
        };
        match &self.waveform {
            Waveform::Wave { minimum, maximum, .. } | Waveform::Ramp { minimum, maximum, .. } => {
                [*minimum, *maximum]
            }
            Waveform::Measured { points, .. } => ends(&mut points.iter().map(|p| p.1)),
            Waveform::Pass(pass) if matches!(pass.spread, AxleSpread::Beam { .. }) => {
                [0.0, 0.5 * pass.axles.iter().map(|a| a[1]).fold(0.0, f64::max)]
            }
            Waveform::Pass(_) => {
                let (middle, step) = (self.places.len() / 2, self.period() / 1000.0);
                ends(&mut (0..=1000).map(|i| self.in_cycles(middle, f64::from(i) * step)))
            }
        }
    }

    /// Number of cycles.
    pub fn cycles(&self) -> u32 {
        self.cycles
    }

    /// Length of a cycle [s].
    pub fn period(&self) -> f64 {
        match &self.waveform {
            Waveform::Wave { frequency, .. } => 1.0 / frequency,
            Waveform::Ramp { rise, hold, fall, .. } => rise + hold + fall.unwrap_or(0.0),
            Waveform::Measured { points, speed } => {
                let last = self.places.last().copied().unwrap_or(0.0);
                points.last().map_or(0.0, |p| p.0) + speed.map_or(0.0, |v| last / v)
            }
            Waveform::Pass(pass) => pass.distance / pass.speed,
        }
    }
}

/// Straight between points, constant beyond them.
fn between(points: &[(f64, f64)], t: f64) -> f64 {
    let k = points.partition_point(|p| p.0 <= t);
    match (k.checked_sub(1).map(|k| points[k]), points.get(k)) {
        (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (t - a.0) / (b.0 - a.0),
        (Some(a), None) => a.1,
        (None, Some(b)) => b.1,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
#[path = "load_tests.rs"]
mod tests;
