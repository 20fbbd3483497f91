//! Pattern and values of the equations on the free dofs.

use super::ordering::nested_dissection;
use crate::assembly::{Combination, Matrices};
use crate::error::SolveError;
use crate::mesh::Mesh;
use crate::solver::analysis::Analysis;
use crate::supports::{CONSTRAINED, Supports};

/// Orders and analyses the free dofs.
///
/// # Errors
/// Out of memory.
pub fn analyse(mesh: &Mesh, matrices: &Matrices, supports: &Supports) -> Result<Analysis, SolveError> {
    let equations = supports.free().len();
    let (mut column_start, mut row) = (vec![0; equations + 1], Vec::new());
    matrices.visit_free(supports, |c, r, _, _, _| {
        row.push(r);
        column_start[c + 1] = row.len();
    });
    Ok(Analysis::from_pattern(column_start, row, order(mesh, supports))?)
}

pub(super) fn order(mesh: &Mesh, supports: &Supports) -> Vec<usize> {
    let index = supports.free_index();
    nested_dissection(mesh)
        .iter()
        .flat_map(|&n| (0..3).map(move |k| index[3 * n as usize + k]))
        .filter(|&e| e != CONSTRAINED)
        .map(|e| e as usize)
        .collect()
}

/// Values of a combination of matrices in the order of [`Analysis::pattern`].
pub fn values(
    analysis: &Analysis,
    matrices: &Matrices,
    supports: &Supports,
    combination: Combination,
) -> Vec<f64> {
    let mut values = Vec::with_capacity(analysis.entries());
    let Combination { stiffness, mass, dashpots } = combination;
    matrices.visit_free(supports, |_, _, k, m, d| {
        values.push(stiffness * k + mass * m + dashpots * d);
    });
    values
}
