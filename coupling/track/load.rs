//! Load on a row of sleepers: rest, ramp, seating pulses, cycles.
//!
//! A cycle is a period of a common force, or a pass of wheels or pulses. Axles act through
//! [`influence`](super::influence) lines or a [rail with mass](super::rail).
//!
//! Theory manual: eqs. (6.1), (6.2), (6.4).

use super::influence::{GAUSS_REACH, Winkler, gauss};
use super::rail::Wheel;
use std::f64::consts::{PI, TAU};

/// Downward forces on the sleepers.
#[derive(Clone, Debug)]
pub struct CyclicLoad {
    /// Waveform of a cycle.
    pub waveform: Waveform,
    /// Number of cycles.
    pub cycles: u32,
    /// Time without load [s].
    pub rest: f64,
    /// Ramp time [s].
    pub ramp: f64,
    /// Seating pulses before the first cycle.
    pub seating: Option<Seating>,
    /// Sleeper positions along the track, the first at 0 [m].
    pub places: Vec<f64>,
}

/// Seating pulses (haversines) from the initial load to `maximum`, on all sleepers.
#[derive(Clone, Copy, Debug)]
pub struct Seating {
    /// Number of pulses.
    pub cycles: u32,
    /// Largest sleeper force [N].
    pub maximum: f64,
    /// Frequency [Hz].
    pub frequency: f64,
}

impl Seating {
    /// Total duration [s].
    pub fn duration(&self) -> f64 {
        f64::from(self.cycles) / self.frequency
    }

    fn force(&self, base: f64, since: f64) -> f64 {
        base + 0.5 * (self.maximum - base) * (1.0 - libm::cos(TAU * since * self.frequency))
    }
}

/// Waveform of a cycle.
#[derive(Clone, Debug)]
pub enum Waveform {
    /// Sine about the mean, or haversine from the minimum.
    Wave {
        /// Whether it is a sine.
        sine: bool,
        /// Smallest force [N].
        minimum: f64,
        /// Largest force [N].
        maximum: f64,
        /// Frequency [Hz].
        frequency: f64,
    },
    /// Half-cosine rise, hold, half-cosine fall.
    Ramp {
        /// Smallest force [N].
        minimum: f64,
        /// Largest force [N].
        maximum: f64,
        /// Rise time [s].
        rise: f64,
        /// Hold time [s].
        hold: f64,
        /// Fall time, if any [s].
        fall: Option<f64>,
    },
    /// Measured force.
    Measured {
        /// (Time [s], force [N]), from 0.
        points: Vec<(f64, f64)>,
        /// Speed along the sleepers [m/s]; `None`: simultaneous.
        speed: Option<f64>,
    },
    /// Moving wheels or pulses.
    Pass(Pass),
}

/// Moving wheels or pulses.
#[derive(Clone, Debug)]
pub struct Pass {
    /// Speed [m/s].
    pub speed: f64,
    /// Distance behind the first [m] and force [N] per axle.
    pub axles: Vec<[f64; 2]>,
    /// Initial position of the first axle [m].
    pub begin: f64,
    /// Travel of the first axle [m].
    pub distance: f64,
    /// Load distribution to the sleepers.
    pub spread: AxleSpread,
    /// Rail irregularity: force amplitude [N] and wavelength [m].
    pub waves: Vec<[f64; 2]>,
}

/// Load distribution of an axle.
#[derive(Clone, Copy, Debug)]
pub enum AxleSpread {
    /// Gaussian pulse of width ℓ [m].
    Gauss(f64),
    /// Beam on elastic foundation.
    Winkler(Winkler),
    /// Rail with mass.
    Beam {
        /// Rail ends [m].
        ends: [f64; 2],
        /// End length over which wheel loads ramp [m].
        taper: f64,
    },
}

impl AxleSpread {
    /// Distance beyond which axle forces are negligible [m].
    pub fn reach(&self) -> f64 {
        match self {
            AxleSpread::Gauss(width) => GAUSS_REACH * width,
            AxleSpread::Winkler(w) => w.reach(),
            AxleSpread::Beam { .. } => 0.0,
        }
    }
}

impl Pass {
    /// Pass of axles over sleepers at `places` [m], with the reach at both ends.
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

    fn place(&self, behind: f64, t: f64) -> f64 {
        self.begin + self.speed * t - behind
    }

    /// Whether pulses are Gaussian.
    pub fn gaussian(&self) -> bool {
        matches!(self.spread, AxleSpread::Gauss(_))
    }

    /// Axle force with irregularity.
    fn axle(&self, force: f64, place: f64) -> f64 {
        force
            + self
                .waves
                .iter()
                .map(|[amplitude, length]| amplitude * libm::sin(TAU * place / length))
                .sum::<f64>()
    }

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
    /// Excitation frequencies [Hz]; none for measured forces.
    pub fn frequencies(&self) -> Vec<f64> {
        match &self.waveform {
            Waveform::Wave { frequency, .. } => vec![*frequency],
            Waveform::Ramp { rise, hold, fall: Some(fall), .. } => vec![1.0 / (rise + hold + fall)],
            Waveform::Ramp { .. } | Waveform::Measured { .. } => Vec::new(),
            Waveform::Pass(pass) => pass.waves.iter().map(|[_, length]| pass.speed / length).collect(),
        }
    }

    /// Downward force on sleeper `k` at `t` [N], without rails with mass.
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

    /// Ramp factor of the initial load and the rail weight at `t`.
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

    /// Sets `out` to the wheels at `t`, loads divided among `rails`.
    pub fn wheels(&self, t: f64, rails: usize, out: &mut Vec<Wheel>) {
        self.wheels_with(t, rails, Pass::axle, out);
    }

    /// The same without rail irregularity.
    pub fn steady_wheels(&self, t: f64, rails: usize, out: &mut Vec<Wheel>) {
        self.wheels_with(t, rails, |_, force, _| force, out);
    }

    fn wheels_with(&self, t: f64, rails: usize, axle: impl Fn(&Pass, f64, f64) -> f64, out: &mut Vec<Wheel>) {
        out.clear();
        let Some((pass, _)) = self.passing(t) else { return };
        for ([at, share], [_, force]) in self.axle_places(t).zip(&pass.axles) {
            if share > 0.0 {
                out.push(Wheel { at, force: share * axle(pass, *force, at) / rails as f64 });
            }
        }
    }

    /// Distance behind the first [m] and static force [N] of each axle.
    pub fn axles(&self) -> &[[f64; 2]] {
        match &self.waveform {
            Waveform::Pass(pass) => &pass.axles,
            _ => &[],
        }
    }

    /// Wheels on a rail with mass at `t`, and the number of the pass from 0.
    pub fn passing(&self, t: f64) -> Option<(&Pass, u32)> {
        let (Waveform::Pass(pass), since) = (&self.waveform, t - self.cycles_begin()) else { return None };
        let inside = matches!(pass.spread, AxleSpread::Beam { .. }) && since >= 0.0 && t < self.end();
        inside.then(|| (pass, (since / self.period()) as u32))
    }

    /// Position of each axle at `t` [m], and share of its load on the rail, rising from 0 at the ends.
    pub fn axle_places(&self, t: f64) -> impl Iterator<Item = [f64; 2]> + '_ {
        let since = (t - self.cycles_begin()) % self.period();
        let pass = self.passing(t).map(|p| p.0);
        pass.into_iter().flat_map(move |pass| {
            let (ends, taper) = match pass.spread {
                AxleSpread::Beam { ends, taper } => (ends, taper),
                _ => ([0.0; 2], 1.0),
            };
            pass.axles.iter().map(move |[behind, _]| {
                let at = pass.place(*behind, since);
                let inside = (at - ends[0]).min(ends[1] - at);
                let share = if inside < taper { 0.5 * (1.0 - libm::cos(PI * inside / taper)) } else { 1.0 };
                [at, if inside > 0.0 { share } else { 0.0 }]
            })
        })
    }

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

    /// The end of the last cycle persists.
    fn in_cycle(&self, since: f64) -> f64 {
        let period = self.period();
        // Rounding of cycle ends.
        let number = (since / period + 1e-9).floor().clamp(0.0, f64::from(self.cycles - 1));
        (since - number * period).max(0.0)
    }

    /// Start of seating [s].
    pub fn seating_begins(&self) -> f64 {
        self.rest + self.ramp
    }

    /// Start of the first cycle [s].
    pub fn cycles_begin(&self) -> f64 {
        self.seating_begins() + self.seating.map_or(0.0, |s| s.duration())
    }

    /// End of the last cycle [s].
    pub fn end(&self) -> f64 {
        self.cycles_begin() + f64::from(self.cycles) * self.period()
    }

    /// Smallest and largest force on the middle sleeper [N]; half of the heaviest axle for a rail with mass.
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

    /// Time of the largest force on sleeper `k` in a cycle, from its start [s]; the first of equal ones.
    pub fn peak_in_cycle(&self, k: usize) -> f64 {
        const PARTS: u32 = 4000;
        let (mut peak, mut largest) = (0.0, f64::NEG_INFINITY);
        for i in 0..PARTS {
            let since = self.period() * f64::from(i) / f64::from(PARTS);
            let force = self.in_cycles(k, since);
            if force > largest {
                (peak, largest) = (since, force);
            }
        }
        peak
    }

    /// Number of cycles.
    pub fn cycles(&self) -> u32 {
        self.cycles
    }

    /// Cycle duration [s].
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
