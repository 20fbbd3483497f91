//! `[[walls]]` resolved.

use super::{GrainsPart, check};
use crate::scene::units::vector;
use crate::scene::walls::{Wall, WallKind};
use crate::scene::{Document, SceneError};
use trackbed_dem::{Plane, TriangleSurface, Vec3};

/// Adds a wall.
pub(super) fn add(
    document: &Document,
    index: usize,
    wall: &Wall,
    material: usize,
    part: &mut GrainsPart,
) -> Result<(), SceneError> {
    let key = |k: &str| format!("walls.{index}.{k}");
    let velocity = wall.velocity.map_or(Vec3::zeros(), |v| Vec3::from(vector(&v)));
    let foreign: [(&str, bool); 4] = [
        ("vertices", wall.vertices.is_some() && wall.kind == WallKind::Plane),
        ("triangles", wall.triangles.is_some() && wall.kind == WallKind::Plane),
        ("point", wall.point.is_some() && wall.kind == WallKind::Triangles),
        ("normal", wall.normal.is_some() && wall.kind == WallKind::Triangles),
    ];
    if let Some((k, _)) = foreign.iter().find(|(_, present)| *present) {
        return Err(document.error(&key(k), "a value", "no such key for this kind of wall"));
    }
    match wall.kind {
        WallKind::Plane => {
            let point =
                wall.point.ok_or_else(|| document.error(&key("point"), "nothing", "a point of the plane"))?;
            let normal =
                wall.normal.ok_or_else(|| document.error(&key("normal"), "nothing", "the plane's normal"))?;
            let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
            check(
                document,
                &key("normal"),
                Some(length),
                |l| l > 0.0 && l.is_finite(),
                "a vector that is not null",
            )?;
            let point = Vec3::from(vector(&point));
            part.planes.push(Plane { point, normal: Vec3::from(normal), material, velocity });
        }
        WallKind::Triangles => {
            let missing =
                |k: &str| document.error(&key(k), "nothing", "the vertices and triangles of the wall");
            let vertices = wall.vertices.as_ref().ok_or_else(|| missing("vertices"))?;
            let triangles = wall.triangles.clone().ok_or_else(|| missing("triangles"))?;
            if let Some(bad) = triangles.iter().flatten().find(|v| **v as usize >= vertices.len()) {
                let expected = format!("0 to {}", vertices.len().max(1) - 1);
                return Err(document.error(&key("triangles"), format!("vertex {bad}"), expected));
            }
            let vertices = vertices.iter().map(|v| Vec3::from(vector(v))).collect();
            part.triangles.push(TriangleSurface { vertices, triangles, material, velocity });
        }
    }
    Ok(())
}
