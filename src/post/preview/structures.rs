//! Structures with recorded loads: axis, sectors at the foot, layer boundaries.

use super::context::Context;
use super::item::{Item, Shape, union};
use super::walls::round;
use trackbed_input::model::grains::{GrainsPart, StructurePlan};

/// Radius of lines over the radius of the structure.
const BEYOND: f64 = 1.1;
/// Lines of a ring without sectors.
const RING: usize = 48;

pub fn all(c: &Context) -> Vec<Item> {
    let Some(part) = &c.job.grains else { return Vec::new() };
    let item = |(k, plan): (usize, &StructurePlan)| {
        let item = Item::new(format!("structure.{k}"), &plan.name, lines(c, part, plan));
        if plan.sectors > 0 { item.counted(plan.sectors, "sector") } else { item }
    };
    part.structures.iter().enumerate().map(item).collect()
}

fn lines(c: &Context, part: &GrainsPart, plan: &StructurePlan) -> Shape {
    let walls = plan.walls.iter().map(|w| round(&part.walls.others[*w].shape, c.bounds));
    let of_walls = walls.flat_map(|shape| shape.points).map(|x| [x, x]);
    let bodies = part.groups.bodies.iter().filter(|b| plan.groups.contains(&b.part) && !b.absent);
    let of_bodies = bodies.map(|b| {
        let (x, r) = (b.position, part.groups.reach(b));
        [[x.x - r, x.y - r, x.z - r], [x.x + r, x.y + r, x.z + r]]
    });
    let Some([low, high]) = union(of_walls.chain(of_bodies)) else { return Shape::default() };
    let [x, y, foot] = plan.foot;
    let far = |k: usize, axis: f64| (axis - low[k]).abs().max((high[k] - axis).abs());
    let radius = BEYOND * far(0, x).max(far(1, y));
    let at = |turn: f64, z: f64| {
        let (sin, cos) = libm::sincos(turn * std::f64::consts::TAU);
        [x + radius * cos, y + radius * sin, z]
    };
    let mut shape = Shape::default();
    line(&mut shape, [x, y, low[2].min(foot)], [x, y, high[2].max(foot)]);
    let turn = |k: usize, of: usize| k as f64 / of as f64;
    for k in 0..plan.sectors {
        line(&mut shape, [x, y, foot], at(turn(k, plan.sectors), foot));
    }
    let heights = (plan.sectors > 0).then_some(&foot).into_iter().chain(&plan.levels);
    for z in heights {
        (0..RING).for_each(|k| line(&mut shape, at(turn(k, RING), *z), at(turn(k + 1, RING), *z)));
    }
    shape
}

fn line(shape: &mut Shape, from: [f64; 3], to: [f64; 3]) {
    let first = shape.points.len() as u32;
    shape.points.extend([from, to]);
    shape.edges.push([first, first + 1]);
}
