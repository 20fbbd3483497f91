//! `[[walls]]` resolved.

mod motion;
mod shape;

use super::check::find;
use crate::failure::Failure;
use crate::scene::walls::{Wall, WallKind};
use crate::scene::{Document, Scene};
use motion::{body, motion, servo};
use shape::shape;
use trackbed_dem::{Plane, Vec3, WallInput, WallShape};

/// The walls of a scene.
#[derive(Clone, Default)]
pub struct WallsPart {
    /// Plain planes.
    pub planes: Vec<Plane>,
    /// All others.
    pub others: Vec<WallInput>,
    /// Those whose force goes to the history.
    pub recorded: Vec<Recorded>,
}

/// A wall whose force is written to the history.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// Name of the wall.
    pub name: String,
    /// Number among the walls other than plain planes.
    pub wall: usize,
}

/// The keys that only some kinds of wall have.
const SPECIAL: [(&str, &[WallKind]); 12] = [
    ("point", &[WallKind::Plane]),
    ("normal", &[WallKind::Plane]),
    ("vertices", &[WallKind::Triangles]),
    ("triangles", &[WallKind::Triangles]),
    ("file", &[WallKind::Mesh]),
    ("scale", &[WallKind::Mesh]),
    ("translation", &[WallKind::Mesh]),
    ("base", &[WallKind::Cylinder, WallKind::Cone, WallKind::Sphere]),
    ("axis", &[WallKind::Cylinder, WallKind::Cone]),
    ("height", &[WallKind::Cylinder, WallKind::Cone]),
    ("radius", &[WallKind::Cylinder, WallKind::Sphere]),
    ("radii", &[WallKind::Cone]),
];

/// `[[walls]]` resolved.
pub(super) fn build(document: &Document, scene: &Scene) -> Result<WallsPart, Failure> {
    let mut part = WallsPart::default();
    for (i, wall) in scene.walls.iter().enumerate() {
        let material = find(document, scene, &format!("walls.{i}.material"), &wall.material)?;
        let before = part.others.len();
        add(document, i, wall, material, &mut part)?;
        let new = part.others.get(before).map(|w| &w.shape);
        if scene.track.is_some() && matches!(new, Some(WallShape::Plane { .. })) {
            let expected =
                "a plane without `record` and motions other than `velocity`: a sleeper touches no other";
            return Err(document.error(&format!("walls.{i}"), "a plane that is more", expected).into());
        }
    }
    Ok(part)
}

/// Adds a wall.
fn add(
    document: &Document,
    index: usize,
    wall: &Wall,
    material: usize,
    part: &mut WallsPart,
) -> Result<(), Failure> {
    let key = |k: &str| format!("walls.{index}.{k}");
    let present = |k: &str| match k {
        "point" => wall.point.is_some(),
        "normal" => wall.normal.is_some(),
        "vertices" => wall.vertices.is_some(),
        "triangles" => wall.triangles.is_some(),
        "file" => wall.file.is_some(),
        "scale" => wall.scale.is_some(),
        "translation" => wall.translation.is_some(),
        "base" => wall.base.is_some(),
        "axis" => wall.axis.is_some(),
        "height" => wall.height.is_some(),
        "radius" => wall.radius.is_some(),
        _ => wall.radii.is_some(),
    };
    let foreign = |(k, kinds): &&(&str, &[WallKind])| present(k) && !kinds.contains(&wall.kind);
    if let Some((k, _)) = SPECIAL.iter().find(foreign) {
        return Err(document.error(&key(k), "a value", "no such key for this kind of wall").into());
    }
    if wall.caps.is_some() && !matches!(wall.kind, WallKind::Cylinder | WallKind::Cone) {
        return Err(document.error(&key("caps"), "a value", "no such key for this kind of wall").into());
    }
    let shape = shape(document, index, wall)?;
    let motion = motion(document, index, wall)?;
    let name = wall.name.clone().unwrap_or_else(|| format!("wall{index}"));
    if wall.record && part.recorded.iter().any(|r| r.name == name) {
        return Err(document.error(&key("name"), format!("\"{name}\""), "a name of its own").into());
    }
    let plain = motion.angular_velocity == Vec3::zeros()
        && motion.oscillation.is_none()
        && wall.servo.is_none()
        && wall.body.is_none()
        && !wall.record;
    if let (WallShape::Plane { point, normal }, true) = (&shape, plain) {
        part.planes.push(Plane { point: *point, normal: *normal, material, velocity: motion.velocity });
        return Ok(());
    }
    let servo = servo(document, index, wall)?;
    let body = body(document, index, wall)?;
    if wall.record {
        part.recorded.push(Recorded { name, wall: part.others.len() });
    }
    part.others.push(WallInput { shape, material, motion, servo, body });
    Ok(())
}
