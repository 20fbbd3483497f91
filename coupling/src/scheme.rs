//! Coupling schemes.
//!
//! | scheme | surface in the window | FEM load | order |
//! |---|---|---|---|
//! | predicted | x₀ + v₀ τ | mean contact force | DEM, FEM |
//! | lagged | from x₀ to x₁, velocity from v₀ to v₁ | previous contact force, reached linearly | FEM, DEM |
//! | stiffened | x₀ + v̄ τ, v̄ from a solve with contact stiffness | as predicted | solve, DEM, FEM |
//! | iterated | x₀ + v̄ τ, v̄ the computed mean | as predicted | both, repeated |
//!
//! All but lagged conserve momentum. Felippa, Park & Farhat, Comput. Methods Appl. Mech. Eng. 190 (2001)
//! 3247; stability: Theory manual, section 5.5.

use serde::{Deserialize, Serialize};

/// Coupling scheme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// Staggered with predictor.
    #[default]
    Predicted,
    /// Conventional serial staggered: FEM first.
    Lagged,
    /// Semi-implicit: current contact stiffness in the predictor.
    Stiffened,
    /// Strong coupling: windows repeat until the surface motion converges.
    Iterated {
        /// Relative tolerance of the surface's mean velocity.
        tolerance: f64,
        /// Maximum number of passes.
        passes: u32,
    },
}

impl std::fmt::Display for Scheme {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Scheme::Predicted => f.write_str("predicted"),
            Scheme::Lagged => f.write_str("lagged"),
            Scheme::Stiffened => f.write_str("stiffened"),
            Scheme::Iterated { tolerance, passes } => {
                write!(f, "iterated to {tolerance:e}, at most {passes} passes")
            }
        }
    }
}

/// Counts of repeated windows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct IterationStats {
    /// Completed windows.
    pub windows: u64,
    /// DEM passes.
    pub passes: u64,
    /// Unconverged windows.
    pub unconverged: u64,
    /// Iterations of the stiffened solves.
    pub solves: u64,
}
