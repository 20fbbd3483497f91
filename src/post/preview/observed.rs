//! Probes, boxes, water and periodic borders of a preview.

use super::context::Context;
use super::item::{Item, Shape};
use super::walls::rectangle;
use crate::water::Surface;
use trackbed_dem::{BodyForce, Vec3};
use trackbed_input::model::Observed;
use trackbed_input::scene::units::vector;

/// Radius of a probe over the model size.
const PROBE: f64 = 0.008;

pub fn probes(c: &Context) -> Vec<Item> {
    let ball = |x: [f64; 3], r: f64| Shape { spheres: vec![[x[0], x[1], x[2], r]], ..Shape::default() };
    let item = |(k, (name, observed)): (usize, &(String, Observed))| {
        let shape = match observed {
            Observed::Node(node) => {
                ball(c.job.solid.as_ref()?.model.mesh().coordinates[*node], PROBE * c.size())
            }
            Observed::Point(point) => {
                let (mesh, r) = (c.job.solid.as_ref()?.model.mesh(), PROBE * c.size());
                let spheres = (0..point.samples.count()).map(|k| {
                    let [x, y, z] = point.samples.position(mesh, k);
                    [x, y, z, r]
                });
                Shape { spheres: spheres.collect(), ..Shape::default() }
            }
            Observed::Plane(_) | Observed::Volume(_) => {
                let table = &c.scene.probe[k];
                let [low, high] = table.plane.as_ref().or(table.solid_box.as_ref())?;
                Shape::cuboid(vector(low), vector(high))
            }
            Observed::Grain(grain) => {
                let groups = &c.job.grains.as_ref()?.groups;
                let body = &groups.bodies[*grain];
                ball(body.position.into(), 1.05 * groups.reach(body))
            }
            Observed::Region(region) => Shape::cuboid(region.low.into(), region.high.into()),
            Observed::Group(_) => return None,
        };
        Some(Item::new(format!("probe.{k}"), name, shape))
    };
    c.job.probes.iter().enumerate().filter_map(item).collect()
}

/// Boxes of measurements and compaction.
pub fn boxes(c: &Context) -> Vec<Item> {
    let Some(part) = &c.job.grains else { return Vec::new() };
    let measures = part.measures.iter().enumerate().map(|(k, m)| {
        Item::new(format!("measure.{k}"), &m.name, Shape::cuboid(m.region.low.into(), m.region.high.into()))
    });
    let stages = c.scene.compaction.iter().enumerate().map(|(k, stage)| {
        let [low, high] = &stage.region;
        let name = format!("{} {k}", format!("{:?}", stage.kind).to_lowercase());
        Item::new(format!("compaction.{k}"), name, Shape::cuboid(vector(low), vector(high)))
    });
    measures.chain(stages).collect()
}

pub fn water(c: &Context) -> Vec<Item> {
    let Some(BodyForce::Water(water)) = c.job.grains.as_ref().and_then(|part| part.water.as_ref()) else {
        return Vec::new();
    };
    let surface = Surface::new(water, c.bounds);
    let (points, triangles, edges) = (surface.points(0.0), surface.triangles(), surface.border());
    let shape = Shape { points, triangles, edges, ..Shape::default() };
    vec![Item::new("water", surface.name(), shape)]
}

pub fn periodic(c: &Context) -> Vec<Item> {
    let Some(part) = &c.job.grains else { return Vec::new() };
    let item = |(k, borders): (usize, &Option<[f64; 2]>)| {
        let mut shape = Shape::default();
        for border in (*borders)? {
            let mut normal = Vec3::zeros();
            normal[k] = 1.0;
            let side = rectangle(&(normal * border), &normal, c.bounds);
            let square: &[u32] = &[0, 1, 2, 3];
            shape.polygons(side.points, [square]);
        }
        let name = ["x", "y", "z"][k];
        Some(Item::new(format!("periodic.{name}"), format!("periodic in {name}"), shape))
    };
    part.periodic.iter().enumerate().filter_map(item).collect()
}
