//! Where the grains of a group come from.

use crate::scene::grains::Grains;

/// Whether the group has each of the sources of grains that are there from the start.
pub(super) fn sources(group: &Grains) -> [bool; 7] {
    [
        group.spheres.is_some(),
        group.packing.is_some(),
        group.fill.is_some(),
        group.lattice.is_some(),
        group.region.is_some(),
        group.floes.is_some(),
        group.frustum.is_some(),
    ]
}

/// Whether all grains of a group wait for their inlet.
pub fn waits(group: &Grains) -> bool {
    group.inlet.is_some() && !sources(group).contains(&true)
}
