//! Preconditioned conjugate gradients.
//!
//! Convergence: `sqrt(r·B r)` relative to the right-hand side, B the preconditioner.
//!
//! Source: Saad (2003), algorithm 9.1. Limits: the recursive residual deviates near rounding, about 1e-16
//! times the condition of A.

pub mod vectors;

use thiserror::Error;
use vectors::{add_scaled, dot, parts, scale_and_add, subtract};

/// Symmetric positive definite matrix, given by products.
pub trait Operator {
    /// Computes `y = A x`, of equal length.
    fn apply(&mut self, x: &[f64], y: &mut [f64]);
}

/// Symmetric positive definite approximate inverse.
pub trait Preconditioner {
    /// Computes `z = B r`, of equal length.
    fn apply(&mut self, r: &[f64], z: &mut [f64]);

    /// Memory [bytes].
    fn memory(&self) -> usize;
}

/// Work space; solves allocate nothing.
pub struct ConjugateGradients {
    r: Vec<f64>,
    z: Vec<f64>,
    p: Vec<f64>,
    q: Vec<f64>,
    partial: Vec<f64>,
    limit: u32,
}

/// Failed solves.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum Stopped {
    /// Direction without energy, or value not finite.
    #[error("breakdown in iteration {iteration}, residual {residual:.3e}")]
    Breakdown {
        /// Iteration, from 1; 0 for the right-hand side.
        iteration: u32,
        /// Relative residual before [-].
        residual: f64,
    },
    /// Iteration limit.
    #[error("residual {residual:.3e} after {iterations} iterations")]
    Limit {
        /// Iterations.
        iterations: u32,
        /// Relative residual [-].
        residual: f64,
    },
}

impl ConjugateGradients {
    /// Work space for vectors of `values` values; iteration limit `limit`.
    pub fn new(values: usize, limit: u32) -> ConjugateGradients {
        let zero = || vec![0.0; values];
        let partial = vec![0.0; parts(values)];
        ConjugateGradients { r: zero(), z: zero(), p: zero(), q: zero(), partial, limit }
    }

    /// Memory [bytes].
    pub fn memory(&self) -> usize {
        size_of::<f64>() * (4 * self.r.len() + self.partial.len())
    }

    /// Solves `A x = b` from the guess in `x`; returns the iterations.
    ///
    /// # Errors
    /// [`Stopped`], with invalid `x`.
    pub fn solve(
        &mut self,
        a: &mut impl Operator,
        preconditioner: &mut impl Preconditioner,
        b: &[f64],
        x: &mut [f64],
        tolerance: f64,
    ) -> Result<u32, Stopped> {
        let ConjugateGradients { r, z, p, q, partial, limit } = self;
        preconditioner.apply(b, z);
        let scale = dot(b, z, partial);
        if scale == 0.0 {
            x.fill(0.0);
            return Ok(0);
        }
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(Stopped::Breakdown { iteration: 0, residual: 1.0 });
        }
        let mut square = scale;
        r.copy_from_slice(b);
        p.copy_from_slice(z);
        if x.iter().any(|x| *x != 0.0) {
            a.apply(x, q);
            subtract(b, q, r);
            preconditioner.apply(r, z);
            square = dot(r, z, partial);
            if square < scale {
                p.copy_from_slice(z);
            } else {
                x.fill(0.0);
                square = scale;
                r.copy_from_slice(b);
            }
        }
        let residual = |square: f64| (square / scale).sqrt();
        for iteration in 0..=*limit {
            if residual(square) <= tolerance {
                return Ok(iteration);
            }
            if iteration == *limit {
                break;
            }
            let breakdown = Err(Stopped::Breakdown { iteration: iteration + 1, residual: residual(square) });
            a.apply(p, q);
            let energy = dot(p, q, partial);
            if !(energy > 0.0 && energy.is_finite()) {
                return breakdown;
            }
            let step = square / energy;
            add_scaled(x, step, p);
            add_scaled(r, -step, q);
            preconditioner.apply(r, z);
            let next = dot(r, z, partial);
            if !(next >= 0.0 && next.is_finite()) {
                return breakdown;
            }
            scale_and_add(p, next / square, z);
            square = next;
        }
        Err(Stopped::Limit { iterations: *limit, residual: residual(square) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tridiagonal `-1, 2 + shift, -1`.
    struct Line(f64);

    impl Operator for Line {
        fn apply(&mut self, x: &[f64], y: &mut [f64]) {
            let n = x.len();
            for i in 0..n {
                let left = if i > 0 { x[i - 1] } else { 0.0 };
                let right = if i + 1 < n { x[i + 1] } else { 0.0 };
                y[i] = (2.0 + self.0) * x[i] - left - right;
            }
        }
    }

    struct Scale(f64);

    impl Preconditioner for Scale {
        fn apply(&mut self, r: &[f64], z: &mut [f64]) {
            z.iter_mut().zip(r).for_each(|(z, r)| *z = self.0 * r);
        }

        fn memory(&self) -> usize {
            0
        }
    }

    fn solve(n: usize, shift: f64, guess: &[f64], tolerance: f64) -> (Result<u32, Stopped>, Vec<f64>) {
        let exact: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).sin()).collect();
        let (mut b, mut x) = (vec![0.0; n], guess.to_vec());
        Line(shift).apply(&exact, &mut b);
        let mut cg = ConjugateGradients::new(n, 200);
        let outcome = cg.solve(&mut Line(shift), &mut Scale(0.5), &b, &mut x, tolerance);
        x.iter_mut().zip(&exact).for_each(|(x, e)| *x -= e);
        (outcome, x)
    }

    /// Iterations equal the distinct eigenvalues (Saad 2003, section 6.11.3).
    #[test]
    fn solves_within_equation_count() {
        let (outcome, error) = solve(12, 0.0, &[0.0; 12], 1e-13);
        assert_eq!(outcome, Ok(12));
        assert!(error.iter().all(|e| e.abs() < 1e-12));
    }

    /// Iteration bound of Saad 2003, eq. 6.128.
    #[test]
    fn iterations_satisfy_condition_bound() {
        let n = 4000;
        for (shift, tolerance) in [(1.0, 1e-8), (0.1, 1e-6), (0.1, 1e-10)] {
            let condition: f64 = (4.0 + shift) / shift;
            let rate = (condition.sqrt() - 1.0) / (condition.sqrt() + 1.0);
            // Energy norm; the residual norm differs by the root of the condition.
            let bound = (tolerance / (2.0 * condition.sqrt())).ln() / rate.ln();
            let (outcome, error) = solve(n, shift, &vec![0.0; n], tolerance);
            let iterations = f64::from(outcome.unwrap());
            println!(
                "condition {condition:.0}, tolerance {tolerance}: {iterations} iterations, bound {bound:.0}"
            );
            assert!(iterations <= bound + 1.0 && iterations > 0.5 * bound);
            assert!(error.iter().all(|e| e.abs() < 1e2 * tolerance));
        }
    }

    #[test]
    fn only_a_good_guess_counts() {
        let n = 500;
        let exact: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).sin()).collect();
        let cold = solve(n, 0.5, &vec![0.0; n], 1e-10).0.unwrap();
        assert_eq!(solve(n, 0.5, &exact, 1e-10).0, Ok(0));
        let near: Vec<f64> = exact.iter().map(|e| 1.001 * e).collect();
        assert!(solve(n, 0.5, &near, 1e-10).0.unwrap() < cold);
        let far: Vec<f64> = exact.iter().map(|e| -3.0 * e).collect();
        let (from_far, from_zero) = (solve(n, 0.5, &far, 1e-10), solve(n, 0.5, &vec![0.0; n], 1e-10));
        assert_eq!(from_far, from_zero);
    }

    #[test]
    fn failures_are_named() {
        let stopped = solve(4000, 1e-6, &vec![0.0; 4000], 1e-10).0;
        let Err(Stopped::Limit { iterations: 200, residual }) = stopped else { panic!("{stopped:?}") };
        assert!(residual > 1e-10 && residual.is_finite());
        let stopped = solve(100, -3.0, &[0.0; 100], 1e-10).0;
        assert!(matches!(stopped, Err(Stopped::Breakdown { iteration: 1, .. })), "{stopped:?}");
        let mut cg = ConjugateGradients::new(3, 5);
        let stopped = cg.solve(&mut Line(0.0), &mut Scale(1.0), &[1.0, f64::NAN, 0.0], &mut [0.0; 3], 1e-8);
        assert!(matches!(stopped, Err(Stopped::Breakdown { iteration: 0, .. })), "{stopped:?}");
        let solved = cg.solve(&mut Line(0.0), &mut Scale(1.0), &[0.0; 3], &mut [7.0; 3], 1e-8);
        assert_eq!(solved, Ok(0));
    }
}
