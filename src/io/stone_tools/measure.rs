//! Fit of spheres to a body, with lengths over the sieve size.
//!
//! Distances run from surface points to the union of spheres, d = min(|p − c| − r): exact outside, else the
//! depth below the sphere that covers most.

use std::fmt;

use nalgebra::Vector3;
use trackbed_dem::distance::SurfaceDistance;
use trackbed_dem::shape::clump::Clump;
use trackbed_dem::shape::cluster::Cluster;
use trackbed_dem::shape::polyhedron::{BodyMoments, Polyhedron, convex_hull, sphericity};

use super::fill::Ball;

const POINTS: usize = 4000;
const SPHERE_POINTS: usize = 500;

/// Stone of spheres compared with its surface.
#[derive(Clone, Debug, PartialEq)]
pub struct StoneReport {
    /// Number of spheres.
    pub spheres: usize,
    /// Number of bonds; 0 for a clump.
    pub bonds: usize,
    /// Elongation b/a and flatness c/b of the surface's principal extents a ≥ b ≥ c.
    pub form: [f64; 2],
    /// Wadell's sphericity of the surface.
    pub surface_sphericity: f64,
    /// Wadell's sphericity of the union; `None` for separate spheres.
    pub sphericity: Option<f64>,
    /// Volume of the union over the surface's volume.
    pub volume_ratio: f64,
    /// Principal moments of inertia over the surface's, ascending; with density factor if bonded.
    pub inertia_ratio: [f64; 3],
    /// Distance of the centres of mass over the sieve size.
    pub centroid_offset: f64,
    /// Mean distance of surface and spheres over the sieve size.
    pub mean_distance: f64,
    /// Largest distance, either way, over the sieve size.
    pub max_distance: f64,
    /// Largest overhang over the sieve size, ≥ 0.
    pub overhang: f64,
    /// Smallest radius over the sieve size; it limits the time step.
    pub least_radius: f64,
}

/// Compares a clump of `spheres`, in the body's frame, with the body.
pub fn clump(body: &Polyhedron, distance: &SurfaceDistance, spheres: &[Ball], clump: &Clump) -> StoneReport {
    let exposed = exposed(spheres);
    let area: f64 = exposed.iter().map(|e| e.1).sum();
    let centre = union_centre(spheres, clump);
    let mut report = distances(body, distance, spheres, &exposed);
    fill_moments(&mut report, body, clump.volume, clump.inertia, centre);
    report.sphericity = Some(sphericity(clump.volume, area));
    report
}

/// Compares a bonded stone of `spheres`, in the body's frame, with the body.
pub fn cluster(
    body: &Polyhedron,
    distance: &SurfaceDistance,
    spheres: &[Ball],
    cluster: &Cluster,
) -> StoneReport {
    let cubes: f64 = spheres.iter().map(|s| s.1.powi(3)).sum();
    let centre = spheres.iter().map(|(c, r)| Vector3::from(*c) * r.powi(3)).sum::<Vector3<f64>>() / cubes;
    let mut report = distances(body, distance, spheres, &exposed(spheres));
    let volume = cluster.volume / cluster.density_factor;
    fill_moments(&mut report, body, volume, cluster.inertia, centre);
    report.bonds = cluster.bonds.len();
    report
}

/// Shape measures of a clump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnionShape {
    /// Wadell's sphericity of the union.
    pub sphericity: f64,
    /// Volume of the union over its convex hull's.
    pub convexity: f64,
}

impl fmt::Display for UnionShape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "sphericity {:.3}, convexity {:.3}", self.sphericity, self.convexity)
    }
}

/// Returns sphericity and convexity, from 500 points per sphere.
pub fn union_shape(clump: &Clump) -> UnionShape {
    let exposed = exposed(&clump.spheres);
    let points: Vec<[f64; 3]> = exposed.iter().map(|e| e.0).collect();
    let hull = convex_hull(&points).ok().and_then(|s| Polyhedron::new(&s).ok());
    UnionShape {
        sphericity: sphericity(clump.volume, exposed.iter().map(|e| e.1).sum()),
        convexity: hull.map_or(1.0, |h| (clump.volume / h.moments().volume).min(1.0)),
    }
}

fn fill_moments(
    report: &mut StoneReport,
    body: &Polyhedron,
    volume: f64,
    inertia: [f64; 3],
    centre: Vector3<f64>,
) {
    let exact: BodyMoments = body.moments();
    let principal = exact.principal();
    report.volume_ratio = volume / exact.volume;
    report.inertia_ratio = std::array::from_fn(|k| inertia[k] / principal[k]);
    report.centroid_offset = (centre - exact.centroid).norm() / body.sieve_size();
}

/// Centre of mass in the frame of `spheres` by the best rigid fit.
fn union_centre(spheres: &[Ball], clump: &Clump) -> Vector3<f64> {
    // x = R x' + o with the best rotation: o = mean x − R mean x' (W. Kabsch, Acta Cryst. A32, 1976).
    let n = spheres.len() as f64;
    let mean = |list: &[Ball]| list.iter().map(|s| Vector3::from(s.0)).sum::<Vector3<f64>>() / n;
    let (here, there) = (mean(spheres), mean(&clump.spheres));
    let spread = spheres.iter().zip(&clump.spheres).fold(nalgebra::Matrix3::zeros(), |sum, (a, b)| {
        sum + (Vector3::from(a.0) - here) * (Vector3::from(b.0) - there).transpose()
    });
    let svd = spread.svd(true, true);
    let (Some(u), Some(vt)) = (svd.u, svd.v_t) else { return here - there };
    let sign = (u * vt).determinant().signum();
    let rotation = u * nalgebra::Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * vt;
    here - rotation * there
}

/// Uncovered surface points with their areas [m²].
fn exposed(spheres: &[Ball]) -> Vec<([f64; 3], f64)> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let mut found = Vec::new();
    for (i, (c, r)) in spheres.iter().enumerate() {
        let area = 4.0 * std::f64::consts::PI * r * r / SPHERE_POINTS as f64;
        for k in 0..SPHERE_POINTS {
            let z = 1.0 - (2 * k + 1) as f64 / SPHERE_POINTS as f64;
            let (sin, cos) = libm::sincos(golden * k as f64);
            let rim = (1.0 - z * z).sqrt();
            let p = Vector3::from(*c) + Vector3::new(rim * cos, rim * sin, z) * *r;
            let covered = |(j, (d, s)): (usize, &Ball)| j != i && (p - Vector3::from(*d)).norm() < *s;
            if !spheres.iter().enumerate().any(covered) {
                found.push((p.into(), area));
            }
        }
    }
    found
}

fn distances(
    body: &Polyhedron,
    distance: &SurfaceDistance,
    spheres: &[Ball],
    exposed: &[([f64; 3], f64)],
) -> StoneReport {
    let size = body.sieve_size();
    let from_union = |p: &[f64; 3]| {
        let p = Vector3::from(*p);
        spheres.iter().map(|(c, r)| (p - Vector3::from(*c)).norm() - r).fold(f64::INFINITY, f64::min).abs()
    };
    let found: Vec<f64> = body.surface_points(POINTS).iter().map(from_union).collect();
    let overhang = exposed.iter().map(|e| -distance.depth(e.0)).fold(0.0, f64::max);
    let mut extents = body.extents();
    extents.sort_by(|a, b| b.total_cmp(a));
    StoneReport {
        spheres: spheres.len(),
        bonds: 0,
        form: [extents[1] / extents[0], extents[2] / extents[1]],
        surface_sphericity: body.sphericity(),
        sphericity: None,
        volume_ratio: 0.0,
        inertia_ratio: [0.0; 3],
        centroid_offset: 0.0,
        mean_distance: found.iter().sum::<f64>() / found.len() as f64 / size,
        max_distance: found.iter().copied().fold(overhang, f64::max) / size,
        overhang: overhang / size,
        least_radius: spheres.iter().map(|s| s.1).fold(f64::INFINITY, f64::min) / size,
    }
}

impl fmt::Display for StoneReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.inertia_ratio;
        write!(f, "{} spheres", self.spheres)?;
        match self.sphericity {
            Some(_) => write!(f, ", volume {:.4}", self.volume_ratio)?,
            None => write!(
                f,
                ", {} bonds ({:.2} per sphere), porosity {:.4}",
                self.bonds,
                2.0 * self.bonds as f64 / self.spheres as f64,
                1.0 - self.volume_ratio
            )?,
        }
        write!(
            f,
            ", inertia {x:.4} {y:.4} {z:.4}, distance mean {:.4} max {:.4}, overhang {:.4}, centre off {:.4}, least \
             radius {:.4}, b/a {:.3}, c/b {:.3}, sphericity of the surface {:.4}",
            self.mean_distance,
            self.max_distance,
            self.overhang,
            self.centroid_offset,
            self.least_radius,
            self.form[0],
            self.form[1],
            self.surface_sphericity,
        )?;
        self.sphericity.map_or(Ok(()), |s| write!(f, ", of the spheres {s:.4}"))
    }
}
