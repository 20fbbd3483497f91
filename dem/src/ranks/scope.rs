//! What ranks compute: models with anything else are refused by name.

use crate::engine::model::Model;

/// What a model has and ranks do not share.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("not supported with several ranks: {0}")]
pub struct Unsupported(pub &'static str);

/// Whether ranks share all that a model has.
///
/// # Errors
/// [`Unsupported`] names the first thing that they do not.
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
