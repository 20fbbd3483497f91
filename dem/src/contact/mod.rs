//! Contact loops: detection, law, force sums.

pub(crate) mod body_lanes;
pub(crate) mod dispatch;
pub(crate) mod gather;
pub(crate) mod group_history;
pub(crate) mod images;
pub(crate) mod inter_block;
pub(crate) mod intra_block;
pub(crate) mod narrow_phase;
pub(crate) mod patch_forces;
pub(crate) mod planes;
pub(crate) mod prefetch;
pub(crate) mod scalar;
pub(crate) mod sphere_pair;
pub(crate) mod surface_contacts;
