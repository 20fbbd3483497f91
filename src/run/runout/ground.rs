//! Ground height from fixed planes and triangles.

use crate::system::GrainsView;
use trackbed_dem::{Motion, Vec3, WallInput};
use trackbed_input::model::grains::GrainsPart;

/// Smallest vertical component of a ground normal.
const UPRIGHT: f64 = 1e-3;
/// Shared edges must belong to at least one triangle.
const EDGE: f64 = 1e-9;

/// Grid in plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Lower corner [m].
    pub low: [f64; 2],
    /// Cell size [m].
    pub cell: f64,
    /// Cells along x and y.
    pub counts: [usize; 2],
}

impl Plan {
    /// Number of cells.
    pub fn len(&self) -> usize {
        self.counts[0] * self.counts[1]
    }

    /// Centre of cell (i, j) [m].
    pub fn middle(&self, i: usize, j: usize) -> [f64; 2] {
        [self.low[0] + (i as f64 + 0.5) * self.cell, self.low[1] + (j as f64 + 0.5) * self.cell]
    }

    /// Index of cell (i, j), x fastest.
    pub fn index(&self, i: usize, j: usize) -> usize {
        j * self.counts[0] + i
    }

    /// Cell index of a coordinate, clamped to the grid.
    pub fn along(&self, axis: usize, x: f64) -> usize {
        let cell = ((x - self.low[axis]) / self.cell).floor().max(0.0) as usize;
        cell.min(self.counts[axis] - 1)
    }
}

/// Returns ground heights at cell centres [m], of the highest surface.
pub fn heights(view: GrainsView<'_>, part: &GrainsPart, plan: &Plan) -> Vec<Option<f64>> {
    let cells = (0..plan.counts[1]).flat_map(|j| (0..plan.counts[0]).map(move |i| (i, j)));
    under(view, part, plan, &cells.map(|(i, j)| plan.middle(i, j)).collect::<Vec<_>>())
}

/// Returns ground heights at positions in plan [m].
pub fn under(view: GrainsView<'_>, part: &GrainsPart, plan: &Plan, places: &[[f64; 2]]) -> Vec<Option<f64>> {
    let mut ground: Vec<Option<f64>> = vec![None; places.len()];
    let mut raise = |k: usize, z: f64| ground[k] = Some(ground[k].map_or(z, |g: f64| g.max(z)));
    let planes = part.walls.planes.iter().enumerate();
    let planes = planes.map(|(k, p)| (view.state.plane_point(view.model, k), p.normal));
    let standing = || part.walls.others.iter().filter(|w| stands(w)).map(|w| &w.shape);
    let others = standing().filter_map(|shape| shape.plane()).map(|(point, normal)| (*point, *normal));
    for (point, normal) in planes.chain(others) {
        let n = normal.normalize();
        if n.z >= UPRIGHT {
            for (k, [x, y]) in places.iter().enumerate() {
                raise(k, point.z - (n.x * (x - point.x) + n.y * (y - point.y)) / n.z);
            }
        }
    }
    let mut of_cell: Vec<Vec<u32>> = vec![Vec::new(); plan.len()];
    for (k, [x, y]) in places.iter().enumerate() {
        of_cell[plan.index(plan.along(0, *x), plan.along(1, *y))].push(k as u32);
    }
    for (vertices, triangles) in standing().filter_map(|shape| shape.triangulated()) {
        for t in triangles {
            below(plan, t.map(|v| vertices[v as usize]), places, &of_cell, &mut raise);
        }
    }
    ground
}

/// A tipping wagon is no ground.
fn stands(wall: &WallInput) -> bool {
    let Motion { velocity, angular_velocity, oscillation, .. } = &wall.motion;
    let still = *velocity == Vec3::zeros() && *angular_velocity == Vec3::zeros();
    still && oscillation.is_none() && wall.servo.is_none() && wall.body.is_none()
}

fn below(
    plan: &Plan,
    [a, b, c]: [Vec3; 3],
    places: &[[f64; 2]],
    of_cell: &[Vec<u32>],
    raise: &mut impl FnMut(usize, f64),
) {
    let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
    let twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if twice == 0.0 {
        return;
    }
    for j in plan.along(1, low.y)..=plan.along(1, high.y) {
        for i in plan.along(0, low.x)..=plan.along(0, high.x) {
            for &k in &of_cell[plan.index(i, j)] {
                let [x, y] = places[k as usize];
                let v = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / twice;
                let w = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / twice;
                if v >= -EDGE && w >= -EDGE && v + w <= 1.0 + EDGE {
                    raise(k as usize, a.z + v * (b.z - a.z) + w * (c.z - a.z));
                }
            }
        }
    }
}
