//! Partition of blocks into ranks.

use crate::engine::state::State;
use std::ops::Range;

/// Contiguous ranges of blocks, one per rank.
#[derive(Clone, Debug, Default)]
pub(super) struct Partition {
    /// First block of each rank, and block count.
    pub bounds: Vec<u32>,
}

impl Partition {
    /// Balances bodies plus candidate pairs.
    pub fn of(state: &State, ranks: usize) -> Partition {
        let blocks = state.blocks.iter().zip(state.lists.iter().zip(&state.cross));
        let work = blocks.map(|(block, (lists, cross))| {
            let walls = lists.walls.live.len() + lists.planes.len();
            (block.bodies.len() + lists.pairs.len() + cross.spheres.len() + walls) as f64
        });
        let work: Vec<f64> = work.collect();
        let total: f64 = work.iter().sum();
        let mut bounds = vec![0];
        let (mut sum, mut b) = (0.0, 0);
        for rank in 1..ranks {
            let share = total * rank as f64 / ranks as f64;
            // A block belongs to the rank of its midpoint.
            while b < work.len() && sum + 0.5 * work[b] < share {
                sum += work[b];
                b += 1;
            }
            bounds.push(b as u32);
        }
        bounds.push(work.len() as u32);
        Partition { bounds }
    }

    pub fn of_rank(&self, rank: usize) -> Range<usize> {
        self.bounds[rank] as usize..self.bounds[rank + 1] as usize
    }

    pub fn owner(&self, block: u32) -> usize {
        self.bounds.partition_point(|&first| first <= block) - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn owners_match_block_ranges() {
        let partition = Partition { bounds: vec![0, 0, 3, 3, 5] };
        for (block, rank) in [(0, 1), (1, 1), (2, 1), (3, 3), (4, 3)] {
            assert_eq!(partition.owner(block), rank);
            assert!(partition.of_rank(rank).contains(&(block as usize)));
        }
    }
}
