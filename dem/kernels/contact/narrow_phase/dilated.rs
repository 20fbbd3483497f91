//! Dilated polyhedra against each other, boxes, planes and spheres.
//!
//! Rounded corners and edges indent the other body (`shape/dilated/edge_contact.rs`): corners with the law's
//! stiffness k, edges with k over [`LENGTH`] times the sum of radii, per unit length. With a linear law the
//! force has a potential. History belongs to features.
//!
//! Limits: of laws with overlap-dependent stiffness only Hertz's, by edge laws (`law/line_contact.rs`).

use super::pair::{Manifold, PairContactPoint, ShapePair};
use super::scene::{PlaneView, Pose, PosedBody};
use super::side::{Planes, Solids, Spheres};
use crate::base::Vec3;
use crate::lanes::vec4::{Vec4, xyz};
use crate::law::ContactGeometry;
use crate::pairs::list::Hint;
use crate::shape::dilated::circle::Circle;
use crate::shape::dilated::edge_contact::{self, HalfSpace, Indentation, Segment, Target};
use crate::shape::dilated::part::{Bounds, Part, View};
use crate::shape::dilated::rim;
use crate::shape::dilated::{CORNERS, Core, disk, farthest};
use crate::spatial::separation::separation;
use arrayvec::ArrayVec;
use nalgebra::{Rotation3, UnitQuaternion};

/// Edge length of a corner's stiffness, over the sum of radii.
pub const LENGTH: f64 = 2.0;

/// Overlap limit over the sum of radii.
pub const DEEPEST: f64 = 0.9;

/// Distance loss over the sum of radii before a new direction search.
const STALE: f64 = 0.05;

pub(super) const ROUNDING: f64 = 1e-6;

/// Two dilated bodies, or one and a box.
pub struct DilatedDilated;

pub struct DilatedPlane;

pub struct SphereDilated;

/// Transform between body frames in unscaled lengths.
pub(super) struct Frame {
    pub turn: Rotation3<f64>,
    pub way: Vec3,
    pub scale: f64,
}

impl Frame {
    /// From `a` to `b`.
    pub fn new(a: &Pose, b: &Pose) -> Frame {
        let back: UnitQuaternion<f64> = b.orientation.inverse();
        Frame {
            turn: (back * a.orientation).to_rotation_matrix(),
            way: back * (a.centre - b.centre) / b.scale,
            scale: a.scale / b.scale,
        }
    }

    fn same() -> Frame {
        Frame { turn: Rotation3::identity(), way: Vec3::zeros(), scale: 1.0 }
    }

    pub fn point(&self, x: &Vec3) -> Vec3 {
        self.turn * (x * self.scale) + self.way
    }
}

/// Corner heights along a direction, in the second's frame.
pub(super) struct Heights {
    pub n: Vec3,
    pub first: ArrayVec<f64, CORNERS>,
    pub second: ArrayVec<f64, CORNERS>,
    /// First's minimum, second's maximum.
    pub low: f64,
    pub high: f64,
}

impl Heights {
    pub fn new() -> Heights {
        let [first, second] = [ArrayVec::new(), ArrayVec::new()];
        Heights { n: Vec3::zeros(), first, second, low: 0.0, high: 0.0 }
    }

    fn take(&mut self, two: &Two<'_>, n: Vec3) {
        let own = two.frame.turn.inverse_transform_vector(&n) * two.frame.scale;
        let aside = n.dot(&two.frame.way);
        (self.n, self.low, self.high) = (n, f64::INFINITY, f64::NEG_INFINITY);
        self.first.clear();
        for x in two.first.corners {
            let h = own.dot(x) + aside;
            self.low = if h < self.low { h } else { self.low };
            self.first.push(h);
        }
        self.second.clear();
        for x in two.second.corners {
            let h = n.dot(x);
            self.high = if h > self.high { h } else { self.high };
            self.second.push(h);
        }
        if let Some(radius) = two.first.rim {
            self.low = aside - radius * libm::hypot(own.x, own.y);
        }
        if let Some(radius) = two.second.rim {
            self.high = radius * libm::hypot(n.x, n.y);
        }
    }
}

/// Hull: corners, or a flat disk.
#[derive(Clone, Copy)]
pub(super) struct Hull<'a> {
    pub corners: &'a [Vec3],
    pub rim: Option<f64>,
}

impl<'a> Hull<'a> {
    pub fn of(core: &'a Core) -> Hull<'a> {
        Hull { corners: &core.corners, rim: core.rim }
    }

    fn farthest(&self, n: &Vec3) -> Vec3 {
        match self.rim {
            None => *farthest(self.corners, n),
            Some(radius) => disk::farthest(radius, n),
        }
    }
}

/// Two hulls in the second's frame.
pub(super) struct Two<'a> {
    pub frame: Frame,
    pub first: Hull<'a>,
    pub second: Hull<'a>,
}

impl<'a> Two<'a> {
    fn new(a: &PosedBody<'a>, b: &PosedBody<'a>) -> Two<'a> {
        Two { frame: Frame::new(&a.pose(), &b.pose()), first: Hull::of(a.core), second: Hull::of(b.core) }
    }

    /// Support vector along a direction.
    fn between(&self, n: &Vec3) -> Vec3 {
        let first = self.first.farthest(&-self.frame.turn.inverse_transform_vector(n));
        self.frame.point(&first) - self.second.farthest(n)
    }

    /// Separating direction and distance bound; any once `enough`. `None` for overlap.
    pub fn separation(&self, guess: Vec3, enough: f64) -> Option<(Vec3, f64)> {
        separation(|n| self.between(n), guess, enough)
    }

    /// Centre line, as first guess.
    pub fn line(&self) -> Vec3 {
        self.frame.way.try_normalize(0.0).unwrap_or(Vec3::z())
    }

    /// Computes `heights` if closer than `reach`. Error: whether farther apart, else overlapping.
    pub fn heights(&self, hint: &mut Hint, reach: f64, heights: &mut Heights) -> Result<(), bool> {
        let mut guess = None;
        if let Some([x, y, z, before]) = *hint {
            let n = Vec3::new(x, y, z);
            guess = Some(n);
            heights.take(self, n);
            let apart = heights.low - heights.high;
            if apart >= reach {
                return Err(true);
            }
            if apart > 0.0 && before < reach && (apart - before).abs() < STALE * reach {
                return Ok(());
            }
        }
        let found = self.separation(guess.unwrap_or_else(|| self.line()), reach);
        *hint = found.map(|(n, apart)| [n.x, n.y, n.z, apart]);
        match found {
            Some((_, apart)) if apart >= reach => Err(true),
            Some((n, _)) => {
                heights.take(self, n);
                Ok(())
            }
            None => Err(false),
        }
    }
}

pub(super) fn set(heights: impl IntoIterator<Item = f64>, near: impl Fn(f64) -> bool) -> u64 {
    heights.into_iter().enumerate().map(|(k, h)| u64::from(near(h)) << k).sum()
}

/// Whether bounding spheres are within `reach`.
fn around(a: &PosedBody<'_>, b: &PosedBody<'_>, reach: f64) -> bool {
    let most = a.reach() + b.reach() + reach;
    (a.centre - b.centre).norm_squared() < most * most
}

/// Calls `put` with feature (from 1), indentation and weight, in the target's frame.
pub(super) fn skeleton(
    core: &Core,
    frame: &Frame,
    (near, view): (u64, &View),
    target: &impl Target,
    reach: f64,
    mut put: impl FnMut(u32, &Indentation, f64),
) {
    for k in core.corners_of(near) {
        if let Some(pressed) = edge_contact::corner(target, &frame.point(&core.corners[k]), reach) {
            put(k as u32 + 1, &pressed, 1.0);
        }
    }
    let sight = view.all(&core.corners, (&frame.turn, frame.scale, &frame.way));
    for k in core.edges_of(near) {
        let edge = &core.edges[k];
        let around = Bounds::around(edge.ends.map(|e| &sight[e as usize]), view);
        if !target.meets(&around) {
            continue;
        }
        let from = frame.point(&core.corners[edge.ends[0] as usize]);
        let (direction, range) = (frame.turn * edge.direction, [0.0, edge.length * frame.scale]);
        if let Some(pressed) = edge_contact::edge(target, &Segment { from, direction, range, around }, reach)
        {
            let weight = length(&pressed, reach);
            put((CORNERS + k) as u32 + 1, &pressed, weight);
        }
    }
    if let Some(radius) = core.rim {
        let [x, y] = [Vec3::x(), Vec3::y()].map(|axis| frame.turn * (axis * (radius * frame.scale)));
        let circle = Circle { centre: frame.way, x, y };
        rim::rim(target, &circle, view.floor_of(&circle), reach, |arc, pressed| {
            put(arc + 1, pressed, length(pressed, reach));
        });
    }
}

/// Edge stiffness over corner stiffness.
pub(super) fn length(pressed: &Indentation, reach: f64) -> f64 {
    pressed.force.norm() / (pressed.overlap * LENGTH * reach)
}

/// Contact point in the world. `frame`: of the target; `own`: indenter radius in its unit [m]; `sign`: −1 if
/// the first partner is the target.
pub(super) fn touch(
    frame: &Pose,
    feature: u32,
    p: &Indentation,
    weight: f64,
    [own, reach, radius]: [f64; 3],
    sign: f64,
) -> PairContactPoint {
    let n = p.force.normalize();
    // Half the overlap below the surface.
    let point = p.point - n * (own - 0.5 * p.overlap);
    let geometry = ContactGeometry {
        point: frame.centre + frame.orientation * (point * frame.scale),
        normal: frame.orientation * n * sign,
        overlap: p.overlap * frame.scale,
        radius,
    };
    let couple = frame.orientation * p.couple * (sign * frame.scale);
    let edge = if p.edge { LENGTH * reach * frame.scale } else { 0.0 };
    PairContactPoint {
        edge,
        couple,
        ..PairContactPoint::of(feature, geometry, weight, DEEPEST * reach * frame.scale)
    }
}

/// Indenter radius, or the other's if sharp; for edges only rolling resistance depends on it.
pub(super) fn rounding(own: f64, other: f64) -> f64 {
    if own > 0.0 { own } else { other }
}

pub(super) fn lost(point: Vec3, normal: Vec3, reach: f64) -> PairContactPoint {
    let geometry = ContactGeometry { point, normal, overlap: reach, radius: reach };
    PairContactPoint::only(geometry, DEEPEST * reach)
}

impl ShapePair for DilatedDilated {
    type First = Solids;
    type Second = Solids;
    const SHARED: bool = true;

    fn may_touch(&self, first: &PosedBody<'_>, second: &PosedBody<'_>, reach: f64) -> bool {
        if !(first.dilated() || second.dilated()) || !around(first, second, reach) {
            return false;
        }
        let two = Two::new(first, second);
        let most = (first.radius + second.radius + reach) / second.scale;
        two.separation(two.line(), most).is_none_or(|(_, apart)| apart < most)
    }

    fn contact_points(&self, a: &PosedBody<'_>, b: &PosedBody<'_>, found: &mut Manifold) {
        self.contact_points_from_hint(a, b, &mut None, found);
    }

    fn contact_points_from_hint(
        &self,
        a: &PosedBody<'_>,
        b: &PosedBody<'_>,
        hint: &mut Hint,
        found: &mut Manifold,
    ) {
        if !around(a, b, 0.0) {
            return;
        }
        let (two, sum) = (Two::new(a, b), a.radius + b.radius);
        let reach = sum / b.scale;
        let mut heights = Heights::new();
        match two.heights(hint, reach, &mut heights) {
            Ok(()) => {}
            Err(true) => return,
            Err(false) => {
                let way = (a.centre - b.centre).try_normalize(0.0).unwrap_or(Vec3::z());
                return found.push(lost((a.centre + b.centre) * 0.5, way, sum));
            }
        }
        let most = reach * (1.0 + ROUNDING);
        let (n, level, floor) = (heights.n, heights.high + most, heights.low - most);
        let near_a = set(heights.first.iter().copied(), |h| h < level);
        let near_b = set(heights.second.iter().copied(), |h| h > floor);
        let view = View::new(n, floor, reach, heights.low - heights.high);
        let mut target = Part::none(b.core, view);
        let (target, of_a) = (target.take(near_b), (near_a, &view.turned(-level)));
        skeleton(a.core, &two.frame, of_a, target, reach, |feature, pressed, weight| {
            let lengths = [a.radius / b.scale, reach, rounding(a.radius, b.radius)];
            found.push(touch(&b.pose(), feature << 16, pressed, weight, lengths, 1.0));
        });
        // Likewise in the first's frame.
        let [level, floor] = [level, floor].map(|h| (h - n.dot(&two.frame.way)) / two.frame.scale);
        let (back, reach) = (Frame::new(&b.pose(), &a.pose()), sum / a.scale);
        let view = view.moved(&back.turn, back.scale, floor);
        let mut target = Part::none(a.core, view.turned(-level));
        let (target, of_b) = (target.take(near_a), (near_b, &view));
        skeleton(b.core, &back, of_b, target, reach, |feature, pressed, weight| {
            let lengths = [b.radius / a.scale, reach, rounding(b.radius, a.radius)];
            found.push(touch(&a.pose(), feature, pressed, weight, lengths, -1.0));
        });
    }
}

impl ShapePair for DilatedPlane {
    type First = Solids;
    type Second = Planes;
    const SHARED: bool = true;

    fn may_touch(&self, body: &PosedBody<'_>, plane: &PlaneView, reach: f64) -> bool {
        body.dilated()
            && !plane.open
            && (body.centre - plane.origin).dot(&plane.normal) < body.reach() + reach
    }

    fn contact_points(&self, body: &PosedBody<'_>, plane: &PlaneView, found: &mut Manifold) {
        let height = (body.centre - plane.origin).dot(&plane.normal);
        if height >= body.reach() {
            return;
        }
        let back = body.orientation.inverse();
        let normal = back * plane.normal;
        let below = HalfSpace { point: normal * (-height / body.scale), normal };
        let (reach, corners) = (body.radius / body.scale, &body.core.corners);
        let level = below.point.dot(&normal) + reach * (1.0 + ROUNDING);
        let near = set(corners.iter().map(|x| x.dot(&normal)), |h| h < level);
        let (of, frame) = ((near, &View::new(-normal, -level, reach, 0.0)), Frame::same());
        skeleton(body.core, &frame, of, &below, reach, |feature, pressed, weight| {
            found.push(touch(&body.pose(), feature << 16, pressed, weight, [reach, reach, body.radius], 1.0));
        });
    }
}

/// Lower bound of the distance outside a core.
fn outside(core: &Core, p: &Vec3) -> f64 {
    match core.rim {
        Some(radius) => disk::offset_from_disk(radius, p).norm(),
        None => core.faces.iter().map(|f| f.normal.dot(p) - f.offset).fold(f64::NEG_INFINITY, f64::max),
    }
}

impl ShapePair for SphereDilated {
    type First = Spheres;
    type Second = Solids;

    fn may_touch(&self, sphere: &&Vec4, body: &PosedBody<'_>, reach: f64) -> bool {
        if !body.dilated() {
            return false;
        }
        let (p, most) = (xyz(sphere), sphere[3] + body.radius + reach);
        let local = body.orientation.inverse() * (p - body.centre) / body.scale;
        outside(body.core, &local) * body.scale < most
    }

    fn contact_points(&self, sphere: &&Vec4, body: &PosedBody<'_>, found: &mut Manifold) {
        if !body.dilated() {
            return;
        }
        let (p, sum) = (xyz(sphere), sphere[3] + body.radius);
        let local = body.orientation.inverse() * (p - body.centre) / body.scale;
        let highest = outside(body.core, &local);
        let reach = sum / body.scale;
        if highest >= reach {
            return;
        }
        let view = View::everywhere(Vec3::z(), reach);
        let Some(pressed) = edge_contact::corner(Part::none(body.core, view).all(), &local, reach) else {
            if highest <= 0.0 {
                let way = (p - body.centre).try_normalize(0.0).unwrap_or(Vec3::z());
                found.push(lost(p, way, sum));
            }
            return;
        };
        let own = sphere[3] / body.scale;
        let radius = sphere[3];
        let bound = if body.core.rim.is_some() { DEEPEST * sum } else { sum };
        found.push(PairContactPoint {
            bound,
            ..touch(&body.pose(), 0, &pressed, 1.0, [own, reach, radius], 1.0)
        });
    }
}

#[cfg(test)]
#[path = "dilated_tests.rs"]
mod tests;

#[cfg(test)]
#[path = "disk_tests.rs"]
mod disk_tests;
#[cfg(test)]
#[path = "dilated_pairs_tests.rs"]
mod pairs_tests;
