//! Signed distance from a closed surface.
//!
//! The side follows from the angle-weighted normal of the closest feature (J. A. Bærentzen and H. Aanæs, IEEE
//! Trans. Visualization and Computer Graphics 11, 2005); near a right angle to it the winding number decides.

use super::bvh::{Aabb, Bvh};
use crate::shape::polyhedron::{Polyhedron, Surface};
use crate::shape::triangle::{Region, closest_point};
use nalgebra::Vector3;
use std::collections::HashMap;

/// Sine of the angle to the surface below which the normal is unreliable.
const DOUBTFUL: f64 = 1e-4;

/// Closest surface point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Position [m].
    pub point: [f64; 3],
    /// Triangle; lowest index of equals.
    pub triangle: usize,
    /// Distance [m].
    pub distance: f64,
}

/// Search tree of an open or closed surface.
#[derive(Clone, Debug)]
pub struct Nearest {
    surface: Surface,
    tree: Bvh,
}

impl Nearest {
    /// Builds the tree of a non-empty surface.
    pub fn new(surface: Surface) -> Nearest {
        let boxes: Vec<Aabb> = (0..surface.triangles.len())
            .map(|t| {
                let [a, b, c] = surface.corners(t);
                (a.inf(&b).inf(&c).into(), a.sup(&b).sup(&c).into())
            })
            .collect();
        Nearest { tree: Bvh::new(&boxes), surface }
    }

    /// Surface point closest to `p` [m].
    pub fn closest(&self, p: [f64; 3]) -> Closest {
        self.search(p).0
    }

    fn search(&self, p: [f64; 3]) -> (Closest, Region) {
        let at = Vector3::from(p);
        let mut best = (f64::INFINITY, usize::MAX, at, Region::Face);
        self.tree.nearest(p, |t| {
            let t = t as usize;
            let [a, b, c] = self.surface.corners(t);
            let ([v, w], region) = closest_point(&a, &b, &c, &at);
            let point = a + (b - a) * v + (c - a) * w;
            let distance2 = (at - point).norm_squared();
            if distance2 < best.0 || (distance2 == best.0 && t < best.1) {
                best = (distance2, t, point, region);
            }
            best.0
        });
        (Closest { point: best.2.into(), triangle: best.1, distance: best.0.sqrt() }, best.3)
    }
}

/// Signed distance from a closed surface.
#[derive(Clone, Debug)]
pub struct SurfaceDistance {
    nearest: Nearest,
    face_normals: Vec<Vector3<f64>>,
    edge_normals: HashMap<(u32, u32), Vector3<f64>>,
    vertex_normals: Vec<Vector3<f64>>,
}

impl SurfaceDistance {
    /// Builds the search tree.
    pub fn new(body: &Polyhedron) -> SurfaceDistance {
        let surface = body.surface();
        let mut face_normals = Vec::with_capacity(surface.triangles.len());
        let mut edge_normals: HashMap<(u32, u32), Vector3<f64>> = HashMap::new();
        let mut vertex_normals = vec![Vector3::zeros(); surface.vertices.len()];
        for (t, corners) in surface.triangles.iter().enumerate() {
            let x = surface.corners(t);
            let normal = (x[1] - x[0]).cross(&(x[2] - x[0])).try_normalize(0.0).unwrap_or_default();
            for k in 0..3 {
                let (next, last) = ((k + 1) % 3, (k + 2) % 3);
                *edge_normals.entry(key(corners[k], corners[next])).or_default() += normal;
                let angle = (x[next] - x[k]).angle(&(x[last] - x[k]));
                vertex_normals[corners[k] as usize] += normal * angle;
            }
            face_normals.push(normal);
        }
        let nearest = Nearest::new(surface.clone());
        SurfaceDistance { nearest, face_normals, edge_normals, vertex_normals }
    }

    /// Surface.
    pub fn surface(&self) -> &Surface {
        &self.nearest.surface
    }

    /// Surface point closest to `p` [m].
    pub fn closest(&self, p: [f64; 3]) -> Closest {
        self.nearest.closest(p)
    }

    /// Depth of `p` [m], positive inside [m].
    pub fn depth(&self, p: [f64; 3]) -> f64 {
        self.depth_and_closest(p).0
    }

    /// Returns true if `p` [m] is inside.
    pub fn contains(&self, p: [f64; 3]) -> bool {
        self.depth(p) > 0.0
    }

    /// [`Self::depth`] and its closest point.
    pub fn depth_and_closest(&self, p: [f64; 3]) -> (f64, Closest) {
        let (closest, region) = self.nearest.search(p);
        let corners = self.surface().triangles[closest.triangle];
        let normal = match region {
            Region::Face => self.face_normals[closest.triangle],
            Region::Edge(k) => self.edge_normals[&key(corners[k], corners[(k + 1) % 3])],
            Region::Vertex(k) => self.vertex_normals[corners[k] as usize],
        };
        let out = (Vector3::from(p) - Vector3::from(closest.point)).dot(&normal);
        let inside = if out.abs() > DOUBTFUL * closest.distance * normal.norm() {
            out < 0.0
        } else {
            self.surface().winding_number(p) > 0.5
        };
        (if inside { closest.distance } else { -closest.distance }, closest)
    }
}

fn key(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}
