//! Closed triangle surfaces: point-in-solid test, surface proximity, enclosed volume.
//!
//! A point is inside if a ray along +z crosses the surface an odd number of times. Edges are evaluated from
//! the lower vertex index, so neighbours agree bitwise and no tolerance is needed. Orientation is arbitrary;
//! every edge must join an even number of triangles.
//!
//! Source: crossing number with consistent edges (Haines, Graphics Gems IV, 1994; own form for triangles).

use crate::base::Vec3;
use crate::shape::polyhedron::Surface;
use crate::spatial::distance::Nearest;
use std::collections::BTreeMap;

/// Defect of a closed surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// No triangle.
    #[error("the surface has no triangle")]
    Empty,
    /// Non-finite vertex.
    #[error("vertex {0} of the surface is not finite")]
    NotFinite(usize),
    /// Unknown vertex.
    #[error("triangle {0} of the surface names a vertex that does not exist")]
    Index(usize),
    /// Open boundary.
    #[error("the surface is not closed: {edges} edges join an odd number of triangles, one at ({}, {}, {}) m", .at[0], .at[1], .at[2])]
    Open {
        /// Number of open edges.
        edges: usize,
        /// Midpoint of one [m].
        at: [f64; 3],
    },
}

/// Closed triangle surface.
#[derive(Clone, Debug)]
pub struct ClosedSurface {
    vertices: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    low: Vec3,
    high: Vec3,
    /// Triangles by grid cell in x and y.
    plan: Vec<Vec<u32>>,
    counts: [usize; 2],
    width: [f64; 2],
    nearest: Nearest,
    volume: f64,
}

impl ClosedSurface {
    /// Checks the surface; coincident vertices are merged.
    ///
    /// # Errors
    /// [`SurfaceError`] for no triangle, an invalid vertex or an open boundary.
    pub fn new(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<ClosedSurface, SurfaceError> {
        if triangles.is_empty() {
            return Err(SurfaceError::Empty);
        }
        if let Some(k) = vertices.iter().position(|v| !v.iter().all(|x| x.is_finite())) {
            return Err(SurfaceError::NotFinite(k));
        }
        if let Some(k) = triangles.iter().position(|t| t.iter().any(|&v| v as usize >= vertices.len())) {
            return Err(SurfaceError::Index(k));
        }
        let (vertices, triangles) = welded(vertices, triangles);
        if triangles.is_empty() {
            return Err(SurfaceError::Empty);
        }
        closed(&vertices, &triangles)?;
        let low = vertices.iter().fold(Vec3::repeat(f64::INFINITY), |a, v| a.inf(v));
        let high = vertices.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |a, v| a.sup(v));
        let side = (high - low).map(|l| l.max(1e-12 * (high - low).max()));
        // About two triangles per column.
        let columns = ((triangles.len() as f64 / 2.0).sqrt().ceil() as usize).clamp(1, 400);
        let unit = side.max() / columns as f64;
        let counts: [usize; 2] =
            std::array::from_fn(|d| ((side[d] / unit).ceil() as usize).clamp(1, columns));
        let mut surface = ClosedSurface {
            low,
            high,
            plan: vec![Vec::new(); counts[0] * counts[1]],
            width: std::array::from_fn(|d| side[d] / counts[d] as f64),
            counts,
            nearest: Nearest::new(Surface {
                vertices: vertices.iter().map(|v| (*v).into()).collect(),
                triangles: triangles.clone(),
            }),
            vertices,
            triangles,
            volume: 0.0,
        };
        for t in 0..surface.triangles.len() {
            let [a, b, c] = surface.corners(t);
            let (from, to) = (surface.cell(&a.inf(&b).inf(&c)), surface.cell(&a.sup(&b).sup(&c)));
            for i in from[0]..=to[0] {
                for j in from[1]..=to[1] {
                    surface.plan[i * counts[1] + j].push(t as u32);
                }
            }
        }
        surface.volume = surface.enclosed();
        Ok(surface)
    }

    /// Distinct vertices [m].
    pub fn vertices(&self) -> &[Vec3] {
        &self.vertices
    }

    /// Vertex indices of each triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Bounding box [m].
    pub fn bounds(&self) -> (Vec3, Vec3) {
        (self.low, self.high)
    }

    /// Enclosed volume [m³].
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Returns true if a point is inside.
    pub fn contains(&self, p: &Vec3) -> bool {
        if (0..3).any(|d| !(p[d] >= self.low[d] && p[d] <= self.high[d])) {
            return false;
        }
        let [i, j] = self.cell(p);
        let above = self.plan[i * self.counts[1] + j].iter().filter(|t| self.crossed(**t as usize, p));
        above.count() % 2 == 1
    }

    /// Returns true if a sphere is entirely inside.
    pub fn holds(&self, centre: &Vec3, radius: f64) -> bool {
        self.contains(centre) && !self.meets(centre, radius)
    }

    /// Returns true if the surface intersects a sphere.
    pub fn meets(&self, centre: &Vec3, radius: f64) -> bool {
        self.nearest.closest((*centre).into()).distance < radius
    }

    fn corners(&self, t: usize) -> [Vec3; 3] {
        self.triangles[t].map(|v| self.vertices[v as usize])
    }

    fn cell(&self, p: &Vec3) -> [usize; 2] {
        std::array::from_fn(|d| {
            (((p[d] - self.low[d]) / self.width[d]).max(0.0) as usize).min(self.counts[d] - 1)
        })
    }

    /// Ray from `p` along +z.
    fn crossed(&self, t: usize, p: &Vec3) -> bool {
        let ids = self.triangles[t];
        let mut ends = [[0.0; 2]; 2];
        let mut found = 0;
        for k in 0..3 {
            let (a, b) = (ids[k].min(ids[(k + 1) % 3]), ids[k].max(ids[(k + 1) % 3]));
            let (a, b) = (&self.vertices[a as usize], &self.vertices[b as usize]);
            if (a.y > p.y) != (b.y > p.y) {
                let share = (p.y - a.y) / (b.y - a.y);
                ends[found.min(1)] = [a.x + share * (b.x - a.x), a.z + share * (b.z - a.z)];
                found += 1;
            }
        }
        if found != 2 || (ends[0][0] > p.x) == (ends[1][0] > p.x) {
            return false;
        }
        let share = (p.x - ends[0][0]) / (ends[1][0] - ends[0][0]);
        ends[0][1] + share * (ends[1][1] - ends[0][1]) > p.z
    }

    /// ⅓ Σ x·n A with outward normals.
    fn enclosed(&self) -> f64 {
        let middle = 0.5 * (self.low + self.high);
        let small = 1e-7 * (self.high - self.low).norm();
        let mut sum = 0.0;
        for t in 0..self.triangles.len() {
            let [a, b, c] = self.corners(t);
            let area = (b - a).cross(&(c - a)) * 0.5;
            let size = area.norm();
            if size > 0.0 {
                let (centre, step) = ((a + b + c) / 3.0, area * (small / size));
                let (front, back) = (self.contains(&(centre + step)), self.contains(&(centre - step)));
                let sign = f64::from(u8::from(back)) - f64::from(u8::from(front));
                sum += sign * (centre - middle).dot(&area) / 3.0;
            }
        }
        sum
    }
}

fn welded(vertices: &[Vec3], triangles: &[[u32; 3]]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut seen: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let mut kept = Vec::new();
    let number: Vec<u32> = vertices
        .iter()
        .map(|v| {
            // Adding 0 maps −0 to 0.
            let key: [u64; 3] = std::array::from_fn(|d| (v[d] + 0.0).to_bits());
            *seen.entry(key).or_insert_with(|| {
                kept.push(*v);
                kept.len() as u32 - 1
            })
        })
        .collect();
    let renamed = triangles.iter().map(|t| t.map(|v| number[v as usize]));
    let whole = renamed.filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]).collect();
    (kept, whole)
}

fn closed(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<(), SurfaceError> {
    let mut edges: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    for t in triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *edges.entry([a.min(b), a.max(b)]).or_default() += 1;
        }
    }
    let mut odd = edges.iter().filter(|(_, n)| *n % 2 == 1).map(|(e, _)| e);
    let Some(first) = odd.next() else { return Ok(()) };
    let middle = (vertices[first[0] as usize] + vertices[first[1] as usize]) * 0.5;
    Err(SurfaceError::Open { edges: odd.count() + 1, at: middle.into() })
}

#[cfg(test)]
#[path = "closed_tests.rs"]
mod tests;
