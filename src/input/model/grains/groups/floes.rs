//! Ice floe fields: prisms from Voronoi cells of random sites (Liu, Long, Ji, Chin. J. Theor. Appl. Mech.
//! 47(6), 2015, 1046–1057).

use super::part::GroupsPart;
use super::polygon::{Point, area, distance_from, inset, scaled, simplified};
use super::sheet::{self, Floe};
use super::voronoi::cells;
use crate::model::grains::bonds::BondPart;
use crate::scene::grains::{Floes, Grains};
use crate::scene::{SceneError, Table};
use trackbed_dem::random::Random;
use trackbed_dem::shape::Shape;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_dem::{BodyInput, Vec3};

/// Random stream of the sites.
const SITES: u64 = 9;
const MOST: f64 = 1e5;
/// Smallest inscribed over rounding radius.
const LEAST: f64 = 0.2;

const ROUNDS: usize = 10_000;

pub(super) fn floes(
    group: &Table<Grains>,
    field: &Table<Floes>,
    model: &BodyInput,
    part: &mut GroupsPart,
    bonds: &mut BondPart,
) -> Result<(), SceneError> {
    let ends = [&field.low, &field.high].map(|corner| corner.map(|x| x.si));
    let count = field.need("count", field.count, "the number of cells")?;
    field.check("count", count, |n| (1.0..=MOST).contains(&n), "1 to 100000")?;
    let radius = field.need("radius", field.radius, "the radius that edges are rounded with")?.si;
    field.check("radius", field.radius, |r| r > 0.0, "above 0")?;
    field.check("thickness", field.thickness, |t| t > 2.0 * radius, "above twice the radius")?;
    let half = 0.5 * field.thickness.si;
    let rounds = field.relax.unwrap_or(0);
    field.check("relax", rounds, |n| (0.0..=ROUNDS as f64).contains(&n), "0 to 10000")?;
    let apart = apart(field)?;
    let sites = relaxed(sites(ends, count, group.seed), ends, rounds);
    let cells = cells(&sites, ends);
    let cores: Vec<_> = cells.iter().map(|cell| core(&apart.outline(cell), radius)).collect();
    let lost = cores.iter().filter(|core| core.is_none()).count();
    if lost == cores.len() {
        let expected = "a radius that leaves something of the floes when their sides are moved in by it";
        return Err(field.error("radius", radius.to_string(), expected));
    }
    let clear = |core: &Vec<Point>| {
        let away = |&[x, y, r]: &[f64; 3]| distance_from([x, y], core) > r + radius;
        field.clear.iter().map(|c| c.map(|q| q.si)).all(|c| away(&c))
    };
    let kept: Vec<_> = cores.into_iter().map(|core| core.filter(clear)).collect();
    if kept.iter().all(Option::is_none) {
        return Err(field.error("clear", "circles that meet all floes", "room for a floe at least"));
    }
    let z = field.elevation.map_or(0.0, |z| z.si);
    let mut made: Vec<Option<Floe>> = vec![None; kept.len()];
    for (core, made) in kept.iter().zip(&mut made) {
        let Some(core) = core else { continue };
        let level = |z: f64| core.iter().map(move |[x, y]| Vec3::new(*x, *y, z));
        let corners: Vec<Vec3> = level(z - half + radius).chain(level(z + half - radius)).collect();
        let (shape, position, orientation) = Dilated::new(&corners, radius)
            .map_err(|e| field.here(e.to_string(), "floes that are dilated polyhedra"))?;
        let shape = part.add_shape(Shape::Polyhedron(Box::new(shape)));
        *made = Some(Floe { body: part.bodies.len(), centre: [position.x, position.y] });
        part.bodies.push(BodyInput { shape, scale: 1.0, position, orientation, ..model.clone() });
    }
    if let Some(name) = &group.bond {
        let kind = bonds.of_group(group, name, true)?;
        sheet::join(&sites, &cells, &made, field.thickness.si, kind, bonds);
    }
    if lost > 0 {
        part.remarks.push(format!(
            "grains \"{}\": {lost} of {} floes are left out, for they are too small to be rounded with {radius} m",
            group.name, count
        ));
    }
    Ok(())
}

pub(super) fn check(field: &Table<Floes>) -> Result<(), SceneError> {
    for d in 0..2 {
        let low = field.check("low", field.low[d], |_| true, "a length")?.si;
        field.check("high", field.high[d], |x| x > low, "above `low`")?;
    }
    field.check("concentration", field.concentration, |c| c > 0.0 && c < 1.0, "above 0, below 1")?;
    field.check("gap", field.gap, |g| g > 0.0, "above 0")?;
    field.check("elevation", field.elevation, |_| true, "a length")?;
    for [x, y, r] in &field.clear {
        field.check("clear", *x, |_| true, "a position")?;
        field.check("clear", *y, |_| true, "a position")?;
        field.check("clear", *r, |r| r >= 0.0, "a radius of 0 or more")?;
    }
    Ok(())
}

fn sites([low, high]: [Point; 2], count: usize, seed: u64) -> Vec<Point> {
    let mut random = Random::new(seed, SITES);
    let mut at = |d: usize| low[d] + random.uniform() * (high[d] - low[d]);
    (0..count).map(|_| [at(0), at(1)]).collect()
}

enum Apart {
    /// Floe area over cell area.
    Share(f64),
    /// Gap between neighbours [m].
    Gap(f64),
}

fn apart(field: &Table<Floes>) -> Result<Apart, SceneError> {
    match (field.concentration, field.gap) {
        (Some(share), None) => Ok(Apart::Share(share)),
        (None, Some(gap)) => Ok(Apart::Gap(gap.si)),
        (share, _) => Err(field.choice(["concentration", "gap"], share.is_some())),
    }
}

impl Apart {
    /// Without corner rounding.
    fn outline(&self, cell: &[Point]) -> Vec<Point> {
        match self {
            Apart::Share(share) => scaled(cell, share.sqrt(), area(cell).1),
            Apart::Gap(gap) => inset(cell, 0.5 * gap),
        }
    }
}

/// Lloyd iteration (Lloyd, IEEE Trans. Inf. Theory 28, 1982).
fn relaxed(mut sites: Vec<Point>, ends: [Point; 2], rounds: usize) -> Vec<Point> {
    for _ in 0..rounds {
        sites = cells(&sites, ends).iter().map(|cell| area(cell).1).collect();
    }
    sites
}

/// None for a floe too small for the radius.
fn core(outline: &[Point], radius: f64) -> Option<Vec<Point>> {
    let none_left = inset(outline, (1.0 + LEAST) * radius).is_empty();
    let core = simplified(&inset(outline, radius));
    (!none_left && core.len() >= 3).then_some(core)
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: [Point; 2] = [[0.0, 0.0], [50.0, 50.0]];

    fn outlines(count: usize, seed: u64) -> Vec<Vec<Point>> {
        cells(&sites(BOX, count, seed), BOX).iter().map(|c| Apart::Share(0.64).outline(c)).collect()
    }

    #[test]
    fn fields_have_their_mean_floe() {
        for (count, mean, size) in [(200, 8.0, 2.828_427_1), (500, 3.2, 1.788_854_4)] {
            for seed in 1..=3 {
                let all: f64 = outlines(count, seed).iter().map(|o| area(o).0).sum();
                assert!((all / 2500.0 - 0.64).abs() < 1e-12, "{all}");
                let found = all / count as f64;
                assert!(
                    (found / mean - 1.0).abs() < 1e-9 && (found.sqrt() / size - 1.0).abs() < 1e-6,
                    "{found}"
                );
            }
        }
    }

    /// Relative standard deviation of Poisson–Voronoi areas: 0.5294 (Gilbert 1962).
    #[test]
    fn areas_vary_like_poisson_voronoi_cells() {
        for seed in 1..=8 {
            let areas: Vec<f64> = outlines(200, seed).iter().map(|o| area(o).0).collect();
            let mean = areas.iter().sum::<f64>() / 200.0;
            let variance = areas.iter().map(|a| (a - mean).powi(2)).sum::<f64>() / 199.0;
            let spread = variance.sqrt() / mean;
            assert!((spread - 0.5294).abs() < 3.0 * 0.038, "seed {seed}: {spread}");
        }
    }

    #[test]
    fn rounded_floes_fill_their_outlines() {
        let radius = 0.04;
        let (mut outer, mut rounded, mut lost) = (0.0, 0.0, 0);
        for outline in outlines(500, 4) {
            let Some(core) = core(&outline, radius) else {
                lost += 1;
                continue;
            };
            let level = |z: f64| core.iter().map(move |[x, y]| Vec3::new(*x, *y, z));
            let corners: Vec<Vec3> = level(-0.21).chain(level(0.21)).collect();
            let shape = Dilated::new(&corners, radius).unwrap().0;
            assert_eq!(shape.core.faces.len(), core.len() + 2);
            // Steiner's formula in the plane.
            let around: f64 =
                super::super::polygon::sides(&core).map(|[p, q]| libm::hypot(q[0] - p[0], q[1] - p[1])).sum();
            let own = area(&core).0 + radius * around + std::f64::consts::PI * radius * radius;
            let full = area(&outline).0;
            assert!(own < full && own > full - 0.05 * full.max(0.1), "{own} {full}");
            outer += full;
            rounded += own;
        }
        assert_eq!(lost, 0);
        assert!(rounded / outer > 0.998, "{}", rounded / outer);
        println!("rounded over straight: {}", rounded / outer);
    }

    #[test]
    fn relaxed_floes_are_alike() {
        let spread = |sites: &[Point], ends: [Point; 2]| {
            let areas: Vec<f64> = cells(sites, ends).iter().map(|c| area(c).0).collect();
            let mean = areas.iter().sum::<f64>() / areas.len() as f64;
            areas.iter().map(|a| (a / mean - 1.0).powi(2)).sum::<f64>() / areas.len() as f64
        };
        let random = sites(BOX, 200, 2);
        assert!(spread(&random, BOX) > 0.4 * 0.4);
        assert!(spread(&relaxed(random, BOX, 100), BOX) < 0.1 * 0.1);
        let row = [[0.0, 0.0], [10.0, 1.0]];
        assert!(spread(&relaxed(sites(row, 10, 2), row, 1000), row) < 1e-8);
    }

    #[test]
    fn removes_floes_below_rounding_radius() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        // 0.5/1.2 leaves at least half of the width.
        assert!(core(&square, 0.41).is_some());
        assert!(core(&square, 0.42).is_none());
    }
}
