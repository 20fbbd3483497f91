//! Model features supported by a device.

use crate::bodies::table::BodyKind;
use crate::engine::model::Model;

/// Name of an unsupported feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("not supported on a GPU: {0}")]
pub struct Unsupported(pub &'static str);

/// Checks that a device supports all features of a model.
///
/// # Errors
/// [`Unsupported`] for the first unsupported feature.
pub fn check(model: &Model) -> Result<(), Unsupported> {
    let bodies = || 0..model.body_count();
    let solid = |k: usize| model.body(k).kind == BodyKind::Solid;
    // Rotation about some axes only requires solving a system of equations.
    let about_some = |k: usize| {
        let fixed = model.body(k).fixed >> 3;
        model.body(k).kind == BodyKind::Clump && fixed != 0 && fixed != 7
    };
    let all = [
        (bodies().any(about_some), "clumps that rotate about some axes only"),
        (model.solids && bodies().all(solid), "scenes of boxes and polyhedra only"),
        (model.solids && !model.bonds.is_empty(), "bonds in scenes with boxes or polyhedra"),
        (model.solids && model.periodic.is_some(), "boxes and polyhedra across periodic boundaries"),
        (
            model.periodic.is_some()
                && !(model.walls.walls.is_empty()
                    && model.bonds.is_empty()
                    && model.surface_material.is_none()),
            "walls, solids and bonds with periodic boundaries",
        ),
        (model.scarred, "scarring of walls"),
        (!model.body_forces.is_empty(), "body forces other than gravity"),
    ];
    match all.into_iter().find(|(there, _)| *there) {
        Some((_, name)) => Err(Unsupported(name)),
        None => Ok(()),
    }
}
