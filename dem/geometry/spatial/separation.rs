//! Separating direction of two convex hulls (Gilbert, Johnson & Keerthi, IEEE J. Robotics and Automation 4,
//! 1988).

use crate::base::Vec3;

/// Two to eight iterations are typical.
const ROUNDS: usize = 32;

/// Relative distance tolerance.
const SLACK: f64 = 1e-4;

/// Unit vector and lower bound of the distance along it [m]; `None` if the hulls overlap. `between`: vector
/// between opposite support points; stops once the distance is `enough`.
pub fn separation(between: impl Fn(&Vec3) -> Vec3, guess: Vec3, enough: f64) -> Option<(Vec3, f64)> {
    let mut v = between(&guess);
    let mut simplex = Simplex::of(v);
    let mut best = Some((guess, v.dot(&guess))).filter(|(_, apart)| *apart > 0.0);
    for _ in 0..ROUNDS {
        let length = v.norm();
        if length <= f64::MIN_POSITIVE || best.is_some_and(|(_, apart)| apart >= enough) {
            break;
        }
        let n = v / length;
        let w = between(&n);
        let apart = w.dot(&n);
        if apart > best.map_or(0.0, |(_, best)| best) {
            best = Some((n, apart));
        }
        if length - apart <= SLACK * length || simplex.points().contains(&w) {
            break;
        }
        simplex.push(w);
        let Some(closest) = simplex.closest() else { break };
        // Rounding: no progress.
        if closest.norm_squared() >= v.norm_squared() {
            break;
        }
        v = closest;
    }
    best
}

struct Simplex {
    points: [Vec3; 4],
    count: usize,
}

impl Simplex {
    fn of(p: Vec3) -> Simplex {
        Simplex { points: [p; 4], count: 1 }
    }

    fn points(&self) -> &[Vec3] {
        &self.points[..self.count]
    }

    fn push(&mut self, p: Vec3) {
        self.points[self.count] = p;
        self.count += 1;
    }

    fn keep(&mut self, points: &[Vec3]) {
        self.points[..points.len()].copy_from_slice(points);
        self.count = points.len();
    }

    /// Point closest to the origin; reduces the simplex. `None` with the origin inside.
    fn closest(&mut self) -> Option<Vec3> {
        let p = self.points;
        let (point, keep) = match self.count {
            1 => (p[0], Simplex::of(p[0])),
            2 => segment(p[0], p[1]),
            3 => triangle([p[0], p[1], p[2]]),
            _ => tetrahedron(p)?,
        };
        self.keep(keep.points());
        Some(point)
    }
}

fn segment(a: Vec3, b: Vec3) -> (Vec3, Simplex) {
    let way = b - a;
    let t = -a.dot(&way);
    let whole = way.norm_squared();
    if t <= 0.0 || whole == 0.0 {
        return (a, Simplex::of(a));
    }
    if t >= whole {
        return (b, Simplex::of(b));
    }
    let mut both = Simplex::of(a);
    both.push(b);
    (a + way * (t / whole), both)
}

fn triangle([a, b, c]: [Vec3; 3]) -> (Vec3, Simplex) {
    let normal = (b - a).cross(&(c - a));
    let square = normal.norm_squared();
    let inside = |p: &Vec3, q: &Vec3| (q - p).cross(&normal).dot(p) >= 0.0;
    if square > 0.0 && inside(&a, &b) && inside(&b, &c) && inside(&c, &a) {
        let mut all = Simplex::of(a);
        all.push(b);
        all.push(c);
        return (normal * (a.dot(&normal) / square), all);
    }
    let sides = [segment(a, b), segment(b, c), segment(c, a)];
    let [x, y, z] = sides;
    let nearer =
        |x: (Vec3, Simplex), y: (Vec3, Simplex)| if y.0.norm_squared() < x.0.norm_squared() { y } else { x };
    nearer(nearer(x, y), z)
}

fn tetrahedron(p: [Vec3; 4]) -> Option<(Vec3, Simplex)> {
    let mut best: Option<(Vec3, Simplex)> = None;
    for (i, j, k, l) in [(0, 1, 2, 3), (0, 3, 1, 2), (0, 2, 3, 1), (1, 3, 2, 0)] {
        let normal = (p[j] - p[i]).cross(&(p[k] - p[i]));
        let (own, origin) = (normal.dot(&(p[l] - p[i])), -normal.dot(&p[i]));
        if own * origin <= 0.0 {
            let found = triangle([p[i], p[j], p[k]]);
            if best.as_ref().is_none_or(|(b, _)| found.0.norm_squared() < b.norm_squared()) {
                best = Some(found);
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::Random;

    /// Support points.
    fn least(points: &[Vec3], n: &Vec3) -> Vec3 {
        let lower = |p: Vec3, q: &Vec3| if q.dot(n) < p.dot(n) { *q } else { p };
        points[1..].iter().fold(points[0], lower)
    }

    fn most(points: &[Vec3], n: &Vec3) -> Vec3 {
        least(points, &-n)
    }

    fn found_apart(a: &[Vec3], b: &[Vec3]) -> Option<(Vec3, f64)> {
        let guess = Vec3::new(-0.6, 0.0, 0.8);
        let found = separation(|n| least(a, n) - most(b, n), guess, f64::INFINITY);
        // Early stop gives a lower bound.
        if let Some((_, whole)) = found {
            let (n, some) = separation(|n| least(a, n) - most(b, n), guess, 0.5 * whole).unwrap();
            assert!(some >= 0.5 * whole && some <= whole * (1.0 + 2.0 * SLACK), "{some} {whole}");
            assert_eq!((least(a, &n) - most(b, &n)).dot(&n), some);
        }
        found
    }

    #[test]
    fn cubes_at_known_distances() {
        let side = |k: usize, d: usize| if k >> d & 1 == 1 { 0.5 } else { -0.5 };
        let cube =
            |at: Vec3| -> Vec<Vec3> { (0..8).map(|k| at + Vec3::from_fn(|d, _| side(k, d))).collect() };
        let origin = cube(Vec3::zeros());
        let (n, apart) = found_apart(&cube(Vec3::new(1.3, 0.2, -0.4)), &origin).unwrap();
        assert!((apart - 0.3).abs() < 1e-4 * 0.3 && (n - Vec3::x()).norm() < 1e-2, "{apart} {n}");
        let (n, apart) = found_apart(&cube(Vec3::repeat(1.1)), &origin).unwrap();
        let exact = 0.1 * 3.0_f64.sqrt();
        assert!(
            (apart - exact).abs() < 1e-4 * exact && (n - Vec3::repeat(1.0).normalize()).norm() < 2e-2,
            "{apart}"
        );
        assert!(found_apart(&cube(Vec3::new(0.9, 0.2, 0.1)), &origin).is_none());
    }

    #[test]
    fn bounds_of_random_tetrahedra() {
        let mut rng = Random::new(5, 1);
        let mut vector = || Vec3::new(rng.uniform() - 0.5, rng.uniform() - 0.5, rng.uniform() - 0.5);
        let mut apart = 0;
        for _ in 0..2000 {
            let way = vector() * 3.0;
            let a: Vec<Vec3> = (0..4).map(|_| vector() + way).collect();
            let b: Vec<Vec3> = (0..4).map(|_| vector()).collect();
            let Some((n, bound)) = found_apart(&a, &b) else { continue };
            apart += 1;
            assert!((n.norm() - 1.0).abs() < 1e-12);
            let gap = a.iter().map(|p| p.dot(&n)).fold(f64::INFINITY, f64::min)
                - b.iter().map(|p| p.dot(&n)).fold(f64::NEG_INFINITY, f64::max);
            assert!((gap - bound).abs() < 1e-12, "{gap} {bound}");
            // Slow but robust descent.
            let (mut p, mut q) = (a.iter().sum::<Vec3>() / 4.0, b.iter().sum::<Vec3>() / 4.0);
            for _ in 0..3000 {
                let v = p - q;
                let (s, t) = (least(&a, &v), most(&b, &v));
                let d = (s - t) - v;
                if d.norm_squared() == 0.0 {
                    break;
                }
                let x = (-v.dot(&d) / d.norm_squared()).clamp(0.0, 1.0);
                (p, q) = (p + (s - p) * x, q + (t - q) * x);
            }
            let distance = (p - q).norm();
            assert!(bound <= distance * (1.0 + 1e-12), "{bound} {distance}");
            assert!(distance < 0.3 || bound > distance * 0.99, "{bound} {distance}");
        }
        assert!(apart > 1000, "{apart}");
    }
}
