//! Progress of the stages of a run, with an estimate of the time left: a bar on a terminal, lines elsewhere, nothing when asked.

use crate::message;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// How much a command prints beside its results.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verbosity {
    /// Errors alone.
    Quiet,
    /// Remarks, a bar, or a line now and then where no terminal is, and a line for each stage that ends.
    #[default]
    Normal,
    /// A line each second of what a stage does, too.
    Verbose,
}

/// Time between two lines [s by the clock].
const LINES: Duration = Duration::from_secs(10);
/// The same of a verbose command.
const VERBOSE_LINES: Duration = Duration::from_secs(1);

/// Progress of one stage of a run.
pub struct Progress {
    bar: ProgressBar,
    stage: &'static str,
    total: f64,
    begun: Instant,
    /// Seconds that the stage took before the program was started anew.
    before: f64,
    verbosity: Verbosity,
    /// When the next line is due, and the time to the one after it; none where no lines are wanted.
    due: Option<(Instant, Duration)>,
    /// Share that is done, as last reported.
    share: f64,
}

/// Ticks of a bar: enough to move smoothly whatever the unit of the stage is.
const TICKS: u64 = 1000;

/// A bar that leaves some twenty of eighty columns to what follows it, and cuts that.
const TEMPLATE: &str = "{prefix:>12} [{bar:20}] {percent:>3}%  {elapsed} of about {duration}  {wide_msg}";

impl Progress {
    /// Starts the stage `stage`, which ends when the measure reaches `total`.
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
        bar.set_style(style.progress_chars("=> "));
        bar.set_prefix(stage);
        let begun = Instant::now();
        let due = interval.map(|interval| (begun + interval, interval));
        Progress { bar, stage, total, begun, before: 0.0, verbosity, due, share: 0.0 }
    }

    /// The same for a stage that an earlier start of the program brought to `done` in `seconds`.
    #[must_use]
    pub fn resumed(mut self, done: f64, seconds: f64) -> Progress {
        self.before = seconds;
        self.bar.set_elapsed(Duration::try_from_secs_f64(seconds.max(0.0)).unwrap_or_default());
        self.at(done, String::new);
        self
    }

    /// Seconds that the stage has taken so far.
    pub fn seconds(&self) -> f64 {
        self.before + self.begun.elapsed().as_secs_f64()
    }

    /// Reports how far the stage is, in the unit of `total`; `details` is called where a line is due.
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

    /// How far the stage is, in one line.
    fn line(&self, details: &str) -> String {
        let seconds = self.seconds();
        let time = |seconds: f64| {
            HumanDuration(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)).to_string()
        };
        let whole = seconds / self.share;
        let whole = if whole.is_finite() { format!(" of about {}", time(whole)) } else { String::new() };
        let parts = [
            format!("{:3.0} %  {}{whole}", 100.0 * self.share, time(seconds)),
            self.bar.message(),
            details.into(),
        ];
        let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        format!("{:>12}  {}", self.stage, parts.join("  "))
    }

    /// Text behind the bar; on eighty columns some twenty characters of it are seen.
    pub fn message(&self, text: String) {
        self.bar.set_message(text);
    }

    /// Ends the stage with a line that stays, and returns the seconds it took.
    pub fn finish(self, text: &str) -> f64 {
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

    /// A bar fits eighty columns whatever stands behind it, and shows how that begins.
    #[test]
    fn a_bar_fits_eighty_columns() {
        let terminal = InMemoryTerm::new(8, 80);
        let target = ProgressDrawTarget::term_like(Box::new(terminal.clone()));
        let mut progress = Progress::to("running", 2.0, Verbosity::Normal, target, None).resumed(0.5, 3600.0);
        progress.message("cycle 12345: 12.345 mm and much that is cut".into());
        progress.at(1.0, String::new);
        progress.bar.force_draw();
        let shown = terminal.contents();
        assert_eq!(shown.lines().count(), 1, "{shown}");
        assert!(
            shown.chars().count() <= 80 && shown.contains(" 50%") && shown.contains("cycle 12345"),
            "{shown}"
        );
        assert!(shown.starts_with("     running [==========>"), "{shown}");
    }

    /// A line says how far the stage is, what it takes, and what it does.
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
        let mut called = false;
        let mut due = nothing;
        due.at(1.0, || {
            called = true;
            "for a line".into()
        });
        assert!(called);
    }
}
