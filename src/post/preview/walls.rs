//! Walls, sleepers and rails of a preview.

use super::context::Context;
use super::item::{Item, Shape, across};
use trackbed_dem::{Vec3, WallShape};
use trackbed_input::model::grains::{GroupsPart, is_plain};
use trackbed_input::scene::walls::Wall;

/// Margin of planes over the model.
const MARGIN: f64 = 0.03;
/// Half width and height of a rail [m].
const RAIL: [f64; 2] = [0.035, 0.17];
/// Length of a seat load over the sleeper length.
const SEAT: f64 = 0.2;

type Bounds = [[f64; 3]; 2];

/// Part of a plane that borders a box.
pub fn rectangle(point: &Vec3, normal: &Vec3, bounds: Bounds) -> Shape {
    let Some(n) = normal.try_normalize(0.0) else { return Shape::default() };
    let (u, v) = across(&n);
    let corners = Shape::cuboid(bounds[0], bounds[1]).points;
    let range = |axis: &Vec3| {
        let along = corners.iter().map(|x| Vec3::from(*x).dot(axis));
        let [low, high] = along.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], x| [a.min(x), b.max(x)]);
        let margin = MARGIN * (high - low);
        [low - margin, high + margin]
    };
    let (a, b, height) = (range(&u), range(&v), n.dot(point));
    let corner = |i: usize, j: usize| <[f64; 3]>::from(u * a[i] + v * b[j] + n * height);
    let mut shape = Shape::default();
    let square: &[u32] = &[0, 1, 2, 3];
    shape.polygons([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)], [square]);
    shape
}

/// Surface of any wall.
pub fn round(wall: &WallShape, bounds: Bounds) -> Shape {
    if let Some((point, normal)) = wall.plane() {
        return rectangle(point, normal, bounds);
    }
    let (points, polygons) = wall.outline(|x| x, (Vec3::zeros(), 1.0));
    let mut shape = Shape::default();
    shape.polygons(points.into_iter().map(Into::into), polygons.iter().map(Vec::as_slice));
    shape
}

pub fn walls(c: &Context) -> Vec<Item> {
    let Some(part) = &c.job.grains else { return Vec::new() };
    let (mut planes, mut others) = (part.walls.planes.iter(), part.walls.others.iter());
    let item = |(k, wall): (usize, &Wall)| {
        let shape = match is_plain(wall) {
            true => planes.next().map(|plane| rectangle(&plane.point, &plane.normal, c.bounds)),
            false => others.next().map(|other| round(&other.shape, c.bounds)),
        };
        let kind = format!("{:?}", wall.kind).to_lowercase();
        let name = wall.name.clone().unwrap_or_else(|| format!("{kind} {k}"));
        let faces = shape.as_ref().map_or(0, |shape| shape.triangles.len());
        let item = Item::new(format!("walls.{k}"), name, shape.unwrap_or_default());
        match kind.as_str() {
            "mesh" | "triangles" => item.counted(faces, "triangle"),
            _ => Item { count: kind, ..item },
        }
    };
    c.scene.walls.iter().enumerate().map(item).collect()
}

/// Height of the sleeper bases before they are set down [m].
fn base(c: &Context) -> f64 {
    let groups = c.job.grains.iter().map(|part| &part.groups);
    let top = |group: &GroupsPart| {
        let present = group.bodies.iter().filter(|b| !b.absent);
        present.map(|b| b.position.z + group.reach(b)).reduce(f64::max)
    };
    let level = c.scene.deposition.as_ref().and_then(|d| d.level).map(|level| level.si);
    let ground = c.job.solid.as_ref().map(|_| c.bounds[1][2]);
    groups.filter_map(top).reduce(f64::max).or(level).or(ground).unwrap_or(0.0)
}

pub fn sleepers(c: &Context) -> Vec<Item> {
    let Some(plan) = c.job.grains.as_ref().and_then(|part| part.track.sleeper.as_ref()) else {
        return Vec::new();
    };
    let (row, base, mut shape) = (&plan.row, base(c), Shape::default());
    for [x, y] in &row.centres {
        let [a, b, h] = row.half;
        shape.block([x - a, y - b, base], [x + a, y + b, base + 2.0 * h]);
    }
    vec![Item::new("track.sleeper", "sleepers", shape).counted(row.centres.len(), "sleeper")]
}

/// Rail seats with their loads, rails.
pub fn rails(c: &Context) -> Vec<Item> {
    let Some(part) = c.job.grains.as_ref().map(|part| &part.track) else { return Vec::new() };
    let (Some(plan), Some(table)) = (&part.sleeper, &c.scene.track) else { return Vec::new() };
    let (row, top) = (&plan.row, base(c) + 2.0 * plan.row.half[2]);
    let mut seats = Shape::default();
    for [x, y] in &row.centres {
        for seat in &row.seats {
            let length = SEAT * 2.0 * row.half.iter().copied().fold(0.0, f64::max);
            seats.arrow([x + seat[0], y + seat[1], top], -Vec3::z(), length);
        }
    }
    let count = row.centres.len() * row.seats.len();
    let key = if table.load.is_some() { "track.load" } else { "track.sleeper" };
    let mut items = vec![Item::new(key, "rail seats", seats).counted(count, "seat").coloured("d55e00")];
    if let (Some(_), Some(spacing), [first, .., last]) =
        (&table.rail, table.sleeper.spacing, &row.centres[..])
    {
        let mut shape = Shape::default();
        for seat in &row.seats {
            let [mut low, mut high] = [first, last].map(|x| [x[0] + seat[0], x[1] + seat[1], top]);
            (low[row.axis], high[row.axis]) =
                (low[row.axis] - 0.5 * spacing.si, high[row.axis] + 0.5 * spacing.si);
            (low[1 - row.axis], high[1 - row.axis]) =
                (low[1 - row.axis] - RAIL[0], high[1 - row.axis] + RAIL[0]);
            high[2] += RAIL[1];
            shape.block(low, high);
        }
        items.push(
            Item::new("track.rail", "rails", shape).counted(row.seats.len(), "rail").coloured("5b4a3f"),
        );
    }
    items
}
