//! Stones that can break: each sphere of a bonded stone is a body, and the bonds of the library join them.

use super::part::GroupsPart;
use crate::failure::Failure;
use crate::model::grains::bonds::BondPart;
use crate::model::tables;
use crate::scene::grains::Grains;
use crate::scene::{SceneError, Table};
use trackbed_dem::shape::Shape;
use trackbed_dem::shape::cluster::Cluster;
use trackbed_dem::{BodyInput, Vec3};

/// Turns the stones that a group was filled with, one body each, into their spheres and bonds. `first` is the first of
/// these bodies, `density` that of their material [kg/m³]; the shapes of the group are the stones of the library in their
/// order.
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
    // One unit sphere serves all; the stones' own shapes go.
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

/// The stones of a group's library as clusters.
pub(super) fn clusters(group: &Table<Grains>) -> Result<Vec<Cluster>, SceneError> {
    let file = group.need("library", group.library.as_ref(), "the library of the bonded stones")?;
    tables::clusters(&group.locate(file))
}

/// Shapes that stand for the stones while places are sought: spheres that hold them. Returns the scale that gives each
/// a sieve size of 1 m.
pub(super) fn stand_ins(group: &Table<Grains>, part: &mut GroupsPart) -> Result<Vec<f64>, SceneError> {
    let clusters = clusters(group)?;
    part.shapes.extend(clusters.iter().map(|c| Shape::Sphere { radius: c.bounding_radius() }));
    Ok(clusters.iter().map(|c| 1.0 / c.sieve_size()).collect())
}
