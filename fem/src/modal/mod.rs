//! Natural frequencies and mode shapes: `K phi = w² M phi` on the free dofs, with boundary springs.
//!
//! Shift and invert, `(K + s M)^-1 M`, s = 0 without rigid-body motion.
//!
//! Source: Ericsson and Ruhe (1980) (shift and invert); Stewart (2001), and Wu and Simon, SIAM J. Matrix
//! Anal. Appl. 22 (2000) 602-616 (restarts); Clough and Penzien (1993), chapter 13 (participation, effective
//! mass). Limits: no damping; in free bodies, frequencies below a thousandth of the lowest smooth strain's
//! count as rigid.
//!
//! Theory manual: equation (4.18) of `docs/theory/solid.md`.

mod krylov;

use crate::assembly::Combination;
use crate::equations::cholesky::Cholesky;
use crate::error::{SolveError, size};
use crate::model::Model;
use crate::newmark::check_density;
use crate::statics::check_rigid_body_motion;
use krylov::{Operator, Ritz};
use nalgebra::DMatrix;
use thiserror::Error;

/// Shift over the lowest smooth squared frequency.
const SHIFT: f64 = 1e-3;
/// Squared rigid frequency over the lowest smooth one.
const RIGID: f64 = 1e-6;
/// Largest accepted residual.
const MAX_RESIDUAL: f64 = 1e-5;
/// Relative rounding of eigenvalues.
const TIE: f64 = 1e-8;

/// Modal analysis errors.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ModalError {
    /// Matrix not assembled or factored.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// No convergence.
    #[error("not converged: {found} of {wanted} modes after {restarts} restarts")]
    NotConverged {
        /// Converged modes.
        found: usize,
        /// Requested modes.
        wanted: usize,
        /// Restarts.
        restarts: usize,
    },
    /// Residual too large.
    #[error("residual of mode {mode}: {}", size(*residual))]
    Inaccurate {
        /// Mode, from 1.
        mode: usize,
        /// Residual [-].
        residual: f64,
    },
}

/// Lowest modes by ascending frequency.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Modes {
    /// Frequencies [Hz]. Shape `[modes]`.
    pub frequencies: Vec<f64>,
    /// Circular frequencies w [1/s]. Shape `[modes]`.
    pub circular: Vec<f64>,
    /// M-normalised shapes [kg^-1/2], largest entry positive. Shape `[modes][3 * nodes]`.
    pub shapes: Vec<Vec<f64>>,
    /// `|K phi - w² M phi| / ((w² + w_s²) |M phi|)` [-]; w_s is 0 or, for free bodies, the lowest smooth
    /// frequency. Shape `[modes]`.
    pub residuals: Vec<f64>,
    /// `phi·M r` for unit motion r along x, y, z [kg^1/2]. Shape `[modes][3]`.
    pub participation: Vec<[f64; 3]>,
    /// Squared participation [kg]; the total is the mass not at supports. Shape `[modes][3]`.
    pub effective_mass: Vec<[f64; 3]>,
    /// Number of rigid and hourglass modes.
    pub zero_modes: usize,
    /// Shift s [1/s²]; 0 without rigid-body motion.
    pub shift: f64,
}

/// Computes the `count` lowest modes, limited by the free dofs.
///
/// # Errors
/// Material without density, out of memory, or no convergence.
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
    match modes.residuals.iter().position(|r| r.is_nan() || *r > MAX_RESIDUAL) {
        Some(i) => Err(ModalError::Inaccurate { mode: i + 1, residual: modes.residuals[i] }),
        None => Ok(modes),
    }
}

fn shifted_factor(model: &Model, scale: f64) -> Result<(Cholesky, f64), SolveError> {
    if check_rigid_body_motion(model).is_ok() {
        match Cholesky::of_stiffness(&model.equations(Combination::STIFFNESS)) {
            Ok(factor) => return Ok((factor, 0.0)),
            // Mechanism not visible in the geometry.
            Err(SolveError::NoStiffness { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    let shift = SHIFT * scale;
    let combination = Combination { mass: shift, ..Combination::STIFFNESS };
    Cholesky::factor(&model.equations(combination)).map(|factor| (factor, shift))
}

/// Lowest smooth squared frequency [1/s²]: least Rayleigh quotient of nine linear fields.
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

/// Rayleigh–Ritz: squared frequencies and shapes, ascending.
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

    /// One of the two removed modes belongs to a pair.
    #[test]
    fn check_finds_missed_mode() {
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
