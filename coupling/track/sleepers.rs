//! Sleepers of a running system with their loads, rails and push test.

use super::extremes::{Extremes, MomentumCheck, Observation, TrackRecord};
use super::load::{CyclicLoad, Waveform};
use super::push_test::{PushTest, PushTestOptions, PushTestState, PushTestSummary};
use super::rail::{RailEnergy, RailInput};
use super::rails::{LaidRails, Rails};
use super::rolling::RollingInput;
use super::row::SleeperRow;
use super::system::{GrainsView, MeshedSleeper, TrackSystem};
use serde::{Deserialize, Serialize};
use trackbed_dem as dem;

/// Parts of a track.
#[derive(Clone, Copy, Debug, Default)]
pub struct TrackInput<'a> {
    /// Sleepers.
    pub sleepers: Option<&'a SleeperRow>,
    /// Load.
    pub load: Option<&'a CyclicLoad>,
    /// Rail with mass on each row of seats.
    pub rail: Option<RailInput>,
    /// Vehicles on it; otherwise the axles are given forces.
    pub vehicles: Option<&'a RollingInput>,
    /// Lateral push after the cycles.
    pub push: Option<&'a PushTestOptions>,
}

/// Track of a run; rigid sleepers are the last bodies.
pub struct Track<'a> {
    row: Option<&'a SleeperRow>,
    load: Option<&'a CyclicLoad>,
    /// First rigid sleeper.
    first: usize,
    rails: Option<Rails>,
    push: Option<PushTest<'a>>,
    state: TrackState,
    /// At the start of a (possibly repeated) window.
    before: Option<LaidRails>,
    momentum: MomentumCheck,
}

/// State of a track, part of checkpoints.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct TrackState {
    /// Placed rails.
    laid: Option<LaidRails>,
    extremes: Vec<Extremes>,
    push: PushTestState,
    /// Load of the observed sleeper, window by window; without rails.
    tracking: dem::ForceTracking,
}

/// Position and load of a sleeper.
#[derive(Clone, Copy, Debug)]
pub struct SleeperSample {
    /// Centre [m].
    pub place: [f64; 3],
    /// Tilt from the vertical [rad].
    pub tilt: f64,
    /// Reference height of settlement [m]: centre, or seats (meshed) less their distance from it.
    pub height: f64,
    /// Downward load [N].
    pub load: f64,
    /// Meshed sleeper.
    pub meshed: Option<MeshedSleeper>,
}

/// Sleeper, seat, body, point [m].
type Seat = (usize, usize, usize, dem::Vec3);

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
    /// Track of a system.
    pub fn new(input: TrackInput<'a>, view: Option<GrainsView<'_>>) -> Track<'a> {
        let TrackInput { sleepers: row, load, rail, vehicles, push } = input;
        let count = row.filter(|r| !r.meshed).map_or(0, |r| r.centres.len());
        let rails = match (rail, row, load, view) {
            (Some(input), Some(row), Some(load), Some(view)) => {
                Rails::new(input, row.seats.len(), &row.gaps, load.clone(), vehicles, view.model.dt())
            }
            _ => None,
        };
        let first = view.map_or(0, |v| v.model.body_count()).saturating_sub(count);
        let push = match (push, row, view) {
            (Some(plan), Some(row), Some(view)) => {
                Some(PushTest::new(plan, row, view.model.gravity().z, first + count / 2))
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

    /// State, for a checkpoint.
    pub fn state(&self) -> &TrackState {
        &self.state
    }

    /// Continues from a checkpoint state.
    pub fn resume(self, state: TrackState) -> Track<'a> {
        Track { state, ..self }
    }

    /// Ends the cycles at `t` [s]; a push test may start.
    pub fn end_cycles(&mut self, t: f64) {
        let load = self.load.map_or(0.0, |l| l.on(self.count() / 2, t));
        if let Some(push) = &self.push {
            push.begin(&mut self.state.push, t, load);
        }
    }

    /// Curve and results of a push test (see [`PushTest::curve`]).
    pub fn push_curve(&self) -> Option<(&[[f64; 3]], PushTestSummary)> {
        self.push.as_ref()?.curve(&self.state.push)
    }

    /// Begins a window.
    pub fn begin_window(&mut self) {
        self.momentum.reset();
        if self.rails.is_some() {
            self.before.clone_from(&self.state.laid);
        }
    }

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

    /// Adds the sleeper forces at `t` [s].
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
        // Loads of meshed sleepers act on the solid.
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

    /// Whether sleeper `k` had no contact in the last window.
    fn has_lost_contact(&self, k: usize, view: GrainsView<'_>) -> bool {
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
        let observed = self.observed().filter(|_| self.rails.is_none());
        if let Some((k, applied)) = observed.and_then(|k| Some((k, self.momentum.mean_force(k)?))) {
            // Simpson's rule.
            let [begin, middle, end] = [t - window, t - 0.5 * window, t].map(|t| load.on(k, t));
            self.state.tracking.add(window, (begin + 4.0 * middle + end) / 6.0, applied);
        }
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
            let lifted = meshed.map_or_else(|| self.has_lost_contact(k, view), |m| m.contact == [0.0; 3]);
            match self.state.extremes.get_mut(k) {
                None => self.state.extremes.push(Extremes::start(&now)),
                Some(e) => e.update(&now, lifted, t - window, window),
            }
        }
    }

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

    /// Body of rigid sleeper `k`.
    pub fn body(&self, k: usize) -> usize {
        self.first + k
    }

    /// Sleeper `k` with its load at `t` [s].
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

    /// Upward rail deflection over sleeper `k`, mean of all rails [m].
    pub fn rail_deflection(&self, k: usize) -> f64 {
        self.state
            .laid
            .as_ref()
            .zip(self.rails.as_ref())
            .map_or(0.0, |(laid, rails)| laid.deflection(rails, k))
    }

    /// Observed sleeper: the middle one.
    pub fn observed(&self) -> Option<usize> {
        (self.count() > 0).then(|| self.count() / 2)
    }

    /// Load of the observed rigid sleeper compared with its target; none with rails.
    pub fn applied_load(&self) -> Option<(usize, dem::AppliedLoad)> {
        Some((self.observed()?, self.state.tracking.result()?))
    }

    /// Energy and work of rails and pads [J]; zero without.
    pub fn rail_energy(&self) -> RailEnergy {
        self.state.laid.as_ref().map(LaidRails::energy).unwrap_or_default()
    }

    /// Forces of the axles of vehicles [N]; 0 before rails are laid, none without vehicles.
    pub fn axle_forces(&self) -> impl Iterator<Item = f64> + '_ {
        let (rails, laid) = (self.rails.as_ref(), self.state.laid.as_ref());
        let count = rails.map_or(0, Rails::axles);
        let before = std::iter::repeat_n(0.0, if laid.is_none() { count } else { 0 });
        before.chain(rails.zip(laid).into_iter().flat_map(|(rails, laid)| laid.axle_forces(rails)))
    }

    /// Placed rails with state and sleepers.
    pub fn laid_rails(&self) -> Option<(&Rails, &LaidRails, &SleeperRow)> {
        Some((self.rails.as_ref()?, self.state.laid.as_ref()?, self.row?))
    }

    /// Extremes of the run; `None` before the first cycle.
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
        let vehicles =
            self.rails.as_ref().zip(self.state.laid.as_ref()).and_then(|(r, laid)| laid.vehicles(r));
        Some(TrackRecord { sleepers: extremes.iter().enumerate().map(record).collect(), vehicles })
    }
}
