//! `[[measure]]` resolved.

use super::check::region;
use crate::scene::compaction as scene;
use crate::scene::{Scene, SceneError, Table};
use trackbed_dem::measure::BoxRegion;

/// Box in which the packing is measured.
#[derive(Clone, Debug)]
pub struct MeasurePlan {
    /// Name in the summary.
    pub name: String,
    /// The box.
    pub region: BoxRegion,
    /// Whether it has columns in `history.csv`.
    pub history: bool,
    /// Radial distribution function, if requested.
    pub radial: Option<RadialPlan>,
}

/// Shells of a radial distribution function.
#[derive(Clone, Copy, Debug)]
pub struct RadialPlan {
    /// Largest distance [m].
    pub reach: f64,
    /// Number of shells.
    pub bins: usize,
}

pub(super) fn build(scene: &Table<Scene>) -> Result<Vec<MeasurePlan>, SceneError> {
    let mut measures = Vec::new();
    for (i, m) in scene.rows("measure", &scene.measure).enumerate() {
        if scene.measure[..i].iter().any(|other| other.name == m.name) {
            return Err(m.error("name", format!("\"{}\" again", m.name), "each name once"));
        }
        if m.history && (m.name.is_empty() || m.name.contains([',', '"', '\n'])) {
            return Err(m.error("name", format!("\"{}\"", m.name), "a name without commas or quotes"));
        }
        let region = region(&m, "box", &m.region)?;
        let radial = m.optional("radial", &m.radial);
        let radial = radial.map(|r| shells(&r, &region)).transpose()?;
        measures.push(MeasurePlan { name: m.name.clone(), region, history: m.history, radial });
    }
    Ok(measures)
}

/// The cut-off distance must fit around a point of the box.
fn shells(r: &Table<scene::Radial>, region: &BoxRegion) -> Result<RadialPlan, SceneError> {
    let least = (region.high - region.low).min();
    let reach = r.reach.si;
    if !(reach > 0.0 && 2.0 * reach <= least) {
        let expected = format!("above 0, at most half the shortest side of the box, {}", 0.5 * least);
        return Err(r.error("reach", reach.to_string(), expected));
    }
    if !(1..=100_000).contains(&r.bins) {
        return Err(r.error("bins", r.bins.to_string(), "1 to 100000"));
    }
    Ok(RadialPlan { reach, bins: r.bins })
}
