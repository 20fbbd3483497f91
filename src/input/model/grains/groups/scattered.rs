//! Grains at random positions in containers.

use super::container::container;
use super::part::{GradedGroup, GroupsPart, GrowthPlan};
use super::shapes::{MOST, deal, shapes};
use super::sizes::SizeSource;
use crate::scene::grains::{Grains, GrowthSource, Region};
use crate::scene::{SceneError, Table};
use trackbed_dem::insert::radius_expansion::Growth;
use trackbed_dem::insert::random_placement;
use trackbed_dem::{BodyInput, Vec3};
use trackbed_io::failure::Failure;

/// Fill ratio of bounding spheres before growth, for easy random placement.
const SEEDLINGS: f64 = 0.22;

pub(super) fn scattered(
    group: &Table<Grains>,
    region: &Table<Region>,
    model: &BodyInput,
    part: &mut GroupsPart,
) -> Result<(), Failure> {
    let container = container(region)?;
    let volume = container.volume();
    let first = part.shapes.len();
    let unit_scale = shapes(group, part)?;
    // At sieve size 1 m, by shape.
    let scaled = || unit_scale.iter().zip(&part.shapes[first..]);
    let unit_volume: Vec<f64> = scaled().map(|(s, unit)| s.powi(3) * unit.query(|u| u.volume())).collect();
    let reach: Vec<f64> = scaled().map(|(s, unit)| s * unit.query(|u| u.bounding_radius())).collect();
    let source = SizeSource::of(group)?;
    let mean_volume = source.mean_cube() * unit_volume.iter().sum::<f64>() / unit_volume.len() as f64;

    let growth = group.optional("growth", &group.growth).map(|g| growth(&g)).transpose()?;
    let porosity = growth.as_ref().map(|g| g.0);
    let count = count(group, porosity, [volume, mean_volume])?;
    let mut sizes = source.sample(count, group.seed);
    let dealt = deal(&sizes, unit_scale.len());
    let (mut start, mut factor) = (1.0, 1.0);
    if let Some((porosity, _)) = &growth {
        let solid: f64 = sizes.iter().zip(&dealt).map(|(s, d)| unit_volume[*d] * s.powi(3)).sum();
        factor = libm::cbrt((1.0 - porosity) * volume / solid);
        sizes.iter_mut().for_each(|s| *s *= factor);
        let bounding: f64 = sizes.iter().zip(&dealt).map(|(s, d)| (reach[*d] * s).powi(3)).sum();
        start = libm::cbrt(SEEDLINGS * volume / (4.0 / 3.0 * std::f64::consts::PI * bounding)).min(0.7);
    }
    let radii: Vec<f64> = sizes.iter().zip(&dealt).map(|(s, d)| start * s * reach[*d]).collect();
    let places = random_placement::scatter(&container, &radii, group.seed)
        .map_err(|e| group.error("region", e.to_string(), "a container with room for the grains"))?;
    let turns = random_placement::orientations(places.len(), group.seed);
    let begin = part.bodies.len();
    let body = |(i, position): (usize, Vec3)| BodyInput {
        shape: first + dealt[i],
        scale: sizes[i] * unit_scale[dealt[i]],
        position,
        orientation: turns[i],
        ..model.clone()
    };
    let bodies: Vec<BodyInput> = places.into_iter().enumerate().map(body).collect();
    part.bodies.extend(bodies);
    if let Some((_, how)) = growth {
        let how = Growth { start, ..how };
        let group = group.name.clone();
        part.growths.push(GrowthPlan { group, bodies: begin..part.bodies.len(), container, how });
    }
    // Growth to a count scales sizes; only the curve shape remains.
    if let SizeSource::Graded(grading) = source
        && (group.growth.is_none() || group.count.is_none())
    {
        let grading = grading.scaled(factor);
        part.graded.push(GradedGroup { part: model.part, name: group.name.clone(), grading });
    }
    Ok(())
}

/// `volumes`: container and mean grain [m³]; `porosity`: target of growth.
fn count(group: &Table<Grains>, porosity: Option<f64>, volumes: [f64; 2]) -> Result<usize, SceneError> {
    group.check("solid_fraction", group.solid_fraction, |c| c > 0.0 && c < 1.0, "above 0, below 1")?;
    let share = match (porosity, group.solid_fraction) {
        (Some(_), Some(_)) => {
            return Err(group.conflict("solid_fraction", "`growth`"));
        }
        (Some(porosity), None) => Some(1.0 - porosity),
        (None, share) => share,
    };
    let count = match (group.count, share) {
        (Some(_), Some(_)) if porosity.is_none() => {
            return Err(group.conflict("count", "`solid_fraction`"));
        }
        (Some(count), _) => count as f64,
        (None, Some(share)) => (share * volumes[0] / volumes[1]).round(),
        (None, None) => {
            let expected = "`count`, `solid_fraction` or `growth`";
            return Err(group.missing("count", expected));
        }
    };
    if !(1.0..=MOST).contains(&count) {
        return Err(group.error("count", format!("{count} grains"), "1 to 10000000"));
    }
    Ok(count as usize)
}

fn growth(g: &Table<GrowthSource>) -> Result<(f64, Growth), SceneError> {
    g.check("porosity", g.porosity, |n| n > 0.0 && n < 1.0, "above 0, below 1")?;
    g.check("rounds", g.rounds, |n| (1.0..=1000.0).contains(&n), "1 to 1000")?;
    g.check("friction", g.friction, |f| f >= 0.0, "0 or more")?;
    g.check("unbalanced_ratio", g.unbalanced_ratio, |r| r > 0.0 && r < 1.0, "above 0, below 1")?;
    let default = Growth::default();
    let how = Growth {
        rounds: g.rounds.unwrap_or(default.rounds),
        friction: g.friction.unwrap_or(default.friction),
        unbalanced: g.unbalanced_ratio.unwrap_or(default.unbalanced),
        ..default
    };
    Ok((g.porosity, how))
}
