//! Plates of compaction against walls, before the first step.

use super::compaction::{CompactionPlan, Press};
use super::footprint::Footprint;
use super::part::GrainsPart;
use super::refused::refused;
use super::tines::TinesPlan;
use crate::scene::{Document, SceneError};
use trackbed_dem::{BodyInput, Model, ModelError, ModelInput, Vec3};

/// Rejects plates that reach through walls, and plates without stiffness against a wall or the grains.
///
/// # Errors
/// First plate.
pub fn check_plates(document: &Document, grains: &GrainsPart) -> Result<(), SceneError> {
    for (k, plan) in grains.packing.compaction.iter().enumerate() {
        if let Press::Tines(tines) = &plan.press {
            blades(document, grains, k, tines)?;
        }
        let Press::Tamping { plate, half, at, .. } = &plan.press else { continue };
        for centre in at {
            let plan = Footprint { centre: *centre, half: [half[0], half[1]], bottom: f64::NEG_INFINITY };
            if let Some(found) = through(grains, &plan) {
                let at = format!("the plate at ({}, {}) m {found}", centre[0], centre[1]);
                return Err(document.error(&format!("compaction.{k}.at"), at, "plates between the walls"));
            }
        }
        stiffness(document, grains, (k, plan), plate)?;
    }
    Ok(())
}

/// Blades at their widest, before they close.
fn blades(document: &Document, grains: &GrainsPart, k: usize, tines: &TinesPlan) -> Result<(), SceneError> {
    let Some(sleeper) = &grains.track.sleeper else { return Ok(()) };
    let [a, b, _] = tines.reach();
    for centre in &sleeper.row.centres {
        for (across, side) in tines.at.iter().flat_map(|x| [(x, 1.0), (x, -1.0)]) {
            let mut at = *centre;
            at[1 - tines.axis] += across;
            at[tines.axis] += side * tines.distance(sleeper.row.half[tines.axis]);
            let blade = Footprint { centre: at, half: [a, b], bottom: f64::NEG_INFINITY };
            let reach = tines.reach()[tines.axis];
            let meets =
                |c: &[f64; 2]| (c[tines.axis] - at[tines.axis]).abs() < sleeper.row.half[tines.axis] + reach;
            let beyond =
                |[low, high]: [f64; 2]| at[tines.axis] - reach < low || at[tines.axis] + reach > high;
            let found = match sleeper.row.centres.iter().position(meets) {
                Some(k) => Some(format!("through sleeper {}", k + 1)),
                None if grains.periodic[tines.axis].is_some_and(beyond) => Some("beyond a border".into()),
                None => through(grains, &blade),
            };
            if let Some(found) = found {
                let found = format!("a blade at ({}, {}) m {found}", at[0], at[1]);
                let key = format!("compaction.{k}.tines.gap");
                return Err(document.error(&key, found, "blades between walls and sleepers"));
            }
        }
    }
    Ok(())
}

/// Walls that are there while the bed is packed.
fn through(grains: &GrainsPart, plate: &Footprint) -> Option<String> {
    let planes = grains.walls.planes.iter().enumerate();
    let mut planes = planes.filter_map(|(k, p)| {
        let depth = plate.behind(&p.point, &p.normal)?;
        Some(format!("{depth:.3e} m through {}", grains.names().plane(k)))
    });
    let walls = grains.walls.others.iter().zip(&grains.walls.names);
    let mut walls = walls.filter(|(w, _)| w.servo.is_none() && w.body.is_none()).filter_map(|(w, name)| {
        let found = match w.shape.plane() {
            Some((point, normal)) => format!("{:.3e} m ", plate.behind(point, normal)?),
            None => plate.is_cut_by(&w.shape).then(String::new)?,
        };
        Some(format!("{found}through wall \"{name}\""))
    });
    planes.next().or_else(|| walls.next())
}

fn stiffness(
    document: &Document,
    grains: &GrainsPart,
    (k, plan): (usize, &CompactionPlan),
    plate: &BodyInput,
) -> Result<(), SceneError> {
    let mut bodies = grains.groups.bodies.clone();
    let top = bodies.iter().map(|b| b.position.z).fold(0.0, f64::max);
    let number = bodies.len();
    bodies.push(BodyInput { position: Vec3::new(0.0, 0.0, top), ..plate.clone() });
    let input = ModelInput { bodies, ..grains.deposition_input(&plan.rest) };
    match Model::new(input) {
        Ok(_) => Ok(()),
        Err(ModelError::RigidPair { a, b }) => {
            let own = format!("body {number}");
            let is_plate = |end: &str| end == own || end.starts_with(&format!("{own} of"));
            let [a, b] = [a, b].map(|end| if is_plate(&end) { "the plate".into() } else { end });
            let found = format!("no stiffness for {a} against {b}, which can be in contact");
            let expected = "`stiffness` for one of their materials, or for the pair";
            Err(document.error(&format!("compaction.{k}.plate.material"), found, expected))
        }
        Err(error) => Err(refused(document, &error)),
    }
}
