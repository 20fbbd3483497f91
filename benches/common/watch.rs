//! Wall and CPU time, thread pools.

use std::time::Instant;

/// Pool of `threads`, never dropped, so that [`Watch`] includes its CPU time.
pub fn pool(threads: usize) -> &'static rayon::ThreadPool {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be started");
    Box::leak(Box::new(pool))
}

/// Wall and CPU seconds. CPU time is reliable on shared machines.
#[derive(Default)]
pub struct Watch {
    pub wall: f64,
    /// All threads; zero except on Linux.
    pub cpu: f64,
}

impl Watch {
    pub fn time<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let (wall, cpu) = (Instant::now(), cpu_seconds());
        let result = work();
        self.wall += wall.elapsed().as_secs_f64();
        self.cpu += cpu_seconds() - cpu;
        result
    }
}

/// CPU seconds of all threads.
fn cpu_seconds() -> f64 {
    let nanoseconds = |task: std::fs::DirEntry| -> Option<f64> {
        let text = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        text.split(' ').next()?.parse().ok()
    };
    let tasks = std::fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    tasks.filter_map(nanoseconds).sum::<f64>() * 1e-9
}
