//! Surfaces of triangles that press on each other, with rounded corners and edges.
//!
//! A body's triangles are moved inwards by the radius that its corners and edges are rounded with, so that its faces, edges and corners are
//! where they were given: a corner goes to where the faces around it meet then, in the sense of least squares where more than three do.
//!
//! Limits: where faces enclose so sharp an angle that a corner would go farther than [`FARTHEST`] radii it goes that far, and what is rounded
//! there lies a little outside of the surface.

use super::bvh::{Aabb, Bvh};
use super::facet::{self, Facet};
use crate::base::Vec3;
use nalgebra::Matrix3;

/// How far a corner goes at most, over the radius.
const FARTHEST: f64 = 4.0;

/// Share of the largest eigenvalue below which normals differ by rounding alone. All planes are moved by one radius, so that nearly flat ones do
/// not meet far away.
const DISTINCT: f64 = 1e-9;

/// How many triangles' planes are looked along at most for the flattest side.
const LOOKED_AT: usize = 512;

/// Area over the square of the longest side below which a triangle has none.
const FLATTEST: f64 = 1e-9;

/// A surface in the frame of its wall.
#[derive(Clone, Debug)]
pub(crate) struct Shell {
    pub facets: Vec<Facet>,
    pub tree: Bvh,
    /// Bounds of the facets.
    pub bounds: Aabb,
    /// Radius that corners and edges are rounded with [m].
    pub radius: f64,
}

impl Shell {
    /// Triangles as they are, with sharp edges. `same` has for each vertex the lowest at the same place.
    pub fn sharp(vertices: &[Vec3], triangles: &[[u32; 3]], same: &[u32]) -> Shell {
        Shell::new(facet::facets(vertices, triangles, same), 0.0)
    }

    /// A surface whose corners and edges are rounded; `faces` look outwards, `same` as in [`Shell::sharp`]. `None` where a triangle would have
    /// no area left or turn over: the radius is too large for the surface.
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

    /// The most that corners, and lengths of edges [m], can press on a plane at once where those within `reach` [m] of it do.
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

/// Twice the area of a triangle, along its normal.
fn area([a, b, c]: &[Vec3; 3]) -> Vec3 {
    (b - a).cross(&(c - a))
}

/// The way s to a point that lies a radius above all planes around a corner: the least that makes Σ w (n·s − r)² least, of which the sums
/// of w n nᵀ and w n are given.
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
