//! Walls in history and frames.

use super::recorder::{Now, Recorder};
use super::system::{GrainsView, System};
use trackbed_dem::{Vec3, WallShape};
use trackbed_input::model::grains::GrainsPart;
use trackbed_io::columns::history;
use trackbed_io::write::csv::Row;
use trackbed_io::write::{WallFrame, WallKind};

const AROUND: u32 = 48;

/// Support energies; force, moment about the centre and displacement of recorded walls.
pub struct Walls;

impl<S: System> Recorder<S> for Walls {
    fn record(&self, now: &Now<'_, S>, row: &mut Row) {
        let (Some(part), Some(view)) = (&now.job.grains, now.system.grains()) else { return };
        if part.walls.others.iter().filter_map(|w| w.body.as_ref()).any(|b| b.mount.is_some()) {
            row.put(history::MOUNT_ENERGY, now.balance.now.mounts);
            row.put(history::DISSIPATED_MOUNTS, now.balance.spent.mounts);
        }
        for wall in &part.walls.recorded {
            let (name, wall) = (&wall.name, wall.wall);
            if let Some(servo) = &part.walls.others[wall].servo {
                let driven = servo.driven.is_some_and(|[from, _]| now.time >= from);
                row.put(history::WALL_TARGET.of(name), if driven { 0.0 } else { servo.target(now.time) });
            }
            let (force, moment) = view.state.wall_force(wall);
            row.vector(history::WALL_FORCE.of(name), force);
            row.vector(history::WALL_MOMENT.of(name), moment);
            row.vector(history::WALL_DISPLACEMENT.of(name), view.state.wall_offset(wall));
        }
    }
}

/// Adds patch walls, numbered from `id`.
pub fn polygons(
    view: GrainsView<'_>,
    part: &GrainsPart,
    extent: (Vec3, f64),
    mut id: u32,
    frame: &mut WallFrame,
) -> u32 {
    for (k, wall) in part.walls.others.iter().enumerate() {
        let first = frame.points.len() as u32;
        let (points, polygons) = outline(&wall.shape, |x| view.state.wall_point(view.model, k, &x), extent);
        frame.points.extend(points.iter().map(|p| <[f64; 3]>::from(*p)));
        for polygon in polygons {
            frame.polygons.push(polygon.iter().map(|v| v + first).collect());
            frame.id.push(id);
            frame.kind.push(WallKind::Wall as u32);
        }
        id += 1;
    }
    id
}

/// Points and polygons of a shape moved by `place`.
pub fn outline(
    shape: &WallShape,
    place: impl Fn(Vec3) -> Vec3,
    extent: (Vec3, f64),
) -> (Vec<Vec3>, Vec<Vec<u32>>) {
    match shape {
        WallShape::Triangles { vertices, triangles } => {
            (vertices.iter().map(|v| place(*v)).collect(), triangles.iter().map(|t| t.to_vec()).collect())
        }
        WallShape::Plane { point, normal } => square(&place(*point), &normal.normalize(), extent),
        WallShape::Frustum { base, axis, height, radii, caps } => {
            let k = axis.normalize();
            let (u, v) = across(&k);
            let ring = |end: usize| {
                let (middle, r) = (base + k * (*height * end as f64), radii[end]);
                (0..AROUND).map(move |i| {
                    let (sin, cos) = libm::sincos(f64::from(i) / f64::from(AROUND) * std::f64::consts::TAU);
                    middle + (u * cos + v * sin) * r
                })
            };
            let points = ring(0).chain(ring(1)).map(place).collect();
            let mut polygons: Vec<Vec<u32>> = (0..AROUND)
                .map(|i| {
                    let j = (i + 1) % AROUND;
                    vec![i, j, j + AROUND, i + AROUND]
                })
                .collect();
            for end in (0..2).filter(|&end| caps[end]) {
                polygons.push((0..AROUND).map(|i| i + end as u32 * AROUND).collect());
            }
            (points, polygons)
        }
        WallShape::Sphere { centre, radius } => {
            // Polar caps are separate polygons.
            let rings = AROUND / 2 - 1;
            let mut points = Vec::new();
            for j in 1..=rings {
                let (sin, cos) = libm::sincos(f64::from(j) / f64::from(rings + 1) * std::f64::consts::PI);
                for i in 0..AROUND {
                    let (s, c) = libm::sincos(f64::from(i) / f64::from(AROUND) * std::f64::consts::TAU);
                    points.push(place(centre + Vec3::new(c * sin, s * sin, cos) * *radius));
                }
            }
            let mut polygons: Vec<Vec<u32>> =
                vec![(0..AROUND).collect(), (0..AROUND).map(|i| (rings - 1) * AROUND + i).collect()];
            for j in 1..rings {
                for i in 0..AROUND {
                    let (a, b) = ((j - 1) * AROUND + i, (j - 1) * AROUND + (i + 1) % AROUND);
                    polygons.push(vec![a, b, b + AROUND, a + AROUND]);
                }
            }
            (points, polygons)
        }
    }
}

fn across(k: &Vec3) -> (Vec3, Vec3) {
    let helper = if k.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() };
    let u = k.cross(&helper).normalize();
    (u, k.cross(&u))
}

/// Returns a square of a plane next to the grains.
pub fn square(point: &Vec3, normal: &Vec3, (centre, half): (Vec3, f64)) -> (Vec<Vec3>, Vec<Vec<u32>>) {
    let middle = centre - normal * (centre - point).dot(normal);
    let (u, v) = across(normal);
    let corner = |a: f64, b: f64| middle + (u * a + v * b) * half;
    (vec![corner(-1., -1.), corner(1., -1.), corner(1., 1.), corner(-1., 1.)], vec![vec![0, 1, 2, 3]])
}
