//! `region` of `[[grains]]` resolved: the container that grains are scattered in, or grown in.

use crate::model::grains::check::{check, region as box_region};
use crate::scene::grains::Region;
use crate::scene::units::vector;
use crate::scene::{Document, SceneError};
use trackbed_dem::Vec3;
use trackbed_dem::insert::closed::ClosedSurface;
use trackbed_dem::insert::container::Container;
use trackbed_dem::measure::BoxRegion;

/// The container of a group.
pub(super) fn container(document: &Document, index: usize, region: &Region) -> Result<Container, SceneError> {
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
        let BoxRegion { low, high } = box_region(document, &key("box"), corners)?;
        return Ok(Container::Box { low, high });
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
