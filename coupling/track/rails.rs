//! [Rails](super::rail) over moving sleepers, one per seat.

use super::load::{CyclicLoad, Waveform};
use super::rail::{Rail, RailEnergy, RailInput, RailScratch, RailState, Wheel};
use serde::{Deserialize, Serialize};

/// Static wheel positions per bay.
const PLACES: f64 = 20.0;

/// One rail per seat.
pub struct Rails {
    rail: Rail,
    spacing: f64,
    count: usize,
    load: CyclicLoad,
    /// Height that the seats of each sleeper lack [m].
    gaps: Vec<f64>,
    scratch: RailScratch,
    wheels: Vec<Wheel>,
    seats: Vec<f64>,
    lifts: Vec<f64>,
}

/// State of the placed rails.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LaidRails {
    /// Current DEM step.
    step: u64,
    /// Seat heights at placement [m]. Shape `[sleepers × rails]`.
    heights: Vec<f64>,
    rails: Vec<RailState>,
}

impl Rails {
    /// `count` rails for steps of `dt` [s]; `gaps` [m] by sleeper; `None` for invalid input.
    pub fn new(input: RailInput, count: usize, gaps: &[f64], load: CyclicLoad, dt: f64) -> Option<Rails> {
        let (spacing, rail) = (input.spacing, Rail::new(input, dt)?);
        let (scratch, wheels, seats, lifts) = Default::default();
        Some(Rails { rail, spacing, count, load, gaps: gaps.to_vec(), scratch, wheels, seats, lifts })
    }

    /// Sleeper spacing [m].
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Places straight, force-free rails on the sleepers after the rest.
    pub fn lay(&self, time: f64, step: u64, heights: impl Iterator<Item = f64>) -> Option<LaidRails> {
        if time < self.load.rest {
            return None;
        }
        let rails = vec![self.rail.laid(); self.count];
        Some(LaidRails { step, heights: heights.collect(), rails })
    }

    /// Advances the rails to the grains' time.
    pub fn advance(
        &mut self,
        laid: &mut LaidRails,
        time: f64,
        (step, dt): (u64, f64),
        heights: impl Iterator<Item = f64>,
    ) {
        if laid.step == step {
            return;
        }
        debug_assert_eq!(laid.step + 1, step);
        laid.step = step;
        self.rail.set_dt(dt);
        self.load.wheels(time, self.count, &mut self.wheels);
        self.seats.clear();
        self.seats.extend(heights.zip(&laid.heights).map(|(now, then)| now - then));
        let weight = self.load.applied_share(time);
        self.lifts.clear();
        self.lifts.extend(self.gaps.iter().map(|gap| weight * gap));
        for (r, state) in laid.rails.iter_mut().enumerate() {
            let own = self.seats.iter().skip(r).step_by(self.count).copied();
            self.rail.step(state, own, &self.lifts, &self.wheels, weight, &mut self.scratch);
        }
    }

    /// Largest static pad force per sleeper [N] for standing wheels, with rail weight and springs
    /// `foundation`; `None` without wheels.
    pub fn static_peaks(&self) -> Option<Vec<f64>> {
        let Waveform::Pass(pass) = &self.load.waveform else { return None };
        let period = self.load.period();
        let steps = (PLACES * pass.distance / self.spacing).ceil();
        let begin = self.load.cycles_begin();
        let places = (0..steps as usize).map(|k| {
            let mut wheels = Vec::new();
            self.load.steady_wheels(begin + k as f64 / steps * period, self.count, &mut wheels);
            wheels
        });
        let forces = self.rail.static_seats(places)?;
        let sleepers = forces.first()?.len();
        let largest = |k: usize| forces.iter().map(|f| f[k]).fold(f64::NEG_INFINITY, f64::max);
        Some((0..sleepers).map(|k| self.count as f64 * largest(k)).collect())
    }
}

impl LaidRails {
    /// DEM step of the rails.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// Downward force of rail `r` on sleeper `k` [N].
    pub fn force(&self, k: usize, r: usize) -> f64 {
        self.rails[r].force(k)
    }

    /// Upward deflection over sleeper `k`, mean of all rails [m].
    pub fn deflection(&self, rails: &Rails, k: usize) -> f64 {
        self.rails.iter().map(|s| s.deflection(&rails.rail, k)).sum::<f64>() / self.rails.len() as f64
    }

    /// Energy of all rails at the grains' half step.
    pub fn energy(&self) -> RailEnergy {
        self.rails.iter().fold(RailEnergy::default(), |sum, s| sum.plus(&s.energy_at_half_step()))
    }

    /// Number of rails.
    pub fn count(&self) -> usize {
        self.rails.len()
    }

    /// Mean initial height of rail `r` [m].
    pub fn mean_height(&self, r: usize) -> f64 {
        let own = self.heights.iter().skip(r).step_by(self.count());
        own.sum::<f64>() / (self.heights.len() / self.count()) as f64
    }

    /// Nodes of rail `r`: distance from the first sleeper, upward deflection [m].
    pub fn line<'a>(&'a self, rails: &'a Rails, r: usize) -> impl Iterator<Item = [f64; 2]> + 'a {
        self.rails[r].line(&rails.rail)
    }
}
