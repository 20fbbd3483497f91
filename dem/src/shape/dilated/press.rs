//! How the rounded corners and edges of one body press into another.
//!
//! A corner, and every point of an edge, presses by R − d: R is the sum of both radii, d the distance of the point from the other
//! core. Of an edge this is summed up along its length, piece by piece where the nearest face, edge or corner of the core is the
//! same; each piece ends where planes say so, exactly. The distance of a fixed point from a convex body has one gradient everywhere
//! outside of it, so the sums are smooth whatever turns into what, corners on edges into faces on faces, and forces that grow with
//! them have a potential.

use crate::base::Vec3;
use crate::shape::dilated::part::Bounds;

/// Points and weights of Gauss's rule on [−1, 1]: for the flat pieces, where two are exact, and for others.
const FLAT: [[f64; 2]; 2] = [[-0.577_350_269_189_625_8, 1.0], [0.577_350_269_189_625_8, 1.0]];
const ROUND: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_86],
    [-0.339_981_043_584_856_3, 0.652_145_154_862_546_1],
    [0.339_981_043_584_856_3, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_86],
];

/// What is pressed into.
pub(crate) trait Target {
    /// Whether it may be met within some bounds.
    fn meets(&self, around: &Bounds) -> bool;

    /// Distance of a point from it, and the unit vector from it to the point; `None` for points within or out of reach.
    fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)>;

    /// Calls `f` with each stretch of a segment that is nearer than `reach` and has one nearest feature.
    fn stretches(&self, segment: &Segment, reach: f64, f: impl FnMut([f64; 2], &Nearest));
}

/// A segment: points `from` + s `direction` with s in `range`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    pub from: Vec3,
    pub direction: Vec3,
    pub range: [f64; 2],
    /// What is farther from it than the reach lies beyond these.
    pub around: Bounds,
}

/// What is nearest on a stretch.
pub(crate) enum Nearest {
    /// A plane: its normal; distance of the segment's beginning, and its slope.
    Plane { normal: Vec3, at: f64, slope: f64 },
    /// An edge or a corner: the vector from it to the segment's beginning, and its slope.
    Line { at: Vec3, slope: Vec3 },
}

/// What a corner or an edge does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pressed {
    /// Away from what it presses into: (R − d) n at a corner, its integral along an edge.
    pub force: Vec3,
    /// R − d; of an edge what gives a spring with this force the energy of all of its points.
    pub overlap: f64,
    /// Where on the corner or the edge.
    pub point: Vec3,
    /// Torque about that point per unit of force [m]: of an edge whose normals turn along it.
    pub couple: Vec3,
}

/// What a corner does.
pub(crate) fn corner(target: &impl Target, p: &Vec3, reach: f64) -> Option<Pressed> {
    let (d, n) = target.distance(p, reach)?;
    (d < reach).then(|| Pressed {
        force: n * (reach - d),
        overlap: reach - d,
        point: *p,
        couple: Vec3::zeros(),
    })
}

/// What an edge does.
pub(crate) fn edge(target: &impl Target, segment: &Segment, reach: f64) -> Option<Pressed> {
    let (mut force, mut moment, mut squares) = (Vec3::zeros(), Vec3::zeros(), 0.0);
    target.stretches(segment, reach, |[low, high], nearest| {
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let mut add = |&[x, w]: &[f64; 2]| {
            let s = middle + half * x;
            let (d, n) = match nearest {
                Nearest::Plane { normal, at, slope } => (at + slope * s, *normal),
                Nearest::Line { at, slope } => {
                    let way = at + slope * s;
                    let d = way.norm();
                    (d, way * (1.0 / d))
                }
            };
            let overlap = reach - d;
            let part = half * w * overlap;
            force += n * part;
            moment += n * (part * s);
            squares += part * overlap;
        };
        match nearest {
            Nearest::Plane { .. } => FLAT.iter().for_each(&mut add),
            Nearest::Line { .. } => ROUND.iter().for_each(&mut add),
        }
    });
    let size = force.norm();
    if size <= 0.0 {
        return None;
    }
    // Where the force alone has the torque of all of it, nearly; anywhere, where it points along the edge.
    let (lever, torque) = (segment.direction.cross(&force), segment.direction.cross(&moment));
    let square = lever.norm_squared();
    let s = if square > 1e-16 * size * size {
        lever.dot(&torque) / square
    } else {
        moment.dot(&force) / (size * size)
    };
    let couple = (torque - lever * s) / size;
    // With this overlap a spring has the energy of all points of the edge.
    Some(Pressed { force, overlap: squares / size, point: segment.from + segment.direction * s, couple })
}

/// A half-space below a plane.
pub(crate) struct HalfSpace {
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
}

/// A stretch of a segment, from and to.
#[derive(Clone, Copy)]
pub(super) struct Stretch(pub [f64; 2]);

impl Stretch {
    pub fn some(&self) -> bool {
        self.0[0] < self.0[1]
    }

    /// Leaves what has `at` + s `slope` ≤ 0.
    pub fn cut(&mut self, at: f64, slope: f64) {
        if slope > 0.0 {
            self.0[1] = self.0[1].min(-at / slope);
        } else if slope < 0.0 {
            self.0[0] = self.0[0].max(-at / slope);
        } else if at > 0.0 {
            self.0[1] = self.0[0];
        }
    }

    /// The same beyond a border that another feature's region shares, from the same numbers: what lies in the border all along is the
    /// other's, so that edges over edges count once.
    pub fn cut_beyond(&mut self, at: f64, slope: f64) {
        if slope == 0.0 && at >= 0.0 {
            self.0[1] = self.0[0];
        }
        self.cut(at, slope);
    }

    /// Leaves what has |`at` + s `slope`| ≤ `reach`.
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
#[path = "press_tests.rs"]
mod tests;
