//! `trackbed study`: parameter studies with errors and costs.

use super::{check, output};
use crate::cli::StudyArgs;
use crate::study;
use std::path::Path;
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_post::preview::Source;
use trackbed_run::Interrupt;

/// Runs a study and prints its table, or scores predictions.
///
/// # Errors
/// Input and I/O errors, interrupts, a failed reference.
pub fn study(args: StudyArgs) -> Result<(), Failure> {
    let Some(file) = args.study else {
        let [predictions, measured] = args.score.as_slice() else { unreachable!("two files") };
        return output::print(&study::scored(predictions, measured, args.given.as_deref())?);
    };
    let quiet = args.quiet;
    let options = study::Options {
        out: args.out,
        threads: args.threads,
        jobs: args.jobs,
        part: args.task.as_deref().map(part).transpose()?,
        merge: args.merge,
        resume: args.resume,
        force: args.force,
        quiet,
        interrupt: Interrupt::on_signals("the active runs have written checkpoints")?,
    };
    let check = |scene: &Path, set: &[String]| check::check(&Source::new(scene, set), None, false).map(drop);
    let study::Finished { text, failure } = if args.trade {
        let (set, seeds, tolerance) = (args.set.as_slice(), args.seeds, args.tolerance);
        study::trade(&study::Request { scene: &file, set, seeds, tolerance, quiet }, &options, &check)?
    } else {
        study::execute(&file, &options, &check)?
    };
    // Tables are saved, so output may fail.
    if !quiet && let Err(failure) = output::print(&text) {
        message::note(&format!("standard output: {failure}"));
    }
    failure.map_or(Ok(()), Err)
}

fn part(text: &str) -> Result<(usize, usize), Failure> {
    let numbers = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    match numbers {
        Some((k, n)) if (1..=n).contains(&k) => Ok((k, n)),
        _ => {
            Err(Failure::Input(format!("--task: found {text}, expected k/N with k from 1 to N, such as 3/8")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::part;

    #[test]
    fn parts_are_counted_from_one() {
        assert_eq!(part("3/8").unwrap(), (3, 8));
        assert_eq!(part("1/1").unwrap(), (1, 1));
        for bad in ["0/3", "4/3", "3", "a/b", "1/0", "-1/3", ""] {
            let error = part(bad).unwrap_err().to_string();
            assert_eq!(error, format!("--task: found {bad}, expected k/N with k from 1 to N, such as 3/8"));
        }
    }
}
