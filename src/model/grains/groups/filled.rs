//! Grains of random sizes, stacked in a box.

use super::part::{GroupsPart, bounding_radius};
use super::shapes::sampled;
use crate::failure::Failure;
use crate::scene::Table;
use crate::scene::grains::{FillBox, Grains};
use crate::scene::units::vector;
use trackbed_dem::BodyInput;
use trackbed_dem::insert::place;

/// Grains of random sizes, places and orientations in a box.
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

/// Height above which a box is free of the grains that earlier groups have put there [m].
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
