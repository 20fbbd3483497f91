//! Rebuild of a neighbour list from candidates, with contact history.

use super::groups::Groups;
use crate::law::History;

#[derive(Debug, Default)]
pub struct Merging {
    pub two: Merge<2>,
    pub three: Merge<3>,
}

#[derive(Debug, Default)]
pub struct Merge<const N: usize> {
    keys: Vec<[u32; N]>,
    fresh: Groups<N>,
}

impl<const N: usize> Merge<N> {
    /// Keeps the close candidates (ascending); history is kept.
    #[inline]
    pub fn merge(
        &mut self,
        list: &mut Groups<N>,
        candidates: impl ExactSizeIterator<Item = [u32; N]>,
        close: impl Fn(&[u32; N]) -> bool,
    ) {
        let Merge { keys, fresh } = self;
        // Branch-free: closeness is unpredictable.
        keys.clear();
        keys.resize(candidates.len(), [0; N]);
        let mut count = 0;
        for key in candidates {
            keys[count] = key;
            count += usize::from(close(&key));
        }
        keys.truncate(count);
        let old = list.len();
        if count == old && keys.iter().enumerate().all(|(k, key)| list.name(k) == *key) {
            return;
        }
        fresh.clear();
        fresh.turning = list.turning;
        let mut k = 0;
        for key in keys {
            while k < old && list.name(k) < *key {
                k += 1;
            }
            let known = k < old && list.name(k) == *key;
            fresh.push(*key, &if known { list.history(k) } else { History::NONE });
        }
        list.copy_from(fresh);
    }
}
