//! The threads of a run.

use crate::failure::Failure;

/// Most threads: more than the largest machines have.
const MOST_THREADS: usize = 1024;

/// The pool that a run works in: as many threads as asked for, with stacks deep enough for recursive elimination.
pub(crate) fn thread_pool(threads: Option<usize>) -> Result<rayon::ThreadPool, Failure> {
    if let Some(threads) = threads.filter(|n| !(1..=MOST_THREADS).contains(n)) {
        return Err(Failure::Input(format!("--threads: found {threads}, expected 1 to {MOST_THREADS}")));
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .stack_size(16 << 20)
        .build()
        .map_err(Failure::thread)
}
