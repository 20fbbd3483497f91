//! Runout of a slide.
//!
//! *Head*: initial position of the highest grain. *Toe*: final front grain, behind which a given mass
//! fraction lies. H and L: their vertical and horizontal distances. The reach angle atan(H/L) is Heim's
//! Fahrböschung (Heim, Bergsturz und Menschenleben, 1932; Scheidegger, Rock Mech. 5, 1973).
//!
//! Theory manual: equation (6.39) of `docs/theory/track.md`.

mod deposit;
mod files;
mod ground;
mod passage;
mod records;

pub use passage::Passage;
pub use records::RunoutRecord;

use super::recorder::{Now, Recorder};
use super::system::{GrainsView, System};
use std::path::Path;
use trackbed_dem::{self as dem, Vec3};
use trackbed_input::model::grains::{GrainsPart, RunoutPlan};
use trackbed_io::columns::history;
use trackbed_io::failure::Failure;
use trackbed_io::write::csv::Row;

const LISTED: usize = 10;

/// Returns initial body positions in the main stage [m]. Shape `[bodies]`.
pub fn origins(model: &dem::Model) -> Vec<Vec3> {
    let start = dem::State::new(model);
    (0..model.body_count()).map(|b| start.position(b)).collect()
}

fn slide(view: GrainsView<'_>, plan: &RunoutPlan) -> Vec<usize> {
    let GrainsView { model, state } = view;
    (0..model.body_count()).filter(|&b| state.present(b) && plan.has(model.part(b))).collect()
}

fn along(plan: &RunoutPlan, x: &Vec3) -> f64 {
    x.x * plan.direction[0] + x.y * plan.direction[1]
}

fn front(
    view: GrainsView<'_>,
    plan: &RunoutPlan,
    bodies: &[usize],
    share: f64,
    place: impl Fn(usize) -> Vec3,
) -> Option<usize> {
    let mut ordered: Vec<(f64, usize)> = bodies.iter().map(|&b| (along(plan, &place(b)), b)).collect();
    ordered.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let total: f64 = bodies.iter().map(|&b| view.model.mass(b)).sum();
    let mut behind = 0.0;
    let at = ordered.iter().position(|(_, b)| {
        behind += view.model.mass(*b);
        behind >= share * total
    });
    at.or(ordered.len().checked_sub(1)).map(|k| ordered[k].1)
}

fn centre(view: GrainsView<'_>, bodies: &[usize], place: impl Fn(usize) -> Vec3) -> Vec3 {
    let mass: f64 = bodies.iter().map(|&b| view.model.mass(b)).sum();
    let sum: Vec3 = bodies.iter().map(|&b| place(b) * view.model.mass(b)).sum();
    sum / mass.max(f64::MIN_POSITIVE)
}

fn kinetic(view: GrainsView<'_>, bodies: &[usize]) -> f64 {
    let energy = |b: usize| {
        let (v, q) = (view.state.velocity(b), view.state.orientation(view.model, b));
        let w = q.inverse() * view.state.spin(b);
        0.5 * (view.model.mass(b) * v.norm_squared() + view.model.inertia(b).dot(&w.component_mul(&w)))
    };
    bodies.iter().map(|&b| energy(b)).sum()
}

/// Front, centre of mass, kinetic energy, largest fragment.
pub struct Slides;

impl<S: System> Recorder<S> for Slides {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let Some(plan) = now.job.grains.as_ref().and_then(|g| g.runout.as_ref()) else { return };
        let Some(view) = now.system.grains() else { return };
        let bodies = slide(view, plan);
        let place = |b: usize| view.state.position(b);
        let at = front(view, plan, &bodies, plan.share, place).map_or(0.0, |b| along(plan, &place(b)));
        row.put(history::RUNOUT_FRONT, at);
        row.vector(history::RUNOUT_CENTRE, centre(view, &bodies, place));
        row.put(history::RUNOUT_KINETIC, kinetic(view, &bodies));
        let speed = |b: &usize| view.state.velocity(*b).norm();
        row.put(history::RUNOUT_FASTEST, bodies.iter().map(speed).fold(0.0, f64::max));
    }
}

/// Measures the final runout.
///
/// # Errors
/// I/O errors.
pub fn record(
    dir: &Path,
    view: GrainsView<'_>,
    part: &GrainsPart,
    passage: Option<&Passage>,
) -> Result<Option<RunoutRecord>, Failure> {
    let Some(plan) = &part.runout else { return Ok(None) };
    let GrainsView { model, state } = view;
    let bodies = slide(view, plan);
    if bodies.is_empty() {
        return Ok(None);
    }
    let from = origins(model);
    let travel: Vec<f64> = from.iter().enumerate().map(|(b, x)| (state.position(b) - x).norm()).collect();
    let map = deposit::measure(view, part, plan, &bodies, &travel);
    let fragments = records::fragments(view, &bodies);
    if let Some(passage) = passage {
        passage.write(dir, view, part, &map)?;
    }
    files::write(dir, view, &map, &fragments, (&bodies, &from))?;
    let (start, end) = (|b: usize| from[b], |b: usize| state.position(b));
    let head = bodies.iter().copied().max_by(|a, b| from[*a].z.total_cmp(&from[*b].z)).expect("some body");
    let toe = front(view, plan, &bodies, plan.share, end).expect("some body");
    let first = front(view, plan, &bodies, plan.share, start).expect("some body");
    let farthest = bodies.iter().map(|&b| along(plan, &end(b))).fold(f64::NEG_INFINITY, f64::max);
    let (drop, length) = fall(plan, &from[head], &end(toe));
    let centres = [centre(view, &bodies, start), centre(view, &bodies, end)];
    let (centre_drop, centre_length) = fall(plan, &centres[0], &centres[1]);
    let solid: f64 = bodies.iter().map(|&b| model.volume(b)).sum();
    let mass: f64 = bodies.iter().map(|&b| model.mass(b)).sum();
    let gravity = model.gravity();
    let released: f64 = bodies.iter().map(|&b| model.mass(b) * gravity.dot(&(end(b) - from[b]))).sum();
    let across = [-plan.direction[1], plan.direction[0]];
    let places: Vec<[f64; 2]> = bodies.iter().map(|&b| [end(b).x, end(b).y]).collect();
    let ground = ground::under(view, part, &map.plan, &places);
    let through = bodies.iter().zip(&ground).filter(|(b, z)| z.is_some_and(|z| end(**b).z < z)).count();
    let (cells, area) = (map.cells().count(), map.plan.cell * map.plan.cell);
    let bulk: f64 = map.cells().map(|(i, j)| map.depth[map.plan.index(i, j)] * area).sum();
    let moved =
        bodies.iter().filter(|b| travel[**b] > 2.0 * model.radius(**b)).map(|&b| model.mass(b)).sum::<f64>();
    Ok(Some(RunoutRecord {
        grains: bodies.len(),
        mass,
        solid_volume: solid,
        moved_share: moved / mass,
        front: along(plan, &end(toe)),
        advance: along(plan, &end(toe)) - along(plan, &from[first]),
        farthest,
        drop,
        length,
        reach_angle: libm::atan2(drop, length).to_degrees(),
        travel_angle: libm::atan2(centre_drop, centre_length).to_degrees(),
        centre_start: centres[0].into(),
        centre_end: centres[1].into(),
        cell: map.plan.cell,
        passage_cell: passage.map(Passage::side),
        deposit_area: cells as f64 * area,
        deposit_length: map.extent(plan.direction),
        deposit_width: map.extent(across),
        deposit_volume: bulk,
        deepest: map.depth.iter().copied().fold(0.0, f64::max),
        potential_released: released,
        kinetic_left: kinetic(view, &bodies),
        below_ground: through,
        beyond_ground: ground.iter().filter(|z| z.is_none()).count(),
        fragments: fragments.len(),
        largest_share: fragments.first().map_or(0.0, |f| f.volume / solid),
        largest: fragments.into_iter().take(LISTED).collect(),
    }))
}

/// Vertical, horizontal distance [m].
fn fall(plan: &RunoutPlan, from: &Vec3, to: &Vec3) -> (f64, f64) {
    (from.z - to.z, along(plan, to) - along(plan, from))
}
