//! Grains of random sizes, stacked in a box.

use super::part::GroupsPart;
use super::shapes::{Sampled, deal, drawn, shapes, unit_volumes};
use super::sizes::SizeSource;
use super::target::{Amount, HIGHEST, Site, amount, bed};
use crate::scene::grains::{FillBox, Grains};
use crate::scene::units::vector;
use crate::scene::{Scene, Table};
use trackbed_dem::BodyInput;
use trackbed_dem::insert::place;
use trackbed_io::failure::Failure;

/// Fill ratio of bounding spheres in a loose heap (`trackbed_dem::insert::place`).
const LOOSE: f64 = 0.3;
/// Sizes drawn first, so that an absurd number of grains is rejected before it is drawn.
const SAMPLE: usize = 10_000;
/// Heights of the sample above this multiple of the limit are rejected: the largest sizes of a wide gradation are rare.
const BEYOND: f64 = 10.0;

pub(super) fn filled(
    (scene, group): (&Table<Scene>, &Table<Grains>),
    fill: &FillBox,
    (model, density): (&BodyInput, f64),
    part: &mut GroupsPart,
) -> Result<(), Failure> {
    let key = amount(group)?;
    let (first, site) = (part.shapes.len(), Site::of(scene, fill, part));
    let unit_scale = shapes(group, part)?;
    let units = unit_volumes(group, part, first, &unit_scale)?;
    let source = SizeSource::of(group)?;
    let how_much = Amount::of(group, &site, (&source, &units), density)?;
    let high = [fill.high[0].si, fill.high[1].si];
    let mut low = vector(&fill.low);
    let area = (high[0] - low[0]) * (high[1] - low[1]);
    let sample = source.sample(how_much.count.min(SAMPLE), group.seed);
    let bounding: Vec<f64> = part.shapes[first..]
        .iter()
        .zip(&unit_scale)
        .map(|(s, u)| u * s.query(|s| s.bounding_radius()))
        .collect();
    let radii = sample.iter().zip(deal(&sample, bounding.len())).map(|(size, d)| size * bounding[d]);
    check_height((group, key), (how_much.count, mean_volume(radii)), area, BEYOND * HIGHEST)?;

    let grains: Vec<Sampled> = drawn(group, part, source, how_much.count, (first, &unit_scale));
    let radii: Vec<f64> =
        grains.iter().map(|b| b.scale * part.shapes[b.shape].query(|s| s.bounding_radius())).collect();
    check_height((group, key), (radii.len(), mean_volume(radii.iter().copied())), area, HIGHEST)?;

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
    let volume = |g: &Sampled| units[g.shape - first] * (g.scale / unit_scale[g.shape - first]).powi(3);
    let solid = grains.iter().map(volume).sum();
    part.filled.extend(bed(group, &site, (&how_much, solid), (density, model.part)));
    Ok(())
}

/// Mean volume of spheres [m³].
fn mean_volume(radii: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = radii.len().max(1) as f64;
    radii.map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3)).sum::<f64>() / count
}

/// `limit` [m] on the height of `count` bounding spheres of a mean volume [m³] on an area [m²].
fn check_height(
    (group, key): (&Table<Grains>, &str),
    (count, volume): (usize, f64),
    area: f64,
    limit: f64,
) -> Result<(), Failure> {
    let height = count as f64 * volume / (LOOSE * area);
    if height <= limit || !height.is_finite() {
        return Ok(());
    }
    let found = format!("{count} grains, a heap of about {height:.0} m on the plan of `fill`");
    Err(group.error(key, found, format!("a heap of at most {HIGHEST:.0} m")).into())
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
