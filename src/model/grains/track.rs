//! `[track]` resolved.

use super::{GrainsPart, SleeperPlan, check};
use crate::failure::Failure;
use crate::model::track::plan::{self, RailPlan};
use crate::model::track::rail::RailInput;
use crate::scene::track::{Motion, Sleeper, Track};
use crate::scene::units::vector;
use crate::scene::{Document, SceneError};
use trackbed_dem::shape::Shape;

/// Adds the sleepers and their load.
pub(super) fn add(
    document: &Document,
    track: &Track,
    material: usize,
    part: &mut GrainsPart,
) -> Result<(), Failure> {
    let s = &track.sleeper;
    let half = vector(&s.size).map(|l| 0.5 * l);
    for l in half {
        check(document, "track.sleeper.size", Some(l), |l| l > 0.0, "lengths above 0")?;
    }
    check(document, "track.sleeper.mass", Some(s.mass.si), |m| m > 0.0, "a mass above 0")?;
    let shape = part.shapes.len();
    part.shapes.push(Shape::Box { half });
    part.parts.push("sleeper".into());
    let mut fixed = [false; 6];
    for motion in &s.hold {
        let k = match motion {
            Motion::X => 0,
            Motion::Y => 1,
            Motion::Z => 2,
            Motion::Rx => 3,
            Motion::Ry => 4,
            Motion::Rz => 5,
        };
        fixed[k] = true;
    }
    let mut seats = vec![[0.0, 0.0, half[2]]];
    if let Some(l) = &track.load {
        if !l.seats.is_empty() {
            seats = l.seats.iter().map(|p| [p[0].si, p[1].si, half[2]]).collect();
        }
        if let Some(p) = seats.iter().find(|p| p[0].abs() > half[0] || p[1].abs() > half[1]) {
            let found = format!("({}, {})", p[0], p[1]);
            return Err(document.error("track.load.seats", found, "points on the sleeper's top").into());
        }
    }
    let centres = row(document, s)?;
    let rail = track.rail.as_ref().map(|r| plan::rail(document, track, r)).transpose()?;
    if let Some(l) = &track.load {
        let axis = s.along.axis();
        let places = centres.iter().map(|c| c[axis] - centres[0][axis]).collect();
        part.load = Some(plan::load(document, l, places, rail.as_ref())?);
    }
    if let Some(RailPlan::Beam(input)) = rail {
        part.rail = Some(RailInput { gravity: -part.gravity.z, ..*input });
    }
    part.sleeper = Some(SleeperPlan {
        shape,
        material,
        mass: s.mass.si,
        fixed,
        half,
        axis: s.along.axis(),
        centres,
        seats,
    });
    Ok(())
}

/// Centres of the sleepers in plan [m].
fn row(document: &Document, s: &Sleeper) -> Result<Vec<[f64; 2]>, SceneError> {
    let (axis, spacing) = (s.along.axis(), s.spacing.map(|l| l.si));
    check(
        document,
        "track.sleeper.count",
        Some(f64::from(s.count)),
        |n| (1.0..=1000.0).contains(&n),
        "1 to 1000",
    )?;
    let width = s.size[axis].si;
    if let Some(l) = spacing.filter(|l| !(l.is_finite() && *l > width)) {
        let expected = format!("more than the sleeper's width of {width} m along the track");
        return Err(document.error("track.sleeper.spacing", l.to_string(), expected));
    }
    if s.count > 1 && spacing.is_none() {
        return Err(document.error("track.sleeper.spacing", "nothing", "the distance of the sleepers"));
    }
    let first = [s.centre[0].si, s.centre[1].si];
    let place = |k: u32| {
        let mut centre = first;
        centre[axis] += f64::from(k) * spacing.unwrap_or(0.0);
        centre
    };
    Ok((0..s.count).map(place).collect())
}
