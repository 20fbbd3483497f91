//! Errors of a reduction: estimated beforehand, found in a run.

use super::{ReducedModel, ReductionError};
use crate::error::SolveError;
use crate::loads;
use crate::mesh::Face;
use crate::modal::Modes;
use crate::model::Model;
use crate::statics::StaticSolver;
use serde::{Deserialize, Serialize};
use std::fmt;

const RIGHT: f64 = 0.01;

/// Errors of the reduced against the full solid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Free dofs of the full solid.
    pub dofs: usize,
    /// Basis vectors.
    pub shapes: usize,
    /// Relative loss of mean deflection under uniform surface pressure [-].
    pub pressure: f64,
    /// Relative loss of deflection under vertical point forces at corner, mid-side and centre of the central
    /// face [-].
    pub point: [f64; 3],
    /// Relative excess of the lowest natural frequency [-].
    pub lowest: f64,
    /// Frequency up to which errors are at most 1 % [Hz]; 0 if none.
    pub right_up_to: f64,
    /// Whether all compared modes are accurate.
    pub open: bool,
}

impl Estimate {
    pub(super) fn of_frequencies(model: &Model, square: &[f64], natural: &Modes) -> Estimate {
        let excess = |k: usize| (square[k].sqrt() / natural.circular[k] - 1.0).abs();
        let compared = natural.circular.len().min(square.len());
        let right = (0..compared).take_while(|&k| excess(k) <= RIGHT).count();
        Estimate {
            dofs: model.free_dof_count(),
            shapes: square.len(),
            lowest: if compared > 0 { excess(0) } else { 0.0 },
            right_up_to: if right > 0 { natural.frequencies[right - 1] } else { 0.0 },
            open: right == compared,
            ..Estimate::default()
        }
    }

    /// 1 − reduced/full.
    pub(super) fn static_errors(
        &mut self,
        model: &Model,
        faces: &[Face],
        solver: &mut StaticSolver,
        basis: &ReducedModel,
    ) -> Result<(), ReductionError> {
        let zero = vec![0.0; model.supports().fixed().len()];
        let mut lost = |load: &[f64]| -> Result<f64, ReductionError> {
            let u = solver.solve_prescribed(model, load, Some(&zero))?.u;
            let full: f64 = load.iter().zip(&u).map(|(f, u)| f * u).sum();
            let forces = basis.project(load);
            let reduced: f64 = forces.iter().zip(&basis.square).map(|(q, s)| q * q / s).sum();
            Ok(if full > 0.0 { 1.0 - reduced / full } else { 0.0 })
        };
        let mut load = vec![0.0; model.dof_count()];
        faces.iter().for_each(|f| loads::face_pressure(model.mesh(), f, 1.0, &mut load));
        self.pressure = lost(&load)?;
        let centres: Vec<[f64; 3]> = faces.iter().map(|f| f.centre(model.mesh())).collect();
        let middle: [f64; 3] =
            std::array::from_fn(|d| centres.iter().map(|c| c[d]).sum::<f64>() / centres.len() as f64);
        let away = |c: &[f64; 3]| (0..3).map(|d| (c[d] - middle[d]).powi(2)).sum::<f64>();
        let nearest = (0..faces.len()).min_by(|&a, &b| away(&centres[a]).total_cmp(&away(&centres[b])));
        if let Some(face) = nearest {
            for (error, xi) in self.point.iter_mut().zip([[-1.0, -1.0], [0.0, -1.0], [0.0, 0.0]]) {
                load.fill(0.0);
                loads::face_point_load(&faces[face], xi, [0.0, 0.0, -1.0], &mut load);
                *error = lost(&load)?;
            }
        }
        Ok(())
    }
}

impl fmt::Display for Estimate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |x: f64| 100.0 * x.max(0.0);
        write!(
            f,
            "{} shapes for {} dofs; deflection lost under a uniform pressure {:.2} %, under a point force {:.1}, {:.1}, {:.1} % \
             (corner, side, middle of a face); lowest frequency {:+.2} %, within 1 % up to {:.1} Hz{}",
            self.shapes,
            self.dofs,
            percent(self.pressure),
            percent(self.point[0]),
            percent(self.point[1]),
            percent(self.point[2]),
            100.0 * self.lowest,
            self.right_up_to,
            if self.open { " or more" } else { "" }
        )
    }
}

/// Force that the basis of a reduced solid leaves unbalanced in a step.
pub struct OutOfBalance {
    /// `F - M a - C v - K u` at free dofs [N]. Shape `[3 * nodes]`.
    pub force: Vec<f64>,
    /// Mean displacement in the step, from the start of the motion [m]. Shape `[3 * nodes]`.
    pub moved: Vec<f64>,
}

/// Largest errors of a reduced solid found in a run: the static answer to what its basis leaves unbalanced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FoundError {
    /// Steps examined.
    pub steps: u64,
    /// Largest error of a displacement [m].
    pub displacement: f64,
    /// Largest displacement from the start of the motion, with the error [m].
    pub largest_displacement: f64,
    /// Largest strain energy of the error [J].
    pub energy: f64,
    /// Largest strain energy of these displacements [J].
    pub largest_energy: f64,
}

impl FoundError {
    /// Examines a step.
    ///
    /// # Errors
    /// As [`StaticSolver::solve_prescribed`].
    pub fn add(
        &mut self,
        model: &Model,
        solver: &mut StaticSolver,
        step: &OutOfBalance,
    ) -> Result<(), SolveError> {
        let still = vec![0.0; model.supports().fixed().len()];
        let error = solver.solve_prescribed(model, &step.force, Some(&still))?.u;
        let corrected: Vec<f64> = step.moved.iter().zip(&error).map(|(x, e)| x + e).collect();
        let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let energy = |x: &[f64]| 0.5 * model.matrices().stiffness_form(x);
        self.steps += 1;
        self.displacement = self.displacement.max(largest(&error));
        self.largest_displacement = self.largest_displacement.max(largest(&corrected));
        self.energy = self.energy.max(energy(&error));
        self.largest_energy = self.largest_energy.max(energy(&corrected));
        Ok(())
    }

    /// Error of the displacement over the largest displacement [-].
    pub fn of_displacement(&self) -> f64 {
        ratio(self.displacement, self.largest_displacement)
    }

    /// Error of the stress over the largest stress, in the energy norm [-].
    pub fn of_stress(&self) -> f64 {
        ratio(self.energy, self.largest_energy).sqrt()
    }
}

fn ratio(error: f64, of: f64) -> f64 {
    if of > 0.0 { error / of } else { 0.0 }
}
