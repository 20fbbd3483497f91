//! Geometry of a touch, per pair of shapes. Nothing here knows stiffness or storage.

use crate::base::Vec3;
use crate::law::ContactGeometry;
use crate::shape::cuboid;
use nalgebra::UnitQuaternion;

/// Two spheres. The contact point halves the overlap. Coincident centres give a normal along z.
#[inline(always)]
pub fn sphere_sphere(xa: &Vec3, ra: f64, xb: &Vec3, rb: f64) -> Option<ContactGeometry> {
    let between = xa - xb;
    let reach = ra + rb;
    let distance2 = between.norm_squared();
    if distance2 >= reach * reach {
        return None;
    }
    let distance = distance2.sqrt();
    // distance/distance² rather than 1/distance: the division need not wait for the root.
    let normal = if distance > 0.0 { between * (distance * (1.0 / distance2)) } else { Vec3::z() };
    let overlap = reach - distance;
    let point = xa - normal * (ra - 0.5 * overlap);
    Some(ContactGeometry { point, normal, overlap, radius: ra * rb / reach })
}

/// A sphere (or, with radius 0, a point) and a plane through `origin` with unit normal `normal`.
#[inline(always)]
pub fn sphere_plane(x: &Vec3, r: f64, origin: &Vec3, normal: &Vec3) -> Option<ContactGeometry> {
    let height = (x - origin).dot(normal);
    if height >= r {
        return None;
    }
    Some(ContactGeometry { point: x - normal * height, normal: *normal, overlap: r - height, radius: r })
}

/// A sphere and a box at `centre`, by the closest point of the box's surface; inside, by the nearest face.
#[inline(always)]
pub fn sphere_box(
    x: &Vec3,
    r: f64,
    centre: &Vec3,
    orientation: &UnitQuaternion<f64>,
    half: &Vec3,
) -> Option<ContactGeometry> {
    let (point, normal, distance) =
        cuboid::closest_point(half, &orientation.inverse_transform_vector(&(x - centre)));
    if distance >= r {
        return None;
    }
    Some(ContactGeometry {
        point: centre + orientation * point,
        normal: orientation * normal,
        overlap: r - distance,
        radius: r,
    })
}
