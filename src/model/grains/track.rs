//! `[track]` resolved.

use super::{GrainsPart, SleeperPlan, check};
use crate::failure::Failure;
use crate::model::track::plan::{self, RailPlan};
use crate::model::track::sleeper;
use crate::scene::Document;
use crate::scene::track::Track;
use trackbed_coupling::track::SleeperRow;
use trackbed_coupling::track::rail::RailInput;
use trackbed_dem::shape::Shape;

/// Adds the sleepers and their load.
pub(super) fn add(
    document: &Document,
    track: &Track,
    material: usize,
    part: &mut GrainsPart,
) -> Result<(), Failure> {
    let s = &track.sleeper;
    let half = sleeper::half(document, s)?;
    let meshed = s.mesh.is_some();
    let mass = match s.mass {
        Some(mass) => mass.si,
        // Its elements have one.
        None if meshed => 0.0,
        None => return Err(document.error("track.sleeper.mass", "nothing", "the mass of a sleeper").into()),
    };
    let shape = part.shapes.len();
    if !meshed {
        check(document, "track.sleeper.mass", Some(mass), |m| m > 0.0, "a mass above 0")?;
        part.shapes.push(Shape::Box { half });
        part.parts.push("sleeper".into());
    }
    let seats = sleeper::seats(document, track, half)?.iter().map(|s| [s[0], s[1], half[2]]).collect();
    let centres = sleeper::row(document, s)?;
    let rail = track.rail.as_ref().map(|r| plan::rail(document, track, r)).transpose()?;
    if let Some(l) = &track.load {
        let axis = s.along.axis();
        let places = centres.iter().map(|c| c[axis] - centres[0][axis]).collect();
        part.load = Some(plan::load(document, l, places, rail.as_ref())?);
    }
    if let Some(RailPlan::Beam(input)) = rail {
        part.rail = Some(RailInput { gravity: -part.gravity.z, ..*input });
    }
    let (held, axis) = (sleeper::held(s), s.along.axis());
    let row = SleeperRow { meshed, mass, held, half, axis, centres, seats };
    part.sleeper = Some(SleeperPlan { shape, material, row });
    Ok(())
}
