//! Surface triangles in contact with bodies with faces.
//!
//! A point's contact is the sum over triangles, minus shared edges, plus interior corners: exact for convex
//! unions, as distances are a valuation (Hadwiger, Vorlesungen über Inhalt, Oberfläche und Isoperimetrie,
//! 1957; Groemer 1978), and smooth across seams.
//!
//! Theory manual: equation (2.9) of `docs/theory/shapes.md`.

use super::bvh::Aabb;
use crate::base::Vec3;
use std::collections::HashMap;

/// Sine of the bend with full indentation (half a degree); proportional below.
const FULL: f64 = 0.01;

/// Angle defect with full indentation [rad].
const PEAK: f64 = 0.01;

/// Height over length that counts as rounding.
const LEVEL: f64 = 1e-9;

#[derive(Clone, Copy, Debug, Default)]
pub struct FeatureWeight {
    /// Multiplicity.
    pub count: f64,
    /// Indentation fraction.
    pub press: f64,
}

#[derive(Clone, Copy, Debug)]
pub struct FacetEdge {
    /// Unit vector, length [m].
    pub direction: Vec3,
    pub length: f64,
    /// Outward unit normal in the facet plane.
    pub side: Vec3,
    pub share: FeatureWeight,
}

#[derive(Clone, Debug)]
pub struct Facet {
    pub corners: [Vec3; 3],
    pub normal: Vec3,
    pub edges: [FacetEdge; 3],
    pub tips: [FeatureWeight; 3],
}

impl Facet {
    fn new(corners: [Vec3; 3]) -> Facet {
        let [a, b, c] = corners;
        let normal = (b - a).cross(&(c - a)).normalize();
        let edges = [0, 1, 2].map(|k: usize| {
            let way = corners[(k + 1) % 3] - corners[k];
            let length = way.norm();
            let direction = way / length;
            FacetEdge { direction, length, side: direction.cross(&normal), share: FeatureWeight::default() }
        });
        Facet { corners, normal, edges, tips: [FeatureWeight::default(); 3] }
    }

    /// The same facet at other corners.
    #[inline]
    pub fn at(&self, corners: [Vec3; 3]) -> Facet {
        let mut moved = Facet::new(corners);
        (0..3).for_each(|k| moved.edges[k].share = self.edges[k].share);
        Facet { tips: self.tips, ..moved }
    }

    /// Interior angle [rad].
    fn angle(&self, k: usize) -> f64 {
        let (out, back) = (self.edges[k].direction, -self.edges[(k + 2) % 3].direction);
        libm::atan2(out.cross(&back).norm(), out.dot(&back))
    }

    #[inline]
    pub fn bounds(&self) -> Aabb {
        let [a, b, c] = &self.corners;
        (a.inf(b).inf(c).into(), a.sup(b).sup(c).into())
    }
}

/// Assigns each edge and corner to its first facet; `same`: lowest coincident vertex of each vertex.
#[inline]
pub fn facets(vertices: &[Vec3], triangles: &[[u32; 3]], same: &[u32]) -> Vec<Facet> {
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
        facets[t].edges[k].share = FeatureWeight { count: 1.0 - of.len() as f64, press };
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
        facets[t].tips[k] = FeatureWeight { count, press: own.press(std::f64::consts::TAU - angle) };
    }
    facets
}

#[derive(Default)]
struct Around {
    /// Triangles at edges ending here, minus one each.
    seams: f64,
    /// Directions of boundaries.
    borders: Vec<Vec3>,
}

impl Around {
    /// Indentation fraction for an angle defect [rad].
    fn press(&self, missing: f64) -> f64 {
        match self.borders[..] {
            [] => (missing / PEAK).clamp(0.0, 1.0),
            // Needle tip.
            [a, b] if a.dot(&b) > 0.0 => 1.0,
            // Straight boundary.
            [a, b] => (a.cross(&b).norm() / FULL).clamp(0.0, 1.0),
            _ => 1.0,
        }
    }
}

/// 1 for boundaries, else by bend. The sign is irrelevant: concave edges are out of contact.
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
