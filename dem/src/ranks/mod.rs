//! One model on several ranks: processes that share no memory and send each other messages, with the bits of one.
//!
//! The blocks of bodies are dealt out in runs, one to each rank (`partition.rs`). A rank searches and moves its own blocks only.
//! Bodies of other blocks that these may touch are its *ghosts*: after each step their owners send where they are and how they
//! move, forward only. A contact between blocks of two ranks is computed by both, from the same numbers in the same order, and
//! each keeps its memory; what such a contact dissipates is booked by the owner of its first block alone. What the blocks book
//! goes to the first rank, which adds it up in the order of the blocks as the engine does. So every bit is the engine's, on any
//! number of ranks.
//!
//! The first rank leads: it has the run, its records and its checkpoints; [`Ranks`] is its back end, and the whole state comes to
//! it with a download. The others [`serve`] it. It also makes the new order of the bodies, every 5,000 steps, from the whole state.
//!
//! A near list that is due takes one message to the first rank and one back, which say whether the candidates reach still. A
//! search takes the bodies near the boxes of the blocks of each other rank, and their requests for those that are near indeed.
//!
//! What is not distributed: every rank has room for the motion of all bodies (100 bytes a sphere) and their constants; lists of
//! contacts, candidates and cells, the larger part, are those of its own blocks. The first rank has the lists of all after a download.

mod books;
mod code;
mod follower;
mod ghosts;
mod halo;
mod leader;
mod link;
mod local;
mod orders;
mod parcel;
mod partition;
mod rank;
mod scope;
mod traffic;

pub use follower::serve;
pub use leader::{Ranks, dismiss};
pub use link::{Link, Lost};
pub use local::{Local, local};
pub use scope::{Unsupported, check};
pub use traffic::{Kind, Traffic};
