//! Triangles as a file holds them.

use super::topology::{Topology, topology};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Triangles on common vertices.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Surface {
    /// Coordinates of the vertices [m].
    pub vertices: Vec<[f64; 3]>,
    /// Vertices of each triangle, counted from 0.
    pub triangles: Vec<[u32; 3]>,
}

/// Why a surface bounds no volume.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// No triangle with three different vertices.
    #[error("the surface has no triangle")]
    Empty,
    /// A vertex that does not exist.
    #[error("triangle {triangle} names vertex {vertex}, but there are only {count} (counted from 0)")]
    Index {
        /// Index of the triangle, from 0.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// Number of vertices.
        count: usize,
    },
    /// A coordinate is not a finite number.
    #[error("vertex {0} of the surface (counted from 0) has a coordinate that is not a finite number")]
    NotFinite(usize),
    /// An edge with one triangle only.
    #[error(
        "the surface is open: {edges} edges have one triangle only, the first runs from {from:?} to {to:?}"
    )]
    Open {
        /// Number of such edges.
        edges: usize,
        /// One end of the first [m].
        from: [f64; 3],
        /// Its other end [m].
        to: [f64; 3],
    },
    /// An edge with more than two triangles.
    #[error(
        "the surface branches: {edges} edges have more than two triangles, the first runs from {from:?} to {to:?}"
    )]
    NonManifold {
        /// Number of such edges.
        edges: usize,
        /// One end of the first [m].
        from: [f64; 3],
        /// Its other end [m].
        to: [f64; 3],
    },
    /// A one-sided surface such as a Klein bottle.
    #[error(
        "the surface has one side only: triangle {0} (counted from 0) cannot be wound like its neighbours"
    )]
    OneSided(usize),
    /// A closed surface around nothing.
    #[error("the surface encloses no volume")]
    Flat,
}

impl Surface {
    /// Lowest and highest coordinates [m]; zeros without vertices.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let Some(first) = self.vertices.first() else { return [[0.0; 3]; 2] };
        self.vertices.iter().fold([*first; 2], |[lo, hi], v| {
            [std::array::from_fn(|k| lo[k].min(v[k])), std::array::from_fn(|k| hi[k].max(v[k]))]
        })
    }

    /// Length of the diagonal of the bounding box [m].
    pub fn diagonal(&self) -> f64 {
        let [lo, hi] = self.bounds();
        (Vector3::from(hi) - Vector3::from(lo)).norm()
    }

    /// Corners of a triangle [m].
    pub fn corners(&self, triangle: usize) -> [Vector3<f64>; 3] {
        self.triangles[triangle].map(|v| Vector3::from(self.vertices[v as usize]))
    }

    /// Area [m²].
    pub fn area(&self) -> f64 {
        let twice = |t| {
            let [a, b, c] = self.corners(t);
            (b - a).cross(&(c - a)).norm()
        };
        0.5 * (0..self.triangles.len()).map(twice).sum::<f64>()
    }

    /// The same surface with vertices no further apart than `tolerance` [m] taken as one, the first of them in order;
    /// triangles left without area by that, and vertices without triangle, are dropped. Zero merges equal vertices.
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

    /// The same triangles with the vertices that they use, in the order of the vertices.
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

    /// How the triangles hang together.
    ///
    /// # Errors
    /// [`SurfaceError::Index`] when a triangle names a vertex that does not exist.
    pub fn topology(&self) -> Result<Topology, SurfaceError> {
        topology(self)
    }

    /// Winding number of the surface about `p` [m]: 1 inside a closed surface wound outwards, 0 outside it, any number
    /// for an open one. It needs no closed or simple surface, but a sum over all triangles.
    ///
    /// Solid angle of a triangle: van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30 (1983), eq. 8.
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
