//! Reduced basis of a solid under grains.

use crate::context::Run;
use crate::device::Steps;
use crate::summary::Summary;
use std::sync::Arc;
use trackbed_coupling::step::{Model, State, Work};
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_fem as fem;
use trackbed_fem::mesh::Face;
use trackbed_fem::reduction::{Cost, ReducedModel};
use trackbed_input::model::solid::SolidPart;
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_io::progress::Verbosity;

/// Floating-point operations in the time of one value read.
const OPERATIONS: f64 = 10.0;

/// Switches to a reduced basis if the scene has one.
///
/// # Errors
/// The solid cannot be reduced.
pub fn reduce(
    run: &Run<'_>,
    solid: &SolidPart,
    (model, state): (&Model<'_>, &mut State),
    work: &mut Work<Steps>,
    summary: &mut Summary,
) -> Result<(), Failure> {
    let Some(reduction) = solid.reduction else { return Ok(()) };
    if state.loaded_faces.is_empty() {
        state.loaded_faces = faces_near_grains(model, &state.grains, &work.surface);
    }
    let faces = work.surface.faces();
    let loaded: Vec<Face> = state.loaded_faces.iter().map(|&f| faces[f as usize]).collect();
    let cost = ReducedModel::cost(model.solid, faces, &loaded, reduction).ok();
    let slower = cost.filter(|c| c.reduced > c.full).map(|c| {
        format!(
            "solid.reduction: {} modes make an FEM step about {:.1}× slower ({:.1} instead of {:.1} million numbers read). Remove it, or set kind = \"modes\".",
            c.shapes,
            c.reduced / c.full,
            1e-6 * c.reduced,
            1e-6 * c.full
        )
    });
    if run.verbosity > Verbosity::Quiet {
        slower.iter().for_each(|r| message::warn(r));
    }
    summary.warnings.extend(slower);
    let reduced = ReducedModel::new(model.solid, faces, &loaded, reduction)
        .map_err(|e| Failure::from(run.document.error("solid.reduction", e.to_string(), "another choice")))?;
    work.reduce(model, Arc::new(reduced)).map_err(|e| solid.failure(&e))?;
    summary.model.reduction = work.reduction();
    Ok(())
}

/// Steps of the full solid in the time of as many `windows` of a reduced one and of making its basis.
pub fn full_steps(solid: &SolidPart, faces: &[Face], loaded: &[Face], windows: f64) -> f64 {
    let cost = solid.reduction.and_then(|r| ReducedModel::cost(&solid.model, faces, loaded, r).ok());
    cost.map_or(windows, |c| (windows * c.reduced + making(&c, &solid.model)) / c.full)
}

/// Values read in the time in which the basis is made: static answers, dense products, eigenvalues.
fn making(cost: &Cost, model: &fem::Model) -> f64 {
    let shapes = cost.shapes as f64;
    let products = 12.0 * model.dof_count() as f64 * shapes.powi(2) + 30.0 * shapes.powi(3);
    2.0 * shapes * cost.full + products / OPERATIONS
}

/// Faces that grains touch or may soon touch, from half a face away. All, if there is none.
fn faces_near_grains(model: &Model<'_>, grains: &dem::State, surface: &SolidSurface) -> Vec<u32> {
    let (mesh, all) = (model.solid.mesh(), 0..surface.faces().len() as u32);
    let bodies: Vec<usize> = (0..model.grains.body_count()).filter(|&b| grains.present(b)).collect();
    let near = |face: &u32| {
        let face = &surface.faces()[*face as usize];
        let centre = face.centre(mesh);
        let away = |x: [f64; 3]| (0..3).map(|d| (x[d] - centre[d]).powi(2)).sum::<f64>().sqrt();
        let size = face.corners().iter().map(|&n| away(mesh.coordinates[n as usize])).fold(0.0, f64::max);
        bodies.iter().any(|&b| away(grains.position(b).into()) < 1.5 * size + model.grains.radius(b))
    };
    let found: Vec<u32> = all.clone().filter(near).collect();
    if found.is_empty() { all.collect() } else { found }
}
