//! Linear (Airy) waves on water of finite depth with a current U (Dean & Dalrymple 1991, ch. 3): (ω − k U)² =
//! g k tanh(k h).
//!
//! The linear field extends up to the crests: small floes drift (Stokes).
//!
//! Theory manual: equations (6.32), (6.33) of `docs/theory/track.md`.

use crate::base::Vec3;
use std::f64::consts::TAU;

/// Steepness over tanh(k h) (Miche 1944) [-].
const STEEPEST: f64 = 0.142;

/// Reason why a wave does not exist.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum WaveError {
    /// Quantity out of range.
    #[error("{0} out of range")]
    Range(&'static str),
    /// Stopped by the current.
    #[error("no wave of this period exists against the current")]
    Blocked,
    /// Breaking wave.
    #[error("a wave of {length} m breaks at a height of {limit} m (Miche 1944)")]
    Breaks {
        /// Wavelength [m].
        length: f64,
        /// Largest height [m].
        limit: f64,
    },
}

/// Given period or length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measured {
    /// Period at a fixed point [s].
    Period(f64),
    /// Length [m].
    Length(f64),
}

/// Regular wave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Amplitude, half the height [m].
    pub amplitude: f64,
    /// Wave number 2π/L [1/m].
    pub number: f64,
    /// Angular frequency at a fixed point [rad/s].
    pub frequency: f64,
    /// Intrinsic angular frequency, in the moving water [rad/s].
    pub intrinsic: f64,
    /// Unit vector of propagation.
    pub direction: [f64; 2],
    /// Phase φ [rad].
    pub phase: f64,
    /// Still-water depth [m]; may be infinite.
    pub depth: f64,
}

/// Water surface and motion at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Orbit {
    /// Surface elevation above still water [m].
    pub elevation: f64,
    /// Water velocity without current [m/s].
    pub velocity: Vec3,
    /// Material acceleration of the water [m/s²].
    pub acceleration: Vec3,
}

impl Wave {
    /// Wave of a height [m] towards `direction` [rad, from x to y]; `depth` [m], `current` [m/s], `gravity`
    /// [m/s²].
    ///
    /// # Errors
    /// [`WaveError`] for a breaking or impossible wave.
    pub fn new(
        height: f64,
        measured: Measured,
        direction: f64,
        phase: f64,
        depth: f64,
        current: [f64; 2],
        gravity: f64,
    ) -> Result<Wave, WaveError> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let along = [libm::cos(direction), libm::sin(direction)];
        let with = current[0] * along[0] + current[1] * along[1];
        for (name, good) in [
            ("height", height >= 0.0 && height.is_finite()),
            ("depth", depth > 0.0),
            ("direction or phase", direction.is_finite() && phase.is_finite()),
            ("current", with.is_finite()),
            ("gravity", positive(gravity)),
        ] {
            if !good {
                return Err(WaveError::Range(name));
            }
        }
        let intrinsic = |k: f64| (gravity * k * libm::tanh(k * depth)).sqrt();
        let (number, frequency) = match measured {
            Measured::Length(length) if positive(length) => {
                let k = TAU / length;
                (k, intrinsic(k) + k * with)
            }
            Measured::Period(period) if positive(period) => {
                let frequency = TAU / period;
                (number(frequency, with, depth, gravity).ok_or(WaveError::Blocked)?, frequency)
            }
            Measured::Length(_) => return Err(WaveError::Range("length")),
            Measured::Period(_) => return Err(WaveError::Range("period")),
        };
        let limit = STEEPEST * TAU / number * libm::tanh(number * depth);
        if height > limit {
            return Err(WaveError::Breaks { length: TAU / number, limit });
        }
        let intrinsic = intrinsic(number);
        Ok(Wave { amplitude: 0.5 * height, number, frequency, intrinsic, direction: along, phase, depth })
    }

    /// Wavelength [m].
    pub fn length(&self) -> f64 {
        TAU / self.number
    }

    /// Surface and water at `x`, `y`, height `z` above still water [m], `time` [s].
    pub fn at(&self, x: f64, y: f64, z: f64, time: f64) -> Orbit {
        let Wave { amplitude, number: k, frequency, intrinsic, direction: [dx, dy], phase, depth } = *self;
        let (sin, cos) = libm::sincos(k * (x * dx + y * dy) - frequency * time + phase);
        let z = z.clamp(-depth, amplitude);
        // cosh k(z + h)/sinh kh, sinh k(z + h)/sinh kh without overflow.
        let (up, down) = (libm::exp(k * z), libm::exp(-k * (z + 2.0 * depth)));
        let whole = 1.0 - libm::exp(-2.0 * k * depth);
        let (level, upright) = ((up + down) / whole, (up - down) / whole);
        let speed = amplitude * intrinsic;
        let (u, w) = (speed * level * cos, speed * upright * sin);
        let (ux, uz) = (-k * speed * level * sin, k * speed * upright * cos);
        // Material derivative.
        let along = speed * intrinsic * level * sin + u * ux + w * uz;
        let rising = -speed * intrinsic * upright * cos + u * uz - w * ux;
        Orbit {
            elevation: amplitude * cos,
            velocity: Vec3::new(u * dx, u * dy, w),
            acceleration: Vec3::new(along * dx, along * dy, rising),
        }
    }
}

/// Smallest wave number of a frequency; `None` if blocked.
fn number(frequency: f64, with: f64, depth: f64, gravity: f64) -> Option<f64> {
    // Convex, decreasing from k = 0.
    let left = |k: f64| {
        let t = libm::tanh(k * depth);
        let root = (gravity * k * t).sqrt();
        let inner = if depth.is_finite() { k * depth * (1.0 - t * t) } else { 0.0 };
        (frequency - k * with - root, -with - 0.5 * gravity * (t + inner) / root)
    };
    let shallow = frequency / (gravity * depth.min(1e12)).sqrt().max(1e-300);
    let deep = frequency * frequency / gravity;
    let mut k = 1e-3 * shallow.min(deep);
    while left(k).0 < 0.0 {
        k *= 1e-3;
    }
    for _ in 0..200 {
        let (value, slope) = left(k);
        if slope >= 0.0 {
            return None;
        }
        let next = k - value / slope;
        if !next.is_finite() {
            return None;
        }
        if (next - k).abs() <= 1e-15 * next {
            return Some(next);
        }
        k = next;
    }
    Some(k)
}

#[cfg(test)]
#[path = "wave_tests.rs"]
mod tests;
