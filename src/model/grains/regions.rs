//! Containers: grains scattered in them or made ready to grow, and spheres on lattices.

use super::groups::{bounding_radius, deal, shapes};
use super::sizes::SizeSource;
use super::{GradedGroup, GrainsPart, GrowthPlan, check};
use crate::failure::Failure;
use crate::scene::grains::{GrainShape, Grains, GrowthSource, LatticeFill, LatticeKind, Region};
use crate::scene::units::vector;
use crate::scene::{Document, SceneError};
use trackbed_dem::insert::closed::ClosedSurface;
use trackbed_dem::insert::container::Container;
use trackbed_dem::insert::grow::Growth;
use trackbed_dem::insert::lattice::Lattice;
use trackbed_dem::insert::scatter;
use trackbed_dem::shape::Shape;
use trackbed_dem::{BodyInput, Vec3};

/// Share of a container that the bounding spheres of grains fill when their growth begins: random places are found
/// without trouble.
const SEEDLINGS: f64 = 0.22;
/// Most grains of a group.
pub(super) const MOST: f64 = 1e7;

/// Equal spheres on a lattice.
pub(super) fn lattice(
    document: &Document,
    index: usize,
    fill: &LatticeFill,
    model: &BodyInput,
    part: &mut GrainsPart,
) -> Result<(), SceneError> {
    let key = |k: &str| format!("grains.{index}.lattice.{k}");
    check(document, &key("size"), Some(fill.size.si), |d| d > 0.0, "a diameter above 0")?;
    let (radius, low) = (0.5 * fill.size.si, Vec3::from(vector(&fill.low)));
    let kind = match fill.kind {
        LatticeKind::Loose => Lattice::Simple,
        LatticeKind::Hexagonal => Lattice::Hexagonal,
        LatticeKind::FaceCentred => Lattice::FaceCentred,
    };
    let few = |n: f64, k: &str| {
        let expected = "1 to 10000000 spheres";
        if (1.0..=MOST).contains(&n) {
            Ok(())
        } else {
            Err(document.error(&key(k), format!("{n} spheres"), expected))
        }
    };
    let sites = match (&fill.counts, &fill.high) {
        (Some(counts), None) => {
            few(counts.iter().map(|n| *n as f64).product(), "counts")?;
            kind.block(low, radius, *counts)
        }
        (None, Some(high)) => {
            let high = Vec3::from(vector(high));
            // An estimate, so that a slip of a unit does not fill the memory.
            let about: f64 = (high - low).iter().map(|l| (l / fill.size.si).max(0.0)).product();
            if about > MOST {
                few(about.round(), "high")?;
            }
            let sites = kind.fill(low, high, radius);
            few(sites.len() as f64, "high")?;
            sites
        }
        _ => {
            let found = "both or none of `counts` and `high`";
            return Err(document.error(&format!("grains.{index}.lattice"), found, "one of them"));
        }
    };
    let shape = part.shapes.len();
    part.shapes.push(Shape::Sphere { radius: 1.0 });
    let body = |position| BodyInput { shape, scale: radius, position, ..model.clone() };
    part.bodies.extend(sites.into_iter().map(body));
    Ok(())
}

/// Grains at random places of a container; with growth they get there in small form and grow when the run begins.
pub(super) fn scattered(
    document: &Document,
    index: usize,
    group: &Grains,
    region: &Region,
    model: &BodyInput,
    part: &mut GrainsPart,
) -> Result<(), Failure> {
    let key = |k: &str| format!("grains.{index}.{k}");
    let container = container(document, index, region)?;
    let volume = container.volume();
    let first = part.shapes.len();
    let unit_scale = shapes(document, index, group, part)?;
    // Volume and reach of a grain of sieve size 1 m, by shape.
    let unit = |k: usize| &part.shapes[first + k];
    let unit_volume: Vec<f64> =
        unit_scale.iter().enumerate().map(|(k, s)| s.powi(3) * shape_volume(unit(k))).collect();
    let reach: Vec<f64> = unit_scale.iter().enumerate().map(|(k, s)| s * bounding_radius(unit(k))).collect();
    let source = SizeSource::of(document, index, group)?;
    let mean_volume = source.mean_cube() * unit_volume.iter().sum::<f64>() / unit_volume.len() as f64;

    let growth = group.growth.as_ref().map(|g| growth(document, index, g)).transpose()?;
    let porosity = growth.as_ref().map(|g| g.0);
    let count = count(document, index, group, porosity, [volume, mean_volume])?;
    let mut sizes = source.sample(count, group.seed);
    let dealt = deal(&sizes, unit_scale.len());
    let (mut start, mut factor) = (1.0, 1.0);
    if let Some((porosity, _)) = &growth {
        let solid: f64 = sizes.iter().zip(&dealt).map(|(s, d)| unit_volume[*d] * s.powi(3)).sum();
        factor = ((1.0 - porosity) * volume / solid).cbrt();
        sizes.iter_mut().for_each(|s| *s *= factor);
        let bounding: f64 = sizes.iter().zip(&dealt).map(|(s, d)| (reach[*d] * s).powi(3)).sum();
        start = (SEEDLINGS * volume / (4.0 / 3.0 * std::f64::consts::PI * bounding)).cbrt().min(0.7);
    }
    let radii: Vec<f64> = sizes.iter().zip(&dealt).map(|(s, d)| start * s * reach[*d]).collect();
    let places = scatter::scatter(&container, &radii, group.seed)
        .map_err(|e| document.error(&key("region"), e.to_string(), "a container with room for the grains"))?;
    let turns = scatter::orientations(places.len(), group.seed);
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
    // A count that growth is to make fit leaves of the curve its form alone: it is then not the one to be met.
    if let SizeSource::Graded(grading) = source
        && (group.growth.is_none() || group.count.is_none())
    {
        let grading = grading.scaled(factor);
        part.graded.push(GradedGroup { part: model.part, name: group.name.clone(), grading });
    }
    Ok(())
}

/// Number of grains of a group in a container, whose volume and the mean volume of a grain are `volumes` [m³]; `porosity` is that which they grow to.
fn count(
    document: &Document,
    index: usize,
    group: &Grains,
    porosity: Option<f64>,
    volumes: [f64; 2],
) -> Result<usize, SceneError> {
    let key = |k: &str| format!("grains.{index}.{k}");
    check(document, &key("concentration"), group.concentration, |c| c > 0.0 && c < 1.0, "above 0, below 1")?;
    let share = match (porosity, group.concentration) {
        (Some(_), Some(_)) => {
            return Err(document.error(&key("concentration"), "a value", "no such key beside `growth`"));
        }
        (Some(porosity), None) => Some(1.0 - porosity),
        (None, share) => share,
    };
    let count = match (group.count, share) {
        (Some(_), Some(_)) if porosity.is_none() => {
            return Err(document.error(&key("count"), "a value", "no such key beside `concentration`"));
        }
        (Some(count), _) => count as f64,
        (None, Some(share)) => (share * volumes[0] / volumes[1]).round(),
        (None, None) => {
            let expected = "`count`, `concentration` or `growth`";
            return Err(document.error(&key("count"), "nothing", expected));
        }
    };
    if !(1.0..=MOST).contains(&count) {
        return Err(document.error(&key("count"), format!("{count} grains"), "1 to 10000000"));
    }
    Ok(count as usize)
}

fn growth(document: &Document, index: usize, g: &GrowthSource) -> Result<(f64, Growth), SceneError> {
    let key = |k: &str| format!("grains.{index}.growth.{k}");
    check(document, &key("porosity"), Some(g.porosity), |n| n > 0.0 && n < 1.0, "above 0, below 1")?;
    check(
        document,
        &key("rounds"),
        g.rounds.map(|n| n as f64),
        |n| (1.0..=1000.0).contains(&n),
        "1 to 1000",
    )?;
    check(document, &key("friction"), g.friction, |f| f >= 0.0, "0 or more")?;
    check(
        document,
        &key("unbalanced_ratio"),
        g.unbalanced_ratio,
        |r| r > 0.0 && r < 1.0,
        "above 0, below 1",
    )?;
    let default = Growth::default();
    let how = Growth {
        rounds: g.rounds.unwrap_or(default.rounds),
        friction: g.friction.unwrap_or(default.friction),
        unbalanced: g.unbalanced_ratio.unwrap_or(default.unbalanced),
        ..default
    };
    Ok((g.porosity, how))
}

fn container(document: &Document, index: usize, region: &Region) -> Result<Container, SceneError> {
    let key = |k: &str| format!("grains.{index}.region.{k}");
    let sources = [region.cuboid.is_some(), region.cone.is_some(), region.surface.is_some()];
    if sources.iter().filter(|s| **s).count() != 1 {
        let expected = "exactly one of `box`, `cone` and `surface`";
        return Err(document.error(
            &format!("grains.{index}.region"),
            "another number of containers",
            expected,
        ));
    }
    if region.surface.is_none() {
        for (k, present) in [("scale", region.scale.is_some()), ("shift", region.shift.is_some())] {
            if present {
                return Err(document.error(&key(k), "a value", "no such key without `surface`"));
            }
        }
    }
    if let Some(corners) = &region.cuboid {
        let [low, high] = corners.map(|c| Vec3::from(vector(&c)));
        if (0..3).all(|d| low[d] < high[d] && (high[d] - low[d]).is_finite()) {
            return Ok(Container::Box { low, high });
        }
        return Err(document.error(
            &key("box"),
            "corners in another order",
            "the lower corner, then the upper",
        ));
    }
    if let Some(cone) = &region.cone {
        let (from, to) = (Vec3::from(vector(&cone.from)), Vec3::from(vector(&cone.to)));
        let radii = cone.radii.map(|r| r.si);
        let length = (to - from).norm();
        check(document, &key("cone.to"), Some(length), |l| l > 0.0, "another point than `from`")?;
        for r in radii {
            check(document, &key("cone.radii"), Some(r), |r| r >= 0.0, "0 or more")?;
        }
        check(document, &key("cone.radii"), Some(radii[0] + radii[1]), |r| r > 0.0, "one radius above 0")?;
        return Ok(Container::Cone { from, to, from_radius: radii[0], to_radius: radii[1] });
    }
    let Some(file) = &region.surface else { unreachable!("one of the three is there") };
    surface(document, &key("surface"), file, region)
}

/// The inside of a closed surface from a file.
fn surface(
    document: &Document,
    key: &str,
    file: &std::path::Path,
    region: &Region,
) -> Result<Container, SceneError> {
    let surface = crate::read::read_surface(&document.resolve(file))?;
    let scale = region.scale.unwrap_or(1.0);
    let scale_key = key.replace(".surface", ".scale");
    check(document, &scale_key, Some(scale), |s| s > 0.0, "above 0")?;
    let shift = region.shift.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v)));
    let vertices: Vec<Vec3> = surface.vertices.iter().map(|v| Vec3::from(*v) * scale + shift).collect();
    ClosedSurface::new(&vertices, &surface.triangles)
        .map(Container::Surface)
        .map_err(|e| document.error(key, e.to_string(), "a closed surface"))
}

/// Whether a group of this shape can come from a lattice.
pub(super) fn spheres_only(document: &Document, index: usize, shape: GrainShape) -> Result<(), SceneError> {
    if shape == GrainShape::Sphere {
        return Ok(());
    }
    let key = format!("grains.{index}.shape");
    Err(document.error(&key, "another shape", "\"sphere\", which a lattice consists of"))
}

fn shape_volume(shape: &Shape) -> f64 {
    match shape {
        Shape::Sphere { radius } => 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3),
        Shape::Clump(clump) => clump.volume,
        Shape::Box { half } => 8.0 * half.iter().product::<f64>(),
    }
}
