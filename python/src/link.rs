//! Link between run thread and interpreter: a paused run executes requests.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Mutex, MutexGuard, PoisonError};
use trackbed::failure::Failure;
use trackbed::run::{Companion, Outcome, Shown};
use trackbed_dem as dem;

/// Request executed on a paused run.
pub type Look = Box<dyn FnOnce(&Shown<'_>) + Send>;

/// Target of a run.
#[derive(Clone, Copy, Debug)]
pub enum Goal {
    /// Number of windows, or the end.
    Windows(u64),
    /// First window ending at or after this time [s].
    Time(f64),
    /// End.
    End,
}

/// Command to a paused run.
pub enum Order {
    /// Execute.
    Look(Look),
    /// Continue.
    Go(Goal),
}

/// Report of a run.
pub enum Report {
    /// Paused.
    Paused(Place),
    /// Ended.
    Ended(Result<Outcome, Failure>),
}

/// Progress of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Place {
    /// Main-loop time [s].
    pub time: f64,
    /// Completed windows.
    pub done: u64,
    /// Expected total of windows.
    pub windows: u64,
}

/// Force on a body at its centre [N].
#[derive(Clone, Copy, Debug)]
pub struct Push {
    /// Body index.
    pub body: usize,
    /// Force [N].
    pub force: [f64; 3],
}

/// Run side of the link.
pub struct Link {
    goal: Mutex<Goal>,
    orders: Mutex<Receiver<Order>>,
    reports: Sender<Report>,
    pushes: Mutex<Vec<Push>>,
    pause: AtomicBool,
}

impl Link {
    /// Creates a link that pauses before the first window.
    pub fn new(orders: Receiver<Order>, reports: Sender<Report>) -> Link {
        Link {
            goal: Mutex::new(Goal::Windows(0)),
            orders: Mutex::new(orders),
            reports,
            pushes: Mutex::default(),
            pause: AtomicBool::new(false),
        }
    }

    /// Pauses the run after its current window.
    pub fn pause(&self) {
        self.pause.store(true, Ordering::Relaxed);
    }

    /// Returns the forces applied in each step.
    pub fn pushes(&self) -> MutexGuard<'_, Vec<Push>> {
        locked(&self.pushes)
    }
}

/// Locks a mutex; its data are never left inconsistent.
pub fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Companion for Link {
    fn is_due(&self, time: f64, done: u64, windows: u64) -> bool {
        let last = done >= windows;
        let reached = match &mut *locked(&self.goal) {
            Goal::Windows(left) => {
                *left = left.saturating_sub(1);
                *left == 0 || last
            }
            // Tolerance for rounding of the summed time.
            Goal::Time(goal) => time >= *goal * (1.0 - 1e-12) || last,
            Goal::End => false,
        };
        self.pause.swap(false, Ordering::Relaxed) || reached
    }

    fn follow(&self, shown: &Shown<'_>) -> Result<(), Failure> {
        let mut goal = locked(&self.goal);
        let orders = locked(&self.orders);
        let place = Place { time: shown.time, done: shown.done, windows: shown.windows };
        // Without a receiver, a stop is requested.
        if self.reports.send(Report::Paused(place)).is_err() {
            return Ok(());
        }
        loop {
            match orders.recv() {
                Ok(Order::Look(look)) => look(shown),
                Ok(Order::Go(next)) => {
                    *goal = next;
                    return Ok(());
                }
                Err(_) => {
                    *goal = Goal::End;
                    return Ok(());
                }
            }
        }
    }

    fn push(&self, _: &dem::Model, state: &dem::State, out: &mut Vec<dem::AppliedForce>) {
        let pushes = locked(&self.pushes);
        let here = pushes.iter().filter(|push| state.present(push.body));
        out.extend(here.map(|&Push { body, force }| dem::AppliedForce {
            body,
            force: force.into(),
            point: state.position(body),
        }));
    }
}
