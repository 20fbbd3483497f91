//! Rounded triangle surfaces in mutual contact.
//!
//! Triangles move inwards by the rounding radius, so that the rounded surface keeps the given faces; corners
//! move to the intersection of offset planes (least squares).
//!
//! Limits: at sharp angles a corner moves at most `FARTHEST` radii.

use super::bvh::{Aabb, Bvh};
use super::facet::{self, Facet};
use crate::base::Vec3;
use nalgebra::Matrix3;

/// Largest corner displacement over radius.
const FARTHEST: f64 = 4.0;

/// Relative eigenvalue below which normals are equal, so nearly coplanar planes do not intersect far away.
const DISTINCT: f64 = 1e-9;

/// Most triangle planes checked for the flattest side.
const LOOKED_AT: usize = 512;

/// Relative area of a degenerate triangle.
const FLATTEST: f64 = 1e-9;

/// In the wall frame.
#[derive(Clone, Debug)]
pub struct Shell {
    pub facets: Vec<Facet>,
    pub tree: Bvh,
    pub bounds: Aabb,
    /// Rounding radius [m].
    pub radius: f64,
}

impl Shell {
    /// Sharp triangles; `same`: lowest coincident vertex of each vertex.
    pub fn sharp(vertices: &[Vec3], triangles: &[[u32; 3]], same: &[u32]) -> Shell {
        Shell::new(facet::facets(vertices, triangles, same), 0.0)
    }

    /// Rounded, from outward `faces`; `same` as [`Shell::sharp`]. `None` if a triangle vanishes or inverts:
    /// radius too large.
    pub fn rounded(vertices: &[Vec3], faces: &[[u32; 3]], same: &[u32], radius: f64) -> Option<Shell> {
        let mut around = vec![(Matrix3::zeros(), Vec3::zeros()); vertices.len()];
        for face in faces {
            let corners = face.map(|v| vertices[v as usize]);
            let normal = area(&corners).normalize();
            for k in 0..3 {
                let (out, back) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
                let angle = libm::atan2(out.cross(&back).norm(), out.dot(&back));
                let (square, sum) = &mut around[same[face[k] as usize] as usize];
                *square += normal * normal.transpose() * angle;
                *sum += normal * angle;
            }
        }
        let moved: Vec<Vec3> = (0..vertices.len())
            .map(|v| {
                let (square, sum) = &around[same[v] as usize];
                vertices[v] - inwards(square, sum, radius)
            })
            .collect();
        let stays = |face: &[u32; 3]| {
            let [before, after] = [vertices, &moved[..]].map(|at| area(&face.map(|v| at[v as usize])));
            let corners = face.map(|v| moved[v as usize]);
            let longest =
                (0..3).map(|k| (corners[k] - corners[(k + 1) % 3]).norm_squared()).fold(0.0, f64::max);
            before.dot(&after) > 0.0 && after.norm() > FLATTEST * longest
        };
        faces.iter().all(stays).then(|| Shell::new(facet::facets(&moved, faces, same), radius))
    }

    fn new(facets: Vec<Facet>, radius: f64) -> Shell {
        let boxes: Vec<Aabb> = facets.iter().map(Facet::bounds).collect();
        let join = |(a, b): Aabb, (c, d): &Aabb| {
            (std::array::from_fn(|k| a[k].min(c[k])), std::array::from_fn(|k| b[k].max(d[k])))
        };
        let bounds = boxes.iter().fold(([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]), join);
        Shell { tree: Bvh::new(&boxes), facets, bounds, radius }
    }

    /// Largest corner count and edge length [m] within `reach` [m] of one plane.
    pub fn flattest(&self, reach: f64) -> [f64; 2] {
        let mut most = [0.0_f64; 2];
        let every = self.facets.len().div_ceil(LOOKED_AT);
        for n in self.facets.iter().step_by(every).flat_map(|f| [f.normal, -f.normal]) {
            let heights = |f: &Facet| f.corners.map(|x| n.dot(&x));
            let level = self.facets.iter().flat_map(heights).fold(f64::NEG_INFINITY, f64::max) - reach;
            let (mut tips, mut length) = (0.0, 0.0);
            for f in &self.facets {
                let near = heights(f).map(|h| h > level);
                for k in 0..3 {
                    tips += if near[k] { f.tips[k].press } else { 0.0 };
                    let both = near[k] && near[(k + 1) % 3];
                    length += if both { f.edges[k].share.press * f.edges[k].length } else { 0.0 };
                }
            }
            most = [most[0].max(tips), most[1].max(length)];
        }
        most
    }
}

/// Twice the area, along the normal.
fn area([a, b, c]: &[Vec3; 3]) -> Vec3 {
    (b - a).cross(&(c - a))
}

/// Smallest s minimising Σ w (n·s − r)², from Σ w n nᵀ and Σ w n.
fn inwards(square: &Matrix3<f64>, sum: &Vec3, radius: f64) -> Vec3 {
    let eigen = square.symmetric_eigen();
    let largest = eigen.eigenvalues.max();
    let mut way = Vec3::zeros();
    for (value, direction) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > DISTINCT * largest {
            way += direction * (direction.dot(sum) / value);
        }
    }
    let length = way.norm();
    if length > FARTHEST { way * (radius * FARTHEST / length) } else { way * radius }
}

#[cfg(test)]
#[path = "shell_tests.rs"]
mod tests;
