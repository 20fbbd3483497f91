//! Deposit of a slide: depth grid, extent, outline.

use super::ground::{self, Plan};
use crate::system::GrainsView;
use std::collections::BTreeMap;
use trackbed_input::model::grains::{GrainsPart, MOST_CELLS, RunoutPlan};

/// Depth grid of a deposit.
pub struct Deposit {
    /// Grid.
    pub plan: Plan,
    /// Ground height at cell centres, or lowest grain [m].
    pub ground: Vec<f64>,
    /// Depth above ground [m]; 0 if empty.
    pub depth: Vec<f64>,
    /// Grain volume over cell area [m].
    pub solid: Vec<f64>,
    /// Mean travel of grains [m].
    pub travel: Vec<f64>,
    /// Whether the cell belongs to the deposit.
    pub inside: Vec<bool>,
}

/// Measures the deposit of bodies `slide`; `travel` [m], shape `[bodies]`.
pub fn measure(
    view: GrainsView<'_>,
    part: &GrainsPart,
    runout: &RunoutPlan,
    slide: &[usize],
    travel: &[f64],
) -> Deposit {
    let spheres = || slide.iter().flat_map(|&b| view.state.spheres(view.model, b).into_iter());
    let count = spheres().count().max(1) as f64;
    let diameter = 2.0 * spheres().map(|(_, r)| r).sum::<f64>() / count;
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for (x, r) in spheres() {
        for d in 0..2 {
            low[d] = low[d].min(x[d] - r);
            high[d] = high[d].max(x[d] + r);
        }
    }
    let side = (high[0] - low[0]).max(high[1] - low[1]);
    let cell = runout.cell.unwrap_or(2.0 * diameter).max(side / MOST_CELLS as f64);
    // Whole multiples make maps comparable; an empty rim closes the outline.
    let low = low.map(|x| ((x / cell).floor() - 1.0) * cell);
    let counts = [0, 1].map(|d| ((high[d] - low[d]) / cell).ceil() as usize + 1);
    let plan = Plan { low, cell, counts };
    let mut top = vec![f64::NEG_INFINITY; plan.len()];
    let mut bottom = vec![f64::INFINITY; plan.len()];
    for (x, r) in spheres() {
        for j in plan.along(1, x.y - r)..=plan.along(1, x.y + r) {
            for i in plan.along(0, x.x - r)..=plan.along(0, x.x + r) {
                // At the cell point closest to the sphere axis.
                let [cx, cy] = plan.middle(i, j);
                let beyond = |c: f64, x: f64| ((x - c).abs() - 0.5 * cell).max(0.0);
                let distance2 = beyond(cx, x.x).powi(2) + beyond(cy, x.y).powi(2);
                if distance2 <= r * r {
                    let (k, h) = (plan.index(i, j), (r * r - distance2).sqrt());
                    top[k] = top[k].max(x.z + h);
                    bottom[k] = bottom[k].min(x.z - r);
                }
            }
        }
    }
    let (mut solid, mut way, mut mass) =
        (vec![0.0; plan.len()], vec![0.0; plan.len()], vec![0.0; plan.len()]);
    for &b in slide {
        let x = view.state.position(b);
        let k = plan.index(plan.along(0, x.x), plan.along(1, x.y));
        solid[k] += view.model.volume(b) / (cell * cell);
        way[k] += view.model.mass(b) * travel[b];
        mass[k] += view.model.mass(b);
    }
    let least = runout.depth.unwrap_or(0.5 * diameter);
    let below = ground::heights(view, part, &plan);
    let lowest = bottom.iter().copied().fold(f64::INFINITY, f64::min).min(0.0);
    let ground: Vec<f64> = (0..plan.len())
        .map(|k| below[k].unwrap_or(if bottom[k].is_finite() { bottom[k] } else { lowest }))
        .collect();
    let depth: Vec<f64> = (0..plan.len()).map(|k| (top[k] - ground[k]).max(0.0)).collect();
    let inside = depth.iter().map(|d| *d > least).collect();
    let travel = (0..plan.len()).map(|k| if mass[k] > 0.0 { way[k] / mass[k] } else { 0.0 }).collect();
    Deposit { plan, ground, depth, solid, travel, inside }
}

impl Deposit {
    /// Iterates over its cells.
    pub fn cells(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let [nx, ny] = self.plan.counts;
        (0..ny)
            .flat_map(move |j| (0..nx).map(move |i| (i, j)))
            .filter(|(i, j)| self.inside[self.plan.index(*i, *j)])
    }

    /// Returns the extent along a direction [m]; 0 if empty.
    pub fn extent(&self, direction: [f64; 2]) -> f64 {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (i, j) in self.cells() {
            let [x, y] = self.plan.middle(i, j);
            let s = x * direction[0] + y * direction[1];
            (low, high) = (low.min(s), high.max(s));
        }
        if low <= high { high - low + self.plan.cell } else { 0.0 }
    }

    /// Returns closed outlines, deposit on the left; inner ones are holes.
    pub fn outlines(&self) -> Vec<Vec<[f64; 2]>> {
        let is_in = |i: isize, j: isize| {
            let [nx, ny] = self.plan.counts.map(|n| n as isize);
            i >= 0 && j >= 0 && i < nx && j < ny && self.inside[self.plan.index(i as usize, j as usize)]
        };
        // At diagonal corners the line turns left.
        let mut next: BTreeMap<[isize; 2], Vec<[isize; 2]>> = BTreeMap::new();
        for (i, j) in self.cells().map(|(i, j)| (i as isize, j as isize)) {
            let sides = [
                ([i, j - 1], [i, j], [i + 1, j]),
                ([i + 1, j], [i + 1, j], [i + 1, j + 1]),
                ([i, j + 1], [i + 1, j + 1], [i, j + 1]),
                ([i - 1, j], [i, j + 1], [i, j]),
            ];
            for (beyond, from, to) in sides {
                if !is_in(beyond[0], beyond[1]) {
                    next.entry(from).or_default().push(to);
                }
            }
        }
        let mut lines = Vec::new();
        while let Some((&start, _)) = next.first_key_value() {
            let (mut at, mut came, mut line) = (start, None, Vec::new());
            loop {
                let ways = next.get_mut(&at).expect("sides of a closed line continue");
                let left = |to: &[isize; 2]| {
                    came.map_or(0, |[x, y]: [isize; 2]| x * (to[1] - at[1]) - y * (to[0] - at[0]))
                };
                let best = (0..ways.len()).max_by_key(|k| left(&ways[*k])).expect("a way on");
                let to = ways.swap_remove(best);
                if ways.is_empty() {
                    next.remove(&at);
                }
                line.push([0, 1].map(|d| self.plan.low[d] + at[d] as f64 * self.plan.cell));
                (came, at) = (Some([to[0] - at[0], to[1] - at[1]]), to);
                if at == start {
                    break;
                }
            }
            lines.push(line);
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn deposit(rows: &[&str]) -> Deposit {
        let (nx, ny) = (rows[0].len(), rows.len());
        let inside: Vec<bool> = rows.iter().flat_map(|r| r.bytes().map(|b| b == b'#')).collect();
        let depth = inside.iter().map(|i| f64::from(u8::from(*i))).collect();
        let plan = Plan { low: [10.0, 20.0], cell: 2.0, counts: [nx, ny] };
        let none = vec![0.0; nx * ny];
        Deposit { plan, ground: none.clone(), depth, solid: none.clone(), travel: none, inside }
    }

    fn area(line: &[[f64; 2]]) -> f64 {
        let next = line.iter().cycle().skip(1);
        0.5 * line.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
    }

    #[test]
    fn outline_area_equals_cell_area() {
        let ring = deposit(&["###", "#.#", "###"]);
        let lines = ring.outlines();
        assert_eq!(lines.len(), 2);
        assert_eq!(lines.iter().map(|l| area(l)).sum::<f64>(), 8.0 * 4.0);
        assert_eq!(lines[0][0], [10.0, 20.0]);
        let aslant = deposit(&["#.", ".#"]);
        let areas: Vec<f64> = aslant.outlines().iter().map(|l| area(l)).collect();
        assert_eq!(areas, [4.0, 4.0]);
        assert_eq!(aslant.extent([1.0, 0.0]), 4.0);
        assert!(deposit(&["..", ".."]).outlines().is_empty());
    }
}
