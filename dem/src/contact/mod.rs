//! Contact loops: detection, law, force sums.

pub(crate) mod between;
pub(crate) mod dispatch;
pub(crate) mod ends;
pub(crate) mod gather;
pub(crate) mod group_memory;
pub(crate) mod images;
pub(crate) mod interior;
pub(crate) mod kind;
pub(crate) mod patch_forces;
pub(crate) mod patches;
pub(crate) mod planes;
pub(crate) mod prefetch;
pub(crate) mod single;
pub(crate) mod sphere_pair;
