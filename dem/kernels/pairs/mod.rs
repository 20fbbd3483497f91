//! Storage of contact pairs and history.

pub mod buffers;
pub mod cross;
pub mod groups;
pub mod list;
pub mod merge;
pub mod patch_search;
pub mod patches;
pub mod reach;
pub mod reference;
pub mod wall_history;
