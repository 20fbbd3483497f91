//! Model errors in terms of scene keys.

use crate::scene::{Document, Problem, SceneError};
use trackbed_dem::ModelError;

/// Converts a model error into an input error.
pub fn refused(document: &Document, error: &ModelError) -> SceneError {
    match error {
        ModelError::TimeStep { dt, limit, cause } => {
            let expected =
                format!("at most {limit:.6e} s, set by {cause}, or `accept_step_above_limit = true`");
            document.error("time.grain_step", format!("{dt} s"), expected)
        }
        ModelError::NotFinite { quantity } => document.beyond_range(&format!("the {quantity} of the grains")),
        ModelError::RigidPair { a, b } => {
            let found = format!("no stiffness for {a} against {b}, which can be in contact");
            document.error("material", found, "`stiffness` for one of their materials, or for the pair")
        }
        ModelError::Wall { wall, problem } => {
            document.error("walls", format!("{wall}: {problem}"), "valid walls")
        }
        ModelError::Adhesion { index, with } => {
            document.problem(&format!("contact.{index}.adhesion"), Problem::conflict(*with))
        }
        ModelError::Periodic { problem } => {
            document.error("periodic", problem, "axes along which the scene can be periodic")
        }
        ModelError::Bond { .. } | ModelError::BondKind { .. } => {
            document.error("bond", error.to_string(), "valid bonds")
        }
        other => document.error("grains", other.to_string(), "valid grains and walls"),
    }
}
