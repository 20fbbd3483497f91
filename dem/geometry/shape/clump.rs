//! Rigid clump: a stone as overlapping spheres.

mod union;

use super::body_shape::{BodyShape, positive};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use union::{Ball, union_moments};

/// Invalid clump.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShapeError {
    /// No sphere.
    #[error("a clump needs at least one sphere")]
    Empty,
    /// Non-finite coordinate or radius.
    #[error("sphere {0} of the clump has a coordinate or radius that is not a finite number")]
    NotFinite(usize),
    /// Radius not positive.
    #[error("sphere {index} of the clump has radius {radius} m; it must be positive")]
    Radius {
        /// Index of the sphere.
        index: usize,
        /// Radius [m].
        radius: f64,
    },
    /// Disconnected clump.
    #[error("sphere {0} of the clump is not connected to sphere 0; a clump must be connected")]
    Disconnected(usize),
}

/// Rigid union of spheres about its centroid. Principal moments ascend: x is the long axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Clump {
    /// Centre [m] and radius [m] of each sphere.
    pub spheres: Vec<([f64; 3], f64)>,
    /// Volume of the union [m³].
    pub volume: f64,
    /// Principal moments of inertia per unit density [m⁵], ascending.
    pub inertia: [f64; 3],
}

impl Clump {
    /// Builds a clump from spheres (centre [m], radius [m]); their order is kept.
    ///
    /// # Errors
    /// [`ShapeError`] if a sphere is invalid or not connected, or none is given.
    pub fn from_spheres(spheres: &[([f64; 3], f64)]) -> Result<Clump, ShapeError> {
        check(spheres)?;
        // Normalised coordinates avoid cancellation and underflow.
        let (lo, hi) = bounding_box(spheres);
        let middle: [f64; 3] = std::array::from_fn(|k| 0.5 * (lo[k] + hi[k]));
        let unit = (0..3).map(|k| 0.5 * (hi[k] - lo[k])).fold(0.0, f64::max);
        let local: Vec<Ball> = spheres
            .iter()
            .map(|(c, r)| Ball { c: std::array::from_fn(|k| (c[k] - middle[k]) / unit), r: r / unit })
            .collect();
        let m = union_moments(&local);

        let centroid = Vector3::from(m.first) / m.volume;
        let [xx, yy, zz, xy, yz, zx] = m.second;
        let second =
            Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz) - m.volume * centroid * centroid.transpose();
        let inertia = Matrix3::identity() * second.trace() - second;
        let (moments, axes) = principal(inertia);

        let spheres = local
            .iter()
            .map(|b| {
                let c = axes.transpose() * (Vector3::from(b.c) - centroid) * unit;
                (c.into(), b.r * unit)
            })
            .collect();
        let u3 = unit * unit * unit;
        Ok(Clump { spheres, volume: m.volume * u3, inertia: moments.map(|i| i * u3 * unit * unit) })
    }

    /// Scales by `s` > 0.
    pub fn scaled(&self, s: f64) -> Clump {
        let s3 = s * s * s;
        Clump {
            spheres: self.spheres.iter().map(|(c, r)| (c.map(|x| x * s), r * s)).collect(),
            volume: self.volume * s3,
            inertia: self.inertia.map(|i| i * s3 * s * s),
        }
    }

    /// Square sieve size [m]: intermediate principal extent.
    pub fn sieve_size(&self) -> f64 {
        let mut extents = self.extents();
        extents.sort_by(f64::total_cmp);
        extents[1]
    }

    /// Bounding box in the principal frame [m].
    pub fn extents(&self) -> [f64; 3] {
        let (lo, hi) = bounding_box(&self.spheres);
        std::array::from_fn(|k| hi[k] - lo[k])
    }

    fn largest(&self) -> f64 {
        self.spheres.iter().map(|s| s.1).fold(0.0, f64::max)
    }

    /// Bounding radius about the centroid [m].
    pub fn bounding_radius(&self) -> f64 {
        self.spheres.iter().map(|(c, r)| Vector3::from(*c).norm() + r).fold(0.0, f64::max)
    }
}

impl BodyShape for Clump {
    fn fault(&self) -> Option<String> {
        let good = |(x, r): &([f64; 3], f64)| positive(*r) && x.iter().all(|x| x.is_finite());
        Some(match self.spheres.len() {
            0 => "a clump without spheres".to_string(),
            count @ 65_536.. => format!("a clump of {count} spheres; at most 65535"),
            _ if !positive(self.volume) || !self.inertia.iter().all(|&i| positive(i)) => {
                "volume and inertia of a clump must be positive".to_string()
            }
            _ if !self.spheres.iter().all(good) => {
                "a sphere of the clump has no positive radius or no finite centre".to_string()
            }
            _ => return None,
        })
    }

    fn volume(&self) -> f64 {
        self.volume
    }

    fn gyration2(&self) -> Vector3<f64> {
        Vector3::from(self.inertia) / self.volume
    }

    fn bounding_radius(&self) -> f64 {
        self.bounding_radius()
    }

    fn reference_radius(&self) -> f64 {
        self.spheres.iter().map(|s| s.1).fold(f64::INFINITY, f64::min)
    }

    fn contact_radius(&self) -> Option<f64> {
        Some(self.largest())
    }

    fn levers2(&self) -> [f64; 3] {
        let reach2 = |k: usize| {
            let lever = |(c, r): &([f64; 3], f64)| libm::hypot(c[(k + 1) % 3], c[(k + 2) % 3]) + r;
            self.spheres.iter().map(|s| lever(s).powi(2)).fold(0.0, f64::max)
        };
        [0, 1, 2].map(reach2)
    }

    /// Members touching a plane across a principal axis (within 0.1 of the largest radius).
    fn contacts(&self, _: f64, _: f64, _: bool) -> f64 {
        let slack = 0.1 * self.largest();
        let touching = |axis: usize, sign: f64| {
            let reach = |s: &([f64; 3], f64)| sign * s.0[axis] + s.1;
            let furthest = self.spheres.iter().map(reach).fold(f64::NEG_INFINITY, f64::max);
            self.spheres.iter().filter(|s| reach(s) >= furthest - slack).count()
        };
        let flat = (0..3).map(|axis| touching(axis, 1.0).max(touching(axis, -1.0))).max().unwrap_or(0);
        2.0 * flat.max(12) as f64
    }

    fn sphere_count(&self) -> usize {
        self.spheres.len()
    }

    fn for_spheres(&self, act: &mut dyn FnMut(Vector3<f64>, f64)) {
        self.spheres.iter().for_each(|(c, r)| act(Vector3::from(*c), *r));
    }

    fn sieve_size(&self) -> Option<f64> {
        Some(self.sieve_size())
    }
}

fn check(spheres: &[([f64; 3], f64)]) -> Result<(), ShapeError> {
    if spheres.is_empty() {
        return Err(ShapeError::Empty);
    }
    for (index, (c, radius)) in spheres.iter().enumerate() {
        if !(c.iter().all(|x| x.is_finite()) && radius.is_finite()) {
            return Err(ShapeError::NotFinite(index));
        }
        if *radius <= 0.0 {
            return Err(ShapeError::Radius { index, radius: *radius });
        }
    }
    // Flood fill; the slack admits spheres in point contact.
    let mut reached = vec![false; spheres.len()];
    let mut open = vec![0];
    reached[0] = true;
    while let Some(i) = open.pop() {
        for j in 0..spheres.len() {
            let reach = (spheres[i].1 + spheres[j].1) * (1.0 + 1e-12);
            if !reached[j] && (Vector3::from(spheres[i].0) - Vector3::from(spheres[j].0)).norm() <= reach {
                reached[j] = true;
                open.push(j);
            }
        }
    }
    reached.iter().position(|r| !r).map_or(Ok(()), |i| Err(ShapeError::Disconnected(i)))
}

pub(super) fn bounding_box(spheres: &[([f64; 3], f64)]) -> ([f64; 3], [f64; 3]) {
    let fold =
        |sign: f64, k: usize| spheres.iter().map(|(c, r)| sign * c[k] + r).fold(f64::NEG_INFINITY, f64::max);
    (std::array::from_fn(|k| -fold(-1.0, k)), std::array::from_fn(|k| fold(1.0, k)))
}

/// Ascending principal moments and right-handed axes (columns).
pub fn principal(mut inertia: Matrix3<f64>) -> ([f64; 3], Matrix3<f64>) {
    let noise = 1e-11 * inertia.trace();
    for (i, j) in [(0, 1), (1, 2), (0, 2)] {
        if inertia[(i, j)].abs() < noise {
            inertia[(i, j)] = 0.0;
            inertia[(j, i)] = 0.0;
        }
    }
    let eigen = inertia.symmetric_eigen();
    let mut order = [0, 1, 2];
    let rank = |i: usize| (eigen.eigenvalues[i] / noise).round();
    order.sort_by(|&i, &j| rank(i).total_cmp(&rank(j)));
    let column = |k: usize| {
        // The largest component is positive.
        let v = eigen.eigenvectors.column(order[k]).into_owned();
        let largest = v[v.iamax()];
        v * largest.signum()
    };
    let (x, y) = (column(0), column(1));
    let axes = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    (order.map(|i| eigen.eigenvalues[i]), axes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::Rotation3;
    use std::f64::consts::PI;

    /// ∫ x^n (R² − x²)^m π dx over a sphere cut by x < h: volume, ∫x, ∫x², ∫y².
    fn cut_sphere(r: f64, h: f64) -> [f64; 4] {
        let f = |x: f64| {
            let r2 = r * r;
            [
                PI * (r2 * x - x.powi(3) / 3.0),
                PI * (r2 * x * x / 2.0 - x.powi(4) / 4.0),
                PI * (r2 * x.powi(3) / 3.0 - x.powi(5) / 5.0),
                PI / 4.0 * (r2 * r2 * x - 2.0 * r2 * x.powi(3) / 3.0 + x.powi(5) / 5.0),
            ]
        };
        std::array::from_fn(|k| f(h)[k] - f(-r)[k])
    }

    fn lens(r1: f64, r2: f64, d: f64) -> (f64, f64, [f64; 2]) {
        let h = 0.5 * (d + (r1 * r1 - r2 * r2) / d);
        let a = cut_sphere(r1, h);
        let b = cut_sphere(r2, d - h); // mirrored, from the second centre
        let volume = a[0] + b[0];
        let centroid = (a[1] + d * b[0] - b[1]) / volume;
        let xx = a[2] + d * d * b[0] - 2.0 * d * b[1] + b[2] - volume * centroid * centroid;
        let yy = a[3] + b[3];
        (volume, centroid, [2.0 * yy, xx + yy])
    }

    #[test]
    fn one_sphere() {
        let r = 0.3;
        let c = Clump::from_spheres(&[([5.0, -7.0, 2.0], r)]).unwrap();
        assert_relative_eq!(c.volume, 4.0 / 3.0 * PI * r.powi(3), max_relative = 1e-12);
        for i in c.inertia {
            assert_relative_eq!(i, 0.4 * c.volume * r * r, max_relative = 1e-12);
        }
        assert!(Vector3::from(c.spheres[0].0).norm() < 1e-14);
        assert_relative_eq!(c.sieve_size(), 2.0 * r, max_relative = 1e-13);
    }

    #[test]
    fn two_spheres_count_the_lens_once() {
        let along = Vector3::new(0.3, -0.5, 0.7).normalize();
        for (r1, r2, d) in [(1.0, 1.0, 1.0), (0.05, 0.03, 0.06), (0.02, 0.011, 0.0285), (1.0, 0.7, 0.31)] {
            let (volume, centroid, [axial, transverse]) = lens(r1, r2, d);
            for axis in [Vector3::x(), Vector3::z(), along] {
                let c = Clump::from_spheres(&[([0.0; 3], r1), ((axis * d).into(), r2)]).unwrap();
                assert_relative_eq!(c.volume, volume, max_relative = 1e-8);
                assert_relative_eq!(c.inertia[0], axial, max_relative = 1e-8);
                assert_relative_eq!(c.inertia[1], transverse, max_relative = 1e-8);
                assert_relative_eq!(c.inertia[2], transverse, max_relative = 1e-8);
                assert_relative_eq!(c.spheres[0].0[0].abs(), centroid, max_relative = 1e-8);
                assert_relative_eq!(c.spheres[1].0[0].abs(), d - centroid, max_relative = 1e-8);
                assert!(c.spheres[0].0[1].hypot(c.spheres[0].0[2]) < 1e-8 * d);
            }
        }
    }

    /// Stone-like shape.
    fn stone() -> Vec<([f64; 3], f64)> {
        let golden = PI * (3.0 - 5.0_f64.sqrt());
        (0..12)
            .map(|i| {
                let (z, a) = (1.0 - (2 * i + 1) as f64 / 12.0, golden * i as f64);
                let s = (1.0 - z * z).sqrt();
                ([0.6 * s * a.cos(), 0.4 * s * a.sin(), 0.3 * z], 0.25 + 0.1 * (i % 3) as f64)
            })
            .collect()
    }

    #[test]
    fn many_spheres_match_voxels_any_frame() {
        let spheres = stone();
        let c = Clump::from_spheres(&spheres).unwrap();
        let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.3);
        let moved: Vec<_> = spheres
            .iter()
            .map(|(p, r)| ((turn * Vector3::from(*p) + Vector3::new(1.0, 2.0, -3.0)).into(), *r))
            .collect();
        let t = Clump::from_spheres(&moved).unwrap();
        assert_relative_eq!(c.volume, t.volume, max_relative = 1e-8);
        for k in 0..3 {
            assert_relative_eq!(c.inertia[k], t.inertia[k], max_relative = 1e-8);
            assert!(c.inertia[k] >= c.inertia[k.saturating_sub(1)]);
        }
        let again = Clump::from_spheres(&c.spheres).unwrap();
        for (a, b) in c.spheres.iter().zip(&again.spheres) {
            assert!((0..3).all(|k| (a.0[k] - b.0[k]).abs() < 1e-9), "{a:?} {b:?}");
        }

        let (n, h) = (200, 2.0 / 200.0);
        let (mut volume, mut xx, mut zz) = (0.0, 0.0, 0.0);
        let at = |i: usize| (i as f64 + 0.5) * h - 1.0;
        for (i, j, k) in (0..n * n * n).map(|m| (m / n / n, m / n % n, m % n)) {
            let p = Vector3::new(at(i), at(j), at(k));
            if c.spheres.iter().any(|(q, r)| (p - Vector3::from(*q)).norm_squared() < r * r) {
                volume += h * h * h;
                xx += h * h * h * (p.y * p.y + p.z * p.z);
                zz += h * h * h * (p.x * p.x + p.y * p.y);
            }
        }
        assert_relative_eq!(c.volume, volume, max_relative = 1e-3);
        assert_relative_eq!(c.inertia[0], xx, max_relative = 1e-3);
        assert_relative_eq!(c.inertia[2], zz, max_relative = 1e-3);
    }

    #[test]
    fn hidden_and_repeated_spheres_change_nothing() {
        let c = Clump::from_spheres(&[([0.0; 3], 1.0), ([0.9, 0.0, 0.0], 0.5)]).unwrap();
        let more = [([0.0; 3], 1.0), ([0.9, 0.0, 0.0], 0.5), ([0.2, 0.1, 0.0], 0.3), ([0.0; 3], 1.0)];
        let m = Clump::from_spheres(&more).unwrap();
        assert_relative_eq!(c.volume, m.volume, max_relative = 1e-8);
        assert_relative_eq!(c.inertia[1], m.inertia[1], max_relative = 1e-8);
    }

    #[test]
    fn scaling_follows_the_powers_of_length() {
        let big: Vec<_> = stone().iter().map(|(c, r)| (c.map(|x| x * 0.04), r * 0.04)).collect();
        let (a, b) =
            (Clump::from_spheres(&big).unwrap(), Clump::from_spheres(&stone()).unwrap().scaled(0.04));
        assert_relative_eq!(a.volume, b.volume, max_relative = 1e-8);
        assert_relative_eq!(a.inertia[2], b.inertia[2], max_relative = 1e-8);
        assert_relative_eq!(a.sieve_size(), b.sieve_size(), max_relative = 1e-8);
        assert_relative_eq!(a.bounding_radius(), b.bounding_radius(), max_relative = 1e-8);
        assert!(2.0 * a.bounding_radius() >= a.sieve_size());
    }

    #[test]
    fn bad_spheres_are_refused_by_number() {
        assert_eq!(Clump::from_spheres(&[]), Err(ShapeError::Empty));
        let ok = ([0.0; 3], 1.0);
        assert_eq!(Clump::from_spheres(&[ok, ([0.0, f64::NAN, 0.0], 1.0)]), Err(ShapeError::NotFinite(1)));
        let flat = ShapeError::Radius { index: 1, radius: 0.0 };
        assert_eq!(Clump::from_spheres(&[ok, ([0.0; 3], 0.0)]), Err(flat));
        assert_eq!(Clump::from_spheres(&[ok, ([2.1, 0.0, 0.0], 1.0)]), Err(ShapeError::Disconnected(1)));
        assert!(Clump::from_spheres(&[ok, ([2.0, 0.0, 0.0], 1.0)]).is_ok());
    }
}
