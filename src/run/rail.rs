//! Rails of a running system.
//!
//! Sleepers move by the leapfrog of the grains, rails by Newmark's rule with the same step. At the start of a step the
//! sleepers are known where they are; the rails are brought to that time with the seats there, and their pads push on
//! the sleepers during the step. Both sides of a pad book the same work (see [`rail`](crate::model::track::rail)).

use crate::model::grains::SleeperPlan;
use crate::model::seat_load::{Course, CyclicLoad};
use crate::model::track::rail::{Books, Rail, RailInput, RailState, Scratch, Wheel};
use crate::write::WallFrame;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;

/// Half the width that a rail is drawn with [m].
const HALF_WIDTH: f64 = 0.035;
/// Places of the train that its static effect is sought at, per sleeper spacing.
const PLACES: f64 = 20.0;

/// One rail on each seat.
pub struct Rails {
    rail: Rail,
    spacing: f64,
    /// Rails, as many as a sleeper has seats.
    count: usize,
    load: CyclicLoad,
    scratch: RefCell<(Scratch, Vec<Wheel>, Vec<f64>)>,
}

/// Rails that are laid.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Laid {
    /// Steps of the grains when they were here.
    step: u64,
    /// Heights of the seats when the rails were laid [m]. Shape `[sleepers × rails]`.
    heights: Vec<f64>,
    rails: Vec<RailState>,
}

impl Rails {
    /// `count` rails for steps of `dt` [s]; `None` where the input makes no rail.
    pub fn new(input: RailInput, count: usize, load: CyclicLoad, dt: f64) -> Option<Rails> {
        let spacing = input.spacing;
        Some(Rails { rail: Rail::new(input, dt)?, spacing, count, load, scratch: RefCell::default() })
    }

    /// Lays the rails, straight and without force, on the sleepers as they lie, once their time of rest is over.
    pub fn lay(&self, time: f64, step: u64, heights: impl Iterator<Item = f64>) -> Option<Laid> {
        if time < self.load.rest {
            return None;
        }
        let rails = vec![self.rail.laid(); self.count];
        Some(Laid { step, heights: heights.collect(), rails })
    }

    /// Brings the rails to the time of the grains, a step later; does nothing where they are there already.
    pub fn advance(&self, laid: &mut Laid, time: f64, step: u64, heights: impl Iterator<Item = f64>) {
        if laid.step == step {
            return;
        }
        debug_assert_eq!(laid.step + 1, step);
        laid.step = step;
        let (scratch, wheels, seats) = &mut *self.scratch.borrow_mut();
        self.load.wheels(time, self.count, wheels);
        seats.clear();
        seats.extend(heights.zip(&laid.heights).map(|(now, then)| now - then));
        let weight = self.load.brought_on(time);
        for (r, state) in laid.rails.iter_mut().enumerate() {
            let own = seats.iter().skip(r).step_by(self.count).copied();
            self.rail.step(state, own, wheels, weight, scratch);
        }
    }

    /// Largest force of each sleeper's pads [N] while the wheels stand still at one place after the other, on a bed of
    /// the scene's `foundation` everywhere; with the rail's weight.
    pub fn static_peaks(&self) -> Option<Vec<f64>> {
        let Course::Pass(pass) = &self.load.course else { return None };
        let period = self.load.period();
        let steps = (PLACES * pass.way / self.spacing).ceil();
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

impl Laid {
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

    /// Books of all rails at the instant of the grains' books.
    pub fn books(&self) -> Books {
        self.rails.iter().fold(Books::default(), |sum, s| sum.plus(&s.half_step_back()))
    }

    /// Adds a ribbon for each rail, from half a spacing before the first sleeper to half a spacing behind the last.
    pub fn draw(&self, rails: &Rails, plan: &SleeperPlan, frame: &mut WallFrame) {
        let along = plan.axis;
        let first = plan.centres[0];
        let [from, to] = [-0.5, plan.centres.len() as f64 - 0.5].map(|k| k * rails.spacing);
        for (r, state) in self.rails.iter().enumerate() {
            let seat = plan.seats[r];
            let id = frame.id.last().map_or(0, |id| id + 1);
            let own = self.heights.iter().skip(r).step_by(self.count());
            let height = own.sum::<f64>() / plan.centres.len() as f64;
            let mut last: Option<u32> = None;
            for [x, w] in state.line(&rails.rail).filter(|p| p[0] >= from - 1e-9 && p[0] <= to + 1e-9) {
                let begin = frame.points.len() as u32;
                for side in [-HALF_WIDTH, HALF_WIDTH] {
                    let mut point = [first[0] + seat[0], first[1] + seat[1], height + w];
                    point[along] += x;
                    point[1 - along] += side;
                    frame.points.push(point);
                }
                if let Some(before) = last {
                    frame.polygons.push(vec![before, before + 1, begin + 1, begin]);
                    frame.id.push(id);
                }
                last = Some(begin);
            }
        }
    }

    fn count(&self) -> usize {
        self.rails.len()
    }
}
