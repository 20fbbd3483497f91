//! Radial distribution function.
//!
//! Reference centres are farther than the cut-off from non-periodic sides.
//!
//! Source: Allen & Tildesley, Computer Simulation of Liquids (2017), sec. 8.2, eq. (8.14).

use super::region::BoxRegion;
use crate::base::Vec3;
use crate::engine::model::Model;
use crate::engine::state::State;
use std::f64::consts::PI;

/// Returns g in `bins` equal shells up to `reach` [m]. `None` without reference centres, or if `reach`
/// exceeds half a period.
pub fn radial_distribution(
    model: &Model,
    state: &State,
    region: &BoxRegion,
    counted: impl Fn(usize) -> bool,
    reach: f64,
    bins: usize,
) -> Option<Vec<f64>> {
    let around = round(model, region);
    if (0..3).any(|d| around[d] && 2.0 * reach > region.high[d] - region.low[d]) {
        return None;
    }
    let centres: Vec<Vec3> = (0..model.body_count())
        .filter(|&b| state.present(b) && counted(b))
        .map(|b| model.wrap(&state.position(b)))
        .filter(|x| region.holds(x))
        .collect();
    let inner = |x: &Vec3| {
        (0..3).all(|d| around[d] || (x[d] - region.low[d] >= reach && region.high[d] - x[d] >= reach))
    };
    let grid = Grid::new(&centres, region, around, reach);
    let mut count = vec![0_u64; bins];
    let mut inside = 0_u64;
    for (i, x) in centres.iter().enumerate().filter(|(_, x)| inner(x)) {
        inside += 1;
        grid.near(x, |j, away| {
            let bin = (away / reach * bins as f64) as usize;
            if i != j && bin < bins {
                count[bin] += 1;
            }
        });
    }
    if inside == 0 {
        return None;
    }
    let density = centres.len() as f64 / region.volume();
    let width = reach / bins as f64;
    let shell = |k: usize| 4.0 / 3.0 * PI * width.powi(3) * ((k + 1).pow(3) - k.pow(3)) as f64;
    let of = |(k, n): (usize, &u64)| *n as f64 / (inside as f64 * density * shell(k));
    Some(count.iter().enumerate().map(of).collect())
}

/// Axes spanning the period.
fn round(model: &Model, region: &BoxRegion) -> [bool; 3] {
    let borders = model.periodic();
    std::array::from_fn(|d| {
        borders[d].is_some_and(|[low, high]| {
            let slack = 1e-9 * (high - low);
            (region.low[d] - low).abs() <= slack && (region.high[d] - high).abs() <= slack
        })
    })
}

/// Cells at least as wide as the cut-off.
struct Grid<'a> {
    points: &'a [Vec3],
    low: Vec3,
    side: Vec3,
    around: [bool; 3],
    counts: [usize; 3],
    /// Offsets in `order`.
    first: Vec<usize>,
    order: Vec<usize>,
}

impl<'a> Grid<'a> {
    fn new(points: &'a [Vec3], region: &BoxRegion, around: [bool; 3], reach: f64) -> Grid<'a> {
        let side = region.high - region.low;
        // No more cells than points.
        let most = libm::cbrt(points.len() as f64).ceil().max(1.0);
        let counts = std::array::from_fn(|d| (side[d] / reach).floor().clamp(1.0, most) as usize);
        let mut grid =
            Grid { points, low: region.low, side, around, counts, first: Vec::new(), order: Vec::new() };
        let cells: Vec<usize> = points.iter().map(|x| grid.number(grid.cell(x))).collect();
        grid.first = vec![0; counts.iter().product::<usize>() + 1];
        cells.iter().for_each(|&c| grid.first[c + 1] += 1);
        (1..grid.first.len()).for_each(|c| grid.first[c] += grid.first[c - 1]);
        grid.order = (0..points.len()).collect();
        grid.order.sort_by_key(|&k| cells[k]);
        grid
    }

    fn cell(&self, x: &Vec3) -> [usize; 3] {
        std::array::from_fn(|d| {
            let part = (x[d] - self.low[d]) / self.side[d];
            ((part * self.counts[d] as f64) as usize).min(self.counts[d] - 1)
        })
    }

    fn number(&self, [a, b, c]: [usize; 3]) -> usize {
        (c * self.counts[1] + b) * self.counts[0] + a
    }

    /// Neighbour cells on an axis, each once.
    fn beside(&self, d: usize, at: usize) -> impl Iterator<Item = usize> {
        let (n, around) = (self.counts[d], self.around[d]);
        (0..n).filter(move |&k| {
            let apart = k.abs_diff(at);
            apart <= 1 || (around && apart == n - 1)
        })
    }

    /// Minimum-image distances.
    fn near(&self, x: &Vec3, mut f: impl FnMut(usize, f64)) {
        let [a, b, c] = self.cell(x);
        for k in self.beside(2, c) {
            for j in self.beside(1, b) {
                for i in self.beside(0, a) {
                    let cell = self.number([i, j, k]);
                    for &p in &self.order[self.first[cell]..self.first[cell + 1]] {
                        let way = self.points[p] - x;
                        let way = Vec3::from_fn(|d, _| {
                            let turns = if self.around[d] { (way[d] / self.side[d]).round() } else { 0.0 };
                            way[d] - turns * self.side[d]
                        });
                        f(p, way.norm());
                    }
                }
            }
        }
    }
}

#[cfg(test)]
#[path = "radial_tests.rs"]
mod tests;
