//! Neighbour list criteria, shared by engine and device text.

use crate::lanes::{Real, V3};

/// `between`: vector between centres [m].
#[inline(always)]
pub fn spheres<R: Real>(between: V3<R>, radii: (R, R), near: R) -> R::Mask {
    let reach = radii.0 + radii.1 + near;
    between.norm2().lt(reach * reach)
}

/// `from`: vector from plane to centre [m].
#[inline(always)]
pub fn plane<R: Real>(from: V3<R>, normal: V3<R>, radius: R, near: R) -> R::Mask {
    from.dot(normal).lt(radius + near)
}
