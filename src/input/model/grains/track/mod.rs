//! `[track]` resolved.

mod after;
mod part;

pub use part::{SleeperPlan, TrackPart};

use super::check::find;
use super::groups::GroupsPart;
use crate::model::track::plan::{self, RailPlan};
use crate::model::track::sleeper;
use crate::scene::{Scene, Table};
use trackbed_dem::Vec3;
use trackbed_dem::shape::Shape;
use trackbed_io::failure::Failure;
use trackbed_track::SleeperRow;
use trackbed_track::rail::RailInput;

/// Rigid sleepers add a shape and a group. `fixed`: reason why a jump cannot move grains. Rows of sleepers
/// have `mass_factor` times the true mass.
pub(super) fn build(
    scene: &Table<Scene>,
    gravity: &Vec3,
    fixed: Option<&str>,
    mass_factor: f64,
    groups: &mut GroupsPart,
) -> Result<TrackPart, Failure> {
    let mut part = TrackPart::default();
    let Some(track) = &scene.optional("track", &scene.track) else { return Ok(part) };
    let s = &track.below("sleeper", &track.sleeper);
    let material = find(scene, s, "material", &s.material)?;
    let half = sleeper::half(s)?;
    let meshed = s.mesh.is_some();
    let mut mass = match s.mass {
        Some(mass) => mass.si,
        // From its elements.
        None if meshed => 0.0,
        None => return Err(s.missing("mass", "the mass of a sleeper").into()),
    };
    let shape = groups.shapes.len();
    if !meshed {
        s.check("mass", mass, |m| m > 0.0, "a mass above 0")?;
        mass *= mass_factor;
        groups.add_shape(Shape::Box { half });
        groups.names.push("sleeper".into());
    }
    let seats = sleeper::seats(track, half)?.iter().map(|s| [s[0], s[1], half[2]]).collect();
    let centres = sleeper::row(s)?;
    let rail = track.optional("rail", &track.rail).map(|r| plan::rail(track, &r)).transpose()?;
    part.vehicles = plan::vehicles(track, -gravity.z)?;
    if let Some(l) = track.optional("load", &track.load) {
        let axis = s.along.axis();
        let places = centres.iter().map(|c| c[axis] - centres[0][axis]).collect();
        part.load = Some(plan::load(&l, places, rail.as_ref(), part.vehicles.as_ref())?);
    }
    if let Some(RailPlan::Beam(input)) = rail {
        part.rail = Some(RailInput { gravity: -gravity.z, ..*input });
    }
    let (held, axis) = (sleeper::held(s), s.along.axis());
    let gaps = plan::gaps(track, centres.len())?;
    let row = SleeperRow { meshed, mass, held, half, axis, centres, seats, gaps };
    part.sleeper = Some(SleeperPlan { shape, material, row });
    part.after = after::build(track, &part, fixed)?;
    Ok(part)
}
