//! `[[grains]]` resolved: given, filled, lattice, net, container, floes, frusta.

mod bonded;
mod container;
mod filled;
mod floes;
mod frustum;
mod given;
mod lattice;
mod net;
mod net_group;
mod pancakes;
mod part;
mod polygon;
mod scattered;
mod shapes;
mod sheet;
mod sizes;
mod sources;
mod target;
mod voronoi;
mod waiting;

pub use part::{FilledGroup, GradedGroup, GroupsPart};
pub use sources::waits;

use super::bonds::BondPart;
use super::check::find;
use super::materials::MaterialsPart;
use crate::scene::grains::{GrainShape, Grains};
use crate::scene::units::vector;
use crate::scene::{Scene, SceneError, Table};
use part::Moving;
use sources::sources;
use trackbed_dem::{BodyInput, Vec3};
use trackbed_io::failure::Failure;

/// Resolves `[[grains]]`; records grain materials and inner bonds.
pub(super) fn build(
    scene: &Table<Scene>,
    materials: &mut MaterialsPart,
    bonds: &mut BondPart,
) -> Result<GroupsPart, Failure> {
    let mut part = GroupsPart::default();
    for group in scene.rows("grains", &scene.grains) {
        let material = find(scene, &group, "material", &group.material)?;
        let of_grains = scene.row("material", &scene.material, material);
        of_grains.need("density", of_grains.density, "the density of a material of grains")?;
        if !materials.of_grains.contains(&material) {
            materials.of_grains.push(material);
        }
        if group.fouling {
            part.fouling.push(part.names.len() as u32);
        }
        if group.accept_overlap {
            part.overlapping.push(part.names.len() as u32);
        }
        part.names.push(group.name.clone());
        let density = materials.all[material].density;
        add(scene, &group, (material, density), &mut part, bonds)?;
    }
    if !part.fouling.is_empty() && part.fouling.len() == scene.grains.len() {
        let expected = "a second group without `fouling`";
        return Err(scene.error("grains.0.fouling", "true for all groups", expected).into());
    }
    Ok(part)
}

/// `(material, density)`: index, density [kg/m³].
fn add(
    scene: &Table<Scene>,
    group: &Table<Grains>,
    (material, density): (usize, f64),
    part: &mut GroupsPart,
    bonds: &mut BondPart,
) -> Result<(), Failure> {
    if group.inlet.is_some() && group.shape == GrainShape::Bonded {
        return Err(group.error("shape", "\"bonded\"", "no inlet for bonded stones").into());
    }
    let waits = waits(group);
    let sources = sources(group);
    if sources.iter().filter(|(_, present)| *present).count() != 1 && !waits {
        return Err(group.one_of(&sources).into());
    }
    let model = BodyInput {
        material,
        part: part.names.len() as u32 - 1,
        velocity: group.velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        spin: group.spin.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v))),
        ..BodyInput::default()
    };
    refuse_idle_keys(group)?;
    prescribed(group, part)?;
    part.first_shape.push(part.shapes.len());
    if waits {
        return waiting::waiting(group, &model, part);
    }
    if let Some(fill) = &group.fill {
        let first = part.bodies.len();
        filled::filled((scene, group), fill, (&model, density), part)?;
        if group.shape == GrainShape::Bonded {
            bonded::expand(group, first, density, part, bonds)?;
        }
        return Ok(());
    }
    if let Some(fill) = group.optional("lattice", &group.lattice) {
        lattice::spheres_only(group)?;
        return Ok(lattice::lattice(&fill, &model, part)?);
    }
    if let Some(net) = group.optional("net", &group.net) {
        return Ok(net::net(group, &net, &model, part, bonds)?);
    }
    if let Some(region) = group.optional("region", &group.region) {
        if group.shape == GrainShape::Bonded {
            return Err(group.error("shape", "\"bonded\"", "`fill`, which bonded stones need").into());
        }
        return scattered::scattered(group, &region, &model, part);
    }
    if let Some(field) = group.optional("floes", &group.floes) {
        floes::check(&field)?;
        if group.shape == GrainShape::Disk {
            return Ok(pancakes::pancakes(group, &field, &model, part)?);
        }
        let expected = "\"polyhedron\" or \"disk\", which floes are";
        only(group, expected)?;
        return Ok(floes::floes(group, &field, &model, part, bonds)?);
    }
    if let Some(frustum) = group.optional("frustum", &group.frustum) {
        only(group, "\"polyhedron\", which a frustum is")?;
        return Ok(frustum::frustum(&frustum, &model, part)?);
    }
    given::given(group, &model, part)
}

fn only(group: &Table<Grains>, expected: &str) -> Result<(), SceneError> {
    if group.shape == GrainShape::Polyhedron {
        return Ok(());
    }
    Err(group.error("shape", "another shape", expected))
}

fn prescribed(group: &Table<Grains>, part: &mut GroupsPart) -> Result<(), SceneError> {
    let number = part.names.len() as u32 - 1;
    if let Some(velocity) = &group.prescribed_velocity {
        let idle = [("velocity", group.velocity.is_some()), ("spin", group.spin.is_some())];
        group.reject_with(idle, "`prescribed_velocity`")?;
        part.moving.push(Moving { part: number, velocity: Vec3::from(vector(velocity)) });
    }
    if group.record.unwrap_or(group.prescribed_velocity.is_some()) {
        part.recorded.push(number);
    }
    Ok(())
}

fn refuse_idle_keys(group: &Table<Grains>) -> Result<(), SceneError> {
    let random = group.fill.is_some() || group.region.is_some() || waits(group);
    let shapes = random || (group.packing.is_some() && group.shape != GrainShape::Sphere);
    let disks = group.shape == GrainShape::Disk;
    let sized = random || (disks && group.floes.is_some());
    for (k, present, used, needs) in [
        ("count", group.count.is_some(), random, "`fill` or `region`"),
        ("target_height", group.target_height.is_some(), group.fill.is_some(), "`fill`"),
        ("target_mass", group.target_mass.is_some(), group.fill.is_some(), "`fill`"),
        ("porosity", group.porosity.is_some(), group.fill.is_some(), "`fill`"),
        ("gradation", group.gradation.is_some(), sized, "`fill` or `region`"),
        ("size", group.size.is_some(), sized, "`fill` or `region`"),
        ("sizes", group.sizes.is_some(), sized, "`fill` or `region`"),
        (
            "aspect",
            group.aspect.is_some(),
            disks && shapes,
            "`shape = \"disk\"` and `fill`, `region`, `packing` or only an `inlet`",
        ),
        ("library", group.library.is_some(), shapes, "`fill`, `region`, or a `packing` of stones"),
        ("solid_fraction", group.solid_fraction.is_some(), group.region.is_some(), "`region`"),
        ("growth", group.growth.is_some(), group.region.is_some(), "`region`"),
        (
            "bond",
            group.bond.is_some(),
            group.shape == GrainShape::Bonded || group.net.is_some() || (group.floes.is_some() && !disks),
            "`shape = \"bonded\"`, `net`, or `floes` that are polyhedra",
        ),
    ] {
        group.reject_without([(k, present && !used)], needs)?;
    }
    Ok(())
}
