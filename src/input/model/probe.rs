//! `[[probe]]` resolved.

mod solid;

use super::grains::GrainsPart;
use super::solid::{SolidPart, find_node};
use crate::scene::units::vector;
use crate::scene::{LINE, Probe, Scene, SceneError, Table};
pub use solid::PointProbe;
use trackbed_dem::measure::BoxRegion;
use trackbed_fem::samples::{BoxPoints, Samples};

/// Observed object.
#[derive(Clone, Debug)]
pub enum Observed {
    /// Node of the solid, by index.
    Node(usize),
    /// Fields at a node, point or points of a line of the solid.
    Point(PointProbe),
    /// Points of a rectangle in the solid.
    Plane(Samples),
    /// Integration points of the solid in a box.
    Volume(BoxPoints),
    /// Grain, by index.
    Grain(usize),
    /// Group, by index.
    Group(u32),
    /// Grains with centre in a box.
    Region(BoxRegion),
}

impl Observed {
    /// Whether fields of the solid are observed.
    pub fn is_of_solid(&self) -> bool {
        !matches!(self, Observed::Grain(_) | Observed::Group(_) | Observed::Region(_))
    }
}

pub(super) fn probes(
    scene: &Table<Scene>,
    solid: Option<&SolidPart>,
    grains: Option<&GrainsPart>,
) -> Result<Vec<(String, Observed)>, SceneError> {
    let all = scene.rows("probe", &scene.probe).map(|p| probe(&p, solid, grains));
    let all = all.collect::<Result<Vec<_>, _>>()?;
    // Both have a column of mean stress.
    for m in scene.rows("measure", &scene.measure).filter(|m| m.history) {
        if all.iter().any(|(name, _)| *name == m.name) {
            return Err(m.error("name", format!("\"{}\", the name of a [[probe]]", m.name), "another name"));
        }
    }
    Ok(all)
}

fn probe(
    table: &Table<Probe>,
    solid: Option<&SolidPart>,
    grains: Option<&GrainsPart>,
) -> Result<(String, Observed), SceneError> {
    let given = [
        ("node", table.node.is_some()),
        ("at", table.at.is_some()),
        ("line", table.line.is_some()),
        ("plane", table.plane.is_some()),
        ("box", table.solid_box.is_some()),
        ("grain", table.grain.is_some()),
        ("group", table.group.is_some()),
        ("region", table.region.is_some()),
    ];
    if given.iter().filter(|(_, present)| *present).count() != 1 {
        return Err(table.one_of(&given));
    }
    let [node, at, line, plane, volume, ..] = given.map(|(_, present)| present);
    if !line && table.points.is_some() {
        return Err(table.no_effect("points", "`line`"));
    }
    if !(node || at || line) {
        let other = given.iter().find(|(_, present)| *present).map_or("node", |(key, _)| *key);
        table.reject_with([("fields", table.fields.is_some())], &format!("`{other}`"))?;
    }
    let (own, observed) = match (node || at || line || plane || volume, solid, grains) {
        (true, Some(solid), _) => of_solid(table, solid)?,
        (true, None, _) => return Err(table.here("a probe of the solid", "a scene with [solid]")),
        (false, _, Some(grains)) => of_grains(table, grains)?,
        (false, _, None) => return Err(table.here("a probe of grains", "a scene with [[grains]]")),
    };
    let name = table.name.clone().unwrap_or(own);
    if name.is_empty() || name.contains([',', '"', '\n']) {
        return Err(table.error("name", format!("\"{name}\""), "a name without commas or quotes"));
    }
    Ok((name, observed))
}

fn of_solid(table: &Table<Probe>, part: &SolidPart) -> Result<(String, Observed), SceneError> {
    if table.plane.is_some() {
        return Ok(("plane".into(), Observed::Plane(solid::plane(table, part)?)));
    }
    if table.solid_box.is_some() {
        return Ok(("box".into(), Observed::Volume(solid::volume(table, part)?)));
    }
    if table.line.is_some() {
        return Ok((LINE.into(), Observed::Point(solid::line(table, part)?)));
    }
    if let Some(fields) = &table.fields {
        let (name, point) = solid::point(table, part, fields)?;
        return Ok((name, Observed::Point(point)));
    }
    nearest_node(table, part)
}

fn nearest_node(table: &Table<Probe>, solid: &SolidPart) -> Result<(String, Observed), SceneError> {
    let mesh = solid.model.mesh();
    // Sleepers move when they are set down.
    let ground = solid.sleepers.as_ref().map_or(mesh.node_count(), |s| s.ground_nodes());
    let node = match (table.node, table.at) {
        (Some(id), _) => find_node(table, mesh, id)?,
        (None, at) => {
            let at = at.map_or([0.0; 3], |at| vector(&at));
            let distance = |x: &[f64; 3]| (0..3).map(|d| (x[d] - at[d]).powi(2)).sum::<f64>();
            let nearest = mesh.coordinates[..ground]
                .iter()
                .enumerate()
                .min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
            nearest.map_or(0, |(i, _)| i)
        }
    };
    Ok((format!("n{}", mesh.node_ids[node]), Observed::Node(node)))
}

fn of_grains(table: &Table<Probe>, grains: &GrainsPart) -> Result<(String, Observed), SceneError> {
    if let Some(grain) = table.grain {
        let count = grains.groups.bodies.len();
        if grain as usize >= count {
            let expected = format!("the number of a grain, 0 to {}", count.saturating_sub(1));
            return Err(table.error("grain", grain.to_string(), expected));
        }
        return Ok((format!("grain{grain}"), Observed::Grain(grain as usize)));
    }
    if let Some(group) = &table.group {
        let Some(part) = grains.groups.names.iter().position(|n| n == group) else {
            let known = format!("the name of a [[grains]]: {}", grains.groups.names.join(", "));
            return Err(table.error("group", format!("\"{group}\""), known));
        };
        return Ok((group.clone(), Observed::Group(part as u32)));
    }
    let corners = table.need("region", table.region, "the corners of a box")?;
    let region = super::grains::region(table, "region", &corners)?;
    Ok(("region".into(), Observed::Region(region)))
}
