//! Closest points of round patches (truncated cones, rings, discs, spheres) and planes.
//!
//! A frustum is two patches: near generator, on the point's side of the axis, and far generator. A ball
//! larger than its ring touches all around: both contacts together have a smooth potential across the axis.

use super::bvh::Aabb;
use crate::base::Vec3;

/// Bounds of an infinite plane [m].
const WORLD: f64 = 1e30;
/// Relative distance from the axis without a defined direction.
const ON_AXIS: f64 = 1e-13;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    Inside,
    /// First or second rim.
    Rim(usize),
    Apex,
    /// Hidden by the wall.
    Hidden,
}

pub type Closest = (Vec3, Vec3, Part);

/// In the wall frame.
#[derive(Clone, Debug)]
pub enum Round {
    Plane { point: Vec3, normal: Vec3 },
    Frustum { base: Vec3, axis: Vec3, height: f64, radii: [f64; 2], far: bool },
    Disc { centre: Vec3, axis: Vec3, radius: f64 },
    Sphere { centre: Vec3, radius: f64 },
}

impl Round {
    /// Closest point, or [`Part::Hidden`].
    #[inline]
    pub fn closest(&self, x: &Vec3) -> Closest {
        match self {
            Round::Plane { point, normal } => (x - normal * (x - point).dot(normal), *normal, Part::Inside),
            Round::Frustum { base, axis, height, radii, far } => {
                let (p, n, part) = frustum(&(x - base), axis, *height, radii, *far);
                (p + base, n, part)
            }
            Round::Disc { centre, axis, radius } => {
                let d = x - centre;
                let along = d.dot(axis);
                let across = d - axis * along;
                let rho = across.norm();
                if rho <= *radius {
                    (x - axis * along, *axis, Part::Inside)
                } else {
                    (centre + across * (radius / rho), *axis, Part::Rim(0))
                }
            }
            Round::Sphere { centre, radius } => {
                let d = x - centre;
                let rho = d.norm();
                let outward = if rho > ON_AXIS * radius { d / rho } else { Vec3::z() };
                (centre + outward * *radius, outward, Part::Inside)
            }
        }
    }

    pub fn bounds(&self) -> Aabb {
        let ring = |c: &Vec3, k: &Vec3, r: f64| {
            let half = k.map(|k| r * (1.0 - k * k).max(0.0).sqrt());
            (c - half, c + half)
        };
        let (lo, hi) = match self {
            Round::Plane { .. } => (Vec3::repeat(-WORLD), Vec3::repeat(WORLD)),
            Round::Frustum { base, axis, height, radii, .. } => {
                let (a, b) = (ring(base, axis, radii[0]), ring(&(base + axis * *height), axis, radii[1]));
                (a.0.inf(&b.0), a.1.sup(&b.1))
            }
            Round::Disc { centre, axis, radius } => ring(centre, axis, *radius),
            Round::Sphere { centre, radius } => (centre.add_scalar(-radius), centre.add_scalar(*radius)),
        };
        (lo.into(), hi.into())
    }

    /// Grains are on the outward side only.
    pub fn one_sided(&self) -> bool {
        matches!(self, Round::Plane { .. })
    }

    /// Corners and edge length [m] in contact with a flat body on it.
    pub fn flattest(&self) -> [f64; 2] {
        match self {
            Round::Disc { radius, .. } => [0.0, std::f64::consts::TAU * radius],
            Round::Sphere { .. } => [1.0, 0.0],
            Round::Plane { .. } | Round::Frustum { .. } => [0.0; 2],
        }
    }

    /// Returns true if rotation about `centre` along `spin` maps the patch to itself.
    pub fn unmoved_by(&self, centre: &Vec3, spin: &Vec3) -> bool {
        let along = |axis: &Vec3| spin.cross(axis).norm() <= 1e-12 * spin.norm();
        match self {
            Round::Plane { normal, .. } => along(normal),
            Round::Frustum { base, axis, radii, .. } => {
                along(axis) && (base - centre).cross(axis).norm() <= 1e-12 * radii[0].max(radii[1])
            }
            Round::Disc { centre: c, axis, radius } => {
                along(axis) && (c - centre).cross(axis).norm() <= 1e-12 * radius
            }
            Round::Sphere { centre: c, radius } => {
                (c - centre).cross(spin).norm() <= 1e-12 * radius * spin.norm()
            }
        }
    }
}

/// Base at the origin.
#[inline]
fn frustum(x: &Vec3, axis: &Vec3, height: f64, radii: &[f64; 2], far: bool) -> Closest {
    let z = x.dot(axis);
    let across = x - axis * z;
    let rho = across.norm();
    let outward = if rho > ON_AXIS * (radii[0] + radii[1]) {
        across / rho
    } else {
        let helper = if axis.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() };
        axis.cross(&helper).normalize()
    };
    let run = radii[1] - radii[0];
    let length2 = run * run + height * height;
    let length = length2.sqrt();
    let normal = |side: &Vec3| (side * height - axis * run) / length;
    let at = |s: f64| {
        let t = (((s - radii[0]) * run + z * height) / length2).clamp(0.0, 1.0);
        let end = if t <= 0.0 { Some(0) } else { (t >= 1.0).then_some(1) };
        let part = match end {
            None => Part::Inside,
            Some(k) if radii[k] == 0.0 => Part::Apex,
            Some(k) => Part::Rim(k),
        };
        (radii[0] + t * run, t * height, part)
    };
    let point = |side: &Vec3, r: f64, h: f64, part: Part| match part {
        Part::Inside => side * r + axis * h,
        Part::Rim(k) => side * radii[k] + axis * if k == 0 { 0.0 } else { height },
        Part::Apex => axis * h,
        Part::Hidden => side * r + axis * h,
    };
    let (r, h, part) = at(rho);
    if !far {
        return (point(&outward, r, h, part), normal(&outward), part);
    }
    let outside = part == Part::Inside && (rho - r) * height - (z - h) * run > 0.0;
    let (r, h, part) = at(-rho);
    let side = -outward;
    let seen = if outside || rho >= r { Part::Hidden } else { part };
    (point(&side, r, h, part), normal(&side), seen)
}

#[cfg(test)]
#[path = "round_tests.rs"]
mod tests;
