//! `[runout]` resolved.

use super::groups::GroupsPart;
use crate::scene::{Scene, SceneError, Table};

/// Default mass fraction behind the front.
const SHARE: f64 = 0.99;
/// Most depth map cells per side.
pub const MOST_CELLS: usize = 4000;

/// Runout measurement.
#[derive(Clone, Debug)]
pub struct RunoutPlan {
    /// Sliding groups, ascending.
    pub parts: Vec<u32>,
    /// Unit direction in plan.
    pub direction: [f64; 2],
    /// Cell size [m]; default twice the mean diameter.
    pub cell: Option<f64>,
    /// Whether passed cells are recorded; with `cell`.
    pub passage: bool,
    /// Depth limit [m]; default half the mean diameter.
    pub depth: Option<f64>,
    /// Mass fraction behind the front.
    pub share: f64,
}

pub(super) fn build(scene: &Table<Scene>, groups: &GroupsPart) -> Result<Option<RunoutPlan>, SceneError> {
    let Some(table) = scene.optional("runout", &scene.runout) else { return Ok(None) };
    let excluded = [("coupling", scene.coupling.is_some()), ("periodic", scene.periodic.is_some())];
    if let Some((key, _)) = excluded.iter().find(|(_, present)| *present) {
        return Err(scene.conflict("runout", format!("[{key}]")));
    }
    let [x, y] = table.direction;
    let length = libm::hypot(x, y);
    table.check("direction", length, |l| l > 0.0 && l.is_finite(), "a vector that is not null")?;
    let gripped = |part: u32| groups.moving.iter().any(|m| m.part == part);
    let mut parts = Vec::new();
    match &table.groups {
        None => parts.extend((0..groups.names.len() as u32).filter(|p| !gripped(*p))),
        Some(names) => {
            for (k, name) in names.iter().enumerate() {
                let Some(part) = groups.names.iter().position(|n| n == name) else {
                    let expected = format!("the name of a [[grains]]: {}", groups.names.join(", "));
                    return Err(table.error(&format!("groups.{k}"), format!("\"{name}\""), expected));
                };
                parts.push(part as u32);
            }
        }
    }
    parts.sort_unstable();
    parts.dedup();
    if parts.is_empty() {
        return Err(table.error("groups", "none", "at least one group that can slide"));
    }
    let cell = table.check("cell", table.cell, |l| l > 0.0, "a length above 0")?.map(|l| l.si);
    if table.passage && cell.is_none() {
        return Err(table.missing("cell", "the side of the cells of `passage`"));
    }
    let depth = table.check("depth", table.depth, |l| l > 0.0, "a length above 0")?.map(|l| l.si);
    let share = table.share.unwrap_or(SHARE);
    table.check("share", share, |s| (0.5..=1.0).contains(&s), "0.5 to 1")?;
    let (direction, passage) = ([x / length, y / length], table.passage);
    Ok(Some(RunoutPlan { parts, direction, cell, passage, depth, share }))
}

impl RunoutPlan {
    /// Whether a group slides.
    pub fn has(&self, part: u32) -> bool {
        self.parts.binary_search(&part).is_ok()
    }
}
