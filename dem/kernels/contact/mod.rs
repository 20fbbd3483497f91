//! Contact loops: detection, law, force sums.

pub mod body_lanes;
pub mod dispatch;
pub mod gather;
pub mod group_history;
pub mod images;
pub mod inter_block;
pub mod intra_block;
pub mod narrow_phase;
pub mod patch_forces;
pub mod planes;
pub mod prefetch;
pub mod scalar;
pub mod sphere_pair;
pub mod surface_contacts;
