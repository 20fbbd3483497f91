//! Culling: features of a core near another body, with bounding boxes.

use super::circle::{Circle, Turns};
use super::edge_contact::{Nearest, Segment, Stretch, Target};
use super::flat::Flat;
use super::{CORNERS, Core, Edge, Face};
use crate::base::Vec3;
use arrayvec::ArrayVec;
use nalgebra::Rotation3;

/// Euler's bound on edges and faces.
const EDGES: usize = 3 * CORNERS - 6;
const FACES: usize = 2 * CORNERS - 4;

/// Relative margin of boxes against rounding.
const ROUNDING: f64 = 1e-6;

/// Region above `floor` along `up`, with lateral margin `aside`.
#[derive(Clone, Copy, Debug)]
pub struct View {
    up: Vec3,
    floor: f64,
    axes: [Vec3; 2],
    aside: f64,
}

impl View {
    /// Lateral margin for bodies within `reach`, at least `apart` above each other.
    pub fn new(up: Vec3, floor: f64, reach: f64, apart: f64) -> View {
        let mut axis = Vec3::zeros();
        axis[up.iamin()] = 1.0;
        let first = axis.cross(&up).normalize();
        let reach = reach * (1.0 + ROUNDING);
        let aside = (reach * reach - apart * apart).max(0.0).sqrt();
        View { up, floor, axes: [first, up.cross(&first)], aside }
    }

    pub fn everywhere(up: Vec3, reach: f64) -> View {
        View::new(up, f64::NEG_INFINITY, reach, 0.0)
    }

    pub fn turned(&self, floor: f64) -> View {
        View { up: -self.up, floor, ..*self }
    }

    pub fn moved(&self, turn: &Rotation3<f64>, scale: f64, floor: f64) -> View {
        let [up, first, second] = [self.up, self.axes[0], self.axes[1]].map(|x| turn * x);
        View { up, floor, axes: [first, second], aside: self.aside * scale }
    }

    /// Coefficients of the circle's part above the floor (≤ 0 inside).
    pub fn floor_of(&self, circle: &Circle) -> [f64; 3] {
        circle.along(&-self.up, -self.floor)
    }

    fn see(&self, p: &Vec3) -> Seen {
        [self.up.dot(p) - self.floor, self.axes[0].dot(p), self.axes[1].dot(p)]
    }

    pub fn all(&self, points: &[Vec3], (turn, scale, way): (&Rotation3<f64>, f64, &Vec3)) -> Sight {
        let axes = [self.up, self.axes[0], self.axes[1]];
        let own = axes.map(|x| turn.inverse_transform_vector(&x) * scale);
        let [over, x, y] = axes.map(|axis| axis.dot(way));
        let from = [over - self.floor, x, y];
        points.iter().map(|p| std::array::from_fn(|k| own[k].dot(p) + from[k])).collect()
    }
}

/// Height above the floor, lateral coordinates.
pub type Seen = [f64; 3];

pub type Sight = ArrayVec<Seen, CORNERS>;

/// Lateral rectangle.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    low: [f64; 2],
    high: [f64; 2],
}

impl Bounds {
    const NONE: Bounds = Bounds { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };

    #[inline(always)]
    fn of([a, b]: [&Seen; 2]) -> Bounds {
        let ([over, ax, ay], [under, bx, by]) = (*a, *b);
        if over < 0.0 && under < 0.0 {
            return Bounds::NONE;
        }
        let ([mut ax, mut ay], [mut bx, mut by]) = ([ax, ay], [bx, by]);
        if over < 0.0 || under < 0.0 {
            let share = over / (over - under);
            let cut = [ax + (bx - ax) * share, ay + (by - ay) * share];
            if over < 0.0 {
                [ax, ay] = cut;
            } else {
                [bx, by] = cut;
            }
        }
        Bounds { low: [least(ax, bx), least(ay, by)], high: [most(ax, bx), most(ay, by)] }
    }

    /// Bounds with lateral margin.
    pub fn near(ends: [&Vec3; 2], view: &View) -> Bounds {
        let ends = ends.map(|p| view.see(p));
        Bounds::around([&ends[0], &ends[1]], view)
    }

    #[inline(always)]
    pub fn around(ends: [&Seen; 2], view: &View) -> Bounds {
        let Bounds { low, high } = Bounds::of(ends);
        let by = view.aside;
        Bounds { low: [low[0] - by, low[1] - by], high: [high[0] + by, high[1] + by] }
    }

    fn join(&mut self, other: &Bounds) {
        for d in 0..2 {
            self.low[d] = least(self.low[d], other.low[d]);
            self.high[d] = most(self.high[d], other.high[d]);
        }
    }

    fn holds(&self, [_, x, y]: &Seen) -> bool {
        (self.low[0] <= *x) & (*x <= self.high[0]) & (self.low[1] <= *y) & (*y <= self.high[1])
    }

    fn meets(&self, other: &Bounds) -> bool {
        let meets = |d: usize| (self.low[d] <= other.high[d]) & (other.low[d] <= self.high[d]);
        meets(0) & meets(1)
    }
}

/// Single-instruction minimum, without NaN handling.
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

fn most(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

pub struct Part<'a> {
    core: &'a Core,
    view: View,
    sight: Sight,
    /// Bit set.
    corners: u64,
    edges: ArrayVec<(u8, Bounds), EDGES>,
    faces: ArrayVec<(u8, Bounds), FACES>,
    bounds: Bounds,
}

impl<'a> Part<'a> {
    #[inline]
    pub fn none(core: &'a Core, view: View) -> Part<'a> {
        let (edges, faces) = (ArrayVec::new(), ArrayVec::new());
        Part { core, view, sight: Sight::new(), corners: 0, edges, faces, bounds: Bounds::NONE }
    }

    /// Fills features with a corner in `corners` (bit set) in place, for speed.
    pub fn take(&mut self, corners: u64) -> &Part<'a> {
        let (core, part) = (self.core, &mut *self);
        part.corners = corners;
        part.sight.extend(core.corners.iter().map(|p| part.view.see(p)));
        let mut places = [0; FACES];
        for k in core.faces_of(corners) {
            places[k] = part.faces.len() as u8;
            part.faces.push((k as u8, Bounds::NONE));
        }
        for k in core.edges_of(corners) {
            let edge = &core.edges[k];
            let bounds = Bounds::of(edge.ends.map(|e| &part.sight[e as usize]));
            part.edges.push((k as u8, bounds));
            part.bounds.join(&bounds);
            edge.faces.iter().for_each(|f| part.faces[places[*f as usize] as usize].1.join(&bounds));
        }
        part
    }

    pub fn all(&mut self) -> &Part<'a> {
        self.take(u64::MAX)
    }

    fn corners_at(&self, around: &Bounds) -> impl Iterator<Item = usize> {
        self.core.corners_of(self.corners).filter(|k| around.holds(&self.sight[*k]))
    }

    fn edges_at(&self, around: &Bounds) -> impl Iterator<Item = &Edge> {
        self.edges.iter().filter(|(_, b)| b.meets(around)).map(|(k, _)| &self.core.edges[*k as usize])
    }

    fn faces_at(&self, around: &Bounds) -> impl Iterator<Item = &Face> {
        self.faces.iter().filter(|(_, b)| b.meets(around)).map(|(k, _)| &self.core.faces[*k as usize])
    }
}

impl Target for Part<'_> {
    fn meets(&self, around: &Bounds) -> bool {
        self.core.rim.is_some() || self.bounds.meets(around)
    }

    fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)> {
        if let Some(radius) = self.core.rim {
            return Flat(radius).distance(p, reach);
        }
        let around = &Bounds::near([p, p], &self.view);
        let mut best = (reach, Vec3::zeros());
        for face in self.faces_at(around) {
            let height = face.normal.dot(p) - face.offset;
            let within = |(side, level): &(Vec3, f64)| side.dot(p) <= *level;
            if height > 0.0 && height < best.0 && face.sides.iter().all(within) {
                best = (height, face.normal);
            }
        }
        for edge in self.edges_at(around) {
            let way = p - self.core.corners[edge.ends[0] as usize];
            let t = way.dot(&edge.direction).clamp(0.0, edge.length);
            let way = way - edge.direction * t;
            let square = way.norm_squared();
            if square < best.0 * best.0 {
                let d = square.sqrt();
                best = (d, way / d);
            }
        }
        (best.0 < reach).then_some(best)
    }

    fn stretches(&self, segment: &Segment, reach: f64, mut f: impl FnMut([f64; 2], &Nearest)) {
        if let Some(radius) = self.core.rim {
            return Flat(radius).stretches(segment, reach, f);
        }
        let whole = Stretch(segment.range);
        let around = &segment.around;
        for face in self.faces_at(around) {
            let (at, slope) =
                (face.normal.dot(&segment.from) - face.offset, face.normal.dot(&segment.direction));
            let mut stretch = whole;
            stretch.cut(at - reach, slope);
            stretch.cut(-at, -slope);
            for (side, level) in &face.sides {
                if !stretch.some() {
                    break;
                }
                stretch.cut(side.dot(&segment.from) - level, side.dot(&segment.direction));
            }
            if stretch.some() {
                f(stretch.0, &Nearest::Plane { normal: face.normal, at, slope });
            }
        }
        for edge in self.edges_at(around) {
            let (t, along) = (edge.direction.dot(&segment.from), segment.direction.dot(&edge.direction));
            let mut stretch = whole;
            stretch.cut(edge.levels[0] - t, -along);
            stretch.cut(t - edge.levels[1], along);
            for (side, level) in &edge.sides {
                if !stretch.some() {
                    break;
                }
                stretch.cut_beyond(level - side.dot(&segment.from), -side.dot(&segment.direction));
            }
            if stretch.some() {
                let way = segment.from - self.core.corners[edge.ends[0] as usize];
                let t = way.dot(&edge.direction);
                let (at, slope) = (way - edge.direction * t, segment.direction - edge.direction * along);
                stretch.near(&at, &slope, reach);
                if stretch.some() {
                    f(stretch.0, &Nearest::Line { at, slope });
                }
            }
        }
        for corner in self.corners_at(around) {
            let (at, slope) = (segment.from - self.core.corners[corner], segment.direction);
            let mut stretch = whole;
            stretch.near(&at, &slope, reach);
            for &(edge, end) in &self.core.spokes[corner] {
                if !stretch.some() {
                    break;
                }
                let edge = &self.core.edges[edge as usize];
                let (t, along) = (edge.direction.dot(&segment.from), segment.direction.dot(&edge.direction));
                let beyond = t - edge.levels[end as usize];
                if end == 0 {
                    stretch.cut_beyond(beyond, along);
                } else {
                    stretch.cut_beyond(-beyond, -along);
                }
            }
            if stretch.some() {
                f(stretch.0, &Nearest::Line { at, slope });
            }
        }
    }

    fn turns(
        &self,
        circle: &Circle,
        turns: &Turns,
        reach: f64,
        mut f: impl FnMut([f64; 2], &dyn Fn(&Vec3) -> (f64, Vec3)),
    ) {
        if let Some(radius) = self.core.rim {
            return Flat(radius).turns(circle, turns, reach, f);
        }
        for face in self.faces.iter().map(|(k, _)| &self.core.faces[*k as usize]) {
            let mut over = turns.clone();
            let height = circle.along(&face.normal, face.offset);
            over.cut([height[0] - reach, height[1], height[2]]);
            over.cut(height.map(|x| -x));
            for (side, level) in &face.sides {
                if !over.some() {
                    break;
                }
                over.cut(circle.along(side, *level));
            }
            let at = |p: &Vec3| (face.normal.dot(p) - face.offset, face.normal);
            over.0.iter().for_each(|part| f(*part, &at));
        }
        for edge in self.edges.iter().map(|(k, _)| &self.core.edges[*k as usize]) {
            let mut beside = turns.clone();
            let along = circle.along(&edge.direction, 0.0);
            beside.cut([edge.levels[0] - along[0], -along[1], -along[2]]);
            beside.cut([along[0] - edge.levels[1], along[1], along[2]]);
            for (side, level) in &edge.sides {
                if !beside.some() {
                    break;
                }
                beside.cut_beyond(circle.along(side, *level).map(|x| -x));
            }
            let end = &self.core.corners[edge.ends[0] as usize];
            let at = |p: &Vec3| {
                let way = p - end;
                direction(way - edge.direction * way.dot(&edge.direction))
            };
            beside.0.iter().for_each(|range| circle.near(*range, reach, &at, |part| f(part, &at)));
        }
        for (k, corner) in self.core.corners.iter().enumerate().filter(|(k, _)| self.corners >> k & 1 == 1) {
            let mut beyond = turns.clone();
            beyond.cut(circle.around(corner, reach));
            for &(edge, end) in &self.core.spokes[k] {
                if !beyond.some() {
                    break;
                }
                let edge = &self.core.edges[edge as usize];
                let along = circle.along(&edge.direction, edge.levels[end as usize]);
                beyond.cut_beyond(if end == 0 { along } else { along.map(|x| -x) });
            }
            let at = |p: &Vec3| direction(p - corner);
            beyond.0.iter().for_each(|part| f(*part, &at));
        }
    }
}

pub fn direction(way: Vec3) -> (f64, Vec3) {
    let d = way.norm();
    if d > 0.0 { (d, way / d) } else { (0.0, Vec3::z()) }
}
