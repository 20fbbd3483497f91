//! Life of a track: traffic in periods with cycle jumps, tampings between them, several packings.
//!
//! A `file` is resolved to a `plan`, run as a `chain` of separate processes; `outcome` reads, `page` writes.

mod chain;
mod file;
mod outcome;
mod page;
mod plan;

use chain::{Chain, Step};
use file::LifeFile;
use outcome::Agreement;
use page::Life;
use plan::Plan;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;
use trackbed_io::progress::{Progress, Verbosity};
use trackbed_io::write::{WriteError, atomic};
use trackbed_run::{Interrupt, Lock, default_folder};

/// Pages in the results directory.
const PAGES: [&str; 5] = ["life.json", "life.csv", "life.md", "life.svg", "resistance.svg"];

/// Options of a life.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Results directory; default `results/<name of the file>`.
    pub out: Option<PathBuf>,
    /// Threads per run; default: cores over packings.
    pub threads: Option<usize>,
    /// Keep finished runs, resume interrupted ones.
    pub resume: bool,
    /// Overwrite existing runs.
    pub force: bool,
    /// Check and list the runs only.
    pub plan: bool,
    /// Print errors only.
    pub quiet: bool,
    /// Stop request.
    pub interrupt: Interrupt,
}

/// Runs a life and returns its table.
///
/// # Errors
/// Input errors, interrupts, failed runs.
pub fn execute(
    file: &Path,
    options: &Options,
    check: impl Fn(&Path, &[String]) -> Result<(), Failure>,
) -> Result<String, Failure> {
    let document = Document::open(file)?;
    let plan = Plan::new(&document, &document.read::<LifeFile>()?)?;
    let of = |what: &str, failure: Failure| match failure.is_input() {
        true => Failure::Input(format!("{}: {what}: {failure}", file.display())),
        false => failure,
    };
    let last = plan.ends.len() - 1;
    check(&plan.scene, &plan.under_traffic(0, last, 1.0)).map_err(|e| of("traffic", e))?;
    if let Some(set) = plan.pushed(0, last) {
        check(&plan.scene, &set).map_err(|e| of("push", e))?;
    }
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = options.threads.unwrap_or_else(|| (cores / plan.packings.len()).max(1));
    if threads == 0 {
        return Err(Failure::Input("--threads: found 0, expected at least 1".into()));
    }
    if options.plan {
        return Ok(plan.listed());
    }
    let dir = options.out.clone().unwrap_or_else(|| default_folder(file, &[]));
    let _lock = Lock::take(&dir)?;
    if options.force {
        clear(&dir)?;
    }
    options.interrupt.end_at_once(false);
    let verbosity = if options.quiet { Verbosity::Quiet } else { Verbosity::Normal };
    let progress = RefCell::new((Progress::start("life", plan.steps() as f64, verbosity), 0));
    let chain = Chain {
        plan: &plan,
        dir: &dir,
        threads,
        resume: options.resume,
        force: options.force,
        quiet: options.quiet,
        interrupt: &options.interrupt,
        progress,
    };
    let life = run(&chain);
    options.interrupt.end_at_once(true);
    let life = life?;
    chain.progress.borrow_mut().0.finish(&format!("{} packings", plan.packings.len()));
    write(&dir.join("life.json"), &format!("{:#}\n", life.json()))?;
    write(&dir.join("life.csv"), &life.csv())?;
    write(&dir.join("life.md"), &life.markdown())?;
    life.settlement_plot().write(&dir.join("life.svg"))?;
    if let Some(plot) = life.resistance_plot() {
        plot.write(&dir.join("resistance.svg"))?;
    }
    Ok(format!("{}results are in {}\n", life.printed(), dir.display()))
}

/// Removes the runs and pages of an earlier life.
fn clear(dir: &Path) -> Result<(), Failure> {
    let fault = |e: std::io::Error| Failure::Other(format!("{}: {e}", dir.display()));
    for packing in 1.. {
        let own = dir.join(packing.to_string());
        if !own.join("built").is_dir() {
            break;
        }
        std::fs::remove_dir_all(own).map_err(fault)?;
    }
    for page in PAGES.iter().map(|name| dir.join(name)).filter(|page| page.is_file()) {
        std::fs::remove_file(page).map_err(fault)?;
    }
    Ok(())
}

fn write(file: &Path, text: &str) -> Result<(), Failure> {
    atomic::write(file, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(file)))?;
    Ok(())
}

fn run<'a>(chain: &Chain<'a>) -> Result<Life<'a>, Failure> {
    let plan = chain.plan;
    let all = 0..plan.packings.len();
    let sets = |of: &dyn Fn(usize) -> Vec<String>| all.clone().map(of).collect::<Vec<_>>();
    let mut life = Life::new(plan);
    let mut before = "built".to_string();
    chain.carry_out(&Step { name: before.clone(), from: None, sets: sets(&|p| plan.at_rest(p, 0)) })?;
    push(chain, &mut life, (&before, 0, 0.0))?;
    for period in 0..plan.ends.len() {
        let mut repetitions = 0;
        let (name, agreement) = loop {
            let name = traffic(period, repetitions);
            let shorter = libm::pow(0.5, f64::from(repetitions));
            let sets = sets(&|p| plan.under_traffic(p, period, shorter));
            chain.carry_out(&Step { name: name.clone(), from: Some(before.clone()), sets })?;
            let read: Result<Vec<_>, _> =
                all.clone().map(|p| outcome::period(chain, p, (period, &name, &before))).collect();
            let read = read?;
            if read.windows(2).any(|pair| pair[0].rows == pair[1].rows) {
                let found = "packings: found beds that settle alike";
                return Err(Failure::Input(format!("{found}, expected seeds that have an effect")));
            }
            let jumped = read.iter().any(|p| p.before_jumps.is_some());
            let difference = if jumped { outcome::difference(&read) } else { 0.0 };
            let agreed = difference <= plan.tolerance;
            if agreed || repetitions == plan.repetitions {
                life.periods.extend(read);
                break (name, Agreement { period: period + 1, difference, agreed, repetitions });
            }
            repetitions += 1;
        };
        if life.periods.iter().any(|p| p.period == period + 1 && p.before_jumps.is_some()) {
            life.agreements.push(agreement);
        }
        push(chain, &mut life, (&name, period, plan.ends[period]))?;
        before = name;
        if period + 1 < plan.ends.len() {
            let (name, earlier) = (format!("tamped-{}", period + 1), before.clone());
            let sets = sets(&|p| plan.at_rest(p, period + 1));
            chain.carry_out(&Step { name: name.clone(), from: Some(before.clone()), sets })?;
            for packing in all.clone() {
                life.tampings.push(outcome::tamped(chain, packing, (period, &earlier))?);
            }
            push(chain, &mut life, (&name, period + 1, plan.ends[period]))?;
            before = name;
        }
    }
    life.laws = outcome::laws_alone(plan, &life.first_periods());
    Ok(life)
}

/// Directory of a period; with shorter jumps, of its repetition.
fn traffic(period: usize, repetitions: u32) -> String {
    let repeated = if repetitions > 0 { format!("-repeated-{repetitions}") } else { String::new() };
    format!("traffic-{}{repeated}", period + 1)
}

fn push(
    chain: &Chain<'_>,
    life: &mut Life<'_>,
    (after, tampings, traffic): (&str, usize, f64),
) -> Result<(), Failure> {
    let plan = chain.plan;
    let sets: Option<Vec<_>> = (0..plan.packings.len()).map(|p| plan.pushed(p, tampings)).collect();
    let Some(sets) = sets else { return Ok(()) };
    chain.carry_out(&Step { name: format!("push-{after}"), from: Some(after.into()), sets })?;
    for packing in 0..plan.packings.len() {
        life.resistances.push(outcome::pushed(chain, packing, after, traffic)?);
    }
    Ok(())
}
