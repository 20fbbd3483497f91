//! The order of the exchange: which side goes first in a window, and on what motion of the surface the grains go.
//!
//! | scheme | surface in the window | solid's load | order |
//! |---|---|---|---|
//! | predicted (B) | x₀ + v₀ τ | mean contact force of the same window | grains, solid |
//! | lagged (A) | from x₀ to x₁, velocity from v₀ to v₁ | contact force of the window before, reached linearly | solid, grains |
//! | stiffened | x₀ + v̄ τ, v̄ from a solve with the contacts' stiffness in the matrix | as B | solve, grains, solid |
//! | iterated | x₀ + v̄ τ, v̄ the mean velocity that the solid then has | as B | both, again until v̄ repeats |
//!
//! In all but A the solid receives the impulse that the grains felt in the same window, so momentum is kept. Iterated to
//! the end, both sides also agree on the work of the interface. A is the order of Kratos and of the seed programs; it is
//! there for comparison.
//!
//! Source: Felippa, Park & Farhat, Comput. Methods Appl. Mech. Eng. 190 (2001) 3247 (staggered orders and their errors);
//! `docs/theory/coupling.md`, section 5.5, for the stable windows. Limits: the stiffened scheme needs a solid with a constant matrix.

use serde::{Deserialize, Serialize};

/// Order of the exchange.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scheme {
    /// Grains first on the predicted motion of the surface (B).
    #[default]
    Predicted,
    /// Solid first with the force of the window before (A).
    Lagged,
    /// As predicted, the prediction being a solve with the stiffness of the present contacts.
    Stiffened,
    /// The window is repeated until the motion of the surface repeats.
    Iterated {
        /// Largest change of the surface's mean velocity between two passes, relative to the largest such velocity.
        tolerance: f64,
        /// Passes at most.
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

/// How often windows were repeated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Passes {
    /// Windows done.
    pub windows: u64,
    /// Passes of the grains in all of them.
    pub passes: u64,
    /// Windows that kept changing up to the last pass allowed.
    pub unconverged: u64,
    /// Iterations of the stiffened solves.
    pub solves: u64,
}
