//! Natural frequencies and mode shapes: `K phi = w² M phi` on the free dofs, boundary springs included.
//!
//! Shift and invert: the eigenvalues of `(K + s M)^-1 M` are `1/(w² + s)`, so the lowest modes come first. A held body
//! takes s = 0; a body that can move freely a small s > 0, which keeps the matrix positive definite and lets its rigid
//! motions through as modes of 0 Hz. The modes come from a block Krylov space with thick restarts (`krylov.rs`); each
//! is checked by its residual, and a further run in the space orthogonal to all of them, from a fresh start, looks for a
//! mode that was missed, until there is none. The frequencies depend on no random choice: the start vectors are fixed.
//!
//! Source: Ericsson and Ruhe, Math. Comp. 35 (1980) 1251-1268 (shift and invert); Stewart, SIAM J. Matrix Anal. Appl. 23
//! (2001) 601-614, and Wu and Simon, ibid. 22 (2000) 602-616 (restarts); Clough and Penzien, Dynamics of Structures
//! (1993), chapter 13 (participation, effective mass). Limits: no damping: Rayleigh damping and dashpots are left out;
//! frequencies below a thousandth of that of the lowest smooth strain count as rigid, when the body is not held.
//!
//! Theory manual: equation (4.18) of `docs/theory/solid.md`.

mod krylov;

use crate::assembly::Combination;
use crate::equations::cholesky::Cholesky;
use crate::error::{SolveError, size};
use crate::model::Model;
use crate::newmark::check_density;
use crate::statics::check_held;
use krylov::{Operator, Ritz};
use nalgebra::DMatrix;
use thiserror::Error;

/// Shift over the square of the frequency of the lowest smooth strain, for bodies that are not held.
const SHIFT: f64 = 1e-3;
/// Square of a frequency over that of the lowest smooth strain, below which a mode counts as rigid.
const RIGID: f64 = 1e-6;
/// Residual above which a mode is refused.
const REFUSE: f64 = 1e-5;
/// Excess of an eigenvalue of the check over the last one wanted, that rounding may cause.
const TIE: f64 = 1e-8;

/// Why there are no modes.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ModalError {
    /// The matrix could not be made or factored.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The iteration did not come to an end.
    #[error("not converged: {found} of {wanted} modes after {restarts} restarts")]
    NotConverged {
        /// Modes that converged.
        found: usize,
        /// Modes wanted.
        wanted: usize,
        /// Restarts made.
        restarts: usize,
    },
    /// A mode misses its equation.
    #[error("residual of mode {mode}: {}", size(*residual))]
    Inaccurate {
        /// Number of the mode, from 1.
        mode: usize,
        /// Residual [-].
        residual: f64,
    },
}

/// The lowest modes, by ascending frequency.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Modes {
    /// Frequencies [Hz]. Shape `[modes]`.
    pub frequencies: Vec<f64>,
    /// Circular frequencies w [1/s]. Shape `[modes]`.
    pub circular: Vec<f64>,
    /// Shapes with `phi·M phi = 1` [kg^-1/2], largest entry positive. Shape `[modes][3 * nodes]`.
    pub shapes: Vec<Vec<f64>>,
    /// `|K phi - w² M phi| / ((w² + w_s²) |M phi|)` over the free dofs [-], w_s being 0 for a held body, else the
    /// frequency of the lowest smooth strain, so that rigid motions have a measure. Shape `[modes]`.
    pub residuals: Vec<f64>,
    /// `phi·M r` with the unit motion r along x, y, z [kg^1/2]. Shape `[modes][3]`.
    pub participation: Vec<[f64; 3]>,
    /// Squares of the participation [kg]; over all modes they add up to the mass that the supports do not carry
    /// themselves. Shape `[modes][3]`.
    pub effective_mass: Vec<[f64; 3]>,
    /// Modes without stiffness, the first ones: rigid motions, and mechanisms of the reduced rule.
    pub zero_modes: usize,
    /// The shift s [1/s²]; 0 when the body is held.
    pub shift: f64,
}

/// The `count` lowest modes; fewer when the model has fewer free dofs.
///
/// # Errors
/// A material without density, not enough memory, or modes that do not converge.
pub fn solve(model: &Model, count: usize) -> Result<Modes, ModalError> {
    check_density(model)?;
    let count = count.min(model.free_dof_count());
    if count == 0 {
        return Ok(Modes::default());
    }
    let scale = smooth_scale(model);
    let (factor, shift) = shifted_factor(model, scale)?;
    let mut operator = Operator::new(model, factor);
    let block = if shift > 0.0 { 6 } else { 4 };
    let mut ritz = operator.largest(&[], count, block)?;
    check_for_missed(&mut operator, &mut ritz, count, block)?;
    let mut modes = Modes { shift, ..Modes::default() };
    for (square, shape) in separate(model, &ritz) {
        let (square, shape) = (square.max(0.0), with_positive_peak(shape));
        modes.circular.push(square.sqrt());
        modes.frequencies.push(square.sqrt() / std::f64::consts::TAU);
        modes.residuals.push(residual(model, square + shift / SHIFT, square, &shape));
        modes.shapes.push(shape);
    }
    if shift > 0.0 {
        modes.zero_modes = modes.circular.iter().filter(|w| *w * *w < RIGID * scale).count();
    }
    participation(model, &mut modes);
    match modes.residuals.iter().position(|r| r.is_nan() || *r > REFUSE) {
        Some(i) => Err(ModalError::Inaccurate { mode: i + 1, residual: modes.residuals[i] }),
        None => Ok(modes),
    }
}

/// Factor of K when the body is held, else of K + s M; and s.
fn shifted_factor(model: &Model, scale: f64) -> Result<(Cholesky, f64), SolveError> {
    if check_held(model).is_ok() {
        match Cholesky::of_stiffness(&model.equations(Combination::STIFFNESS)) {
            Ok(factor) => return Ok((factor, 0.0)),
            // A mechanism that the geometry does not show.
            Err(SolveError::NoStiffness { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    let shift = SHIFT * scale;
    let combination = Combination { mass: shift, ..Combination::STIFFNESS };
    Cholesky::factor(&model.equations(combination)).map(|factor| (factor, shift))
}

/// A measure of the lowest squares of frequencies [1/s²]: the least Rayleigh quotient of nine linear displacement fields.
fn smooth_scale(model: &Model) -> f64 {
    let (low, high) = model.mesh().bounding_box();
    let mut least = f64::INFINITY;
    let mut field = vec![0.0; model.dof_count()];
    for along in 0..3 {
        for direction in 0..3 {
            field.fill(0.0);
            for (u, x) in field.chunks_exact_mut(3).zip(&model.mesh().coordinates) {
                u[direction] = x[along] - 0.5 * (low[along] + high[along]);
            }
            let matrices = model.matrices();
            least = least.min(matrices.stiffness_form(&field) / matrices.mass_form(&field));
        }
    }
    least
}

/// Searches the space orthogonal to what was found for modes that belong among the first `count`, and adds them.
fn check_for_missed(
    operator: &mut Operator<'_>,
    ritz: &mut Vec<Ritz>,
    count: usize,
    block: usize,
) -> Result<(), ModalError> {
    loop {
        let vectors: Vec<&[f64]> = ritz.iter().map(|r| r.vector.as_slice()).collect();
        let next = operator.largest(&vectors, 1, block)?;
        let last = ritz[ritz.len().min(count) - 1].value;
        let missed = next.into_iter().filter(|r| r.value > last * (1.0 + TIE)).collect::<Vec<_>>();
        if missed.is_empty() {
            ritz.truncate(count);
            return Ok(());
        }
        ritz.extend(missed);
        ritz.sort_by(|a, b| b.value.total_cmp(&a.value));
    }
}

/// Diagonalizes K within the space of the vectors: squares of the circular frequencies and shapes, ascending.
fn separate(model: &Model, ritz: &[Ritz]) -> Vec<(f64, Vec<f64>)> {
    let (n, count) = (model.dof_count(), ritz.len());
    let mut small = DMatrix::zeros(count, count);
    let mut product = vec![0.0; n];
    for j in 0..count {
        model.stiffness_times(&ritz[j].vector, &mut product);
        for i in 0..=j {
            let entry: f64 = ritz[i].vector.iter().zip(&product).map(|(a, b)| a * b).sum();
            (small[(i, j)], small[(j, i)]) = (entry, entry);
        }
    }
    let eigen = small.symmetric_eigen();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let shape = |k: usize| {
        let mut shape = vec![0.0; n];
        for (i, ritz) in ritz.iter().enumerate() {
            let factor = eigen.eigenvectors[(i, k)];
            shape.iter_mut().zip(&ritz.vector).for_each(|(s, v)| *s += factor * v);
        }
        shape
    };
    order.into_iter().map(|k| (eigen.eigenvalues[k], shape(k))).collect()
}

/// Turns a shape so that the first of its largest entries, within a margin for rounding, is positive.
fn with_positive_peak(mut shape: Vec<f64>) -> Vec<f64> {
    let size = shape.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let peak = shape.iter().find(|v| v.abs() > 0.999 * size).copied().unwrap_or(1.0);
    if peak < 0.0 {
        shape.iter_mut().for_each(|v| *v = -*v);
    }
    shape
}

fn residual(model: &Model, measure: f64, square: f64, shape: &[f64]) -> f64 {
    let (mut k, mut m) = (vec![0.0; shape.len()], vec![0.0; shape.len()]);
    model.stiffness_times(shape, &mut k);
    model.mass_times(shape, &mut m);
    let (mut miss, mut size) = (0.0, 0.0);
    for d in model.supports().free().iter().map(|&d| d as usize) {
        miss += (k[d] - square * m[d]).powi(2);
        size += m[d] * m[d];
    }
    miss.sqrt() / (measure * size.sqrt())
}

fn participation(model: &Model, modes: &mut Modes) {
    let n = model.dof_count();
    for direction in 0..3 {
        let unit: Vec<f64> = (0..n).map(|d| f64::from(u8::from(d % 3 == direction))).collect();
        let mut product = vec![0.0; n];
        model.mass_times(&unit, &mut product);
        modes.participation.resize(modes.shapes.len(), [0.0; 3]);
        for (factor, shape) in modes.participation.iter_mut().zip(&modes.shapes) {
            factor[direction] = shape.iter().zip(&product).map(|(s, p)| s * p).sum();
        }
    }
    modes.effective_mass = modes.participation.iter().map(|p| p.map(|p| p * p)).collect();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::quadrature::Quadrature;
    use crate::material::elastic::Elastic;
    use crate::mesh::Mesh;
    use crate::model::ModelInput;

    /// Two modes taken away from the result, one of them of a pair, are found again.
    #[test]
    fn a_missed_mode_is_found_by_the_check() {
        let model = Model::new(ModelInput {
            mesh: Mesh::block([2, 2, 3], [1.0, 1.0, 1.6]),
            materials: [(1, Elastic { young: 20e6, poisson: 0.3, density: 2000.0 }.into())].into(),
            quadrature: Quadrature::Gauss3,
            ..Default::default()
        })
        .unwrap();
        let (factor, _) = shifted_factor(&model, smooth_scale(&model)).unwrap();
        let mut operator = Operator::new(&model, factor);
        let mut ritz = operator.largest(&[], 16, 6).unwrap();
        let values: Vec<f64> = ritz.iter().map(|r| r.value).collect();
        ritz.remove(9);
        ritz.remove(3);
        check_for_missed(&mut operator, &mut ritz, 14, 6).unwrap();
        assert_eq!(ritz.len(), 14);
        assert!(ritz.iter().zip(&values).all(|(r, v)| (r.value / v - 1.0).abs() < 1e-9), "{values:?}");
    }
}
