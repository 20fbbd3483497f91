//! Where the grains of a group come from.

use crate::scene::grains::Grains;

/// Whether the group has each of the sources of grains that are there from the start.
pub(super) fn sources(group: &Grains) -> [(&'static str, bool); 7] {
    [
        ("spheres", group.spheres.is_some()),
        ("packing", group.packing.is_some()),
        ("fill", group.fill.is_some()),
        ("lattice", group.lattice.is_some()),
        ("region", group.region.is_some()),
        ("floes", group.floes.is_some()),
        ("frustum", group.frustum.is_some()),
    ]
}

/// Whether all grains of a group wait for their inlet.
pub fn waits(group: &Grains) -> bool {
    group.inlet.is_some() && sources(group).iter().all(|(_, present)| !present)
}
