//! `[[measure]]` resolved.

use super::check::region;
use crate::scene::compaction as scene;
use crate::scene::{Document, Scene, SceneError};
use trackbed_dem::measure::BoxRegion;

/// A box in which the packing is measured.
#[derive(Clone, Debug)]
pub struct MeasurePlan {
    /// Name in the summary.
    pub name: String,
    /// The box.
    pub region: BoxRegion,
    /// Radial distribution function, where it is asked for.
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

/// The boxes of a scene.
pub(super) fn build(document: &Document, scene: &Scene) -> Result<Vec<MeasurePlan>, SceneError> {
    let mut measures = Vec::new();
    for (i, m) in scene.measure.iter().enumerate() {
        if scene.measure[..i].iter().any(|other| other.name == m.name) {
            let key = format!("measure.{i}.name");
            return Err(document.error(&key, format!("\"{}\" again", m.name), "each name once"));
        }
        let region = region(document, &format!("measure.{i}.box"), &m.region)?;
        let radial = radial(document, i, m, &region)?;
        measures.push(MeasurePlan { name: m.name.clone(), region, radial });
    }
    Ok(measures)
}

/// Checks that the reach finds room about at least one point of the box.
fn radial(
    document: &Document,
    i: usize,
    measure: &scene::Measure,
    region: &BoxRegion,
) -> Result<Option<RadialPlan>, SceneError> {
    let Some(r) = &measure.radial else { return Ok(None) };
    let least = (region.high - region.low).min();
    let reach = r.reach.si;
    if !(reach > 0.0 && 2.0 * reach <= least) {
        let expected = format!("above 0, at most half the shortest side of the box, {}", 0.5 * least);
        return Err(document.error(&format!("measure.{i}.radial.reach"), reach.to_string(), expected));
    }
    if !(1..=100_000).contains(&r.bins) {
        return Err(document.error(&format!("measure.{i}.radial.bins"), r.bins.to_string(), "1 to 100000"));
    }
    Ok(Some(RadialPlan { reach, bins: r.bins }))
}
