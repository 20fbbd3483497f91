//! Initial overlaps by true shapes.

use super::part::GrainsPart;
use crate::scene::{Document, SceneError};
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem as dem;
use trackbed_dem::shape::Shape;
use trackbed_dem::surface::NoSurface;
use trackbed_dem::{Model, Partner};

/// Largest overlap over smaller radius, beyond which grains are ejected.
const LARGEST: f64 = 0.1;
const ROUNDING: f64 = 1e-9;

/// Rejects initial overlaps above a tenth of the smaller radius, unless a group has `accept_overlap`.
///
/// # Errors
/// Deepest overlap.
pub fn check_overlaps(
    document: &Document,
    grains: &GrainsPart,
    model: &Model,
    ground: Option<&SolidSurface>,
) -> Result<(), SceneError> {
    let mut state = dem::State::new(model);
    let mut work = dem::Work::new(model, &state);
    // Larger overlaps are reported by the run.
    let found = match ground {
        Some(ground) => dem::find_contacts(model, &mut state, &mut work, ground),
        None => dem::find_contacts(model, &mut state, &mut work, &NoSurface),
    };
    if found.is_err() {
        return Ok(());
    }
    let group = |body: usize| grains.groups.bodies.get(body).map(|b| b.part);
    let accepted = |body: usize| group(body).is_none_or(|part| grains.groups.overlapping.contains(&part));
    let grows = |body: usize| grains.groups.growths.iter().any(|g| g.bodies.contains(&body));
    let moving = &grains.groups.moving;
    let fixed = |body: usize| group(body).is_some_and(|part| moving.iter().any(|m| m.part == part));
    let mut worst: Option<(f64, dem::measure::ContactRecord)> = None;
    for contact in dem::measure::contacts(model, &state) {
        let (share, other) = match contact.b {
            Partner::Body(b) => (contact.overlap / radius(model, contact.a).min(radius(model, b)), Some(b)),
            _ => (contact.overlap / radius(model, contact.a), None),
        };
        let both = [Some(contact.a), other].into_iter().flatten();
        let exempt = both.clone().any(|b| accepted(b) || grows(b)) || both.clone().all(fixed);
        if share > LARGEST + ROUNDING && !exempt && worst.as_ref().is_none_or(|(most, _)| share > *most) {
            worst = Some((share, contact));
        }
    }
    let Some((share, contact)) = worst else { return Ok(()) };
    let part = group(contact.a).unwrap_or_default();
    let found = format!(
        "grain {} of \"{}\" and {} with an overlap of {:.3e} m, {:.0} % of the smaller radius",
        contact.a,
        grains.groups.names[part as usize],
        contact.b,
        contact.overlap,
        100.0 * share
    );
    let expected = format!(
        "at most {:.0} % at the start. Move them apart, or set `accept_overlap = true` for the group",
        100.0 * LARGEST
    );
    Err(document.error(&format!("grains.{part}"), found, expected))
}

/// Reference radius [m]: smallest clump sphere, half the shortest box side, equal-volume sphere of a
/// polyhedron.
fn radius(model: &Model, body: usize) -> f64 {
    let scale = model.scale(body);
    match model.shape(body) {
        Shape::Sphere { radius } => scale * radius,
        Shape::Clump(clump) => scale * clump.spheres.iter().map(|s| s.1).fold(f64::INFINITY, f64::min),
        Shape::Box { half } => scale * half.iter().copied().fold(f64::INFINITY, f64::min),
        Shape::Polyhedron(it) => scale * libm::cbrt(0.75 * it.volume / std::f64::consts::PI),
    }
}
