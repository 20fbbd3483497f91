//! Random stones: convex hulls of points near an ellipsoid.
//!
//! Random points on a sphere are pushed apart and moved radially by up to 10 %. Angularity a sets their
//! number n = 8 · 10^(1 − a), from 80 to 8.
//!
//! Ratios after T. Zingg (1935): elongation b/a and flatness c/b of the extents a ≥ b ≥ c.

use nalgebra::{Matrix3, Vector3};
use trackbed_dem::random::Random;
use trackbed_dem::shape::polyhedron::{Polyhedron, convex_hull};

const PURPOSE: u64 = 11;
/// Points at angularity 1, and factor at 0.
const POINTS: [f64; 2] = [8.0, 10.0];
const ROUGHNESS: f64 = 0.1;
const REPULSIONS: usize = 60;

/// Ranges of the shape, sampled uniformly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Form {
    /// Intermediate over longest extent, > 0, ≤ 1.
    pub elongation: [f64; 2],
    /// Shortest over intermediate extent, > 0, ≤ 1.
    pub flatness: [f64; 2],
    /// From 0, blunt, to 1, sharp.
    pub angularity: [f64; 2],
}

/// Returns stone `index` of a seed in its principal frame, sieve size 1 m.
pub fn stone(seed: u64, index: u64, form: &Form) -> Polyhedron {
    let mut random = Random::new(seed, PURPOSE + 0x1_0000 * (index + 1));
    let mut draw = |[lo, hi]: [f64; 2]| lo + (hi - lo) * random.uniform();
    let (elongation, flatness, angularity) =
        (draw(form.elongation), draw(form.flatness), draw(form.angularity));
    let count = (POINTS[0] * libm::pow(POINTS[1], 1.0 - angularity)).round() as usize;
    // Redraw if the hull has no volume.
    let body = loop {
        let points = points(&mut random, count, [1.0, elongation, elongation * flatness]);
        if let Ok(body) = convex_hull(&points).map_err(drop).and_then(|s| Polyhedron::new(&s).map_err(drop)) {
            break body;
        }
    };
    fitted(body, elongation, flatness)
}

fn points(random: &mut Random, count: usize, axes: [f64; 3]) -> Vec<[f64; 3]> {
    let mut p: Vec<Vector3<f64>> = (0..count).map(|_| random.orientation() * Vector3::z()).collect();
    for _ in 0..REPULSIONS {
        let pushed: Vec<Vector3<f64>> = p
            .iter()
            .map(|a| {
                let push = |b: &Vector3<f64>| {
                    let d = a - b;
                    let r = d.norm();
                    if r > 0.0 { d / (r * r * r) } else { Vector3::zeros() }
                };
                (a + p.iter().map(push).sum::<Vector3<f64>>() * 0.01).normalize()
            })
            .collect();
        p = pushed;
    }
    p.iter()
        .map(|v| {
            let r = 1.0 + ROUGHNESS * (2.0 * random.uniform() - 1.0);
            std::array::from_fn(|k| v[k] * r * axes[k])
        })
        .collect()
}

/// Stretches rotate the principal frame slightly, so a few rounds are needed.
fn fitted(body: Polyhedron, elongation: f64, flatness: f64) -> Polyhedron {
    let wanted = [1.0 / elongation, 1.0, flatness];
    let mut body = body.in_principal_frame();
    for _ in 0..20 {
        let [lo, hi] = body.surface().bounds();
        let stretch = Vector3::from_fn(|k, _| wanted[k] / (hi[k] - lo[k]));
        body = body.mapped(&Matrix3::from_diagonal(&stretch), &Vector3::zeros()).in_principal_frame();
    }
    let size = body.sieve_size();
    body.scaled(1.0 / size)
}
