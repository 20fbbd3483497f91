//! `[[walls]]` resolved.

mod afloat;
mod motion;
mod scarring;
mod shape;

use super::check::find;
use crate::scene::walls::{Wall, WallKind};
use crate::scene::water::Water;
use crate::scene::{Scene, Table};
use motion::{body, motion, servo};
use scarring::scarring;
use shape::shape;
use trackbed_dem::{Plane, WallInput};
use trackbed_io::failure::Failure;

/// The walls of a scene.
#[derive(Clone, Default)]
pub struct WallsPart {
    /// Planes at constant velocity.
    pub planes: Vec<Plane>,
    /// Other walls.
    pub others: Vec<WallInput>,
    /// Names of the other walls.
    pub names: Vec<String>,
    /// Names of the planes.
    pub plane_names: Vec<String>,
    /// Walls with recorded force.
    pub recorded: Vec<Recorded>,
}

/// Wall with recorded force.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// Wall name.
    pub name: String,
    /// Index among non-planar walls.
    pub wall: usize,
}

pub(super) fn build(scene: &Table<Scene>) -> Result<WallsPart, Failure> {
    let mut part = WallsPart::default();
    for (i, wall) in scene.rows("walls", &scene.walls).enumerate() {
        let material = find(scene, &wall, "material", &wall.material)?;
        let before = part.others.len();
        add(&wall, scene.water.as_ref(), (i, material), &mut part)?;
        let new = part.others.get(before).map(|w| &w.shape);
        if scene.track.is_some() && new.is_some_and(|shape| shape.plane().is_some()) {
            let expected = "a plane with no key but `velocity`: sleepers contact only such planes";
            return Err(wall.here("a plane with other keys", expected).into());
        }
    }
    Ok(part)
}

/// Planes at rest or constant velocity: indexed separately, because sleepers contact them and compaction
/// moves them.
pub fn is_plain(wall: &Wall) -> bool {
    wall.kind == WallKind::Plane
        && wall.angular_velocity.is_none_or(|turn| turn.iter().all(|w| w.si == 0.0))
        && wall.oscillation.is_none()
        && wall.servo.is_none()
        && wall.body.is_none()
        && wall.scarring.is_none()
        && !wall.record
}

fn add(
    wall: &Table<Wall>,
    water: Option<&Water>,
    (index, material): (usize, usize),
    part: &mut WallsPart,
) -> Result<(), Failure> {
    let shape = shape(wall)?;
    let motion = motion(wall)?;
    let name = wall.name.clone().unwrap_or_else(|| format!("wall{index}"));
    if wall.record && part.recorded.iter().any(|r| r.name == name) {
        return Err(wall.error("name", format!("\"{name}\""), "a unique name").into());
    }
    if let (Some((point, normal)), true) = (shape.plane(), is_plain(wall)) {
        part.plane_names.push(name);
        part.planes.push(Plane { point: *point, normal: *normal, material, velocity: motion.velocity });
        return Ok(());
    }
    let servo = servo(wall)?;
    let (body, scarring) = (body(wall, &shape, water)?, scarring(wall)?);
    part.names.push(name.clone());
    if wall.record {
        part.recorded.push(Recorded { name, wall: part.others.len() });
    }
    part.others.push(WallInput { shape, material, motion, servo, body, scarring });
    Ok(())
}
