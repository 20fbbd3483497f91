//! Grains of a preview: groups in their initial positions, regions that are filled, inlets, outlets.

use super::context::Context;
use super::item::{Item, Shape, union};
use super::palette;
use super::walls::{rectangle, round};
use trackbed_dem::{BodyInput, Vec3, WallShape};
use trackbed_input::model::grains::{GrainsPart, OutletRegion};
use trackbed_input::scene::grains::Grains;
use trackbed_input::scene::units::vector;

pub fn groups(c: &Context) -> Vec<Item> {
    let Some(part) = &c.job.grains else { return Vec::new() };
    let mut shapes = vec![(Shape::default(), 0, 0); c.scene.grains.len()];
    for (k, body) in part.groups.bodies.iter().enumerate() {
        let Some((shape, present, waiting)) = shapes.get_mut(body.part as usize) else { continue };
        match body.absent {
            true => *waiting += 1,
            false => {
                *present += 1;
                add(shape, body, k as u32, part);
            }
        }
    }
    let item = |(k, ((shape, present, waiting), group)): (usize, ((Shape, usize, usize), &Grains))| {
        let key = format!("grains.{k}");
        let item = Item::new(key, &group.name, shape).counted(present, "grain").coloured(palette::group(k));
        if waiting > 0 { Item { count: format!("{}, {waiting} queued", item.count), ..item } } else { item }
    };
    shapes.into_iter().zip(&c.scene.grains).enumerate().map(item).collect()
}

fn add(shape: &mut Shape, body: &BodyInput, index: u32, part: &GrainsPart) {
    let place = |x: &Vec3| body.position + body.orientation * (x * body.scale);
    part.groups.shapes[body.shape].query(|it| {
        it.for_spheres(&mut |x, r| {
            let at = place(&x);
            shape.spheres.push([at.x, at.y, at.z, r * body.scale]);
        });
        if let Some((points, polygons)) = it.outline() {
            shape.polygons(points.iter().map(|x| place(x).into()), polygons.iter().map(Vec::as_slice));
        }
    });
    let numbered = if shape.points.is_empty() { shape.spheres.len() } else { shape.points.len() };
    shape.ids.resize(numbered, index);
}

/// Boxes and other regions in which grains are placed.
pub fn fills(c: &Context) -> Vec<Item> {
    let Some(part) = &c.job.grains else { return Vec::new() };
    let item = |(k, group): (usize, &Grains)| {
        let (table, shape) = region(c, part, k, group)?;
        Some(Item::new(format!("grains.{k}.{table}"), format!("{}: {table}", group.name), shape))
    };
    c.scene.grains.iter().enumerate().filter_map(item).collect()
}

fn region(c: &Context, part: &GrainsPart, k: usize, group: &Grains) -> Option<(&'static str, Shape)> {
    if let Some(fill) = &group.fill {
        let (low, top) = (vector(&fill.low), top(part, k).unwrap_or(c.bounds[1][2]));
        let high = [fill.high[0].si, fill.high[1].si, top.max(low[2])];
        return Some(("fill", Shape::cuboid(low, high)));
    }
    if let Some(lattice) = &group.lattice {
        let low = vector(&lattice.low);
        let high = lattice.high.map(|high| vector(&high)).or_else(|| Some(bounds(part, k)?[1]))?;
        return Some(("lattice", Shape::cuboid(low, high)));
    }
    if let Some(region) = &group.region {
        if let Some([low, high]) = &region.cuboid {
            return Some(("region", Shape::cuboid(vector(low), vector(high))));
        }
        if let Some(cone) = &region.cone {
            let [from, to] = [&cone.from, &cone.to].map(|x| Vec3::from(vector(x)));
            let radii = [cone.radii[0].si, cone.radii[1].si];
            let (axis, height) = (to - from, (to - from).norm());
            let shape = WallShape::Frustum { base: from, axis, height, radii, caps: [true; 2] };
            return Some(("region", Shape { triangles: Vec::new(), ..round(&shape, c.bounds) }));
        }
        let [low, high] = bounds(part, k)?;
        return Some(("region", Shape::cuboid(low, high)));
    }
    let floes = group.floes.as_ref()?;
    let [low, high] = [floes.low, floes.high].map(|corner| corner.map(|x| x.si));
    let [z0, z1] = bounds(part, k).map_or([0.0; 2], |b| [b[0][2], b[1][2]]);
    Some(("floes", Shape::cuboid([low[0], low[1], z0], [high[0], high[1], z1])))
}

fn bounds(part: &GrainsPart, group: usize) -> Option<[[f64; 3]; 2]> {
    let own = part.groups.bodies.iter().filter(|b| b.part as usize == group && !b.absent);
    union(own.map(|b| {
        let (x, r) = (b.position, part.groups.reach(b));
        [[x.x - r, x.y - r, x.z - r], [x.x + r, x.y + r, x.z + r]]
    }))
}

fn top(part: &GrainsPart, group: usize) -> Option<f64> {
    bounds(part, group).map(|b| b[1][2])
}

/// Inlets and outlets.
pub fn flow(c: &Context) -> Vec<Item> {
    let Some(flow) = c.job.grains.as_ref().and_then(|part| part.flow.as_ref()) else { return Vec::new() };
    let inlets = flow.inlets.iter().map(|inlet| {
        let mut shape = Shape::cuboid(inlet.region.low.into(), inlet.region.high.into());
        let middle = 0.5 * (inlet.region.low + inlet.region.high);
        let down = if inlet.velocity.norm() > 0.0 { inlet.velocity } else { -Vec3::z() };
        shape.arrow(middle.into(), down, 0.08 * c.size());
        Item::new(format!("grains.{}.inlet", inlet.part), format!("inlet of {}", inlet.group), shape)
            .coloured("218f33")
    });
    let outlets = flow.outlets.iter().enumerate().map(|(k, outlet)| {
        let shape = match &outlet.region {
            OutletRegion::Box(region) => Shape::cuboid(region.low.into(), region.high.into()),
            OutletRegion::Beyond { point, normal } => {
                Shape { triangles: Vec::new(), ..rectangle(point, normal, c.bounds) }
            }
        };
        Item::new(format!("outlet.{k}"), &outlet.name, shape).coloured("cc2924")
    });
    inlets.chain(outlets).collect()
}
