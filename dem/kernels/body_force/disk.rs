//! Part of a dilated disk below a plane, at any tilt.
//!
//! Slices across the axis are circular segments; Gauss's rule runs between slices tangent to the plane.

use super::skin::Wet;
use crate::base::Vec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Gauss's rule on [−1, 1]: positive half of points, with weights.
const RULE: [[f64; 2]; 8] = [
    [0.095_012_509_837_637_44, 0.189_450_610_455_068_5],
    [0.281_603_550_779_258_9, 0.182_603_415_044_923_58],
    [0.458_016_777_657_227_37, 0.169_156_519_395_002_54],
    [0.617_876_244_402_643_7, 0.149_595_988_816_576_73],
    [0.755_404_408_355_003, 0.124_628_971_255_533_87],
    [0.865_631_202_387_831_7, 0.095_158_511_682_492_78],
    [0.944_575_023_073_232_6, 0.062_253_523_938_647_89],
    [0.989_400_934_991_649_9, 0.027_152_459_411_754_095],
];

/// Slope of a plane normal to the axis.
const LEVEL: f64 = 1e-12;

/// Disk, and plane n·x = `level`, n = (`slope`, 0, `up`).
struct Cut {
    big: f64,
    r: f64,
    slope: f64,
    up: f64,
    level: f64,
    /// `along`: size and angle across the axis; axial part.
    across: f64,
    angle: f64,
    axial: f64,
}

#[derive(Default)]
struct Sum {
    volume: f64,
    /// First moments across and along the axis.
    aside: f64,
    high: f64,
    area: f64,
    /// Projected area: absolute and signed.
    seen: f64,
    signed: f64,
}

/// Part below up·x = `level` of a disk of radius `big`, dilated by `r` [m]; projected along `along`.
pub(super) fn below([big, r]: [f64; 2], up: &Vec3, level: f64, along: &Vec3) -> Wet {
    let slope = libm::hypot(up.x, up.y);
    if level <= -(slope * big + r) {
        return Wet::default();
    }
    let (x, y) = if slope > LEVEL { (up.x / slope, up.y / slope) } else { (1.0, 0.0) };
    let [ax, ay] = [along.x * x + along.y * y, along.y * x - along.x * y];
    let cut = Cut {
        big,
        r,
        slope: slope.max(LEVEL),
        up: up.z,
        level,
        across: libm::hypot(ax, ay),
        angle: libm::atan2(ay, ax),
        axial: along.z,
    };
    let mut sum = Sum::default();
    let places = cut.places();
    for ends in places.windows(2) {
        cut.strip([ends[0], ends[1]], &mut sum);
    }
    for z in [-r, r] {
        let beta = cut.dry(z, big);
        let area = big * big * (PI - beta + 0.5 * libm::sin(2.0 * beta));
        sum.area += area;
        sum.seen += area * along.z.abs();
        sum.signed += area * along.z * z.signum();
    }
    if sum.volume <= 0.0 {
        return Wet::default();
    }
    let [aside, high] = [sum.aside, sum.high].map(|m| m / sum.volume);
    let arm = Vec3::new(aside * x, aside * y, high);
    Wet { volume: sum.volume, arm, area: sum.area, seen: 0.5 * (sum.seen + sum.signed.abs()) }
}

impl Cut {
    /// Ascending latitudes where slices touch the plane, and both ends.
    fn places(&self) -> arrayvec::ArrayVec<f64, 6> {
        let tilt = libm::atan2(self.slope, self.up);
        let mut places = arrayvec::ArrayVec::new();
        places.push(-FRAC_PI_2);
        for side in [1.0, -1.0] {
            // level = up r sin φ ± slope (R + r cos φ).
            let q = (self.level - side * self.slope * self.big) / self.r;
            if q.abs() >= 1.0 {
                continue;
            }
            let angle = libm::asin(q);
            for at in [angle - side * tilt, PI - angle - side * tilt] {
                let at = at - TAU * (at / TAU).round();
                if at.abs() < FRAC_PI_2 {
                    places.push(at);
                }
            }
        }
        places.push(FRAC_PI_2);
        places.sort_by(f64::total_cmp);
        places
    }

    /// Half angle above the plane, at height z on the axis.
    fn dry(&self, z: f64, radius: f64) -> f64 {
        libm::acos(((self.level - self.up * z) / (self.slope * radius)).clamp(-1.0, 1.0))
    }

    fn strip(&self, [from, to]: [f64; 2], sum: &mut Sum) {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let (sine, cosine) = libm::sincos(middle);
        if half <= 0.0 || self.dry(self.r * sine, self.big + self.r * cosine) >= PI {
            return;
        }
        for [x, w] in RULE {
            for x in [-x, x] {
                let (s, c) = libm::sincos(FRAC_PI_2 * (1.0 + x));
                self.slice(middle - half * c, w * FRAC_PI_2 * half * s, sum);
            }
        }
    }

    fn slice(&self, latitude: f64, width: f64, sum: &mut Sum) {
        let (sine, cosine) = libm::sincos(latitude);
        let (z, radius) = (self.r * sine, self.big + self.r * cosine);
        let beta = self.dry(z, radius);
        let (sb, cb) = libm::sincos(beta);
        let thick = self.r * cosine * width;
        let area = radius * radius * (PI - beta + sb * cb);
        sum.volume += area * thick;
        sum.aside -= 2.0 / 3.0 * (radius * sb).powi(3) * thick;
        sum.high += z * area * thick;
        // Normal: (cos φ cos θ, cos φ sin θ, sin φ).
        let strip = self.r * radius * width;
        sum.area += strip * (TAU - 2.0 * beta);
        let (round, flat) = (cosine * self.across, sine * self.axial);
        let whole = |theta: f64| round * libm::sin(theta - self.angle) + flat * theta;
        let [first, last] = [beta, TAU - beta].map(whole);
        sum.signed += strip * (last - first);
        if flat.abs() >= round {
            sum.seen += strip * (last - first).abs();
            return;
        }
        let turn = libm::acos(-flat / round);
        let mut at = [self.angle - turn, self.angle + turn].map(|t| t - TAU * (t / TAU).floor());
        at.sort_by(f64::total_cmp);
        let mut before = first;
        for theta in at.into_iter().filter(|t| *t > beta && *t < TAU - beta) {
            let here = whole(theta);
            sum.seen += strip * (here - before).abs();
            before = here;
        }
        sum.seen += strip * (last - before).abs();
    }
}

#[cfg(test)]
#[path = "disk_tests.rs"]
mod tests;
