//! Model features supported by ranks.

use crate::engine::model::Model;

/// Name of an unsupported feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("not supported with several ranks: {0}")]
pub struct Unsupported(pub &'static str);

/// Checks that ranks support all features of a model.
///
/// # Errors
/// [`Unsupported`] for the first unsupported feature.
pub fn check(model: &Model) -> Result<(), Unsupported> {
    let all = [
        (model.solids, "boxes and polyhedra"),
        (model.surface_material.is_some(), "contacts with a solid"),
        (model.periodic.is_some(), "periodic borders"),
    ];
    match all.into_iter().find(|(there, _)| *there) {
        Some((_, name)) => Err(Unsupported(name)),
        None => Ok(()),
    }
}
