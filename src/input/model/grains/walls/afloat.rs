//! Water on rigid bodies, thrust and rudder.

use super::shape::direction;
use crate::scene::units::vector;
use crate::scene::walls::{self, Body, Wall, WallKind};
use crate::scene::water::Water;
use crate::scene::{SceneError, Table, kinds};
use std::f64::consts::FRAC_PI_2;
use trackbed_dem::{BodyWater, Propulsion, Rudder, Vec3, WallShape};

pub(super) fn water(
    wall: &Table<Wall>,
    body: &Table<Body>,
    shape: &WallShape,
    water: Option<&Water>,
) -> Result<Option<BodyWater>, SceneError> {
    body.reject_without([("propulsion", body.propulsion.is_some() && body.water.is_none())], "`water`")?;
    let Some(w) = body.optional("water", &body.water) else { return Ok(None) };
    let round = !matches!(wall.kind, WallKind::Triangles | WallKind::Mesh);
    body.reject_without([("water", round)], &kinds(&[WallKind::Triangles, WallKind::Mesh]))?;
    let Some(water) = water else { return Err(body.requirement("water", "[water]")) };
    if !shape.is_closed() {
        let expected = "a closed surface, each edge of exactly two triangles";
        return Err(body.error("water", "an open surface", expected));
    }
    let three = |key: &'static str, given: Option<[f64; 3]>, default: f64, most: f64| {
        for x in given.into_iter().flatten() {
            w.check(key, x, |c| (0.0..=most).contains(&c), &format!("0 to {most}"))?;
        }
        Ok(given.map_or(Vec3::repeat(default), Vec3::from))
    };
    w.check("skin_drag", w.skin_drag, |c| (0.0..=100.0).contains(&c), "0 to 100")?;
    Ok(Some(BodyWater {
        drag: three("drag", w.drag, water.drag, 100.0)?,
        skin_drag: w.skin_drag.unwrap_or(water.skin_drag),
        drag_moment: three("drag_moment", w.drag_moment, water.drag_moment, 100.0)?,
        added_mass: three("added_mass", w.added_mass, water.added_mass, 100.0)?,
        added_inertia: three("added_inertia", w.added_inertia, 0.0, 100.0)?,
        damping_ratio: three("damping_ratio", w.damping_ratio, 0.0, 10.0)?,
    }))
}

pub(super) fn propulsion(body: &Table<Body>) -> Result<Option<Propulsion>, SceneError> {
    let Some(p) = body.optional("propulsion", &body.propulsion) else { return Ok(None) };
    let along = direction(&p, "direction", p.direction.unwrap_or([1.0, 0.0, 0.0]))?;
    p.reject_without([("diameter", p.diameter.is_some() && p.rudder.is_none())], "`rudder`")?;
    let diameter = p.check("diameter", p.diameter, |d| d > 0.0, "a diameter above 0")?;
    let thrust = p.check("thrust", p.thrust, |_| true, "a force")?.si;
    let factors = match &p.history {
        None => vec![[0.0, thrust]],
        Some(points) => table(&p, points.iter().map(|(t, f)| [t.si, f * thrust]).collect())?,
    };
    let rudder = match p.optional("rudder", &p.rudder) {
        Some(_) if libm::hypot(along.x, along.y) < 1e-6 => {
            return Err(p.error("direction", "vertical", "a direction that is not vertical, with `rudder`"));
        }
        Some(r) => Some(rudder(&r)?),
        None => None,
    };
    Ok(Some(Propulsion {
        point: Vec3::from(vector(&p.point)),
        direction: along,
        thrust: factors,
        diameter: diameter.map_or(0.0, |d| d.si),
        rudder,
    }))
}

fn rudder(r: &Table<walls::Rudder>) -> Result<Rudder, SceneError> {
    r.check("area", r.area, |a| a > 0.0, "an area above 0")?;
    let aspect_ratio = r.aspect_ratio.unwrap_or(1.5);
    r.check("aspect_ratio", aspect_ratio, |a| a > 0.0, "a ratio above 0")?;
    for (_, angle) in &r.history {
        r.check("history", *angle, |a| a.abs() <= FRAC_PI_2, "angles of -90 to 90 degrees")?;
    }
    let angle = table(r, r.history.iter().map(|(t, a)| [t.si, a.si]).collect())?;
    Ok(Rudder { point: Vec3::from(vector(&r.point)), area: r.area, aspect_ratio, angle })
}

fn table<T>(of: &Table<T>, points: Vec<[f64; 2]>) -> Result<Vec<[f64; 2]>, SceneError> {
    let finite = points.iter().flatten().all(|x| x.is_finite());
    if points.is_empty() || !finite || !points.is_sorted_by(|a, b| a[0] < b[0]) {
        return Err(of.error("history", "times that do not rise", "points with rising times"));
    }
    Ok(points)
}
