//! Shapes of walls.

use crate::scene::units::vector;
use crate::scene::walls::{Wall, WallKind};
use crate::scene::{SceneError, Table, kinds};
use trackbed_dem::{Vec3, WallShape};
use trackbed_io::failure::Failure;
use trackbed_io::read::{read_surface, surface_unit};

/// Rejects keys of other kinds.
fn own_keys(wall: &Table<Wall>) -> Result<(), SceneError> {
    use WallKind::{Cone, Cylinder, Mesh, Plane, Sphere, Triangles};
    let keys: [(&str, bool, &[WallKind]); 13] = [
        ("point", wall.point.is_some(), &[Plane]),
        ("normal", wall.normal.is_some(), &[Plane]),
        ("vertices", wall.vertices.is_some(), &[Triangles]),
        ("triangles", wall.triangles.is_some(), &[Triangles]),
        ("file", wall.file.is_some(), &[Mesh]),
        ("scale", wall.scale.is_some(), &[Mesh]),
        ("translation", wall.translation.is_some(), &[Mesh]),
        ("base", wall.base.is_some(), &[Cylinder, Cone, Sphere]),
        ("axis", wall.axis.is_some(), &[Cylinder, Cone]),
        ("height", wall.height.is_some(), &[Cylinder, Cone]),
        ("radius", wall.radius.is_some(), &[Cylinder, Sphere]),
        ("radii", wall.radii.is_some(), &[Cone]),
        ("caps", wall.caps.is_some(), &[Cylinder, Cone]),
    ];
    match keys.iter().find(|(_, present, of)| *present && !of.contains(&wall.kind)) {
        Some((key, _, of)) => Err(wall.no_effect(key, kinds(of))),
        None => Ok(()),
    }
}

pub(super) fn shape(wall: &Table<Wall>) -> Result<WallShape, Failure> {
    own_keys(wall)?;
    let axis =
        || -> Result<Vec3, SceneError> { direction(wall, "axis", wall.axis.unwrap_or([0.0, 0.0, 1.0])) };
    let base = || {
        wall.base
            .map(|b| Vec3::from(vector(&b)))
            .ok_or_else(|| wall.missing("base", "the middle of the first end, or of a sphere"))
    };
    let height = || wall.need("height", wall.height.map(|h| h.si), "the distance of the two ends");
    let radius = || wall.need("radius", wall.radius.map(|r| r.si), "the radius");
    Ok(match wall.kind {
        WallKind::Plane => {
            let point = wall.need("point", wall.point, "a point of the plane")?;
            let normal = wall.need("normal", wall.normal, "the plane's normal")?;
            direction(wall, "normal", normal)?;
            WallShape::Plane { point: Vec3::from(vector(&point)), normal: Vec3::from(normal) }
        }
        WallKind::Triangles => triangles(wall)?,
        WallKind::Mesh => mesh(wall)?,
        WallKind::Cylinder => {
            let (radius, height) = (radius()?, height()?);
            wall.check("radius", radius, |x| x > 0.0, "a length above 0")?;
            wall.check("height", height, |x| x > 0.0, "a length above 0")?;
            let caps = wall.caps.unwrap_or_default();
            WallShape::Frustum { base: base()?, axis: axis()?, height, radii: [radius; 2], caps }
        }
        WallKind::Cone => {
            let radii = wall.need("radii", wall.radii, "the radii of the two ends")?.map(|r| r.si);
            let height = height()?;
            check_cone(wall, radii, height)?;
            WallShape::Frustum {
                base: base()?,
                axis: axis()?,
                height,
                radii,
                caps: wall.caps.unwrap_or_default(),
            }
        }
        WallKind::Sphere => {
            let radius = radius()?;
            wall.check("radius", radius, |x| x > 0.0, "a length above 0")?;
            WallShape::Sphere { centre: base()?, radius }
        }
    })
}

fn triangles(wall: &Table<Wall>) -> Result<WallShape, SceneError> {
    let expected = "the vertices and triangles of the wall";
    let vertices = wall.need("vertices", wall.vertices.as_ref(), expected)?;
    let triangles = wall.need("triangles", wall.triangles.clone(), expected)?;
    if let Some(bad) = triangles.iter().flatten().find(|v| **v as usize >= vertices.len()) {
        let expected = format!("0 to {}", vertices.len().max(1) - 1);
        return Err(wall.error("triangles", format!("vertex {bad}"), expected));
    }
    Ok(WallShape::Triangles { vertices: vertices.iter().map(|v| Vec3::from(vector(v))).collect(), triangles })
}

fn mesh(wall: &Table<Wall>) -> Result<WallShape, Failure> {
    let Some(file) = &wall.file else {
        let expected = "a surface file: .stl, .obj, or a plain list";
        return Err(wall.missing("file", expected).into());
    };
    let scale = wall.scale.unwrap_or(1.0);
    wall.check("scale", scale, |s| s > 0.0, "above 0")?;
    let shift = wall.translation.map_or(Vec3::zeros(), |t| Vec3::from(vector(&t)));
    let path = wall.locate(file);
    if let Some(error) = surface_unit(&path).filter(|_| wall.scale.is_none()) {
        return Err(error.into());
    }
    let surface = read_surface(&path)?;
    let vertices: Vec<Vec3> = surface.vertices.iter().map(|v| Vec3::from(*v) * scale + shift).collect();
    let triangles = with_area(&vertices, surface.triangles);
    if triangles.is_empty() {
        return Err(wall.error("file", "no triangle with an area", "at least one").into());
    }
    Ok(WallShape::Triangles { vertices, triangles })
}

fn check_cone(wall: &Table<Wall>, radii: [f64; 2], height: f64) -> Result<(), SceneError> {
    wall.check("height", height, |h| h >= 0.0, "0 or more")?;
    for r in radii {
        wall.check("radii", r, |r| r >= 0.0, "0 or more")?;
    }
    if radii[0].max(radii[1]) > 0.0 && (height > 0.0 || radii[0] != radii[1]) {
        return Ok(());
    }
    let found = format!("[{}, {}]", radii[0], radii[1]);
    Err(wall.error("radii", found, "radii that give the cone an area"))
}

/// Removes degenerate triangles; their neighbours cover any contact.
fn with_area(vertices: &[Vec3], mut triangles: Vec<[u32; 3]>) -> Vec<[u32; 3]> {
    triangles.retain(|t| {
        let [a, b, c] = t.map(|v| vertices[v as usize]);
        let longest2 = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
        (b - a).cross(&(c - a)).norm() > 2e-9 * longest2
    });
    triangles
}

pub(super) fn direction<T>(table: &Table<T>, key: &str, v: [f64; 3]) -> Result<Vec3, SceneError> {
    let length = Vec3::from(v).norm();
    table.check(key, length, |l| l > 0.0 && l.is_finite(), "a vector that is not null")?;
    Ok(Vec3::from(v) / length)
}
