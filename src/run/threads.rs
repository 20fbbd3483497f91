//! Thread pool of a run.

use trackbed_io::failure::Failure;

/// Waiting threads spin.
const MOST_PER_CPU: usize = 8;
const MOST_ANYWHERE: usize = 16;

fn most_threads() -> usize {
    let cpus = std::thread::available_parallelism().map_or(1, |n| n.get());
    MOST_ANYWHERE.max(MOST_PER_CPU * cpus)
}

/// With stacks for recursive elimination.
pub fn thread_pool(threads: Option<usize>) -> Result<rayon::ThreadPool, Failure> {
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
