//! Wall–wall contacts: triangulated bodies (`spatial/shell.rs`) with triangulated surfaces and round patches,
//! concave ones included. Penetration ends the run.

use super::dilated::{DEEPEST, Frame, length, lost, rounding, touch};
use super::facet::{Closed, Rim, Tip};
use super::pair::{Manifold, PairContactPoint};
use super::round::{self, Indenter};
use super::scene::Pose;
use crate::base::Vec3;
use crate::shape::dilated::edge_contact::{self, Indentation, Segment, Target};
use crate::shape::dilated::part::{Bounds, View};
use crate::spatial::bvh::Aabb;
use crate::spatial::facet::{Facet, FeatureWeight};
use crate::spatial::round::Round;
use crate::spatial::shell::Shell;

/// Numbers of triangle parts as indenter and target: face, edges, corners.
const FACE: u32 = 0;
const EDGE: u32 = 1;
const TIP: u32 = 4;
const PARTS: u32 = 8;

const ROUND_PARTS: u32 = 128;

/// Flag: the second partner indents.
const TURNED: u32 = 1 << 31;

/// History key: indenter, target.
pub type Name = [u32; 2];

/// Wall–wall contacts; names ascend.
#[derive(Clone, Debug, Default)]
pub struct WallContactList {
    pub names: Vec<Name>,
    pub touches: Manifold,
    rows: [Vec<u32>; 2],
}

impl WallContactList {
    pub fn clear(&mut self) {
        self.names.clear();
        self.touches.clear();
    }

    /// Sorts by name.
    fn sort(&mut self) {
        let order = &mut self.rows[0];
        order.clear();
        order.extend(0..self.names.len() as u32);
        order.sort_unstable_by_key(|k| self.names[*k as usize]);
        for to in 0..order.len() {
            // Displaced by an earlier swap.
            let mut from = order[to] as usize;
            while from < to {
                from = order[from] as usize;
            }
            self.names.swap(to, from);
            self.touches.swap(to, from);
        }
    }

    fn push(&mut self, name: Name, touch: PairContactPoint) {
        self.names.push(name);
        self.touches.push(touch);
    }
}

#[derive(Clone, Copy)]
pub struct ShellPose<'a> {
    pub shell: &'a Shell,
    pub pose: Pose,
}

pub fn shells(a: &ShellPose<'_>, b: &ShellPose<'_>, found: &mut WallContactList) {
    ShellIndenter::new(a, b.pose, a.shell.radius + b.shell.radius, false).on_shell(b.shell, found);
    ShellIndenter::new(b, a.pose, a.shell.radius + b.shell.radius, true).on_shell(a.shell, found);
}

/// Adds contacts with round patches in frame `pose`.
pub fn rounds(
    a: &ShellPose<'_>,
    inner_point: &Vec3,
    forms: &[Round],
    pose: Pose,
    found: &mut WallContactList,
) {
    let pressing = ShellIndenter::new(a, pose, a.shell.radius, false);
    for (form, first) in forms.iter().zip((0..).step_by(ROUND_PARTS as usize)) {
        let bounds = form.bounds();
        if apart(&pressing.bounds(), &grown(&bounds, a.shell.radius)) {
            continue;
        }
        let inner_point = pressing.frame.point(inner_point);
        round::on(form, &mut OnRound { pressing: &pressing, inner_point, bounds, first, found: &mut *found });
    }
    // Found patch by patch.
    found.sort();
}

fn grown((low, high): &Aabb, by: f64) -> Aabb {
    (low.map(|x| x - by), high.map(|x| x + by))
}

fn apart((low, high): &Aabb, (from, to): &Aabb) -> bool {
    (0..3).any(|d| low[d] > to[d] || high[d] < from[d])
}

/// Bounds in another frame.
fn seen(frame: &Frame, (low, high): &Aabb) -> Aabb {
    // Planes are unbounded.
    let [low, high] = [low, high].map(|x| Vec3::from(x.map(|x| x.clamp(-1e18, 1e18))));
    let middle = frame.point(&((low + high) * 0.5));
    let half = frame.turn.matrix().abs() * ((high - low) * (0.5 * frame.scale));
    ((middle - half).into(), (middle + half).into())
}

struct ShellIndenter<'a> {
    shell: &'a Shell,
    /// Frames of shell and target.
    own: Pose,
    pose: Pose,
    /// Shell to target, back.
    frame: Frame,
    back: Frame,
    reach: f64,
    turned: bool,
    view: View,
}

/// Indenting corner or edge.
enum Feature {
    Corner(Vec3),
    Edge(Segment),
}

impl Feature {
    fn on(&self, target: &impl Target, reach: f64) -> Option<Indentation> {
        match self {
            Feature::Corner(p) => edge_contact::corner(target, p, reach),
            Feature::Edge(segment) => edge_contact::edge(target, segment, reach),
        }
    }

    /// Visits each loaded part: number, indentation, weight.
    fn on_parts(&self, facet: &Facet, reach: f64, mut f: impl FnMut(u32, &Indentation, f64)) {
        let mut put = |part: u32, pressed: Option<Indentation>, count: f64| {
            pressed.iter().for_each(|pressed| f(part, pressed, count));
        };
        put(FACE, self.on(&Closed(facet), reach), 1.0);
        for (k, edge) in facet.edges.iter().enumerate().filter(|(_, e)| e.share.count != 0.0) {
            put(EDGE + k as u32, self.on(&Rim(&facet.corners[k], edge), reach), edge.share.count);
        }
        for (k, tip) in facet.tips.iter().enumerate().filter(|(_, t)| t.count != 0.0) {
            put(TIP + k as u32, self.on(&Tip(&facet.corners[k]), reach), tip.count);
        }
    }

    fn beside(&self, facet: &Facet, reach: f64) -> bool {
        let height = |p: &Vec3| (p - facet.corners[0]).dot(&facet.normal);
        match self {
            Feature::Corner(p) => height(p).abs() > reach,
            Feature::Edge(s) => {
                let [a, b] = [height(&s.from), height(&(s.from + s.direction * s.range[1]))];
                a.min(b) > reach || a.max(b) < -reach
            }
        }
    }

    /// Bounds including `reach`.
    fn bounds(&self, reach: f64) -> Aabb {
        let (a, b) = match self {
            Feature::Corner(p) => (*p, *p),
            Feature::Edge(s) => (s.from, s.from + s.direction * s.range[1]),
        };
        grown(&(a.inf(&b).into(), a.sup(&b).into()), reach)
    }
}

impl<'a> ShellIndenter<'a> {
    fn new(of: &ShellPose<'a>, pose: Pose, reach: f64, turned: bool) -> ShellIndenter<'a> {
        let (frame, back) = (Frame::new(&of.pose, &pose), Frame::new(&pose, &of.pose));
        let view = View::everywhere(Vec3::z(), reach);
        ShellIndenter { shell: of.shell, own: of.pose, pose, frame, back, reach, turned, view }
    }

    /// Bounds in the target's frame.
    fn bounds(&self) -> Aabb {
        seen(&self.frame, &self.shell.bounds)
    }

    /// Visits features possibly near: number, weight, geometry in the target's frame.
    fn features(&self, within: &Aabb, row: &mut Vec<u32>, mut f: impl FnMut(u32, f64, Feature)) {
        let (low, high) = seen(&self.back, &grown(within, self.reach));
        row.clear();
        self.shell.tree.query(low, high, row);
        for &t in row.iter() {
            let Facet { corners, edges, tips, .. } = &self.shell.facets[t as usize];
            let presses = |share: &FeatureWeight| share.press > 0.0;
            for (k, edge) in edges.iter().enumerate().filter(|(_, e)| presses(&e.share)) {
                let from = self.frame.point(&corners[k]);
                let to = self.frame.point(&corners[(k + 1) % 3]);
                let around = Bounds::near([&from, &to], &self.view);
                let direction = self.frame.turn * edge.direction;
                let segment = Segment { from, direction, range: [0.0, edge.length], around };
                f(t * PARTS + EDGE + k as u32, edge.share.press, Feature::Edge(segment));
            }
            for (k, tip) in tips.iter().enumerate().filter(|(_, t)| presses(t)) {
                f(t * PARTS + TIP + k as u32, tip.press, Feature::Corner(self.frame.point(&corners[k])));
            }
        }
    }

    /// Contact weighted by `count`.
    fn touch(&self, pressed: &Indentation, count: f64) -> PairContactPoint {
        let weight = if pressed.edge { count * length(pressed, self.reach) } else { count };
        let own = self.shell.radius;
        let lengths = [own, self.reach, rounding(own, self.reach)];
        touch(&self.pose, 0, pressed, weight, lengths, if self.turned { -1.0 } else { 1.0 })
    }

    /// Penetration of a surface.
    fn lost(&self, p: &Vec3, normal: &Vec3) -> PairContactPoint {
        lost(self.pose.centre + self.pose.orientation * p, self.pose.orientation * normal, self.reach)
    }

    fn on_shell(&self, target: &Shell, found: &mut WallContactList) {
        let [mut row, mut near] = std::mem::take(&mut found.rows);
        self.features(&target.bounds, &mut row, |number, share, feature| {
            let number = number | if self.turned { TURNED } else { 0 };
            let (low, high) = feature.bounds(self.reach);
            near.clear();
            target.tree.query(low, high, &mut near);
            for &t in &near {
                let facet = &target.facets[t as usize];
                if feature.beside(facet, self.reach) {
                    continue;
                }
                let first = t * PARTS;
                feature.on_parts(facet, self.reach, |part, pressed, count| {
                    found.push([number, first + part], self.touch(pressed, share * count));
                });
                if let Feature::Edge(segment) = &feature
                    && let Some(p) = pierced(facet, segment)
                {
                    found.push([number, first + PARTS - 1], self.lost(&p, &facet.normal));
                }
            }
        });
        found.rows = [row, near];
    }
}

fn pierced(facet: &Facet, segment: &Segment) -> Option<Vec3> {
    let height = |p: &Vec3| (p - facet.corners[0]).dot(&facet.normal);
    let to = segment.from + segment.direction * segment.range[1];
    let [from, up] = [height(&segment.from), height(&to)];
    if from * up >= 0.0 {
        return None;
    }
    let p = segment.from + (to - segment.from) * (from / (from - up));
    let inside = facet.edges.iter().zip(&facet.corners).all(|(e, corner)| (p - corner).dot(&e.side) < 0.0);
    inside.then_some(p)
}

/// Shell on a round patch: bounds, first part number.
struct OnRound<'a, 'b> {
    pressing: &'b ShellIndenter<'a>,
    inner_point: Vec3,
    bounds: Aabb,
    first: u32,
    found: &'b mut WallContactList,
}

impl Indenter for OnRound<'_, '_> {
    fn inner_point(&self) -> Vec3 {
        self.inner_point
    }

    fn reach(&self) -> f64 {
        self.pressing.reach
    }

    fn press(&mut self, target: &impl Target, (part, count): (u32, f64)) {
        let (pressing, found) = (self.pressing, &mut *self.found);
        let [mut row, near] = std::mem::take(&mut found.rows);
        pressing.features(&self.bounds, &mut row, |number, share, feature| {
            if let Some(pressed) = feature.on(target, pressing.reach) {
                found.push([number, self.first + part], pressing.touch(&pressed, share * count));
            }
        });
        found.rows = [row, near];
    }

    fn bear(&mut self, points: impl Iterator<Item = (u32, Vec3)>, (own, reach, weight): (f64, f64, f64)) {
        let (pressing, found) = (self.pressing, &mut *self.found);
        let shell = pressing.shell;
        let [mut row, near] = std::mem::take(&mut found.rows);
        for (number, p) in points {
            let corner = Feature::Corner(pressing.back.point(&p));
            let (low, high) = corner.bounds(reach);
            row.clear();
            shell.tree.query(low, high, &mut row);
            for &t in &row {
                let facet = &shell.facets[t as usize];
                corner.on_parts(facet, reach, |part, pressed, count| {
                    let lengths = [own, reach, rounding(own, shell.radius)];
                    let touch = touch(&pressing.own, 0, pressed, weight * count, lengths, -1.0);
                    let bound = (DEEPEST * shell.radius).max(touch.bound - own);
                    found.push(
                        [TURNED | (self.first + number), t * PARTS + part],
                        PairContactPoint { bound, ..touch },
                    );
                });
            }
        }
        found.rows = [row, near];
    }

    fn through(&mut self, form: &Round) -> bool {
        let mut through = false;
        self.pressing.features(&self.bounds, &mut self.found.rows[0], |_, _, feature| {
            through |= matches!(&feature, Feature::Edge(segment) if round::pierced(form, segment));
        });
        through
    }

    fn lose(&mut self, normal: &Vec3) {
        let lost = self.pressing.lost(&self.inner_point, normal);
        self.found.push([u32::MAX, self.first], lost);
    }
}

#[cfg(test)]
#[path = "shell_tests.rs"]
mod tests;
