//! Random rough stones: few spheres with small overlap.
//!
//! Clumps fitted to convex hulls lack hollows for interlocking. Of simple clumps, these came nearest to
//! measured compression and direct shear of ballast (B. Suhr, K. Six, Granular Matter 24:114, 2022,
//! 10.1007/s10035-022-01274-y).
//!
//! Random centres are pulled to the middle and pushed apart up to the allowed overlap.

use std::fmt;

use nalgebra::Vector3;
use rayon::prelude::*;
use trackbed_dem::insert::library::Stone;
use trackbed_dem::random::Random;
use trackbed_dem::shape::clump::Clump;

use super::fill::Ball;
use super::measure;

/// Explanation of the measures in a library.
pub const MEASURES: &str =
    "Volume and lengths at a sieve size of 1 m; convexity is the volume over the volume of the convex hull.";

const PURPOSE: u64 = 12;
/// Most draws per stone.
const DRAWS: usize = 20_000;
const ROUNDS: usize = 400;
/// Relative pull to the middle per round, along an axis of length 1.
const PULL: f64 = 0.02;
/// Fraction of excess overlap removed per round.
const PUSH: f64 = 0.5;

/// Shape of the stones; ranges are sampled uniformly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Form {
    /// Spheres per stone, ≥ 2.
    pub spheres: usize,
    /// Largest overlap over the sum of radii, 0 to 0.5.
    pub overlap: f64,
    /// Relative deviation of radii, 0 to 0.5.
    pub spread: f64,
    /// Range of intermediate over longest extent.
    pub elongation: [f64; 2],
    /// Range of shortest over intermediate extent.
    pub flatness: [f64; 2],
}

/// Rough stone and its measures.
#[derive(Clone, Debug, PartialEq)]
pub struct Rough {
    /// Library stone: sieve size 1 m, principal axes.
    pub stone: Stone,
    /// b/a and c/b of the principal extents a ≥ b ≥ c.
    pub ratios: [f64; 2],
    /// Sphericity and convexity.
    pub shape: measure::UnionShape,
    /// Volume at a sieve size of 1 m [m³].
    pub volume: f64,
}

impl fmt::Display for Rough {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let least = self.stone.spheres.iter().map(|s| s[3]).fold(f64::INFINITY, f64::min);
        write!(
            f,
            "{} spheres, volume {:.4} m³, least radius {least:.4}, b/a {:.3}, c/b {:.3}, {}",
            self.stone.spheres.len(),
            self.volume,
            self.ratios[0],
            self.ratios[1],
            self.shape
        )
    }
}

/// Returns `count` stones of a seed.
///
/// # Errors
/// Number of draws without success.
pub fn stones(seed: u64, count: usize, form: &Form) -> Result<Vec<Rough>, usize> {
    (0..count).into_par_iter().map(|i| stone(seed, i, form).ok_or(DRAWS)).collect()
}

fn stone(seed: u64, index: usize, form: &Form) -> Option<Rough> {
    let mut random = Random::new(seed, PURPOSE + 0x1_0000 * (index as u64 + 1));
    (0..DRAWS).find_map(|_| {
        let spheres = arranged(&mut random, form);
        let clump = Clump::from_spheres(&spheres).ok()?;
        let mut e = clump.extents();
        e.sort_by(|a, b| b.total_cmp(a));
        let ratios = [e[1] / e[0], e[2] / e[1]];
        let inside = |v: f64, [low, high]: [f64; 2]| (low..=high).contains(&v);
        if !inside(ratios[0], form.elongation) || !inside(ratios[1], form.flatness) {
            return None;
        }
        let clump = clump.scaled(1.0 / clump.sieve_size());
        let rows = clump.spheres.iter().map(|&([x, y, z], r)| [x, y, z, r]).collect();
        let stone = Stone { name: format!("rough {}", index + 1), spheres: rows, ..Stone::default() };
        Some(Rough { stone, ratios, shape: measure::union_shape(&clump), volume: clump.volume })
    })
}

fn arranged(random: &mut Random, form: &Form) -> Vec<Ball> {
    let mut draw = |[low, high]: [f64; 2]| low + (high - low) * random.uniform();
    let elongation = draw(form.elongation);
    let axes = [1.0, elongation, elongation * draw(form.flatness)];
    let radii: Vec<f64> = (0..form.spheres).map(|_| draw([1.0 - form.spread, 1.0 + form.spread])).collect();
    let mut at: Vec<Vector3<f64>> =
        radii.iter().map(|_| Vector3::from_fn(|k, _| axes[k] * draw([-2.0, 2.0]))).collect();
    for _ in 0..ROUNDS {
        let mut moves: Vec<Vector3<f64>> =
            at.iter().map(|p| Vector3::from_fn(|k, _| -PULL * p[k] / (axes[k] * axes[k]))).collect();
        for i in 0..at.len() {
            for j in 0..i {
                let apart = at[i] - at[j];
                let (distance, least) = (apart.norm(), (1.0 - form.overlap) * (radii[i] + radii[j]));
                if distance < least && distance > 0.0 {
                    let push = apart * (0.5 * PUSH * (least - distance) / distance);
                    moves[i] += push;
                    moves[j] -= push;
                }
            }
        }
        at.iter_mut().zip(moves).for_each(|(p, m)| *p += m);
    }
    at.iter().zip(radii).map(|(p, r)| ((*p).into(), r)).collect()
}
