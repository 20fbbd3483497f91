//! Rough stones at random: few spheres that hardly overlap, with hollows between them.
//!
//! A hull filled with spheres is rounder than crushed rock and has no hollows into which a neighbour's corner fits. Few
//! spheres that hardly overlap have lower sphericity and interlock; of simple clumps these came nearest to measured
//! compression and direct shear of ballast (B. Suhr, K. Six, Granular Matter 24:114, 2022, 10.1007/s10035-022-01274-y).
//!
//! Centres are drawn at random, pulled to the middle, stronger along the short axes, and pushed apart until no two
//! spheres overlap by more than asked; what does not have the ratios asked for is drawn again.

use std::fmt;

use nalgebra::Vector3;
use rayon::prelude::*;
use trackbed_dem::insert::library::Stone;
use trackbed_dem::random::Random;
use trackbed_dem::shape::clump::Clump;

use super::fill::Ball;
use super::measure;

/// What the measures beside the stones of a library are.
pub const MEASURES: &str =
    "Volume and lengths at a sieve size of 1 m; convexity is the volume over that of the convex hull.";

const PURPOSE: u64 = 12;
/// Draws for one stone before the ratios are said to be out of reach.
const DRAWS: usize = 20_000;
const ROUNDS: usize = 400;
/// Share of the way to the middle that a centre is pulled in a round, along an axis of length 1.
const PULL: f64 = 0.02;
/// Share of the overlap too much that a pair is pushed apart in a round.
const PUSH: f64 = 0.5;

/// What the stones are like; ranges are drawn from uniformly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Form {
    /// Spheres of each stone, at least 2.
    pub spheres: usize,
    /// Largest overlap of two spheres as a share of the sum of their radii, 0 to 0.5.
    pub overlap: f64,
    /// Radii differ by this share up and down, 0 to 0.5.
    pub spread: f64,
    /// Range of the intermediate over the longest extent.
    pub elongation: [f64; 2],
    /// Range of the shortest over the intermediate extent.
    pub flatness: [f64; 2],
}

/// A rough stone and its measures.
#[derive(Clone, Debug, PartialEq)]
pub struct Rough {
    /// As it stands in a library: sieve size 1 m, principal axes.
    pub stone: Stone,
    /// b/a and c/b of the extents a ≥ b ≥ c in the principal frame.
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

/// `count` stones of a seed; each depends on its own number alone.
///
/// # Errors
/// The number of draws after which no stone had the ratios asked for.
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

/// Spheres at random places, pulled together and pushed apart.
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
