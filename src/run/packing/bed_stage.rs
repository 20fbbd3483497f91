//! Height, mass and porosity of the bed after a packing stage.
//!
//! The height is the mean of the highest points over a grid of vertical lines that meet a grain, above the
//! floor: the highest level plane or solid below the middle of the bed, else its lowest grain.

use crate::system::GrainsView;
use serde::{Deserialize, Serialize};
use trackbed_coupling::surface::SolidSurface;
use trackbed_dem::Vec3;
use trackbed_dem::measure::highest_over;
use trackbed_input::model::grains::GrainsPart;

/// Lines per mean grain diameter and direction.
const LINES: f64 = 4.0;
/// Most lines.
const MOST: f64 = 4e6;
/// Deviation from a target height that causes a warning.
const TOLERANCE: f64 = 0.05;

/// Bed after a packing stage. Always written in full: fields are unnamed in checkpoints.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct BedStage {
    /// Stage name.
    pub stage: String,
    /// Mean height above the floor [m].
    pub height: f64,
    /// Mass of the grains [kg].
    pub mass: f64,
    /// Porosity below the mean surface.
    pub porosity: f64,
    /// Target heights of groups.
    pub targets: Vec<HeightTarget>,
}

/// Target height of a group.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct HeightTarget {
    /// Group name.
    pub group: String,
    /// Target [m].
    pub target: f64,
    /// Mean height over the plan of `fill` [m].
    pub reached: f64,
    /// Value of `porosity` expected to meet the target.
    pub suggested_porosity: f64,
}

impl BedStage {
    /// Measures the bodies `of_bed`; `None` without grains or without downward gravity.
    pub fn of(
        stage: &str,
        view: GrainsView<'_>,
        grains: &GrainsPart,
        surface: Option<&SolidSurface>,
        of_bed: impl Fn(usize) -> bool,
    ) -> Option<BedStage> {
        let GrainsView { model, state } = view;
        if grains.gravity.z >= -0.9 * grains.gravity.norm() {
            return None;
        }
        let bodies: Vec<usize> = (0..model.body_count()).filter(|&b| state.present(b) && of_bed(b)).collect();
        let volume: f64 = bodies.iter().map(|&b| model.volume(b)).sum();
        let lines = Lines::of(view, &bodies, volume)?;
        let floor = floor(view, grains, surface, &bodies);
        let height = lines.height(floor, |_| true)?;
        let space = height * lines.area();
        Some(BedStage {
            stage: stage.into(),
            height,
            mass: bodies.iter().map(|&b| model.mass(b)).sum(),
            porosity: if space > 0.0 { 1.0 - volume / space } else { 0.0 },
            targets: targets(view, grains, &bodies, &lines),
        })
    }

    /// Formats the log lines.
    pub fn lines(&self) -> Vec<String> {
        let BedStage { stage, height, mass, porosity, targets } = self;
        let decimals = if *mass >= 10.0 { 1 } else { 4 };
        let bed = format!(
            "bed after {stage}: height {height:.3} m, mass {mass:.decimals$} kg, porosity {porosity:.3}"
        );
        let target = |t: &HeightTarget| {
            let HeightTarget { group, target, reached, .. } = t;
            format!(
                "{group}: target height {target} m, reached {reached:.3} m ({:+.1} %)",
                100.0 * t.deviation()
            )
        };
        std::iter::once(bed).chain(targets.iter().map(target)).collect()
    }

    /// Returns warnings about missed targets.
    pub fn warnings(&self) -> Vec<String> {
        let missed = self.targets.iter().filter(|t| t.deviation().abs() > TOLERANCE);
        missed.map(HeightTarget::warning).collect()
    }
}

impl HeightTarget {
    fn deviation(&self) -> f64 {
        self.reached / self.target - 1.0
    }

    fn warning(&self) -> String {
        let level = if self.deviation() > 0.0 { ", or set `deposition.level`" } else { "" };
        format!(
            "{}: bed height {:.3} m, {:+.1} % off the target height {} m. Set `porosity = {:.3}` in [[grains]]{level}.",
            self.group,
            self.reached,
            100.0 * self.deviation(),
            self.target,
            self.suggested_porosity
        )
    }
}

/// Of groups with grains in the bed.
fn targets(view: GrainsView<'_>, grains: &GrainsPart, bodies: &[usize], lines: &Lines) -> Vec<HeightTarget> {
    let mut targets = Vec::new();
    for group in &grains.groups.filled {
        let Some(target) = group.target else { continue };
        let [low, high] = group.plan;
        let over = |x: [f64; 2]| (0..2).all(|d| (low[d]..=high[d]).contains(&x[d]));
        if !bodies.iter().any(|&b| view.model.part(b) == group.part) {
            continue;
        }
        if let Some(reached) = lines.height(group.floor, over).filter(|h| *h > 0.0) {
            // The same grains at the height of the target.
            let porosity = 1.0 - (1.0 - group.porosity) * target / reached;
            let suggested_porosity = porosity.clamp(0.01, 0.99);
            targets.push(HeightTarget { group: group.name.clone(), target, reached, suggested_porosity });
        }
    }
    targets
}

fn floor(view: GrainsView<'_>, grains: &GrainsPart, surface: Option<&SolidSurface>, bodies: &[usize]) -> f64 {
    let GrainsView { model, state } = view;
    let height = |b: usize| state.position(b).z;
    let middle = bodies.iter().map(|&b| height(b)).sum::<f64>() / bodies.len() as f64;
    let level = |normal: Vec3| normal.z > 0.999 * normal.norm();
    let planes = grains.walls.planes.iter().filter(|p| level(p.normal)).map(|p| p.point.z);
    let solid = surface.map(SolidSurface::highest);
    let floor = planes.chain(solid).filter(|z| *z < middle).fold(f64::NEG_INFINITY, f64::max);
    if floor.is_finite() {
        return floor;
    }
    bodies.iter().map(|&b| height(b) - model.radius(b)).fold(f64::INFINITY, f64::min)
}

/// Grid of vertical lines over the bed.
struct Lines {
    low: [f64; 2],
    cell: [f64; 2],
    count: [usize; 2],
    /// Highest point; −∞ without grain.
    tops: Vec<f64>,
}

impl Lines {
    fn of(view: GrainsView<'_>, bodies: &[usize], volume: f64) -> Option<Lines> {
        let GrainsView { model, state } = view;
        let place = |b: usize| model.wrap(&state.position(b));
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for &b in bodies {
            let (x, r) = (place(b), model.radius(b));
            // Exact for spheres; other grains meet fewer lines at the border.
            for d in 0..2 {
                low[d] = low[d].min(x[d] - r);
                high[d] = high[d].max(x[d] + r);
            }
        }
        let size = libm::cbrt(6.0 / std::f64::consts::PI * volume / bodies.len() as f64);
        let sides = [high[0] - low[0], high[1] - low[1]];
        if bodies.is_empty() || !(size > 0.0 && sides.iter().all(|s| s.is_finite() && *s > 0.0)) {
            return None;
        }
        let cell = (size / LINES).max((sides[0] * sides[1] / MOST).sqrt());
        let count = sides.map(|s| (s / cell).round().clamp(1.0, MOST) as usize);
        let cell = [sides[0] / count[0] as f64, sides[1] / count[1] as f64];
        let mut lines = Lines { low, cell, count, tops: vec![f64::NEG_INFINITY; count[0] * count[1]] };
        bodies.iter().for_each(|&b| lines.raise(view, b));
        Some(lines)
    }

    fn raise(&mut self, view: GrainsView<'_>, body: usize) {
        let GrainsView { model, state } = view;
        let position = state.position(body);
        let shift = model.wrap(&position) - position;
        for (x, r) in state.spheres(model, body) {
            let x = x + shift;
            self.each([x.x, x.y], r, |[a, b], top| {
                let square = r * r - (a - x.x).powi(2) - (b - x.y).powi(2);
                if square >= 0.0 {
                    *top = top.max(x.z + square.sqrt());
                }
            });
        }
        let (x, r) = (position + shift, model.radius(body));
        if matches!(model.shape(body), trackbed_dem::shape::Shape::Polyhedron(_)) {
            self.each([x.x, x.y], r, |[a, b], top| {
                if *top < x.z + r
                    && let Some(z) = highest_over(model, state, body, [a - shift.x, b - shift.y], [0.0; 2])
                {
                    *top = top.max(z + shift.z);
                }
            });
        }
    }

    /// Calls `act` with place and top of the lines of a square of half side `reach`.
    fn each(&mut self, middle: [f64; 2], reach: f64, mut act: impl FnMut([f64; 2], &mut f64)) {
        let range = [0, 1].map(|d| {
            let at = |x: f64| ((x - self.low[d]) / self.cell[d] - 0.5).clamp(0.0, self.count[d] as f64 - 1.0);
            at(middle[d] - reach).floor() as usize..=at(middle[d] + reach).ceil() as usize
        });
        let [columns, rows] = range;
        for i in columns {
            for j in rows.clone() {
                let place = self.place(i, j);
                act(place, &mut self.tops[i * self.count[1] + j]);
            }
        }
    }

    fn place(&self, i: usize, j: usize) -> [f64; 2] {
        [self.low[0] + (i as f64 + 0.5) * self.cell[0], self.low[1] + (j as f64 + 0.5) * self.cell[1]]
    }

    /// Area of the lines with grains [m²].
    fn area(&self) -> f64 {
        self.tops.iter().filter(|z| z.is_finite()).count() as f64 * self.cell[0] * self.cell[1]
    }

    /// Mean height above `floor` of the lines with grains `within` a plan [m].
    fn height(&self, floor: f64, within: impl Fn([f64; 2]) -> bool) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0_usize);
        for (k, top) in self.tops.iter().enumerate() {
            if top.is_finite() && within(self.place(k / self.count[1], k % self.count[1])) {
                sum += top - floor;
                count += 1;
            }
        }
        (count > 0).then(|| sum / count as f64)
    }
}
