//! Rigid clumps: fills a body with overlapping spheres that minimise E, the distance error Φ of the theory
//! manual.
//!
//! 1. Greedy selection: of spheres at lattice points, the one that lowers E most is added repeatedly.
//! 2. Descent: with each sample point assigned to its nearest sphere, E splits into least squares problems of
//!    four unknowns. Damped Gauss–Newton steps (Levenberg–Marquardt) are accepted if E falls and the union
//!    stays connected.
//! 3. Exchange: the sphere that contributes least is reselected and refitted.
//!
//! Source: own, after the variational sphere sets of R. Wang et al., The Visual Computer 22, 2006
//! (alternating assignment and fit), with distance instead of volume as measure.
//! Limits: step 1 misses features smaller than the lattice (a 26th of the longest side).
//!
//! Theory manual: equation (2.3) of `docs/theory/shapes.md`.

use nalgebra::{Matrix4, Vector3, Vector4};
use trackbed_dem::distance::SurfaceDistance;
use trackbed_dem::shape::polyhedron::Polyhedron;

/// Centre and radius.
pub type Ball = ([f64; 3], f64);

/// Options of the filling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Number of spheres, ≥ 1.
    pub spheres: usize,
    /// Protrusion over the largest inscribed radius, ≥ 0.
    pub overhang: f64,
}

/// Lattice cells along the longest side.
const CELLS: f64 = 26.0;
/// Least number of inner lattice points, and largest number of cells along the longest side to reach it.
const FEW: usize = 300;
const FINEST: f64 = 120.0;
/// Surface points, at least and per sphere; at most as many inside.
const POINTS: [usize; 2] = [1200, 40];
/// Approximate number of points that rate a candidate.
const GREEDY_POINTS: usize = 2400;
const CANDIDATES: usize = 1400;
const DESCENTS: usize = 60;
const EXCHANGES: usize = 12;
/// Least radius over the largest inscribed radius.
const LEAST: f64 = 0.05;

/// Fills a body with its `distance`; `None` if no lattice point lies inside.
pub fn fill(body: &Polyhedron, distance: &SurfaceDistance, options: &Options) -> Option<Vec<Ball>> {
    let problem = Problem::new(body, distance, options);
    if problem.candidates.is_empty() {
        return None;
    }
    let mut balls: Vec<Ball> = Vec::new();
    for _ in 0..options.spheres {
        let next = problem.best_candidate(&balls);
        balls.push(next);
    }
    let mut error = problem.descend(&mut balls);
    for _ in 0..EXCHANGES.min(2 * (options.spheres - 1)) {
        let mut changed = balls.clone();
        changed.remove(problem.least_missed(&balls));
        if changed.is_empty() || !in_one_piece(&changed) {
            break;
        }
        changed.push(problem.best_candidate(&changed));
        let lower = problem.descend(&mut changed);
        if lower >= error * (1.0 - 1e-4) {
            break;
        }
        (balls, error) = (changed, lower);
    }
    Some(balls)
}

struct Problem<'a> {
    distance: &'a SurfaceDistance,
    points: Vec<Vector3<f64>>,
    on_surface: usize,
    weights: [f64; 2],
    candidates: Vec<Ball>,
    /// Overhang and least radius [m].
    overhang: f64,
    least: f64,
}

impl<'a> Problem<'a> {
    fn new(body: &Polyhedron, distance: &'a SurfaceDistance, options: &Options) -> Problem<'a> {
        let [lo, hi] = body.surface().bounds();
        let longest = (0..3).map(|k| hi[k] - lo[k]).fold(0.0, f64::max);
        let shortest = (0..3).map(|k| hi[k] - lo[k]).fold(f64::INFINITY, f64::min);
        // Flat and thin-walled bodies need a finer lattice for points near their middle.
        let mut h = (longest / CELLS).min(shortest / 6.0);
        let mut inside = lattice(distance, [lo, hi], h);
        while inside.len() < FEW && h > longest / FINEST {
            h *= 0.6;
            inside = lattice(distance, [lo, hi], h);
        }
        let largest = inside.iter().map(|b| b.1).fold(0.0, f64::max);
        let overhang = options.overhang * largest;
        let points = POINTS[0].max(POINTS[1] * options.spheres);
        let least = LEAST * largest;
        let wide: Vec<&Ball> = inside.iter().filter(|b| b.1 > least).collect();
        // With many spheres, late ones only fit without overhang.
        let sizes = if overhang > 0.0 { &[0.0, 0.5, 1.0][..] } else { &[0.0] };
        let candidates = thinned(wide.len(), CANDIDATES)
            .flat_map(|i| sizes.iter().map(move |s| (i, s * overhang)))
            .map(|(i, out)| (wide[i].0, wide[i].1 + out))
            .collect();
        let surface = body.surface_points(points);
        let filling: Vec<[f64; 3]> = thinned(inside.len(), points).map(|i| inside[i].0).collect();
        let weights = [1.0 / surface.len() as f64, 1.0 / filling.len().max(1) as f64];
        Problem {
            distance,
            on_surface: surface.len(),
            points: surface.into_iter().chain(filling).map(Vector3::from).collect(),
            weights,
            candidates,
            overhang,
            least,
        }
    }

    fn weight(&self, point: usize) -> f64 {
        self.weights[usize::from(point >= self.on_surface)]
    }

    /// Inside, only uncovered points count.
    fn residual(&self, point: usize, d: f64) -> f64 {
        if point >= self.on_surface { d.max(0.0) } else { d }
    }

    fn distances(&self, balls: &[Ball]) -> Vec<(f64, usize)> {
        let nearest = |p: &Vector3<f64>| {
            let mut best = (f64::INFINITY, 0);
            for (j, (c, r)) in balls.iter().enumerate() {
                let d = (p - Vector3::from(*c)).norm() - r;
                if d < best.0 {
                    best = (d, j);
                }
            }
            best
        };
        self.points.iter().map(nearest).collect()
    }

    fn error(&self, distances: &[(f64, usize)]) -> f64 {
        distances.iter().enumerate().map(|(i, (d, _))| self.weight(i) * self.residual(i, *d).powi(2)).sum()
    }

    /// Connected candidate that lowers E most.
    fn best_candidate(&self, balls: &[Ball]) -> Ball {
        let present: Vec<f64> = self.distances(balls).iter().map(|d| d.0).collect();
        // A subset of the points suffices.
        let stride = (self.points.len() / GREEDY_POINTS).max(1);
        let mut best = (f64::INFINITY, self.candidates[0]);
        for &(c, r) in &self.candidates {
            let centre = Vector3::from(c);
            if !balls.is_empty() && !balls.iter().any(|b| joined(b, &(c, r))) {
                continue;
            }
            let mut error = 0.0;
            for (i, (p, present)) in self.points.iter().zip(&present).enumerate().step_by(stride) {
                let d = ((p - centre).norm() - r).min(*present);
                error += self.weight(i) * self.residual(i, d).powi(2);
            }
            if error < best.0 {
                best = (error, (c, r));
            }
        }
        best.1
    }

    /// Sphere whose removal raises E least.
    fn least_missed(&self, balls: &[Ball]) -> usize {
        // The two nearest spheres of each point give all removals.
        let mut growth = vec![0.0; balls.len()];
        for (i, p) in self.points.iter().enumerate() {
            let (mut first, mut second) = ((f64::INFINITY, 0), f64::INFINITY);
            for (j, (c, r)) in balls.iter().enumerate() {
                let d = (p - Vector3::from(*c)).norm() - r;
                if d < first.0 {
                    second = first.0;
                    first = (d, j);
                } else if d < second {
                    second = d;
                }
            }
            let (with, without) = (self.residual(i, first.0), self.residual(i, second));
            growth[first.1] += self.weight(i) * (without * without - with * with);
        }
        (0..balls.len()).min_by(|a, b| growth[*a].total_cmp(&growth[*b])).unwrap_or(0)
    }

    /// Fits the spheres until E stops falling; returns E.
    fn descend(&self, balls: &mut Vec<Ball>) -> f64 {
        let mut distances = self.distances(balls);
        let mut error = self.error(&distances);
        let mut damping = 1e-2;
        for _ in 0..DESCENTS {
            let trial = self.stepped(balls, &distances, damping);
            let trial_distances = self.distances(&trial);
            let lower = self.error(&trial_distances);
            if lower < error && in_one_piece(&trial) {
                let gain = error - lower;
                (*balls, distances, error) = (trial, trial_distances, lower);
                damping = f64::max(damping / 3.0, 1e-6);
                if gain < 1e-5 * error {
                    break;
                }
            } else {
                damping *= 4.0;
                if damping > 1e6 {
                    break;
                }
            }
        }
        error
    }

    fn stepped(&self, balls: &[Ball], distances: &[(f64, usize)], damping: f64) -> Vec<Ball> {
        let mut normal = vec![(Matrix4::<f64>::zeros(), Vector4::<f64>::zeros()); balls.len()];
        for (i, &(d, j)) in distances.iter().enumerate() {
            let residual = self.residual(i, d);
            if i >= self.on_surface && residual == 0.0 {
                continue;
            }
            let away = self.points[i] - Vector3::from(balls[j].0);
            let u = away.try_normalize(0.0).unwrap_or_default();
            let g = Vector4::new(-u.x, -u.y, -u.z, -1.0);
            let w = self.weight(i);
            normal[j].0 += g * g.transpose() * w;
            normal[j].1 += g * (w * residual);
        }
        balls
            .iter()
            .zip(&normal)
            .map(|(ball, (a, b))| {
                let shift = a.diagonal() * damping + Vector4::repeat(1e-9 * a.trace());
                let step =
                    (a + Matrix4::from_diagonal(&shift)).cholesky().map(|f| f.solve(b)).unwrap_or_default();
                let moved: [f64; 3] = std::array::from_fn(|k| ball.0[k] - step[k]);
                let depth = self.distance.depth(moved);
                if depth <= 0.0 {
                    return *ball;
                }
                (moved, (ball.1 - step[3]).min(depth + self.overhang).max(self.least.min(depth)))
            })
            .collect()
    }
}

/// Inner lattice points of spacing about `h` [m], with depths [m].
fn lattice(distance: &SurfaceDistance, [lo, hi]: [[f64; 3]; 2], h: f64) -> Vec<Ball> {
    let count: [usize; 3] = std::array::from_fn(|k| ((hi[k] - lo[k]) / h).ceil().max(1.0) as usize);
    let mut inside = Vec::new();
    for i in 0..count[0] {
        for j in 0..count[1] {
            for k in 0..count[2] {
                let at = [i, j, k];
                let p =
                    std::array::from_fn(|d| lo[d] + (at[d] as f64 + 0.5) * (hi[d] - lo[d]) / count[d] as f64);
                let depth = distance.depth(p);
                if depth > 0.0 {
                    inside.push((p, depth));
                }
            }
        }
    }
    inside
}

/// At most `count` indices, spread evenly over 0..n.
fn thinned(n: usize, count: usize) -> impl Iterator<Item = usize> {
    let take = n.min(count);
    (0..take).map(move |i| (2 * i + 1) * n / (2 * take))
}

/// Connected spheres overlap by a tenth of the smaller radius.
fn joined(a: &Ball, b: &Ball) -> bool {
    (Vector3::from(a.0) - Vector3::from(b.0)).norm() < a.1 + b.1 - 0.1 * a.1.min(b.1)
}

fn in_one_piece(balls: &[Ball]) -> bool {
    let mut reached = vec![false; balls.len()];
    let mut open = vec![0];
    reached[0] = true;
    let mut count = 1;
    while let Some(i) = open.pop() {
        for j in 0..balls.len() {
            if !reached[j] && joined(&balls[i], &balls[j]) {
                reached[j] = true;
                count += 1;
                open.push(j);
            }
        }
    }
    count == balls.len()
}
