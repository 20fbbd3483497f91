//! Sleepers of a running system and what loads them: forces on their seats, rails on pads, a push when the cycles are over.

use super::checkpoint::{Body, Loaded};
use super::push::{Push, PushState};
use super::rail::{Laid, Rails};
use super::summary::{LiftOff, SleeperRecord, Summary, TrackRecord};
use super::system::{GrainsView, MeshedView, System};
use crate::failure::Failure;
use crate::model::grains::{GrainsPart, SleeperPlan};
use crate::model::seat_load::{Course, CyclicLoad};
use crate::write::WallFrame;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;
use std::io;
use std::path::Path;
use trackbed_coupling::ledger::{Spent, Stored};
use trackbed_dem as dem;

/// Share of a sleeper's weight below which a contact force is rounding.
const UNFELT: f64 = 1e-9;

/// The sleepers of a run, its last bodies or bodies of the solid, and what loads them.
pub struct Track<'a> {
    plan: Option<&'a SleeperPlan>,
    load: Option<&'a CyclicLoad>,
    /// Body of the first sleeper, of rigid ones.
    first: usize,
    rails: Option<Rails>,
    push: Option<Push<'a>>,
    now: RefCell<Now>,
    /// The rails as they were when the present window began, for a window that is made again.
    before: RefCell<Option<Laid>>,
    window: RefCell<Window>,
}

/// What tells whether contacts carry a sleeper in the present window: what its momentum would be without contacts.
#[derive(Default)]
struct Window {
    /// Step at which it began.
    from: Option<u64>,
    /// Upward speed of each sleeper then [m/s].
    speed: Vec<f64>,
    /// Upward impulse of its seats since [N s].
    impulse: Vec<f64>,
}

/// What changes, and so what a checkpoint keeps.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Now {
    /// The rails, once they are laid.
    laid: Option<Laid>,
    extremes: Vec<Extremes>,
    push: PushState,
}

/// Extremes of a sleeper while the load cycles last.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Extremes {
    force: [f64; 2],
    /// Height when the cycles began, and the least since [m].
    height: [f64; 2],
    /// Greatest height since [m].
    highest: f64,
    /// Time without any contact force, and when that first began [s].
    aloft: f64,
    lifted: Option<f64>,
    /// Least deflection of the rail over it [m].
    rail: f64,
    /// Least and largest rise of a meshed sleeper's ends over its middle [m].
    bend: [f64; 2],
}

/// Place and load of a sleeper at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Sleeper {
    /// Centre [m].
    pub place: [f64; 3],
    /// Angle between its axis and the vertical [rad].
    pub tilt: f64,
    /// Height that settlements are taken from [m]: of the centre; of a meshed sleeper of the seats, less their distance
    /// from the centre.
    pub height: f64,
    /// Downward load [N].
    pub load: f64,
    /// What a meshed sleeper has more.
    pub meshed: Option<MeshedView>,
}

impl<'a> Track<'a> {
    /// The track of a system; one without sleepers where there are none.
    pub fn new(grains: Option<&'a GrainsPart>, view: Option<GrainsView<'_>>) -> Track<'a> {
        let plan = grains.and_then(|g| g.sleeper.as_ref());
        let load = grains.and_then(|g| g.load.as_ref());
        let count = plan.filter(|p| !p.meshed).map_or(0, |p| p.centres.len());
        let rails = match (grains.and_then(|g| g.rail), plan, load, view) {
            (Some(input), Some(plan), Some(load), Some(view)) => {
                Rails::new(input, plan.seats.len(), load.clone(), view.model.dt())
            }
            _ => None,
        };
        let first = view.map_or(0, |v| v.model.body_count()).saturating_sub(count);
        let push = match (grains, view) {
            (Some(grains), Some(view)) => Push::new(grains, view.model, first + count / 2),
            _ => None,
        };
        let track = Track {
            plan,
            load,
            first,
            rails,
            push,
            now: RefCell::default(),
            before: RefCell::default(),
            window: RefCell::default(),
        };
        if load.is_none() {
            track.end_cycles(0.0);
        }
        track
    }

    /// The cycles are over at time `t` [s]: a push, if there is one, begins.
    pub fn end_cycles(&self, t: f64) {
        if let Some(push) = &self.push {
            push.begin(
                &mut self.now.borrow_mut().push,
                t,
                self.load.map_or(0.0, |l| l.on(self.count() / 2, t)),
            );
        }
    }

    /// Writes what a push told.
    ///
    /// # Errors
    /// The disk refuses.
    pub fn finish(&self, dir: &Path, summary: &mut Summary) -> Result<(), Failure> {
        self.push.as_ref().map_or(Ok(()), |push| push.finish(&self.now.borrow().push, dir, summary))
    }

    /// The same, going on from a checkpoint.
    ///
    /// # Errors
    /// A checkpoint of something else.
    pub fn resume(self, loaded: &mut Loaded) -> Result<Track<'a>, Failure> {
        self.now.replace(loaded.take()?);
        Ok(self)
    }

    /// Puts into a checkpoint what [`Track::resume`] goes on from.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn save(&self, body: &mut Body<'_>) -> io::Result<()> {
        body.put(&*self.now.borrow())
    }

    /// Begins a window of steps.
    pub fn begin_window(&self) {
        self.window.borrow_mut().from = None;
        if self.rails.is_some() {
            self.before.borrow_mut().clone_from(&self.now.borrow().laid);
        }
    }

    /// Seats of all sleepers where they are: number of sleeper and of seat, body, point.
    fn seats<'b>(
        &'b self,
        model: &'b dem::Model,
        state: &'b dem::State,
    ) -> impl Iterator<Item = (usize, usize, usize, dem::Vec3)> + 'b {
        let plan = self.plan;
        (0..self.count()).flat_map(move |k| {
            let body = self.first + k;
            let (x, q) = (state.position(body), state.orientation(model, body));
            let seats = plan.map_or(&[][..], |p| &p.seats);
            seats.iter().enumerate().map(move |(r, seat)| (k, r, body, x + q * dem::Vec3::from(*seat)))
        })
    }

    /// Brings the rails to the time of the grains.
    fn bring_up(&self, model: &dem::Model, state: &dem::State) {
        let Some(rails) = &self.rails else { return };
        let laid = &mut self.now.borrow_mut().laid;
        if laid.as_ref().is_some_and(|l| l.step() > state.steps) {
            laid.clone_from(&self.before.borrow());
        }
        let heights = self.seats(model, state).map(|s| s.3.z);
        match laid {
            None => *laid = rails.lay(state.time, state.steps, heights),
            Some(laid) => rails.advance(laid, state.time, state.steps, heights),
        }
    }

    /// Adds the forces that act on the sleepers at time `t` [s].
    pub fn apply(&self, t: f64, model: &dem::Model, state: &dem::State, out: &mut Vec<dem::AppliedForce>) {
        if self.push.as_ref().is_some_and(|p| p.apply(&self.now.borrow().push, t, model, state, out)) {
            return;
        }
        // Meshed sleepers get theirs as a load on the solid.
        let (Some(load), Some(plan)) = (self.load, self.plan.filter(|p| !p.meshed)) else { return };
        self.bring_up(model, state);
        let (now, mut window) = (self.now.borrow(), self.window.borrow_mut());
        // A window that is made again begins at the same step.
        if window.from.is_none_or(|from| state.steps <= from) {
            window.from = Some(state.steps);
            window.speed.clear();
            window.speed.extend((0..self.count()).map(|k| state.velocity(self.first + k).z));
            window.impulse.clear();
            window.impulse.resize(self.count(), 0.0);
        }
        let share = 1.0 / plan.seats.len() as f64;
        for (k, r, body, point) in self.seats(model, state) {
            let down = match (&self.rails, &now.laid) {
                (Some(_), Some(laid)) => laid.force(k, r),
                (Some(_), None) => 0.0,
                (None, _) => load.on(k, t) * share,
            };
            window.impulse[k] -= down * model.dt();
            out.push(dem::AppliedForce { body, force: dem::Vec3::new(0.0, 0.0, -down), point });
        }
    }

    /// Whether no contact has carried sleeper `k` in the window that is over: its momentum has changed by no more than what its
    /// seats and its weight gave it.
    fn aloft(&self, k: usize, view: GrainsView<'_>) -> bool {
        let (window, Some(plan)) = (self.window.borrow(), self.plan) else { return false };
        let (Some(from), false) = (window.from, plan.held()[2]) else { return false };
        let mass = plan.mass();
        let weight = mass * view.model.gravity().z * view.model.dt() * (view.state.steps - from) as f64;
        let gained = mass * (view.state.velocity(self.first + k).z - window.speed[k]);
        (gained - window.impulse[k] - weight).abs() <= UNFELT * weight.abs()
    }

    /// Takes in the state at the end of a window.
    pub fn follow<S: System>(&self, t: f64, system: &S) {
        let Some(view) = system.grains() else { return };
        if let Some(push) = &self.push {
            let state = &mut self.now.borrow_mut().push;
            push.follow(state, t, view);
            if push.load(state, t).is_some() {
                return;
            }
        }
        let Some(load) = self.load else { return };
        if self.rails.is_some() {
            self.bring_up(view.model, view.state);
        }
        if t + 0.5 * system.window() < load.cycles_begin() {
            return;
        }
        let mut now = self.now.borrow_mut();
        for k in 0..self.count() {
            let meshed = system.meshed_sleeper(k);
            let height = meshed.map_or_else(|| view.state.position(self.body(k)).z, |m| m.height);
            let bend = meshed.map_or(0.0, |m| m.moved.bend);
            let force = self.force(&now, k, t);
            let rail = now.laid.as_ref().zip(self.rails.as_ref()).map_or(0.0, |(l, r)| l.deflection(r, k));
            match now.extremes.get_mut(k) {
                None => now.extremes.push(Extremes {
                    force: [force; 2],
                    height: [height; 2],
                    highest: height,
                    aloft: 0.0,
                    lifted: None,
                    rail,
                    bend: [bend; 2],
                }),
                Some(e) => {
                    e.highest = e.highest.max(height);
                    if meshed.map_or_else(|| self.aloft(k, view), |m| m.contact == [0.0; 3]) {
                        e.lifted.get_or_insert(t - system.window());
                        e.aloft += system.window();
                    }
                    e.force = [e.force[0].min(force), e.force[1].max(force)];
                    e.height[1] = e.height[1].min(height);
                    e.rail = e.rail.min(rail);
                    e.bend = [e.bend[0].min(bend), e.bend[1].max(bend)];
                }
            }
        }
    }

    /// Downward force on a sleeper.
    fn force(&self, now: &Now, k: usize, t: f64) -> f64 {
        if let Some(load) = self.push.as_ref().and_then(|p| p.load(&now.push, t)) {
            return load;
        }
        match (&self.rails, &now.laid, self.plan) {
            (Some(_), Some(laid), Some(plan)) => (0..plan.seats.len()).map(|r| laid.force(k, r)).sum(),
            (Some(_), _, _) => 0.0,
            (None, _, _) => self.load.map_or(0.0, |l| l.on(k, t)),
        }
    }

    /// Number of sleepers.
    pub fn count(&self) -> usize {
        self.plan.map_or(0, |p| p.centres.len())
    }

    /// Whether there are rails with columns of their own.
    pub fn has_rails(&self) -> bool {
        self.rails.is_some()
    }

    /// Body of sleeper `k`, of rigid ones.
    pub fn body(&self, k: usize) -> usize {
        self.first + k
    }

    /// Sleeper `k` with its load at time `t` [s].
    pub fn sleeper<S: System>(&self, k: usize, t: f64, system: &S) -> Option<Sleeper> {
        let load = self.force(&self.now.borrow(), k, t);
        if let Some(meshed) = system.meshed_sleeper(k) {
            let MeshedView { place, height, moved, .. } = meshed;
            return Some(Sleeper { place, tilt: moved.tilt, height, load, meshed: Some(meshed) });
        }
        let g = system.grains()?;
        let x = g.state.position(self.body(k));
        let up = g.state.orientation(g.model, self.body(k)) * nalgebra::Vector3::z();
        let tilt = up.z.clamp(-1.0, 1.0).acos();
        Some(Sleeper { place: x.into(), tilt, height: x.z, load, meshed: None })
    }

    /// Whether the sleepers are meshed.
    pub fn is_meshed(&self) -> bool {
        self.plan.is_some_and(|p| p.meshed)
    }

    /// Deflection of the rail over sleeper `k` since it was laid, upwards, mean of all rails [m].
    pub fn rail(&self, k: usize) -> f64 {
        let now = self.now.borrow();
        now.laid.as_ref().zip(self.rails.as_ref()).map_or(0.0, |(laid, rails)| laid.deflection(rails, k))
    }

    /// The sleeper whose settlement is followed: the one in the middle.
    pub fn observed(&self) -> Option<usize> {
        (self.count() > 0).then(|| self.count() / 2)
    }

    /// Adds what rails and pads hold and have turned over [J].
    pub fn account(&self, stored: &mut Stored, spent: &mut Spent) {
        if let Some(laid) = &self.now.borrow().laid {
            let books = laid.books();
            stored.rail += books.kinetic + books.elastic;
            spent.wheels += books.wheels;
            spent.pads_on_sleepers += books.on_seats;
            spent.pads += books.pads;
            spent.track_beyond += books.beyond;
        }
    }

    /// Adds the rails over the modelled sleepers to a picture.
    pub fn draw(&self, frame: &mut WallFrame) {
        if let (Some(plan), Some(rails), Some(laid)) = (self.plan, &self.rails, &self.now.borrow().laid) {
            laid.draw(rails, plan, frame);
        }
    }

    /// Extremes of the run.
    pub fn record(&self) -> Option<TrackRecord> {
        let now = self.now.borrow();
        let load = self.load.filter(|_| !now.extremes.is_empty())?;
        let axle = match &load.course {
            Course::Pass(pass) if !pass.gaussian() => pass.axles.iter().map(|a| a[1]).reduce(f64::max),
            _ => None,
        };
        let at_rest = self.rails.as_ref().and_then(Rails::static_peaks);
        let record = |(k, e): (usize, &Extremes)| {
            let static_force = at_rest.as_ref().map(|f| f[k]);
            SleeperRecord {
                largest_force: e.force[1],
                smallest_force: e.force[0],
                lowering: e.height[0] - e.height[1],
                lifted_off: e.lifted.map(|first| LiftOff {
                    first,
                    seconds: e.aloft,
                    rise: e.highest - e.height[0],
                }),
                load_share: axle.map(|p| e.force[1] / p),
                rail_deflection: self.rails.as_ref().map(|_| -e.rail),
                static_force,
                dynamic_amplification: static_force.map(|f| e.force[1] / f),
                bend: self.is_meshed().then_some(e.bend),
            }
        };
        Some(TrackRecord { sleepers: now.extremes.iter().enumerate().map(record).collect() })
    }
}
