//! The threads of a run.

use crate::failure::Failure;

/// Most threads per CPU: waiting threads spin, so more of them take the time of those that compute.
const MOST_PER_CPU: usize = 8;
/// Most threads on a machine of a few CPUs.
const MOST_ANYWHERE: usize = 16;

/// Most threads on this machine.
fn most_threads() -> usize {
    let cpus = std::thread::available_parallelism().map_or(1, |n| n.get());
    MOST_ANYWHERE.max(MOST_PER_CPU * cpus)
}

/// Returns the pool that a run works in, with stacks deep enough for recursive elimination.
pub(crate) fn thread_pool(threads: Option<usize>) -> Result<rayon::ThreadPool, Failure> {
    let most = most_threads();
    if let Some(threads) = threads.filter(|n| !(1..=most).contains(n)) {
        return Err(Failure::Input(format!(
            "--threads: found {threads}, expected 1 to {most} on this machine"
        )));
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .stack_size(16 << 20)
        .build()
        .map_err(Failure::thread)
}
