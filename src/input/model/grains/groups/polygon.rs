//! Convex polygons in a plane: corners [m], counter-clockwise.

pub(super) type Point = [f64; 2];

/// Shortest side, relative to polygon size.
const SHORT: f64 = 1e-3;
/// Smallest corner distance from the line through its neighbours, relative to polygon size.
const LEVEL: f64 = 1e-4;

/// Part with `normal` · x ≤ `level` [m].
pub(super) fn clipped(corners: &[Point], normal: Point, level: f64) -> Vec<Point> {
    let beyond = |p: &Point| normal[0] * p[0] + normal[1] * p[1] - level;
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for [p, q] in sides(corners) {
        let [at, next] = [beyond(&p), beyond(&q)];
        if at <= 0.0 {
            kept.push(p);
        }
        if (at < 0.0 && next > 0.0) || (at > 0.0 && next < 0.0) {
            let t = at / (at - next);
            kept.push([p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])]);
        }
    }
    kept
}

pub(super) fn sides(corners: &[Point]) -> impl Iterator<Item = [Point; 2]> + '_ {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(p, q)| [*p, *q])
}

pub(super) fn area(corners: &[Point]) -> (f64, Point) {
    let Some(&[x, y]) = corners.first() else { return (0.0, [0.0; 2]) };
    let (mut double, mut moment) = (0.0, [0.0; 2]);
    // Relative to a corner: distant polygons keep their accuracy.
    for [p, q] in sides(corners).map(|ends| ends.map(|p| [p[0] - x, p[1] - y])) {
        let cross = p[0] * q[1] - p[1] * q[0];
        double += cross;
        (0..2).for_each(|d| moment[d] += cross * (p[d] + q[d]));
    }
    (0.5 * double, [x + moment[0] / (3.0 * double), y + moment[1] / (3.0 * double)])
}

pub(super) fn scaled(corners: &[Point], factor: f64, middle: Point) -> Vec<Point> {
    let scale = |p: &Point| [0, 1].map(|d| middle[d] + factor * (p[d] - middle[d]));
    corners.iter().map(scale).collect()
}

pub(super) fn inset(corners: &[Point], distance: f64) -> Vec<Point> {
    let mut left = corners.to_vec();
    for [p, q] in sides(corners) {
        let (x, y) = (q[0] - p[0], q[1] - p[1]);
        let length = libm::hypot(x, y);
        if length > 0.0 {
            let normal = [y / length, -x / length];
            left = clipped(&left, normal, normal[0] * p[0] + normal[1] * p[1] - distance);
        }
    }
    if left.len() < 3 { Vec::new() } else { left }
}

/// Replaces short sides by midpoints and removes nearly collinear corners.
pub(super) fn simplified(corners: &[Point]) -> Vec<Point> {
    let mut left = corners.to_vec();
    let size = area(corners).0.max(0.0).sqrt();
    while left.len() > 3 {
        let n = left.len();
        let at = |k: usize| left[k % n];
        if let Some(k) = (0..n).find(|&k| distance(at(k), at(k + 1)) < SHORT * size) {
            let [p, q] = [at(k), at(k + 1)];
            left[k] = [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
            left.remove((k + 1) % n);
        } else if let Some(k) = (0..n).find(|&k| to_segment(at(k + 1), [at(k), at(k + 2)]) < LEVEL * size) {
            left.remove((k + 1) % n);
        } else {
            break;
        }
    }
    left
}

pub(super) fn distance_from(point: Point, corners: &[Point]) -> f64 {
    let inside =
        |[p, q]: [Point; 2]| (q[0] - p[0]) * (point[1] - p[1]) - (q[1] - p[1]) * (point[0] - p[0]) >= 0.0;
    if sides(corners).all(inside) {
        return 0.0;
    }
    sides(corners).map(|side| to_segment(point, side)).fold(f64::INFINITY, f64::min)
}

fn distance(p: Point, q: Point) -> f64 {
    libm::hypot(q[0] - p[0], q[1] - p[1])
}

fn to_segment(point: Point, [p, q]: [Point; 2]) -> f64 {
    let way = [q[0] - p[0], q[1] - p[1]];
    let along = way[0] * (point[0] - p[0]) + way[1] * (point[1] - p[1]);
    let t = (along / (way[0] * way[0] + way[1] * way[1]).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    distance(point, [p[0] + t * way[0], p[1] + t * way[1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Point; 4] = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0]];

    #[test]
    fn clips_and_insets_square() {
        let half = clipped(&SQUARE, [1.0, 0.0], 2.0);
        assert_eq!((half.len(), area(&half)), (4, (2.0, [1.5, 2.0])));
        // A line through two corners duplicates no corner.
        assert_eq!(clipped(&SQUARE, [1.0, 1.0], 4.0).len(), 3);
        assert_eq!(clipped(&SQUARE, [1.0, 0.0], 0.5), Vec::<Point>::new());
        let within = inset(&SQUARE, 0.25);
        assert!((area(&within).0 - 2.25).abs() < 1e-14, "{within:?}");
        assert!(inset(&SQUARE, 1.01).is_empty());
        assert!((area(&scaled(&SQUARE, 0.5, [2.0, 2.0])).0 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_side_moved_in_may_vanish() {
        let cut = [[0.1, 0.0], [4.0, 0.0], [0.0, 3.0], [0.0, 0.1]];
        let within = inset(&cut, 0.5);
        assert_eq!(within.len(), 3);
        // Inscribed radius 1: moved in by half, half the size.
        assert!((area(&within).0 - 1.5).abs() < 1e-12, "{within:?}");
    }

    #[test]
    fn short_sides_and_flat_corners_go() {
        let rough = [[0.0, 0.0], [0.5, -1e-5], [1.0, 0.0], [1.0, 1.0], [1.0 - 1e-4, 1.0 + 1e-4], [0.0, 1.0]];
        let plain = simplified(&rough);
        assert_eq!(plain.len(), 4, "{plain:?}");
        assert!((area(&plain).0 - area(&rough).0).abs() < 1e-4);
        assert_eq!(simplified(&SQUARE), SQUARE);
    }

    #[test]
    fn distances_from_a_square() {
        for (point, expected) in [([2.0, 2.0], 0.0), ([4.0, 2.0], 1.0), ([6.0, 7.0], 5.0), ([1.0, 3.0], 0.0)]
        {
            assert!((distance_from(point, &SQUARE) - expected).abs() < 1e-15, "{point:?}");
        }
    }
}
