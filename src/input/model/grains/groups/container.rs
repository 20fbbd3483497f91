//! `region` of `[[grains]]` resolved.

use crate::model::grains::check::region as box_region;
use crate::scene::grains::Region;
use crate::scene::units::vector;
use crate::scene::{SceneError, Table};
use trackbed_dem::Vec3;
use trackbed_dem::insert::closed::ClosedSurface;
use trackbed_dem::insert::container::Container;
use trackbed_dem::measure::BoxRegion;
use trackbed_io::read::{read_surface, surface_unit};

pub(super) fn container(region: &Table<Region>) -> Result<Container, SceneError> {
    let sources = [
        ("box", region.cuboid.is_some()),
        ("cone", region.cone.is_some()),
        ("surface", region.surface.is_some()),
    ];
    if sources.iter().filter(|(_, present)| *present).count() != 1 {
        return Err(region.one_of(&sources));
    }
    if region.surface.is_none() {
        let idle = [("scale", region.scale.is_some()), ("shift", region.shift.is_some())];
        region.reject_without(idle, "`surface`")?;
    }
    if let Some(corners) = &region.cuboid {
        let BoxRegion { low, high } = box_region(region, "box", corners)?;
        return Ok(Container::Box { low, high });
    }
    if let Some(cone) = region.optional("cone", &region.cone) {
        let (from, to) = (Vec3::from(vector(&cone.from)), Vec3::from(vector(&cone.to)));
        let radii = cone.radii.map(|r| r.si);
        let length = (to - from).norm();
        cone.check("to", length, |l| l > 0.0, "another point than `from`")?;
        for r in radii {
            cone.check("radii", r, |r| r >= 0.0, "0 or more")?;
        }
        cone.check("radii", radii[0] + radii[1], |r| r > 0.0, "one radius above 0")?;
        return Ok(Container::Cone { from, to, from_radius: radii[0], to_radius: radii[1] });
    }
    let Some(file) = &region.surface else { unreachable!("one of the three is there") };
    surface(region, file)
}

fn surface(region: &Table<Region>, file: &std::path::Path) -> Result<Container, SceneError> {
    let path = region.locate(file);
    if let Some(error) = surface_unit(&path).filter(|_| region.scale.is_none()) {
        return Err(error);
    }
    let surface = read_surface(&path)?;
    let scale = region.check("scale", region.scale.unwrap_or(1.0), |s| s > 0.0, "above 0")?;
    let shift = region.shift.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v)));
    let vertices: Vec<Vec3> = surface.vertices.iter().map(|v| Vec3::from(*v) * scale + shift).collect();
    ClosedSurface::new(&vertices, &surface.triangles)
        .map(Container::Surface)
        .map_err(|e| region.error("surface", e.to_string(), "a closed surface"))
}
