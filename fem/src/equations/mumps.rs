//! The equations of a model by the library MUMPS: a factor of `S A S`, A = k K + m M + d D on the free dofs, S the root of the inverse
//! diagonal, in the order of elimination of the mesh.
//!
//! The scaled diagonal is 1, so that pivots that count as zero are shares of their diagonal.
//!
//! Limits: the factor is made anew with its analysis for each combination; a pivot near zero is reported with its node and direction, a
//! negative one without.

use super::method::MumpsMethod;
use super::pattern::order;
use super::system::{Equations, SystemSolver};
use crate::assembly::Combination;
use crate::error::SolveError;
use crate::solver::mumps::{self, Coordinates, MumpsError, Settings};
use crate::supports::Supports;

/// A factor of MUMPS, ready to solve.
pub struct Factor {
    factor: mumps::Factor,
    /// Root of the inverse diagonal. Shape `[equations]`.
    scale: Vec<f64>,
}

impl Factor {
    /// Factors a combination; pivots below `null_pivot` of their diagonal count as zero.
    ///
    /// # Errors
    /// [`SolveError::NoStiffness`] names the node and direction of a pivot that is zero, [`SolveError::Singular`] says that one is
    /// negative, [`SolveError::Library`] any other failure of the library, or that the program was built without it.
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

    /// The largest memory that MUMPS has taken while it factored, the entries of the matrix as given included.
    fn memory(&self) -> Option<usize> {
        Some(self.factor.memory())
    }
}

impl From<MumpsError> for SolveError {
    fn from(error: MumpsError) -> SolveError {
        SolveError::Library(error.to_string())
    }
}

/// Memory that MUMPS expects to take for the equations, their entries included [bytes].
///
/// # Errors
/// No memory, no stiffness at a dof, or a program that was built without the library.
pub fn demand(equations: &Equations<'_>, method: MumpsMethod) -> Result<usize, SolveError> {
    let (matrix, _) = scaled(equations)?;
    Ok(mumps::demand(matrix, settings(method, 0.0))?)
}

fn settings(method: MumpsMethod, null_pivot: f64) -> Settings {
    Settings { out_of_core: method.out_of_core, null_pivot }
}

/// The scaled matrix and its scale.
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
