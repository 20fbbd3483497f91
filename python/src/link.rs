//! The link between a run on its thread and the interpreter: the run pauses after a window, carries out what it is asked to look at,
//! and goes on.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender};
use std::sync::{Mutex, MutexGuard, PoisonError};
use trackbed::failure::Failure;
use trackbed::run::{Companion, Outcome, Shown};
use trackbed_dem as dem;

/// What a paused run carries out with its state.
pub type Look = Box<dyn FnOnce(&Shown<'_>) + Send>;

/// How far a run goes.
#[derive(Clone, Copy, Debug)]
pub enum Goal {
    /// So many windows, or the last.
    Windows(u64),
    /// The first window that ends at this time or later [s], or the last.
    Time(f64),
    /// Its end.
    End,
}

/// What a paused run is to do.
pub enum Order {
    /// Carry this out.
    Look(Look),
    /// Go on.
    Go(Goal),
}

/// What a run reports.
pub enum Report {
    /// It waits for orders.
    Paused(Place),
    /// It has ended.
    Ended(Result<Outcome, Failure>),
}

/// Where a run is.
#[derive(Clone, Copy, Debug, Default)]
pub struct Place {
    /// Time since the start of the main loop [s].
    pub time: f64,
    /// Windows done.
    pub done: u64,
    /// Windows of the whole loop, as far as is known.
    pub windows: u64,
}

/// A force on a body, through its centre of mass [N].
#[derive(Clone, Copy, Debug)]
pub struct Push {
    /// Body (index).
    pub body: usize,
    /// Force [N].
    pub force: [f64; 3],
}

/// The run's end of the link.
pub struct Link {
    goal: Mutex<Goal>,
    orders: Mutex<Receiver<Order>>,
    reports: Sender<Report>,
    pushes: Mutex<Vec<Push>>,
    /// Whether it is to pause after the present window, whatever its goal.
    pause: AtomicBool,
}

impl Link {
    /// A link that pauses before the first window.
    pub fn new(orders: Receiver<Order>, reports: Sender<Report>) -> Link {
        Link {
            goal: Mutex::new(Goal::Windows(0)),
            orders: Mutex::new(orders),
            reports,
            pushes: Mutex::default(),
            pause: AtomicBool::new(false),
        }
    }

    /// Has the run pause after its present window.
    pub fn pause(&self) {
        self.pause.store(true, Ordering::Relaxed);
    }

    /// Forces that act in every step.
    pub fn pushes(&self) -> MutexGuard<'_, Vec<Push>> {
        locked(&self.pushes)
    }
}

/// What a lock holds; nobody leaves it half changed.
pub fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Companion for Link {
    fn follow(&self, shown: &Shown<'_>) -> Result<(), Failure> {
        let mut goal = locked(&self.goal);
        let last = shown.done >= shown.windows;
        let reached = match &mut *goal {
            Goal::Windows(left) => {
                *left = left.saturating_sub(1);
                *left == 0 || last
            }
            // A window that ends at the time but for the rounding of the sum.
            Goal::Time(time) => shown.time >= *time * (1.0 - 1e-12) || last,
            Goal::End => false,
        };
        if !self.pause.swap(false, Ordering::Relaxed) && !reached {
            return Ok(());
        }
        let orders = locked(&self.orders);
        let place = Place { time: shown.time, done: shown.done, windows: shown.windows };
        // Where nobody listens any more the run has been asked to stop, and does so after this window.
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
