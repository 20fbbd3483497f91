//! Grains of random sizes, stacked in a box.

use super::part::{GroupsPart, bounding_radius};
use super::shapes::sampled;
use crate::failure::Failure;
use crate::scene::Table;
use crate::scene::grains::{FillBox, Grains};
use crate::scene::units::vector;
use trackbed_dem::BodyInput;
use trackbed_dem::insert::place;

/// Fill ratio of bounding spheres in a loose heap (`trackbed_dem::insert::place`).
const LOOSE: f64 = 0.3;
/// Falling grains take 6 s and arrive at 63 m/s.
const HIGHEST: f64 = 200.0;

pub(super) fn filled(
    group: &Table<Grains>,
    fill: &FillBox,
    model: &BodyInput,
    part: &mut GroupsPart,
) -> Result<(), Failure> {
    let grains = sampled(group, part, "the number of grains to fill in")?;
    let radii: Vec<f64> = grains.iter().map(|b| b.scale * bounding_radius(&part.shapes[b.shape])).collect();

    let mut low = vector(&fill.low);
    let high = [fill.high[0].si, fill.high[1].si];
    check_height(group, &radii, (high[0] - low[0]) * (high[1] - low[1]))?;
    low[2] = low[2].max(top_of(part, low, high));
    let placed = place::place_loose(low, high, &radii, group.seed)
        .map_err(|e| group.error("fill", e.to_string(), "a box that holds the grains"))?;
    part.bodies.extend(placed.iter().zip(&grains).map(|(place, grain)| BodyInput {
        shape: grain.shape,
        scale: grain.scale,
        position: place.position,
        orientation: place.orientation,
        ..model.clone()
    }));
    Ok(())
}

fn check_height(group: &Table<Grains>, radii: &[f64], area: f64) -> Result<(), Failure> {
    let volume: f64 = radii.iter().map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3)).sum();
    let height = volume / (LOOSE * area);
    if height <= HIGHEST || !height.is_finite() {
        return Ok(());
    }
    let found = format!("{} grains, a heap of about {height:.0} m on the plan of `fill`", radii.len());
    Err(group.error("count", found, format!("a heap of at most {HIGHEST:.0} m")).into())
}

fn top_of(part: &GroupsPart, low: [f64; 3], high: [f64; 2]) -> f64 {
    let mut top = f64::NEG_INFINITY;
    for body in part.bodies.iter().filter(|b| !b.absent) {
        let r = part.reach(body);
        let over = (0..2).all(|d| body.position[d] + r > low[d] && body.position[d] - r < high[d]);
        if over && body.position.z + r > low[2] {
            top = top.max(body.position.z + r);
        }
    }
    top
}
