//! Sources of the grains of a group.

use crate::scene::grains::Grains;

pub(super) fn sources(group: &Grains) -> [(&'static str, bool); 8] {
    [
        ("spheres", group.spheres.is_some()),
        ("packing", group.packing.is_some()),
        ("fill", group.fill.is_some()),
        ("lattice", group.lattice.is_some()),
        ("net", group.net.is_some()),
        ("region", group.region.is_some()),
        ("floes", group.floes.is_some()),
        ("frustum", group.frustum.is_some()),
    ]
}

/// Whether all grains are queued.
pub fn waits(group: &Grains) -> bool {
    group.inlet.is_some() && sources(group).iter().all(|(_, present)| !present)
}
