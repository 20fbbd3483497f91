//! Storage of pairs, written once for every kind of pair: lists in groups of lanes with the memory of contacts, merging
//! with candidates, slots for forces across blocks.

pub(crate) mod buffers;
pub(crate) mod cross;
pub(crate) mod groups;
pub(crate) mod list;
pub(crate) mod meets;
pub(crate) mod merge;
pub(crate) mod patch_search;
pub(crate) mod patches;
pub(crate) mod reach;
pub(crate) mod reference;
