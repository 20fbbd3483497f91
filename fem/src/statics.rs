//! Statics: `K u = F` with prescribed displacements, and the reactions `R = K u - F` at the supports.
//!
//! Source: Zienkiewicz and Taylor, The Finite Element Method, vol. 1 (2000), section 1.6. A body with a free rigid motion
//! is refused from its geometry before factoring; a mechanism that only the stiffness shows (a hinge, a mode without
//! stiffness of the reduced rule) is found by its pivot. Each solution is checked against equilibrium and corrected
//! when rounding or the tolerance of an iteration shows. Limits: pivots below 1e-11 of the diagonal count as no stiffness, which also refuses bodies
//! so slender (some thousand elements in a single row) or so unlike in stiffness that few digits would be left.

use crate::assembly::Combination;
use crate::boundary::spring_points;
use crate::equations::method::Regime;
use crate::equations::system::{Counts, SystemSolver};
use crate::error::SolveError;
use crate::model::Model;
use crate::supports::name;

/// Residual over the largest force above which the solution is corrected by one more solve.
const IMPROVE: f64 = 1e-13;
/// Solves at most.
const CORRECTIONS: usize = 3;
/// Residual over the largest force above which the solution is refused, unless the tolerance of an iteration is larger.
const REFUSE: f64 = 1e-6;

/// A static solution. Shapes `[3 * nodes]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Static {
    /// Displacements [m].
    pub u: Vec<f64>,
    /// Forces of the supports on the body [N]; 0 at free dofs.
    pub reactions: Vec<f64>,
}

/// Holds the factor of the stiffness matrix, or what an iteration needs, for any number of loads.
pub struct StaticSolver {
    system: Box<dyn SystemSolver>,
    /// Residual over the largest force at which no correction follows.
    enough: f64,
    nodal: Vec<f64>,
    equations: Vec<f64>,
}

/// Checks, before any solve, that no body of the model can move as a rigid body.
///
/// # Errors
/// [`SolveError::NotHeld`] names a node and direction that can move freely.
pub fn check_held(model: &Model) -> Result<(), SolveError> {
    let springs = spring_points(model.mesh(), model.boundaries());
    match model.supports().free_motion_on_springs(model.mesh(), &springs) {
        None => Ok(()),
        Some((node, direction)) => {
            let (node, direction) = name(model.mesh(), 3 * node + direction);
            Err(SolveError::NotHeld { node, direction })
        }
    }
}

impl StaticSolver {
    /// Checks that the body is held, and factors its stiffness or sets up conjugate gradients with smoothed aggregation, as the
    /// model's [`methods`](Model::methods) say.
    ///
    /// # Errors
    /// [`SolveError::NotHeld`] or [`SolveError::NoStiffness`] name a node and direction that can move freely;
    /// [`SolveError::Plastic`] refuses a plastic material; [`SolveError::Library`] names the failure of a library.
    pub fn new(model: &Model) -> Result<StaticSolver, SolveError> {
        check_linear(model)?;
        check_held(model)?;
        let method = model.methods().statics;
        let system = method.solver(&model.equations(Combination::STIFFNESS), Regime::Statics)?;
        let enough = IMPROVE.max(100.0 * method.tolerance());
        let equations = vec![0.0; model.free_dof_count()];
        Ok(StaticSolver { system, enough, nodal: vec![0.0; model.dof_count()], equations })
    }

    /// Counts of conjugate gradients, where the model's [`methods`](Model::methods) say so.
    pub fn counts(&self) -> Option<Counts> {
        self.system.counts()
    }

    /// Memory of conjugate gradients or of a library beside that of the model [bytes].
    pub fn solver_memory(&self) -> Option<usize> {
        self.system.memory()
    }

    /// Displacements and reactions under `load` [N], shape `[3 * nodes]`, and the prescribed displacements of the model.
    ///
    /// # Errors
    /// A load of the wrong length or with values that are not finite, or a solution that misses equilibrium.
    pub fn solve(&mut self, model: &Model, load: &[f64]) -> Result<Static, SolveError> {
        self.solve_prescribed(model, load, None)
    }

    /// As [`StaticSolver::solve`], with other displacements [m] of the constrained dofs, in the order of
    /// [`crate::supports::Supports::fixed`].
    ///
    /// # Errors
    /// As [`StaticSolver::solve`], for the displacements too.
    pub fn solve_prescribed(
        &mut self,
        model: &Model,
        load: &[f64],
        prescribed: Option<&[f64]>,
    ) -> Result<Static, SolveError> {
        check_load(model, load, 0.0)?;
        check_prescribed(model, prescribed, 0.0)?;
        let supports = model.supports();
        let mut u = vec![0.0; model.dof_count()];
        for (i, &(dof, value)) in supports.fixed().iter().enumerate() {
            u[dof as usize] = prescribed.map_or(value, |p| p[i]);
        }
        let mut worst = (0, f64::INFINITY);
        for _ in 0..CORRECTIONS {
            worst = self.correct(model, load, &mut u)?;
            if worst.1 <= self.enough || worst.1.is_nan() {
                break;
            }
        }
        if worst.1.is_nan() || worst.1 > REFUSE.max(self.enough) {
            let (node, direction) = name(model.mesh(), worst.0);
            return Err(SolveError::Inaccurate { node, direction, residual: worst.1 });
        }
        let mut reactions = vec![0.0; u.len()];
        for &(dof, _) in supports.fixed() {
            reactions[dof as usize] = self.nodal[dof as usize] - load[dof as usize];
        }
        Ok(Static { u, reactions })
    }

    /// Adds the solution of `K du = F - K u` to u, leaves `K u` behind, and returns the dof and the size of the largest
    /// residual against the largest force.
    fn correct(&mut self, model: &Model, load: &[f64], u: &mut [f64]) -> Result<(usize, f64), SolveError> {
        let free = model.supports().free();
        model.stiffness_times(u, &mut self.nodal);
        for (slot, &dof) in self.equations.iter_mut().zip(free) {
            *slot = load[dof as usize] - self.nodal[dof as usize];
        }
        self.system.solve(model.supports(), &mut self.equations, &|_| 0.0)?;
        for (du, &dof) in self.equations.iter().zip(free) {
            u[dof as usize] += du;
        }
        model.stiffness_times(u, &mut self.nodal);
        let size = load.iter().chain(&self.nodal).fold(f64::MIN_POSITIVE, |m, f| m.max(f.abs()));
        let mut worst = (0, 0.0);
        for &dof in free {
            let residual = (load[dof as usize] - self.nodal[dof as usize]).abs() / size;
            if residual.is_nan() || residual > worst.1 {
                worst = (dof as usize, residual);
            }
        }
        Ok(worst)
    }
}

/// One static solution: builds a [`StaticSolver`], uses it once.
///
/// # Errors
/// As [`StaticSolver::new`] and [`StaticSolver::solve`].
pub fn solve(model: &Model, load: &[f64]) -> Result<Static, SolveError> {
    StaticSolver::new(model)?.solve(model, load)
}

/// A linear solver must not be given a plastic material.
pub(crate) fn check_linear(model: &Model) -> Result<(), SolveError> {
    model.plastic_material().map_or(Ok(()), |material| Err(SolveError::Plastic { material }))
}

/// A load must have a finite value for every dof.
pub(crate) fn check_load(model: &Model, load: &[f64], time: f64) -> Result<(), SolveError> {
    if load.len() != model.dof_count() {
        return Err(SolveError::Length { what: "load", found: load.len(), expected: model.dof_count() });
    }
    check_finite(model, "the load", load, time)
}

/// Prescribed displacements must have a finite value for every constrained dof.
pub(crate) fn check_prescribed(
    model: &Model,
    prescribed: Option<&[f64]>,
    time: f64,
) -> Result<(), SolveError> {
    let (Some(values), fixed) = (prescribed, model.supports().fixed()) else { return Ok(()) };
    let what = "prescribed displacement";
    if values.len() != fixed.len() {
        return Err(SolveError::Length { what, found: values.len(), expected: fixed.len() });
    }
    match values.iter().position(|v| !v.is_finite()) {
        Some(i) => {
            let (node, direction) = name(model.mesh(), fixed[i].0 as usize);
            Err(SolveError::NotFinite { what, node, direction, time })
        }
        None => Ok(()),
    }
}

/// Names the first value that is not finite.
pub(crate) fn check_finite(
    model: &Model,
    what: &'static str,
    x: &[f64],
    time: f64,
) -> Result<(), SolveError> {
    match x.iter().position(|v| !v.is_finite()) {
        Some(dof) => {
            let (node, direction) = name(model.mesh(), dof);
            Err(SolveError::NotFinite { what, node, direction, time })
        }
        None => Ok(()),
    }
}
