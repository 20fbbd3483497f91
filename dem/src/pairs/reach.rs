//! Which partners a near list holds, as formulas that the engine runs and a device is given as text.

use crate::lanes::{Real, V3};

/// Whether two spheres are less than `near` apart [m]; `between`: the way from one centre to the other [m].
#[inline(always)]
pub(crate) fn spheres<R: Real>(between: V3<R>, radii: (R, R), near: R) -> R::Mask {
    let reach = radii.0 + radii.1 + near;
    between.norm2().lt(reach * reach)
}

/// Whether a sphere is less than `near` above a plane [m]; `from`: the way from a point of the plane to its centre [m].
#[inline(always)]
pub(crate) fn plane<R: Real>(from: V3<R>, normal: V3<R>, radius: R, near: R) -> R::Mask {
    from.dot(normal).lt(radius + near)
}
