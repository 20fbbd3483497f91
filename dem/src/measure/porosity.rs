//! Solid volume and porosity in a box.
//!
//! Exact for spheres and bodies inside. Other bodies on the border: midpoint rule over [`COLUMNS`] ×
//! [`COLUMNS`] columns, error about 1e-3.

use super::{BoxRegion, sphere_box_volume};
use crate::base::Vec3;
use crate::bodies::table::BodyKind;
use crate::engine::model::Model;
use crate::engine::state::State;

/// Columns per side of a body on the border.
pub const COLUMNS: usize = 40;

/// Returns the volume of a body and its periodic images inside a box [m³].
pub fn body_volume_in(model: &Model, state: &State, body: usize, region: &BoxRegion) -> f64 {
    if !state.present(body) {
        return 0.0;
    }
    let periodic = model.periodic();
    if periodic.iter().all(Option::is_none) {
        return volume_in(model, state, body, region);
    }
    let x = state.position(body);
    let back = model.wrap(&x) - x;
    let mut sum = 0.0;
    for k in 0..27 {
        let images = [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1];
        if (0..3).any(|d| periodic[d].is_none() && images[d] != 0) {
            continue;
        }
        let way =
            Vec3::from_fn(|d, _| periodic[d].map_or(0.0, |[l, h]| f64::from(images[d]) * (h - l))) + back;
        let region = BoxRegion { low: region.low - way, high: region.high - way };
        sum += volume_in(model, state, body, &region);
    }
    sum
}

fn volume_in(model: &Model, state: &State, body: usize, region: &BoxRegion) -> f64 {
    let spheres = state.spheres(model, body);
    let (low, high) = extent(model, state, body, &spheres);
    if (0..3).any(|d| low[d] >= region.high[d] || high[d] <= region.low[d]) {
        return 0.0;
    }
    if (0..3).all(|d| low[d] >= region.low[d] && high[d] <= region.high[d]) {
        return model.volume(body);
    }
    if let [(centre, radius)] = spheres[..] {
        return sphere_box_volume(&centre, radius, region);
    }
    let (from, to) = (low.sup(&region.low), high.inf(&region.high));
    let step = (to - from) / COLUMNS as f64;
    let mut spans: Vec<(f64, f64)> = Vec::new();
    let mut sum = 0.0;
    for k in 0..COLUMNS * COLUMNS {
        let x = from.x + ((k / COLUMNS) as f64 + 0.5) * step.x;
        let y = from.y + ((k % COLUMNS) as f64 + 0.5) * step.y;
        spans.clear();
        for (c, r) in &spheres {
            let rise2 = r * r - (x - c.x) * (x - c.x) - (y - c.y) * (y - c.y);
            if rise2 > 0.0 {
                spans.push((c.z - rise2.sqrt(), c.z + rise2.sqrt()));
            }
        }
        if model.body(body).kind == BodyKind::Solid {
            spans.extend(column_of_solid(model, state, body, x, y));
        }
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut reached = from.z;
        for &(a, b) in &spans {
            let (a, b) = (a.max(reached), b.min(to.z));
            if b > a {
                sum += b - a;
                reached = b;
            }
        }
    }
    sum * step.x * step.y
}

/// Returns the volume of all bodies inside a box [m³].
pub fn solid_volume(model: &Model, state: &State, region: &BoxRegion) -> f64 {
    (0..model.body_count()).map(|body| body_volume_in(model, state, body, region)).sum()
}

/// Porosity [-]; 0 without volume, negative for large overlaps.
pub fn porosity(model: &Model, state: &State, region: &BoxRegion) -> f64 {
    let volume = region.volume();
    if volume > 0.0 { 1.0 - solid_volume(model, state, region) / volume } else { 0.0 }
}

fn extent(model: &Model, state: &State, body: usize, spheres: &[(Vec3, f64)]) -> (Vec3, Vec3) {
    if model.body(body).kind == BodyKind::Solid {
        let turn = state.orientation(model, body).to_rotation_matrix();
        let reach = turn.matrix().abs() * model.shape(body).bounding_half(model.scale(body));
        let x = state.position(body);
        return (x - reach, x + reach);
    }
    let start = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    spheres
        .iter()
        .fold(start, |(low, high), (c, r)| (low.inf(&c.add_scalar(-r)), high.sup(&c.add_scalar(*r))))
}

/// Intersection with the vertical line through (x, y).
fn column_of_solid(model: &Model, state: &State, body: usize, x: f64, y: f64) -> Option<(f64, f64)> {
    let (turn, centre) = (state.orientation(model, body), state.position(body));
    let origin = turn.inverse_transform_vector(&(Vec3::new(x, y, 0.0) - centre));
    let along = turn.inverse_transform_vector(&Vec3::z());
    model.shape(body).query(|shape| shape.chord(model.scale(body), &origin, &along))
}
