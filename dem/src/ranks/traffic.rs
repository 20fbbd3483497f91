//! What ranks send each other, counted.

use serde::{Deserialize, Serialize};

/// What a message is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// What to do, from the first rank to each other: one a step.
    Order,
    /// Motion of ghosts: one a step to each rank that has any.
    Ghosts,
    /// What the blocks have booked: one a step to the first rank.
    Books,
    /// How far bodies have come: one for each near list to the first rank, and one back.
    NearList,
    /// Bodies near the blocks of another rank, and which of them are its ghosts: for each search.
    Search,
    /// The state, whole or in parts: at the start, for each new order of the bodies and each download.
    State,
}

/// Names of the kinds, in their order.
const NAMES: [&str; 6] = ["orders", "ghosts", "books", "near lists", "searches", "states"];

/// What a rank, or several, have sent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Traffic {
    /// Messages of each kind.
    pub messages: [u64; 6],
    /// Bytes of each kind.
    pub bytes: [u64; 6],
    /// Ghosts that this rank has now.
    pub ghosts: u64,
}

impl Traffic {
    /// Counts a message.
    pub(super) fn count(&mut self, kind: Kind, bytes: usize) {
        self.messages[kind as usize] += 1;
        self.bytes[kind as usize] += bytes as u64;
    }

    /// Adds what another rank has sent.
    pub(super) fn add(&mut self, other: &Traffic) {
        for k in 0..NAMES.len() {
            self.messages[k] += other.messages[k];
            self.bytes[k] += other.bytes[k];
        }
        self.ghosts += other.ghosts;
    }

    /// A line for each kind: messages and bytes a step.
    pub fn lines(&self, steps: u64) -> Vec<String> {
        let each = |n: u64| n as f64 / steps.max(1) as f64;
        let lines = NAMES.iter().zip(self.messages.iter().zip(&self.bytes));
        lines
            .map(|(name, (&messages, &bytes))| {
                format!("{name}: {:.3} messages per step, {:.0} bytes per step", each(messages), each(bytes))
            })
            .collect()
    }
}
