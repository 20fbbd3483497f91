//! Check for measurement boxes above the bed.

use super::bed_surface::BedSurface;
use super::{Check, Limits};
use trackbed_dem::measure::BoxRegion;
use trackbed_track::GrainsView;

/// Height above the surface over box height.
const EMPTY: Limits = Limits { warn: 0.0, fail: None };

/// Surface height over a box [m]; none unless gravity acts downwards.
fn surface(view: GrainsView<'_>, region: &BoxRegion, is_grain: &impl Fn(usize) -> bool) -> Option<f64> {
    let (model, state) = (view.model, view.state);
    let gravity = model.gravity();
    if gravity.z >= 0.0 || (gravity.x * gravity.x + gravity.y * gravity.y).sqrt() > 0.5 * gravity.z.abs() {
        return None;
    }
    // Queued bodies have no position.
    let grains = || (0..model.body_count()).filter(|&b| state.present(b) && is_grain(b));
    let count = grains().count().max(1) as f64;
    let size = 2.0 * grains().map(|b| model.radius(b)).sum::<f64>() / count;
    let mut surface = BedSurface::new(region, size);
    for b in grains() {
        let x = model.wrap(&state.position(b));
        surface.add([x.x, x.y, x.z], model.radius(b));
    }
    Some(surface.height())
}

fn text(name: &str, region: &BoxRegion, height: f64) -> String {
    format!(
        "{name}: top at z = {:.4} m, above the mean bed surface at z = {height:.4} m. Its porosity includes air above the bed. Lower the top, or add grains.",
        region.high.z
    )
}

/// Checks a named box; none without a bed surface.
pub fn measure_box(
    name: &str,
    view: GrainsView<'_>,
    region: &BoxRegion,
    is_grain: impl Fn(usize) -> bool,
) -> Option<Check> {
    let height = surface(view, region, &is_grain)?;
    let value = (region.high.z - height) / (region.high.z - region.low.z);
    let name = format!("measure {name}");
    Some(Check::new(format!("fraction of {name} above the bed"), value.clamp(0.0, 1.0), EMPTY, || {
        text(&name, region, height)
    }))
}

/// Warns about an unfilled `region` of compaction.
pub fn region_not_filled(
    name: &str,
    view: GrainsView<'_>,
    region: &BoxRegion,
    is_grain: impl Fn(usize) -> bool,
) -> Option<String> {
    let height = surface(view, region, &is_grain)?;
    (height < region.high.z).then(|| text(name, region, height))
}
