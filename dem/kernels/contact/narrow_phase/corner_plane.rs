//! Corner–plane contacts: flat faces and straight edges never touch first.

use super::pair::{Manifold, PairContactPoint, ShapePair};
use super::scene::PlaneView;
use super::side::{Corner, Corners, Planes};
use crate::law::ContactGeometry;
use crate::spatial::detect;

pub struct CornerPlane;

impl ShapePair for CornerPlane {
    type First = Corners;
    type Second = Planes;

    fn may_touch(&self, corner: &Corner, plane: &PlaneView, reach: f64) -> bool {
        !plane.open && (corner.point - plane.origin).dot(&plane.normal) < reach
    }

    fn contact_points(&self, corner: &Corner, plane: &PlaneView, found: &mut Manifold) {
        let touch = detect::sphere_plane(&corner.point, 0.0, &plane.origin, &plane.normal);
        let touch = touch.map(|g| ContactGeometry { radius: corner.size, ..g });
        found.extend(touch.map(|g| PairContactPoint::only(g, corner.size)));
    }
}
