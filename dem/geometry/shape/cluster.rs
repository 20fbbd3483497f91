//! Bonded cluster: a breakable stone of spheres; mass and inertia are sums over spheres.

use super::clump::{bounding_box, principal};
use nalgebra::{Matrix3, Vector3};

/// Invalid cluster.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ClusterError {
    /// No sphere.
    #[error("a bonded stone needs at least one sphere")]
    Empty,
    /// Non-finite value, or radius not positive.
    #[error("sphere {0} (counted from 0) of the bonded stone needs finite coordinates and a radius above 0")]
    Sphere(usize),
    /// Unknown sphere, self-bond or duplicate bond.
    #[error("bond {index} [{a}, {b}] must join two different spheres of 0 to {last}, each pair once")]
    Bond {
        /// Index of the bond.
        index: usize,
        /// First sphere.
        a: u32,
        /// Second sphere.
        b: u32,
        /// Last sphere.
        last: usize,
    },
    /// Disconnected cluster.
    #[error("no chain of bonds leads from sphere 0 to sphere {0}; a bonded stone starts in one piece")]
    Disconnected(usize),
    /// Density factor not positive.
    #[error("the density factor is {0}; it must be a number above 0")]
    DensityFactor(f64),
}

/// Spheres and bonds in the principal frame, moments ascending.
#[derive(Clone, Debug, PartialEq)]
pub struct Cluster {
    /// Centre [m] and radius [m] of each sphere.
    pub spheres: Vec<([f64; 3], f64)>,
    /// Bonded pairs, lower index first, in input order.
    pub bonds: Vec<[u32; 2]>,
    /// Sphere density over material density.
    pub density_factor: f64,
    /// Mass per material density [m³].
    pub volume: f64,
    /// Principal moments of inertia per material density [m⁵], ascending.
    pub inertia: [f64; 3],
}

impl Cluster {
    /// Builds a cluster from spheres (centre [m], radius [m]) and bonded pairs.
    ///
    /// # Errors
    /// [`ClusterError`] if a value or bond is invalid, or the cluster empty or disconnected.
    pub fn new(
        spheres: &[([f64; 3], f64)],
        bonds: &[[u32; 2]],
        density_factor: f64,
    ) -> Result<Cluster, ClusterError> {
        if spheres.is_empty() {
            return Err(ClusterError::Empty);
        }
        let fine = |(c, r): &([f64; 3], f64)| c.iter().all(|x| x.is_finite()) && r.is_finite() && *r > 0.0;
        if let Some(bad) = spheres.iter().position(|s| !fine(s)) {
            return Err(ClusterError::Sphere(bad));
        }
        if !(density_factor > 0.0 && density_factor.is_finite()) {
            return Err(ClusterError::DensityFactor(density_factor));
        }
        let bonds = checked(bonds, spheres.len())?;

        let ball = |r: f64| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3);
        let volume: f64 = spheres.iter().map(|s| ball(s.1)).sum();
        let centre = spheres.iter().map(|(c, r)| Vector3::from(*c) * ball(*r)).sum::<Vector3<f64>>() / volume;
        let second = spheres.iter().fold(Matrix3::zeros(), |sum: Matrix3<f64>, (c, r)| {
            let x = Vector3::from(*c) - centre;
            sum + (x * x.transpose() + Matrix3::identity() * (0.2 * r * r)) * ball(*r)
        });
        let (inertia, axes) = principal(Matrix3::identity() * second.trace() - second);
        Ok(Cluster {
            spheres: spheres
                .iter()
                .map(|(c, r)| ((axes.transpose() * (Vector3::from(*c) - centre)).into(), *r))
                .collect(),
            bonds,
            density_factor,
            volume: volume * density_factor,
            inertia: inertia.map(|i| i * density_factor),
        })
    }

    /// Bounding box in the principal frame [m].
    pub fn extents(&self) -> [f64; 3] {
        let (lo, hi) = bounding_box(&self.spheres);
        std::array::from_fn(|k| hi[k] - lo[k])
    }

    /// Square sieve size [m]: intermediate extent.
    pub fn sieve_size(&self) -> f64 {
        let mut extents = self.extents();
        extents.sort_by(f64::total_cmp);
        extents[1]
    }

    /// Bounding radius about the centre of mass [m].
    pub fn bounding_radius(&self) -> f64 {
        self.spheres.iter().map(|(c, r)| Vector3::from(*c).norm() + r).fold(0.0, f64::max)
    }
}

fn checked(bonds: &[[u32; 2]], spheres: usize) -> Result<Vec<[u32; 2]>, ClusterError> {
    let mut seen = std::collections::HashSet::new();
    let mut ordered = Vec::with_capacity(bonds.len());
    let mut neighbours = vec![Vec::new(); spheres];
    for (index, &[a, b]) in bonds.iter().enumerate() {
        let pair = [a.min(b), a.max(b)];
        if a == b || pair[1] as usize >= spheres || !seen.insert(pair) {
            return Err(ClusterError::Bond { index, a, b, last: spheres - 1 });
        }
        neighbours[a as usize].push(b as usize);
        neighbours[b as usize].push(a as usize);
        ordered.push(pair);
    }
    let mut reached = vec![false; spheres];
    reached[0] = true;
    let mut open = vec![0];
    while let Some(i) = open.pop() {
        for &j in &neighbours[i] {
            if !reached[j] {
                reached[j] = true;
                open.push(j);
            }
        }
    }
    reached.iter().position(|r| !r).map_or(Ok(ordered), |i| Err(ClusterError::Disconnected(i)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

    const R: f64 = 0.1;

    /// Along y, far from the origin.
    fn row() -> Vec<([f64; 3], f64)> {
        (0..3).map(|i| ([5.0, 3.0 + 0.2 * f64::from(i), -2.0], R)).collect()
    }

    #[test]
    fn row_of_three_matches_closed_form() {
        let c = Cluster::new(&row(), &[[1, 0], [1, 2]], 1.5).unwrap();
        let ball = 4.0 / 3.0 * PI * R.powi(3);
        assert_relative_eq!(c.volume, 1.5 * 3.0 * ball, max_relative = 1e-13);
        assert_relative_eq!(c.inertia[0], 1.5 * 3.0 * 0.4 * ball * R * R, max_relative = 1e-9);
        let across = 1.5 * ball * (3.0 * 0.4 * R * R + 2.0 * 0.2 * 0.2);
        assert_relative_eq!(c.inertia[1], across, max_relative = 1e-9);
        assert_relative_eq!(c.inertia[2], across, max_relative = 1e-9);
        assert_relative_eq!(c.extents()[0], 0.6, max_relative = 1e-12);
        assert_relative_eq!(c.sieve_size(), 0.2, max_relative = 1e-12);
        assert_relative_eq!(c.bounding_radius(), 0.3, max_relative = 1e-12);
        assert_eq!(c.bonds, [[0, 1], [1, 2]]);
    }

    #[test]
    fn what_is_no_cluster_is_refused() {
        let build = |bonds: &[[u32; 2]]| Cluster::new(&row(), bonds, 1.0).unwrap_err();
        assert_eq!(build(&[[0, 1]]), ClusterError::Disconnected(2));
        assert_eq!(build(&[[0, 1], [1, 3]]), ClusterError::Bond { index: 1, a: 1, b: 3, last: 2 });
        assert_eq!(build(&[[0, 1], [1, 0]]), ClusterError::Bond { index: 1, a: 1, b: 0, last: 2 });
        assert_eq!(build(&[[2, 2]]), ClusterError::Bond { index: 0, a: 2, b: 2, last: 2 });
        assert_eq!(Cluster::new(&[], &[], 1.0), Err(ClusterError::Empty));
        assert_eq!(Cluster::new(&[([0.0; 3], 0.0)], &[], 1.0), Err(ClusterError::Sphere(0)));
        assert_eq!(Cluster::new(&[([0.0; 3], 1.0)], &[], 0.0), Err(ClusterError::DensityFactor(0.0)));
        assert!(Cluster::new(&[([0.0; 3], 1.0)], &[], 1.0).is_ok());
    }
}
