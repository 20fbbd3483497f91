//! Checkpoints at wall-time intervals and on interrupts.

use super::checkpoint::{Body, Moment, Slots};
use std::cell::{Cell, RefCell};
use std::io;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_io::system;

const WATCH: Duration = Duration::from_millis(50);

/// Request to stop after the current step.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    stop: Arc<AtomicBool>,
    keeps: Arc<AtomicBool>,
    seen: Arc<AtomicBool>,
    acknowledged: Arc<AtomicBool>,
    steps: Option<u64>,
    trace: Option<Trace>,
}

/// About 20 ms apart.
pub type Trace = Arc<Mutex<Vec<(Instant, Moment)>>>;

const TRACE: Duration = Duration::from_millis(20);

impl Interrupt {
    /// Creates a request raised by Ctrl-C (SIGINT), SIGTERM or, unless ignored, SIGHUP, and acknowledged with
    /// `after`. A second signal, or the first if nothing can be saved, exits with code 130.
    ///
    /// # Errors
    /// Handlers or thread unavailable.
    pub fn on_signals(after: &'static str) -> Result<Interrupt, Failure> {
        use signal_hook::flag;
        let interrupt = Interrupt::default();
        let again = Arc::new(AtomicBool::new(false));
        for signal in system::stop_signals() {
            // Order matters: the first signal finds `again` unset, the second set.
            flag::register_conditional_shutdown(signal, 130, again.clone())?;
            flag::register(signal, again.clone())?;
            flag::register(signal, interrupt.stop.clone())?;
        }
        let watched = interrupt.clone();
        let builder = std::thread::Builder::new().name("signals".into());
        builder.spawn(move || watched.watch(after)).map_err(Failure::thread)?;
        Ok(interrupt)
    }

    fn watch(&self, after: &str) {
        while !self.stopped() {
            std::thread::sleep(WATCH);
        }
        if self.acknowledged.swap(true, Ordering::Relaxed) {
            return;
        }
        if self.keeps.load(Ordering::Relaxed) || self.seen.load(Ordering::Relaxed) {
            message::say(&format!("stopping after {after}; press Ctrl-C again to abort"));
        } else {
            message::say("interrupted: nothing to save");
            signal_hook::low_level::exit(130);
        }
    }

    /// Whether a signal exits at once or waits for a save.
    pub fn end_at_once(&self, at_once: bool) {
        // Pending requests belong to the ending stage.
        self.seen.fetch_or(self.stopped(), Ordering::Relaxed);
        self.keeps.store(!at_once, Ordering::Relaxed);
    }

    /// Whether the run should stop.
    pub fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Creates a request that records the time of each checkpoint.
    pub fn traced() -> (Interrupt, Trace) {
        let trace = Trace::default();
        (Interrupt { trace: Some(trace.clone()), ..Interrupt::default() }, trace)
    }

    /// Raises the request.
    pub fn request(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Creates a request raised after `steps` steps of all stages.
    pub fn after(steps: u64) -> Interrupt {
        Interrupt { steps: Some(steps), ..Interrupt::default() }
    }
}

/// Target time between clock checks, from half to twice.
const LOOK: Duration = Duration::from_millis(2);
const STRIDE: u32 = 1024;

/// Writes checkpoints when due.
pub struct CheckpointStore {
    slots: RefCell<Slots>,
    interrupt: Interrupt,
    interval: Duration,
    written: Cell<Instant>,
    looked: Cell<Instant>,
    stride: Cell<u32>,
    left: Cell<u32>,
    steps: Cell<u64>,
    command: String,
}

impl CheckpointStore {
    /// Creates a store; `command` resumes the run.
    pub fn new(slots: Slots, interrupt: Interrupt, interval: Duration, command: String) -> CheckpointStore {
        let now = Cell::new(Instant::now());
        CheckpointStore {
            slots: RefCell::new(slots),
            interrupt,
            interval,
            written: now.clone(),
            looked: now,
            stride: Cell::new(1),
            left: Cell::new(1),
            steps: Cell::new(0),
            command,
        }
    }

    /// Returns the stop request.
    pub fn interrupt(&self) -> &Interrupt {
        &self.interrupt
    }

    /// Begins a stage that calls [`CheckpointStore::step`] after each step.
    pub fn begin(&self) {
        self.interrupt.end_at_once(false);
    }

    /// Ends the stage: signals then exit at once.
    pub fn end(&self) {
        self.interrupt.end_at_once(true);
    }

    /// Writes a due checkpoint of `moment`, filled by `fill`.
    ///
    /// # Errors
    /// [`Failure::Interrupted`] after a requested checkpoint; I/O errors.
    #[inline]
    pub fn step(
        &self,
        moment: impl FnOnce() -> Moment,
        fill: impl FnOnce(&mut Body<'_>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        if self.stopped() {
            // Printed as one line.
            self.interrupt.acknowledged.store(true, Ordering::Relaxed);
            let moment = moment();
            let place =
                format!("stage \"{}\", step {}, t = {:.6e} s", moment.stage, moment.step, moment.time);
            self.save(moment, fill)?;
            return Err(Failure::Interrupted(format!("interrupted: {place}; resume with: {}", self.command)));
        }
        let due = self.due();
        // Traced runs are discarded.
        if self.interrupt.trace.is_some() {
            self.follow(moment);
            return Ok(());
        }
        if due { self.save(moment(), fill) } else { Ok(()) }
    }

    /// Handles a step of a stage without checkpoints; `time`: simulated [s].
    ///
    /// # Errors
    /// [`Failure::Interrupted`] on request.
    #[inline]
    pub fn check(&self, stage: &str, time: f64) -> Result<(), Failure> {
        if !self.stopped() {
            if self.interrupt.trace.is_some() {
                self.due();
                self.follow(|| Moment { stage: stage.into(), step: 0, time });
            }
            return Ok(());
        }
        self.interrupt.acknowledged.store(true, Ordering::Relaxed);
        let again = "the stage restarts from its beginning";
        Err(Failure::Interrupted(format!(
            "interrupted: stage \"{stage}\"; {again}; resume with: {}",
            self.command
        )))
    }

    fn follow(&self, moment: impl FnOnce() -> Moment) {
        let Some(trace) = &self.interrupt.trace else { return };
        let mut trace = trace.lock().unwrap_or_else(PoisonError::into_inner);
        if trace.last().is_none_or(|(then, _)| self.looked.get() - *then > TRACE) {
            trace.push((self.looked.get(), moment()));
        }
    }

    #[inline]
    fn stopped(&self) -> bool {
        self.steps.set(self.steps.get() + 1);
        self.interrupt.stop.load(Ordering::Relaxed)
            || self.interrupt.steps.is_some_and(|steps| self.steps.get() >= steps)
    }

    /// Writes a checkpoint.
    ///
    /// # Errors
    /// I/O errors.
    pub fn save(
        &self,
        moment: Moment,
        fill: impl FnOnce(&mut Body<'_>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let done = self.slots.borrow_mut().save(moment, fill);
        self.written.set(Instant::now());
        done
    }

    /// Writes a state file.
    ///
    /// # Errors
    /// I/O errors.
    pub fn save_file(
        &self,
        file: &Path,
        moment: Moment,
        fill: impl FnOnce(&mut Body<'_>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        self.slots.borrow().save_file(file, moment, fill)
    }

    /// Removes all checkpoints.
    ///
    /// # Errors
    /// I/O errors.
    pub fn clear(&self) -> Result<(), Failure> {
        self.slots.borrow_mut().clear()
    }

    /// Removes checkpoints of another run.
    ///
    /// # Errors
    /// I/O errors.
    pub fn clear_others(&self) -> Result<(), Failure> {
        self.slots.borrow_mut().clear_others()
    }

    /// Describes the last checkpoint, if any.
    pub fn kept(&self) -> Option<String> {
        let slots = self.slots.borrow();
        slots.has_one().then(|| slots.dir().display().to_string())
    }

    /// Reads the clock only occasionally.
    fn due(&self) -> bool {
        self.left.set(self.left.get() - 1);
        if self.left.get() > 0 {
            return false;
        }
        let now = Instant::now();
        let passed = now - self.looked.get();
        let stride = self.stride.get();
        self.stride.set(match passed {
            short if short < LOOK / 2 => (2 * stride).min(STRIDE),
            long if long > 2 * LOOK => (stride / 2).max(1),
            _ => stride,
        });
        self.left.set(self.stride.get());
        self.looked.set(now);
        now - self.written.get() >= self.interval
    }
}
