//! Regions of growth against walls.

use super::overlap::LARGEST_OVERLAP;
use super::part::GrainsPart;
use crate::scene::{Document, SceneError};
use std::f64::consts::TAU;
use trackbed_dem::insert::closed::ClosedSurface;
use trackbed_dem::insert::container::Container;
use trackbed_dem::{Vec3, WallShape};

/// Points on each end of a cone.
const RING: usize = 48;

/// Rejects regions of growth that reach through walls, unless the group has `accept_overlap`.
///
/// # Errors
/// First region.
pub fn check_growth(document: &Document, grains: &GrainsPart) -> Result<(), SceneError> {
    let groups = &grains.groups;
    for growth in &groups.growths {
        let bodies = &groups.bodies[growth.bodies.clone()];
        let Some(part) = bodies.first().map(|b| b.part).filter(|p| !groups.overlapping.contains(p)) else {
            continue;
        };
        let smallest = bodies.iter().map(|b| groups.reach(b)).fold(f64::INFINITY, f64::min);
        let found = crossed(grains, &growth.container, LARGEST_OVERLAP * smallest);
        if let Some(found) = found {
            let expected = "a region within the walls: grains grow up to its sides";
            return Err(document.error(&format!("grains.{part}.region"), found, expected));
        }
    }
    Ok(())
}

/// `limit`: depth behind a wall [m].
fn crossed(grains: &GrainsPart, container: &Container, limit: f64) -> Option<String> {
    let points = extreme(container);
    let behind = |point: &Vec3, normal: &Vec3| {
        let normal = normal.normalize();
        let depth = points.iter().map(|x| (point - x).dot(&normal)).fold(f64::NEG_INFINITY, f64::max);
        (depth > limit).then(|| format!("a region {depth:.3e} m behind"))
    };
    for (k, plane) in grains.walls.planes.iter().enumerate() {
        if let Some(found) = behind(&plane.point, &plane.normal) {
            return Some(format!("{found} {}", grains.names().plane(k)));
        }
    }
    let later = grains.packing.deposition.is_some();
    for (wall, name) in grains.walls.others.iter().zip(&grains.walls.names) {
        if later && (wall.servo.is_some() || wall.body.is_some()) {
            continue;
        }
        let found = match wall.shape.plane() {
            Some((point, normal)) => behind(point, normal),
            None => straddles(&wall.shape, &points, limit).then(|| "a region across".into()),
        };
        if let Some(found) = found {
            return Some(format!("{found} wall \"{name}\""));
        }
    }
    None
}

/// Points whose hull is the hull of the container [m].
fn extreme(container: &Container) -> Vec<Vec3> {
    match container {
        Container::Box { low, high } => {
            let corner = |k: usize| Vec3::from_fn(|d, _| if k >> d & 1 == 0 { low[d] } else { high[d] });
            (0..8).map(corner).collect()
        }
        Container::Cone { from, to, from_radius, to_radius } => {
            let axis = (to - from).normalize();
            let helper = if axis.x.abs() < 0.9 { Vec3::x() } else { Vec3::y() };
            let u = axis.cross(&helper).normalize();
            let v = axis.cross(&u);
            let at = |k: usize, end: &Vec3, radius: f64| {
                let a = TAU * k as f64 / RING as f64;
                end + (u * libm::cos(a) + v * libm::sin(a)) * radius
            };
            let ends = [(from, *from_radius), (to, *to_radius)];
            ends.iter().flat_map(|(end, r)| (0..RING).map(move |k| at(k, end, *r))).collect()
        }
        Container::Surface(surface) => surface.vertices().to_vec(),
    }
}

/// Whether points, moved inwards by `margin` [m], and their middle lie on both sides.
fn straddles(shape: &WallShape, points: &[Vec3], margin: f64) -> bool {
    let Some(side) = inside_of(shape) else { return false };
    let middle = points.iter().sum::<Vec3>() / points.len().max(1) as f64;
    let inwards = |x: &Vec3| {
        let away = (x - middle).norm();
        if away > margin { middle + (x - middle) * (1.0 - margin / away) } else { middle }
    };
    let sides: Vec<bool> = points.iter().map(inwards).chain([middle]).filter_map(|x| side(&x)).collect();
    sides.contains(&true) && sides.contains(&false)
}

/// Side of a point.
type Side<'a> = Box<dyn Fn(&Vec3) -> Option<bool> + 'a>;

/// Returns a function that decides if a point is inside a wall. None for planes and open surfaces.
pub fn inside_of(shape: &WallShape) -> Option<Side<'_>> {
    if let Some((vertices, triangles)) = shape.triangulated() {
        let surface = ClosedSurface::new(vertices, triangles).ok()?;
        return Some(Box::new(move |x: &Vec3| Some(surface.contains(x))));
    }
    shape.encloses().then(|| Box::new(move |x: &Vec3| shape.contains(x)) as Side<'_>)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(low: f64, high: f64) -> Vec<Vec3> {
        extreme(&Container::Box { low: Vec3::repeat(low), high: Vec3::repeat(high) })
    }

    fn block() -> WallShape {
        let vertices = cube(0.0, 1.0);
        // Corners are numbered by x, y, z in bits 0, 1, 2.
        let squares = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
        let triangles = squares.iter().flat_map(|s| [[s[0], s[1], s[2]], [s[0], s[2], s[3]]]).collect();
        WallShape::Triangles { vertices, triangles }
    }

    #[test]
    fn closed_walls_are_crossed_or_not() {
        let sphere = WallShape::Sphere { centre: Vec3::repeat(0.5), radius: 0.5 };
        let axis = Vec3::z();
        let tube = |caps| WallShape::Frustum {
            base: Vec3::new(0.5, 0.5, 0.0),
            axis,
            height: 1.0,
            radii: [0.5; 2],
            caps,
        };
        for (shape, [within, around, beside]) in [
            (sphere, [false, true, false]),
            (block(), [false, true, false]),
            (tube([true, true]), [false, true, false]),
            (tube([false, false]), [false, false, false]),
        ] {
            assert_eq!(straddles(&shape, &cube(0.3, 0.7), 1e-3), within, "{shape:?}");
            assert_eq!(straddles(&shape, &cube(-0.1, 1.1), 1e-3), around, "{shape:?}");
            assert_eq!(straddles(&shape, &cube(1.2, 1.5), 1e-3), beside, "{shape:?}");
        }
        // Corners of a box between the ends of an open tube.
        let wide = extreme(&Container::Box { low: Vec3::new(0.0, 0.0, 0.2), high: Vec3::new(1.0, 1.0, 0.8) });
        assert!(straddles(&tube([false, false]), &wide, 1e-3));
    }

    /// A region that fills the wall touches it.
    #[test]
    fn region_may_fill_a_closed_wall() {
        assert!(!straddles(&block(), &cube(0.0, 1.0), 1e-3));
        assert!(straddles(&block(), &cube(-0.01, 1.0), 1e-3));
    }

    #[test]
    fn cone_points_reach_its_bounds() {
        let cone = Container::Cone { from: Vec3::zeros(), to: Vec3::z(), from_radius: 0.1, to_radius: 0.5 };
        let points = extreme(&cone);
        let top = points.iter().map(|x| x.x).fold(0.0, f64::max);
        assert!((top - 0.5).abs() < 2e-3 && points.len() == 96, "{top}");
    }
}
