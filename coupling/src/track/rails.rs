//! Rails over sleepers that move: one [rail](super::rail) on each seat.
//!
//! Sleepers move by the leapfrog of the grains, rails by Newmark's rule with the same step. At the start of a step the
//! sleepers are known where they are; the rails are brought to that time with the seats there, and their pads push on
//! the sleepers during the step. Both sides of a pad account for the same work (see [`rail`](super::rail)).

use super::load::{CyclicLoad, Waveform};
use super::rail::{Rail, RailEnergy, RailInput, RailScratch, RailState, Wheel};
use serde::{Deserialize, Serialize};

/// Places of the train for which its static effect is computed, per sleeper spacing.
const PLACES: f64 = 20.0;

/// One rail on each seat.
pub struct Rails {
    rail: Rail,
    spacing: f64,
    /// Rails, as many as a sleeper has seats.
    count: usize,
    load: CyclicLoad,
    scratch: RailScratch,
    wheels: Vec<Wheel>,
    seats: Vec<f64>,
}

/// Rails in place, with their motion.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LaidRails {
    /// Steps of the grains when they were here.
    step: u64,
    /// Heights of the seats when the rails were laid [m]. Shape `[sleepers × rails]`.
    heights: Vec<f64>,
    rails: Vec<RailState>,
}

impl Rails {
    /// `count` rails for steps of `dt` [s]; `None` where the input makes no rail.
    pub fn new(input: RailInput, count: usize, load: CyclicLoad, dt: f64) -> Option<Rails> {
        let (spacing, rail) = (input.spacing, Rail::new(input, dt)?);
        let (scratch, wheels, seats) = Default::default();
        Some(Rails { rail, spacing, count, load, scratch, wheels, seats })
    }

    /// Distance of the sleepers [m].
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Lays the rails, straight and without force, on the sleepers as they lie, once their time of rest is over.
    pub fn lay(&self, time: f64, step: u64, heights: impl Iterator<Item = f64>) -> Option<LaidRails> {
        if time < self.load.rest {
            return None;
        }
        let rails = vec![self.rail.laid(); self.count];
        Some(LaidRails { step, heights: heights.collect(), rails })
    }

    /// Advances the rails to the time of the grains, a step of `dt` [s] later; does nothing where they are there already.
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
        for (r, state) in laid.rails.iter_mut().enumerate() {
            let own = self.seats.iter().skip(r).step_by(self.count).copied();
            self.rail.step(state, own, &self.wheels, weight, &mut self.scratch);
        }
    }

    /// Largest force of each sleeper's pads [N] while the wheels stand still at one place after the other, on a bed of
    /// the rail's `foundation` everywhere; with the rail's weight. None without wheels.
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
    /// Steps of the grains when the rails were here.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// Downward force of rail `r` on sleeper `k` [N].
    pub fn force(&self, k: usize, r: usize) -> f64 {
        self.rails[r].force(k)
    }

    /// Deflection over sleeper `k`, upwards, mean of all rails [m].
    pub fn deflection(&self, rails: &Rails, k: usize) -> f64 {
        self.rails.iter().map(|s| s.deflection(&rails.rail, k)).sum::<f64>() / self.rails.len() as f64
    }

    /// Account of energy of all rails at the instant of the grains' account.
    pub fn energy(&self) -> RailEnergy {
        self.rails.iter().fold(RailEnergy::default(), |sum, s| sum.plus(&s.energy_at_half_step()))
    }

    /// Number of rails.
    pub fn count(&self) -> usize {
        self.rails.len()
    }

    /// Mean height of rail `r` when it was laid [m].
    pub fn mean_height(&self, r: usize) -> f64 {
        let own = self.heights.iter().skip(r).step_by(self.count());
        own.sum::<f64>() / (self.heights.len() / self.count()) as f64
    }

    /// Nodes of rail `r`: distance along the track from the first sleeper, deflection upwards [m].
    pub fn line<'a>(&'a self, rails: &'a Rails, r: usize) -> impl Iterator<Item = [f64; 2]> + 'a {
        self.rails[r].line(&rails.rail)
    }
}
