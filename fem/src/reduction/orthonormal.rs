//! Mass-orthonormal basis with diagonal stiffness of given vectors.

use super::ReductionError;
use crate::model::Model;
use nalgebra::{DMatrix, SymmetricEigen};

/// Squared relative length of the part of a vector that depends on others.
const DEPENDENT: f64 = 1e-12;

/// Basis with its matrices.
pub(super) struct Orthonormal {
    /// V. Shape `[shapes][3 * nodes]`.
    pub shape: Vec<f64>,
    /// VᵀKV, ascending [1/s²]. Shape `[shapes]`.
    pub square: Vec<f64>,
    /// VᵀDV.
    pub dashpots: Option<DMatrix<f64>>,
}

/// Spans `columns`, shape `[vectors][3 * nodes]`; dependent vectors are dropped.
///
/// # Errors
/// A vector without stiffness.
pub(super) fn orthonormal(model: &Model, columns: Vec<f64>) -> Result<Orthonormal, ReductionError> {
    let n = model.dof_count();
    let mut columns = DMatrix::from_vec(n, columns.len() / n, columns);
    let mass = |x: &[f64], y: &mut [f64]| model.mass_times(x, y);
    for mut column in columns.column_iter_mut() {
        let mut momentum = vec![0.0; n];
        mass(column.as_slice(), &mut momentum);
        let length: f64 = column.iter().zip(&momentum).map(|(x, m)| x * m).sum::<f64>().max(0.0).sqrt();
        column /= length.max(f64::MIN_POSITIVE);
    }
    let independent = {
        let eigen = gram(&columns, &mass).symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        let kept: Vec<usize> =
            ascending(&eigen).filter(|k| eigen.eigenvalues[*k] > DEPENDENT * largest).collect();
        let turn = |i: usize, k: usize| eigen.eigenvectors[(i, kept[k])] / eigen.eigenvalues[kept[k]].sqrt();
        &columns * DMatrix::from_fn(columns.ncols(), kept.len(), turn)
    };
    // Once more: rounding of short vectors was enlarged.
    let lower = gram(&independent, &mass).cholesky().ok_or(ReductionError::NotDefinite)?.unpack();
    let count = independent.ncols();
    let upper = lower
        .solve_lower_triangular(&DMatrix::identity(count, count))
        .ok_or(ReductionError::NotDefinite)?
        .transpose();
    let stiffness = gram(&independent, &|x, y| model.stiffness_times(x, y));
    let eigen = symmetric(upper.transpose() * stiffness * &upper).symmetric_eigen();
    let order: Vec<usize> = ascending(&eigen).collect();
    let square: Vec<f64> = order.iter().map(|&k| eigen.eigenvalues[k]).collect();
    if !square.iter().all(|s| *s > 0.0) {
        return Err(ReductionError::NotDefinite);
    }
    let turn = DMatrix::from_fn(count, count, |i, k| eigen.eigenvectors[(i, order[k])]);
    let shape = independent * (upper * turn);
    let damped = !model.matrices().dashpots().is_empty();
    let dashpots = damped.then(|| {
        gram(&shape, &|x, y| {
            y.fill(0.0);
            model.dashpot_times(x, y);
        })
    });
    Ok(Orthonormal { shape: shape.data.into(), square, dashpots })
}

/// XᵀAX.
fn gram(columns: &DMatrix<f64>, times: &dyn Fn(&[f64], &mut [f64])) -> DMatrix<f64> {
    let mut images = DMatrix::zeros(columns.nrows(), columns.ncols());
    for (x, mut y) in columns.column_iter().zip(images.column_iter_mut()) {
        times(x.as_slice(), y.as_mut_slice());
    }
    symmetric(columns.transpose() * images)
}

fn symmetric(matrix: DMatrix<f64>) -> DMatrix<f64> {
    0.5 * (&matrix + matrix.transpose())
}

fn ascending(eigen: &SymmetricEigen<f64, nalgebra::Dyn>) -> impl Iterator<Item = usize> {
    let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    order.into_iter()
}
