//! The loops over contacts: detection, the law, and the sums of forces on bodies, in lanes.

pub(crate) mod coming;
pub(crate) mod groups;
pub(crate) mod hits;
pub(crate) mod pass;
pub(crate) mod passes;
pub(crate) mod patches;
pub(crate) mod planes;
