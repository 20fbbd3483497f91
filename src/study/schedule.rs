//! Carries out the runs of a study, several at a time.

use super::plan::Run;
use super::process::{self, Beginning};
use super::store::{Found, NUMERICAL, Record, Store};
use crate::failure::Failure;
use crate::message;
use crate::progress::{Progress, Verbosity};
use crate::run::Interrupt;
use std::io::IsTerminal;
use std::path::Path;
use std::process::{Child, ExitStatus};
use std::time::{Duration, Instant};

/// Time between two looks at the processes.
const LOOK: Duration = Duration::from_millis(5);
/// Exit code of an interrupted run.
const INTERRUPTED: i32 = 130;

/// A run that is to be carried out.
#[derive(Debug)]
pub struct Task<'a> {
    /// The run.
    pub run: &'a Run,
    /// Hash of its scene.
    pub scene_hash: &'a str,
    /// What is there of it.
    pub found: Found,
}

/// How runs are carried out.
#[derive(Debug)]
pub struct Schedule<'a> {
    /// The scene.
    pub scene: &'a Path,
    /// Where the results go.
    pub store: &'a Store,
    /// Runs at a time.
    pub jobs: usize,
    /// Threads of each.
    pub threads: usize,
    /// Request to stop.
    pub interrupt: &'a Interrupt,
    /// Whether nothing is printed.
    pub quiet: bool,
}

/// A run in progress.
struct Active<'a> {
    run: &'a Run,
    child: Child,
    begun: Instant,
    record: Record,
}

impl Schedule<'_> {
    /// Carries out `tasks`; `first` is called with the first run that is done, and may end the study.
    ///
    /// # Errors
    /// An interrupt, after all runs that were under way have stopped; what the system refuses; what `first` says.
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
        let (mut ended, mut seen) = (0, false);
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
            bar.message(active.iter().map(|a| a.run.label.as_str()).collect::<Vec<_>>().join(" | "));
            std::thread::sleep(LOOK);
        }
        if failure.is_none() {
            bar.finish(&format!("{total} runs"));
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
        // Before it starts: whatever happens now, what is there is known to be unfinished.
        self.store.record(run, &record)?;
        let (threads, log) = (self.threads, self.store.log(run));
        let child = process::start(self.scene, &out, &run.set, threads, beginning, &log)
            .map_err(|e| Failure::Other(format!("{}: the run cannot be started: {e}", out.display())))?;
        Ok(Active { run, child, begun: Instant::now(), record })
    }

    /// Writes what became of a run.
    fn end(&self, a: Active<'_>, status: ExitStatus) -> Result<Record, Failure> {
        let (code, message) = process::verdict(status, &self.store.log(a.run));
        // Others may have left no summary, and the one in the folder is of an earlier attempt.
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

    /// A line for each run where no bar is shown.
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

/// Takes the processes that have ended out of a list.
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
