//! Walls scarred by rocks.

use crate::scene::walls::{Wall, WallKind};
use crate::scene::{SceneError, Table, kinds};
use trackbed_dem::Scarring;

/// Lu et al. (Landslides 16, 2019), soil and scree slope; strength there depends on scar depth.
const DRAG: f64 = 2.5;
const DENSITY: f64 = 1700.0;
const FRICTION: [f64; 2] = [0.55, 2.0];
const GROWTH: f64 = 3.0;
const DECAY: f64 = 185.0;

pub(super) fn scarring(wall: &Table<Wall>) -> Result<Option<Scarring>, SceneError> {
    let Some(s) = wall.optional("scarring", &wall.scarring) else { return Ok(None) };
    if !matches!(wall.kind, WallKind::Triangles | WallKind::Mesh) {
        return Err(wall.no_effect("scarring", kinds(&[WallKind::Triangles, WallKind::Mesh])));
    }
    let moves = [
        ("velocity", wall.velocity.is_some()),
        ("angular_velocity", wall.angular_velocity.is_some()),
        ("oscillation", wall.oscillation.is_some()),
        ("servo", wall.servo.is_some()),
        ("body", wall.body.is_some()),
    ];
    wall.reject_with(moves, "`scarring`").map_err(|e| e.remedy("A wall with scarring is fixed"))?;
    let not_negative = |x: f64| x >= 0.0;
    s.check("strength", s.strength, |x| x > 0.0, "a strength above 0")?;
    s.check("drag", s.drag, not_negative, "0 or more")?;
    s.check("density", s.density, not_negative, "0 or more")?;
    s.check("growth", s.growth, not_negative, "0 or more")?;
    s.check("decay", s.decay, not_negative, "0 or more")?;
    let friction @ [first, last] = s.friction.unwrap_or(FRICTION);
    if !(first >= 0.0 && last >= first && last.is_finite()) {
        let expected = "two coefficients of 0 or more, the second not below the first";
        return Err(s.error("friction", format!("[{first}, {last}]"), expected));
    }
    Ok(Some(Scarring {
        strength: s.strength.si,
        drag: s.drag.unwrap_or(DRAG),
        density: s.density.map_or(DENSITY, |d| d.si),
        friction,
        growth: s.growth.unwrap_or(GROWTH),
        decay: s.decay.unwrap_or(DECAY),
    }))
}
