//! [Rails](super::rail) over moving sleepers, one per seat.

use super::load::{CyclicLoad, Waveform};
use super::rail::{Rail, RailEnergy, RailInput, RailScratch, RailState, Wheel};
use super::rolling::{Rolling, RollingInput, RollingRecord, RollingState};
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
    rolling: Option<Rolling>,
    /// Shape `[rails]`.
    scratch: Vec<RailScratch>,
    /// Given wheels; wheels of vehicles on each rail.
    wheels: Vec<Wheel>,
    rolled: Vec<Vec<Wheel>>,
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
    rolling: Option<RollingState>,
}

impl Rails {
    /// `count` rails for steps of `dt` [s]; `gaps` [m] by sleeper; axles of `vehicles`, if any; `None` for
    /// invalid input.
    pub fn new(
        input: RailInput,
        count: usize,
        gaps: &[f64],
        load: CyclicLoad,
        vehicles: Option<&RollingInput>,
        dt: f64,
    ) -> Option<Rails> {
        let (spacing, rail, gaps) = (input.spacing, Rail::new(input, dt)?, gaps.to_vec());
        let rolling = match vehicles {
            Some(input) => Some(Rolling::new(input.clone(), &rail, count, &load)?),
            None => None,
        };
        let (scratch, rolled) = (vec![RailScratch::default(); count], vec![Vec::new(); count]);
        let (wheels, seats, lifts) = Default::default();
        Some(Rails { rail, spacing, count, load, gaps, rolling, scratch, wheels, rolled, seats, lifts })
    }

    /// Sleeper spacing [m].
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Number of axles of vehicles.
    pub fn axles(&self) -> usize {
        self.rolling.as_ref().map_or(0, Rolling::axles)
    }

    /// Places straight, force-free rails on the sleepers after the rest.
    pub fn lay(&self, time: f64, step: u64, heights: impl Iterator<Item = f64>) -> Option<LaidRails> {
        if time < self.load.rest {
            return None;
        }
        let rails = vec![self.rail.laid(); self.count];
        let rolling = self.rolling.as_ref().map(Rolling::standing);
        Some(LaidRails { step, heights: heights.collect(), rails, rolling })
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
        if self.rolling.is_none() {
            self.load.wheels(time, self.count, &mut self.wheels);
        }
        self.seats.clear();
        self.seats.extend(heights.zip(&laid.heights).map(|(now, then)| now - then));
        let weight = self.load.applied_share(time);
        self.lifts.clear();
        self.lifts.extend(self.gaps.iter().map(|gap| weight * gap));
        for ((r, state), scratch) in laid.rails.iter_mut().enumerate().zip(&mut self.scratch) {
            let own = self.seats.iter().skip(r).step_by(self.count).copied();
            self.rail.begin_step(state, own, &self.lifts, &self.wheels, weight, scratch);
        }
        if let (Some(rolling), Some(state)) = (&mut self.rolling, &mut laid.rolling) {
            let rails = (&laid.rails[..], &mut self.scratch[..]);
            rolling.advance(state, &self.load, time, &self.rail, rails, &mut self.rolled);
        }
        for ((state, scratch), rolled) in laid.rails.iter_mut().zip(&mut self.scratch).zip(&self.rolled) {
            self.rail.end_step(state, &self.lifts, rolled, scratch);
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

    /// Forces of the axles of vehicles on the track, both rails together [N].
    pub fn axle_forces<'a>(&'a self, rails: &'a Rails) -> impl Iterator<Item = f64> + 'a {
        let rolling = rails.rolling.as_ref().zip(self.rolling.as_ref());
        rolling.into_iter().flat_map(|(r, state)| (0..r.axles()).map(|i| r.axle_force(state, i)))
    }

    /// Results of the vehicles.
    pub fn vehicles(&self, rails: &Rails) -> Option<RollingRecord> {
        rails.rolling.as_ref()?.record(self.rolling.as_ref()?)
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
