//! `[coupling]` resolved.

use super::class::WITH_SLEEPERS;
use super::{CouplingPart, TransferPlan, WindowPlan};
use crate::model::solid::SolidPart;
use crate::scene::coupling::{Coupling, SchemeName, Substeps, TransferTable};
use crate::scene::{Document, SceneError};
use trackbed_coupling::scheme::Scheme;
use trackbed_coupling::surface::SolidSurface;

/// Passes of the iterated scheme, unless the scene says otherwise.
const PASSES: u32 = 20;

/// Tolerance of the iterated scheme, unless the scene says otherwise.
const TOLERANCE: f64 = 1e-4;

/// Resolves `[coupling]`.
///
/// # Errors
/// Bad input.
pub fn build(document: &Document, c: &Coupling, solid: &SolidPart) -> Result<CouplingPart, SceneError> {
    let window = window(document, c)?;
    let theta = c.theta.unwrap_or(if solid.sleepers.is_some() { WITH_SLEEPERS } else { 0.5 });
    if !(0.5..=1.0).contains(&theta) {
        return Err(document.error("coupling.theta", theta.to_string(), "0.5 to 1"));
    }
    let scheme = scheme(document, c, solid)?;
    let transfer = transfer(document, c)?;
    if c.direction.iter().map(|d| d * d).sum::<f64>() <= 0.0 {
        return Err(document.error("coupling.direction", "the null vector", "a direction"));
    }
    if !(c.max_angle.si > 0.0 && c.max_angle.si <= std::f64::consts::PI) {
        return Err(document.error("coupling.max_angle", c.max_angle.si.to_string(), "above 0, at most pi"));
    }
    let mesh = solid.model.mesh();
    let ground = solid.sleepers.as_ref().map_or(mesh.element_count(), |s| s.ground_elements());
    let mut faces = SolidSurface::facing(mesh, c.direction, c.max_angle.si);
    faces.retain(|f| (f.element as usize) < ground);
    if faces.is_empty() {
        return Err(document.error(
            "coupling.direction",
            "no boundary face that looks this way",
            "at least one",
        ));
    }
    let ground_faces = faces.len();
    if solid.sleepers.is_some() {
        // On all sides: in the order of their elements, so sleeper by sleeper.
        faces.extend(mesh.boundary_faces().into_iter().filter(|f| f.element as usize >= ground));
    }
    Ok(CouplingPart { window, scheme, transfer, theta, faces, ground_faces })
}

/// How long a step of the solid is.
fn window(document: &Document, c: &Coupling) -> Result<WindowPlan, SceneError> {
    match (c.substeps.unwrap_or_default(), c.window) {
        (_, Some(_)) if c.substeps.is_some() => {
            Err(document.error("coupling.window", "a value", "no such key beside `substeps`"))
        }
        (_, Some(window)) if window.si > 0.0 && window.si.is_finite() => Ok(WindowPlan::Seconds(window.si)),
        (_, Some(window)) => Err(document.error("coupling.window", window.si.to_string(), "a time above 0")),
        (Substeps::Auto, None) => Ok(WindowPlan::Auto),
        (Substeps::Count(n), None) if (1..=1000).contains(&n) => Ok(WindowPlan::Steps(n as u32)),
        (Substeps::Count(n), None) => {
            Err(document.error("coupling.substeps", n.to_string(), "1 to 1000, or \"auto\""))
        }
    }
}

fn scheme(document: &Document, c: &Coupling, solid: &SolidPart) -> Result<Scheme, SceneError> {
    if c.scheme != SchemeName::Iterated {
        for (key, present) in [("tolerance", c.tolerance.is_some()), ("max_passes", c.max_passes.is_some())] {
            if present {
                let expected = "no such key but with scheme = \"iterated\"";
                return Err(document.error(&format!("coupling.{key}"), "a value", expected));
            }
        }
    }
    Ok(match c.scheme {
        SchemeName::Predicted => Scheme::Predicted,
        SchemeName::Lagged => Scheme::Lagged,
        SchemeName::Stiffened => {
            if !solid.is_linear() {
                let expected = "another scheme for a plastic solid or one with initial stress: this one needs a constant matrix";
                return Err(document.error("coupling.scheme", "\"stiffened\"", expected));
            }
            if solid.reduction.is_some() {
                let expected = "another scheme beside [solid.reduction]: this one needs the whole matrix";
                return Err(document.error("coupling.scheme", "\"stiffened\"", expected));
            }
            Scheme::Stiffened
        }
        SchemeName::Iterated => {
            let tolerance = c.tolerance.unwrap_or(TOLERANCE);
            if !(tolerance > 0.0 && tolerance < 1.0) {
                let found = tolerance.to_string();
                return Err(document.error("coupling.tolerance", found, "above 0, below 1"));
            }
            let passes = c.max_passes.unwrap_or(PASSES);
            if !(2..=1000).contains(&passes) {
                return Err(document.error("coupling.max_passes", passes.to_string(), "2 to 1000"));
            }
            Scheme::Iterated { tolerance, passes }
        }
    })
}

fn transfer(document: &Document, c: &Coupling) -> Result<TransferPlan, SceneError> {
    let TransferTable::Spread(table) = c.transfer else { return Ok(TransferPlan::Point) };
    match (table.spread, table.spread_factor) {
        (Some(radius), None) if radius.si > 0.0 => Ok(TransferPlan::Disc(radius.si)),
        (Some(radius), None) => {
            Err(document.error("coupling.transfer.spread", format!("{} m", radius.si), "a radius above 0"))
        }
        (None, Some(factor)) if factor > 0.0 && factor <= 100.0 => Ok(TransferPlan::Part(factor)),
        (None, Some(factor)) => {
            Err(document.error("coupling.transfer.spread_factor", factor.to_string(), "above 0, at most 100"))
        }
        _ => Err(document.error(
            "coupling.transfer",
            "both or none of `spread` and `spread_factor`",
            "one of them",
        )),
    }
}
