//! Bed of another run that further compaction reworks: `trackbed run NEXT --from DIR`, with stages that the
//! earlier run did not have.

use super::stage::{Settled, planes};
use crate::from::Previous;
use crate::system::SavedCoupling;
use trackbed_dem as dem;
use trackbed_dem::{BodyInput, Vec3};
use trackbed_input::model::grains::GrainsPart;
use trackbed_io::failure::Failure;

/// Returns the bed where the earlier run left it, at rest.
///
/// # Errors
/// State of another program, or of other grains.
pub fn bed(before: Previous, part: &GrainsPart) -> Result<Settled, Failure> {
    let Previous { mut loaded, coupled, added, .. } = before;
    let begun: Option<Settled> = loaded.take()?;
    let state = match coupled {
        true => loaded.take::<SavedCoupling<'_>>()?.state.into_owned().grains,
        false => loaded.take::<dem::State>()?,
    };
    let mut bed = begun.unwrap_or_else(|| Settled {
        bodies: part.groups.bodies.clone(),
        planes: planes(part),
        ..Settled::default()
    });
    if let Some(plan) = part.track.rigid_sleeper().filter(|_| bed.sleepers.is_empty()) {
        let at = |&centre: &[f64; 2]| part.sleeper_body(plan, centre, 0.0);
        bed.sleepers = plan.row.centres.iter().map(at).collect();
    }
    let all = bed.all();
    let model = dem::Model::new(part.input(all.clone()))
        .map_err(|e| Failure::Other(format!("--from: the bed of the earlier run: {e}")))?;
    // Grains that wait have no place; those that left do not return.
    let left = |b: usize| !all[b].absent && !state.present(b);
    let placed = |(b, body): (usize, &BodyInput)| match body.absent {
        true => body.clone(),
        false => BodyInput {
            position: state.position(b),
            orientation: state.orientation(&model, b),
            velocity: Vec3::zeros(),
            spin: Vec3::zeros(),
            ..body.clone()
        },
    };
    let there = all.iter().enumerate().filter(|(b, _)| !left(*b));
    let mut bodies: Vec<BodyInput> = there.map(placed).collect();
    bed.sleepers = bodies.split_off(bodies.len() - bed.sleepers.len());
    bed.bodies = bodies;
    bed.planes = (0..bed.planes.len()).map(|k| state.plane_point(&model, k)).collect();
    bed.earlier = added.unwrap_or(0);
    Ok(bed)
}
