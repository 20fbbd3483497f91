//! Sleepers of a running system and their loads: forces on their seats, rails on pads, a push when the cycles are over.

use super::extremes::{Extremes, MomentumCheck, Observation, TrackRecord};
use super::load::{CyclicLoad, Waveform};
use super::push::{Push, PushPlan, PushState, PushSummary};
use super::rail::RailInput;
use super::rails::{LaidRails, Rails};
use super::row::SleeperRow;
use super::system::{GrainsView, MeshedSleeper, TrackSystem};
use crate::ledger::{Spent, Stored};
use serde::{Deserialize, Serialize};
use trackbed_dem as dem;

/// What a track consists of.
#[derive(Clone, Copy, Debug, Default)]
pub struct TrackInput<'a> {
    /// The sleepers.
    pub sleepers: Option<&'a SleeperRow>,
    /// The load on them.
    pub load: Option<&'a CyclicLoad>,
    /// The rail on each row of seats, where it is a beam.
    pub rail: Option<RailInput>,
    /// Lateral push when the cycles are over.
    pub push: Option<&'a PushPlan>,
}

/// The sleepers of a run, the last bodies of the grains or bodies of the solid, and their loads.
pub struct Track<'a> {
    row: Option<&'a SleeperRow>,
    load: Option<&'a CyclicLoad>,
    /// Body of the first sleeper, of rigid ones.
    first: usize,
    rails: Option<Rails>,
    push: Option<Push<'a>>,
    state: TrackState,
    /// The rails as they were when the present window began, for a window that is repeated.
    before: Option<LaidRails>,
    momentum: MomentumCheck,
}

/// State of a track; goes into checkpoints.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct TrackState {
    /// The rails, once they are laid.
    laid: Option<LaidRails>,
    extremes: Vec<Extremes>,
    push: PushState,
}

/// Place and load of a sleeper at one moment.
#[derive(Clone, Copy, Debug)]
pub struct SleeperSample {
    /// Centre [m].
    pub place: [f64; 3],
    /// Angle between its axis and the vertical [rad].
    pub tilt: f64,
    /// Height that settlements refer to [m]: of the centre; of a meshed sleeper of the seats, less their distance
    /// from the centre.
    pub height: f64,
    /// Downward load [N].
    pub load: f64,
    /// More of a meshed sleeper.
    pub meshed: Option<MeshedSleeper>,
}

/// A seat where it is: number of sleeper and of seat, body, point [m].
type Seat = (usize, usize, usize, dem::Vec3);

/// Seats of rigid sleepers, `first` being the body of the first one.
fn seats<'a>(
    row: Option<&'a SleeperRow>,
    first: usize,
    model: &'a dem::Model,
    state: &'a dem::State,
) -> impl Iterator<Item = Seat> + 'a {
    (0..row.map_or(0, |r| r.centres.len())).flat_map(move |k| {
        let body = first + k;
        let (x, q) = (state.position(body), state.orientation(model, body));
        let seats = row.map_or(&[][..], |r| &r.seats);
        seats.iter().enumerate().map(move |(r, seat)| (k, r, body, x + q * dem::Vec3::from(*seat)))
    })
}

impl<'a> Track<'a> {
    /// The track of a system; one without sleepers where there are none.
    pub fn new(input: TrackInput<'a>, view: Option<GrainsView<'_>>) -> Track<'a> {
        let TrackInput { sleepers: row, load, rail, push } = input;
        let count = row.filter(|r| !r.meshed).map_or(0, |r| r.centres.len());
        let rails = match (rail, row, load, view) {
            (Some(input), Some(row), Some(load), Some(view)) => {
                Rails::new(input, row.seats.len(), load.clone(), view.model.dt())
            }
            _ => None,
        };
        let first = view.map_or(0, |v| v.model.body_count()).saturating_sub(count);
        let push = match (push, row, view) {
            (Some(plan), Some(row), Some(view)) => {
                Some(Push::new(plan, row, view.model.gravity().z, first + count / 2))
            }
            _ => None,
        };
        let (state, before, momentum) = Default::default();
        let mut track = Track { row, load, first, rails, push, state, before, momentum };
        if load.is_none() {
            track.end_cycles(0.0);
        }
        track
    }

    /// The state, for a checkpoint.
    pub fn state(&self) -> &TrackState {
        &self.state
    }

    /// The same track continued from a state of a checkpoint.
    pub fn resume(self, state: TrackState) -> Track<'a> {
        Track { state, ..self }
    }

    /// The cycles are over at time `t` [s]: a push, if there is one, begins.
    pub fn end_cycles(&mut self, t: f64) {
        let load = self.load.map_or(0.0, |l| l.on(self.count() / 2, t));
        if let Some(push) = &self.push {
            push.begin(&mut self.state.push, t, load);
        }
    }

    /// Curve and results of a push, if there was one (see [`Push::curve`]).
    pub fn push_curve(&self) -> Option<(&[[f64; 3]], PushSummary)> {
        self.push.as_ref()?.curve(&self.state.push)
    }

    /// Begins a window of steps.
    pub fn begin_window(&mut self) {
        self.momentum.reset();
        if self.rails.is_some() {
            self.before.clone_from(&self.state.laid);
        }
    }

    /// Advances the rails to the time of the grains.
    fn advance_rails(&mut self, model: &dem::Model, state: &dem::State) {
        let Some(rails) = &mut self.rails else { return };
        let laid = &mut self.state.laid;
        if laid.as_ref().is_some_and(|l| l.step() > state.steps) {
            laid.clone_from(&self.before);
        }
        let heights = seats(self.row, self.first, model, state).map(|s| s.3.z);
        match laid {
            None => *laid = rails.lay(state.time, state.steps, heights),
            Some(laid) => rails.advance(laid, state.time, (state.steps, state.last_dt()), heights),
        }
    }

    /// Adds the forces that act on the sleepers at time `t` [s].
    pub fn apply(
        &mut self,
        t: f64,
        model: &dem::Model,
        state: &dem::State,
        out: &mut Vec<dem::AppliedForce>,
    ) {
        if self.push.as_ref().is_some_and(|p| p.apply(&self.state.push, t, model, state, out)) {
            return;
        }
        // The load of meshed sleepers acts on the solid.
        let (Some(load), Some(row)) = (self.load, self.row.filter(|r| !r.meshed)) else { return };
        self.advance_rails(model, state);
        let speeds = (0..row.centres.len()).map(|k| state.velocity(self.first + k).z);
        self.momentum.begin(state.steps, state.kick(), speeds);
        let share = 1.0 / row.seats.len() as f64;
        for (k, r, body, point) in seats(self.row, self.first, model, state) {
            let down = match (&self.rails, &self.state.laid) {
                (Some(_), Some(laid)) => laid.force(k, r),
                (Some(_), None) => 0.0,
                (None, _) => load.on(k, t) * share,
            };
            self.momentum.add(k, -(down * state.kick()));
            out.push(dem::AppliedForce { body, force: dem::Vec3::new(0.0, 0.0, -down), point });
        }
    }

    /// Whether no contact has carried sleeper `k` in the window that is over.
    fn is_lifted(&self, k: usize, view: GrainsView<'_>) -> bool {
        let Some(row) = self.row.filter(|r| !r.held[2]) else { return false };
        let weight = row.mass * view.model.gravity().z;
        let speed = view.state.velocity(self.first + k).z;
        self.momentum.is_free(k, row.mass, weight, speed)
    }

    /// Records the state at the end of a window.
    pub fn follow<S: TrackSystem>(&mut self, t: f64, system: &S) {
        let Some(view) = system.grains() else { return };
        if let Some(push) = &self.push {
            push.follow(&mut self.state.push, t, view);
            if push.load(&self.state.push, t).is_some() {
                return;
            }
        }
        let Some(load) = self.load else { return };
        if self.rails.is_some() {
            self.advance_rails(view.model, view.state);
        }
        let window = system.window();
        if t + 0.5 * window < load.cycles_begin() {
            return;
        }
        for k in 0..self.count() {
            let meshed = system.meshed_sleeper(k);
            let now = Observation {
                force: self.force(k, t),
                height: meshed.map_or_else(|| view.state.position(self.body(k)).z, |m| m.height),
                rail: self.rail_deflection(k),
                bend: meshed.map_or(0.0, |m| m.moved.bend),
            };
            let lifted = meshed.map_or_else(|| self.is_lifted(k, view), |m| m.contact == [0.0; 3]);
            match self.state.extremes.get_mut(k) {
                None => self.state.extremes.push(Extremes::start(&now)),
                Some(e) => e.update(&now, lifted, t - window, window),
            }
        }
    }

    /// Downward force on a sleeper.
    fn force(&self, k: usize, t: f64) -> f64 {
        if let Some(load) = self.push.as_ref().and_then(|p| p.load(&self.state.push, t)) {
            return load;
        }
        match (&self.rails, &self.state.laid, self.row) {
            (Some(_), Some(laid), Some(row)) => (0..row.seats.len()).map(|r| laid.force(k, r)).sum(),
            (Some(_), _, _) => 0.0,
            (None, _, _) => self.load.map_or(0.0, |l| l.on(k, t)),
        }
    }

    /// Number of sleepers.
    pub fn count(&self) -> usize {
        self.row.map_or(0, |r| r.centres.len())
    }

    /// Whether there are rails with mass.
    pub fn has_rails(&self) -> bool {
        self.rails.is_some()
    }

    /// Body of sleeper `k`, of rigid ones.
    pub fn body(&self, k: usize) -> usize {
        self.first + k
    }

    /// Sleeper `k` with its load at time `t` [s].
    pub fn sleeper<S: TrackSystem>(&self, k: usize, t: f64, system: &S) -> Option<SleeperSample> {
        let load = self.force(k, t);
        if let Some(meshed) = system.meshed_sleeper(k) {
            let MeshedSleeper { place, height, moved, .. } = meshed;
            return Some(SleeperSample { place, tilt: moved.tilt, height, load, meshed: Some(meshed) });
        }
        let g = system.grains()?;
        let x = g.state.position(self.body(k));
        let up = g.state.orientation(g.model, self.body(k)) * nalgebra::Vector3::z();
        let tilt = libm::acos(up.z.clamp(-1.0, 1.0));
        Some(SleeperSample { place: x.into(), tilt, height: x.z, load, meshed: None })
    }

    /// Whether the sleepers are meshed.
    pub fn is_meshed(&self) -> bool {
        self.row.is_some_and(|r| r.meshed)
    }

    /// Deflection of the rail over sleeper `k` since it was laid, upwards, mean of all rails [m].
    pub fn rail_deflection(&self, k: usize) -> f64 {
        self.state
            .laid
            .as_ref()
            .zip(self.rails.as_ref())
            .map_or(0.0, |(laid, rails)| laid.deflection(rails, k))
    }

    /// The sleeper whose settlement is followed: the one in the middle.
    pub fn observed(&self) -> Option<usize> {
        (self.count() > 0).then(|| self.count() / 2)
    }

    /// Adds what rails and pads store and the work that passes through them [J].
    pub fn account(&self, stored: &mut Stored, spent: &mut Spent) {
        if let Some(laid) = &self.state.laid {
            let energy = laid.energy();
            stored.rail += energy.kinetic + energy.elastic;
            spent.wheels += energy.wheels;
            spent.pads_on_sleepers += energy.on_seats;
            spent.pads += energy.pads;
            spent.track_beyond += energy.beyond;
        }
    }

    /// The rails once they are laid, with their state and the sleepers below.
    pub fn laid_rails(&self) -> Option<(&Rails, &LaidRails, &SleeperRow)> {
        Some((self.rails.as_ref()?, self.state.laid.as_ref()?, self.row?))
    }

    /// Extremes of the run; none before the first cycle.
    pub fn record(&self) -> Option<TrackRecord> {
        let extremes = &self.state.extremes;
        let load = self.load.filter(|_| !extremes.is_empty())?;
        let axle = match &load.waveform {
            Waveform::Pass(pass) if !pass.gaussian() => pass.axles.iter().map(|a| a[1]).reduce(f64::max),
            _ => None,
        };
        let at_rest = self.rails.as_ref().and_then(Rails::static_peaks);
        let record = |(k, e): (usize, &Extremes)| {
            e.record(axle, at_rest.as_ref().map(|f| f[k]), self.has_rails(), self.is_meshed())
        };
        Some(TrackRecord { sleepers: extremes.iter().enumerate().map(record).collect() })
    }
}
