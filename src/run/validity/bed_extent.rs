//! Box around a bed, and measurement boxes that reach beyond it.

use super::{Check, Limits};
use trackbed_dem::measure::BoxRegion;
use trackbed_dem::{Vec3, WallInput};
use trackbed_input::model::grains::GrainsPart;
use trackbed_track::GrainsView;

/// Volume beyond the bed over box volume.
const BEYOND: Limits = Limits { warn: 0.02, fail: None };
/// Gap between grains and a wall over the mean grain radius.
const GAP: f64 = 2.0;

/// Sides of a bed: its grains, or walls close to them [m].
#[derive(Clone, Copy, Debug)]
pub struct BedExtent {
    low: Vec3,
    high: Vec3,
}

/// Side of a box beyond the bed.
struct Beyond {
    fraction: f64,
    side: String,
    bed: f64,
}

impl BedExtent {
    /// Returns the extent of the selected grains; unlimited along periodic axes, and upwards with gravity, where
    /// the bed surface is compared. None without grains.
    pub fn of(
        view: GrainsView<'_>,
        grains: &GrainsPart,
        is_grain: impl Fn(usize) -> bool,
    ) -> Option<BedExtent> {
        let (model, state) = (view.model, view.state);
        let bodies: Vec<(Vec3, f64)> = (0..model.body_count())
            .filter(|&b| state.present(b) && is_grain(b))
            .map(|b| (model.wrap(&state.position(b)), model.radius(b)))
            .collect();
        let gap = GAP * bodies.iter().map(|b| b.1).sum::<f64>() / bodies.len().max(1) as f64;
        let mut extent = BedExtent::around(&bodies)?.up_to(&walls(view, grains), gap);
        for d in (0..3).filter(|&d| grains.periodic[d].is_some()) {
            (extent.low[d], extent.high[d]) = (f64::NEG_INFINITY, f64::INFINITY);
        }
        if grains.gravity.z < 0.0 {
            extent.high.z = f64::INFINITY;
        }
        Some(extent)
    }

    fn around(bodies: &[(Vec3, f64)]) -> Option<BedExtent> {
        let none = BedExtent { low: Vec3::repeat(f64::INFINITY), high: Vec3::repeat(f64::NEG_INFINITY) };
        let all = bodies.iter().fold(none, |e, (x, r)| BedExtent {
            low: e.low.inf(&x.add_scalar(-r)),
            high: e.high.sup(&x.add_scalar(*r)),
        });
        (!bodies.is_empty()).then_some(all)
    }

    /// Extends the sides to `walls` (axis, position [m]) within a `gap` [m].
    fn up_to(self, walls: &[(usize, f64)], gap: f64) -> BedExtent {
        let mut wide = self;
        for &(d, at) in walls {
            if at > self.high[d] && at < self.high[d] + gap {
                wide.high[d] = wide.high[d].max(at);
            }
            if at < self.low[d] && at > self.low[d] - gap {
                wide.low[d] = wide.low[d].min(at);
            }
        }
        wide
    }

    fn beyond(&self, region: &BoxRegion) -> Option<Beyond> {
        let (mut fraction, mut farthest, mut worst) = (1.0, 0.0, None);
        for d in 0..3 {
            let (low, high) = (region.low[d].max(self.low[d]), region.high[d].min(self.high[d]));
            fraction *= ((high - low) / (region.high[d] - region.low[d])).max(0.0);
            for (end, bed, depth) in [
                (region.low[d], self.low[d], self.low[d] - region.low[d]),
                (region.high[d], self.high[d], region.high[d] - self.high[d]),
            ] {
                if depth > farthest {
                    (farthest, worst) = (depth, Some((format!("{} = {end:.4} m", ["x", "y", "z"][d]), bed)));
                }
            }
        }
        let (side, bed) = worst?;
        Some(Beyond { fraction: 1.0 - fraction, side, bed })
    }

    /// Checks that a named box lies within the bed.
    pub fn check(&self, name: &str, region: &BoxRegion) -> Check {
        let found = self.beyond(region);
        let name = format!("measure {name}");
        let value = found.as_ref().map_or(0.0, |b| b.fraction);
        Check::new(format!("fraction of {name} outside the bed"), value, BEYOND, || {
            found.map_or(String::new(), |b| b.text(&name))
        })
    }

    /// Warns about a `region` of compaction that reaches beyond the bed.
    pub fn warning(&self, name: &str, region: &BoxRegion) -> Option<String> {
        self.beyond(region).filter(|b| b.fraction > BEYOND.warn).map(|b| b.text(name))
    }
}

impl Beyond {
    fn text(&self, name: &str) -> String {
        format!(
            "{name}: side at {}, beyond the bed that ends at {:.4} m. Its porosity includes space outside the bed. Move this side inwards.",
            self.side, self.bed
        )
    }
}

/// Walls across an axis, and bounds of other walls: axis, position [m].
fn walls(view: GrainsView<'_>, grains: &GrainsPart) -> Vec<(usize, f64)> {
    let (model, state) = (view.model, view.state);
    let mut found = Vec::new();
    let across = |normal: &Vec3| Some(normal.iamax()).filter(|&d| normal[d].abs() > 0.999 * normal.norm());
    for (k, plane) in grains.walls.planes.iter().enumerate() {
        found.extend(across(&plane.normal).map(|d| (d, state.plane_point(model, k)[d])));
    }
    // Packing has no servo-controlled walls and no rigid bodies.
    let packing = model.wall_count() < grains.walls.others.len();
    let stays = |wall: &&WallInput| !packing || (wall.servo.is_none() && wall.body.is_none());
    for (w, wall) in grains.walls.others.iter().filter(stays).enumerate() {
        let at = |x: &Vec3| state.wall_point(model, w, x);
        if let Some((point, normal)) = wall.shape.plane() {
            found.extend(across(normal).map(|d| (d, at(point)[d])));
            continue;
        }
        let balls = wall.shape.balls();
        let points: Vec<Vec3> =
            balls.iter().flat_map(|(x, r)| [at(x).add_scalar(*r), at(x).add_scalar(-r)]).collect();
        let ends = |d: usize| {
            let all = points.iter().map(move |x| x[d]);
            [all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max)]
        };
        found.extend((0..3).flat_map(|d| ends(d).map(|at| (d, at))));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validity::Outcome;

    fn region(low: [f64; 3], high: [f64; 3]) -> BoxRegion {
        BoxRegion { low: Vec3::from(low), high: Vec3::from(high) }
    }

    /// A bed of 0.3 × 0.3 m whose grains end 4 mm before the walls.
    #[test]
    fn detects_boxes_beyond_bed() {
        let bodies = [(Vec3::new(0.024, 0.024, 0.02), 0.02), (Vec3::new(0.276, 0.276, 0.06), 0.02)];
        let walls = [(0, 0.0), (0, 0.3), (1, 0.0), (1, 0.3), (2, 0.0), (0, 5.0)];
        let bed = BedExtent::around(&bodies).unwrap().up_to(&walls, 0.04);
        let bed = BedExtent { high: Vec3::new(bed.high.x, bed.high.y, f64::INFINITY), ..bed };
        for (box_, value) in [
            (region([0.0, 0.0, 0.0], [0.3, 0.3, 0.04]), 0.0),
            (region([0.1, 0.1, 0.01], [0.2, 0.2, 0.04]), 0.0),
            (region([0.15, 0.1, 0.01], [0.45, 0.2, 0.04]), 0.5),
            (region([0.1, 0.1, -0.05], [0.2, 0.2, 0.05]), 0.5),
            (region([0.4, 0.1, 0.0], [0.5, 0.2, 0.05]), 1.0),
        ] {
            let check = bed.check("core", &box_);
            assert!((check.value - value).abs() < 1e-12, "{check:?}");
            assert_eq!(check.status == Outcome::Passed, value == 0.0, "{check:?}");
        }
        let text = bed.warning("compaction.0.region", &region([0.15, 0.1, 0.01], [0.45, 0.2, 0.04])).unwrap();
        assert!(
            text.starts_with(
                "compaction.0.region: side at x = 0.4500 m, beyond the bed that ends at 0.3000 m"
            ),
            "{text}"
        );
    }

    #[test]
    fn distant_walls_do_not_count() {
        let bodies = [(Vec3::zeros(), 0.02)];
        let bed = BedExtent::around(&bodies).unwrap().up_to(&[(0, 0.1), (0, -0.03)], 0.04);
        assert!((bed.high.x - 0.02).abs() < 1e-15 && (bed.low.x + 0.03).abs() < 1e-15, "{bed:?}");
        assert!(BedExtent::around(&[]).is_none());
    }
}
