//! Checkpoints of a run, written when they are due: after an interval of the clock, and when the user interrupts the run.

use super::checkpoint::{Body, Moment, Slots};
use crate::failure::Failure;
use crate::message;
use std::cell::{Cell, RefCell};
use std::io;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time between two looks at a request from outside.
const WATCH: Duration = Duration::from_millis(50);

/// A request to stop a run at the end of its present step.
#[derive(Clone, Debug, Default)]
pub struct Interrupt {
    stop: Arc<AtomicBool>,
    /// Whether a stage is under way that looks at the request and keeps where it is.
    keeps: Arc<AtomicBool>,
    /// Whether a stage has seen the request.
    seen: Arc<AtomicBool>,
    /// Whether it is acknowledged, or need not be any more.
    acknowledged: Arc<AtomicBool>,
    /// Steps after which the run stops by itself.
    steps: Option<u64>,
    /// Where the run was when, if that is wanted.
    trace: Option<Trace>,
}

/// Moments of a run and when it was there by the clock, some 20 ms apart.
pub(crate) type Trace = Arc<Mutex<Vec<(Instant, Moment)>>>;

/// Time between two moments of a trace.
const TRACE: Duration = Duration::from_millis(20);

impl Interrupt {
    /// A request that comes with Ctrl-C (SIGINT), SIGTERM, or SIGHUP, of a terminal that is closed, unless it is ignored as
    /// under `nohup`. It is acknowledged at once on standard error, with what the program stops after. A second signal ends the
    /// program at once, with exit code 130, as the first does where nothing could be kept.
    ///
    /// # Errors
    /// The system refuses the handlers, or has no thread.
    pub fn on_signals(after: &'static str) -> Result<Interrupt, Failure> {
        use signal_hook::consts::{SIGINT, SIGTERM};
        use signal_hook::flag;
        let mut signals = vec![SIGINT, SIGTERM];
        #[cfg(unix)]
        {
            use signal_hook::consts::SIGHUP;
            if !is_ignored(SIGHUP) {
                signals.push(SIGHUP);
            }
        }
        let interrupt = Interrupt::default();
        let again = Arc::new(AtomicBool::new(false));
        for signal in signals {
            // In this order: the first signal finds `again` unset, the second finds it set.
            flag::register_conditional_shutdown(signal, 130, again.clone())?;
            flag::register(signal, again.clone())?;
            flag::register(signal, interrupt.stop.clone())?;
        }
        let watched = interrupt.clone();
        let builder = std::thread::Builder::new().name("signals".into());
        builder.spawn(move || watched.watch(after)).map_err(Failure::thread)?;
        Ok(interrupt)
    }

    /// Waits for a request and says what becomes of it: a step of a large solid may take minutes.
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

    /// Whether a signal ends the program at once from now on, or waits for what is under way to be kept.
    pub(crate) fn end_at_once(&self, at_once: bool) {
        // One that has come meanwhile belongs to the stage that ends.
        self.seen.fetch_or(self.stopped(), Ordering::Relaxed);
        self.keeps.store(!at_once, Ordering::Relaxed);
    }

    /// Whether a signal has come.
    pub(crate) fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// None until [`Interrupt::request`]; and a trace of the run.
    pub(crate) fn traced() -> (Interrupt, Trace) {
        let trace = Trace::default();
        (Interrupt { trace: Some(trace.clone()), ..Interrupt::default() }, trace)
    }

    /// Makes the request.
    pub fn request(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// A request that comes of itself after so many steps of the program, in whatever stages they are.
    pub fn after(steps: u64) -> Interrupt {
        Interrupt { steps: Some(steps), ..Interrupt::default() }
    }
}

/// Whether the program was started with a signal ignored, by the system's own account.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    mask & (1 << (signal - 1)) != 0
}

/// Time between two looks at the clock that is aimed at, from half to twice.
const LOOK: Duration = Duration::from_millis(2);
/// Most steps between two looks at the clock.
const STRIDE: u32 = 1024;

/// Writes the checkpoints of a run when they are due.
pub struct CheckpointStore {
    slots: RefCell<Slots>,
    interrupt: Interrupt,
    interval: Duration,
    written: Cell<Instant>,
    looked: Cell<Instant>,
    stride: Cell<u32>,
    left: Cell<u32>,
    steps: Cell<u64>,
    /// How the user goes on, for the message.
    command: String,
}

impl CheckpointStore {
    /// A store that is written about every `interval`; `command` is what continues the run.
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

    /// The request to stop.
    pub fn interrupt(&self) -> &Interrupt {
        &self.interrupt
    }

    /// Begins a stage that calls [`CheckpointStore::step`] after every step.
    pub fn begin(&self) {
        self.interrupt.end_at_once(false);
    }

    /// Ends it: from now on a signal ends the program at once.
    pub fn end(&self) {
        self.interrupt.end_at_once(true);
    }

    /// After a step: writes a checkpoint if one is due. `moment` is where the run is, `fill` puts its state in.
    ///
    /// # Errors
    /// [`Failure::Interrupted`] after the checkpoint that an interrupt requests; what the system refuses.
    #[inline]
    pub fn step(
        &self,
        moment: impl FnOnce() -> Moment,
        fill: impl FnOnce(&mut Body<'_>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        if self.stopped() {
            // A run that stops at once says so in one line.
            self.interrupt.acknowledged.store(true, Ordering::Relaxed);
            let moment = moment();
            let place =
                format!("stage \"{}\", step {}, t = {:.6e} s", moment.stage, moment.step, moment.time);
            self.save(moment, fill)?;
            return Err(Failure::Interrupted(format!("interrupted: {place}; resume with: {}", self.command)));
        }
        let due = self.due();
        // A run that is traced is thrown away: it needs no checkpoint but the one at its end.
        if self.interrupt.trace.is_some() {
            self.follow(moment);
            return Ok(());
        }
        if due { self.save(moment(), fill) } else { Ok(()) }
    }

    /// After a step of a stage that only starts again from its beginning, where a checkpoint was written; `time`: simulated time of
    /// the bed that takes it [s].
    ///
    /// # Errors
    /// [`Failure::Interrupted`] when an interrupt requests it.
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

    /// Adds where the run is to its trace, if that is due.
    fn follow(&self, moment: impl FnOnce() -> Moment) {
        let Some(trace) = &self.interrupt.trace else { return };
        let mut trace = trace.lock().unwrap_or_else(PoisonError::into_inner);
        if trace.last().is_none_or(|(then, _)| self.looked.get() - *then > TRACE) {
            trace.push((self.looked.get(), moment()));
        }
    }

    /// Counts a step; whether the run is to stop after it.
    #[inline]
    fn stopped(&self) -> bool {
        self.steps.set(self.steps.get() + 1);
        self.interrupt.stop.load(Ordering::Relaxed)
            || self.interrupt.steps.is_some_and(|steps| self.steps.get() >= steps)
    }

    /// Writes a checkpoint now.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn save(
        &self,
        moment: Moment,
        fill: impl FnOnce(&mut Body<'_>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        let done = self.slots.borrow_mut().save(moment, fill);
        self.written.set(Instant::now());
        done
    }

    /// Writes a state to a file of its own.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn save_file(
        &self,
        file: &Path,
        moment: Moment,
        fill: impl FnOnce(&mut Body<'_>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        self.slots.borrow().save_file(file, moment, fill)
    }

    /// Removes the checkpoints: there is nothing to go on from.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn clear(&self) -> Result<(), Failure> {
        self.slots.borrow_mut().clear()
    }

    /// Removes checkpoints that another run left.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn clear_others(&self) -> Result<(), Failure> {
        self.slots.borrow_mut().clear_others()
    }

    /// Where the last checkpoint is, if there is one.
    pub fn kept(&self) -> Option<String> {
        let slots = self.slots.borrow();
        slots.has_one().then(|| slots.dir().display().to_string())
    }

    /// Whether the interval is over. Looks at the clock now and then only.
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
