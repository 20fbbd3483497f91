//! Dilated disks: a flat circular disk, rolled over by a sphere. The core is the disk, across the third axis; its rim is the only edge.

use super::press::{Nearest, Segment, Stretch};
use super::rim::{self, Circle, Turns};
use super::scan::{self, Places};
use super::{Core, Dilated, DilatedError};
use crate::base::Vec3;
use std::f64::consts::{PI, TAU};

/// Strips of the rim and points around it in pictures.
const STRIPS: usize = 4;
const AROUND: usize = 36;

impl Core {
    /// A flat disk about the third axis, of a radius [m].
    pub fn disk(radius: f64) -> Core {
        Core { rim: Some(radius), reach: radius, ..Core::default() }
    }
}

impl Dilated {
    /// A disk of a radius [m], rolled over by a sphere of another: its diameter is twice the sum of both, its thickness twice the latter.
    ///
    /// # Errors
    /// [`DilatedError`] for radii that are not positive and finite.
    pub fn disk(radius: f64, rounding: f64) -> Result<Dilated, DilatedError> {
        let (big, r) = (radius, rounding);
        if !(big.is_finite() && r.is_finite()) {
            return Err(DilatedError::NotFinite);
        }
        for x in [big, r] {
            if x <= 0.0 {
                return Err(DilatedError::Radius(x));
            }
        }
        let (r2, r3) = (r * r, r * r * r);
        // By slices: circles of radius R + √(r² − z²).
        let volume = PI * (2.0 * r * big * big + PI * big * r2 + 4.0 / 3.0 * r3);
        let area = TAU * big * big + 2.0 * PI * PI * big * r + 4.0 * PI * r2;
        // ∫ ρ⁴ dz and ∫ z² ρ² dz.
        let fourth = 2.0 * r * big.powi(4)
            + 2.0 * PI * big.powi(3) * r2
            + 8.0 * big * big * r3
            + 1.5 * PI * big * r3 * r
            + 16.0 / 15.0 * r3 * r2;
        let across = 2.0 / 3.0 * big * big * r3 + 0.25 * PI * big * r3 * r + 4.0 / 15.0 * r3 * r2;
        let axial = 0.5 * PI * fourth;
        let other = 0.25 * PI * fourth + PI * across;
        Ok(Dilated { core: Core::disk(big), radius: r, volume, area, inertia: [other, other, axial] })
    }
}

/// The surface of a dilated disk for pictures: points, which lie on it, and polygons.
pub(super) fn outline(big: f64, r: f64) -> (Vec<Vec3>, Vec<Vec<u32>>) {
    let mut points = Vec::with_capacity((STRIPS + 1) * AROUND);
    for i in 0..=STRIPS {
        let (up, out) = libm::sincos(PI * (i as f64 / STRIPS as f64 - 0.5));
        for k in 0..AROUND {
            let (y, x) = libm::sincos(TAU * k as f64 / AROUND as f64);
            let rho = big + r * out.max(0.0);
            points.push(Vec3::new(rho * x, rho * y, r * up));
        }
    }
    let at = |i: usize, k: usize| (i * AROUND + k % AROUND) as u32;
    let mut polygons = vec![
        (0..AROUND).rev().map(|k| at(0, k)).collect::<Vec<_>>(),
        (0..AROUND).map(|k| at(STRIPS, k)).collect(),
    ];
    for i in 0..STRIPS {
        polygons.extend((0..AROUND).map(|k| vec![at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)]));
    }
    (points, polygons)
}

/// The point of a flat disk that is farthest along a direction.
#[inline]
pub(crate) fn farthest(radius: f64, n: &Vec3) -> Vec3 {
    let across = libm::hypot(n.x, n.y);
    let out = if across > 0.0 { radius / across } else { 0.0 };
    Vec3::new(n.x * out, n.y * out, 0.0)
}

/// The way from the nearest point of a flat disk to a point, in the disk's frame.
pub(crate) fn way(radius: f64, p: &Vec3) -> Vec3 {
    let square = p.x * p.x + p.y * p.y;
    if square <= radius * radius {
        return Vec3::new(0.0, 0.0, p.z);
    }
    let inner = 1.0 - radius / square.sqrt();
    Vec3::new(p.x * inner, p.y * inner, p.z)
}

/// Distance of a point from a flat disk, and its direction; where it lies in the disk, any.
fn distance(radius: f64, p: &Vec3) -> (f64, Vec3) {
    let way = way(radius, p);
    let d = way.norm();
    if d > 0.0 { (d, way / d) } else { (0.0, Vec3::z()) }
}

/// A flat disk as what is pressed into: see [`super::press::Target`].
pub(crate) struct Flat(pub f64);

impl Flat {
    pub fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)> {
        Some(distance(self.0, p)).filter(|(d, _)| *d < reach && *d > 0.0)
    }

    pub fn stretches(&self, segment: &Segment, reach: f64, mut f: impl FnMut([f64; 2], &Nearest)) {
        let Segment { from, direction, range, .. } = segment;
        // Where its distance from the axis is the radius, and where it passes through the plane.
        let a = direction.x * direction.x + direction.y * direction.y;
        let b = from.x * direction.x + from.y * direction.y;
        let c = from.x * from.x + from.y * from.y - self.0 * self.0;
        let mut places = Places::new();
        let root = b * b - a * c;
        if root > 0.0 {
            let q = -(b + root.sqrt().copysign(b));
            places.extend([q / a, c / q]);
        }
        places.push(-from.z / direction.z);
        places.retain(|s| *s > range[0] && *s < range[1]);
        places.sort_by(f64::total_cmp);
        let at = |s: f64| distance(self.0, &(from + direction * s));
        scan::between(*range, &places, |[low, high]| {
            let middle = from + direction * (0.5 * (low + high));
            if middle.x * middle.x + middle.y * middle.y <= self.0 * self.0 {
                let normal = Vec3::new(0.0, 0.0, middle.z.signum());
                let (at, slope) = (normal.z * from.z, normal.z * direction.z);
                let mut stretch = Stretch([low, high]);
                stretch.cut(at - reach, slope);
                if stretch.some() {
                    f(stretch.0, &Nearest::Plane { normal, at, slope });
                }
                return;
            }
            // Along a line the distance has one least value.
            let gap = |s: f64| {
                let (d, n) = at(s);
                [d - reach, n.dot(direction)]
            };
            scan::below([low, high], [low, high], &gap, |part| f(part, &Nearest::Curve(&at)));
        });
    }

    pub fn turns(
        &self,
        circle: &Circle,
        turns: &Turns,
        reach: f64,
        mut f: impl FnMut([f64; 2], &dyn Fn(&Vec3) -> (f64, Vec3)),
    ) {
        let outside = |t: f64| {
            let (p, slope) = circle.moving(t);
            [p.x * p.x + p.y * p.y - self.0 * self.0, 2.0 * (p.x * slope.x + p.y * slope.y)]
        };
        let at = |p: &Vec3| distance(self.0, p);
        for &range in &turns.0 {
            let mut places = Places::new();
            scan::roots(rim::ends(range), &outside, &mut places);
            scan::between(range, &places, |part| {
                let middle = 0.5 * (part[0] + part[1]);
                if outside(middle)[0] > 0.0 {
                    return circle.near(part, reach, &at, |part| f(part, &at));
                }
                // A circle that does not meet the disk is on one side of it there.
                let normal = Vec3::new(0.0, 0.0, circle.at(middle).z.signum());
                let mut over = Turns::of(part);
                over.cut(circle.along(&normal, reach));
                over.0.iter().for_each(|part| f(*part, &|p: &Vec3| (normal.z * p.z, normal)));
            });
        }
    }
}

#[cfg(test)]
#[path = "disk_tests.rs"]
mod tests;
