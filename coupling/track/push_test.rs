//! Lateral push test of a sleeper by an actuator of constant speed with spring and dashpot.
//!
//! Single-tie push test, as in Zakeri, Lateral resistance of railway track, 2012. Resistance: mean actuator
//! force per row; inertia vanishes at constant speed. Theory manual: eq. (6.28).

use super::row::SleeperRow;
use super::system::GrainsView;
use serde::{Deserialize, Serialize};
use trackbed_dem as dem;

/// Acceleration time over full-speed time.
const START: f64 = 0.05;
/// Rows of the curve.
const ROWS: f64 = 200.0;
/// Damping ratio of the actuator.
const DAMPING: f64 = 0.7;
/// Largest Δt ω of sleeper and actuator.
const LARGEST_STEP: f64 = 0.1;

/// Lateral push test.
#[derive(Clone, Copy, Debug)]
pub struct PushTestOptions {
    /// Unit vector.
    pub direction: dem::Vec3,
    /// Actuator speed [m/s].
    pub speed: f64,
    /// Actuator displacement [m].
    pub displacement: f64,
    /// Vertical force on the sleeper [N].
    pub load: f64,
    /// Time from the last cycle to the push [s].
    pub rest: f64,
    /// Height above the sleeper centre [m].
    pub height: f64,
    /// Actuator stiffness [N/m].
    pub stiffness: f64,
}

impl PushTestOptions {
    /// Duration with the preceding rest [s].
    pub fn duration(&self) -> f64 {
        self.rest + (1.0 + 0.5 * START) * self.displacement / self.speed
    }

    /// Actuator displacement [m] and speed [m/s] `since` its start [s].
    pub fn actuator(&self, since: f64) -> (f64, f64) {
        let start = START * self.displacement / self.speed;
        if since < start {
            let share = since.max(0.0) / start;
            (0.5 * self.speed * share * share * start, share * self.speed)
        } else {
            (self.speed * (since - 0.5 * start), self.speed)
        }
    }

    /// Longest step [s] for `stiffness` [N/m] and sleeper `mass` [kg].
    pub fn longest_step(stiffness: f64, mass: f64) -> f64 {
        LARGEST_STEP * (mass / stiffness).sqrt()
    }

    /// Largest stiffness [N/m] for steps of `dt` [s] and sleeper `mass` [kg]: dt √(k/m) = 0.1.
    pub fn largest_stiffness(mass: f64, dt: f64) -> f64 {
        mass * (LARGEST_STEP / dt).powi(2)
    }
}

/// Results of a push test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PushTestSummary {
    /// Force at 2 mm [N]; `None` if not reached.
    pub resistance_at_2_mm: Option<f64>,
    /// Largest force [N].
    pub peak: f64,
    /// Displacement at the largest force [m].
    pub displacement_at_peak: f64,
    /// Mean force over the last quarter [N].
    pub residual: f64,
    /// Sleeper weight plus vertical load [N].
    pub vertical_force: f64,
    /// Final uplift [m].
    pub uplift: f64,
}

/// State of a push test, part of checkpoints.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct PushTestState {
    /// Start of rest [s] and load then [N].
    rest_start: Option<(f64, f64)>,
    /// Initial position [m].
    origin: Option<dem::Vec3>,
    /// Windows and sums of the current row.
    count: u32,
    sums: [f64; 3],
    /// Displacement [m], force [N], uplift [m].
    rows: Vec<[f64; 3]>,
}

/// Running push test.
pub struct PushTest<'a> {
    plan: &'a PushTestOptions,
    mass: f64,
    weight: f64,
    seats: &'a [[f64; 3]],
    body: usize,
}

impl<'a> PushTest<'a> {
    /// Push of sleeper `body` of `row`, gravity along z [m/s²].
    pub fn new(plan: &'a PushTestOptions, row: &'a SleeperRow, gravity: f64, body: usize) -> PushTest<'a> {
        PushTest { plan, mass: row.mass, weight: -row.mass * gravity, seats: &row.seats, body }
    }

    /// Ends the cycles at `t` [s] with the current load [N].
    pub fn begin(&self, state: &mut PushTestState, t: f64, load: f64) {
        state.rest_start.get_or_insert((t, load));
    }

    /// Load [N] and actuator time [s]; `None` during the cycles.
    fn at(&self, state: &PushTestState, t: f64) -> Option<(f64, f64)> {
        let (rest_start, before) = state.rest_start?;
        let since = t - rest_start;
        let share = if self.plan.rest > 0.0 { (since / self.plan.rest).clamp(0.0, 1.0) } else { 1.0 };
        Some((before + share * (self.plan.load - before), since - self.plan.rest))
    }

    /// Vertical load at `t` [N]; `None` during the cycles.
    pub fn load(&self, state: &PushTestState, t: f64) -> Option<f64> {
        self.at(state, t).map(|(load, _)| load)
    }

    /// Actuator force [N] and sleeper displacement [m].
    fn actuator(&self, state: &PushTestState, t: f64, grains: &dem::State) -> Option<(f64, f64)> {
        let (actuator, actuator_speed) = self.plan.actuator(self.at(state, t)?.1);
        let way = (grains.position(self.body) - state.origin?).dot(&self.plan.direction);
        let speed = grains.velocity(self.body).dot(&self.plan.direction);
        let dashpot = 2.0 * DAMPING * (self.plan.stiffness * self.mass).sqrt();
        let force = self.plan.stiffness * (actuator - way) + dashpot * (actuator_speed - speed);
        // No tension.
        Some((force.max(0.0), way))
    }

    /// Adds the forces at `t` [s]; returns whether the cycles are over.
    pub fn apply(
        &self,
        state: &PushTestState,
        t: f64,
        model: &dem::Model,
        grains: &dem::State,
        out: &mut Vec<dem::AppliedForce>,
    ) -> bool {
        let Some((load, _)) = self.at(state, t) else { return false };
        let (body, x) = (self.body, grains.position(self.body));
        let q = grains.orientation(model, body);
        for seat in self.seats {
            let force = dem::Vec3::new(0.0, 0.0, -load / self.seats.len() as f64);
            out.push(dem::AppliedForce { body, force, point: x + q * dem::Vec3::from(*seat) });
        }
        if let Some((force, _)) = self.actuator(state, t, grains) {
            let point = x + dem::Vec3::new(0.0, 0.0, self.plan.height);
            out.push(dem::AppliedForce { body, force: self.plan.direction * force, point });
        }
        true
    }

    /// Adds a window to the curve.
    pub fn follow(&self, state: &mut PushTestState, t: f64, g: GrainsView<'_>) {
        let Some((_, since)) = self.at(state, t) else { return };
        let (x, actuator) = (g.state.position(self.body), self.plan.actuator(since).0);
        if since < 0.0 || state.rows.len() as f64 >= ROWS {
            return;
        }
        let origin = *state.origin.get_or_insert(x);
        if let Some((force, way)) = self.actuator(state, t, g.state) {
            for (sum, value) in state.sums.iter_mut().zip([way, force, x.z - origin.z]) {
                *sum += value;
            }
            state.count += 1;
        }
        if actuator >= (state.rows.len() + 1) as f64 / ROWS * self.plan.displacement {
            let n = f64::from(state.count.max(1));
            state.rows.push(state.sums.map(|s| s / n));
            (state.sums, state.count) = ([0.0; 3], 0);
        }
    }

    /// Displacement [m], force [N], uplift [m] per row, and results; `None` before the start.
    pub fn curve<'b>(&self, state: &'b PushTestState) -> Option<(&'b [[f64; 3]], PushTestSummary)> {
        (!state.rows.is_empty()).then(|| (&state.rows[..], self.summary(&state.rows)))
    }

    fn summary(&self, rows: &[[f64; 3]]) -> PushTestSummary {
        let peak = rows.iter().copied().max_by(|a, b| a[1].total_cmp(&b[1])).unwrap_or_default();
        let two = rows.windows(2).find(|w| w[0][0] < 2e-3 && 2e-3 <= w[1][0]).map(|w| {
            let share = (2e-3 - w[0][0]) / (w[1][0] - w[0][0]);
            w[0][1] + share * (w[1][1] - w[0][1])
        });
        let tail = &rows[rows.len() - rows.len().div_ceil(4)..];
        PushTestSummary {
            resistance_at_2_mm: two,
            peak: peak[1],
            displacement_at_peak: peak[0],
            residual: tail.iter().map(|r| r[1]).sum::<f64>() / tail.len() as f64,
            vertical_force: self.weight + self.plan.load,
            uplift: rows.last().map_or(0.0, |r| r[2]),
        }
    }
}
