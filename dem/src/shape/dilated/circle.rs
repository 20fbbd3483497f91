//! Circles, and parts of them that planes and distances cut.

use super::{CORNERS, scan};
use crate::base::Vec3;
use arrayvec::ArrayVec;
use std::f64::consts::TAU;

/// Cells of a circle, in each of which a distance has one extremum. They are fixed in it, so that what is left out beforehand, which depends
/// on what is known of a pair, changes no bit.
const CELLS: usize = 32;
const CELL: f64 = TAU / CELLS as f64;

/// Most parts that convex faces cut a circle into.
const PARTS: usize = 2 * CORNERS;

/// A circle: points `centre` + cos t `x` + sin t `y`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circle {
    pub centre: Vec3,
    /// Two radii at a right angle.
    pub x: Vec3,
    pub y: Vec3,
}

impl Circle {
    pub fn at(&self, t: f64) -> Vec3 {
        let (sine, cosine) = libm::sincos(t);
        self.centre + self.x * cosine + self.y * sine
    }

    /// Its point, and the derivative of that.
    pub fn moving(&self, t: f64) -> (Vec3, Vec3) {
        let (sine, cosine) = libm::sincos(t);
        (self.centre + self.x * cosine + self.y * sine, self.y * cosine - self.x * sine)
    }

    /// Coefficients of n·p − level on it: of one, cosine and sine.
    pub fn along(&self, n: &Vec3, level: f64) -> [f64; 3] {
        [n.dot(&self.centre) - level, n.dot(&self.x), n.dot(&self.y)]
    }

    /// Coefficients of what is zero or less on it within `reach` of a point.
    pub fn around(&self, p: &Vec3, reach: f64) -> [f64; 3] {
        let way = self.centre - p;
        let square = way.norm_squared() + self.x.norm_squared() - reach * reach;
        [square, 2.0 * way.dot(&self.x), 2.0 * way.dot(&self.y)]
    }

    /// Calls `put` with each part of a range in which a distance, given with its direction, is below `reach`.
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

/// The ends of the cells of a part of a circle.
pub(crate) fn ends([from, to]: [f64; 2]) -> impl Iterator<Item = f64> {
    let inner = (1..CELLS).map(|k| k as f64 * CELL).filter(move |t| *t > from && *t < to);
    std::iter::once(from).chain(inner).chain(std::iter::once(to))
}

/// Parts of a circle, in order.
#[derive(Clone, Debug)]
pub(crate) struct Turns(pub ArrayVec<[f64; 2], PARTS>);

impl Turns {
    /// All of it.
    pub fn whole() -> Turns {
        Turns::of([0.0, TAU])
    }

    /// One part.
    pub fn of(range: [f64; 2]) -> Turns {
        Turns(ArrayVec::from_iter([range]))
    }

    /// The cells of which some is in one of these parts.
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

    /// Leaves what has a + b cos t + c sin t ≤ 0.
    pub fn cut(&mut self, [a, b, c]: [f64; 3]) {
        let most = libm::hypot(b, c);
        if a <= -most {
            return;
        }
        let old = std::mem::take(&mut self.0);
        if a > most {
            return;
        }
        // cos(t − middle) ≤ −a/most: beyond an angle on either side of the highest place.
        let aside = libm::acos((-a / most).clamp(-1.0, 1.0));
        let (first, long) = (libm::atan2(c, b) + aside, TAU - 2.0 * aside);
        for [from, to] in old {
            let mut turn = ((from - first - long) / TAU).ceil();
            while first + TAU * turn < to {
                let at = first + TAU * turn;
                let part = [at.max(from), (at + long).min(to)];
                // More parts than faces can cut do not come about.
                if part[0] < part[1] && self.0.try_push(part).is_err() {
                    return;
                }
                turn += 1.0;
            }
        }
    }

    /// The same beyond a border that another feature's region shares: what lies in the border all along is the other's.
    pub fn cut_beyond(&mut self, [a, b, c]: [f64; 3]) {
        if b == 0.0 && c == 0.0 && a >= 0.0 {
            self.0.clear();
        }
        self.cut([a, b, c]);
    }
}
