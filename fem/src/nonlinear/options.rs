//! Options of the Newton iteration.

use crate::error::SolveError;
use serde::{Deserialize, Serialize};

/// Matrix after the first iteration of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Variant {
    /// Consistent tangent in every iteration.
    Full,
    /// Tangent after the first iteration, updated every n further ones (0: never).
    Modified(u32),
    /// Elastic matrix: one factor, linear convergence.
    InitialStiffness,
}

/// Solver of unsymmetric systems.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LinearMethod {
    /// L U up to 30,000 free dofs, then GMRES.
    #[default]
    Auto,
    /// L U.
    Direct,
    /// GMRES with the elastic factor.
    Krylov,
}

/// Options of the iteration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NewtonOptions {
    /// Iteration matrix.
    pub variant: Variant,
    /// Line search.
    pub line_search: bool,
    /// Relative force residual [-].
    pub force_tolerance: f64,
    /// Work of the last correction over the largest in the step [-].
    pub energy_tolerance: f64,
    /// Iteration limit of a step.
    pub max_iterations: u32,
    /// Solver of unsymmetric systems.
    pub linear: LinearMethod,
}

impl NewtonOptions {
    /// Default options: tolerances 1e-6 and 1e-8, line search, 50 (full), 60 (modified) or 400 (elastic)
    /// iterations.
    pub fn new(variant: Variant) -> NewtonOptions {
        let max_iterations = match variant {
            Variant::Full => 50,
            Variant::Modified(_) => 60,
            Variant::InitialStiffness => 400,
        };
        NewtonOptions {
            variant,
            line_search: true,
            force_tolerance: 1e-6,
            energy_tolerance: 1e-8,
            max_iterations,
            linear: LinearMethod::Auto,
        }
    }

    /// Checks for positive tolerances and iterations.
    ///
    /// # Errors
    /// [`SolveError::Option`].
    pub fn check(&self) -> Result<(), SolveError> {
        for (what, value) in
            [("the force tolerance", self.force_tolerance), ("the energy tolerance", self.energy_tolerance)]
        {
            if !(value > 0.0 && value < 1.0) {
                return Err(SolveError::Option { what, value, expected: "a number between 0 and 1" });
            }
        }
        if self.max_iterations == 0 {
            return Err(SolveError::Option {
                what: "the limit of iterations",
                value: 0.0,
                expected: "1 or more",
            });
        }
        Ok(())
    }
}

impl Default for NewtonOptions {
    fn default() -> Self {
        NewtonOptions::new(Variant::Full)
    }
}
