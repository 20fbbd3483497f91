//! `[runout]` resolved.

use super::groups::GroupsPart;
use crate::scene::{Scene, SceneError, Table};

/// Share of the mass at which the front is taken where the scene does not say.
const SHARE: f64 = 0.99;
/// Most cells of a depth map along a side: what a slide spreads over beyond it makes the cells larger.
pub const MOST_CELLS: usize = 4000;

/// What of a slide is measured.
#[derive(Clone, Debug)]
pub struct RunoutPlan {
    /// Groups that slide, by number, ascending.
    pub parts: Vec<u32>,
    /// Direction in plan, of length 1.
    pub direction: [f64; 2],
    /// Side of the cells of the depth map [m]; none: twice the mean diameter.
    pub cell: Option<f64>,
    /// Depth above which a cell belongs to the deposit [m]; none: half the mean diameter.
    pub depth: Option<f64>,
    /// Share of the mass behind the front.
    pub share: f64,
}

/// The plan of a scene.
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
    let depth = table.check("depth", table.depth, |l| l > 0.0, "a length above 0")?.map(|l| l.si);
    let share = table.share.unwrap_or(SHARE);
    table.check("share", share, |s| (0.5..=1.0).contains(&s), "0.5 to 1")?;
    Ok(Some(RunoutPlan { parts, direction: [x / length, y / length], cell, depth, share }))
}

impl RunoutPlan {
    /// Whether a group slides.
    pub fn has(&self, part: u32) -> bool {
        self.parts.binary_search(&part).is_ok()
    }
}
