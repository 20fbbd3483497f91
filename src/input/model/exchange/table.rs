//! `[coupling]` resolved.

use super::class::WITH_SLEEPERS;
use super::{CouplingPart, TransferPlan, WindowPlan};
use crate::model::solid::SolidPart;
use crate::scene::coupling::{Coupling, FacesName, SchemeName, Substeps, TransferTable};
use crate::scene::{SceneError, Table};
use trackbed_coupling::scheme::Scheme;
use trackbed_coupling::surface::{SolidSurface, face_triangles};

const PASSES: u32 = 20;

const TOLERANCE: f64 = 1e-4;

/// Resolves `[coupling]`. `polyhedra`: in the model.
///
/// # Errors
/// Input errors.
pub fn build(c: &Table<Coupling>, solid: &SolidPart, polyhedra: bool) -> Result<CouplingPart, SceneError> {
    if polyhedra {
        beside_polyhedra(c, solid)?;
    }
    let window = window(c)?;
    let theta = c.theta.or(solid.sleepers.is_some().then_some(WITH_SLEEPERS));
    if let Some(theta) = theta.filter(|theta| !(0.5..=1.0).contains(theta)) {
        return Err(c.error("theta", theta.to_string(), "0.5 to 1"));
    }
    let scheme = scheme(c, solid)?;
    let transfer = transfer(c)?;
    if c.direction.iter().map(|d| d * d).sum::<f64>() <= 0.0 {
        return Err(c.error("direction", "the null vector", "a direction"));
    }
    if !(c.max_angle.si > 0.0 && c.max_angle.si <= std::f64::consts::PI) {
        return Err(c.error("max_angle", c.max_angle.si.to_string(), "above 0, at most pi"));
    }
    let mesh = solid.model.mesh();
    let ground = solid.sleepers.as_ref().map_or(mesh.element_count(), |s| s.ground_elements());
    let mut faces = SolidSurface::facing(mesh, c.direction, c.max_angle.si);
    faces.retain(|f| (f.element as usize) < ground);
    if faces.is_empty() {
        return Err(c.error("direction", "no boundary face that looks this way", "at least one"));
    }
    if polyhedra || c.faces == Some(FacesName::Flat) {
        faces = faces.iter().flat_map(face_triangles).collect();
    }
    let ground_faces = faces.len();
    if solid.sleepers.is_some() {
        // In element order, hence sleeper by sleeper.
        faces.extend(mesh.boundary_faces().into_iter().filter(|f| f.element as usize >= ground));
    }
    // Meshed sleepers have no automatic θ.
    let removable = c.theta.is_some() && solid.sleepers.is_none();
    Ok(CouplingPart { window, scheme, transfer, theta, removable, faces, ground_faces })
}

fn beside_polyhedra(c: &Table<Coupling>, solid: &SolidPart) -> Result<(), SceneError> {
    if c.faces == Some(FacesName::Curved) {
        let remedy = "Polyhedra contact flat triangles between the nodes";
        return Err(c.error("faces", "\"curved\" with polyhedra", "\"flat\"").remedy(remedy));
    }
    if c.scheme == SchemeName::Stiffened {
        let expected = "\"predicted\", \"lagged\" or \"iterated\"";
        return Err(c.error("scheme", "\"stiffened\" with polyhedra", expected));
    }
    if solid.sleepers.is_some() {
        return Err(c.here("polyhedra with meshed sleepers", "rigid sleepers, or another shape of grains"));
    }
    Ok(())
}

fn window(c: &Table<Coupling>) -> Result<WindowPlan, SceneError> {
    match (c.substeps.unwrap_or_default(), c.window) {
        (_, Some(_)) if c.substeps.is_some() => Err(c.conflict("window", "`substeps`")),
        (_, Some(window)) if window.si > 0.0 && window.si.is_finite() => Ok(WindowPlan::Seconds(window.si)),
        (_, Some(window)) => Err(c.error("window", window.si.to_string(), "a time above 0")),
        (Substeps::Auto, None) => Ok(WindowPlan::Auto),
        (Substeps::Count(n), None) if (1..=1000).contains(&n) => Ok(WindowPlan::Steps(n as u32)),
        (Substeps::Count(n), None) => Err(c.error("substeps", n.to_string(), "1 to 1000, or \"auto\"")),
    }
}

fn scheme(c: &Table<Coupling>, solid: &SolidPart) -> Result<Scheme, SceneError> {
    if c.scheme != SchemeName::Iterated {
        let idle = [("tolerance", c.tolerance.is_some()), ("max_passes", c.max_passes.is_some())];
        c.reject_without(idle, "`scheme = \"iterated\"`")?;
    }
    let others = "\"predicted\", \"lagged\" or \"iterated\"";
    Ok(match c.scheme {
        SchemeName::Predicted => Scheme::Predicted,
        SchemeName::Lagged => Scheme::Lagged,
        SchemeName::Stiffened => {
            if !solid.is_linear() {
                let found = "\"stiffened\" with a plastic solid or initial stress";
                return Err(c.error("scheme", found, others));
            }
            if solid.reduction.is_some() {
                return Err(c.error("scheme", "\"stiffened\" with [solid.reduction]", others));
            }
            Scheme::Stiffened
        }
        SchemeName::Iterated => {
            let tolerance = c.tolerance.unwrap_or(TOLERANCE);
            if !(tolerance > 0.0 && tolerance < 1.0) {
                let found = tolerance.to_string();
                return Err(c.error("tolerance", found, "above 0, below 1"));
            }
            let passes = c.max_passes.unwrap_or(PASSES);
            if !(2..=1000).contains(&passes) {
                return Err(c.error("max_passes", passes.to_string(), "2 to 1000"));
            }
            Scheme::Iterated { tolerance, passes }
        }
    })
}

fn transfer(c: &Table<Coupling>) -> Result<TransferPlan, SceneError> {
    let TransferTable::Spread(transfer) = &c.transfer else { return Ok(TransferPlan::Point) };
    let transfer = c.below("transfer", transfer);
    match (transfer.spread, transfer.spread_factor) {
        (Some(radius), None) if radius.si > 0.0 => Ok(TransferPlan::Disc(radius.si)),
        (Some(radius), None) => Err(transfer.error("spread", format!("{} m", radius.si), "a radius above 0")),
        (None, Some(factor)) if factor > 0.0 && factor <= 100.0 => Ok(TransferPlan::Part(factor)),
        (None, Some(factor)) => {
            Err(transfer.error("spread_factor", factor.to_string(), "above 0, at most 100"))
        }
        (spread, _) => Err(transfer.choice(["spread", "spread_factor"], spread.is_some())),
    }
}
