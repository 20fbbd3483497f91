//! `[[grains]]` resolved: grains by hand or from a packing, stacked in a box, on a lattice, or in a container.

use super::sizes::SizeSource;
use super::{GradedGroup, GrainsPart, Moving, bonded, check, flow, regions};
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
    let sources = [
        group.spheres.is_some(),
        group.packing.is_some(),
        group.fill.is_some(),
        group.lattice.is_some(),
        group.region.is_some(),
    ];
    if group.inlet.is_some() && group.shape == GrainShape::Bonded {
        let key = format!("grains.{index}.shape");
        return Err(document.error(&key, "\"bonded\"", "no inlet for bonded stones").into());
    }
    let waits = flow::waits(group);
    if sources.iter().filter(|s| **s).count() != 1 && !waits {
        let expected = "exactly one of `spheres`, `packing`, `fill`, `lattice` and `region`";
        return Err(document.error(&format!("grains.{index}"), "another number of sources", expected).into());
    }
    let model = BodyInput {
        material,
        part: part.parts.len() as u32 - 1,
        velocity: group.velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        spin: group.spin.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        ..BodyInput::default()
    };
    refuse_idle_keys(document, index, group)?;
    prescribed(document, index, group, part)?;
    part.first_shape.push(part.shapes.len());
    if waits {
        return flow::waiting(document, index, group, &model, part);
    }
    if let Some(fill) = &group.fill {
        return filled(document, index, group, fill, &model, part);
    }
    if let Some(fill) = &group.lattice {
        regions::spheres_only(document, index, group.shape)?;
        return Ok(regions::lattice(document, index, fill, &model, part)?);
    }
    if let Some(region) = &group.region {
        if group.shape == GrainShape::Bonded {
            let key = format!("grains.{index}.shape");
            return Err(document.error(&key, "\"bonded\"", "`fill`, which bonded stones need").into());
        }
        return regions::scattered(document, index, group, region, &model, part);
    }
    given(document, index, group, &model, part)
}

/// Grips and groups that are recorded.
fn prescribed(
    document: &Document,
    index: usize,
    group: &Grains,
    part: &mut GrainsPart,
) -> Result<(), SceneError> {
    let number = part.parts.len() as u32 - 1;
    if let Some(motion) = &group.motion {
        for (k, present) in [("velocity", group.velocity.is_some()), ("spin", group.spin.is_some())] {
            if present {
                let key = format!("grains.{index}.{k}");
                return Err(document.error(&key, "a value", "no such key beside `motion`"));
            }
        }
        part.moving.push(Moving { part: number, velocity: Vec3::from(vector(motion)) });
    }
    if group.record.unwrap_or(group.motion.is_some()) {
        part.recorded_groups.push(number);
    }
    Ok(())
}

/// Refuses keys that the source of the grains has no use for.
fn refuse_idle_keys(document: &Document, index: usize, group: &Grains) -> Result<(), SceneError> {
    let random = group.fill.is_some() || group.region.is_some() || flow::waits(group);
    let shapes = random || (group.packing.is_some() && group.shape == GrainShape::Clump);
    for (k, present, used, needs) in [
        ("count", group.count.is_some(), random, "`fill` or `region`"),
        ("gradation", group.gradation.is_some(), random, "`fill` or `region`"),
        ("size", group.size.is_some(), random, "`fill` or `region`"),
        ("sizes", group.sizes.is_some(), random, "`fill` or `region`"),
        ("library", group.library.is_some(), shapes, "`fill`, `region`, or a `packing` of clumps"),
        ("concentration", group.concentration.is_some(), group.region.is_some(), "`region`"),
        ("growth", group.growth.is_some(), group.region.is_some(), "`region`"),
        ("bond", group.bond.is_some(), group.shape == GrainShape::Bonded, "`shape = \"bonded\"`"),
    ] {
        if present && !used {
            let key = format!("grains.{index}.{k}");
            return Err(document.error(&key, "a value", format!("no such key without {needs}")));
        }
    }
    Ok(())
}

/// Grains whose places are given.
fn given(
    document: &Document,
    index: usize,
    group: &Grains,
    model: &BodyInput,
    part: &mut GrainsPart,
) -> Result<(), Failure> {
    let key = |k: &str| format!("grains.{index}.{k}");
    if group.shape == GrainShape::Bonded {
        let expected = "`fill`, which bonded stones need";
        return Err(document.error(&key("shape"), "\"bonded\"", expected).into());
    }
    if group.shape == GrainShape::Clump {
        let Some(file) = &group.packing else {
            let expected = "`fill`, `region` or `packing`, which clumps need";
            return Err(document.error(&key("shape"), "\"clump\"", expected).into());
        };
        let first = part.shapes.len();
        let stones = shapes(document, index, group, part)?.len();
        let placed = tables::clump_packing(&document.resolve(file), stones)?;
        part.bodies.extend(placed.iter().map(|p| {
            let [w, x, y, z] = p.orientation;
            let q = nalgebra::Quaternion::new(w, x, y, z);
            // A packing that a run has written comes back bit for bit; one by hand may be rounded.
            let exact = (q.norm_squared() - 1.0).abs() < 1e-14;
            BodyInput {
                shape: first + p.stone,
                scale: p.scale,
                position: Vec3::from(p.position),
                orientation: if exact {
                    UnitQuaternion::new_unchecked(q)
                } else {
                    UnitQuaternion::new_normalize(q)
                },
                ..model.clone()
            }
        }));
        return Ok(());
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
    let (first, first_body) = (part.shapes.len(), part.bodies.len());
    let grains = sampled(document, index, group, part, "the number of grains to fill in")?;
    let radii: Vec<f64> = grains.iter().map(|b| b.scale * bounding_radius(&part.shapes[b.shape])).collect();

    let mut low = vector(&fill.low);
    let high = [fill.high[0].si, fill.high[1].si];
    low[2] = low[2].max(top_of(part, low, high));
    let placed = place::place_loose(low, high, &radii, group.seed)
        .map_err(|e| document.error(&key("fill"), e.to_string(), "a box that holds the grains"))?;
    part.bodies.extend(placed.iter().zip(&grains).map(|(place, grain)| BodyInput {
        shape: grain.shape,
        scale: grain.scale,
        position: place.position,
        orientation: place.orientation,
        ..model.clone()
    }));
    if group.shape == GrainShape::Bonded {
        bonded::expand(document, index, group, first_body, first, part)?;
    }
    Ok(())
}

/// Shape and scale of a grain.
#[derive(Clone, Copy)]
pub(super) struct Sampled {
    pub shape: usize,
    pub scale: f64,
}

/// Adds the shapes of a group of `count` grains and draws their sizes; `expected` says what the count is. A group with a
/// gradation is noted, so that the run tells how its grains meet the curve.
pub(super) fn sampled(
    document: &Document,
    index: usize,
    group: &Grains,
    part: &mut GrainsPart,
    expected: &str,
) -> Result<Vec<Sampled>, Failure> {
    let key = format!("grains.{index}.count");
    let count = group.count.ok_or_else(|| document.error(&key, "nothing", expected))?;
    check(document, &key, Some(count as f64), |n| (1.0..=1e7).contains(&n), "1 to 10000000")?;
    let first = part.shapes.len();
    let unit_scale = shapes(document, index, group, part)?;
    let source = SizeSource::of(document, index, group)?;
    let sizes = source.sample(count, group.seed);
    let dealt = deal(&sizes, unit_scale.len());
    if let SizeSource::Graded(grading) = source
        && group.shape != GrainShape::Bonded
    {
        part.graded.push(GradedGroup { part: index as u32, name: group.name.clone(), grading });
    }
    let grains = sizes.iter().zip(dealt);
    Ok(grains.map(|(size, d)| Sampled { shape: first + d, scale: size * unit_scale[d] }).collect())
}

/// Adds the shapes of a filled group; returns the scale that gives each a sieve size of 1 m, so that the scale of a
/// body is its sieve size.
pub(super) fn shapes(
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
        (GrainShape::Bonded, _) => bonded::stand_ins(document, index, group, part),
        (GrainShape::Sphere, Some(_)) => Err(document.error(&key, "a file", "no such key for spheres")),
        (GrainShape::Sphere, None) => {
            part.shapes.push(Shape::Sphere { radius: 0.5 });
            Ok(vec![1.0])
        }
    }
}

/// Deals `shapes` shapes out to grains in the order of their sizes, so that every shape has the sizes of all: mass per
/// size³ differs between shapes, and would else make the sieve curve err.
pub(super) fn deal(sizes: &[f64], shapes: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by(|&a, &b| sizes[a].total_cmp(&sizes[b]));
    let mut dealt = vec![0; sizes.len()];
    order.into_iter().enumerate().for_each(|(rank, i)| dealt[i] = rank % shapes);
    dealt
}

/// Height above which a box is free of the grains that earlier groups have put there [m].
fn top_of(part: &GrainsPart, low: [f64; 3], high: [f64; 2]) -> f64 {
    let mut top = f64::NEG_INFINITY;
    for body in part.bodies.iter().filter(|b| !b.absent) {
        let r = body.scale * bounding_radius(&part.shapes[body.shape]);
        let over = (0..2).all(|d| body.position[d] + r > low[d] && body.position[d] - r < high[d]);
        if over && body.position.z + r > low[2] {
            top = top.max(body.position.z + r);
        }
    }
    top
}

/// Radius about the centre of mass that holds a grain of scale 1 [m].
pub(super) fn bounding_radius(shape: &Shape) -> f64 {
    match shape {
        Shape::Sphere { radius } => *radius,
        Shape::Clump(clump) => clump.bounding_radius(),
        Shape::Box { half } => half.iter().map(|h| h * h).sum::<f64>().sqrt(),
    }
}
