//! Dilated disks: the core is a flat disk across axis 3 with its rim as only edge.
//!
//! Theory manual: equation (2.10) of `docs/theory/shapes.md`.

use crate::base::Vec3;
use std::f64::consts::{PI, TAU};

/// Rim arcs, each a separate contact.
pub(super) const ARCS: usize = 8;

/// Rendering strips and points of the rim.
const STRIPS: usize = 4;
const AROUND: usize = 36;

/// Volume [m³], area [m²], moments of inertia per unit density about diameter and axis [m⁵]; disk radius
/// `big`, rounding `r` [m].
pub(super) fn moments(big: f64, r: f64) -> [f64; 4] {
    let (r2, r3) = (r * r, r * r * r);
    let volume = PI * (2.0 * r * big * big + PI * big * r2 + 4.0 / 3.0 * r3);
    let area = TAU * big * big + 2.0 * PI * PI * big * r + 4.0 * PI * r2;
    let fourth = 2.0 * r * big.powi(4)
        + 2.0 * PI * big.powi(3) * r2
        + 8.0 * big * big * r3
        + 1.5 * PI * big * r3 * r
        + 16.0 / 15.0 * r3 * r2;
    let across = 2.0 / 3.0 * big * big * r3 + 0.25 * PI * big * r3 * r + 4.0 / 15.0 * r3 * r2;
    let axial = 0.5 * PI * fourth;
    let other = 0.25 * PI * fourth + PI * across;
    [volume, area, other, axial]
}

/// Rendering surface: points and polygons.
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

/// Support point of a flat disk.
#[inline]
pub fn farthest(radius: f64, n: &Vec3) -> Vec3 {
    let across = libm::hypot(n.x, n.y);
    let out = if across > 0.0 { radius / across } else { 0.0 };
    Vec3::new(n.x * out, n.y * out, 0.0)
}

/// Vector from the closest disk point, in the disk frame.
pub fn offset_from_disk(radius: f64, p: &Vec3) -> Vec3 {
    let square = p.x * p.x + p.y * p.y;
    if square <= radius * radius {
        return Vec3::new(0.0, 0.0, p.z);
    }
    let inner = 1.0 - radius / square.sqrt();
    Vec3::new(p.x * inner, p.y * inner, p.z)
}

/// Distance and direction from a flat disk; any direction inside.
pub(super) fn distance(radius: f64, p: &Vec3) -> (f64, Vec3) {
    let way = offset_from_disk(radius, p);
    let d = way.norm();
    if d > 0.0 { (d, way / d) } else { (0.0, Vec3::z()) }
}

#[cfg(test)]
#[path = "disk_tests.rs"]
mod tests;
