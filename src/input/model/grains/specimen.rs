//! `[specimen]` and `[events]` resolved.

use super::groups::GroupsPart;
use super::walls::WallsPart;
use crate::scene::specimen::{Specimen, SpecimenTest};
use crate::scene::{Scene, SceneError, Table};
use std::f64::consts::PI;

/// Default range of the secant over the peak.
const BETWEEN: [f64; 2] = [0.2, 0.5];

/// Platen type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Platen {
    /// Wall, by index among non-planar walls.
    Wall(usize),
    /// Group with prescribed motion.
    Group(u32),
}

/// Specimen between platens.
#[derive(Clone, Debug)]
pub struct SpecimenPlan {
    /// Whether it is a Brazilian disc.
    pub brazilian: bool,
    /// Lower and upper platen.
    pub platens: [Platen; 2],
    /// Axis index, 0 to 2.
    pub axis: usize,
    /// Initial platen distance [m].
    pub length: f64,
    /// Reference area of the stress [m²].
    pub area: f64,
    /// Side walls and their areas [m²].
    pub sides: (Vec<usize>, f64),
    /// Specimen groups, ascending.
    pub parts: Vec<u32>,
    /// Peak fractions of the elastic range.
    pub between: [f64; 2],
}

/// Clustering of bond breaks into events.
#[derive(Clone, Copy, Debug)]
pub struct EventPlan {
    /// Largest break distance in an event [m].
    pub distance: f64,
    /// Longest time between them [s].
    pub time: f64,
}

pub(super) fn events(scene: &Table<Scene>) -> Result<Option<EventPlan>, SceneError> {
    let Some(table) = scene.optional("events", &scene.events) else { return Ok(None) };
    if scene.bond.is_empty() {
        return Err(scene.no_effect("events", "[[bond]]"));
    }
    let distance = table.check("distance", table.distance, |l| l >= 0.0, "0 or more")?.si;
    let time = table.check("time", table.time, |t| t >= 0.0, "0 or more")?.si;
    Ok(Some(EventPlan { distance, time }))
}

pub(super) fn build(
    scene: &Table<Scene>,
    groups: &GroupsPart,
    walls: &WallsPart,
) -> Result<Option<SpecimenPlan>, SceneError> {
    let Some(table) = scene.optional("specimen", &scene.specimen) else { return Ok(None) };
    let wall = |name: &str| walls.recorded.iter().find(|r| r.name == name).map(|r| r.wall);
    let group = |name: &str| {
        let part = groups.names.iter().position(|n| n == name).map(|p| p as u32);
        part.filter(|p| groups.recorded.contains(p))
    };
    let platen = |key: &str, name: &str| {
        let found = wall(name).map(Platen::Wall).or_else(|| group(name).map(Platen::Group));
        found.ok_or_else(|| {
            table.error(key, format!("\"{name}\""), "the name of a wall or of a gripped group with `record`")
        })
    };
    let platens = [platen("bottom", &table.bottom)?, platen("top", &table.top)?];
    let length = table.check("length", table.length, |l| l > 0.0, "a length above 0")?.si;
    let area = area(&table, length)?;
    let mut sides = Vec::new();
    for (k, name) in table.sides.iter().enumerate() {
        let expected = "the name of a wall with `record`";
        let side = wall(name);
        sides.push(side.ok_or_else(|| table.error(&format!("sides.{k}"), format!("\"{name}\""), expected))?);
    }
    let side_area = match (sides.is_empty(), table.side_area) {
        (true, None) => 1.0,
        (true, Some(_)) => return Err(table.no_effect("side_area", "`sides`")),
        (false, _) => {
            let a = table.need("side_area", table.side_area, "the area of each side")?;
            table.check("side_area", a, |a| a > 0.0, "above 0")?
        }
    };
    let gripped = |part: u32| groups.moving.iter().any(|m| m.part == part);
    let named = |names: &Vec<String>| {
        let find = |(k, name): (usize, &String)| {
            let part = groups.names.iter().position(|n| n == name).map(|p| p as u32);
            let known = || format!("the name of a [[grains]]: {}", groups.names.join(", "));
            part.ok_or_else(|| table.error(&format!("groups.{k}"), format!("\"{name}\""), known()))
        };
        names.iter().enumerate().map(find).collect::<Result<Vec<u32>, _>>()
    };
    let all = || Ok((0..groups.names.len() as u32).filter(|p| !gripped(*p)).collect());
    let mut parts = table.groups.as_ref().map_or_else(all, named)?;
    parts.sort_unstable();
    parts.dedup();
    let between = table.between.unwrap_or(BETWEEN);
    if !(0.0 <= between[0] && between[0] < between[1] && between[1] <= 1.0) {
        let found = format!("[{}, {}]", between[0], between[1]);
        return Err(table.error("between", found, "two rising shares from 0 to 1"));
    }
    let brazilian = table.test == SpecimenTest::Brazilian;
    let sides = (sides, side_area);
    Ok(Some(SpecimenPlan {
        brazilian,
        platens,
        axis: table.axis as usize,
        length,
        area,
        sides,
        parts,
        between,
    }))
}

/// Section, or π D t/2.
fn area(table: &Table<Specimen>, length: f64) -> Result<f64, SceneError> {
    match table.test {
        SpecimenTest::Compression => {
            let idle = [("thickness", table.thickness.is_some())];
            table.reject_without(idle, "`test = \"brazilian\"`")?;
            let area = table.need("area", table.area, "the section of the specimen")?;
            table.check("area", area, |a| a > 0.0, "above 0")
        }
        SpecimenTest::Brazilian => {
            table.reject_without([("area", table.area.is_some())], "`test = \"compression\"`")?;
            let t = table.need("thickness", table.thickness, "the thickness of the disc")?;
            let t = table.check("thickness", t, |t| t > 0.0, "a length above 0")?.si;
            Ok(0.5 * PI * length * t)
        }
    }
}
