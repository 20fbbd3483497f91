//! Smoothed aggregation: a preconditioner for elastic stiffness, nearly independent of mesh size.
//!
//! Source: Vaněk, Mandel and Brezina (1996). Limits: near incompressibility and very flat elements take more
//! iterations.

mod aggregates;
mod galerkin;
mod level;
mod rows;
mod transfer;

use super::block_jacobi::BlockJacobi;
use super::matrix_product::MatrixProduct;
use crate::solver::conjugate::Preconditioner;
use aggregates::{NONE, aggregate};
use galerkin::galerkin;
use level::{Level, largest_eigenvalue};
use nalgebra::linalg::Cholesky;
use nalgebra::{DMatrix, DVector, Dyn, SMatrix};
use rows::{Block, BlockRows, Blocks, UpperTriangle};
use transfer::{Transfer, tentative};

/// Strength threshold of the first level; larger values cost time and memory.
const STRENGTH: f64 = 0.02;
/// Most aggregates of the coarsest level.
const COARSEST: usize = 160;
/// Maximum number of levels.
const LEVELS: usize = 8;

/// Levels and coarsest factor.
pub struct Aggregation {
    finest: Level<3, MatrixProduct>,
    levels: Vec<Level<6, Blocks<6, 6>>>,
    factor: Cholesky<f64, Dyn>,
    sides: Vec<[Vec<f64>; 2]>,
    last: DVector<f64>,
    memory: usize,
}

/// Level matrix that is not positive definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotPositive;

impl Aggregation {
    /// Builds the levels from inverse diagonal blocks `jacobi` and node `coordinates`.
    ///
    /// # Errors
    /// A level matrix is not positive definite: insufficient constraints.
    pub fn new(
        mut product: MatrixProduct,
        jacobi: &BlockJacobi,
        coordinates: &[[f64; 3]],
    ) -> Result<Aggregation, NotPositive> {
        let inverse: Vec<Block<3, 3>> = jacobi
            .inverse()
            .iter()
            .map(|a| [[a[0], a[1], a[2]], [a[1], a[3], a[4]], [a[2], a[4], a[5]]])
            .collect();
        let largest = largest_eigenvalue(&mut product, &inverse);
        let modes = rigid_motions(coordinates, product.free());
        let (transfer, matrix, mut modes) =
            next_level(&UpperTriangle::new(&product), STRENGTH, &modes, &inverse, largest);
        let finest = Level::new(product, inverse, largest, transfer);
        let (mut levels, mut matrix) = (Vec::new(), matrix);
        while matrix.len() > COARSEST && levels.len() < LEVELS {
            let inverse = inverse_diagonal(&matrix)?;
            let largest = largest_eigenvalue(&mut matrix, &inverse);
            let (transfer, next, next_modes) = next_level(&matrix, 0.0, &modes, &inverse, largest);
            // Coarsening stagnates.
            if 2 * next.len() > matrix.len() {
                break;
            }
            levels.push(Level::new(matrix, inverse, largest, transfer));
            (matrix, modes) = (next, next_modes);
        }
        let n = 6 * matrix.len();
        let mut dense = DMatrix::zeros(n, n);
        for p in 0..matrix.len() {
            for (q, block) in matrix.row(p) {
                (0..36).for_each(|k| dense[(6 * p + k / 6, 6 * q + k % 6)] = block[k / 6][k % 6]);
            }
        }
        let factor = Cholesky::new(dense).ok_or(NotPositive)?;
        let counts = levels.iter().map(|l| l.matrix().len()).chain([matrix.len()]);
        let sides: Vec<_> = counts.map(|n| [vec![0.0; 6 * n], vec![0.0; 6 * n]]).collect();
        let of_levels: usize = levels.iter().map(|l| l.memory() + l.matrix().memory()).sum();
        let memory = finest.memory() + finest.matrix().memory() + of_levels + 8 * n * n;
        Ok(Aggregation { finest, levels, factor, sides, last: DVector::zeros(n), memory })
    }

    /// Rows of each level, finest first.
    pub fn sizes(&self) -> Vec<usize> {
        let first = self.finest.matrix().free().len();
        std::iter::once(first).chain(self.sides.iter().map(|[b, _]| b.len() / 6)).collect()
    }
}

fn next_level<const N: usize>(
    rows: &impl BlockRows<N>,
    strength: f64,
    modes: &[Block<N, 6>],
    inverse: &[Block<N, N>],
    largest: f64,
) -> (Transfer<N>, Blocks<6, 6>, Vec<Block<6, 6>>) {
    let groups = aggregate(rows, strength);
    debug_assert!(groups.of.iter().all(|&g| g == NONE || (g as usize) < groups.count));
    let (base, next) = tentative(&groups, modes);
    let transfer = Transfer::new(rows, &groups, &base, inverse, 4.0 / (3.0 * largest));
    let matrix = galerkin(rows, &transfer.prolongator, groups.count);
    (transfer, matrix, next)
}

fn rigid_motions(coordinates: &[[f64; 3]], free: &[[bool; 3]]) -> Vec<Block<3, 6>> {
    let count = coordinates.len().max(1) as f64;
    let centre = [0, 1, 2].map(|k| coordinates.iter().map(|x| x[k]).sum::<f64>() / count);
    coordinates
        .iter()
        .zip(free)
        .map(|(x, free)| {
            let [x, y, z] = [0, 1, 2].map(|k| x[k] - centre[k]);
            let all = [[1.0, 0.0, 0.0, 0.0, z, -y], [0.0, 1.0, 0.0, -z, 0.0, x], [0.0, 0.0, 1.0, y, -x, 0.0]];
            [0, 1, 2].map(|k| if free[k] { all[k] } else { [0.0; 6] })
        })
        .collect()
}

fn inverse_diagonal(matrix: &Blocks<6, 6>) -> Result<Vec<Block<6, 6>>, NotPositive> {
    (0..matrix.len())
        .map(|p| {
            let (_, diagonal) = matrix.row(p).find(|(q, _)| *q == p).ok_or(NotPositive)?;
            let diagonal = SMatrix::<f64, 6, 6>::from_fn(|i, j| diagonal[i][j]);
            let inverse = diagonal.cholesky().ok_or(NotPositive)?.inverse();
            Ok(std::array::from_fn(|i| std::array::from_fn(|j| inverse[(i, j)])))
        })
        .collect()
}

impl Preconditioner for Aggregation {
    fn apply(&mut self, r: &[f64], z: &mut [f64]) {
        let Aggregation { finest, levels, factor, sides, last, .. } = self;
        finest.descend(r, z, &mut sides[0][0]);
        for (k, level) in levels.iter_mut().enumerate() {
            let (own, next) = sides.split_at_mut(k + 1);
            let [b, x] = &mut own[k];
            level.descend(b, x, &mut next[0][0]);
        }
        let [b, x] = &mut sides[levels.len()];
        last.as_mut_slice().copy_from_slice(b);
        factor.solve_mut(last);
        x.copy_from_slice(last.as_slice());
        for (k, level) in levels.iter_mut().enumerate().rev() {
            let (own, next) = sides.split_at_mut(k + 1);
            let [b, x] = &mut own[k];
            level.ascend(b, x, &next[0][1]);
        }
        finest.ascend(r, z, &sides[0][1]);
    }

    fn memory(&self) -> usize {
        self.memory
    }
}
