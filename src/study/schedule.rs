//! Runs the tasks of a study concurrently.

use super::plan::Run;
use super::process::{self, Beginning};
use super::store::{Found, NUMERICAL, Record, Store};
use std::io::IsTerminal;
use std::path::Path;
use std::process::{Child, ExitStatus};
use std::time::{Duration, Instant};
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_io::progress::{Progress, Verbosity};
use trackbed_run::Interrupt;

const LOOK: Duration = Duration::from_millis(5);
const INTERRUPTED: i32 = 130;

/// Pending run.
#[derive(Debug)]
pub struct Task<'a> {
    /// Run.
    pub run: &'a Run,
    /// Scene hash.
    pub scene_hash: &'a str,
    /// Existing results.
    pub found: Found,
}

/// Run settings.
#[derive(Debug)]
pub struct Schedule<'a> {
    /// Scene.
    pub scene: &'a Path,
    /// Store.
    pub store: &'a Store,
    /// Concurrent runs.
    pub jobs: usize,
    /// Threads per run.
    pub threads: usize,
    /// Stop request.
    pub interrupt: &'a Interrupt,
    /// Suppresses output.
    pub quiet: bool,
}

struct Active<'a> {
    run: &'a Run,
    child: Child,
    begun: Instant,
    record: Record,
}

impl Schedule<'_> {
    /// Runs `tasks`; `first` gets the first completed run and may stop the study.
    ///
    /// # Errors
    /// Interrupts; I/O errors; errors of `first`.
    pub fn carry_out(
        &self,
        tasks: Vec<Task<'_>>,
        first: impl Fn(&Run) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let total = tasks.len();
        if total == 0 {
            return Ok(());
        }
        let mut waiting = tasks.into_iter();
        let mut active: Vec<Active<'_>> = Vec::new();
        let (mut ended, mut failed, mut seen) = (0, 0, false);
        let mut failure = None;
        let verbosity = if self.quiet { Verbosity::Quiet } else { Verbosity::Normal };
        let mut bar = Progress::start("study", total as f64, verbosity);
        loop {
            if failure.is_none() && self.interrupt.stopped() {
                failure = Some(Failure::Interrupted(String::new()));
                active.iter().for_each(|a| process::interrupt(&a.child));
            }
            while failure.is_none() && active.len() < self.jobs {
                let Some(task) = waiting.next() else { break };
                match self.start(task) {
                    Ok(started) => active.push(started),
                    Err(e) => failure = Some(e),
                }
                if failure.is_some() {
                    active.iter().for_each(|a| process::interrupt(&a.child));
                }
            }
            if active.is_empty() {
                break;
            }
            for (a, status) in finished(&mut active)? {
                let run = a.run;
                let record = self.end(a, status)?;
                ended += 1;
                failed += usize::from(!matches!(record.exit_code, Some(0 | INTERRUPTED)));
                self.report(&record, ended, total);
                if record.exit_code == Some(0) && !seen && failure.is_none() {
                    seen = true;
                    failure = first(run).err();
                    if failure.is_some() {
                        active.iter().for_each(|a| process::interrupt(&a.child));
                    }
                }
            }
            bar.at(ended as f64, String::new);
            let failures = (failed > 0).then(|| format!("{failed} failed"));
            let labels = active.iter().map(|a| a.run.label.clone());
            bar.message(failures.into_iter().chain(labels).collect::<Vec<_>>().join(" | "));
            std::thread::sleep(LOOK);
        }
        if failure.is_none() {
            let failures = if failed > 0 { format!(", {failed} failed") } else { String::new() };
            bar.finish(&format!("{total} runs{failures}"));
        }
        failure.map_or(Ok(()), Err)
    }

    fn start<'r>(&self, task: Task<'r>) -> Result<Active<'r>, Failure> {
        let (run, out) = (task.run, self.store.results(task.run));
        let (before, beginning) = match task.found {
            Found::Unfinished(record, true) => (record, Beginning::Resumed),
            _ => (Record::default(), Beginning::Anew),
        };
        let record = Record {
            label: run.label.clone(),
            set: run.set.clone(),
            scene_hash: task.scene_hash.into(),
            exit_code: None,
            message: String::new(),
            ..before
        };
        // A crash then leaves a known unfinished run.
        self.store.record(run, &record)?;
        let (threads, log) = (self.threads, self.store.log(run));
        let child = process::start(self.scene, &out, &run.set, threads, beginning, &log)
            .map_err(|e| Failure::Other(format!("{}: the run cannot be started: {e}", out.display())))?;
        Ok(Active { run, child, begun: Instant::now(), record })
    }

    fn end(&self, a: Active<'_>, status: ExitStatus) -> Result<Record, Failure> {
        let (code, message) = process::verdict(status, &self.store.log(a.run));
        // Else of an earlier attempt.
        let summarized = [0, NUMERICAL, INTERRUPTED].contains(&code);
        let cpu = if summarized { self.store.cpu_seconds(a.run) } else { None };
        let sum = match (a.record.cpu_seconds, cpu) {
            (Some(before), Some(now)) => Some(before + now),
            (before, now) => before.or(now),
        };
        let wall_seconds = a.record.wall_seconds + a.begun.elapsed().as_secs_f64();
        let record = Record { exit_code: Some(code), message, cpu_seconds: sum, wall_seconds, ..a.record };
        self.store.record(a.run, &record)?;
        Ok(record)
    }

    fn report(&self, record: &Record, ended: usize, total: usize) {
        if self.quiet || std::io::stderr().is_terminal() {
            return;
        }
        let end = match record.exit_code {
            Some(0) => "done".to_string(),
            Some(INTERRUPTED) => "interrupted".to_string(),
            code => format!("failed, exit code {}: {}", code.unwrap_or(1), record.message),
        };
        let cpu = record.cpu_seconds.map_or(String::new(), |s| format!(", CPU time {s:.1} s"));
        message::say(&format!("{ended:>5}/{total}  {}: {end}{cpu}", record.label));
    }
}

fn finished<'r>(active: &mut Vec<Active<'r>>) -> Result<Vec<(Active<'r>, ExitStatus)>, Failure> {
    let mut ended = Vec::new();
    let mut k = 0;
    while k < active.len() {
        match active[k].child.try_wait()? {
            Some(status) => ended.push((active.remove(k), status)),
            None => k += 1,
        }
    }
    Ok(ended)
}
