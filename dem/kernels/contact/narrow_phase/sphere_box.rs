//! Sphere–box contacts.

use super::pair::{Manifold, PairContactPoint, ShapePair};
use super::scene::PosedBody;
use super::side::{Solids, Spheres};
use crate::lanes::vec4::{Vec4, xyz};
use crate::shape::cuboid;
use crate::spatial::detect;

pub struct SphereBox;

impl ShapePair for SphereBox {
    type First = Spheres;
    type Second = Solids;

    fn may_touch(&self, sphere: &&Vec4, solid: &PosedBody<'_>, reach: f64) -> bool {
        solid.half().is_some_and(|half| {
            let local = solid.orientation.inverse_transform_vector(&(xyz(sphere) - solid.centre));
            cuboid::closest_point(&half, &local).2 < sphere[3] + reach
        })
    }

    fn contact_points(&self, sphere: &&Vec4, solid: &PosedBody<'_>, found: &mut Manifold) {
        let Some(half) = solid.half() else { return };
        let touch = detect::sphere_box(&xyz(sphere), sphere[3], &solid.centre, &solid.orientation, &half);
        found.extend(touch.map(|g| PairContactPoint::only(g, 2.0 * sphere[3])));
    }
}
