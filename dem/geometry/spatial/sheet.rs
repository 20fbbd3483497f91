//! External surface of triangles on moving nodes, for bodies with faces (`facet.rs`).
//!
//! A point at height h above a triangle moves by linear shape functions and the best-fit rotation Ω = A⁻¹ Σ
//! rᵢ × vᵢ, A = Σ (rᵢ² − rᵢ rᵢᵀ), r from the centre; a moment M acts on the nodes as fᵢ = (A⁻¹ M) × rᵢ.
//! Force, moment and power thus agree on both sides.

use super::bvh::Aabb;
use super::facet::{self, Facet};
use crate::base::Vec3;
use nalgebra::Matrix3;

/// Triangulated external surface at rest: patch k is triangle k.
#[derive(Clone, Debug, Default)]
pub struct SurfaceMesh {
    /// Vertices [m].
    pub vertices: Vec<Vec3>,
    /// Vertex indices, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

#[derive(Clone, Debug, Default)]
pub struct Sheet {
    facets: Vec<Facet>,
    triangles: Vec<[u32; 3]>,
    /// Initial position and velocity of vertices.
    pub rest: Vec<[Vec3; 2]>,
}

/// Placed triangle.
#[derive(Clone, Debug)]
pub struct SheetFacet {
    pub facet: Facet,
    /// Corner velocities [m/s].
    pub velocity: [Vec3; 3],
    /// Corner displacements not contained in velocities [m].
    pub correction: Option<[Vec3; 3]>,
}

/// Foot of a force: natural coordinates, point [m], offset of the force [m].
pub struct SurfacePoint {
    pub local: [f64; 2],
    pub point: Vec3,
    pub aside: Vec3,
}

impl Sheet {
    #[inline]
    pub fn new(mesh: Option<&SurfaceMesh>) -> Sheet {
        let Some(mesh) = mesh else { return Sheet::default() };
        let own: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
        Sheet {
            facets: facet::facets(&mesh.vertices, &mesh.triangles, &own),
            triangles: mesh.triangles.clone(),
            rest: mesh.vertices.iter().map(|x| [*x, Vec3::zeros()]).collect(),
        }
    }

    #[inline]
    pub fn is_empty(&self) -> bool {
        self.facets.is_empty()
    }

    /// Triangles `back` seconds ago.
    #[inline]
    pub fn update_poses(&self, corners: &[[Vec3; 2]], back: f64, out: &mut Vec<SheetFacet>) {
        out.clear();
        out.extend(self.facets.iter().zip(&self.triangles).map(|(rest, t)| {
            let now = t.map(|v| corners[v as usize]);
            SheetFacet {
                facet: rest.at(now.map(|[x, v]| x - v * back)),
                velocity: now.map(|[_, v]| v),
                correction: None,
            }
        }));
    }

    /// Sets corner displacements not contained in velocities [m].
    #[inline]
    pub fn correct(&self, of: impl Fn(u32) -> Option<Vec3>, out: &mut [SheetFacet]) {
        for (facet, t) in out.iter_mut().zip(&self.triangles) {
            facet.correction = of(t[0]).zip(of(t[1])).zip(of(t[2])).map(|((a, b), c)| [a, b, c]);
        }
    }
}

impl SheetFacet {
    #[inline]
    pub fn bounds(&self) -> Aabb {
        self.facet.bounds()
    }

    #[inline]
    pub fn foot(&self, p: &Vec3) -> SurfacePoint {
        let [a, b, c] = self.facet.corners;
        let (u, v, w) = (b - a, c - a, p - a);
        let (uu, uv, vv) = (u.norm_squared(), u.dot(&v), v.norm_squared());
        let (wu, wv) = (w.dot(&u), w.dot(&v));
        let inverse = 1.0 / (uu * vv - uv * uv);
        let local = [(vv * wu - uv * wv) * inverse, (uu * wv - uv * wu) * inverse];
        let point = a + u * local[0] + v * local[1];
        SurfacePoint { local, point, aside: p - point }
    }

    /// Velocity [m/s] and angular velocity [rad/s].
    #[inline]
    pub fn motion(&self, foot: &SurfacePoint) -> (Vec3, Vec3) {
        self.linear(&self.velocity, foot)
    }

    /// Displacement not contained in the velocity [m].
    #[inline]
    pub fn correction(&self, foot: &SurfacePoint) -> Option<Vec3> {
        self.correction.as_ref().map(|corners| self.linear(corners, foot).0)
    }

    /// Interpolates a nodal field and its rotation.
    fn linear(&self, corners: &[Vec3; 3], foot: &SurfacePoint) -> (Vec3, Vec3) {
        let &[a, b, c] = corners;
        if a == Vec3::zeros() && b == a && c == a {
            return (a, a);
        }
        let [s, t] = foot.local;
        let spin = turn(&self.facet.corners, corners);
        (a * (1.0 - s - t) + b * s + c * t + spin.cross(&foot.aside), spin)
    }
}

/// Corners relative to their centre; A⁻¹.
fn levers(corners: &[Vec3; 3]) -> ([Vec3; 3], Matrix3<f64>) {
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    let r = corners.map(|x| x - middle);
    let a = r.iter().fold(Matrix3::zeros(), |a: Matrix3<f64>, r| {
        a + Matrix3::from_diagonal_element(r.norm_squared()) - r * r.transpose()
    });
    (r, a.try_inverse().unwrap_or_else(Matrix3::zeros))
}

/// Best-fit angular velocity [rad/s].
fn turn(corners: &[Vec3; 3], velocity: &[Vec3; 3]) -> Vec3 {
    let (r, inverse) = levers(corners);
    inverse * r.iter().zip(velocity).fold(Vec3::zeros(), |sum, (r, v)| sum + r.cross(v))
}

/// Corner forces with zero sum and the given moment [N m]; corners [m].
#[inline]
pub fn couple_at_corners(corners: [[f64; 3]; 3], moment: [f64; 3]) -> [[f64; 3]; 3] {
    let (r, inverse) = levers(&corners.map(Vec3::from));
    let turn = inverse * Vec3::from(moment);
    r.map(|r| turn.cross(&r).into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Random;

    #[test]
    fn corner_forces_keep_moment_and_power() {
        let mut random = Random::new(3, 0);
        let mut vector = || Vec3::from_fn(|_, _| 2.0 * random.uniform() - 1.0);
        for _ in 0..200 {
            let corners = [vector(), vector(), vector()];
            let area = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm();
            if area < 0.2 {
                continue;
            }
            let (moment, velocity) = (vector(), [vector(), vector(), vector()]);
            let forces = couple_at_corners(corners.map(Into::into), moment.into()).map(Vec3::from);
            let sum: Vec3 = forces.iter().sum();
            let found = forces.iter().zip(&corners).fold(Vec3::zeros(), |m, (f, x)| m + x.cross(f));
            assert!(sum.norm() < 1e-12 && (found - moment).norm() < 1e-12, "{sum} {found} {moment}");
            let power: f64 = forces.iter().zip(&velocity).map(|(f, v)| f.dot(v)).sum();
            assert!((power - moment.dot(&turn(&corners, &velocity))).abs() < 1e-12);
        }
    }
}
