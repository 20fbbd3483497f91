//! Triangles of a surface as bodies with faces and edges press on them.
//!
//! A point presses on the surface by what it does to each triangle, less what it does to every edge that triangles share, plus what it
//! does to the corners inside: distances to the closed triangle, edge and corner. On convex sets that unite to a convex one such sums are exact
//! (distances are a valuation: Hadwiger, Vorlesungen über Inhalt, Oberfläche und Isoperimetrie, 1957; Groemer 1978), so that flat triangles
//! press as the polygon that they make up, ridges once, and both sides of a valley. Each term is smooth wherever the point goes, and so
//! is the sum: a seam is not felt.
//!
//! What presses into the bodies in return are edges where the surface bends (in full from half a degree on), its borders, and corners around
//! which an angle is missing: not what lies flat.
//!
//! Theory manual: equation (2.9) of `docs/theory/shapes.md`.

use super::bvh::Aabb;
use crate::base::Vec3;
use std::collections::HashMap;

/// Sine of the bend from which a ridge presses in full; less by its share. Half a degree.
const FULL: f64 = 0.01;

/// Missing angle around a corner from which it presses in full [rad].
const PEAK: f64 = 0.01;

/// Height over length that counts as rounding.
const LEVEL: f64 = 1e-9;

/// An edge or a corner of a facet that it answers for.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Share {
    /// How often what it does is added.
    pub count: f64,
    /// Share of it that presses into bodies.
    pub press: f64,
}

/// An edge of a facet, from its k-th corner to the next.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FacetEdge {
    /// Unit vector along it, and its length [m].
    pub direction: Vec3,
    pub length: f64,
    /// Outward unit normal in the plane of the facet.
    pub side: Vec3,
    pub share: Share,
}

/// A triangle.
#[derive(Clone, Debug)]
pub(crate) struct Facet {
    pub corners: [Vec3; 3],
    pub normal: Vec3,
    pub edges: [FacetEdge; 3],
    pub tips: [Share; 3],
}

impl Facet {
    fn new(corners: [Vec3; 3]) -> Facet {
        let [a, b, c] = corners;
        let normal = (b - a).cross(&(c - a)).normalize();
        let edges = [0, 1, 2].map(|k: usize| {
            let way = corners[(k + 1) % 3] - corners[k];
            let length = way.norm();
            let direction = way / length;
            FacetEdge { direction, length, side: direction.cross(&normal), share: Share::default() }
        });
        Facet { corners, normal, edges, tips: [Share::default(); 3] }
    }

    /// The same triangle, with the same shares, elsewhere.
    pub fn at(&self, corners: [Vec3; 3]) -> Facet {
        let mut moved = Facet::new(corners);
        (0..3).for_each(|k| moved.edges[k].share = self.edges[k].share);
        Facet { tips: self.tips, ..moved }
    }

    /// Angle at a corner [rad].
    fn angle(&self, k: usize) -> f64 {
        let (out, back) = (self.edges[k].direction, -self.edges[(k + 2) % 3].direction);
        libm::atan2(out.cross(&back).norm(), out.dot(&back))
    }

    /// Bounds.
    pub fn bounds(&self) -> Aabb {
        let [a, b, c] = &self.corners;
        (a.inf(b).inf(c).into(), a.sup(b).sup(c).into())
    }
}

/// Facets with what each answers for: the first that has an edge or a corner does. `same` has for each vertex the lowest at the same place.
pub(crate) fn facets(vertices: &[Vec3], triangles: &[[u32; 3]], same: &[u32]) -> Vec<Facet> {
    let welded: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|v| same[v as usize])).collect();
    let mut facets: Vec<Facet> = welded.iter().map(|t| Facet::new(t.map(|v| vertices[v as usize]))).collect();
    let mut edges: HashMap<[u32; 2], Vec<(usize, usize)>> = HashMap::new();
    let mut tips: HashMap<u32, Vec<(usize, usize)>> = HashMap::new();
    for (t, v) in welded.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (v[k], v[(k + 1) % 3]);
            edges.entry([a.min(b), a.max(b)]).or_default().push((t, k));
            tips.entry(v[k]).or_default().push((t, k));
        }
    }
    let mut around: HashMap<u32, Around> = HashMap::new();
    for (ends, of) in &edges {
        let press = ridge(&facets, of, ends.map(|v| vertices[v as usize]));
        let (t, k) = of[0];
        facets[t].edges[k].share = Share { count: 1.0 - of.len() as f64, press };
        for (v, other) in [(ends[0], ends[1]), (ends[1], ends[0])] {
            let own = around.entry(v).or_default();
            own.seams += of.len() as f64 - 1.0;
            if of.len() == 1 {
                own.borders.push((vertices[other as usize] - vertices[v as usize]).normalize());
            }
        }
    }
    for (v, of) in &tips {
        let own = &around[v];
        let angle: f64 = of.iter().map(|(t, k)| facets[*t].angle(*k)).sum();
        let (t, k) = of[0];
        let count = 1.0 - of.len() as f64 + own.seams;
        facets[t].tips[k] = Share { count, press: own.press(std::f64::consts::TAU - angle) };
    }
    facets
}

/// What meets in a corner.
#[derive(Default)]
struct Around {
    /// Triangles at the edges that end here, less one each.
    seams: f64,
    /// Ways along borders.
    borders: Vec<Vec3>,
}

impl Around {
    /// Share of the corner that presses, of an angle that is missing around it [rad].
    fn press(&self, missing: f64) -> f64 {
        match self.borders[..] {
            [] => (missing / PEAK).clamp(0.0, 1.0),
            // A needle's tip.
            [a, b] if a.dot(&b) > 0.0 => 1.0,
            // A border that goes straight on, with nothing else to press.
            [a, b] => (a.cross(&b).norm() / FULL).clamp(0.0, 1.0),
            _ => 1.0,
        }
    }
}

/// Share of an edge that presses: one for borders, by the bend for others, whichever side it is seen from: from the hollow one it is out of
/// reach of bodies.
fn ridge(facets: &[Facet], of: &[(usize, usize)], ends: [Vec3; 2]) -> f64 {
    let &[(s, i), (t, j)] = of else { return 1.0 };
    let (first, second) = (&facets[s], &facets[t]);
    let [own, other] = [first.edges[i].side, second.edges[j].side];
    let apex = second.corners[(j + 2) % 3] - ends[0];
    let bend = if own.dot(&other) > 0.0 { 1.0 } else { own.cross(&other).norm() };
    let level = own.dot(&other) < 0.0 && apex.dot(&first.normal).abs() <= LEVEL * apex.norm();
    if level { 0.0 } else { (bend / FULL).min(1.0) }
}

#[cfg(test)]
#[path = "facet_tests.rs"]
mod tests;
