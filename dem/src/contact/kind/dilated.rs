//! Dilated polyhedra with each other, with boxes, planes and spheres.
//!
//! The rounded corners and edges of either body press into the other (`shape/dilated/press.rs`). A corner is a contact point with the
//! whole stiffness k of the law; an edge has k over [`LENGTH`] times the sum of both radii per unit of length, and is one point too,
//! where its pressure has its centre. With a linear law all of it has a potential, and the force is continuous whatever the
//! bodies do. Crossing edges are then as stiff as crossing cylinders after Hertz at the overlap at which corners are as stiff as
//! spheres, to a factor of four; a face is as stiff as its circumference is long.
//!
//! Memory belongs to corners and edges of bodies, so that no spring has to be handed on. Springs of friction weigh as their points do.
//!
//! Limits: laws whose stiffness depends on the overlap are refused (`engine/check.rs`); a core that another core reaches ends the run.

use super::pair::{PairKind, Touch, Touches};
use super::scene::{Placed, PlaneView};
use super::side::{Planes, Solids, Spheres};
use crate::base::Vec3;
use crate::lanes::record::{Record, xyz};
use crate::law::ContactGeometry;
use crate::shape::dilated::press::{self, HalfSpace, Part, Pressed, Segment, Target};
use crate::shape::dilated::{CORNERS, Core};
use crate::spatial::separation::separation;
use nalgebra::{Rotation3, UnitQuaternion};

/// Length of edge with the stiffness of a corner, over the sum of both radii.
pub(crate) const LENGTH: f64 = 2.0;

/// Share of the sum of both radii above which an overlap has lost its meaning: the cores are about to meet.
const DEEPEST: f64 = 0.9;

/// Contact points of a pair: 10 corners and edges of either body at a face and those that end there.
const POINTS: usize = 40;

/// Two dilated polyhedra, or one and a box.
pub(crate) struct DilatedDilated;

/// A dilated polyhedron and a plane.
pub(crate) struct DilatedPlane;

/// A sphere and a dilated polyhedron.
pub(crate) struct SphereDilated;

/// Corners of a body in another frame.
struct Corners {
    list: [Vec3; CORNERS],
    count: usize,
}

impl Corners {
    fn of(core: &Core, point: impl Fn(&Vec3) -> Vec3) -> Corners {
        let mut list = [Vec3::zeros(); CORNERS];
        for (to, from) in list.iter_mut().zip(&core.corners) {
            *to = point(from);
        }
        Corners { list, count: core.corners.len() }
    }

    fn list(&self) -> &[Vec3] {
        &self.list[..self.count]
    }

    /// The set of those with f(height) true along `n`.
    fn set(points: &[Vec3], n: &Vec3, near: impl Fn(f64) -> bool) -> u64 {
        points.iter().enumerate().map(|(k, p)| u64::from(near(p.dot(n))) << k).sum()
    }

    fn range(points: &[Vec3], n: &Vec3) -> [f64; 2] {
        let h = points.iter().map(|p| p.dot(n));
        h.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], h| [low.min(h), high.max(h)])
    }
}

/// Takes points of one body's frame to another's: both frames have unscaled lengths.
struct Frame {
    turn: Rotation3<f64>,
    way: Vec3,
    scale: f64,
}

impl Frame {
    /// From the frame of `a` to that of `b`.
    fn new(a: &Placed<'_>, b: &Placed<'_>) -> Frame {
        let back: UnitQuaternion<f64> = b.orientation.inverse();
        Frame {
            turn: (back * a.orientation).to_rotation_matrix(),
            way: back * (a.centre - b.centre) / b.scale,
            scale: a.scale / b.scale,
        }
    }

    fn point(&self, x: &Vec3) -> Vec3 {
        self.turn * (x * self.scale) + self.way
    }
}

/// Whether the spheres around two bodies are within `reach` of each other.
fn around(a: &Placed<'_>, b: &Placed<'_>, reach: f64) -> bool {
    let most = a.reach() + b.reach() + reach;
    (a.centre - b.centre).norm_squared() < most * most
}

/// What the corners and edges of a body do to a target: calls `put` with the feature, from 1 on, what it does, and its weight. Only what
/// is below a level along a direction, corners of the set `near` among it, can be within reach.
fn skeleton(
    core: &Core,
    at: &[Vec3],
    (near, n, level): (u64, &Vec3, f64),
    target: &impl Target,
    reach: f64,
    mut put: impl FnMut(u32, &Pressed, f64),
) {
    let part = Part::new(core, near);
    for k in part.corners() {
        if let Some(pressed) = press::corner(target, &at[k], reach) {
            put(k as u32 + 1, &pressed, 1.0);
        }
    }
    for k in part.edges() {
        let [a, b] = core.edges[k].ends.map(|e| at[e as usize]);
        let segment = Segment::new(a, b).below(n, level);
        if let Some(pressed) = press::edge(target, &segment, reach) {
            let weight = pressed.force.norm() / (pressed.overlap * LENGTH * reach);
            put((CORNERS + k) as u32 + 1, &pressed, weight);
        }
    }
}

/// A contact point in the world. `frame` is the body in whose frame the target lies, `own` the radius of what presses [m], in that
/// frame's unit; `sign`: −1 where the first partner is the target.
fn touch(
    frame: &Placed<'_>,
    feature: u32,
    p: &Pressed,
    weight: f64,
    [own, reach, radius]: [f64; 3],
    sign: f64,
) -> Touch {
    let n = p.force.normalize();
    // Half of the overlap below the surface.
    let point = p.point - n * (own - 0.5 * p.overlap);
    let geometry = ContactGeometry {
        point: frame.centre + frame.orientation * (point * frame.scale),
        normal: frame.orientation * n * sign,
        overlap: p.overlap * frame.scale,
        radius,
    };
    let couple = frame.orientation * p.couple * (sign * frame.scale);
    Touch { feature, geometry, weight, bound: DEEPEST * reach * frame.scale, couple }
}

/// Effective radius of two.
fn effective(a: f64, b: f64) -> f64 {
    if a > 0.0 && b > 0.0 { a * b / (a + b) } else { a.max(b) }
}

/// What is left to say where cores overlap: too much of it.
fn lost(point: Vec3, normal: Vec3, reach: f64) -> Touch {
    let geometry = ContactGeometry { point, normal, overlap: reach, radius: reach };
    Touch::only(geometry, DEEPEST * reach)
}

impl PairKind for DilatedDilated {
    type First = Solids;
    type Second = Solids;
    const POINTS: usize = POINTS;
    const SHARED: bool = true;

    fn near(&self, first: &Placed<'_>, second: &Placed<'_>, reach: f64) -> bool {
        if !(first.dilated() || second.dilated()) || !around(first, second, reach) {
            return false;
        }
        let frame = Frame::new(first, second);
        let corners = Corners::of(first.core, |x| frame.point(x));
        let found = separation(corners.list(), &second.core.corners);
        found.is_none_or(|(_, apart)| apart * second.scale < first.radius + second.radius + reach)
    }

    fn touches(&self, a: &Placed<'_>, b: &Placed<'_>, found: &mut Touches) {
        if !around(a, b, 0.0) {
            return;
        }
        let (to_b, to_a) = (Frame::new(a, b), Frame::new(b, a));
        let corners = Corners::of(a.core, |x| to_b.point(x));
        let others = &b.core.corners;
        let sum = a.radius + b.radius;
        let reach = sum / b.scale;
        let Some((n, apart)) = separation(corners.list(), others) else {
            let way = a.centre - b.centre;
            found.push(lost((a.centre + b.centre) * 0.5, way.try_normalize(0.0).unwrap_or(Vec3::z()), sum));
            return;
        };
        if apart >= reach {
            return;
        }
        // A point of one body that is nearer to the other than `reach` is so along any direction.
        let [low, _] = Corners::range(corners.list(), &n);
        let [_, high] = Corners::range(others, &n);
        let level = high + reach;
        let near_a = Corners::set(corners.list(), &n, |h| h < level);
        let near_b = Corners::set(others, &n, |h| h > low - reach);
        let radius = effective(a.radius, b.radius);
        skeleton(
            a.core,
            corners.list(),
            (near_a, &n, level),
            &Part::new(b.core, near_b),
            reach,
            |feature, pressed, weight| {
                found.push(touch(
                    b,
                    feature << 16,
                    pressed,
                    weight,
                    [a.radius / b.scale, reach, radius],
                    1.0,
                ));
            },
        );
        let corners = Corners::of(b.core, |x| to_a.point(x));
        let reach = sum / a.scale;
        // The same direction, turned about, in the frame of the first.
        let n = -(to_a.turn * n);
        let level = Corners::range(&a.core.corners, &n)[1] + reach;
        skeleton(
            b.core,
            corners.list(),
            (near_b, &n, level),
            &Part::new(a.core, near_a),
            reach,
            |feature, pressed, weight| {
                found.push(touch(a, feature, pressed, weight, [b.radius / a.scale, reach, radius], -1.0));
            },
        );
        found.truncate(POINTS);
    }
}

impl PairKind for DilatedPlane {
    type First = Solids;
    type Second = Planes;
    const POINTS: usize = POINTS;
    const SHARED: bool = true;

    fn near(&self, body: &Placed<'_>, plane: &PlaneView, reach: f64) -> bool {
        body.dilated()
            && !plane.open
            && (body.centre - plane.origin).dot(&plane.normal) < body.reach() + reach
    }

    fn touches(&self, body: &Placed<'_>, plane: &PlaneView, found: &mut Touches) {
        let height = (body.centre - plane.origin).dot(&plane.normal);
        if height >= body.reach() {
            return;
        }
        let back = body.orientation.inverse();
        let normal = back * plane.normal;
        let below = HalfSpace { point: normal * (-height / body.scale), normal };
        let (reach, corners) = (body.radius / body.scale, &body.core.corners);
        let level = below.point.dot(&normal) + reach;
        let near = Corners::set(corners, &normal, |h| h < level);
        skeleton(body.core, corners, (near, &normal, level), &below, reach, |feature, pressed, weight| {
            found.push(touch(body, feature << 16, pressed, weight, [reach, reach, body.radius], 1.0));
        });
        found.truncate(POINTS);
    }
}

impl PairKind for SphereDilated {
    type First = Spheres;
    type Second = Solids;
    const POINTS: usize = 1;

    fn near(&self, sphere: &&Record, body: &Placed<'_>, reach: f64) -> bool {
        if !body.dilated() {
            return false;
        }
        let (p, most) = (xyz(sphere), sphere[3] + body.radius + reach);
        let local = body.orientation.inverse() * (p - body.centre) / body.scale;
        let outside = body.core.faces.iter().map(|f| f.normal.dot(&local) - f.offset);
        outside.fold(f64::NEG_INFINITY, f64::max) * body.scale < most
    }

    fn touches(&self, sphere: &&Record, body: &Placed<'_>, found: &mut Touches) {
        if !body.dilated() {
            return;
        }
        let (p, sum) = (xyz(sphere), sphere[3] + body.radius);
        let local = body.orientation.inverse() * (p - body.centre) / body.scale;
        let highest =
            body.core.faces.iter().map(|f| f.normal.dot(&local) - f.offset).fold(f64::NEG_INFINITY, f64::max);
        let reach = sum / body.scale;
        if highest >= reach {
            return;
        }
        let Some(pressed) = press::corner(&Part::all(body.core), &local, reach) else {
            if highest <= 0.0 {
                let way = (p - body.centre).try_normalize(0.0).unwrap_or(Vec3::z());
                found.push(lost(p, way, sum));
            }
            return;
        };
        let own = sphere[3] / body.scale;
        let radius = effective(sphere[3], body.radius);
        // A sphere may sink into a face as deep as into another sphere.
        found.push(Touch { bound: sum, ..touch(body, 0, &pressed, 1.0, [own, reach, radius], 1.0) });
    }
}

#[cfg(test)]
#[path = "dilated_tests.rs"]
mod tests;
