//! Distributed memory: one model on several ranks, bitwise identical to a single process.
//!
//! Blocks are partitioned into contiguous ranges (`partition.rs`). Bodies in contact range of other ranks are
//! *ghosts*, whose motion is sent after each step. Both ranks compute a shared contact; the owner of its
//! first block records the dissipation. The first rank ([`Ranks`]) sums block totals in order and re-sorts
//! the bodies every 5,000 steps; the others [`serve`].
//!
//! Not distributed: motion (100 B per sphere) and constants of all bodies.

mod block_totals;
mod codec;
mod commands;
mod follower;
mod ghosts;
mod halo;
mod leader;
mod link;
mod local;
mod message_counters;
mod partition;
mod rank;
mod state_message;
mod supported;

pub use follower::serve;
pub use leader::{Ranks, dismiss};
pub use link::{Link, Lost};
pub use local::{Local, local};
pub use message_counters::{MessageCounters, MessageKind};
pub use supported::{Unsupported, check};
