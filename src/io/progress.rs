//! Stage progress: a bar on terminals, else lines.

use crate::message;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Amount of output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verbosity {
    /// Errors only.
    Quiet,
    /// Warnings, a bar or occasional lines, completed stages.
    #[default]
    Normal,
    /// Additionally a progress line per second.
    Verbose,
}

/// Wall time between lines.
const LINES: Duration = Duration::from_secs(10);
const VERBOSE_LINES: Duration = Duration::from_secs(1);

/// Progress of a stage.
pub struct Progress {
    bar: ProgressBar,
    stage: &'static str,
    total: f64,
    begun: Instant,
    /// Seconds before resuming.
    before: f64,
    verbosity: Verbosity,
    /// None without lines.
    due: Option<(Instant, Duration)>,
    share: f64,
}

const TICKS: u64 = 1000;

/// Leaves about twenty of eighty columns for the message.
const TEMPLATE: &str = "{prefix:>12} [{bar:20}] {percent:>3}%  {elapsed}{total}  {wide_msg}";

/// Fraction from which the total time is shown: first steps may be a tenth as long as later ones.
const KNOWN: f64 = 0.03;

fn show_total(state: &ProgressState, out: &mut dyn Write) {
    if f64::from(state.fraction()) >= KNOWN {
        // A full terminal line is no error.
        let _ = write!(out, " of about {:#}", HumanDuration(state.duration()));
    }
}

impl Progress {
    /// Starts a stage that ends at `total`.
    pub fn start(stage: &'static str, total: f64, verbosity: Verbosity) -> Progress {
        let terminal = std::io::stderr().is_terminal();
        let target = match verbosity {
            Verbosity::Normal if terminal => ProgressDrawTarget::stderr_with_hz(5),
            _ => ProgressDrawTarget::hidden(),
        };
        let interval = match verbosity {
            Verbosity::Normal if !terminal => Some(LINES),
            Verbosity::Verbose => Some(VERBOSE_LINES),
            _ => None,
        };
        Progress::to(stage, total, verbosity, target, interval)
    }

    fn to(
        stage: &'static str,
        total: f64,
        verbosity: Verbosity,
        target: ProgressDrawTarget,
        interval: Option<Duration>,
    ) -> Progress {
        let bar = ProgressBar::with_draw_target(Some(TICKS), target);
        let style = ProgressStyle::with_template(TEMPLATE).expect("the template is a constant");
        bar.set_style(style.with_key("total", show_total).progress_chars("=> "));
        bar.set_prefix(stage);
        let begun = Instant::now();
        let due = interval.map(|interval| (begun + interval, interval));
        Progress { bar, stage, total, begun, before: 0.0, verbosity, due, share: 0.0 }
    }

    /// Resumes a stage at `done` after `seconds`.
    #[must_use]
    pub fn resumed(mut self, done: f64, seconds: f64) -> Progress {
        self.before = seconds;
        self.bar.set_elapsed(Duration::try_from_secs_f64(seconds.max(0.0)).unwrap_or_default());
        self.at(done, String::new);
        self
    }

    /// Returns the stage time [s].
    pub fn seconds(&self) -> f64 {
        self.before + self.begun.elapsed().as_secs_f64()
    }

    /// Reports progress in units of `total`; `details` is called lazily.
    pub fn at(&mut self, done: f64, details: impl FnOnce() -> String) {
        self.share = (done / self.total).clamp(0.0, 1.0);
        self.bar.set_position((self.share * TICKS as f64) as u64);
        let Some((due, interval)) = self.due else { return };
        let now = Instant::now();
        if now >= due {
            self.due = Some((now + interval, interval));
            message::say(&self.line(&details()));
        }
    }

    fn line(&self, details: &str) -> String {
        let seconds = self.seconds();
        let time = |seconds: f64| {
            HumanDuration(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)).to_string()
        };
        let whole = seconds / self.share;
        let whole = if self.share >= KNOWN { format!(" of about {}", time(whole)) } else { String::new() };
        let parts = [
            format!("{:3.0} %  {}{whole}", 100.0 * self.share, time(seconds)),
            self.bar.message(),
            details.into(),
        ];
        let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        format!("{:>12}  {}", self.stage, parts.join("  "))
    }

    /// Sets the message after the bar.
    pub fn message(&self, text: String) {
        self.bar.set_message(text);
    }

    /// Ends the stage with a permanent line; returns its seconds.
    pub fn finish(&self, text: &str) -> f64 {
        let seconds = self.seconds();
        self.bar.finish_and_clear();
        if self.verbosity > Verbosity::Quiet {
            message::say(&format!("{:>12}  {text} ({seconds:.1} s)", self.stage));
        }
        seconds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use indicatif::InMemoryTerm;

    #[test]
    fn a_bar_fits_eighty_columns() {
        let terminal = InMemoryTerm::new(8, 80);
        let target = ProgressDrawTarget::term_like(Box::new(terminal.clone()));
        let mut progress = Progress::to("running", 2.0, Verbosity::Normal, target, None).resumed(0.5, 3600.0);
        progress.message("cycle 12345: 12.345 mm and much that is cut".into());
        progress.at(1.0, String::new);
        progress.bar.force_draw();
        let shown = terminal.contents();
        assert!(shown.contains(" of about "), "{shown}");
        assert_eq!(shown.lines().count(), 1, "{shown}");
        assert!(
            shown.chars().count() <= 80 && shown.contains(" 50%") && shown.contains("cycle 12345"),
            "{shown}"
        );
        assert!(shown.starts_with("     running [==========>"), "{shown}");
    }

    #[test]
    fn lines_where_no_terminal_is() {
        let hidden = ProgressDrawTarget::hidden;
        let mut progress =
            Progress::to("settling", 10.0, Verbosity::Normal, hidden(), None).resumed(0.0, 100.0);
        progress.message("rms 2e-3 m/s".into());
        progress.at(2.5, || unreachable!("no line is due"));
        let line = progress.line("12 contacts");
        assert_eq!(line, "    settling   25 %  2 minutes of about 7 minutes  rms 2e-3 m/s  12 contacts");
        let nothing = Progress::to("settling", 10.0, Verbosity::Normal, hidden(), Some(Duration::ZERO));
        assert!(nothing.line("").starts_with("    settling    0 %  0 seconds"), "{}", nothing.line(""));
        let mut early = Progress::to("run", 10.0, Verbosity::Normal, hidden(), None).resumed(0.2, 14.0);
        assert_eq!(early.line("").trim_start(), "run    2 %  14 seconds");
        early.at(0.4, String::new);
        assert!(early.line("").contains("4 %  14 seconds of about 6 minutes"), "{}", early.line(""));
        let mut called = false;
        let mut due = nothing;
        due.at(1.0, || {
            called = true;
            "for a line".into()
        });
        assert!(called);
    }
}
