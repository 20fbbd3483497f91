//! `[[structure]]` resolved.

use super::hazard::{self, HazardPlan};
use super::walls::WallsPart;
use crate::scene::structure::Structure;
use crate::scene::{Scene, SceneError, Table};

const MOST: usize = 360;

/// Structure with recorded loads.
#[derive(Clone, Debug)]
pub struct StructurePlan {
    /// Name in the history.
    pub name: String,
    /// Walls, indexed among non-planar walls.
    pub walls: Vec<usize>,
    /// Groups of grains.
    pub groups: Vec<u32>,
    /// Rigid body wall with recorded motion.
    pub body: Option<usize>,
    /// Reference point of moments [m].
    pub foot: [f64; 3],
    /// Sectors of equal angle.
    pub sectors: usize,
    /// Layer boundaries [m], ascending.
    pub levels: Vec<f64>,
    /// Statistics of the load.
    pub hazard: Option<HazardPlan>,
}

impl StructurePlan {
    /// Returns the sector of a position.
    pub fn sector(&self, at: [f64; 3]) -> usize {
        let turn = libm::atan2(at[1] - self.foot[1], at[0] - self.foot[0]) / std::f64::consts::TAU;
        let share = if turn < 0.0 { turn + 1.0 } else { turn };
        ((share * self.sectors as f64) as usize).min(self.sectors.saturating_sub(1))
    }

    /// Returns the layer of a position, from below.
    pub fn layer(&self, at: [f64; 3]) -> usize {
        self.levels.partition_point(|level| *level <= at[2])
    }
}

pub(super) fn build(
    scene: &Table<Scene>,
    walls: &WallsPart,
    groups: &[String],
) -> Result<Vec<StructurePlan>, SceneError> {
    let mut plans: Vec<StructurePlan> = Vec::new();
    for structure in scene.rows("structure", &scene.structure) {
        if plans.iter().any(|p| p.name == structure.name) {
            return Err(structure.error("name", format!("\"{}\" again", structure.name), "each name once"));
        }
        plans.push(plan(&structure, walls, groups)?);
    }
    Ok(plans)
}

fn plan(
    structure: &Table<Structure>,
    walls: &WallsPart,
    groups: &[String],
) -> Result<StructurePlan, SceneError> {
    let Structure { name, parts, axis, foot, .. } = &**structure;
    for x in axis.iter().chain(foot) {
        structure.check("axis", *x, |_| true, "a length")?;
    }
    let sectors = structure.sectors.unwrap_or(0);
    structure.check("sectors", sectors, |n| n <= MOST as f64, "at most 360")?;
    let levels: Vec<f64> = structure.levels.iter().flatten().map(|x| x.si).collect();
    let ascend = levels.iter().all(|x| x.is_finite()) && levels.windows(2).all(|w| w[0] < w[1]);
    if !ascend || levels.len() > MOST {
        return Err(structure.error("levels", format!("{levels:?}"), "at most 360 heights, ascending"));
    }
    let mut plan = StructurePlan {
        name: name.clone(),
        walls: Vec::new(),
        groups: Vec::new(),
        body: None,
        foot: [axis[0].si, axis[1].si, foot.map_or(0.0, |z| z.si)],
        sectors,
        levels,
        hazard: structure.optional("hazard", &structure.hazard).map(|h| hazard::plan(&h)).transpose()?,
    };
    for part in parts {
        let before = plan.walls.len() + plan.groups.len();
        plan.walls.extend(walls.names.iter().enumerate().filter(|(_, n)| *n == part).map(|(k, _)| k));
        plan.groups.extend(groups.iter().zip(0..).filter(|(n, _)| *n == part).map(|(_, k)| k));
        if plan.walls.len() + plan.groups.len() == before {
            let known: Vec<String> = walls.names.iter().chain(groups).map(|n| format!("\"{n}\"")).collect();
            return Err(structure.error(
                "parts",
                format!("\"{part}\""),
                format!("names among {}", known.join(", ")),
            ));
        }
    }
    let bodies: Vec<usize> = plan.walls.iter().copied().filter(|w| walls.others[*w].body.is_some()).collect();
    plan.body = bodies.first().copied();
    if bodies.len() > 1 {
        let found = format!("{} walls that are rigid bodies", bodies.len());
        return Err(structure.error("parts", found, "at most one, which moves as the structure does"));
    }
    if parts.is_empty() {
        return Err(structure.error("parts", "nothing", "names of walls or groups of grains"));
    }
    Ok(plan)
}
