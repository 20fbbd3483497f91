//! Storage of contact pairs and history.

pub(crate) mod buffers;
pub(crate) mod cross;
pub(crate) mod groups;
pub(crate) mod list;
pub(crate) mod merge;
pub(crate) mod patch_search;
pub(crate) mod patches;
pub(crate) mod reach;
pub(crate) mod reference;
pub(crate) mod wall_history;
