//! Raw triangle meshes.

use super::topology::{Topology, topology};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Triangles on shared vertices.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Surface {
    /// Vertices [m].
    pub vertices: Vec<[f64; 3]>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// Defect of a surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// No valid triangle.
    #[error("the surface has no triangle")]
    Empty,
    /// Unknown vertex.
    #[error("triangle {triangle} names vertex {vertex}, but there are only {count} (counted from 0)")]
    Index {
        /// Index of the triangle.
        triangle: usize,
        /// Vertex index.
        vertex: u32,
        /// Number of vertices.
        count: usize,
    },
    /// Non-finite coordinate.
    #[error("vertex {0} of the surface (counted from 0) has a coordinate that is not a finite number")]
    NotFinite(usize),
    /// Open edge.
    #[error(
        "the surface is open: {edges} edges have one triangle only, the first runs from {from:?} to {to:?}"
    )]
    Open {
        /// Number of open edges.
        edges: usize,
        /// First end [m].
        from: [f64; 3],
        /// Second end [m].
        to: [f64; 3],
    },
    /// Edge of more than two triangles.
    #[error(
        "the surface branches: {edges} edges have more than two triangles, the first runs from {from:?} to {to:?}"
    )]
    NonManifold {
        /// Number of such edges.
        edges: usize,
        /// First end [m].
        from: [f64; 3],
        /// Second end [m].
        to: [f64; 3],
    },
    /// One-sided surface, such as a Klein bottle.
    #[error(
        "the surface has one side only: triangle {0} (counted from 0) cannot be wound like its neighbours"
    )]
    OneSided(usize),
    /// No enclosed volume.
    #[error("the surface encloses no volume")]
    Flat,
}

impl Surface {
    /// Lower and upper bounds [m]; zero without vertices.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let Some(first) = self.vertices.first() else { return [[0.0; 3]; 2] };
        self.vertices.iter().fold([*first; 2], |[lo, hi], v| {
            [std::array::from_fn(|k| lo[k].min(v[k])), std::array::from_fn(|k| hi[k].max(v[k]))]
        })
    }

    /// Bounding box diagonal [m].
    pub fn diagonal(&self) -> f64 {
        let [lo, hi] = self.bounds();
        (Vector3::from(hi) - Vector3::from(lo)).norm()
    }

    /// Corners of a triangle [m].
    pub fn corners(&self, triangle: usize) -> [Vector3<f64>; 3] {
        self.triangles[triangle].map(|v| Vector3::from(self.vertices[v as usize]))
    }

    /// Surface area [m²].
    pub fn area(&self) -> f64 {
        let twice = |t| {
            let [a, b, c] = self.corners(t);
            (b - a).cross(&(c - a)).norm()
        };
        0.5 * (0..self.triangles.len()).map(twice).sum::<f64>()
    }

    /// Merges vertices within `tolerance` [m] (zero: identical ones) into the first; drops degenerate
    /// triangles and unused vertices.
    pub fn merged(&self, tolerance: f64) -> Surface {
        let cell = |x: f64| {
            if tolerance > 0.0 { (x / tolerance).floor() as i64 } else { (x + 0.0).to_bits() as i64 }
        };
        let mut kept: Vec<[f64; 3]> = Vec::new();
        let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        let steps: &[i64] = if tolerance > 0.0 { &[0, -1, 1] } else { &[0] };
        let mut place = |v: &[f64; 3]| {
            let home = v.map(cell);
            for (i, j, k) in steps
                .iter()
                .flat_map(|i| steps.iter().flat_map(move |j| steps.iter().map(move |k| (i, j, k))))
            {
                let near = [home[0].wrapping_add(*i), home[1].wrapping_add(*j), home[2].wrapping_add(*k)];
                for &c in cells.get(&near).into_iter().flatten() {
                    let apart = Vector3::from(kept[c as usize]) - Vector3::from(*v);
                    if apart.norm() <= tolerance {
                        return c;
                    }
                }
            }
            kept.push(*v);
            cells.entry(home).or_default().push(kept.len() as u32 - 1);
            kept.len() as u32 - 1
        };
        let mut number: Vec<Option<u32>> = vec![None; self.vertices.len()];
        let mut triangles = Vec::with_capacity(self.triangles.len());
        for t in &self.triangles {
            let [a, b, c] =
                t.map(|v| *number[v as usize].get_or_insert_with(|| place(&self.vertices[v as usize])));
            if a != b && b != c && c != a {
                triangles.push([a, b, c]);
            }
        }
        let merged = Surface { vertices: kept, triangles };
        merged.without_loose_vertices()
    }

    /// Drops unused vertices; order is kept.
    pub fn without_loose_vertices(self) -> Surface {
        let mut used = vec![false; self.vertices.len()];
        self.triangles.iter().flatten().for_each(|v| used[*v as usize] = true);
        let mut number = vec![0_u32; used.len()];
        let mut vertices = Vec::new();
        for (v, point) in self.vertices.iter().enumerate().filter(|(v, _)| used[*v]) {
            number[v] = vertices.len() as u32;
            vertices.push(*point);
        }
        let triangles = self.triangles.iter().map(|t| t.map(|v| number[v as usize])).collect();
        Surface { vertices, triangles }
    }

    /// Computes the connectivity.
    ///
    /// # Errors
    /// [`SurfaceError::Index`] if a vertex does not exist.
    pub fn topology(&self) -> Result<Topology, SurfaceError> {
        topology(self)
    }

    /// Winding number about `p` [m]: 1 inside a closed, outward-oriented surface, 0 outside; fractional if
    /// open.
    ///
    /// Solid angle: van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983), eq. 8.
    pub fn winding_number(&self, p: [f64; 3]) -> f64 {
        let p = Vector3::from(p);
        let angle = |t: usize| {
            let [a, b, c] = self.corners(t).map(|x| x - p);
            let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
            let volume = a.dot(&b.cross(&c));
            let base = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
            2.0 * libm::atan2(volume, base)
        };
        (0..self.triangles.len()).map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
    }
}
