//! Nets and geogrids: spheres along the ribs of rectangular meshes.

use super::net_group::{Geometry, NetGroup, Place, joined, places};
use super::part::GroupsPart;
use super::shapes::MOST;
use crate::model::grains::bonds::BondPart;
use crate::scene::grains::{GrainShape, Grains, Net, NetSide};
use crate::scene::units::vector;
use crate::scene::{SceneError, Table};
use std::collections::BTreeMap;
use trackbed_dem::shape::Shape;
use trackbed_dem::{BodyInput, Vec3};

pub(super) fn net(
    group: &Table<Grains>,
    net: &Table<Net>,
    model: &BodyInput,
    part: &mut GroupsPart,
    bonds: &mut BondPart,
) -> Result<(), SceneError> {
    if group.shape != GrainShape::Sphere {
        return Err(group.error("shape", "another shape", "\"sphere\", which a net consists of"));
    }
    let geometry = geometry(net)?;
    let shape = part.add_shape(Shape::Sphere { radius: 1.0 });
    let mut bodies = BTreeMap::new();
    for place in places(geometry.last, geometry.each).filter(|p| kept(net, *p, geometry.last)) {
        bodies.insert(place, part.bodies.len());
        let position = geometry.position(place);
        part.bodies.push(BodyInput { shape, scale: net.radius.si, position, ..model.clone() });
    }
    if bodies.is_empty() {
        let key = if net.only.is_empty() { "without" } else { "only" };
        return Err(net.error(key, "no spheres are left", "sides that leave spheres"));
    }
    let kind = group.bond.as_ref().map(|name| bonds.of_group(group, name, false)).transpose()?;
    let this = NetGroup { part: model.part, kind, geometry, bodies };
    if let Some(kind) = kind {
        for (pair, axis) in joined(&this, &part.nets) {
            bonds.join_net(pair, kind, this.geometry.steps[axis].norm());
        }
    }
    let alike = |n: &&NetGroup| n.kind.is_some() && n.kind == this.kind;
    let mut others = part.nets.iter().filter(alike).peekable();
    if others.peek().is_some() && !others.any(|n| n.geometry.matches(&this.geometry)) {
        part.remarks.push(format!(
            "grains \"{}\": its net has another place, size or mesh than the other nets of its bond and is not joined to them",
            group.name
        ));
    }
    part.nets.push(this);
    Ok(())
}

fn geometry(net: &Table<Net>) -> Result<Geometry, SceneError> {
    let each =
        net.check("spheres_per_rib", net.spheres_per_rib, |n| (1.0..=100.0).contains(&n), "1 to 100")?;
    let each = each.unwrap_or(1);
    let last = last(net, each)?;
    let steps = sides(net, last)?;
    let spacing = steps.iter().map(Vec3::norm).filter(|l| *l > 0.0).fold(f64::INFINITY, f64::min);
    let expected = format!("above 0, at most half the distance of spheres, {spacing:.4} m");
    net.check("radius", net.radius, |r| r > 0.0 && r <= 0.5 * spacing, &expected)?;
    Ok(Geometry { corner: Vec3::from(vector(&net.corner)), steps, last, each })
}

/// Numbers of the last spheres along and across.
fn last(net: &Table<Net>, each: usize) -> Result<Place, SceneError> {
    let [m, n] = net.meshes;
    if m == 0 {
        return Err(net.error("meshes", "0 along", "1 or more along, 0 (one strand) or more across"));
    }
    let count = (m as f64 + 1.0) * (n as f64 + 1.0) * (2.0 * each as f64 - 1.0);
    if count > MOST {
        return Err(net.error("meshes", format!("about {count} spheres"), "at most 10000000 spheres"));
    }
    Ok([m * each, n * each])
}

/// Vectors from sphere to sphere [m].
fn sides(net: &Table<Net>, last: Place) -> Result<[Vec3; 2], SceneError> {
    let along = Vec3::from(vector(&net.along));
    net.check("along", along.norm(), |l| l > 0.0, "a vector, not zero")?;
    let across = match (&net.across, last[1]) {
        (None, 0) => return Ok([along / last[0] as f64, Vec3::zeros()]),
        (Some(_), 0) => return Err(net.no_effect("across", "meshes across")),
        (across, _) => Vec3::from(vector(&net.need("across", *across, "the second side of the net")?)),
    };
    let area = along.cross(&across).norm() / (along.norm() * across.norm());
    net.check("across", area, |a| a > 1e-3, "a vector, not zero, in another direction than `along`")?;
    Ok([along / last[0] as f64, across / last[1] as f64])
}

fn kept(net: &Net, [i, j]: Place, last: Place) -> bool {
    let on = |side: &NetSide| match side {
        NetSide::Start => i == 0,
        NetSide::End => i == last[0],
        NetSide::Left => j == 0 && last[1] > 0,
        NetSide::Right => j == last[1] && last[1] > 0,
    };
    (net.only.is_empty() || net.only.iter().any(on)) && !net.without.iter().any(on)
}
