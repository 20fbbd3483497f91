//! MUMPS factor of `S A S`, A = k K + m M + d D, in the elimination order of the mesh.
//!
//! Limits: no reuse of the analysis; negative pivots are reported without node.

use super::method::MumpsMethod;
use super::pattern::order;
use super::system::{Equations, SystemSolver};
use crate::assembly::Combination;
use crate::error::SolveError;
use crate::solver::mumps::{self, Coordinates, MumpsError, Settings};
use crate::supports::Supports;

/// Factor of MUMPS.
pub struct Factor {
    factor: mumps::Factor,
    /// Root of the inverse diagonal. Shape `[equations]`.
    scale: Vec<f64>,
}

impl Factor {
    /// Factors a combination; pivots below `null_pivot` of their diagonal count as zero.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] for a zero pivot, [`SolveError::Singular`] for a negative one,
    /// [`SolveError::Library`] for other failures or a missing library.
    pub fn new(
        equations: &Equations<'_>,
        method: MumpsMethod,
        null_pivot: f64,
    ) -> Result<Factor, SolveError> {
        let (matrix, scale) = scaled(equations)?;
        let factor = mumps::Factor::new(matrix, settings(method, null_pivot)).map_err(|e| match e {
            MumpsError::Pivot { equation } => equations.no_stiffness(equation, 0.0),
            MumpsError::NotPositive { .. } => SolveError::Singular,
            other => other.into(),
        })?;
        Ok(Factor { factor, scale })
    }
}

impl SystemSolver for Factor {
    fn solve(&mut self, _: &Supports, x: &mut [f64], _: &dyn Fn(usize) -> f64) -> Result<(), SolveError> {
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= s);
        self.factor.solve_in_place(x)?;
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= s);
        Ok(())
    }

    fn memory(&self) -> Option<usize> {
        Some(self.factor.memory())
    }
}

impl From<MumpsError> for SolveError {
    fn from(error: MumpsError) -> SolveError {
        SolveError::Library(error.to_string())
    }
}

/// Memory predicted by MUMPS [bytes].
///
/// # Errors
/// Out of memory, a dof without stiffness, or a missing library.
pub fn demand(equations: &Equations<'_>, method: MumpsMethod) -> Result<usize, SolveError> {
    let (matrix, _) = scaled(equations)?;
    Ok(mumps::demand(matrix, settings(method, 0.0))?)
}

fn settings(method: MumpsMethod, null_pivot: f64) -> Settings {
    Settings { out_of_core: method.out_of_core, null_pivot }
}

fn scaled(equations: &Equations<'_>) -> Result<(Coordinates, Vec<f64>), SolveError> {
    let Equations { mesh, matrices, supports, combination, .. } = *equations;
    let order = order(mesh, supports);
    let mut matrix = Coordinates { place: vec![0; order.len()], ..Coordinates::default() };
    order.iter().enumerate().for_each(|(i, &e)| matrix.place[e] = i as i32 + 1);
    let mut entries = 0;
    matrices.visit_free(supports, |_, _, _, _, _| entries += 1);
    (matrix.row, matrix.column) = (Vec::with_capacity(entries), Vec::with_capacity(entries));
    matrix.value = Vec::with_capacity(entries);
    let mut scale = vec![0.0; order.len()];
    let Combination { stiffness, mass, dashpots } = combination;
    matrices.visit_free(supports, |c, r, k, m, d| {
        let value = stiffness * k + mass * m + dashpots * d;
        matrix.row.push(r as i32 + 1);
        matrix.column.push(c as i32 + 1);
        matrix.value.push(value);
        if c == r {
            scale[c] = value;
        }
    });
    if let Some(equation) = scale.iter().position(|d| !(*d > 0.0 && d.is_finite())) {
        return Err(equations.no_stiffness(equation, 0.0));
    }
    scale.iter_mut().for_each(|d| *d = d.sqrt().recip());
    let Coordinates { row, column, value, .. } = &mut matrix;
    for (v, (r, c)) in value.iter_mut().zip(row.iter().zip(column.iter())) {
        *v *= scale[*r as usize - 1] * scale[*c as usize - 1];
    }
    Ok((matrix, scale))
}
