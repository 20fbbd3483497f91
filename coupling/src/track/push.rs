//! Lateral push of a sleeper: a ram with a spring and a dashpot moves sideways at a steady speed; the result is its force against
//! the way of the sleeper.
//!
//! Source: single-tie push test, as in Zakeri, Lateral resistance of railway track, 2012. The resistance is the force of the
//! ram, mean over one row: less the inertia of the sleeper, which at a steady speed is none.
//!
//! Limits: a single sleeper, without a rail.
//!
//! Theory manual: equation (6.28) of `docs/theory/track.md`.

use super::row::SleeperRow;
use super::system::GrainsView;
use serde::{Deserialize, Serialize};
use trackbed_dem as dem;

/// Share of its time at full speed in which the ram of a push accelerates.
const START: f64 = 0.05;
/// Rows of the curve.
const ROWS: f64 = 200.0;
/// Share of critical damping of the ram against the sleeper's mass.
const DAMPING: f64 = 0.7;
/// Largest step of the grains times the frequency of the sleeper on the ram.
const LARGEST_STEP: f64 = 0.1;

/// A lateral push.
#[derive(Clone, Copy, Debug)]
pub struct PushPlan {
    /// Unit vector.
    pub direction: dem::Vec3,
    /// Speed of the ram [m/s].
    pub speed: f64,
    /// How far it goes [m].
    pub displacement: f64,
    /// Vertical force on the sleeper meanwhile [N].
    pub load: f64,
    /// Time from the last cycle to the push [s].
    pub rest: f64,
    /// Height of the ram above the sleeper's centre [m].
    pub height: f64,
    /// Stiffness of the ram [N/m].
    pub stiffness: f64,
}

impl PushPlan {
    /// Time that the push takes with the rest before it [s].
    pub fn duration(&self) -> f64 {
        self.rest + (1.0 + 0.5 * START) * self.displacement / self.speed
    }

    /// Way [m] and speed [m/s] of the ram a time after it started [s]: it accelerates evenly to its speed.
    pub fn ram(&self, since: f64) -> (f64, f64) {
        let start = START * self.displacement / self.speed;
        if since < start {
            let share = since.max(0.0) / start;
            (0.5 * self.speed * share * share * start, share * self.speed)
        } else {
            (self.speed * (since - 0.5 * start), self.speed)
        }
    }

    /// Longest step [s] that can follow a ram of `stiffness` [N/m] against a sleeper of `mass` [kg].
    pub fn longest_step(stiffness: f64, mass: f64) -> f64 {
        LARGEST_STEP * (mass / stiffness).sqrt()
    }

    /// Largest stiffness of a ram against a sleeper of `mass` [kg] that steps of `dt` [s] can follow [N/m]:
    /// dt √(k/m) is a tenth.
    pub fn largest_stiffness(mass: f64, dt: f64) -> f64 {
        mass * (LARGEST_STEP / dt).powi(2)
    }
}

/// Results of a push.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PushSummary {
    /// Force at a way of 2 mm [N]; none when the sleeper did not get there.
    pub resistance_at_2_mm: Option<f64>,
    /// Largest force [N].
    pub peak: f64,
    /// Way at the largest force [m].
    pub displacement_at_peak: f64,
    /// Mean force over the last quarter of the curve [N].
    pub residual: f64,
    /// Weight of the sleeper and vertical load on it [N].
    pub vertical_force: f64,
    /// Rise of the sleeper at the end [m].
    pub uplift: f64,
}

/// State of a push; goes into checkpoints.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct PushState {
    /// Time when the rest before the push began, and the vertical load then [s, N].
    begun: Option<(f64, f64)>,
    /// Place of the sleeper when the ram started [m].
    origin: Option<dem::Vec3>,
    /// Windows in the present row, and sums of way, force and rise.
    count: u32,
    sums: [f64; 3],
    /// Way [m], force [N], rise [m].
    rows: Vec<[f64; 3]>,
}

/// A push of a run.
pub struct Push<'a> {
    plan: &'a PushPlan,
    mass: f64,
    weight: f64,
    seats: &'a [[f64; 3]],
    body: usize,
}

impl<'a> Push<'a> {
    /// The push of the sleeper `body`, one of `row`, under gravity along z [m/s²].
    pub fn new(plan: &'a PushPlan, row: &'a SleeperRow, gravity: f64, body: usize) -> Push<'a> {
        Push { plan, mass: row.mass, weight: -row.mass * gravity, seats: &row.seats, body }
    }

    /// Ends the cycles at time `t` [s], under the load of that moment [N].
    pub fn begin(&self, state: &mut PushState, t: f64, load: f64) {
        state.begun.get_or_insert((t, load));
    }

    /// Vertical load on the sleeper [N] and time since the ram started [s] at time `t`; none before the cycles are over.
    fn at(&self, state: &PushState, t: f64) -> Option<(f64, f64)> {
        let (begun, before) = state.begun?;
        let since = t - begun;
        let share = if self.plan.rest > 0.0 { (since / self.plan.rest).clamp(0.0, 1.0) } else { 1.0 };
        Some((before + share * (self.plan.load - before), since - self.plan.rest))
    }

    /// Vertical load on the sleeper at time `t` [N]; none before the cycles are over.
    pub fn load(&self, state: &PushState, t: f64) -> Option<f64> {
        self.at(state, t).map(|(load, _)| load)
    }

    /// Force of the ram on the sleeper [N], and how far that has come [m].
    fn ram(&self, state: &PushState, t: f64, grains: &dem::State) -> Option<(f64, f64)> {
        let (ram, ram_speed) = self.plan.ram(self.at(state, t)?.1);
        let way = (grains.position(self.body) - state.origin?).dot(&self.plan.direction);
        let speed = grains.velocity(self.body).dot(&self.plan.direction);
        let dashpot = 2.0 * DAMPING * (self.plan.stiffness * self.mass).sqrt();
        let force = self.plan.stiffness * (ram - way) + dashpot * (ram_speed - speed);
        // A ram does not pull.
        Some((force.max(0.0), way))
    }

    /// Adds the forces at time `t` [s]; whether the cycles are over, so that there are any.
    pub fn apply(
        &self,
        state: &PushState,
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
        if let Some((force, _)) = self.ram(state, t, grains) {
            let point = x + dem::Vec3::new(0.0, 0.0, self.plan.height);
            out.push(dem::AppliedForce { body, force: self.plan.direction * force, point });
        }
        true
    }

    /// After a window that ended at time `t` [s]: adds the force to the curve.
    pub fn follow(&self, state: &mut PushState, t: f64, g: GrainsView<'_>) {
        let Some((_, since)) = self.at(state, t) else { return };
        let (x, ram) = (g.state.position(self.body), self.plan.ram(since).0);
        if since < 0.0 || state.rows.len() as f64 >= ROWS {
            return;
        }
        let origin = *state.origin.get_or_insert(x);
        if let Some((force, way)) = self.ram(state, t, g.state) {
            for (sum, value) in state.sums.iter_mut().zip([way, force, x.z - origin.z]) {
                *sum += value;
            }
            state.count += 1;
        }
        if ram >= (state.rows.len() + 1) as f64 / ROWS * self.plan.displacement {
            let n = f64::from(state.count.max(1));
            state.rows.push(state.sums.map(|s| s / n));
            (state.sums, state.count) = ([0.0; 3], 0);
        }
    }

    /// The curve, rows of way [m], force [N] and rise [m], and its results; none before the ram has moved.
    pub fn curve<'b>(&self, state: &'b PushState) -> Option<(&'b [[f64; 3]], PushSummary)> {
        (!state.rows.is_empty()).then(|| (&state.rows[..], self.summary(&state.rows)))
    }

    fn summary(&self, rows: &[[f64; 3]]) -> PushSummary {
        let peak = rows.iter().copied().max_by(|a, b| a[1].total_cmp(&b[1])).unwrap_or_default();
        let two = rows.windows(2).find(|w| w[0][0] < 2e-3 && 2e-3 <= w[1][0]).map(|w| {
            let share = (2e-3 - w[0][0]) / (w[1][0] - w[0][0]);
            w[0][1] + share * (w[1][1] - w[0][1])
        });
        let tail = &rows[rows.len() - rows.len().div_ceil(4)..];
        PushSummary {
            resistance_at_2_mm: two,
            peak: peak[1],
            displacement_at_peak: peak[0],
            residual: tail.iter().map(|r| r[1]).sum::<f64>() / tail.len() as f64,
            vertical_force: self.weight + self.plan.load,
            uplift: rows.last().map_or(0.0, |r| r[2]),
        }
    }
}
