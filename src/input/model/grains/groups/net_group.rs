//! Groups of a net: places of spheres on a lattice, pairs of neighbours along ribs.

use std::collections::BTreeMap;
use trackbed_dem::Vec3;

/// Numbers of a sphere along and across, from 0 at the corner.
pub(super) type Place = [usize; 2];

/// Group of a net: with other groups of the same bond and geometry it forms one net.
#[derive(Clone, Debug)]
pub struct NetGroup {
    /// Group index.
    pub part: u32,
    pub(super) kind: Option<usize>,
    pub(super) geometry: Geometry,
    pub(super) bodies: BTreeMap<Place, usize>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Geometry {
    pub corner: Vec3,
    /// From sphere to sphere [m].
    pub steps: [Vec3; 2],
    /// Numbers of the last spheres.
    pub last: Place,
    /// Spheres per rib.
    pub each: usize,
}

/// Pairs of neighbours along ribs, in `this` or between it and the `others` of its net, with the axis of the rib.
pub(super) fn joined(this: &NetGroup, others: &[NetGroup]) -> Vec<([usize; 2], usize)> {
    let same = |n: &&NetGroup| n.kind == this.kind && n.geometry.matches(&this.geometry);
    let mut all: BTreeMap<Place, usize> =
        others.iter().filter(same).flat_map(|n| &n.bodies).map(|(p, b)| (*p, *b)).collect();
    all.extend(&this.bodies);
    let mut pairs = Vec::new();
    for (place, body) in &all {
        for axis in 0..2 {
            let mut next = *place;
            next[axis] += 1;
            // Ribs run along an axis where the other number is a node's.
            let rib = place[1 - axis].is_multiple_of(this.geometry.each);
            if let Some(other) = all.get(&next).filter(|_| rib)
                && (this.bodies.contains_key(place) || this.bodies.contains_key(&next))
            {
                pairs.push(([*body, *other], axis));
            }
        }
    }
    pairs
}

/// Difference of places that counts as rounding, over the distance of spheres.
const ROUNDING: f64 = 1e-3;

impl Geometry {
    /// Whether the spheres have the same places.
    pub fn matches(&self, other: &Geometry) -> bool {
        let corners = [[0, 0], [self.last[0], 0], [0, self.last[1]]];
        let near = |p: Place| (self.position(p) - other.position(p)).norm() < ROUNDING * self.steps[0].norm();
        self.last == other.last && self.each == other.each && corners.into_iter().all(near)
    }

    pub fn position(&self, [i, j]: Place) -> Vec3 {
        self.corner + self.steps[0] * i as f64 + self.steps[1] * j as f64
    }
}

/// Places of nodes and of the spheres between them.
pub(super) fn places(last: Place, each: usize) -> impl Iterator<Item = Place> {
    let all = (0..=last[1]).flat_map(move |j| (0..=last[0]).map(move |i| [i, j]));
    all.filter(move |[i, j]| i.is_multiple_of(each) || j.is_multiple_of(each))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ribs_have_spheres_between_nodes() {
        // 2 × 1 meshes of four spheres a rib: 6 nodes, 7 ribs with three spheres each.
        assert_eq!(places([8, 4], 4).count(), 6 + 7 * 3);
        assert_eq!(places([8, 0], 4).count(), 9);
        assert_eq!(places([3, 2], 1).count(), 12);
    }

    #[test]
    fn groups_of_a_net_are_joined() {
        let geometry =
            Geometry { corner: Vec3::zeros(), steps: [Vec3::x(), Vec3::y()], last: [8, 4], each: 4 };
        let mut count = 0;
        let mut of = |part, side: bool| {
            let inside = places([8, 4], 4).filter(|[i, _]| (*i == 0) == side);
            let bodies = inside
                .map(|p| {
                    count += 1;
                    (p, count - 1)
                })
                .collect();
            NetGroup { part, kind: Some(0), geometry, bodies }
        };
        let (net, border) = (of(0, false), of(1, true));
        // 7 ribs of four bonds, of which four lie on the border and two lead to it.
        assert_eq!(joined(&net, &[]).len(), 7 * 4 - 4 - 2);
        assert_eq!(joined(&border, &[]).len(), 4);
        assert_eq!(joined(&border, std::slice::from_ref(&net)).len(), 4 + 2);
        let other = NetGroup { kind: Some(1), ..net };
        assert_eq!(joined(&border, &[other]).len(), 4);
    }
}
