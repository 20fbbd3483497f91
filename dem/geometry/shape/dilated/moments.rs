//! Exact moments of a dilated polyhedron.
//!
//! Volume and surface: J. Steiner (1840). Corner with solid angle W of normals: ∫n dW = −½ Σ t ν, ∫n nᵀ dW =
//! ⅓ (W 1 − Σ ν (n₁ + n₂)ᵀ tan(t/2)), sums over its edges with outgoing unit vector ν and angle t between
//! face normals n₁, n₂.
//!
//! Theory manual: equation (2.6) of `docs/theory/shapes.md`.

use super::{Core, DilatedMoments};
use crate::base::Vec3;
use nalgebra::Matrix3;

/// Integrals of 1, x and x xᵀ.
#[derive(Clone, Copy, Default)]
struct Sums {
    volume: f64,
    first: Vec3,
    second: Matrix3<f64>,
}

impl Sums {
    fn add(&mut self, volume: f64, first: Vec3, second: Matrix3<f64>) {
        self.volume += volume;
        self.first += first;
        self.second += second;
    }
}

pub(super) fn moments(core: &Core, r: f64) -> DilatedMoments {
    // Local origin avoids cancellation.
    let middle = core.corners.iter().sum::<Vec3>() / core.corners.len() as f64;
    let at = |k: u8| core.corners[k as usize] - middle;
    let mut sums = Sums::default();
    let mut area = 0.0;
    for face in &core.faces {
        for k in 1..face.corners.len() - 1 {
            let corners = [at(face.corners[0]), at(face.corners[k]), at(face.corners[k + 1])];
            let triangle = Triangle::new(corners);
            area += triangle.area;
            triangle.cone(&mut sums);
            triangle.slab(&face.normal, r, &mut sums);
        }
    }
    for edge in &core.edges {
        let [n1, n2] = edge.faces.map(|f| core.faces[f as usize].normal);
        let angle = between(&n1, &n2);
        area += edge.length * r * angle;
        wedge(edge.ends.map(at), [n1, n2], angle, r, &mut sums);
    }
    area += 4.0 * std::f64::consts::PI * r * r;
    for corner in 0..core.corners.len() {
        sector(core, corner, &at(corner as u8), r, &mut sums);
    }
    let centre = sums.first / sums.volume;
    let second = sums.second - sums.volume * centre * centre.transpose();
    let second = (second + second.transpose()) * 0.5;
    let inertia = Matrix3::identity() * second.trace() - second;
    DilatedMoments { volume: sums.volume, area, centre: centre + middle, inertia }
}

fn between(a: &Vec3, b: &Vec3) -> f64 {
    libm::atan2(a.cross(b).norm(), a.dot(b))
}

struct Triangle {
    corners: [Vec3; 3],
    area: f64,
    first: Vec3,
    second: Matrix3<f64>,
}

impl Triangle {
    fn new(corners: [Vec3; 3]) -> Triangle {
        let [a, b, c] = corners;
        let area = 0.5 * (b - a).cross(&(c - a)).norm();
        let sum = a + b + c;
        let squares: Matrix3<f64> = corners.iter().map(|v| v * v.transpose()).sum();
        let second = (squares + sum * sum.transpose()) * (area / 12.0);
        Triangle { corners, area, first: sum * (area / 3.0), second }
    }

    /// Tetrahedron to the origin.
    fn cone(&self, sums: &mut Sums) {
        let [a, b, c] = self.corners;
        let volume = a.dot(&b.cross(&c)) / 6.0;
        let sum = a + b + c;
        let squares: Matrix3<f64> = self.corners.iter().map(|v| v * v.transpose()).sum();
        sums.add(volume, sum * (volume / 4.0), (squares + sum * sum.transpose()) * (volume / 20.0));
    }

    /// Slab of thickness `r`.
    fn slab(&self, n: &Vec3, r: f64, sums: &mut Sums) {
        let mixed = self.first * n.transpose();
        sums.add(
            self.area * r,
            self.first * r + n * (0.5 * r * r * self.area),
            self.second * r
                + (mixed + mixed.transpose()) * (0.5 * r * r)
                + n * n.transpose() * (self.area * r.powi(3) / 3.0),
        );
    }
}

fn wedge([a, b]: [Vec3; 2], [n1, n2]: [Vec3; 2], angle: f64, r: f64, sums: &mut Sums) {
    let length = (b - a).norm();
    let u = (n1 + n2).normalize();
    let across = n2 - n1;
    let w = if across.norm() > 0.0 { across.normalize() } else { Vec3::zeros() };
    let along = (a + b) * (0.5 * length);
    let mixed = a * b.transpose();
    let squares =
        (a * a.transpose() + b * b.transpose() + (mixed + mixed.transpose()) * 0.5) * (length / 3.0);
    let (sector, arm) = (0.5 * angle * r * r, u * (2.0 * libm::sin(0.5 * angle) * r.powi(3) / 3.0));
    let normals = u * u.transpose() * (0.5 * (angle + libm::sin(angle)))
        + w * w.transpose() * (0.5 * (angle - libm::sin(angle)));
    let cross = along * arm.transpose();
    sums.add(
        sector * length,
        along * sector + arm * length,
        squares * sector + cross + cross.transpose() + normals * (length * r.powi(4) / 4.0),
    );
}

/// Sphere sector at a corner.
fn sector(core: &Core, corner: usize, at: &Vec3, r: f64, sums: &mut Sums) {
    let (mut first, mut second) = (Vec3::zeros(), Matrix3::zeros());
    let edges = core.edges.iter().filter_map(|e| {
        let sign = match e.ends.map(|k| k as usize == corner) {
            [true, _] => 1.0,
            [_, true] => -1.0,
            _ => return None,
        };
        Some((e, e.direction * sign))
    });
    for (edge, nu) in edges {
        let [n1, n2] = edge.faces.map(|f| core.faces[f as usize].normal);
        let angle = between(&n1, &n2);
        first -= nu * (0.5 * angle);
        second -= nu * (n1 + n2).transpose() * libm::tan(0.5 * angle);
    }
    let solid = solid_angle(core, corner);
    second = (second + Matrix3::identity() * solid) / 3.0;
    let mixed = at * first.transpose();
    sums.add(
        solid * r.powi(3) / 3.0,
        at * (solid * r.powi(3) / 3.0) + first * (r.powi(4) / 4.0),
        at * at.transpose() * (solid * r.powi(3) / 3.0)
            + (mixed + mixed.transpose()) * (r.powi(4) / 4.0)
            + second * (r.powi(5) / 5.0),
    );
}

/// Solid angle of normals at a corner: 2π minus the face angles (Gauss & Bonnet).
fn solid_angle(core: &Core, corner: usize) -> f64 {
    let inner: f64 = (core.faces.iter())
        .filter_map(|f| {
            let k = f.corners.iter().position(|c| *c as usize == corner)?;
            let n = f.corners.len();
            let at = |k: usize| core.corners[f.corners[k % n] as usize];
            Some(between(&(at(k + 1) - at(k)).normalize(), &(at(k + n - 1) - at(k)).normalize()))
        })
        .sum();
    2.0 * std::f64::consts::PI - inner
}
