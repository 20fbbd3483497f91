//! Message transport.

/// Message transport between ranks, in order for each pair.
pub trait Link: Send {
    /// Rank index; the first is 0.
    fn rank(&self) -> usize;

    /// Number of ranks.
    fn size(&self) -> usize;

    /// Sends a message without blocking.
    ///
    /// # Errors
    /// [`Lost`] if the other rank is lost.
    fn send(&mut self, to: usize, message: &[u8]) -> Result<(), Lost>;

    /// Receives the next message of a rank, blocking.
    ///
    /// # Errors
    /// [`Lost`] if the other rank is lost.
    fn receive(&mut self, from: usize, message: &mut Vec<u8>) -> Result<(), Lost>;
}

impl Link for Box<dyn Link> {
    fn rank(&self) -> usize {
        (**self).rank()
    }

    fn size(&self) -> usize {
        (**self).size()
    }

    fn send(&mut self, to: usize, message: &[u8]) -> Result<(), Lost> {
        (**self).send(to, message)
    }

    fn receive(&mut self, from: usize, message: &mut Vec<u8>) -> Result<(), Lost> {
        (**self).receive(from, message)
    }
}

/// Unresponsive rank.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("rank {rank} lost: {problem}")]
pub struct Lost {
    /// Rank index.
    pub rank: usize,
    /// Cause.
    pub problem: String,
}

impl Lost {
    /// Error for a malformed message.
    pub(super) fn garbled(rank: usize) -> Lost {
        Lost { rank, problem: "invalid message".into() }
    }
}
