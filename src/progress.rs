//! Progress bars with an estimate of the time left; silent when asked or when the output is not a terminal.

use crate::message;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Progress of one stage of a run.
pub struct Progress {
    bar: ProgressBar,
    stage: &'static str,
    total: f64,
    begun: Instant,
    /// Seconds that the stage took before the program was started anew.
    before: f64,
    quiet: bool,
}

/// Ticks of a bar: enough to move smoothly whatever the unit of the stage is.
const TICKS: u64 = 1000;

impl Progress {
    /// Starts the stage `stage`, which ends when the measure reaches `total`.
    pub fn start(stage: &'static str, total: f64, quiet: bool) -> Progress {
        let target = if quiet || !std::io::stderr().is_terminal() {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr_with_hz(5)
        };
        let bar = ProgressBar::with_draw_target(Some(TICKS), target);
        let style = ProgressStyle::with_template(
            "{prefix:>12} [{bar:40}] {percent:>3}%  {elapsed} of about {duration}  {msg}",
        )
        .expect("the template is a constant")
        .progress_chars("=> ");
        bar.set_style(style);
        bar.set_prefix(stage);
        Progress { bar, stage, total, begun: Instant::now(), before: 0.0, quiet }
    }

    /// The same for a stage that an earlier start of the program brought to `done` in `seconds`.
    #[must_use]
    pub fn resumed(mut self, done: f64, seconds: f64) -> Progress {
        self.before = seconds;
        self.bar.set_elapsed(Duration::try_from_secs_f64(seconds.max(0.0)).unwrap_or_default());
        self.at(done);
        self
    }

    /// Seconds that the stage has taken so far.
    pub fn seconds(&self) -> f64 {
        self.before + self.begun.elapsed().as_secs_f64()
    }

    /// Reports how far the stage is, in the unit of `total`.
    pub fn at(&self, done: f64) {
        self.bar.set_position(((done / self.total).clamp(0.0, 1.0) * TICKS as f64) as u64);
    }

    /// Text behind the bar.
    pub fn message(&self, text: String) {
        self.bar.set_message(text);
    }

    /// Ends the stage with a line that stays, and returns the seconds it took.
    pub fn finish(self, text: &str) -> f64 {
        let seconds = self.seconds();
        self.bar.finish_and_clear();
        if !self.quiet {
            message::say(&format!("{:>12}  {text} ({seconds:.1} s)", self.stage));
        }
        seconds
    }
}
