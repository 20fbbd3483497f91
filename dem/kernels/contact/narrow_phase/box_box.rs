//! Box–box contacts: axis of least overlap among face normals and edge cross products, then polygon clipped
//! on a face, or closest edge points.
//!
//! Axes: Gottschalk, Lin & Manocha (SIGGRAPH 1996); clipping: Sutherland & Hodgman. Polygon corners below the
//! face are weighted by adjacent side lengths; the weights sum to four, so the force is continuous when
//! corners split.
//!
//! Limits: the force may jump between face and edge contact; tangential springs restart with new features.

use super::pair::{Manifold, PairContactPoint, ShapePair};
use super::scene::PosedBody;
use super::side::Solids;
use crate::base::Vec3;
use crate::law::ContactGeometry;
use nalgebra::Matrix3;

pub struct BoxBox;

/// Largest edge over face overlap for an edge axis: flat faces stay face contacts.
const EDGE: f64 = 0.98;

/// Likewise for the second box's faces.
const SECOND: f64 = 0.98;

/// Largest sine of parallel edges.
const PARALLEL: f64 = 1e-6;

const ON_EDGE: u32 = 0x4000;
const REFERENCE: u32 = 0x8000;

/// Two boxes in the first's frame.
struct Two {
    half: [Vec3; 2],
    turn: Matrix3<f64>,
    /// First centre to second centre.
    way: Vec3,
}

/// Separating axis.
enum Axis {
    Face { of: usize, axis: usize },
    Edges { first: usize, second: usize, normal: Vec3 },
}

impl Two {
    fn new(a: &PosedBody<'_>, b: &PosedBody<'_>) -> Option<Two> {
        let turn = (a.orientation.inverse() * b.orientation).to_rotation_matrix().into_inner();
        let way = a.orientation.inverse_transform_vector(&(b.centre - a.centre));
        Some(Two { half: [a.half()?, b.half()?], turn, way })
    }

    /// Axis of largest separation, negative for overlap [m].
    fn separation(&self) -> (Axis, f64) {
        let Two { half: [a, b], turn, way } = self;
        let reach = turn.abs();
        let on_first = way.abs() - a - reach * b;
        let on_second = turn.tr_mul(way).abs() - b - reach.tr_mul(a);
        let (i, j) = (on_first.imax(), on_second.imax());
        let mut best = (Axis::Face { of: 0, axis: i }, on_first[i]);
        if on_second[j] > best.1.max(SECOND * best.1) {
            best = (Axis::Face { of: 1, axis: j }, on_second[j]);
        }
        for first in 0..3 {
            for second in 0..3 {
                let cross = Vec3::ith(first, 1.0).cross(&turn.column(second));
                let sine = cross.norm();
                if sine < PARALLEL {
                    continue;
                }
                let normal = cross / sine;
                let apart =
                    way.dot(&normal).abs() - a.dot(&normal.abs()) - b.dot(&turn.tr_mul(&normal).abs());
                if apart > best.1.max(EDGE * best.1) {
                    let normal = if way.dot(&normal) > 0.0 { -normal } else { normal };
                    best = (Axis::Edges { first, second, normal }, apart);
                }
            }
        }
        best
    }
}

impl ShapePair for BoxBox {
    type First = Solids;
    type Second = Solids;

    fn may_touch(&self, first: &PosedBody<'_>, second: &PosedBody<'_>, reach: f64) -> bool {
        Two::new(first, second).is_some_and(|two| two.separation().1 < reach)
    }

    fn contact_points(&self, first: &PosedBody<'_>, second: &PosedBody<'_>, found: &mut Manifold) {
        let Some(two) = Two::new(first, second) else { return };
        let (axis, apart) = two.separation();
        if apart >= 0.0 {
            return;
        }
        match axis {
            Axis::Edges { first, second, normal } => edges(&two, (first, second), &normal, -apart, found),
            Axis::Face { of: 0, axis } => face(&two.half, &two.turn, &two.way, axis, found),
            Axis::Face { axis, .. } => {
                let [a, b] = two.half;
                let way = -two.turn.tr_mul(&two.way);
                face(&[b, a], &two.turn.transpose(), &way, axis, found);
                for t in found.iter_mut() {
                    t.feature = t.feature.rotate_left(16);
                    t.geometry.point = two.way + two.turn * t.geometry.point;
                    t.geometry.normal = -(two.turn * t.geometry.normal);
                }
            }
        }
        let size = two.half[0].min().min(two.half[1].min());
        for t in found.iter_mut() {
            t.geometry.point = first.centre + first.orientation * t.geometry.point;
            t.geometry.normal = first.orientation * t.geometry.normal;
            t.geometry.radius = size;
            t.bound = size;
        }
    }
}

/// Closest points of edges facing along `normal`, towards the first box.
fn edges(two: &Two, (i, j): (usize, usize), normal: &Vec3, overlap: f64, found: &mut Manifold) {
    let Two { half: [a, b], turn, way } = two;
    let local = turn.tr_mul(normal);
    let mut p = -a.zip_map(normal, |h, n| h.copysign(n));
    let mut q = b.zip_map(&local, |h, n| h.copysign(n));
    (p[i], q[j]) = (0.0, 0.0);
    let signs = |v: &Vec3, skip: usize| {
        (0..3).filter(|d| *d != skip).enumerate().map(|(n, d)| u32::from(v[d] > 0.0) << n).sum::<u32>()
    };
    let feature = |axis: usize, v: &Vec3| ON_EDGE | (axis as u32) << 2 | signs(v, axis);
    let features = feature(i, &p) << 16 | feature(j, &q);
    let (u, v, q) = (Vec3::ith(i, 1.0), turn.column(j).into_owned(), way + turn * q);
    // Minimises |p + s u − q − t v|.
    let (w, cosine) = (q - p, u.dot(&v));
    let s = (w.dot(&u) - cosine * w.dot(&v)) / (1.0 - cosine * cosine);
    let s = s.clamp(-a[i], a[i]);
    let t = (v.dot(&(p + u * s - q))).clamp(-b[j], b[j]);
    let point = (p + u * s + q + v * t) * 0.5;
    let geometry = ContactGeometry { point, normal: *normal, overlap, radius: 0.0 };
    found.push(PairContactPoint::of(features, geometry, 1.0, 0.0));
}

/// Polygon corner, height over the face, starting edge.
#[derive(Clone, Copy, Debug)]
struct Corner {
    at: [f64; 2],
    height: f64,
    edge: u32,
}

/// Second box over face ± `axis` of the first.
fn face(half: &[Vec3; 2], turn: &Matrix3<f64>, way: &Vec3, axis: usize, found: &mut Manifold) {
    let [a, b] = half;
    let side = 1.0_f64.copysign(way[axis]);
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    let facing: Vec3 = turn.row(axis).transpose() * side;
    let other = facing.iamax();
    let sign = -1.0_f64.copysign(facing[other]);
    let (u, v) = ((other + 1) % 3, (other + 2) % 3);
    let mut polygon: Vec<Corner> = Vec::with_capacity(8);
    for (edge, (su, sv)) in [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].into_iter().enumerate() {
        let mut local = Vec3::zeros();
        (local[other], local[u], local[v]) = (sign * b[other], su * b[u], sv * b[v]);
        let p = way + turn * local;
        polygon.push(Corner { at: [p[x], p[y]], height: side * p[axis] - a[axis], edge: edge as u32 });
    }
    for (edge, (d, limit)) in [(0, a[x]), (1, a[y])].into_iter().enumerate() {
        clip(&mut polygon, d, 1.0, limit, 4 + 2 * edge as u32);
        clip(&mut polygon, d, -1.0, limit, 5 + 2 * edge as u32);
    }
    let number = |axis: usize, sign: f64| 2 * axis as u32 + u32::from(sign > 0.0);
    let reference = REFERENCE | number(axis, side) << 6;
    let count = polygon.len();
    let length = |k: usize| {
        let (p, q) = (&polygon[k % count], &polygon[(k + 1) % count]);
        libm::hypot(p.at[0] - q.at[0], p.at[1] - q.at[1])
    };
    let around: f64 = (0..count).map(length).sum();
    for (k, corner) in polygon.iter().enumerate().filter(|(_, c)| c.height < 0.0) {
        let before = (k + count - 1) % count;
        let weight =
            if around > 0.0 { 2.0 * (length(k) + length(before)) / around } else { 4.0 / count as f64 };
        let mut point = Vec3::zeros();
        (point[x], point[y]) = (corner.at[0], corner.at[1]);
        point[axis] = side * (a[axis] + 0.5 * corner.height);
        let (one, two) = (corner.edge.min(polygon[before].edge), corner.edge.max(polygon[before].edge));
        let feature = reference << 16 | number(other, sign) << 6 | one << 3 | two;
        let normal = Vec3::ith(axis, -side);
        let geometry = ContactGeometry { point, normal, overlap: -corner.height, radius: 0.0 };
        found.push(PairContactPoint::of(feature, geometry, weight, 0.0));
    }
}

/// Clips to `sign` × coordinate `d` ≤ `limit`; new sides are `edge`.
fn clip(polygon: &mut Vec<Corner>, d: usize, sign: f64, limit: f64, edge: u32) {
    let old = std::mem::take(polygon);
    let beyond = |c: &Corner| sign * c.at[d] - limit;
    for (k, p) in old.iter().enumerate() {
        let q = &old[(k + 1) % old.len()];
        let (out_p, out_q) = (beyond(p), beyond(q));
        if out_p <= 0.0 {
            polygon.push(*p);
        }
        if (out_p <= 0.0) != (out_q <= 0.0) {
            let t = out_p / (out_p - out_q);
            let mix = |a: f64, b: f64| a + t * (b - a);
            let mut at = [mix(p.at[0], q.at[0]), mix(p.at[1], q.at[1])];
            at[d] = sign * limit;
            let begins = if out_p <= 0.0 { edge } else { p.edge };
            polygon.push(Corner { at, height: mix(p.height, q.height), edge: begins });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Shape;
    use crate::shape::dilated::Core;
    use nalgebra::UnitQuaternion;
    use rand_core::Rng;
    use rand_pcg::Pcg64Mcg;

    #[test]
    fn random_pairs_from_both_sides() {
        let mut rng = Pcg64Mcg::new(11);
        let mut unit = || (rng.next_u64() >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        let mut vector = |size: f64| Vec3::new(unit(), unit(), unit()) * size;
        let none = Core::default();
        let shapes = [Shape::Box { half: [0.3, 0.5, 0.2] }, Shape::Box { half: [0.4, 0.1, 0.6] }];
        let (mut overlapping, mut several) = (0, 0);
        for _ in 0..2000 {
            let [a, mut b] = [0, 1].map(|k| PosedBody {
                centre: vector(1.2),
                orientation: UnitQuaternion::from_scaled_axis(vector(6.0)),
                shape: &shapes[k],
                scale: 1.0 + k as f64,
                core: &none,
                radius: 0.0,
            });
            let (mut one, mut two) = (Manifold::new(), Manifold::new());
            BoxBox.contact_points(&a, &b, &mut one);
            BoxBox.contact_points(&b, &a, &mut two);
            assert_eq!(one.is_empty(), two.is_empty());
            let separation = Two::new(&a, &b).unwrap().separation().1;
            assert_eq!(one.is_empty(), separation >= 0.0);
            let Some(touch) = one.iter().max_by(|s, t| s.geometry.overlap.total_cmp(&t.geometry.overlap))
            else {
                continue;
            };
            overlapping += 1;
            several += usize::from(one.len() > 2);
            let other = Two::new(&b, &a).unwrap().separation().1;
            assert!((separation - other).abs() < 0.12 * separation.abs(), "{separation} {other}");
            if separation == other && one.len() == two.len() {
                for s in &one {
                    let same = |t: &&PairContactPoint| t.feature == s.feature.rotate_left(16);
                    let t = two.iter().find(same).expect("the same features");
                    assert!((s.geometry.point - t.geometry.point).norm() < 1e-12);
                    assert!((s.geometry.normal + t.geometry.normal).norm() < 1e-12);
                }
            }
            for s in &one {
                for body in [&a, &b] {
                    let local = body.orientation.inverse_transform_vector(&(s.geometry.point - body.centre));
                    let outside = (local.abs() - body.half().unwrap()).max();
                    assert!(outside < 0.5 * s.geometry.overlap + 1e-12, "{outside} {}", s.geometry.overlap);
                }
            }
            b.centre -= touch.geometry.normal * (1.0 + 1e-9) * -separation.min(-touch.geometry.overlap);
            let mut apart = Manifold::new();
            BoxBox.contact_points(&a, &b, &mut apart);
            assert!(apart.is_empty(), "{separation}");
        }
        assert!(overlapping > 500 && several > 100, "{overlapping} {several}");
    }

    #[test]
    fn weights_of_a_face_add_up() {
        let none = Core::default();
        let shapes = [Shape::Box { half: [0.3, 0.5, 0.2] }, Shape::Box { half: [0.4, 0.3, 0.1] }];
        for (turn, aside, least) in [(0.0, 0.0, 4), (0.7, 0.0, 6), (0.0, 0.5, 4), (0.3, 0.45, 3)] {
            let placed = |k: usize, centre: Vec3, turn: f64| PosedBody {
                centre,
                orientation: UnitQuaternion::from_axis_angle(&Vec3::z_axis(), turn),
                shape: &shapes[k],
                scale: 1.0,
                core: &none,
                radius: 0.0,
            };
            let mut found = Manifold::new();
            let above = Vec3::new(aside, 0.1 * aside, 0.2999);
            BoxBox.contact_points(&placed(0, Vec3::zeros(), 0.0), &placed(1, above, turn), &mut found);
            let sum: f64 = found.iter().map(|t| t.weight).sum();
            assert!((sum - 4.0).abs() < 1e-12, "{turn} {aside}: {sum}");
            assert!((least..=8).contains(&found.len()), "{turn} {aside}: {}", found.len());
        }
    }
}
