//! Circles, and arcs cut by planes and distances.

use super::{CORNERS, scan};
use crate::base::Vec3;
use arrayvec::ArrayVec;
use std::f64::consts::TAU;

/// Cells of a circle with one distance extremum each; fixed, so culling does not affect results.
const CELLS: usize = 32;
const CELL: f64 = TAU / CELLS as f64;

/// Most arcs cut by convex faces.
const PARTS: usize = 2 * CORNERS;

/// Circle `centre` + cos t `x` + sin t `y`.
#[derive(Clone, Copy, Debug)]
pub struct Circle {
    pub centre: Vec3,
    /// Orthogonal radii.
    pub x: Vec3,
    pub y: Vec3,
}

impl Circle {
    pub fn at(&self, t: f64) -> Vec3 {
        let (sine, cosine) = libm::sincos(t);
        self.centre + self.x * cosine + self.y * sine
    }

    /// Point and derivative.
    pub fn moving(&self, t: f64) -> (Vec3, Vec3) {
        let (sine, cosine) = libm::sincos(t);
        (self.centre + self.x * cosine + self.y * sine, self.y * cosine - self.x * sine)
    }

    /// Coefficients of n·p − level: 1, cos, sin.
    pub fn along(&self, n: &Vec3, level: f64) -> [f64; 3] {
        [n.dot(&self.centre) - level, n.dot(&self.x), n.dot(&self.y)]
    }

    /// Coefficients of a function ≤ 0 within `reach` of a point.
    pub fn around(&self, p: &Vec3, reach: f64) -> [f64; 3] {
        let way = self.centre - p;
        let square = way.norm_squared() + self.x.norm_squared() - reach * reach;
        [square, 2.0 * way.dot(&self.x), 2.0 * way.dot(&self.y)]
    }

    /// Calls `put` for each arc with distance below `reach`.
    pub fn near(
        &self,
        range: [f64; 2],
        reach: f64,
        at: &dyn Fn(&Vec3) -> (f64, Vec3),
        put: impl FnMut([f64; 2]),
    ) {
        let gap = |t: f64| {
            let (p, slope) = self.moving(t);
            let (d, n) = at(&p);
            [d - reach, n.dot(&slope)]
        };
        scan::below(ends(range), range, &gap, put);
    }
}

/// Cell boundaries within an arc.
pub fn ends([from, to]: [f64; 2]) -> impl Iterator<Item = f64> {
    let inner = (1..CELLS).map(|k| k as f64 * CELL).filter(move |t| *t > from && *t < to);
    std::iter::once(from).chain(inner).chain(std::iter::once(to))
}

/// Arcs, in order.
#[derive(Clone, Debug)]
pub struct Turns(pub ArrayVec<[f64; 2], PARTS>);

impl Turns {
    pub fn whole() -> Turns {
        Turns::of([0.0, TAU])
    }

    pub fn of(range: [f64; 2]) -> Turns {
        Turns(ArrayVec::from_iter([range]))
    }

    /// Cells overlapping these arcs.
    pub fn cells(&self) -> Turns {
        let mut cells: ArrayVec<[f64; 2], PARTS> = ArrayVec::new();
        for k in 0..CELLS {
            let cell = [k as f64 * CELL, (k + 1) as f64 * CELL];
            if !self.0.iter().any(|part| part[0] < cell[1] && part[1] > cell[0]) {
                continue;
            }
            match cells.last_mut() {
                Some(last) if last[1] == cell[0] => last[1] = cell[1],
                _ => cells.push(cell),
            }
        }
        Turns(cells)
    }

    pub fn some(&self) -> bool {
        !self.0.is_empty()
    }

    /// Keeps a + b cos t + c sin t ≤ 0.
    pub fn cut(&mut self, [a, b, c]: [f64; 3]) {
        let most = libm::hypot(b, c);
        if a <= -most {
            return;
        }
        let old = std::mem::take(&mut self.0);
        if a > most {
            return;
        }
        // cos(t − middle) ≤ −a/most excludes an arc about the maximum.
        let aside = libm::acos((-a / most).clamp(-1.0, 1.0));
        let (first, long) = (libm::atan2(c, b) + aside, TAU - 2.0 * aside);
        for [from, to] in old {
            let mut turn = ((from - first - long) / TAU).ceil();
            while first + TAU * turn < to {
                let at = first + TAU * turn;
                let part = [at.max(from), (at + long).min(to)];
                // Faces cannot cut more arcs.
                if part[0] < part[1] && self.0.try_push(part).is_err() {
                    return;
                }
                turn += 1.0;
            }
        }
    }

    /// As `cut`; an arc entirely in a shared boundary belongs to the other feature.
    pub fn cut_beyond(&mut self, [a, b, c]: [f64; 3]) {
        if b == 0.0 && c == 0.0 && a >= 0.0 {
            self.0.clear();
        }
        self.cut([a, b, c]);
    }
}
