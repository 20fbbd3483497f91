//! `[periodic]` resolved.

use super::groups::GroupsPart;
use super::track::TrackPart;
use crate::scene::{Scene, SceneError, Table};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Borders of each periodic axis [m].
pub type Borders = [Option<[f64; 2]>; 3];

/// Generated grains must lie inside, given grains only with their centre.
pub(super) fn build(scene: &Table<Scene>, groups: &GroupsPart) -> Result<Borders, SceneError> {
    let mut borders = Borders::default();
    let Some(table) = scene.optional("periodic", &scene.periodic) else { return Ok(borders) };
    let sides = [&table.x, &table.y, &table.z];
    if sides.iter().all(|s| s.is_none()) {
        return Err(table.here("no axis", "`x`, `y` or `z` with its two borders"));
    }
    for (d, side) in sides.into_iter().enumerate() {
        let Some([low, high]) = side.as_ref().map(|s| [s[0].si, s[1].si]) else { continue };
        if !(low.is_finite() && high.is_finite() && low < high) {
            let expected = "two lengths, the second the larger";
            return Err(table.error(AXES[d], format!("[{low}, {high}]"), expected));
        }
        borders[d] = Some([low, high]);
        let slack = 1e-9 * (high - low);
        for body in groups.bodies.iter().filter(|b| !b.absent) {
            let group = &scene.grains[body.part as usize];
            // Floes lie inside, unlike their bounding spheres.
            let placed = [group.spheres.is_some(), group.packing.is_some(), group.floes.is_some()];
            let reach =
                if placed.contains(&true) || group.frustum.is_some() { 0.0 } else { groups.reach(body) };
            let x = body.position[d];
            if x - reach < low - slack || x + reach > high + slack {
                let found = format!("a grain from {} = {} to {}", AXES[d], x - reach, x + reach);
                let expected = format!("grains between the borders {low} and {high} of `periodic`");
                return Err(scene.row("grains", &scene.grains, body.part as usize).here(found, expected));
            }
        }
    }
    Ok(borders)
}

/// Sleepers lie between the borders, clear of their images.
pub(super) fn check_sleepers(
    scene: &Table<Scene>,
    track: &TrackPart,
    borders: &Borders,
) -> Result<(), SceneError> {
    let Some(row) = track.sleeper.as_ref().map(|plan| &plan.row) else { return Ok(()) };
    for d in 0..2 {
        let Some([low, high]) = borders[d] else { continue };
        let along = row.centres.iter().map(|x| x[d]);
        let [from, to] = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
        let length = to - from + 2.0 * row.half[d];
        if from < low || to > high || length >= high - low {
            let found = format!("sleepers from {} to {} m", from - row.half[d], to + row.half[d]);
            let expected = format!(
                "centres between the borders {low} and {high} of `periodic.{}`, and a row shorter than the period",
                AXES[d]
            );
            return Err(scene.error("track.sleeper", found, expected));
        }
    }
    Ok(())
}
