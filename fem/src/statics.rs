//! Statics: `K u = F`, reactions `R = K u - F`.
//!
//! Source: Zienkiewicz and Taylor (2000), vol. 1, section 1.6. Rigid-body motion is detected from geometry,
//! mechanisms from pivots. Limits: relative pivots below 1e-11 are rejected, also for very slender bodies.

use crate::assembly::Combination;
use crate::boundary::spring_points;
use crate::equations::method::Regime;
use crate::equations::system::{IterationCounts, SystemSolver};
use crate::error::SolveError;
use crate::model::Model;
use crate::supports::name;

/// Relative residual that requires correction.
const REFINEMENT_THRESHOLD: f64 = 1e-13;
const CORRECTIONS: usize = 3;
/// Largest accepted relative residual.
const MAX_RESIDUAL: f64 = 1e-6;

/// Static solution. Shapes `[3 * nodes]`.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticSolution {
    /// Displacements [m].
    pub u: Vec<f64>,
    /// Support reactions [N]; 0 at free dofs.
    pub reactions: Vec<f64>,
}

/// Static solver for any number of loads.
pub struct StaticSolver {
    system: Box<dyn SystemSolver>,
    refine_below: f64,
    nodal: Vec<f64>,
    equations: Vec<f64>,
}

/// Checks all bodies for rigid-body motion.
///
/// # Errors
/// [`SolveError::RigidBodyMotion`] with a free node and direction.
pub fn check_rigid_body_motion(model: &Model) -> Result<(), SolveError> {
    let springs = spring_points(model.mesh(), model.boundaries());
    match model.supports().rigid_body_motion_on_springs(model.mesh(), &springs) {
        None => Ok(()),
        Some((node, direction)) => {
            let (node, direction) = name(model.mesh(), 3 * node + direction);
            Err(SolveError::RigidBodyMotion { node, direction })
        }
    }
}

impl StaticSolver {
    /// Checks the constraints and prepares the solver of [`methods`](Model::methods).
    ///
    /// # Errors
    /// [`SolveError::RigidBodyMotion`] or [`SolveError::NoStiffness`]; [`SolveError::Plastic`];
    /// [`SolveError::Library`].
    pub fn new(model: &Model) -> Result<StaticSolver, SolveError> {
        check_linear(model)?;
        check_rigid_body_motion(model)?;
        let method = model.methods().statics;
        let system = method.solver(&model.equations(Combination::STIFFNESS), Regime::Statics)?;
        let refine_below = REFINEMENT_THRESHOLD.max(100.0 * method.tolerance());
        let equations = vec![0.0; model.free_dof_count()];
        Ok(StaticSolver { system, refine_below, nodal: vec![0.0; model.dof_count()], equations })
    }

    /// CG counts, if selected.
    pub fn counts(&self) -> Option<IterationCounts> {
        self.system.counts()
    }

    /// Additional solver memory [bytes].
    pub fn solver_memory(&self) -> Option<usize> {
        self.system.memory()
    }

    /// Solves for displacements and reactions under `load` [N], shape `[3 * nodes]`.
    ///
    /// # Errors
    /// Load of wrong length or not finite; equilibrium not satisfied.
    pub fn solve(&mut self, model: &Model, load: &[f64]) -> Result<StaticSolution, SolveError> {
        self.solve_prescribed(model, load, None)
    }

    /// Like [`StaticSolver::solve`], with displacements [m] ordered as [`crate::supports::Supports::fixed`].
    ///
    /// # Errors
    /// As [`StaticSolver::solve`].
    pub fn solve_prescribed(
        &mut self,
        model: &Model,
        load: &[f64],
        prescribed: Option<&[f64]>,
    ) -> Result<StaticSolution, SolveError> {
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
            if worst.1 <= self.refine_below || worst.1.is_nan() {
                break;
            }
        }
        if worst.1.is_nan() || worst.1 > MAX_RESIDUAL.max(self.refine_below) {
            let (node, direction) = name(model.mesh(), worst.0);
            return Err(SolveError::Inaccurate { node, direction, residual: worst.1 });
        }
        let mut reactions = vec![0.0; u.len()];
        for &(dof, _) in supports.fixed() {
            reactions[dof as usize] = self.nodal[dof as usize] - load[dof as usize];
        }
        Ok(StaticSolution { u, reactions })
    }

    /// Returns dof and size of the largest relative residual of `F - K u`.
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

/// Solves once with a new [`StaticSolver`].
///
/// # Errors
/// As [`StaticSolver::new`] and [`StaticSolver::solve`].
pub fn solve(model: &Model, load: &[f64]) -> Result<StaticSolution, SolveError> {
    StaticSolver::new(model)?.solve(model, load)
}

pub(crate) fn check_linear(model: &Model) -> Result<(), SolveError> {
    model.plastic_material().map_or(Ok(()), |material| Err(SolveError::Plastic { material }))
}

pub(crate) fn check_load(model: &Model, load: &[f64], time: f64) -> Result<(), SolveError> {
    if load.len() != model.dof_count() {
        return Err(SolveError::Length { what: "load", found: load.len(), expected: model.dof_count() });
    }
    check_finite(model, "the load", load, time)
}

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
