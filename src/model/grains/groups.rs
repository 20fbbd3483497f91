//! `[[grains]]` resolved: spheres by hand or from a packing, or grains filled into a box.

use super::{GrainsPart, check};
use crate::failure::Failure;
use crate::model::tables;
use crate::scene::grains::{FillBox, GrainShape, Grains};
use crate::scene::units::vector;
use crate::scene::{Document, SceneError};
use nalgebra::UnitQuaternion;
use trackbed_dem::insert::place;
use trackbed_dem::shape::Shape;
use trackbed_dem::{BodyInput, Vec3};

/// Adds the grains of group `index` of the scene, all of one material.
pub(super) fn add(
    document: &Document,
    index: usize,
    group: &Grains,
    material: usize,
    part: &mut GrainsPart,
) -> Result<(), Failure> {
    let sources = [group.spheres.is_some(), group.packing.is_some(), group.fill.is_some()];
    if sources.iter().filter(|s| **s).count() != 1 {
        let expected = "exactly one of `spheres`, `packing` and `fill`";
        return Err(document.error(&format!("grains.{index}"), "another number of sources", expected).into());
    }
    let model = BodyInput {
        material,
        part: part.parts.len() as u32 - 1,
        velocity: group.velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        spin: group.spin.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        ..BodyInput::default()
    };
    match &group.fill {
        None => given(document, index, group, &model, part),
        Some(fill) => filled(document, index, group, fill, &model, part),
    }
}

/// Spheres whose places are given.
fn given(
    document: &Document,
    index: usize,
    group: &Grains,
    model: &BodyInput,
    part: &mut GrainsPart,
) -> Result<(), Failure> {
    let key = |k: &str| format!("grains.{index}.{k}");
    for (k, present) in [
        ("count", group.count.is_some()),
        ("gradation", group.gradation.is_some()),
        ("size", group.size.is_some()),
        ("library", group.library.is_some()),
    ] {
        if present {
            return Err(document.error(&key(k), "a value", "no such key without `fill`").into());
        }
    }
    if group.shape == GrainShape::Clump {
        return Err(document.error(&key("shape"), "\"clump\"", "`fill`, which clumps need").into());
    }
    let spheres = match (&group.spheres, &group.packing) {
        (Some(list), _) => {
            for s in list {
                check(document, &key("spheres"), Some(s[3].si), |r| r > 0.0, "a radius above 0")?;
            }
            list.iter().map(|s| ([s[0].si, s[1].si, s[2].si], s[3].si)).collect()
        }
        (_, Some(file)) => tables::packing(&document.resolve(file))?,
        _ => Vec::new(),
    };
    if spheres.is_empty() {
        return Err(document.error(&key("spheres"), "none", "at least one sphere").into());
    }
    let shape = part.shapes.len();
    part.shapes.push(Shape::Sphere { radius: 1.0 });
    part.bodies.extend(spheres.iter().map(|(c, r)| BodyInput {
        shape,
        scale: *r,
        position: Vec3::from(*c),
        orientation: UnitQuaternion::identity(),
        ..model.clone()
    }));
    Ok(())
}

/// Grains of random sizes, places and orientations in a box.
fn filled(
    document: &Document,
    index: usize,
    group: &Grains,
    fill: &FillBox,
    model: &BodyInput,
    part: &mut GrainsPart,
) -> Result<(), Failure> {
    let key = |k: &str| format!("grains.{index}.{k}");
    let count = group
        .count
        .ok_or_else(|| document.error(&key("count"), "nothing", "the number of grains to fill in"))?;
    check(document, &key("count"), Some(count as f64), |n| (1.0..=1e7).contains(&n), "1 to 10000000")?;
    let first = part.shapes.len();
    let unit_scale = shapes(document, index, group, part)?;
    let sizes = sizes(document, index, group, count)?;
    let shape = |i: usize| first + i % unit_scale.len();
    let scale: Vec<f64> =
        sizes.iter().enumerate().map(|(i, s)| s * unit_scale[i % unit_scale.len()]).collect();
    let radii: Vec<f64> =
        scale.iter().enumerate().map(|(i, s)| s * bounding_radius(&part.shapes[shape(i)])).collect();

    let mut low = vector(&fill.low);
    let high = [fill.high[0].si, fill.high[1].si];
    low[2] = low[2].max(top_of(part, low, high));
    let placed = place::place_loose(low, high, &radii, group.seed)
        .map_err(|e| document.error(&key("fill"), e.to_string(), "a box that holds the grains"))?;
    part.bodies.extend(placed.iter().enumerate().map(|(i, place)| BodyInput {
        shape: shape(i),
        scale: scale[i],
        position: place.position,
        orientation: place.orientation,
        ..model.clone()
    }));
    Ok(())
}

/// Adds the shapes of a filled group; returns the scale that gives each a sieve size of 1 m, so that the scale of a
/// body is its sieve size.
fn shapes(
    document: &Document,
    index: usize,
    group: &Grains,
    part: &mut GrainsPart,
) -> Result<Vec<f64>, SceneError> {
    let key = format!("grains.{index}.library");
    match (group.shape, &group.library) {
        (GrainShape::Clump, Some(file)) => {
            let clumps = tables::stones(&document.resolve(file))?;
            part.shapes.extend(clumps.iter().cloned().map(Shape::Clump));
            Ok(clumps.iter().map(|c| 1.0 / c.sieve_size()).collect())
        }
        (GrainShape::Clump, None) => Err(document.error(&key, "nothing", "the stone library of the clumps")),
        (GrainShape::Sphere, Some(_)) => Err(document.error(&key, "a file", "no such key for spheres")),
        (GrainShape::Sphere, None) => {
            part.shapes.push(Shape::Sphere { radius: 0.5 });
            Ok(vec![1.0])
        }
    }
}

/// Sieve sizes of `count` grains [m].
fn sizes(document: &Document, index: usize, group: &Grains, count: usize) -> Result<Vec<f64>, SceneError> {
    let key = |k: &str| format!("grains.{index}.{k}");
    match (&group.gradation, &group.size) {
        (Some(g), None) => {
            check(document, &key("gradation.scale"), Some(g.scale), |s| s > 0.0, "above 0")?;
            let curve = tables::gradation(&document.resolve(&g.file), &g.standard, &g.grade)?;
            Ok(curve.scaled(g.scale).sample(count, group.seed))
        }
        (None, Some([low, high])) => {
            check(document, &key("size"), Some(low.si), |s| s > 0.0, "sizes above 0")?;
            check(document, &key("size"), Some(high.si), |s| s >= low.si, "the larger size last")?;
            Ok((0..count).map(|i| low.si + (high.si - low.si) * (i as f64 + 0.5) / count as f64).collect())
        }
        _ => Err(document.error(&key("gradation"), "both or none of `gradation` and `size`", "one of them")),
    }
}

/// Height above which a box is free of the grains that earlier groups have put there [m].
fn top_of(part: &GrainsPart, low: [f64; 3], high: [f64; 2]) -> f64 {
    let mut top = f64::NEG_INFINITY;
    for body in &part.bodies {
        let r = body.scale * bounding_radius(&part.shapes[body.shape]);
        let over = (0..2).all(|d| body.position[d] + r > low[d] && body.position[d] - r < high[d]);
        if over && body.position.z + r > low[2] {
            top = top.max(body.position.z + r);
        }
    }
    top
}

/// Radius about the centre of mass that holds a grain of scale 1 [m].
fn bounding_radius(shape: &Shape) -> f64 {
    match shape {
        Shape::Sphere { radius } => *radius,
        Shape::Clump(clump) => clump.bounding_radius(),
        Shape::Box { half } => half.iter().map(|h| h * h).sum::<f64>().sqrt(),
    }
}
