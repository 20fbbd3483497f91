//! Grain shapes and sizes.

use super::bonded;
use super::part::{GradedGroup, GroupsPart};
use super::sizes::SizeSource;
use crate::model::tables;
use crate::scene::grains::{GrainShape, Grains};
use crate::scene::{SceneError, Table, setting};
use trackbed_dem::shape::Shape;
use trackbed_dem::shape::dilated::Dilated;
use trackbed_io::failure::Failure;

pub(super) const MOST: f64 = 1e7;

#[derive(Clone, Copy)]
pub(super) struct Sampled {
    pub shape: usize,
    pub scale: f64,
}

pub(super) fn sampled(
    group: &Table<Grains>,
    part: &mut GroupsPart,
    expected: &str,
) -> Result<Vec<Sampled>, Failure> {
    let count = group.need("count", group.count, expected)?;
    group.check("count", count, |n| (1.0..=MOST).contains(&n), "1 to 10000000")?;
    let first = part.shapes.len();
    let unit_scale = shapes(group, part)?;
    let source = SizeSource::of(group)?;
    Ok(drawn(group, part, source, count, (first, &unit_scale)))
}

/// Draws grains of shapes from `first` on.
pub(super) fn drawn(
    group: &Table<Grains>,
    part: &mut GroupsPart,
    source: SizeSource,
    count: usize,
    (first, unit_scale): (usize, &[f64]),
) -> Vec<Sampled> {
    let sizes = source.sample(count, group.seed);
    let dealt = deal(&sizes, unit_scale.len());
    if let SizeSource::Graded(grading) = source
        && group.shape != GrainShape::Bonded
    {
        part.graded.push(GradedGroup {
            part: part.names.len() as u32 - 1,
            name: group.name.clone(),
            grading,
        });
    }
    let grains = sizes.iter().zip(dealt);
    grains.map(|(size, d)| Sampled { shape: first + d, scale: size * unit_scale[d] }).collect()
}

/// Returns volumes at a sieve size of 1 m, by shape from `first` on [m³].
pub(super) fn unit_volumes(
    group: &Table<Grains>,
    part: &GroupsPart,
    first: usize,
    unit_scale: &[f64],
) -> Result<Vec<f64>, SceneError> {
    if group.shape == GrainShape::Bonded {
        return bonded::volumes(group);
    }
    let own = part.shapes[first..].iter().zip(unit_scale);
    Ok(own.map(|(shape, scale)| shape.query(|s| s.volume()) * scale.powi(3)).collect())
}

/// Returns scales for a sieve size of 1 m.
pub(super) fn shapes(group: &Table<Grains>, part: &mut GroupsPart) -> Result<Vec<f64>, SceneError> {
    match (group.shape, &group.library) {
        (GrainShape::Clump, Some(file)) => {
            let clumps = tables::stones(&group.locate(file))?;
            part.shapes.extend(clumps.iter().cloned().map(Shape::Clump));
            Ok(clumps.iter().map(|c| 1.0 / c.sieve_size()).collect())
        }
        (GrainShape::Clump, None) => Err(group.missing("library", "the stone library of the clumps")),
        (GrainShape::Polyhedron, Some(file)) => {
            let stones = tables::polyhedra(&group.locate(file))?;
            let scales = stones.iter().map(|s| 1.0 / s.sieve_size()).collect();
            part.shapes.extend(stones.into_iter().map(|s| Shape::Polyhedron(Box::new(s))));
            Ok(scales)
        }
        (GrainShape::Polyhedron, None) => Err(group.missing("library", "the stone library of the polyhedra")),
        (GrainShape::Disk, None) => {
            let expected = "the thickness of the disks over their diameter";
            let aspect = group.need("aspect", group.aspect, expected)?;
            group.check("aspect", aspect, |a| a > 0.0 && a < 1.0, "above 0, below 1")?;
            let disk = Dilated::disk(0.5 - 0.5 * aspect, 0.5 * aspect)
                .map_err(|e| group.error("aspect", e.to_string(), "above 0, below 1"))?;
            part.shapes.push(Shape::Polyhedron(Box::new(disk)));
            Ok(vec![1.0])
        }
        (GrainShape::Disk, Some(_)) => Err(group.conflict("library", setting("shape", &["disk"]))),
        (GrainShape::Bonded, _) => bonded::stand_ins(group, part),
        (GrainShape::Sphere, Some(_)) => {
            Err(group.no_effect("library", setting("shape", &["clump", "polyhedron", "bonded"])))
        }
        (GrainShape::Sphere, None) => {
            part.shapes.push(Shape::Sphere { radius: 0.5 });
            Ok(vec![1.0])
        }
    }
}

/// Shape and keys that place its grains; `None`: coordinates do.
pub(super) fn placing(shape: GrainShape) -> Option<(&'static str, &'static str)> {
    Some(match shape {
        GrainShape::Sphere => return None,
        GrainShape::Bonded => ("\"bonded\"", "`fill`, which bonded stones need"),
        GrainShape::Clump => ("\"clump\"", "`fill`, `region` or `packing`, which clumps need"),
        GrainShape::Polyhedron => {
            ("\"polyhedron\"", "`fill`, `region`, `packing`, `floes` or `frustum`, which polyhedra need")
        }
        GrainShape::Disk => ("\"disk\"", "`fill`, `region`, `packing` or `floes`, which disks need"),
    })
}

/// Deals shapes in order of size: mass per size³ differs between shapes, which would bias the sieve curve.
pub(super) fn deal(sizes: &[f64], shapes: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by(|&a, &b| sizes[a].total_cmp(&sizes[b]));
    let mut dealt = vec![0; sizes.len()];
    order.into_iter().enumerate().for_each(|(rank, i)| dealt[i] = rank % shapes);
    dealt
}
