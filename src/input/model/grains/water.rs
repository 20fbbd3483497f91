//! `[water]` resolved.

use crate::scene::units::vector;
use crate::scene::water::{DragArea, Water as Written};
use crate::scene::{Document, Scene, SceneError, Table};
use trackbed_dem::{DragArea as Area, Measured, Vec3, Water, Wave, WaveError};

/// Water of a scene, without the rest of it.
///
/// # Errors
/// Values out of range.
pub fn of_scene(document: &Document, scene: &Scene) -> Result<Option<Water>, SceneError> {
    build(&Table::root(document, scene), &Vec3::from(vector(&scene.gravity)))
}

pub(super) fn build(scene: &Table<Scene>, gravity: &Vec3) -> Result<Option<Water>, SceneError> {
    let Some(water) = scene.optional("water", &scene.water) else { return Ok(None) };
    if !(gravity.z < 0.0 && gravity.x == 0.0 && gravity.y == 0.0) {
        let found = format!("[{}, {}, {}] m/s2", gravity.x, gravity.y, gravity.z);
        return Err(scene.error("gravity", found, "gravity along -z with [water]"));
    }
    let current = water.current.map(|v| v.si);
    let speed = libm::hypot(current[0], current[1]);
    water.check("current", speed, |v| v <= 20.0, "at most 20 m/s")?;
    let density =
        water.check("density", water.density, |d| d > 0.0 && d <= 2e4, "above 0, at most 20000")?.si;
    for (key, value) in [
        ("drag", water.drag),
        ("skin_drag", water.skin_drag),
        ("drag_moment", water.drag_moment),
        ("added_mass", water.added_mass),
    ] {
        water.check(key, value, |c| (0.0..=100.0).contains(&c), "0 to 100")?;
    }
    Ok(Some(Water {
        level: water.level.si,
        density,
        current,
        wave: wave(&water, current, -gravity.z)?,
        drag: water.drag,
        drag_area: match water.drag_area {
            DragArea::Projected => Area::Projected,
            DragArea::Wetted => Area::Wetted,
        },
        skin_drag: water.skin_drag,
        drag_moment: water.drag_moment,
        added_mass: water.added_mass,
    }))
}

fn wave(water: &Table<Written>, current: [f64; 2], gravity: f64) -> Result<Option<Wave>, SceneError> {
    let depth = water.check("depth", water.depth, |d| d > 0.0, "above 0")?.map_or(f64::INFINITY, |d| d.si);
    let Some(wave) = water.optional("wave", &water.wave) else {
        water.reject_without([("depth", water.depth.is_some())], "[water.wave]")?;
        return Ok(None);
    };
    wave.check("height", wave.height, |h| h > 0.0, "above 0")?;
    wave.check("period", wave.period, |t| t > 0.0, "above 0")?;
    wave.check("length", wave.length, |l| l > 0.0, "above 0")?;
    let measured = match (&wave.period, &wave.length) {
        (Some(period), None) => Measured::Period(period.si),
        (None, Some(length)) => Measured::Length(length.si),
        (period, _) => return Err(wave.choice(["period", "length"], period.is_some())),
    };
    let (height, direction, phase) = (wave.height.si, wave.direction.si, wave.phase.si);
    let made = Wave::new(height, measured, direction, phase, depth, current, gravity);
    made.map(Some).map_err(|e| match e {
        WaveError::Breaks { length, limit } => {
            let expected = format!(
                "at most {limit:.4} m, the breaking height of a wave of {length:.4} m (0.142 L tanh(k h), Miche 1944)"
            );
            wave.error("height", format!("{height} m"), expected)
        }
        WaveError::Blocked => {
            let expected = "a period whose waves the current does not carry away";
            wave.error("period", "a current that is too fast against it", expected)
        }
        WaveError::Range(what) => wave.error(what, "out of range", "a wave that can be"),
    })
}
