//! What the model of the grains refuses, in words of the scene.

use crate::scene::{Document, SceneError};
use trackbed_dem::ModelError;

/// What is wrong with the grains as a whole, which shows only when their model is made.
pub fn refused(document: &Document, error: &ModelError) -> SceneError {
    match error {
        ModelError::TimeStep { dt, limit, cause } => {
            let expected =
                format!("at most {limit:.6e} s, set by {cause}, or `accept_step_above_limit = true`");
            document.error("time.grain_step", format!("{dt} s"), expected)
        }
        ModelError::NotFinite { quantity } => document.beyond_range(&format!("the {quantity} of the grains")),
        ModelError::RigidPair { a, b } => {
            let found = format!("no stiffness for {a} against {b}, which may touch");
            document.error("material", found, "`stiffness` for one of their materials, or for the pair")
        }
        ModelError::Wall { wall, problem } => {
            document.error("walls", format!("{wall}: {problem}"), "walls that can be built")
        }
        ModelError::Adhesion { index, with } => document.error(
            &format!("contact.{index}.adhesion"),
            format!("adhesion beside {with}"),
            "no adhesion in such a scene",
        ),
        ModelError::Periodic { problem } => {
            document.error("periodic", problem, "axes that the rest of the scene can be periodic along")
        }
        ModelError::Bond { .. } | ModelError::BondKind { .. } => {
            document.error("bond", error.to_string(), "bonds that can be made")
        }
        other => document.error("grains", other.to_string(), "grains and walls that make a model"),
    }
}
