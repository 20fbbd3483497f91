//! Breakage of bonded stones, from sieve curves before and after.
//!
//! Sieve size of a fragment: intermediate principal extent at initial positions, constant for unbroken
//! stones.
//!
//! * Marsal (1967): sum of the decreases of mass fraction retained on the R10 sieves.
//! * Ballast breakage index (Indraratna, Lackenby & Christie, Géotechnique 55 (2005) 325): A/(A + B) on a
//!   linear size axis, A the area between both curves, A + B from the initial curve to the line (2.36 mm, 0)
//!   to (d₉₅, 0.95).
//!
//! Limits: no fines below the sphere size; initially unbonded bodies do not count.

use crate::engine::model::Model;
use crate::engine::state::State;
use crate::shape::cluster::Cluster;
use std::collections::BTreeMap;

/// Smallest size of the ballast breakage index [m].
const SMALLEST: f64 = 2.36e-3;
/// Mass fraction passing its largest size.
const LARGEST: f64 = 0.95;
const R10: [f64; 10] = [1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0];

/// Sieve size [m], mass [kg].
type Piece = (f64, f64);

/// Sieve curves and breakage indices.
#[derive(Clone, Debug, PartialEq)]
pub struct Breakage {
    /// Sieve sizes [m], ascending.
    pub sieves: Vec<f64>,
    /// Initial mass fraction passing [-].
    pub before: Vec<f64>,
    /// Present mass fraction passing [-].
    pub after: Vec<f64>,
    /// Marsal's index.
    pub marsal: f64,
    /// Ballast breakage index; `None` if its area vanishes (fines).
    pub ballast: Option<f64>,
}

impl Breakage {
    /// Compares fragments before and after.
    pub fn of(before: &[Piece], after: &[Piece]) -> Breakage {
        let sizes = || before.iter().chain(after).map(|p| p.0);
        let sieves = series(sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
        let curves = [before, after].map(|pieces| passing(&sieves, pieces));
        let held = |curve: &[f64]| -> Vec<f64> {
            let above = curve.iter().skip(1).chain([&1.0]);
            curve.iter().zip(above).map(|(own, above)| above - own).collect()
        };
        let [held_before, held_after] = [held(&curves[0]), held(&curves[1])];
        let marsal = held_before.iter().zip(held_after).map(|(b, a)| (b - a).max(0.0)).sum();
        let [before_curve, after_curve] = curves;
        Breakage { sieves, before: before_curve, after: after_curve, marsal, ballast: ballast(before, after) }
    }
}

fn passing(sieves: &[f64], pieces: &[Piece]) -> Vec<f64> {
    let total: f64 = pieces.iter().map(|p| p.1).sum();
    // An empty `sum` would be -0.
    let finer = |sieve: f64| pieces.iter().filter(|p| p.0 <= sieve).fold(0.0, |sum, p| sum + p.1);
    sieves.iter().map(|&s| if total > 0.0 { finer(s) / total } else { 0.0 }).collect()
}

/// R10 sieves from the largest retaining `low` to the smallest passing `high` [m].
fn series(low: f64, high: f64) -> Vec<f64> {
    if !(low > 0.0 && high.is_finite() && low <= high) {
        return Vec::new();
    }
    let decades = (libm::log10(low).floor() as i32 - 1)..=(libm::log10(high).ceil() as i32);
    let sieve = |n: i32, r: f64| {
        if n < 0 { r / libm::pow(10.0, f64::from(-n)) } else { r * libm::pow(10.0, f64::from(n)) }
    };
    let all: Vec<f64> = decades.flat_map(|n| R10.map(|r| sieve(n, r))).collect();
    let first = all.iter().rposition(|s| *s < low).unwrap_or(0);
    let last = all.iter().position(|s| *s >= high).unwrap_or(all.len() - 1);
    all[first..=last].to_vec()
}

fn ballast(before: &[Piece], after: &[Piece]) -> Option<f64> {
    let mut rising = before.to_vec();
    rising.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = rising.iter().map(|p| p.1).sum();
    let mut passed = 0.0;
    let top = rising.iter().find(|p| {
        passed += p.1;
        passed >= LARGEST * total * (1.0 - 1e-12)
    })?;
    // ∫ P dd of the step curve.
    let area = |pieces: &[Piece]| -> f64 {
        let mass: f64 = pieces.iter().map(|p| p.1).sum();
        pieces.iter().map(|p| p.1 * (top.0 - p.0.max(SMALLEST)).max(0.0)).sum::<f64>() / mass
    };
    let all = 0.5 * LARGEST * (top.0 - SMALLEST) - area(before);
    (top.0 > SMALLEST && all > 0.0).then(|| (area(after) - area(before)) / all)
}

/// Returns the breakage; `None` without bonds or initial positions.
pub fn breakage(model: &Model, state: &State) -> Option<Breakage> {
    let starts = model.bodies.positions()?;
    let mut bonded: Vec<u32> = model.bonds.iter().flat_map(|b| b.ends).collect();
    bonded.sort_unstable();
    bonded.dedup();
    if bonded.is_empty() {
        return None;
    }
    let all = model.bonds.iter().map(|b| b.ends);
    let mut whole = Vec::new();
    state.each_bond(|number, _| whole.push(model.bonds[number as usize].ends));
    let pieces = |bonds: Vec<[u32; 2]>| -> Vec<Piece> {
        let of = crate::engine::pieces::components(model.body_count(), bonds);
        let mut groups: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        bonded.iter().for_each(|&b| groups.entry(of[b as usize]).or_default().push(b));
        groups.values().map(|bodies| piece(model, starts, bodies)).collect()
    };
    Some(Breakage::of(&pieces(all.collect()), &pieces(whole)))
}

/// Connected bodies at their initial positions.
fn piece(model: &Model, starts: &[crate::base::Vec3], bodies: &[u32]) -> Piece {
    let spheres: Vec<([f64; 3], f64)> =
        bodies.iter().map(|&b| (starts[b as usize].into(), model.radius(b as usize))).collect();
    let chain: Vec<[u32; 2]> = (1..bodies.len() as u32).map(|k| [k - 1, k]).collect();
    let mass = bodies.iter().map(|&b| model.mass(b as usize)).sum();
    let size = Cluster::new(&spheres, &chain, 1.0).map_or(2.0 * spheres[0].1, |cluster| cluster.sieve_size());
    (size, mass)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Manual: 10 units of 20 to 60 mm; a 50 mm stone of 3 units breaks into 40 mm (2) and 20 mm (1): d₉₅ =
    /// 60 mm, A = (2 · 10 + 1 · 30)/10 = 5 mm, initial area (1 · 40 + 2 · 30 + 3 · 20 + 3 · 10)/10 = 19 mm,
    /// line 0.95 · 57.64/2 = 27.379 mm.
    #[test]
    fn indices_match_hand_calculation() {
        let before = [(0.02, 1.0), (0.03, 2.0), (0.04, 3.0), (0.05, 3.0), (0.06, 1.0)];
        let after = [(0.02, 1.0), (0.03, 2.0), (0.04, 3.0), (0.04, 2.0), (0.02, 1.0), (0.06, 1.0)];
        let found = Breakage::of(&before, &after);
        assert!((found.marsal - 0.3).abs() < 1e-12, "{found:?}");
        let index = found.ballast.expect("an index");
        assert!((index - 5.0 / 8.379).abs() < 1e-9, "{index}");
        let close =
            |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(close(&found.sieves, &[0.016, 0.02, 0.025, 0.0315, 0.04, 0.05, 0.063]), "{:?}", found.sieves);
        assert!(close(&found.before, &[0.0, 0.1, 0.1, 0.3, 0.6, 0.9, 1.0]), "{:?}", found.before);
        assert!(close(&found.after, &[0.0, 0.2, 0.2, 0.4, 0.9, 0.9, 1.0]), "{:?}", found.after);
        let same = Breakage::of(&before, &before);
        assert_eq!((same.marsal, same.ballast), (0.0, Some(0.0)));
    }

    #[test]
    fn no_index_without_area() {
        assert_eq!(Breakage::of(&[(0.002, 1.0)], &[(0.001, 1.0)]).ballast, None);
        assert_eq!(Breakage::of(&[], &[]).ballast, None);
        // All 50 mm stones halved: A = 25 mm of 0.95 · 47.64/2.
        let one = Breakage::of(&[(0.05, 1.0)], &[(0.025, 0.5), (0.025, 0.5)]);
        assert!((one.ballast.unwrap() - 25.0 / (0.475 * 47.64)).abs() < 1e-9);
        assert_eq!(one.marsal, 1.0);
    }
}
