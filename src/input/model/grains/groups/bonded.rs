//! Breakable grains: bonded spheres as separate bodies.

use super::part::GroupsPart;
use crate::model::grains::bonds::BondPart;
use crate::model::tables;
use crate::scene::grains::Grains;
use crate::scene::{SceneError, Table};
use trackbed_dem::shape::Shape;
use trackbed_dem::shape::cluster::Cluster;
use trackbed_dem::{BodyInput, Vec3};
use trackbed_io::failure::Failure;

/// Expands grains into spheres and bonds. `first`: first body; `density` [kg/m³].
pub(super) fn expand(
    group: &Table<Grains>,
    first: usize,
    density: f64,
    part: &mut GroupsPart,
    bonds: &mut BondPart,
) -> Result<(), Failure> {
    let first_shape = *part.first_shape.last().expect("the group was begun");
    let clusters = clusters(group)?;
    let expected = "the name of the [[bond]] that holds the stones together";
    let name = group.need("bond", group.bond.as_ref(), expected)?;
    let kind = bonds.of_group(group, name, false)?;
    let stones = part.bodies.split_off(first);
    // One unit sphere replaces all grain shapes.
    part.shapes.truncate(first_shape);
    part.shapes.push(Shape::Sphere { radius: 1.0 });
    for stone in stones {
        let cluster = &clusters[stone.shape - first_shape];
        let start = part.bodies.len();
        for (centre, radius) in &cluster.spheres {
            let scale = radius * stone.scale;
            let volume = 4.0 / 3.0 * std::f64::consts::PI * scale.powi(3);
            let arm = stone.orientation * (Vec3::from(*centre) * stone.scale);
            part.bodies.push(BodyInput {
                shape: first_shape,
                scale,
                position: stone.position + arm,
                orientation: nalgebra::UnitQuaternion::identity(),
                velocity: stone.velocity + stone.spin.cross(&arm),
                mass: Some(density * cluster.density_factor * volume),
                ..stone.clone()
            });
        }
        for bond in &cluster.bonds {
            bonds.join_stone(bond.map(|s| start + s as usize), kind);
        }
    }
    Ok(())
}

pub(super) fn clusters(group: &Table<Grains>) -> Result<Vec<Cluster>, SceneError> {
    let file = group.need("library", group.library.as_ref(), "the library of the bonded stones")?;
    tables::clusters(&group.locate(file))
}

/// Returns volumes at a sieve size of 1 m [m³].
pub(super) fn volumes(group: &Table<Grains>) -> Result<Vec<f64>, SceneError> {
    Ok(clusters(group)?.iter().map(|c| c.volume / c.sieve_size().powi(3)).collect())
}

/// Enclosing spheres as substitutes during placement.
pub(super) fn stand_ins(group: &Table<Grains>, part: &mut GroupsPart) -> Result<Vec<f64>, SceneError> {
    let clusters = clusters(group)?;
    part.shapes.extend(clusters.iter().map(|c| Shape::Sphere { radius: c.bounding_radius() }));
    Ok(clusters.iter().map(|c| 1.0 / c.sieve_size()).collect())
}
