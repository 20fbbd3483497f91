//! Grains with given positions.

use super::part::GroupsPart;
use super::shapes::{placing, shapes};
use crate::model::tables;
use crate::scene::Table;
use crate::scene::grains::{GrainShape, Grains};
use nalgebra::UnitQuaternion;
use std::path::Path;
use trackbed_dem::shape::Shape;
use trackbed_dem::{BodyInput, Vec3};
use trackbed_io::failure::Failure;

pub(super) fn given(group: &Table<Grains>, model: &BodyInput, part: &mut GroupsPart) -> Result<(), Failure> {
    let Some((found, expected)) = placing(group.shape) else { return spheres(group, model, part) };
    match &group.packing {
        Some(file) if group.shape != GrainShape::Bonded => stones(group, file, model, part),
        _ => Err(group.error("shape", found, expected).into()),
    }
}

fn stones(
    group: &Table<Grains>,
    file: &Path,
    model: &BodyInput,
    part: &mut GroupsPart,
) -> Result<(), Failure> {
    let first = part.shapes.len();
    let stones = shapes(group, part)?.len();
    let placed = tables::stone_packing(&group.locate(file), stones)?;
    part.bodies.extend(placed.iter().map(|p| {
        let [w, x, y, z] = p.orientation;
        let q = nalgebra::Quaternion::new(w, x, y, z);
        // Written packings are bitwise; typed quaternions may be rounded.
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
    Ok(())
}

fn spheres(group: &Table<Grains>, model: &BodyInput, part: &mut GroupsPart) -> Result<(), Failure> {
    let spheres = match (&group.spheres, &group.packing) {
        (Some(list), _) => {
            for s in list {
                group.check("spheres", s[3], |r| r > 0.0, "a radius above 0")?;
            }
            list.iter().map(|s| ([s[0].si, s[1].si, s[2].si], s[3].si)).collect()
        }
        (_, Some(file)) => tables::packing(&group.locate(file))?,
        _ => Vec::new(),
    };
    if spheres.is_empty() {
        return Err(group.error("spheres", "none", "at least one sphere").into());
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
