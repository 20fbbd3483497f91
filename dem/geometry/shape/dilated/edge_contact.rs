//! Contact of rounded corners and edges with another body.
//!
//! Each point has overlap R − d: R the sum of radii, d the distance from the other core. Edges are integrated
//! piecewise by nearest face, edge or corner.
//!
//! Theory manual: equation (2.7) of `docs/theory/shapes.md`.

use super::circle::{self, Circle, Turns};
use super::part::Bounds;
use crate::base::Vec3;

/// Gauss points and weights on [−1, 1] for flat pieces: two are exact.
const FLAT: [[f64; 2]; 2] = [[-0.577_350_269_189_625_8, 1.0], [0.577_350_269_189_625_8, 1.0]];
const ROUND: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_86],
    [-0.339_981_043_584_856_3, 0.652_145_154_862_546_1],
    [0.339_981_043_584_856_3, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_86],
];

/// For curved surfaces.
pub const CURVED: [[f64; 2]; 8] = [
    [-0.960_289_856_497_536_2, 0.101_228_536_290_376_26],
    [-0.796_666_477_413_626_7, 0.222_381_034_453_374_47],
    [-0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [-0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_47],
    [0.960_289_856_497_536_2, 0.101_228_536_290_376_26],
];

/// Half length over distance below which four points give eleven digits.
const SHORT: f64 = 0.1;

/// Contact target.
pub trait Target {
    /// Returns true if contact within the bounds is possible.
    fn meets(&self, around: &Bounds) -> bool;

    /// Distance and unit vector towards the point; `None` inside or out of reach.
    fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)>;

    /// Calls `f` for each piece nearer than `reach` with one nearest feature.
    fn stretches(&self, segment: &Segment, reach: f64, f: impl FnMut([f64; 2], &Nearest));

    /// Calls `f` for given arcs nearer than `reach`; smooth within each arc.
    fn turns(
        &self,
        circle: &Circle,
        turns: &Turns,
        reach: f64,
        mut f: impl FnMut([f64; 2], &dyn Fn(&Vec3) -> (f64, Vec3)),
    ) {
        let at = |p: &Vec3| self.distance(p, f64::INFINITY).unwrap_or((0.0, Vec3::z()));
        for &range in &turns.0 {
            let mut from = range[0];
            for to in circle::ends(range).skip(1) {
                circle.near([from, to], reach, &at, |part| f(part, &at));
                from = to;
            }
        }
    }
}

/// Points `from` + s `direction`, s in `range`.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    pub from: Vec3,
    pub direction: Vec3,
    pub range: [f64; 2],
    /// Bounds of possible contacts.
    pub around: Bounds,
}

/// Nearest feature of a piece.
pub enum Nearest<'a> {
    /// Normal, initial distance, slope.
    Plane { normal: Vec3, at: f64, slope: f64 },
    /// Edge or corner: vector to the segment start, and slope.
    Line { at: Vec3, slope: Vec3 },
    /// Curved surface: distance and direction along the segment.
    Curve(&'a dyn Fn(f64) -> (f64, Vec3)),
}

/// Contact of a corner or edge.
#[derive(Clone, Copy, Debug)]
pub struct Indentation {
    /// (R − d) n at a corner, integrated along an edge.
    pub force: Vec3,
    /// R − d; for an edge, energy-equivalent spring overlap.
    pub overlap: f64,
    /// Contact point.
    pub point: Vec3,
    /// Torque about that point per force [m], if normals rotate along an edge.
    pub couple: Vec3,
    pub edge: bool,
}

pub fn corner(target: &impl Target, p: &Vec3, reach: f64) -> Option<Indentation> {
    let (d, n) = target.distance(p, reach)?;
    (d < reach).then(|| Indentation {
        force: n * (reach - d),
        overlap: reach - d,
        point: *p,
        couple: Vec3::zeros(),
        edge: false,
    })
}

/// Sums over an edge.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    /// ∫ (R − d) n ds, ∫ (R − d) n s ds and ∫ (R − d)² ds.
    force: Vec3,
    moment: Vec3,
    squares: f64,
}

impl Sum {
    /// Gauss rule; `at` returns distance and direction.
    fn by_rule(
        &mut self,
        rule: &[[f64; 2]],
        [low, high]: [f64; 2],
        reach: f64,
        at: impl Fn(f64) -> (f64, Vec3),
    ) {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        for [x, w] in rule {
            let s = middle + half * x;
            let (d, n) = at(s);
            let overlap = reach - d;
            let part = half * w * overlap;
            self.force += n * part;
            self.moment += n * (part * s);
            self.squares += part * overlap;
        }
    }

    /// Piece nearest to `at` + s `slope`: closed form, or a rule of equal accuracy.
    fn of_line(&mut self, range: [f64; 2], reach: f64, (at, slope): (&Vec3, &Vec3)) {
        let a = slope.norm_squared();
        let shift = if a > 0.0 { at.dot(slope) / a } else { 0.0 };
        let aside = at - slope * shift;
        let h2 = aside.norm_squared();
        let [u, v] = range.map(|s| s + shift);
        let (middle, half) = (0.5 * (u + v), 0.5 * (v - u));
        if a * (half * half - SHORT * SHORT * middle * middle) <= SHORT * SHORT * h2 {
            return self.by_rule(&ROUND, range, reach, |s| {
                let way = at + slope * s;
                let d = way.norm();
                (d, way * (1.0 / d))
            });
        }
        let (root, h2) = (a.sqrt(), h2.max(1e-300));
        let [du, dv] = [u, v].map(|u| (a * u * u + h2).sqrt());
        let (one, first, second) = (v - u, 0.5 * (v * v - u * u), (v * v * v - u * u * u) / 3.0);
        // asinh difference as one logarithm, without cancellation.
        let (ru, rv) = (root * u, root * v);
        let ratio = if u >= 0.0 {
            (rv + dv) / (ru + du)
        } else if v <= 0.0 {
            (du - ru) / (dv - rv)
        } else {
            (rv + dv) * ((du - ru) / h2)
        };
        let inverse = libm::log(ratio) / root;
        let by_first = (v - u) * (v + u) / (du + dv);
        let by_second = 0.5 * (v * dv - u * du - h2 * inverse) / a;
        let length = 0.5 * (v * dv - u * du + h2 * inverse);
        let force = aside * (reach * inverse - one) + slope * (reach * by_first - first);
        self.force += force;
        self.moment +=
            aside * (reach * by_first - first) + slope * (reach * by_second - second) - force * shift;
        self.squares += (reach * reach + h2) * one - 2.0 * reach * length + a * second;
    }
}

pub fn edge(target: &impl Target, segment: &Segment, reach: f64) -> Option<Indentation> {
    let mut sum = Sum::default();
    target.stretches(segment, reach, |range, nearest| match nearest {
        Nearest::Plane { normal, at, slope } => {
            sum.by_rule(&FLAT, range, reach, |s| (at + slope * s, *normal));
        }
        Nearest::Line { at, slope } => sum.of_line(range, reach, (at, slope)),
        Nearest::Curve(at) => sum.by_rule(&CURVED, range, reach, at),
    });
    let Sum { force, moment, squares } = sum;
    let size = force.norm();
    if size <= 0.0 {
        return None;
    }
    // Point where the force alone best reproduces the torque; arbitrary for force along the edge.
    let (lever, torque) = (segment.direction.cross(&force), segment.direction.cross(&moment));
    let square = lever.norm_squared();
    let s = if square > 1e-16 * size * size {
        lever.dot(&torque) / square
    } else {
        moment.dot(&force) / (size * size)
    };
    let couple = (torque - lever * s) / size;
    // Energy-equivalent overlap.
    let point = segment.from + segment.direction * s;
    Some(Indentation { force, overlap: squares / size, point, couple, edge: true })
}

pub struct HalfSpace {
    pub point: Vec3,
    pub normal: Vec3,
}

impl Target for HalfSpace {
    fn meets(&self, _: &Bounds) -> bool {
        true
    }

    fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)> {
        let d = (p - self.point).dot(&self.normal);
        (d < reach).then_some((d, self.normal))
    }

    fn stretches(&self, segment: &Segment, reach: f64, mut f: impl FnMut([f64; 2], &Nearest)) {
        let (at, slope) =
            ((segment.from - self.point).dot(&self.normal), segment.direction.dot(&self.normal));
        let mut stretch = Stretch(segment.range);
        stretch.cut(at - reach, slope);
        if stretch.some() {
            f(stretch.0, &Nearest::Plane { normal: self.normal, at, slope });
        }
    }

    fn turns(
        &self,
        circle: &Circle,
        turns: &Turns,
        reach: f64,
        mut f: impl FnMut([f64; 2], &dyn Fn(&Vec3) -> (f64, Vec3)),
    ) {
        let mut turns = turns.clone();
        turns.cut(circle.along(&self.normal, self.normal.dot(&self.point) + reach));
        let at = |p: &Vec3| ((p - self.point).dot(&self.normal), self.normal);
        turns.0.iter().for_each(|part| f(*part, &at));
    }
}

#[derive(Clone, Copy)]
pub struct Stretch(pub [f64; 2]);

impl Stretch {
    pub fn some(&self) -> bool {
        self.0[0] < self.0[1]
    }

    /// Keeps `at` + s `slope` ≤ 0.
    pub fn cut(&mut self, at: f64, slope: f64) {
        let end = -at / slope;
        let none = if at > 0.0 { f64::NEG_INFINITY } else { f64::INFINITY };
        let high = if slope > 0.0 {
            end
        } else if slope < 0.0 {
            f64::INFINITY
        } else {
            none
        };
        let low = if slope < 0.0 { end } else { f64::NEG_INFINITY };
        let [from, to] = self.0;
        self.0 = [if low > from { low } else { from }, if high < to { high } else { to }];
    }

    /// As `cut`, but a piece entirely in a shared boundary counts once, with the other feature.
    pub fn cut_beyond(&mut self, at: f64, slope: f64) {
        if slope == 0.0 && at >= 0.0 {
            self.0[1] = self.0[0];
        }
        self.cut(at, slope);
    }

    /// Keeps |`at` + s `slope`| ≤ `reach`.
    pub fn near(&mut self, at: &Vec3, slope: &Vec3, reach: f64) {
        let (a, b, c) = (slope.norm_squared(), at.dot(slope), at.norm_squared() - reach * reach);
        let root = b * b - a * c;
        if a < 1e-30 {
            if c > 0.0 {
                self.0[1] = self.0[0];
            }
        } else if root <= 0.0 {
            self.0[1] = self.0[0];
        } else {
            let root = root.sqrt();
            self.0 = [self.0[0].max((-b - root) / a), self.0[1].min((-b + root) / a)];
        }
    }
}

#[cfg(test)]
#[path = "edge_contact_tests.rs"]
mod tests;
