//! Irregularity of the rail: height of its running surface.

use std::f64::consts::TAU;

/// Dipped joint: two parabolas that meet in a kink.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dip {
    /// Position of the kink [m].
    pub at: f64,
    /// Depth there [m].
    pub depth: f64,
    /// Length of the dip [m].
    pub length: f64,
}

impl Dip {
    /// Angle between the two ramps at the kink [rad]: 8 × depth / length.
    pub fn angle(&self) -> f64 {
        8.0 * self.depth / self.length
    }

    fn height(&self, x: f64) -> f64 {
        let beside = 1.0 - 2.0 * (x - self.at).abs() / self.length;
        -self.depth * beside.max(0.0).powi(2)
    }
}

/// Sum of waves, dipped joints and a measured profile.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Irregularity {
    /// Wavelength and amplitude [m].
    pub waves: Vec<[f64; 2]>,
    /// Dipped joints.
    pub dips: Vec<Dip>,
    /// Position, ascending, and height [m]; 0 beyond the ends.
    pub profile: Vec<(f64, f64)>,
}

impl Irregularity {
    /// Height at `x` from the first sleeper [m].
    pub fn height(&self, x: f64) -> f64 {
        let waves: f64 = self.waves.iter().map(|[length, a]| a * libm::sin(TAU * x / length)).sum();
        let dips: f64 = self.dips.iter().map(|dip| dip.height(x)).sum();
        waves + dips + self.measured(x)
    }

    fn measured(&self, x: f64) -> f64 {
        let k = self.profile.partition_point(|p| p.0 <= x);
        match (k.checked_sub(1).map(|k| self.profile[k]), self.profile.get(k)) {
            (Some(a), Some(b)) => a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0),
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_add() {
        let dip = Dip { at: 1.0, depth: 2e-3, length: 0.8 };
        let profile = vec![(0.0, 0.0), (1.0, 4e-3), (2.0, 0.0)];
        let all = Irregularity { waves: vec![[4.0, 1e-3]], dips: vec![dip], profile };
        assert!((all.height(1.0) - (1e-3 - 2e-3 + 4e-3)).abs() < 1e-15);
        assert!((all.height(1.2) - (1e-3 * (TAU * 0.3).sin() - 0.5e-3 + 3.2e-3)).abs() < 1e-15);
        assert!((all.height(3.0) + 1e-3).abs() < 1e-15, "only the wave");
        let slope = |x: f64| (dip.height(x + 1e-6) - dip.height(x)) / 1e-6;
        assert!((slope(1.0) - slope(1.0 - 1e-6) - dip.angle()).abs() < 1e-5 * dip.angle());
    }
}
