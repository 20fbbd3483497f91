//! Contact geometry per shape pair.
//!
//! Theory manual: equation (1.1) of `docs/theory/contacts.md`.

use crate::base::Vec3;
use crate::lanes::{Real, V3};
use crate::shape::cuboid;
use nalgebra::UnitQuaternion;

/// Contact of partner a, which receives the force, with b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactGeometry {
    /// Point of the force on both [m].
    pub point: Vec3,
    /// Unit normal, from b to a.
    pub normal: Vec3,
    /// Overlap [m].
    pub overlap: f64,
    /// Effective radius 1/(1/R₁ + 1/R₂) [m].
    pub radius: f64,
}

#[derive(Clone, Copy, Debug)]
pub struct Spheres<R> {
    xa: V3<R>,
    ra: R,
    rb: R,
    between: V3<R>,
    distance2: R,
    reach: R,
}

/// See [`ContactGeometry`].
pub struct Overlap<R> {
    pub point: V3<R>,
    pub normal: V3<R>,
    pub overlap: R,
    pub radius: R,
}

impl<R: Real> Spheres<R> {
    #[inline(always)]
    pub fn new(xa: V3<R>, ra: R, xb: V3<R>, rb: R) -> Spheres<R> {
        let between = xa - xb;
        Spheres { xa, ra, rb, between, distance2: between.norm2(), reach: ra + rb }
    }

    #[inline(always)]
    pub fn on(&self) -> R::Mask {
        self.distance2.lt(self.reach * self.reach)
    }

    /// The contact point halves the overlap. Coincident centres give a normal along z.
    #[inline(always)]
    pub fn touch(&self) -> Overlap<R> {
        let &Spheres { xa, ra, rb, between, distance2, reach } = self;
        let (distance, zero, one) = (distance2.sqrt(), R::zero(), R::splat(1.0));
        let mut normal = between * (distance * (one / distance2));
        let apart = zero.lt(distance);
        if !R::all(apart) {
            normal = V3::select(apart, normal, V3::new(zero, zero, one));
        }
        let overlap = reach - distance;
        let point = xa - normal * (ra - R::splat(0.5) * overlap);
        Overlap { point, normal, overlap, radius: ra * rb / reach }
    }
}

/// Sphere–sphere contact.
#[inline(always)]
pub fn sphere_sphere(xa: &Vec3, ra: f64, xb: &Vec3, rb: f64) -> Option<ContactGeometry> {
    let both = Spheres::new(V3::from_vec(xa), ra, V3::from_vec(xb), rb);
    both.on().then(|| {
        let Overlap { point, normal, overlap, radius } = both.touch();
        ContactGeometry { point: point.to_vec(), normal: normal.to_vec(), overlap, radius }
    })
}

/// Sphere (or point of radius 0) and plane through `origin`, unit `normal`.
#[inline(always)]
pub fn sphere_plane(x: &Vec3, r: f64, origin: &Vec3, normal: &Vec3) -> Option<ContactGeometry> {
    let height = (x - origin).dot(normal);
    if height >= r {
        return None;
    }
    Some(ContactGeometry { point: x - normal * height, normal: *normal, overlap: r - height, radius: r })
}

/// Sphere and box; inside, the nearest face.
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
