//! What ranks need of whatever carries their messages.

/// Carries messages between the ranks of a run. Those from one rank to another arrive in the order in which they were sent.
pub trait Link: Send {
    /// Number of this rank; the first is 0.
    fn rank(&self) -> usize;

    /// Number of ranks.
    fn size(&self) -> usize;

    /// Sends a message, without waiting until it is received.
    ///
    /// # Errors
    /// The other rank is lost.
    fn send(&mut self, to: usize, message: &[u8]) -> Result<(), Lost>;

    /// Waits for the next message of a rank, which takes the place of what `message` held.
    ///
    /// # Errors
    /// The other rank is lost.
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

/// A rank that does not respond any more.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("rank {rank} lost: {problem}")]
pub struct Lost {
    /// Its number.
    pub rank: usize,
    /// What is known of it.
    pub problem: String,
}

impl Lost {
    /// A rank that sent what cannot be read.
    pub(super) fn garbled(rank: usize) -> Lost {
        Lost { rank, problem: "invalid message".into() }
    }
}
