//! Runs of a life: each starts from the end of the one before, all packings at once.
//!
//! ```text
//! DIR/1/built             bed of the first packing
//! DIR/1/traffic-1         first period of traffic
//! DIR/1/tamped-1          after the first tamping
//! DIR/1/push-traffic-1    lateral push of a copy of the bed
//! ```

use super::plan::Plan;
use crate::study;
use std::cell::RefCell;
use std::fs::{self, File};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::Child;
use std::time::Duration;
use trackbed_io::failure::Failure;
use trackbed_io::progress::Progress;
use trackbed_io::{message, system};
use trackbed_run::Interrupt;

const LOOK: Duration = Duration::from_millis(20);

/// Directory and settings of the runs.
pub struct Chain<'a> {
    /// Life.
    pub plan: &'a Plan,
    /// Results directory.
    pub dir: &'a Path,
    /// Threads per run.
    pub threads: usize,
    /// Whether finished runs are kept and interrupted ones resumed.
    pub resume: bool,
    /// Whether existing runs are overwritten.
    pub force: bool,
    /// Print errors only.
    pub quiet: bool,
    /// Stop request.
    pub interrupt: &'a Interrupt,
    /// Steps so far, of all.
    pub progress: RefCell<(Progress, usize)>,
}

/// Run of every packing.
#[derive(Clone, Debug)]
pub struct Step {
    /// Directory name.
    pub name: String,
    /// Directory name of the run before.
    pub from: Option<String>,
    /// Overrides per packing.
    pub sets: Vec<Vec<String>>,
}

impl Chain<'_> {
    /// Results directory of a run.
    pub fn folder(&self, packing: usize, name: &str) -> PathBuf {
        self.dir.join((packing + 1).to_string()).join(name)
    }

    /// Runs one step of all packings.
    ///
    /// # Errors
    /// Failed runs, interrupts, I/O errors.
    pub fn carry_out(&self, step: &Step) -> Result<(), Failure> {
        let mut active: Vec<(usize, Child)> = Vec::new();
        let mut failure = None;
        for packing in 0..step.sets.len() {
            match self.start(step, packing) {
                Ok(child) => active.push((packing, child)),
                Err(e) => failure = failure.or(Some(e)),
            }
        }
        self.progress.borrow_mut().0.message(step.name.clone());
        let mut stopping = false;
        while !active.is_empty() {
            if (self.interrupt.stopped() || failure.is_some()) && !stopping {
                stopping = true;
                active.iter().for_each(|(_, child)| system::interrupt(child));
            }
            let mut k = 0;
            while k < active.len() {
                let Some(status) = active[k].1.try_wait()? else {
                    k += 1;
                    continue;
                };
                let (packing, _) = active.remove(k);
                let (code, reason) = study::verdict(status, &self.log(packing, &step.name));
                if code != 0 && failure.is_none() && !stopping {
                    let folder = self.folder(packing, &step.name);
                    let text = format!("{}: {reason}", folder.display());
                    failure = Some(if code == 2 { Failure::Input(text) } else { Failure::Numerical(text) });
                }
            }
            std::thread::sleep(LOOK);
        }
        if self.interrupt.stopped() {
            let dir = trackbed_run::quoted(self.dir);
            return Err(Failure::Interrupted(format!("interrupted; continue with --resume --out {dir}")));
        }
        match failure {
            Some(failure) => Err(failure),
            None => {
                let (progress, done) = &mut *self.progress.borrow_mut();
                *done += 1;
                progress.at(*done as f64, || step.name.clone());
                if !self.quiet && !std::io::stderr().is_terminal() {
                    message::say(&format!("{}: {} packings done", step.name, step.sets.len()));
                }
                Ok(())
            }
        }
    }

    fn log(&self, packing: usize, name: &str) -> PathBuf {
        self.dir.join((packing + 1).to_string()).join(format!("{name}.log"))
    }

    fn start(&self, step: &Step, packing: usize) -> Result<Child, Failure> {
        let folder = self.folder(packing, &step.name);
        let there = folder.join("summary.json").exists() || folder.join("checkpoint").exists();
        if there && !self.resume && !self.force {
            let expected = "--resume, --force to start from scratch, or another --out";
            return Err(Failure::Input(format!("{}: found a run, expected {expected}", folder.display())));
        }
        let fault = |e: std::io::Error| Failure::Other(format!("{}: {e}", folder.display()));
        fs::create_dir_all(self.dir.join((packing + 1).to_string())).map_err(fault)?;
        let mut command =
            study::command("run", &self.plan.scene, &folder, &step.sets[packing]).map_err(fault)?;
        command.args(["--quiet", "--threads", &self.threads.to_string()]);
        command.arg(if self.resume && there { "--resume" } else { "--force" });
        if let Some(from) = &step.from {
            command.arg("--from").arg(self.folder(packing, from));
        }
        command.stderr(File::create(self.log(packing, &step.name)).map_err(fault)?);
        system::set_apart(&mut command);
        command.spawn().map_err(fault)
    }
}
