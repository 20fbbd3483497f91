//! Check for grains fallen below all walls.

use super::{Check, Limits};
use trackbed_dem::measure::{Fragments, fragments};
use trackbed_dem::{State, Vec3};
use trackbed_input::model::grains::GrainsPart;
use trackbed_track::GrainsView;

/// No failure: runs may lose grains intentionally.
const LOST: Limits = Limits { warn: 0.01, fail: None };

/// Checks for grains below the lowest wall point. `None` without gravity, with a bounding plane, without
/// bounded walls, and for slides, which count lost grains.
pub fn grains_below_walls(view: GrainsView<'_>, grains: &GrainsPart) -> Option<Check> {
    let (model, state) = (view.model, view.state);
    let up = -model.gravity().try_normalize(0.0)?;
    let is_floor = |normal: &Vec3| normal.dot(&up) > 1e-9;
    let walls = &grains.walls;
    if grains.runout.is_some() || walls.planes.iter().any(|p| is_floor(&p.normal)) {
        return None;
    }
    let mut lowest = f64::INFINITY;
    for (w, wall) in walls.others.iter().enumerate() {
        if wall.shape.plane().is_some_and(|(_, normal)| is_floor(normal)) {
            return None;
        }
        let bottom = |(x, r): &(Vec3, f64)| state.wall_point(model, w, x).dot(&up) - r;
        let low = wall.shape.balls().iter().map(bottom).fold(f64::INFINITY, f64::min);
        lowest = lowest.min(low);
    }
    // Fixed grains support others.
    let start = State::new(model);
    let prescribed = |b: &usize| grains.groups.moving.iter().any(|m| m.part == model.part(*b));
    let supports = (0..model.body_count()).filter(prescribed);
    let lowest = supports.map(|b| state.position(b).dot(&up) - model.radius(b)).fold(lowest, f64::min);
    if lowest == f64::INFINITY {
        return None;
    }
    let hangs = hanging(&fragments(model, state), (0..model.body_count()).filter(prescribed));
    let present: Vec<usize> = (0..model.body_count()).filter(|&b| state.present(b)).collect();
    let below = |x: &Vec3, b: usize| x.dot(&up) < lowest - model.radius(b);
    let lost: Vec<usize> = present
        .iter()
        .copied()
        .filter(|&b| !hangs[b] && below(&state.position(b), b))
        .filter(|&b| !(start.present(b) && below(&start.position(b), b)))
        .collect();
    let value = lost.len() as f64 / present.len().max(1) as f64;
    Some(Check::new("grains below all walls over all grains", value, LOST, || {
        let x = state.position(lost[0]);
        format!(
            "grains lost below all walls: {}, first {} at ({:.4}, {:.4}, {:.4}) m. Close the walls, or remove grains with an [[outlet]].",
            lost.len(),
            model.name_objects(&format!("body {}", lost[0])),
            x.x,
            x.y,
            x.z
        )
    }))
}

/// Whether each body is bonded to one of the `held` bodies.
fn hanging(fragments: &Fragments, held: impl Iterator<Item = usize>) -> Vec<bool> {
    let mut hangs = vec![false; fragments.sizes.len()];
    held.for_each(|b| hangs[fragments.of[b] as usize] = true);
    fragments.of.iter().map(|&k| hangs[k as usize]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grains_bonded_to_fixed_are_kept() {
        // Body 0 is held, 1 and 2 hang from it, 3 and 4 are a broken end.
        let broken = Fragments { of: vec![0, 0, 0, 1, 1], sizes: vec![3, 2] };
        assert_eq!(hanging(&broken, [0].into_iter()), [true, true, true, false, false]);
        assert_eq!(hanging(&broken, [].into_iter()), [false; 5]);
    }
}
