//! Cell grids by counting sort, one per size class.
//!
//! Each class spans a factor of two in radius, so small spheres do not crowd large cells. Coordinates outside
//! are clamped: far bodies do not inflate the grid.

use crate::lanes::vec4::Vec4;

/// All smaller spheres share the last class.
const CLASSES: usize = 8;

#[derive(Clone, Debug, Default)]
struct Grid {
    lo: [f64; 3],
    inverse: f64,
    dims: [usize; 3],
    /// Largest radius [m].
    radius: f64,
    start: Vec<u32>,
    items: Vec<u32>,
}

#[derive(Clone, Debug, Default)]
pub struct Cells {
    grids: Vec<Grid>,
    class: Vec<u8>,
    key: Vec<u32>,
}

impl Grid {
    #[inline(always)]
    fn coordinate(&self, x: f64, d: usize) -> usize {
        // `as` saturates: far left becomes 0.
        (((x - self.lo[d]) * self.inverse) as usize).min(self.dims[d] - 1)
    }

    #[inline(always)]
    fn cell(&self, p: &Vec4) -> usize {
        let [x, y, z] = [0, 1, 2].map(|d| self.coordinate(p[d], d));
        (z * self.dims[1] + y) * self.dims[0] + x
    }
}

impl Cells {
    /// Sorts `points` (centre, radius); `skin`: search skin [m].
    pub fn build(&mut self, points: &[Vec4], radii: (f64, f64), skin: f64) {
        let wide = radii.1 > 3.0 * radii.0;
        let class_of = |r: f64| if wide { (libm::log2(radii.1 / r) as usize).min(CLASSES - 1) } else { 0 };
        self.class.clear();
        self.class.extend(points.iter().map(|p| class_of(p[3]) as u8));
        self.grids.resize_with(if wide { CLASSES } else { 1 }, Grid::default);
        for (class, grid) in self.grids.iter_mut().enumerate() {
            let members = || (0..points.len()).filter(|&k| self.class[k] as usize == class);
            let count = members().count();
            grid.items.clear();
            grid.radius = members().map(|k| points[k][3]).fold(0.0, f64::max);
            if count == 0 {
                continue;
            }
            grid.lay_out(members().map(|k| &points[k]), count, 2.0 * grid.radius + skin);
            let cells = grid.dims.iter().product::<usize>();
            grid.start.clear();
            grid.start.resize(cells + 1, 0);
            self.key.clear();
            for k in members() {
                let cell = grid.cell(&points[k]);
                self.key.push(cell as u32);
                grid.start[cell + 1] += 1;
            }
            for c in 0..cells {
                grid.start[c + 1] += grid.start[c];
            }
            grid.items.resize(count, 0);
            for (n, k) in members().enumerate() {
                let slot = &mut grid.start[self.key[n] as usize];
                grid.items[*slot as usize] = k as u32;
                *slot += 1;
            }
            grid.start.rotate_right(1);
            grid.start[0] = 0;
        }
    }

    /// Calls `f` with all points within `skin` of contact, and others in their cells.
    #[inline]
    pub fn neighbours(&self, p: &Vec4, skin: f64, mut f: impl FnMut(u32)) {
        for grid in &self.grids {
            if grid.items.is_empty() {
                continue;
            }
            let reach = p[3] + grid.radius + skin;
            let from = [0, 1, 2].map(|d| grid.coordinate(p[d] - reach, d));
            let to = [0, 1, 2].map(|d| grid.coordinate(p[d] + reach, d));
            for z in from[2]..=to[2] {
                for y in from[1]..=to[1] {
                    let row = (z * grid.dims[1] + y) * grid.dims[0];
                    let (a, b) = (grid.start[row + from[0]], grid.start[row + to[0] + 1]);
                    grid.items[a as usize..b as usize].iter().for_each(|&k| f(k));
                }
            }
        }
    }
}

impl Grid {
    /// Covers the points, or the middle 98 % per direction.
    fn lay_out<'a>(&mut self, points: impl Iterator<Item = &'a Vec4> + Clone, count: usize, cell: f64) {
        let most = 8 * count + 512;
        let bounds = |d: usize| {
            points.clone().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p[d]), h.max(p[d])))
        };
        let mut range = [0, 1, 2].map(bounds);
        let cells = |range: &[(f64, f64); 3], cell: f64| {
            range
                .map(|(l, h)| (((h - l) / cell) as usize).saturating_add(1))
                .iter()
                .fold(1, |a: usize, &b| a.saturating_mul(b))
        };
        if cells(&range, cell) > most {
            for (d, r) in range.iter_mut().enumerate() {
                let mut x: Vec<f64> = points.clone().map(|p| p[d]).collect();
                let cut = count / 100;
                let low = *x.select_nth_unstable_by(cut, f64::total_cmp).1;
                let high = *x.select_nth_unstable_by(count - 1 - cut, f64::total_cmp).1;
                *r = (low, high);
            }
        }
        let mut size = cell;
        while cells(&range, size) > most {
            size *= 1.26;
        }
        self.inverse = 1.0 / size;
        self.lo = range.map(|r| r.0);
        self.dims = range.map(|(l, h)| ((h - l) / size) as usize + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_core::Rng;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn finds_every_pair() {
        let mut rng = Pcg64Mcg::new(3);
        let mut unit = || (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        for (small, spread) in [(0.05, 0.01), (0.004, 0.1)] {
            let mut points: Vec<Vec4> =
                (0..600).map(|_| Vec4([unit(), unit(), unit(), small + spread * unit().powi(4)])).collect();
            points.extend([
                Vec4([1e6, 0.5, -3e5, small]),
                Vec4([1e6 + small, 0.5, -3e5, small]),
                Vec4([-1e9, 0.0, 0.0, small]),
            ]);
            let r = points.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), p| (l.min(p[3]), h.max(p[3])));
            let mut cells = Cells::default();
            cells.build(&points, r, 0.01);
            let mut pairs = 0;
            for p in &points {
                let mut found = vec![false; points.len()];
                cells.neighbours(p, 0.01, |k| found[k as usize] = true);
                for (k, q) in points.iter().enumerate() {
                    let d2: f64 = (0..3).map(|d| (p[d] - q[d]).powi(2)).sum();
                    let touches = d2 < (p[3] + q[3] + 0.01_f64).powi(2);
                    pairs += usize::from(touches);
                    assert!(!touches || found[k], "{p:?} {q:?}");
                }
            }
            assert!(pairs > 1000);
        }
    }
}
