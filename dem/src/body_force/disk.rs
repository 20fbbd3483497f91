//! What of a dilated disk is below a plane, at any tilt: slices across its axis are circles that the plane cuts segments from. They are summed up
//! by a rule of Gauss between the slices that the plane only touches, which are known in closed form, in a variable in which the sums are smooth
//! there too.

use super::skin::Wet;
use crate::base::Vec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Half of the points and weights of Gauss's rule on [−1, 1]; the others lie opposite.
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

/// Slope below which a plane counts as lying across the axis.
const LEVEL: f64 = 1e-12;

/// A dilated disk, and a plane normal to (`slope`, 0, `up`) at `level` along it, both of length one; areas are seen along `along`.
struct Cut {
    big: f64,
    r: f64,
    slope: f64,
    up: f64,
    level: f64,
    /// Size and angle of the part of `along` across the axis, and the part along it.
    across: f64,
    angle: f64,
    axial: f64,
}

/// Sums over what is below.
#[derive(Default)]
struct Sum {
    volume: f64,
    /// First moments across and along the axis.
    aside: f64,
    high: f64,
    area: f64,
    /// Areas as seen, and with their sign.
    seen: f64,
    signed: f64,
}

/// What of a disk of radius `big`, dilated by `r` [m], lies below the plane that is normal to the unit vector `up` at `level` along it [m];
/// its areas as seen along the unit vector `along`.
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
    /// Angles of latitude on the rounding at which the plane touches slices, with both ends, in order.
    fn places(&self) -> arrayvec::ArrayVec<f64, 6> {
        let tilt = libm::atan2(self.slope, self.up);
        let mut places = arrayvec::ArrayVec::new();
        places.push(-FRAC_PI_2);
        for side in [1.0, -1.0] {
            // Where level = up r sin φ ± slope (R + r cos φ).
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

    /// Half of the angle that is above the plane of a circle at a height z along the axis.
    fn dry(&self, z: f64, radius: f64) -> f64 {
        libm::acos(((self.level - self.up * z) / (self.slope * radius)).clamp(-1.0, 1.0))
    }

    /// Adds the slices between two latitudes.
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

    /// Adds a slice at a latitude of some width.
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
        // The rim has the normal (cos φ cos θ, cos φ sin θ, sin φ).
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
