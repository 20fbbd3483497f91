//! Dilated polyhedra and triangulated bodies on round walls: frusta (cylinders), discs, spheres, moving
//! planes.
//!
//! Features indent by radius minus distance. A rim shared by side and disc counts once. Rims indent the body
//! at [`POINTS`] points, spheres with their centre.
//!
//! Limits: sides and spheres do not indent face interiors; inside a frustum only the nearest generator acts
//! (body smaller than the wall).

use super::dilated::{Frame, LENGTH, lost};
use super::pair::Manifold;
use super::patch::{Whole, points_on_body};
use super::scene::{PatchView, PosedBody};
use crate::base::Vec3;
use crate::shape::dilated::edge_contact::{HalfSpace, Nearest, Segment, Stretch, Target};
use crate::shape::dilated::part::{Bounds, View};
use crate::spatial::round::{Part, Round};
use crate::spatial::separation::separation;
use arrayvec::ArrayVec;

const POINTS: usize = 96;

/// Numbers of targets, and of the first rim point.
const SIDE: u32 = 0;
const RIM: u32 = 1;
const PRESSING: u32 = 8;

/// Iterations for nearest points and range ends.
const ROUNDS: usize = 48;

pub(super) fn may_touch(body: &PosedBody<'_>, patch: &PatchView<'_>, form: &Round, reach: f64) -> bool {
    let pose = patch.pose();
    let at = pose.orientation.inverse() * (body.centre - pose.centre);
    match form {
        Round::Frustum { far: true, .. } => false,
        Round::Plane { point, normal } => (at - point).dot(normal) < body.reach() + reach,
        _ => (form.closest(&at).0 - at).norm() < body.reach() + reach,
    }
}

/// Body in a round patch's frame.
pub(super) trait Indenter {
    /// Interior point.
    fn inner_point(&self) -> Vec3;

    /// Rounding radius [m].
    fn reach(&self) -> f64;

    /// Features indent a part of the patch, weighted by `count`.
    fn press(&mut self, target: &impl Target, number: (u32, f64));

    /// Points indent it; `own` of the sum of radii `reach` [m], weight.
    fn bear(&mut self, points: impl Iterator<Item = (u32, Vec3)>, lengths: (f64, f64, f64));

    fn through(&mut self, form: &Round) -> bool;

    /// Records penetration.
    fn lose(&mut self, normal: &Vec3);
}

pub(super) fn contact_points(
    body: &PosedBody<'_>,
    patch: &PatchView<'_>,
    form: &Round,
    found: &mut Manifold,
) {
    if !may_touch(body, patch, form, 0.0) {
        return;
    }
    let pose = patch.pose();
    let frame = Frame::new(&body.pose(), &pose);
    let view = View::everywhere(Vec3::z(), body.radius);
    let whole = Whole { body, frame: &frame, of: (u64::MAX, &view), pose: &pose };
    on(form, &mut OnRound { whole, found });
}

struct OnRound<'a> {
    whole: Whole<'a>,
    found: &'a mut Manifold,
}

impl Indenter for OnRound<'_> {
    fn inner_point(&self) -> Vec3 {
        self.whole.frame.way
    }

    fn reach(&self) -> f64 {
        self.whole.body.radius
    }

    fn press(&mut self, target: &impl Target, number: (u32, f64)) {
        self.whole.press(target, number, self.found);
    }

    fn bear(&mut self, points: impl Iterator<Item = (u32, Vec3)>, (own, reach, weight): (f64, f64, f64)) {
        let Whole { body, pose, .. } = self.whole;
        let back = Frame::new(pose, &body.pose());
        let points = points.map(|(number, p)| (number, back.point(&p)));
        points_on_body(body, points, (own / body.scale, reach / body.scale, weight), self.found);
    }

    fn through(&mut self, form: &Round) -> bool {
        match form {
            Round::Frustum { base, axis, height, radii, far: _ } => {
                Side::new(base, axis, *height, *radii).meets_core(self.whole.frame, self.whole.body)
            }
            // Detected by its corners.
            _ => false,
        }
    }

    fn lose(&mut self, normal: &Vec3) {
        self.found.push(lost(self.whole.body.centre, *normal, self.whole.body.radius));
    }
}

pub(super) fn on(form: &Round, presser: &mut impl Indenter) {
    let reach = presser.reach();
    match form {
        Round::Plane { point, normal } => {
            presser.press(&HalfSpace { point: *point, normal: *normal }, (SIDE, 1.0));
        }
        Round::Frustum { far: true, .. } => {}
        Round::Frustum { base, axis, height, radii, far: false } => {
            if presser.through(form) {
                return presser.lose(axis);
            }
            presser.press(&Side::new(base, axis, *height, *radii), (SIDE, 1.0));
        }
        Round::Disc { centre, axis, radius } => {
            if presser.through(form) {
                return presser.lose(axis);
            }
            presser.press(&Disc { centre, axis, radius: *radius }, (SIDE, 1.0));
            presser.press(&Circle { centre: *centre, axis: *axis, radius: *radius }, (RIM, -1.0));
            let weight = std::f64::consts::TAU * radius / (POINTS as f64 * LENGTH * reach);
            let x = helper(axis);
            let y = axis.cross(&x);
            let points = (0..POINTS).map(|k| {
                let (sine, cosine) = libm::sincos(std::f64::consts::TAU * k as f64 / POINTS as f64);
                (PRESSING + k as u32, centre + (x * cosine + y * sine) * *radius)
            });
            presser.bear(points, (0.0, reach, weight));
        }
        Round::Sphere { centre, radius } if (presser.inner_point() - centre).norm() > *radius => {
            presser.bear(std::iter::once((PRESSING, *centre)), (*radius, radius + reach, 1.0));
        }
        Round::Sphere { centre, radius } => {
            presser.press(&Bowl { centre, radius: *radius }, (SIDE, 1.0));
        }
    }
}

/// Whether a segment pierces a patch.
pub(super) fn pierced(form: &Round, segment: &Segment) -> bool {
    let within = |s: f64| segment.range[0] < s && s < segment.range[1];
    match form {
        Round::Frustum { base, axis, height, radii, .. } => {
            let seen = Seen::new(segment, base, axis);
            let mut places = Places::new();
            let run = radii[1] - radii[0];
            if *height > 0.0 {
                seen.at([radii[0] + seen.z[0] * run / height, seen.z[1] * run / height], &mut places);
                let between = |s: f64| (0.0..=*height).contains(&(seen.z[0] + s * seen.z[1]));
                places.iter().any(|s| within(*s) && between(*s))
            } else {
                seen.at_height(0.0, &mut places);
                let between = |s: f64| {
                    let [c, b, a] = seen.square;
                    let rho = (c + s * (b + s * a)).sqrt();
                    radii[0].min(radii[1]) <= rho && rho <= radii[0].max(radii[1])
                };
                places.iter().any(|s| within(*s) && between(*s))
            }
        }
        Round::Disc { centre, axis, radius } => {
            let seen = Seen::new(segment, centre, axis);
            let mut places = Places::new();
            seen.at_height(0.0, &mut places);
            let [c, b, a] = seen.square;
            places.iter().any(|s| within(*s) && c + s * (b + s * a) <= radius * radius)
        }
        Round::Plane { .. } | Round::Sphere { .. } => false,
    }
}

fn helper(axis: &Vec3) -> Vec3 {
    let mut x = Vec3::zeros();
    x[axis.iamin()] = 1.0;
    axis.cross(&x).normalize()
}

/// Ordered segment parameters.
type Places = ArrayVec<f64, 16>;

fn between(range: [f64; 2], mut places: Places, mut f: impl FnMut([f64; 2])) {
    places.retain(|s| *s > range[0] && *s < range[1]);
    places.sort_by(f64::total_cmp);
    let mut from = range[0];
    for to in places.into_iter().chain([range[1]]) {
        if to > from {
            f([from, to]);
        }
        from = to;
    }
}

struct Seen {
    /// Height: value, slope.
    z: [f64; 2],
    /// Squared distance, quadratic polynomial.
    square: [f64; 3],
}

impl Seen {
    fn new(segment: &Segment, centre: &Vec3, axis: &Vec3) -> Seen {
        let way = segment.from - centre;
        let z = [way.dot(axis), segment.direction.dot(axis)];
        let (at, slope) = (way - axis * z[0], segment.direction - axis * z[1]);
        Seen { z, square: [at.norm_squared(), 2.0 * at.dot(&slope), slope.norm_squared()] }
    }

    /// Roots of distance `level[0] + level[1] s`.
    fn at(&self, level: [f64; 2], places: &mut Places) {
        let [c, b, a] = self.square;
        let [c, b, a] = [c - level[0] * level[0], b - 2.0 * level[0] * level[1], a - level[1] * level[1]];
        let root = b * b - 4.0 * a * c;
        if root < 0.0 {
            return;
        }
        let q = -0.5 * (b + root.sqrt().copysign(b));
        for s in [q / a, c / q] {
            if s.is_finite() && level[0] + level[1] * s >= 0.0 {
                places.push(s);
            }
        }
    }

    fn at_height(&self, h: f64, places: &mut Places) {
        let s = (h - self.z[0]) / self.z[1];
        if s.is_finite() {
            places.push(s);
        }
    }
}

/// Gauss rule for curved targets.
fn curve(range: [f64; 2], at: &dyn Fn(f64) -> (f64, Vec3), f: &mut impl FnMut([f64; 2], &Nearest)) {
    f(range, &Nearest::Curve(at));
}

/// Side of a frustum.
struct Side {
    base: Vec3,
    axis: Vec3,
    height: f64,
    radii: [f64; 2],
    length: f64,
    near: Round,
}

impl Side {
    fn new(base: &Vec3, axis: &Vec3, height: f64, radii: [f64; 2]) -> Side {
        let near = Round::Frustum { base: *base, axis: *axis, height, radii, far: false };
        Side {
            base: *base,
            axis: *axis,
            height,
            radii,
            length: libm::hypot(height, radii[1] - radii[0]),
            near,
        }
    }

    /// Whether an outside core meets the frustum; inside, corners detect it.
    fn meets_core(&self, frame: &Frame, body: &PosedBody<'_>) -> bool {
        let (point, normal, _) = self.near.closest(&frame.way);
        let outside = (frame.way - point).dot(&normal) > 0.0;
        let farthest = |n: &Vec3| {
            let across = n - self.axis * n.dot(&self.axis);
            let unit = across.try_normalize(0.0).unwrap_or_default();
            let ends = [
                self.base + unit * self.radii[0],
                self.base + self.axis * self.height + unit * self.radii[1],
            ];
            if ends[0].dot(n) > ends[1].dot(n) { ends[0] } else { ends[1] }
        };
        let between = |n: &Vec3| {
            let own = frame.turn.inverse_transform_vector(n);
            frame.point(&body.core.farthest(&-own)) - farthest(n)
        };
        outside && separation(between, normal, 0.0).is_none()
    }

    fn at(&self, p: &Vec3) -> (f64, Vec3) {
        let (point, normal, _) = self.near.closest(p);
        let way = p - point;
        let d = way.norm();
        if d > 0.0 { (d, way / d) } else { (0.0, normal) }
    }
}

impl Target for Side {
    fn meets(&self, _: &Bounds) -> bool {
        true
    }

    fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)> {
        Some(self.at(p)).filter(|(d, _)| *d < reach)
    }

    fn stretches(&self, segment: &Segment, reach: f64, mut f: impl FnMut([f64; 2], &Nearest)) {
        let seen = Seen::new(segment, &self.base, &self.axis);
        let (h, run, length) = (self.height, self.radii[1] - self.radii[0], self.length);
        let mut places = Places::new();
        // Generator ends.
        for end in [0.0, length * length] {
            if run.abs() > 1e-12 * length {
                seen.at([self.radii[0] + (end - seen.z[0] * h) / run, -seen.z[1] * h / run], &mut places);
            } else {
                seen.at_height(end / h, &mut places);
            }
        }
        // Distance equals the reach, either side.
        for off in [reach, -reach] {
            if h > 1e-12 * length {
                let level = [self.radii[0] + (off * length + seen.z[0] * run) / h, seen.z[1] * run / h];
                seen.at(level, &mut places);
            } else {
                seen.at_height(-off * run.signum(), &mut places);
            }
        }
        let at = |s: f64| self.at(&(segment.from + segment.direction * s));
        between(segment.range, places, |[low, high]| {
            let middle = 0.5 * (low + high);
            match self.near.closest(&(segment.from + segment.direction * middle)).2 {
                Part::Inside if at(middle).0 < reach => curve([low, high], &at, &mut f),
                Part::Rim(_) | Part::Apex => lowest([low, high], reach, &at, &mut f),
                _ => {}
            }
        });
    }
}

/// Subrange of a unimodal distance below the reach.
fn lowest(
    range: [f64; 2],
    reach: f64,
    at: &dyn Fn(f64) -> (f64, Vec3),
    f: &mut impl FnMut([f64; 2], &Nearest),
) {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let d = |s: f64| at(s).0;
    let [mut low, mut high] = range;
    let (mut x, mut y) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
    let (mut dx, mut dy) = (d(x), d(y));
    for _ in 0..ROUNDS {
        if dx < dy {
            (high, y, dy) = (y, x, dx);
            x = high - GOLDEN * (high - low);
            dx = d(x);
        } else {
            (low, x, dx) = (x, y, dy);
            y = low + GOLDEN * (high - low);
            dy = d(y);
        }
    }
    let ends = [range[0], range[1], 0.5 * (low + high)];
    let least = ends.into_iter().min_by(|s, t| d(*s).total_cmp(&d(*t))).unwrap_or(low);
    if d(least) >= reach {
        return;
    }
    let border = |end: f64| {
        if d(end) < reach {
            return end;
        }
        let (mut inside, mut outside) = (least, end);
        for _ in 0..ROUNDS {
            let middle = 0.5 * (inside + outside);
            if d(middle) < reach { inside = middle } else { outside = middle }
        }
        inside
    };
    let stretch = [border(range[0]), border(range[1])];
    if stretch[0] < stretch[1] {
        curve(stretch, at, f);
    }
}

struct Circle {
    centre: Vec3,
    axis: Vec3,
    radius: f64,
}

impl Circle {
    fn at(&self, p: &Vec3) -> (f64, Vec3) {
        let way = p - self.centre;
        let across = way - self.axis * way.dot(&self.axis);
        let way = way - across.try_normalize(0.0).unwrap_or_else(|| helper(&self.axis)) * self.radius;
        let d = way.norm();
        if d > 0.0 { (d, way / d) } else { (0.0, self.axis) }
    }
}

impl Target for Circle {
    fn meets(&self, _: &Bounds) -> bool {
        true
    }

    fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)> {
        Some(self.at(p)).filter(|(d, _)| *d < reach)
    }

    fn stretches(&self, segment: &Segment, reach: f64, mut f: impl FnMut([f64; 2], &Nearest)) {
        let seen = Seen::new(segment, &self.centre, &self.axis);
        let mut places = Places::new();
        // Cuts of disc and cylinder; point nearest to the axis.
        seen.at([self.radius, 0.0], &mut places);
        seen.at_height(0.0, &mut places);
        let middle = -0.5 * seen.square[1] / seen.square[2];
        if middle.is_finite() {
            places.push(middle);
        }
        let at = |s: f64| self.at(&(segment.from + segment.direction * s));
        between(segment.range, places, |range| lowest(range, reach, &at, &mut f));
    }
}

struct Disc<'a> {
    centre: &'a Vec3,
    axis: &'a Vec3,
    radius: f64,
}

impl Disc<'_> {
    fn rim(&self) -> Circle {
        Circle { centre: *self.centre, axis: *self.axis, radius: self.radius }
    }
}

impl Target for Disc<'_> {
    fn meets(&self, _: &Bounds) -> bool {
        true
    }

    fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)> {
        let way = p - self.centre;
        let z = way.dot(self.axis);
        if (way - self.axis * z).norm() > self.radius {
            return self.rim().distance(p, reach);
        }
        (z.abs() < reach).then(|| (z.abs(), self.axis * z.signum()))
    }

    fn stretches(&self, segment: &Segment, reach: f64, mut f: impl FnMut([f64; 2], &Nearest)) {
        let seen = Seen::new(segment, self.centre, self.axis);
        let mut places = Places::new();
        seen.at([self.radius, 0.0], &mut places);
        seen.at_height(0.0, &mut places);
        let rim = self.rim();
        let at = |s: f64| rim.at(&(segment.from + segment.direction * s));
        between(segment.range, places, |[low, high]| {
            let middle = 0.5 * (low + high);
            let square = seen.square[0] + middle * (seen.square[1] + middle * seen.square[2]);
            if square > self.radius * self.radius {
                return lowest([low, high], reach, &at, &mut f);
            }
            let sign = (seen.z[0] + seen.z[1] * middle).signum();
            let mut stretch = Stretch([low, high]);
            stretch.cut(sign * seen.z[0] - reach, sign * seen.z[1]);
            if stretch.some() {
                let plane = Nearest::Plane {
                    normal: self.axis * sign,
                    at: sign * seen.z[0],
                    slope: sign * seen.z[1],
                };
                f(stretch.0, &plane);
            }
        });
    }
}

/// Inside of a sphere.
struct Bowl<'a> {
    centre: &'a Vec3,
    radius: f64,
}

impl Bowl<'_> {
    fn at(&self, p: &Vec3) -> (f64, Vec3) {
        let way = p - self.centre;
        let d = way.norm();
        (self.radius - d, if d > 0.0 { -way / d } else { Vec3::z() })
    }
}

impl Target for Bowl<'_> {
    fn meets(&self, _: &Bounds) -> bool {
        true
    }

    fn distance(&self, p: &Vec3, reach: f64) -> Option<(f64, Vec3)> {
        Some(self.at(p)).filter(|(d, _)| *d < reach)
    }

    fn stretches(&self, segment: &Segment, reach: f64, mut f: impl FnMut([f64; 2], &Nearest)) {
        let way = segment.from - self.centre;
        let least = self.radius - reach;
        let mut places = Places::new();
        let b = way.dot(&segment.direction);
        let root = b * b - way.norm_squared() + least * least;
        if root > 0.0 && least > 0.0 {
            places.push(-b - root.sqrt());
            places.push(-b + root.sqrt());
        }
        let at = |s: f64| self.at(&(segment.from + segment.direction * s));
        between(segment.range, places, |[low, high]| {
            if at(0.5 * (low + high)).0 < reach {
                curve([low, high], &at, &mut f);
            }
        });
    }
}
