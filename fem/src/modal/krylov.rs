//! Largest eigenvalues of `A^-1 M` by block Krylov iteration with thick restarts.
//!
//! M-orthonormal basis V with full reorthogonalisation, `T = V·M A^-1 M V`. Sequential sums and fixed start
//! vectors make results bitwise reproducible. Memory: about `2 modes + 8 blocks` nodal vectors.

use super::ModalError;
use crate::equations::cholesky::Cholesky;
use crate::model::Model;
use nalgebra::{DMatrix, DVector};

/// Relative residual of a converged pair; eigenvalue error is its square.
const TOLERANCE: f64 = 1e-10;
/// Relative norm of a dependent vector.
const NOTHING: f64 = 1e-13;
const RESTARTS: usize = 200;

/// Eigenpair of `A^-1 M`, M-normalised, 0 at constrained dofs.
pub struct Ritz {
    /// Eigenvalue `1/(w² + s)` [s²].
    pub value: f64,
    pub vector: Vec<f64>,
}

pub struct Operator<'m> {
    model: &'m Model,
    factor: Cholesky,
    product: Vec<f64>,
    equations: Vec<f64>,
    seed: u64,
}

struct Space {
    basis: Vec<Vec<f64>>,
    /// Vectors with known columns of `projected`.
    done: usize,
    projected: DMatrix<f64>,
}

impl<'m> Operator<'m> {
    pub fn new(model: &'m Model, factor: Cholesky) -> Operator<'m> {
        let product = vec![0.0; model.dof_count()];
        Operator { model, factor, product, equations: Vec::new(), seed: 0x9e37_79b9_7f4a_7c15 }
    }

    /// Computes the `wanted` largest eigenvalues orthogonal to `locked`, descending; fewer if exhausted.
    ///
    /// # Errors
    /// [`ModalError::NotConverged`].
    pub fn largest(
        &mut self,
        locked: &[&[f64]],
        wanted: usize,
        block: usize,
    ) -> Result<Vec<Ritz>, ModalError> {
        let room = self.model.free_dof_count() - locked.len().min(self.model.free_dof_count());
        let (wanted, block) = (wanted.min(room), block.min(room));
        if wanted == 0 {
            return Ok(Vec::new());
        }
        let limit = room.min((2 * wanted).max(wanted + 8 * block));
        let size = limit + 2 * block;
        let mut space = Space { basis: Vec::new(), done: 0, projected: DMatrix::zeros(size, size) };
        self.add_random(locked, &mut space, block);
        let mut found = 0;
        for _ in 0..RESTARTS {
            while space.done < limit && space.done < space.basis.len() {
                self.expand(locked, &mut space, room, size);
            }
            let eigen =
                space.projected.view((0, 0), (space.done, space.done)).clone_owned().symmetric_eigen();
            let mut order: Vec<usize> = (0..space.done).collect();
            order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
            let tail = space.basis.len() - space.done;
            let coupling = space.projected.view((space.done, 0), (tail, space.done)) * &eigen.eigenvectors;
            let converged = |k: &&usize| coupling.column(**k).norm() <= TOLERANCE * eigen.eigenvalues[**k];
            found = order[..wanted.min(order.len())].iter().take_while(converged).count();
            if found == wanted {
                let chosen: Vec<usize> = order[..wanted].to_vec();
                let vectors = combine(&space.basis[..space.done], &eigen.eigenvectors, &chosen);
                let ritz = |(&k, vector)| Ritz { value: eigen.eigenvalues[k], vector };
                return Ok(chosen.iter().zip(vectors).map(ritz).collect());
            }
            // Neighbours of wanted vectors reappear slowly.
            let keep = (wanted + (limit - wanted) / 2).min(space.done - 1);
            let kept: Vec<usize> = order[..keep].to_vec();
            let mut basis = combine(&space.basis[..space.done], &eigen.eigenvectors, &kept);
            basis.extend(space.basis.drain(space.done..));
            let mut projected = DMatrix::zeros(size, size);
            for (i, &k) in kept.iter().enumerate() {
                // Coupling with the last block follows from its expansion.
                projected[(i, i)] = eigen.eigenvalues[k];
            }
            space = Space { basis, done: keep, projected };
        }
        Err(ModalError::NotConverged { found, wanted, restarts: RESTARTS })
    }

    fn expand(&mut self, locked: &[&[f64]], space: &mut Space, room: usize, size: usize) {
        let (start, end) = (space.done, space.basis.len());
        let images = self.apply(&space.basis[start..]);
        for (column, mut z) in (start..end).zip(images) {
            let before = self.norm(&z);
            let (coefficients, left) = self.orthogonalize(&mut z, locked, &space.basis);
            for (row, c) in coefficients.iter().enumerate() {
                space.projected[(row, column)] = *c;
                space.projected[(column, row)] = *c;
            }
            if left > NOTHING * before && space.basis.len() < room.min(size) {
                let row = space.basis.len();
                space.projected[(row, column)] = left;
                space.projected[(column, row)] = left;
                z.iter_mut().for_each(|v| *v /= left);
                space.basis.push(z);
            }
        }
        space.done = end;
        if space.basis.len() == end && end < room.min(size) {
            // Invariant subspace: continue in a random direction.
            self.add_random(locked, space, 1);
        }
    }

    fn add_random(&mut self, locked: &[&[f64]], space: &mut Space, count: usize) {
        for _ in 0..count {
            let mut z = vec![0.0; self.model.dof_count()];
            for &d in self.model.supports().free() {
                self.seed = self.seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                z[d as usize] = (self.seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0;
            }
            let (_, left) = self.orthogonalize(&mut z, locked, &space.basis);
            z.iter_mut().for_each(|v| *v /= left);
            space.basis.push(z);
        }
    }

    fn apply(&mut self, block: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let (supports, size) = (self.model.supports(), self.model.free_dof_count());
        self.equations.resize(block.len() * size, 0.0);
        for (x, equations) in block.iter().zip(self.equations.chunks_exact_mut(size)) {
            self.model.mass_times(x, &mut self.product);
            supports.gather(&self.product, equations);
        }
        self.equations.chunks_exact_mut(size).for_each(|x| self.factor.solve_in_place(x));
        let image = |equations: &[f64]| {
            let mut y = vec![0.0; self.product.len()];
            supports.scatter(equations, &mut y);
            y
        };
        self.equations.chunks_exact(size).map(image).collect()
    }

    fn norm(&mut self, x: &[f64]) -> f64 {
        self.model.matrices().mass_form(x).sqrt()
    }

    /// Orthogonalises z, repeatedly on cancellation (Daniel and others 1976); returns basis coefficients and
    /// remaining norm.
    fn orthogonalize(&mut self, z: &mut [f64], locked: &[&[f64]], basis: &[Vec<f64>]) -> (DVector<f64>, f64) {
        let mut coefficients = DVector::zeros(basis.len());
        let mut norm = self.norm(z);
        for _ in 0..5 {
            self.model.mass_times(z, &mut self.product);
            for v in locked {
                let c = dot(v, &self.product);
                subtract(z, c, v);
            }
            for (v, sum) in basis.iter().zip(coefficients.iter_mut()) {
                let c = dot(v, &self.product);
                subtract(z, c, v);
                *sum += c;
            }
            let left = self.norm(z);
            let settled = left > 0.7 * norm;
            norm = left;
            if settled || norm == 0.0 {
                break;
            }
        }
        (coefficients, norm)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn subtract(z: &mut [f64], factor: f64, v: &[f64]) {
    z.iter_mut().zip(v).for_each(|(z, v)| *z -= factor * v);
}

fn combine(basis: &[Vec<f64>], matrix: &DMatrix<f64>, columns: &[usize]) -> Vec<Vec<f64>> {
    columns
        .iter()
        .map(|&k| {
            let mut sum = vec![0.0; basis[0].len()];
            for (i, v) in basis.iter().enumerate() {
                subtract(&mut sum, -matrix[(i, k)], v);
            }
            sum
        })
        .collect()
}
