//! Free space in an insertion box: random, overlap-free positions during a run.
//!
//! Inserted clumps, polyhedra and disks count as bounding spheres. Periodic images count.

use super::random_placement::Grid;
use crate::base::Vec3;
use crate::base::random::Random;
use crate::bodies::table::BodyKind;
use crate::engine::model::Model;
use crate::engine::state::State;
use crate::lanes::vec4::xyz;
use crate::measure::BoxRegion;
use crate::spatial::surface::Surface;
use nalgebra::UnitQuaternion;

/// Random stream id.
const PURPOSE: u64 = 7;
/// Trial positions per grain.
const TRIES: usize = 1000;
/// Relative gap to obstacles.
pub const GAP: f64 = 1e-3;

/// Snapshot of an insertion box.
pub struct FreeSpace<'a> {
    model: &'a Model,
    state: &'a State,
    surface: &'a dyn Surface,
    region: BoxRegion,
    spheres: Grid,
    /// Centre, orientation, body.
    solids: Vec<(Vec3, UnitQuaternion<f64>, usize)>,
    patches: Vec<u32>,
}

impl<'a> FreeSpace<'a> {
    /// Free space left by all bodies but `without`, for grains of bounding radii up to `largest` [m].
    pub fn new(
        model: &'a Model,
        state: &'a State,
        surface: &'a dyn Surface,
        region: BoxRegion,
        largest: f64,
        without: impl Fn(usize) -> bool,
    ) -> FreeSpace<'a> {
        let mut near: Vec<(Vec3, f64)> = Vec::new();
        let mut solids = Vec::new();
        let meets = |x: &Vec3, r: f64| (0..3).all(|d| x[d] + r > region.low[d] && x[d] - r < region.high[d]);
        let images = images(model);
        for block in &state.blocks {
            for (k, &body) in block.bodies.iter().enumerate() {
                let body = body as usize;
                if without(body) {
                    continue;
                }
                let (centre, reach) = (xyz(&block.centre[k]), block.centre[k][3]);
                let solid = model.bodies.kind(body) == BodyKind::Solid;
                if distance(model, body, &Vec3::zeros()).is_some() {
                    solids.push((centre, block.rotation[k].orientation, body));
                    continue;
                }
                let back = model.wrap(&centre) - centre;
                if !images.iter().any(|way| meets(&(centre + back + way), reach)) {
                    continue;
                }
                if solid {
                    let all = images.iter().map(|way| centre + back + way);
                    near.extend(all.filter(|x| meets(x, reach)).map(|x| (x, reach)));
                    continue;
                }
                for (x, r) in state.spheres(model, body) {
                    let all = images.iter().map(|way| x + back + way);
                    near.extend(all.filter(|x| meets(x, r)).map(|x| (x, r)));
                }
            }
        }
        let radii = near.iter().map(|s| s.1).fold(largest, f64::max) * (1.0 + GAP);
        let mut spheres = Grid::new(region.low, region.high, 2.0 * radii, radii);
        near.into_iter().for_each(|(x, r)| spheres.add(x, r));
        FreeSpace { model, state, surface, region, spheres, solids, patches: Vec::new() }
    }

    /// Occupies the position of a simultaneously inserted grain; `radius` [m].
    pub fn fill(&mut self, x: &Vec3, radius: f64) {
        self.spheres.add(*x, radius);
    }

    /// Finds and occupies a random position and orientation for a grain of bounding `radius` [m]; `None` if
    /// the box is full.
    pub fn find_position(
        &mut self,
        radius: f64,
        random: &mut FreePositions,
    ) -> Option<(Vec3, UnitQuaternion<f64>)> {
        let r = radius * (1.0 + GAP);
        let (low, high) = (self.region.low.add_scalar(r), self.region.high.add_scalar(-r));
        let mut stream = random.next();
        if (0..3).any(|d| low[d] > high[d]) {
            return None;
        }
        let place = (0..TRIES).find_map(|_| {
            let x = Vec3::from_fn(|d, _| low[d] + stream.uniform() * (high[d] - low[d]));
            self.free(&x, r).then_some(x)
        })?;
        self.spheres.add(place, r);
        Some((place, stream.orientation()))
    }

    fn free(&mut self, x: &Vec3, r: f64) -> bool {
        let FreeSpace { model, state, .. } = *self;
        let clear_of_planes = model
            .planes
            .iter()
            .zip(&state.planes)
            .all(|(plane, now)| now.open || (x - plane.point - now.offset).dot(&plane.normal) >= r);
        let clear_of_solids = || {
            self.solids.iter().all(|(centre, turn, body)| {
                let point = turn.inverse_transform_vector(&(x - centre));
                distance(model, *body, &point).is_none_or(|distance| distance >= r)
            })
        };
        if !(clear_of_planes && self.spheres.free(x, r) && clear_of_solids()) {
            return false;
        }
        let walls = model.walls.placed(&state.walls);
        clear_of(&walls, x, r, &mut self.patches) && clear_of(self.surface, x, r, &mut self.patches)
    }
}

/// Distance from a body of a point in its frame [m], where its shape has one.
fn distance(model: &Model, body: usize, point: &Vec3) -> Option<f64> {
    model.shape(body).query(|s| s.distance(model.body(body).scale, point))
}

/// Returns true if a sphere is clear of a surface, on its outer side if one-sided.
fn clear_of(surface: &dyn Surface, x: &Vec3, r: f64, patches: &mut Vec<u32>) -> bool {
    if surface.is_empty() {
        return true;
    }
    patches.clear();
    surface.candidates(x.add_scalar(-r).into(), x.add_scalar(r).into(), patches);
    patches.iter().all(|&patch| {
        let closest = surface.closest_point(patch, (*x).into(), [0.0; 2]);
        let away = x - Vec3::from(closest.point);
        let outside = !surface.one_sided_patch(patch) || away.dot(&Vec3::from(closest.normal)) > 0.0;
        away.norm() >= r && outside
    })
}

/// Offsets of adjacent periodic images, with zero [m].
fn images(model: &Model) -> Vec<Vec3> {
    let periodic = model.periodic();
    let mut ways = vec![Vec3::zeros()];
    for (d, borders) in periodic.iter().enumerate() {
        let Some([low, high]) = borders else { continue };
        let mut way = Vec3::zeros();
        way[d] = high - low;
        ways = ways.iter().flat_map(|w| [*w, w - way, w + way]).collect();
    }
    ways
}

/// Random streams, one per grain: values depend on seed and request count only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct FreePositions {
    seed: u64,
    requests: u64,
}

impl FreePositions {
    /// Starts the streams of a seed.
    pub fn new(seed: u64) -> FreePositions {
        FreePositions { seed, requests: 0 }
    }

    fn next(&mut self) -> Random {
        self.requests += 1;
        // Odd multipliers separate grains and purposes.
        Random::new(self.seed ^ self.requests.wrapping_mul(0xd134_2543_de82_ef95), PURPOSE)
    }
}

#[cfg(test)]
#[path = "free_space_tests.rs"]
mod tests;
