//! Restarted GMRES with right preconditioner, which keeps the true residual norm.
//!
//! Source: Saad and Schultz (1986); Saad (2003), algorithm 9.5; reorthogonalisation: Daniel, Gragg, Kaufman
//! and Stewart, Math. Comp. 30 (1976) 772-795.

/// Work space; solves allocate nothing.
pub struct Gmres {
    size: usize,
    restart: usize,
    /// Arnoldi vectors `[(restart + 1) x size]`.
    basis: Vec<f64>,
    /// Triangular Hessenberg factor, by columns `[restart x (restart + 1)]`.
    hessenberg: Vec<f64>,
    cosine: Vec<f64>,
    sine: Vec<f64>,
    rotated: Vec<f64>,
    direction: Vec<f64>,
}

/// Outcome of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Arnoldi steps; the preconditioner is applied once more per cycle.
    pub iterations: usize,
    /// True |b - A x| / |b|; 0 for b = 0.
    pub residual: f64,
    /// Whether the tolerance is met.
    pub converged: bool,
}

impl Gmres {
    /// Work space for `size` equations and `restart` iterations (at least 1): `restart + 2` vectors.
    pub fn new(size: usize, restart: usize) -> Gmres {
        let restart = restart.max(1);
        Gmres {
            size,
            restart,
            basis: vec![0.0; (restart + 1) * size],
            hessenberg: vec![0.0; restart * (restart + 1)],
            cosine: vec![0.0; restart],
            sine: vec![0.0; restart],
            rotated: vec![0.0; restart + 1],
            direction: vec![0.0; size],
        }
    }

    /// Solves `A x = b` from the guess in `x` until `|b - A x| <= tolerance |b|`, `limit` iterations, or no
    /// progress.
    ///
    /// `times(v, y)` sets `y = A v`, `precondition(z)` solves `M z = z` in place. Shapes `[size]`.
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn solve(
        &mut self,
        mut times: impl FnMut(&[f64], &mut [f64]),
        mut precondition: impl FnMut(&mut [f64]),
        b: &[f64],
        x: &mut [f64],
        tolerance: f64,
        limit: usize,
    ) -> Outcome {
        let n = self.size;
        assert!(b.len() == n && x.len() == n, "all sizes are alike");
        let scale = norm(b);
        if scale == 0.0 {
            x.fill(0.0);
            return Outcome { iterations: 0, residual: 0.0, converged: true };
        }
        let (mut iterations, mut former) = (0, f64::INFINITY);
        loop {
            times(x, &mut self.direction);
            let first = &mut self.basis[..n];
            for i in 0..n {
                first[i] = b[i] - self.direction[i];
            }
            let length = norm(first);
            let residual = length / scale;
            let converged = residual <= tolerance;
            // The next cycle would be identical.
            if converged || iterations >= limit || !residual.is_finite() || residual > 0.999 * former {
                return Outcome { iterations, residual, converged };
            }
            former = residual;
            first.iter_mut().for_each(|v| *v /= length);
            self.rotated.fill(0.0);
            self.rotated[0] = length;
            let mut steps = 0;
            while steps < self.restart && iterations < limit {
                let more = self.step(steps, &mut times, &mut precondition);
                steps += 1;
                iterations += 1;
                if !more || self.rotated[steps].abs() <= tolerance * scale {
                    break;
                }
            }
            self.correct(steps, &mut precondition, x);
        }
    }

    /// Returns false if the space is exhausted.
    fn step(
        &mut self,
        j: usize,
        times: &mut impl FnMut(&[f64], &mut [f64]),
        precondition: &mut impl FnMut(&mut [f64]),
    ) -> bool {
        let (n, rows) = (self.size, self.restart + 1);
        let (known, new) = self.basis.split_at_mut((j + 1) * n);
        let new = &mut new[..n];
        self.direction.copy_from_slice(&known[j * n..]);
        precondition(&mut self.direction);
        times(&self.direction, new);
        let column = &mut self.hessenberg[j * rows..(j + 1) * rows];
        column.fill(0.0);
        let before = norm(new);
        for pass in 0..2 {
            for (i, v) in known.chunks_exact(n).enumerate() {
                let h = dot(v, new);
                column[i] += h;
                new.iter_mut().zip(v).for_each(|(w, v)| *w -= h * v);
            }
            if pass == 0 && norm(new) > 0.7 * before {
                break;
            }
        }
        let length = norm(new);
        let grows = length > f64::EPSILON * before && length.is_finite();
        if grows {
            new.iter_mut().for_each(|w| *w /= length);
        }
        for i in 0..j {
            let (a, b) = (column[i], column[i + 1]);
            column[i] = self.cosine[i] * a + self.sine[i] * b;
            column[i + 1] = self.cosine[i] * b - self.sine[i] * a;
        }
        let (a, b) = (column[j], if grows { length } else { 0.0 });
        let r = libm::hypot(a, b);
        // Zero columns, of singular matrices, do not contribute.
        (self.cosine[j], self.sine[j]) = if r > 0.0 { (a / r, b / r) } else { (1.0, 0.0) };
        column[j] = r;
        self.rotated[j + 1] = -self.sine[j] * self.rotated[j];
        self.rotated[j] *= self.cosine[j];
        grows
    }

    /// `x += M^-1 V y` with the minimising y.
    fn correct(&mut self, steps: usize, precondition: &mut impl FnMut(&mut [f64]), x: &mut [f64]) {
        let (n, rows) = (self.size, self.restart + 1);
        for i in (0..steps).rev() {
            let known: f64 = (i + 1..steps).map(|k| self.hessenberg[k * rows + i] * self.rotated[k]).sum();
            let pivot = self.hessenberg[i * rows + i];
            self.rotated[i] = if pivot == 0.0 { 0.0 } else { (self.rotated[i] - known) / pivot };
        }
        self.direction.fill(0.0);
        for (v, &y) in self.basis.chunks_exact(n.max(1)).zip(&self.rotated[..steps]) {
            self.direction.iter_mut().zip(v).for_each(|(d, v)| *d += y * v);
        }
        precondition(&mut self.direction);
        x.iter_mut().zip(&self.direction).for_each(|(x, d)| *x += d);
    }
}

/// Fixes the summation order.
const LANES: usize = 8;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = [0.0; LANES];
    let (a, a_rest) = a.as_chunks::<LANES>();
    let (b, b_rest) = b.as_chunks::<LANES>();
    for (a, b) in a.iter().zip(b) {
        for l in 0..LANES {
            sum[l] += a[l] * b[l];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    sum.iter().sum::<f64>() + rest
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solver::analysis::Analysis;
    use crate::solver::multifrontal::DirectSolver;
    use std::sync::Arc;

    struct Line {
        n: usize,
        convection: f64,
    }

    impl Line {
        fn times(&self, x: &[f64], y: &mut [f64]) {
            for i in 0..self.n {
                let left = if i > 0 { x[i - 1] } else { 0.0 };
                let right = if i + 1 < self.n { x[i + 1] } else { 0.0 };
                y[i] = 2.1 * x[i] - (1.0 + self.convection) * left - (1.0 - self.convection) * right;
            }
        }

        fn diffusion(&self) -> DirectSolver {
            let n = self.n;
            let (mut start, mut row, mut values) = (vec![0], Vec::new(), Vec::new());
            for c in 0..n {
                row.extend(c..n.min(c + 2));
                values.extend([2.1, -1.0].iter().take(n.min(c + 2) - c));
                start.push(row.len());
            }
            let mut solver =
                DirectSolver::new(Arc::new(Analysis::from_pattern(start, row, (0..n).collect()).unwrap()));
            solver.factor_symmetric(&values).unwrap();
            solver
        }

        fn solve(&self, restart: usize, tolerance: f64, limit: usize) -> (Outcome, f64) {
            let n = self.n;
            let exact: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).sin()).collect();
            let (mut b, mut x) = (vec![0.0; n], vec![0.0; n]);
            self.times(&exact, &mut b);
            let mut gmres = Gmres::new(n, restart);
            let times = |v: &[f64], y: &mut [f64]| self.times(v, y);
            let mut solver = self.diffusion();
            let precondition = |z: &mut [f64]| solver.solve_in_place(z);
            let outcome = gmres.solve(times, precondition, &b, &mut x, tolerance, limit);
            let error = x.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            (outcome, error)
        }
    }

    #[test]
    fn solves_with_symmetric_part_factor() {
        let (outcome, error) = Line { n: 500, convection: 0.2 }.solve(40, 1e-12, 200);
        assert!(outcome.converged && outcome.residual <= 1e-12, "{outcome:?}");
        assert!(error < 1e-10, "{error:.1e}");
        assert!(outcome.iterations < 60, "{outcome:?}");
        let (short, error) = Line { n: 500, convection: 0.2 }.solve(6, 1e-12, 400);
        assert!(short.converged && error < 1e-10 && short.iterations > outcome.iterations, "{short:?}");
    }

    #[test]
    fn the_exact_factor_needs_one_iteration() {
        let (outcome, error) = Line { n: 300, convection: 0.0 }.solve(10, 1e-13, 10);
        assert_eq!((outcome.iterations, outcome.converged), (1, true));
        assert!(error < 1e-12);
    }

    /// Unrestarted iterations equal the distinct eigenvalues (Saad and Schultz 1986, corollary 3).
    #[test]
    fn ends_at_minimal_polynomial_degree() {
        let n = 60;
        let b = vec![1.0; n];
        let mut x = vec![0.0; n];
        let times = |v: &[f64], y: &mut [f64]| (0..n).for_each(|i| y[i] = (1 + i % 3) as f64 * v[i]);
        let outcome = Gmres::new(n, 20).solve(times, |_| (), &b, &mut x, 1e-13, 20);
        assert_eq!((outcome.iterations, outcome.converged), (3, true));
        assert!(x.iter().enumerate().all(|(i, x)| (x - 1.0 / (1 + i % 3) as f64).abs() < 1e-14));
    }

    /// Cyclic shift: no progress before iteration n (Saad 2003, section 6.5.9).
    #[test]
    fn stagnation_and_the_limit_are_reported() {
        let n = 12;
        let times = |v: &[f64], y: &mut [f64]| (0..n).for_each(|i| y[i] = v[(i + 1) % n]);
        let mut b = vec![0.0; n];
        b[0] = 1.0;
        let mut x = vec![0.0; n];
        let outcome = Gmres::new(n, 5).solve(times, |_| (), &b, &mut x, 1e-10, 1000);
        assert_eq!(outcome, Outcome { iterations: 5, residual: 1.0, converged: false });
        let outcome = Gmres::new(n, n).solve(times, |_| (), &b, &mut x, 1e-10, 1000);
        assert_eq!((outcome.iterations, outcome.converged), (n, true));
        x.fill(0.0);
        let outcome = Gmres::new(n, n).solve(times, |_| (), &b, &mut x, 1e-10, 3);
        assert_eq!((outcome.iterations, outcome.converged), (3, false));
    }

    #[test]
    fn zero_load_needs_no_iteration() {
        let line = Line { n: 50, convection: 0.3 };
        let (mut solver, mut gmres) = (line.diffusion(), Gmres::new(50, 10));
        let mut x = vec![1.0; 50];
        let times = |v: &[f64], y: &mut [f64]| line.times(v, y);
        let outcome = gmres.solve(times, |z| solver.solve_in_place(z), &[0.0; 50], &mut x, 1e-8, 10);
        assert_eq!(outcome, Outcome { iterations: 0, residual: 0.0, converged: true });
        assert!(x.iter().all(|&x| x == 0.0));
        x.fill(1.0);
        let mut b = vec![0.0; 50];
        line.times(&x, &mut b);
        let outcome = gmres.solve(times, |z| solver.solve_in_place(z), &b, &mut x, 1e-8, 10);
        assert_eq!((outcome.iterations, outcome.converged), (0, true));
    }
}
