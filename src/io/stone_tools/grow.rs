//! Bonded stones: fills a body with separate spheres that grow until they jam.
//!
//! After each growth, overlaps are removed down to 0.3 % of the mean radius; otherwise the growth is halved.
//! When jammed, remaining overlaps are taken from the radii, and each sphere grows until contact.
//!
//! Source: growth with relaxation after B. D. Lubachevsky and F. H. Stillinger, J. Stat. Phys. 60, 1990,
//! without dynamics: overlaps are removed by projection.
//!
//! Theory manual: equation (2.5) of `docs/theory/shapes.md`.

use nalgebra::Vector3;
use trackbed_dem::distance::SurfaceDistance;
use trackbed_dem::random::Random;
use trackbed_dem::shape::polyhedron::Polyhedron;

use super::fill::Ball;

const PURPOSE: u64 = 12;
/// Largest overlap after relaxation over the mean radius.
const OVERLAP: f64 = 3e-3;
const SWEEPS: usize = 1000;
/// First and last growth per step.
const GROWTH: [f64; 2] = [0.1, 1e-3];
/// Neighbour search radius in mean diameters, and sweeps between searches.
const REACH: f64 = 1.6;
const RENEW: usize = 10;
const ALONE: f64 = 1.3;

/// Options of the growth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Number of spheres, ≥ 1.
    pub spheres: usize,
    /// Seed of positions and sizes.
    pub seed: u64,
    /// Relative deviation of radii before the final growth, 0 to < 1.
    pub spread: f64,
    /// Largest gap of bonded spheres over their mean radius.
    pub gap: f64,
}

/// Spheres grown in a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Grown {
    /// Spheres.
    pub spheres: Vec<Ball>,
    /// Bonded pairs from 0, lower index first.
    pub bonds: Vec<[u32; 2]>,
    /// Body volume over sphere volume.
    pub density_factor: f64,
}

/// Grows spheres in a body with its `distance`.
pub fn grow(body: &Polyhedron, distance: &SurfaceDistance, options: &Options) -> Grown {
    let volume = body.moments().volume;
    let [lo, hi] = body.surface().bounds();
    let mut random = Random::new(options.seed, PURPOSE);
    let n = options.spheres;
    let mut centres: Vec<Vector3<f64>> = Vec::with_capacity(n);
    while centres.len() < n {
        let p = std::array::from_fn(|k| lo[k] + random.uniform() * (hi[k] - lo[k]));
        if distance.contains(p) {
            centres.push(Vector3::from(p));
        }
    }
    let ratio: Vec<f64> = (0..n).map(|_| 1.0 + options.spread * (2.0 * random.uniform() - 1.0)).collect();
    let ball = 4.0 / 3.0 * std::f64::consts::PI;
    let cubes: f64 = ratio.iter().map(|s| s.powi(3)).sum();

    // Initially a fifth of the volume.
    let mut size = libm::cbrt(0.2 * volume / (ball * cubes));
    let mut jammed = Jam { distance, radii: vec![0.0; n], pairs: Vec::new(), mean: 0.0 };
    while !jammed.relax(&mut centres, &ratio, size) {
        size *= 0.8;
    }
    let mut growth = GROWTH[0];
    while growth > GROWTH[1] {
        let mut trial = centres.clone();
        if jammed.relax(&mut trial, &ratio, size * (1.0 + growth)) {
            centres = trial;
            size *= 1.0 + growth;
        } else {
            growth *= 0.5;
        }
    }
    let radii = alone(distance, &centres, &ratio.iter().map(|s| s * size).collect::<Vec<f64>>());
    let spheres: Vec<Ball> = centres.iter().map(|c| (*c).into()).zip(radii).collect();
    let solid: f64 = spheres.iter().map(|s| ball * s.1.powi(3)).sum();
    let mut bonds = Vec::new();
    for i in 0..n {
        for j in i + 1..n {
            if gap(&spheres[i], &spheres[j]) <= options.gap * 0.5 * (spheres[i].1 + spheres[j].1) {
                bonds.push([i as u32, j as u32]);
            }
        }
    }
    Grown { spheres, bonds, density_factor: volume / solid }
}

/// Returns the gap of two spheres [m], negative for overlap.
pub fn gap(a: &Ball, b: &Ball) -> f64 {
    (Vector3::from(a.0) - Vector3::from(b.0)).norm() - a.1 - b.1
}

struct Jam<'a> {
    distance: &'a SurfaceDistance,
    radii: Vec<f64>,
    pairs: Vec<(u32, u32)>,
    mean: f64,
}

impl Jam<'_> {
    /// Separates spheres of radius `ratio` × `size` within the body; whether it succeeded.
    fn relax(&mut self, centres: &mut [Vector3<f64>], ratio: &[f64], size: f64) -> bool {
        self.mean = size;
        self.radii.iter_mut().zip(ratio).for_each(|(r, s)| *r = s * size);
        for sweep in 0..SWEEPS {
            if sweep % RENEW == 0 {
                self.find_pairs(centres);
            }
            if self.sweep(centres) <= OVERLAP * self.mean {
                // Neighbours may have approached since the last search.
                self.find_pairs(centres);
                if self.sweep(centres) <= OVERLAP * self.mean {
                    return true;
                }
            }
        }
        false
    }

    fn find_pairs(&mut self, centres: &[Vector3<f64>]) {
        self.pairs.clear();
        for i in 0..centres.len() {
            for j in i + 1..centres.len() {
                let reach = REACH * (self.radii[i] + self.radii[j]);
                if (centres[i] - centres[j]).norm_squared() < reach * reach {
                    self.pairs.push((i as u32, j as u32));
                }
            }
        }
    }

    fn sweep(&self, centres: &mut [Vector3<f64>]) -> f64 {
        let mut largest = 0.0_f64;
        for &(i, j) in &self.pairs {
            let (i, j) = (i as usize, j as usize);
            let apart = centres[j] - centres[i];
            let d = apart.norm();
            let overlap = self.radii[i] + self.radii[j] - d;
            if overlap > 0.0 {
                largest = largest.max(overlap);
                let push = apart.try_normalize(0.0).unwrap_or_else(Vector3::x) * (0.5 * overlap);
                centres[i] -= push;
                centres[j] += push;
            }
        }
        for (c, r) in centres.iter_mut().zip(&self.radii) {
            let (depth, closest) = self.distance.depth_and_closest((*c).into());
            if depth < *r {
                largest = largest.max(r - depth);
                // Inward from the surface; outer centres pass through their closest point.
                let inward = (*c - Vector3::from(closest.point)) * depth.signum();
                *c += inward.try_normalize(0.0).unwrap_or_default() * (r - depth);
            }
        }
        largest
    }
}

/// Radii without overlap, each then grown up to contact.
fn alone(distance: &SurfaceDistance, centres: &[Vector3<f64>], radii: &[f64]) -> Vec<f64> {
    let n = centres.len();
    let depth: Vec<f64> = centres.iter().map(|c| distance.depth((*c).into())).collect();
    let mut fitted = radii.to_vec();
    for i in 0..n {
        fitted[i] = fitted[i].min(depth[i]);
        for j in (0..n).filter(|j| *j != i) {
            // Each of a pair shrinks by its share.
            fitted[i] = fitted[i].min((centres[i] - centres[j]).norm() * radii[i] / (radii[i] + radii[j]));
        }
    }
    for i in 0..n {
        let mut room = depth[i].min(ALONE * radii[i]);
        for j in (0..n).filter(|j| *j != i) {
            room = room.min((centres[i] - centres[j]).norm() - fitted[j]);
        }
        fitted[i] = fitted[i].max(room);
    }
    fitted
}
