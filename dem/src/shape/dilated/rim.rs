//! How the rim of a flat disk presses into another body: as an edge does (`press.rs`), summed up over arcs that are fixed in the disk, so
//! that friction has points to hold at all around, and a disk that rolls comes from one to the next.

use super::press::{Pressed, Target};
use super::scan;
use crate::base::Vec3;
use arrayvec::ArrayVec;
use std::f64::consts::TAU;

/// Arcs of a rim.
pub(crate) const ARCS: usize = 8;

/// Cells of a circle, in each of which a distance has one extremum. They are fixed in it, so that what is left out beforehand, which depends
/// on what is known of a pair, changes no bit.
const CELLS: usize = 32;
const CELL: f64 = TAU / CELLS as f64;

/// Most parts that convex faces cut a circle into.
const PARTS: usize = 2 * super::CORNERS;

/// Points and weights of Gauss's rule on [−1, 1].
const RULE: [[f64; 2]; 8] = super::press::CURVED;

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
    fn cells(&self) -> Turns {
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

/// What the points of an arc do together.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    /// ∫ (R − d) n ds, ∫ (R − d) p × n ds, ∫ (R − d) p ds, ∫ (R − d) ds and ∫ (R − d)² ds.
    force: Vec3,
    torque: Vec3,
    place: Vec3,
    whole: f64,
    squares: f64,
}

impl Sum {
    fn add(&mut self, circle: &Circle, [low, high]: [f64; 2], reach: f64, at: &dyn Fn(&Vec3) -> (f64, Vec3)) {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        for [x, w] in RULE {
            let p = circle.at(middle + half * x);
            let (d, n) = at(&p);
            let overlap = reach - d;
            let part = half * w * overlap;
            let force = n * part;
            self.force += force;
            self.torque += p.cross(&force);
            self.place += p * part;
            self.whole += part;
            self.squares += part * overlap;
        }
    }

    /// As one force at the mean place. `radius`: that of the circle, for lengths along it.
    fn pressed(&self, radius: f64) -> Option<Pressed> {
        let size = self.force.norm();
        if size <= 0.0 || self.whole <= 0.0 {
            return None;
        }
        let point = self.place / self.whole;
        let couple = (self.torque - point.cross(&self.force)) / size;
        Some(Pressed { force: self.force * radius, overlap: self.squares / size, point, couple })
    }
}

/// What the arcs of a rim do to a target: calls `put` with the number of each that presses. Only what has `floor` ≤ 0 of the circle
/// can: coefficients as in [`Circle::along`].
pub(crate) fn rim(
    target: &impl Target,
    circle: &Circle,
    floor: [f64; 3],
    reach: f64,
    mut put: impl FnMut(u32, &Pressed),
) {
    let mut turns = Turns::whole();
    turns.cut(floor);
    if !turns.some() {
        return;
    }
    let turns = turns.cells();
    let mut sums = [Sum::default(); ARCS];
    const STEP: f64 = TAU / ARCS as f64;
    target.turns(circle, &turns, reach, |range, at| {
        for (k, sum) in sums.iter_mut().enumerate() {
            let part = [range[0].max(k as f64 * STEP), range[1].min((k + 1) as f64 * STEP)];
            if part[0] < part[1] {
                sum.add(circle, part, reach, at);
            }
        }
    });
    let radius = circle.x.norm();
    for (k, sum) in sums.iter().enumerate() {
        if let Some(pressed) = sum.pressed(radius) {
            put(k as u32, &pressed);
        }
    }
}
