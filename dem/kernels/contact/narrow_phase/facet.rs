//! Triangles, edges and corners as indentation targets (`spatial/facet.rs`).

use crate::base::Vec3;
use crate::shape::dilated::circle::{Circle, Turns};
use crate::shape::dilated::edge_contact::{Nearest, Segment, Stretch, Target};
use crate::shape::dilated::part::Bounds;
use crate::shape::dilated::part::direction;
use crate::spatial::facet::{Facet, FacetEdge};

pub(super) struct Tip<'a>(pub &'a Vec3);

/// Closed segment: first end, edge.
pub(super) struct Rim<'a>(pub &'a Vec3, pub &'a FacetEdge);

pub(super) struct Closed<'a>(pub &'a Facet);

fn near(way: Vec3, reach: f64) -> Option<(f64, Vec3)> {
    let square = way.norm_squared();
    if square >= reach * reach || square == 0.0 {
        return None;
    }
    let d = square.sqrt();
    Some((d, way / d))
}

fn of_tip(
    mut stretch: Stretch,
    segment: &Segment,
    tip: &Vec3,
    reach: f64,
    f: &mut impl FnMut([f64; 2], &Nearest),
) {
    let at = segment.from - tip;
    stretch.near(&at, &segment.direction, reach);
    if stretch.some() {
        f(stretch.0, &Nearest::Line { at, slope: segment.direction });
    }
}

/// Part of a segment near an edge, between its ends.
fn of_rim(
    mut stretch: Stretch,
    segment: &Segment,
    (end, edge): (&Vec3, &FacetEdge),
    reach: f64,
    f: &mut impl FnMut([f64; 2], &Nearest),
) {
    let way = segment.from - end;
    let along = segment.direction.dot(&edge.direction);
    let at = way - edge.direction * way.dot(&edge.direction);
    let slope = segment.direction - edge.direction * along;
    stretch.near(&at, &slope, reach);
    if stretch.some() {
        f(stretch.0, &Nearest::Line { at, slope });
    }
}

/// Receives a circle part, and distance and direction of its points.
type Put<'a> = &'a mut dyn FnMut([f64; 2], &dyn Fn(&Vec3) -> (f64, Vec3));

fn turns_of_tip(circle: &Circle, mut turns: Turns, tip: &Vec3, reach: f64, f: Put<'_>) {
    turns.cut(circle.around(tip, reach));
    let at = |p: &Vec3| direction(p - tip);
    turns.0.iter().for_each(|part| f(*part, &at));
}

/// Part of circle arcs near an edge, between its ends.
fn turns_of_rim(circle: &Circle, turns: &Turns, (end, edge): (&Vec3, &FacetEdge), reach: f64, f: Put<'_>) {
    let at = |p: &Vec3| {
        let way = p - end;
        direction(way - edge.direction * way.dot(&edge.direction))
    };
    turns.0.iter().for_each(|range| circle.near(*range, reach, &at, |part| f(part, &at)));
}

impl Target for Tip<'_> {
    fn meets(&self, _: &Bounds) -> bool {
        true
    }

    fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)> {
        near(p - self.0, reach)
    }

    fn stretches(&self, segment: &Segment, reach: f64, mut f: impl FnMut([f64; 2], &Nearest)) {
        of_tip(Stretch(segment.range), segment, self.0, reach, &mut f);
    }

    fn turns(
        &self,
        circle: &Circle,
        turns: &Turns,
        reach: f64,
        mut f: impl FnMut([f64; 2], &dyn Fn(&Vec3) -> (f64, Vec3)),
    ) {
        turns_of_tip(circle, turns.clone(), self.0, reach, &mut f);
    }
}

impl Target for Rim<'_> {
    fn meets(&self, _: &Bounds) -> bool {
        true
    }

    fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)> {
        let way = p - self.0;
        let t = way.dot(&self.1.direction).clamp(0.0, self.1.length);
        near(way - self.1.direction * t, reach)
    }

    fn stretches(&self, segment: &Segment, reach: f64, mut f: impl FnMut([f64; 2], &Nearest)) {
        let Rim(end, edge) = *self;
        let t = (segment.from - end).dot(&edge.direction);
        let along = segment.direction.dot(&edge.direction);
        let whole = Stretch(segment.range);
        let mut stretch = whole;
        stretch.cut(-t, -along);
        stretch.cut_beyond(t - edge.length, along);
        if stretch.some() {
            of_rim(stretch, segment, (end, edge), reach, &mut f);
        }
        let mut before = whole;
        before.cut_beyond(t, along);
        if before.some() {
            of_tip(before, segment, end, reach, &mut f);
        }
        let mut behind = whole;
        behind.cut(edge.length - t, -along);
        if behind.some() {
            of_tip(behind, segment, &(end + edge.direction * edge.length), reach, &mut f);
        }
    }

    fn turns(
        &self,
        circle: &Circle,
        turns: &Turns,
        reach: f64,
        mut f: impl FnMut([f64; 2], &dyn Fn(&Vec3) -> (f64, Vec3)),
    ) {
        let Rim(end, edge) = *self;
        let along = circle.along(&edge.direction, edge.direction.dot(end));
        let beyond = [along[0] - edge.length, along[1], along[2]];
        let mut beside = turns.clone();
        beside.cut(along.map(|x| -x));
        beside.cut_beyond(beyond);
        turns_of_rim(circle, &beside, (end, edge), reach, &mut f);
        let mut before = turns.clone();
        before.cut_beyond(along);
        turns_of_tip(circle, before, end, reach, &mut f);
        let mut behind = turns.clone();
        behind.cut(beyond.map(|x| -x));
        turns_of_tip(circle, behind, &(end + edge.direction * edge.length), reach, &mut f);
    }
}

impl Closed<'_> {
    fn way(&self, p: &Vec3) -> Vec3 {
        let Facet { corners, edges, normal, .. } = self.0;
        let mut best: Option<Vec3> = None;
        let mut over = true;
        for (corner, edge) in corners.iter().zip(edges) {
            let way = p - corner;
            if way.dot(&edge.side) > 0.0 {
                over = false;
                let t = way.dot(&edge.direction).clamp(0.0, edge.length);
                let way = way - edge.direction * t;
                if best.is_none_or(|b| way.norm_squared() < b.norm_squared()) {
                    best = Some(way);
                }
            }
        }
        match best {
            Some(way) if !over => way,
            _ => normal * (p - corners[0]).dot(normal),
        }
    }
}

impl Target for Closed<'_> {
    fn meets(&self, _: &Bounds) -> bool {
        true
    }

    fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)> {
        near(self.way(p), reach)
    }

    fn stretches(&self, segment: &Segment, reach: f64, mut f: impl FnMut([f64; 2], &Nearest)) {
        let Facet { corners, edges, normal, .. } = self.0;
        let whole = Stretch(segment.range);
        let (at, slope) = ((segment.from - corners[0]).dot(normal), segment.direction.dot(normal));
        // Outside a side, and along it.
        let aside = |k: usize| {
            let way = segment.from - corners[k];
            (way.dot(&edges[k].side), segment.direction.dot(&edges[k].side))
        };
        let along = |k: usize| {
            let way = segment.from - corners[k];
            (way.dot(&edges[k].direction), segment.direction.dot(&edges[k].direction))
        };
        for sign in [1.0, -1.0] {
            let (at, slope) = (sign * at, sign * slope);
            let mut stretch = whole;
            stretch.cut(at - reach, slope);
            if sign > 0.0 {
                stretch.cut(-at, -slope)
            } else {
                stretch.cut_beyond(-at, -slope)
            }
            for k in 0..3 {
                let (out, slope) = aside(k);
                stretch.cut(out, slope);
            }
            if stretch.some() {
                f(stretch.0, &Nearest::Plane { normal: normal * sign, at, slope });
            }
        }
        for k in 0..3 {
            let ((out, out_slope), (t, t_slope)) = (aside(k), along(k));
            let mut stretch = whole;
            stretch.cut_beyond(-out, -out_slope);
            stretch.cut(-t, -t_slope);
            stretch.cut(t - edges[k].length, t_slope);
            if stretch.some() {
                of_rim(stretch, segment, (&corners[k], &edges[k]), reach, &mut f);
            }
            let before = (k + 2) % 3;
            let (u, u_slope) = along(before);
            let mut stretch = whole;
            stretch.cut_beyond(t, t_slope);
            stretch.cut_beyond(edges[before].length - u, -u_slope);
            if stretch.some() {
                of_tip(stretch, segment, &corners[k], reach, &mut f);
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
        let Facet { corners, edges, normal, .. } = self.0;
        for sign in [1.0, -1.0] {
            let normal = normal * sign;
            let height = circle.along(&normal, normal.dot(&corners[0]));
            let mut over = turns.clone();
            over.cut([height[0] - reach, height[1], height[2]]);
            if sign > 0.0 {
                over.cut(height.map(|x| -x));
            } else {
                over.cut_beyond(height.map(|x| -x));
            }
            for (corner, edge) in corners.iter().zip(edges) {
                over.cut(circle.along(&edge.side, edge.side.dot(corner)));
            }
            let at = |p: &Vec3| ((p - corners[0]).dot(&normal), normal);
            over.0.iter().for_each(|part| f(*part, &at));
        }
        for k in 0..3 {
            let (corner, edge, before) = (&corners[k], &edges[k], &edges[(k + 2) % 3]);
            let along = circle.along(&edge.direction, edge.direction.dot(corner));
            let mut beside = turns.clone();
            beside.cut_beyond(circle.along(&edge.side, edge.side.dot(corner)).map(|x| -x));
            beside.cut(along.map(|x| -x));
            beside.cut([along[0] - edge.length, along[1], along[2]]);
            turns_of_rim(circle, &beside, (corner, edge), reach, &mut f);
            let mut beyond = turns.clone();
            beyond.cut_beyond(along);
            beyond.cut_beyond(circle.along(&before.direction, before.direction.dot(corner)).map(|x| -x));
            turns_of_tip(circle, beyond, corner, reach, &mut f);
        }
    }
}
