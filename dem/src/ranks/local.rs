//! Ranks as threads of one process, for tests.

use super::link::{Link, Lost};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, OnceLock};

/// Rank in a thread.
#[derive(Debug)]
pub struct Local {
    rank: usize,
    to: Vec<Sender<Vec<u8>>>,
    from: Vec<Receiver<Vec<u8>>>,
    /// First rank that ended.
    ended: Arc<OnceLock<usize>>,
}

/// Returns `size` connected ranks, one per thread.
pub fn local(size: usize) -> Vec<Local> {
    let ended = Arc::new(OnceLock::new());
    let one = |rank| Local { rank, to: Vec::new(), from: Vec::new(), ended: ended.clone() };
    let mut ranks: Vec<Local> = (0..size).map(one).collect();
    for a in 0..size {
        for b in 0..size {
            let (sender, receiver) = channel();
            ranks[a].to.push(sender);
            ranks[b].from.push(receiver);
        }
    }
    ranks
}

impl Link for Local {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.to.len()
    }

    fn send(&mut self, to: usize, message: &[u8]) -> Result<(), Lost> {
        self.to[to].send(message.to_vec()).map_err(|_| self.gone(to))
    }

    fn receive(&mut self, from: usize, message: &mut Vec<u8>) -> Result<(), Lost> {
        *message = self.from[from].recv().map_err(|_| self.gone(from))?;
        Ok(())
    }
}

impl Local {
    fn gone(&self, rank: usize) -> Lost {
        Lost { rank: *self.ended.get().unwrap_or(&rank), problem: "its thread has ended".into() }
    }
}

impl Drop for Local {
    fn drop(&mut self) {
        self.ended.get_or_init(|| self.rank);
    }
}
