//! Dilated polyhedra against wall patches: triangles (`spatial/facet.rs`) and round surfaces (`round.rs`).
//!
//! Features indent each other as between bodies (`dilated.rs`), independent of the triangulation. At a seam,
//! the next side's history begins before the previous ends, so friction continues.
//!
//! Limits: as between bodies.

use super::dilated::{self, DEEPEST, Frame, Heights, Hull, ROUNDING, Two, rounding, set, skeleton, touch};
use super::facet::{Closed, Rim, Tip};
use super::pair::{Manifold, PairContactPoint, ShapePair};
use super::round;
use super::scene::{PatchView, Pose, PosedBody};
use super::side::{Patches, Solids};
use crate::base::Vec3;
use crate::pairs::list::Hint;
use crate::shape::dilated::edge_contact::{self, Indentation, Segment, Target};
use crate::shape::dilated::part::{Bounds, Part, View};
use crate::spatial::facet::{Facet, FeatureWeight};
use crate::spatial::patchwork::Form;

/// Numbers of face, edges and corners as targets, then as indenters.
const FACE: u32 = 0;
const EDGE: u32 = 1;
const TIP: u32 = 4;
const PRESSING: u32 = 8;

pub struct DilatedPatch;

/// Body over a facet, in the wall's frame.
pub(super) fn two<'a>(body: &PosedBody<'a>, pose: &Pose, facet: &'a Facet) -> Two<'a> {
    let frame = Frame::new(&body.pose(), pose);
    Two { frame, first: Hull::of(body.core), second: Hull { corners: &facet.corners, rim: None } }
}

impl ShapePair for DilatedPatch {
    type First = Solids;
    type Second = Patches;
    const SHARED: bool = true;
    const JOINED: bool = true;

    fn may_touch(&self, body: &PosedBody<'_>, patch: &PatchView<'_>, reach: f64) -> bool {
        if !body.dilated() || patch.wall.open {
            return false;
        }
        match &patch.patch.form {
            Form::Facet(facet) => {
                let two = two(body, &patch.pose(), facet);
                let most = body.radius + reach;
                two.separation(two.line(), most).is_none_or(|(_, apart)| apart < most)
            }
            Form::Round(form) => round::may_touch(body, patch, form, reach),
        }
    }

    fn contact_points(&self, body: &PosedBody<'_>, patch: &PatchView<'_>, found: &mut Manifold) {
        self.contact_points_from_hint(body, patch, &mut None, found);
    }

    fn contact_points_from_hint(
        &self,
        body: &PosedBody<'_>,
        patch: &PatchView<'_>,
        hint: &mut Hint,
        found: &mut Manifold,
    ) {
        if patch.wall.open {
            return;
        }
        match &patch.patch.form {
            Form::Facet(facet) => on_facet(body, &patch.pose(), facet, hint, found),
            Form::Round(form) => round::contact_points(body, patch, form, found),
        }
    }
}

/// Body in a wall's frame.
pub(super) struct Whole<'a> {
    pub body: &'a PosedBody<'a>,
    pub frame: &'a Frame,
    /// Bit set of corners possibly near; view of edges.
    pub of: (u64, &'a View),
    pub pose: &'a Pose,
}

impl Whole<'_> {
    /// Indents a numbered part of the wall, weighted by `count`.
    pub fn press(&self, target: &impl Target, (number, count): (u32, f64), found: &mut Manifold) {
        let reach = self.body.radius;
        skeleton(self.body.core, self.frame, self.of, target, reach, |feature, pressed, weight| {
            let feature = feature << 16 | number;
            found.push(touch(self.pose, feature, pressed, count * weight, [reach; 3], 1.0));
        });
    }
}

pub(super) fn on_facet(
    body: &PosedBody<'_>,
    pose: &Pose,
    facet: &Facet,
    hint: &mut Hint,
    found: &mut Manifold,
) {
    let (two, reach) = (two(body, pose, facet), body.radius);
    let mut heights = Heights::new();
    match two.heights(hint, reach, &mut heights) {
        Ok(()) => {}
        Err(true) => return,
        Err(false) => return found.push(dilated::lost(body.centre, facet.normal, reach)),
    }
    let most = reach * (1.0 + ROUNDING);
    let (n, level, floor) = (heights.n, heights.high + most, heights.low - most);
    let near = set(heights.first.iter().copied(), |h| h < level);
    let view = View::new(n, floor, reach, heights.low - heights.high);
    let of_body = (near, &view.turned(-level));
    let whole = Whole { body, frame: &two.frame, of: of_body, pose };
    whole.press(&Closed(facet), (FACE, 1.0), found);
    for (k, edge) in facet.edges.iter().enumerate().filter(|(_, e)| e.share.count != 0.0) {
        whole.press(&Rim(&facet.corners[k], edge), (EDGE + k as u32, edge.share.count), found);
    }
    for (k, tip) in facet.tips.iter().enumerate().filter(|(_, t)| t.count != 0.0) {
        whole.press(&Tip(&facet.corners[k]), (TIP + k as u32, tip.count), found);
    }
    if !facet.edges.iter().map(|e| e.share).chain(facet.tips).any(|s| s.press > 0.0) {
        return;
    }
    let back = Frame::new(pose, &body.pose());
    let level = (level - n.dot(&two.frame.way)) / two.frame.scale;
    let floor = (floor - n.dot(&two.frame.way)) / two.frame.scale;
    let view = view.moved(&back.turn, back.scale, floor);
    let mut target = Part::none(body.core, view.turned(-level));
    on_body(body, facet, &back, (target.take(near), &view), found);
}

/// Facet edges and corners on a body, in its frame.
fn on_body(
    body: &PosedBody<'_>,
    facet: &Facet,
    back: &Frame,
    (target, view): (&impl Target, &View),
    found: &mut Manifold,
) {
    let reach = body.radius / body.scale;
    let corners = facet.corners.map(|x| back.point(&x));
    let presses = |share: &FeatureWeight| share.press > 0.0;
    let mut put = |number: u32, pressed: &Indentation, weight: f64| {
        let lengths = [0.0, reach, body.radius];
        found.push(touch(&body.pose(), PRESSING + number, pressed, weight, lengths, -1.0));
    };
    for (k, tip) in facet.tips.iter().enumerate().filter(|(_, t)| presses(t)) {
        if let Some(pressed) = edge_contact::corner(target, &corners[k], reach) {
            put(TIP + k as u32, &pressed, tip.press);
        }
    }
    for (k, edge) in facet.edges.iter().enumerate().filter(|(_, e)| presses(&e.share)) {
        let (from, to) = (corners[k], corners[(k + 1) % 3]);
        let around = Bounds::near([&from, &to], view);
        if !target.meets(&around) {
            continue;
        }
        let (direction, range) = (back.turn * edge.direction, [0.0, edge.length * back.scale]);
        if let Some(pressed) = edge_contact::edge(target, &Segment { from, direction, range, around }, reach)
        {
            put(EDGE + k as u32, &pressed, edge.share.press * dilated::length(&pressed, reach));
        }
    }
}

/// Numbered points that indent as corners, in the body's frame and unit.
pub(super) fn points_on_body(
    body: &PosedBody<'_>,
    points: impl Iterator<Item = (u32, Vec3)>,
    (own, reach, weight): (f64, f64, f64),
    found: &mut Manifold,
) {
    let mut target = Part::none(body.core, View::everywhere(Vec3::z(), reach));
    let target = target.all();
    let most = body.core.reach + reach;
    for (number, p) in points.filter(|(_, p)| p.norm_squared() < most * most) {
        if let Some(pressed) = edge_contact::corner(target, &p, reach) {
            let lengths = [own, reach, rounding(own * body.scale, body.radius)];
            let touch = touch(&body.pose(), number, &pressed, weight, lengths, -1.0);
            found.push(PairContactPoint {
                bound: (DEEPEST * body.radius).max(touch.bound - own * body.scale),
                ..touch
            });
        }
    }
}

#[cfg(test)]
#[path = "patch_tests.rs"]
mod tests;
