//! Message counters.

use serde::{Deserialize, Serialize};

/// Message type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MessageKind {
    /// Command: one per step and rank.
    Order,
    /// Ghost motion: one per step and receiving rank.
    Ghosts,
    /// Block totals: one per step to the first rank.
    Books,
    /// Displacements: two per neighbour list.
    NearList,
    /// Halo bodies and requested ghosts: per search.
    Search,
    /// State: at the start, re-sorting and download.
    State,
}

const NAMES: [&str; 6] = ["orders", "ghosts", "books", "near lists", "searches", "states"];

/// Messages sent by one or several ranks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MessageCounters {
    /// Messages of each type.
    pub messages: [u64; 6],
    /// Bytes of each type.
    pub bytes: [u64; 6],
    /// Present ghosts.
    pub ghosts: u64,
}

impl MessageCounters {
    pub(super) fn count(&mut self, kind: MessageKind, bytes: usize) {
        self.messages[kind as usize] += 1;
        self.bytes[kind as usize] += bytes as u64;
    }

    pub(super) fn add(&mut self, other: &MessageCounters) {
        for k in 0..NAMES.len() {
            self.messages[k] += other.messages[k];
            self.bytes[k] += other.bytes[k];
        }
        self.ghosts += other.ghosts;
    }

    /// A line per type, per step.
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
