//! Sources of the grains of a group.

use crate::scene::grains::Grains;

/// Sources of initial grains, with presence.
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

/// Whether all grains of a group are queued at its inlet.
pub fn waits(group: &Grains) -> bool {
    group.inlet.is_some() && sources(group).iter().all(|(_, present)| !present)
}
