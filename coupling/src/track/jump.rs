//! Cycle jumps: most cycles of a long load are not simulated one by one.
//!
//! Settlement grows with the logarithm of the number of cycles, so the rate of N cycles predicts that of the next ΔN:
//! together they settle b ln(1 + ΔN/N), b the slope ds/d(ln N) of the last simulated cycles. The controller runs in rounds. A
//! *stretch* of cycles is simulated and its slope compared with the one predicted before the last jump; then follows the next
//! jump, relative to N twice as long if the error of the last one is within the tolerance, half as long if not.
//!
//! * `account`: the grains stay, and the settlement of the row is the measured one plus b ln(N/n), n the age of the bed. Each
//!   stretch makes the bed older and b new. Its error is estimated as ln(N/n) times two standard errors of b and that of b by
//!   the stretches that were predicted.
//! * `grains`: every body is moved on along its drift through the last stretch, scaled to the settlement b ln(1 + ΔN/N), as
//!   far as the overlaps change by a given share of their mean; then some cycles run whose rate does not count. The error of
//!   a jump is the difference of the settlement after the next stretch from the logarithm; errors add up. Contact springs stay:
//!   the next step turns them into their new planes and cuts them at the friction limit. The energy that a jump brings
//!   in has a term of its own in the account.
//!
//! Limits: a bed that breaks, or whose load changes, has no such logarithm. Driven walls are not moved.
//!
//! Theory manual: equations (6.24), (6.25), (6.26), (6.27) of `docs/theory/track.md`.

use super::cycles::CycleRecorder;
use super::settlement;
use super::system::TrackSystem;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use trackbed_dem as dem;
use trackbed_dem::Partner;
use trackbed_dem::integrate::rotation;

/// First jump over the largest one.
const START: f64 = 0.25;
/// Share of all simulated cycles that a stretch of `account` has at least.
const STRETCH: f64 = 0.1;
/// The slope is that of the cycles from this share of the last one on.
const WINDOW: f64 = 0.25;

/// Cycles that are not simulated one by one.
#[derive(Clone, Copy, Debug)]
pub struct JumpPlan {
    /// Whether the grains are moved; otherwise only the account goes on.
    pub grains: bool,
    /// Cycles simulated before the first jump.
    pub first: u32,
    /// Cycles of a stretch whose rate is measured.
    pub measure: u32,
    /// Cycles after a jump whose rate does not count.
    pub settle: u32,
    /// Error of a jump over the settlement up to which the next jump is longer.
    pub tolerance: f64,
    /// Largest jump over the cycles before it.
    pub largest: f64,
    /// Share by which a jump may change the overlaps in the mean.
    pub overlap: f64,
}

/// One jump, for the summary.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct JumpRecord {
    /// Last cycle before it.
    pub from: u32,
    /// Cycles jumped over.
    pub cycles: u32,
    /// Slope predicted, ds/d(ln N) [m].
    pub predicted_slope: f64,
    /// Slope of the stretch after it [m]; none when the run ended first.
    pub measured_slope: Option<f64>,
    /// Estimated error of the settlement: by this jump (`grains`), or of all so far (`account`) [m].
    pub error: f64,
    /// Share by which the jump was to change the overlaps in the mean; `grains` only.
    pub overlap_change: Option<f64>,
}

/// Results of a run with jumps.
#[derive(Clone, Debug, Serialize)]
pub struct JumpSummary {
    /// `"account"` or `"grains"`.
    pub method: &'static str,
    /// Cycles simulated.
    pub simulated: u32,
    /// Cycles jumped over.
    pub skipped: u32,
    /// Estimated error of the last settlement [m].
    pub error_estimate: f64,
    /// The same over that settlement.
    pub relative_error_estimate: f64,
    /// Energy that the jumps brought in [J].
    pub energy: f64,
    /// The jumps.
    pub jumps: Vec<JumpRecord>,
}

/// Purpose of the present cycles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Phase {
    /// Cycles before the first stretch, and those after a jump whose rate does not count.
    Wait(u32),
    /// Cycles whose rate is measured.
    Stretch(u32),
    /// No jump is left.
    Over,
}

/// Body by body: centre and orientation.
type Places = Vec<(dem::Vec3, UnitQuaternion<f64>)>;

/// The controller of a run with jumps; all of it goes into a checkpoint.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Jumper {
    phase: Phase,
    /// Next jump over the cycles before it.
    growth: f64,
    /// Places of the bodies, age of the bed and settlement when the stretch began.
    places: Places,
    begun: [f64; 2],
    /// Age and settlement when the last jump was made, and the slope predicted.
    predicted: Option<[f64; 3]>,
    /// The jumps so far.
    pub jumps: Vec<JumpRecord>,
}

impl Jumper {
    /// The controller at the start of a run.
    pub fn new(plan: &JumpPlan) -> Jumper {
        Jumper {
            phase: Phase::Wait(plan.first - plan.measure),
            growth: START * plan.largest,
            places: Vec::new(),
            begun: [0.0; 2],
            predicted: None,
            jumps: Vec::new(),
        }
    }

    /// After a simulated cycle: goes on in the round, and jumps when it is time. Returns whether bodies were moved.
    pub fn after_cycle<S: TrackSystem>(
        &mut self,
        plan: &JumpPlan,
        cycles: &mut CycleRecorder,
        system: &mut S,
    ) -> bool {
        match self.phase {
            Phase::Over => false,
            Phase::Wait(left) if left > 1 => {
                self.phase = Phase::Wait(left - 1);
                false
            }
            Phase::Wait(_) => {
                self.begin(plan, cycles, system);
                false
            }
            Phase::Stretch(left) if left > 1 => {
                self.phase = Phase::Stretch(left - 1);
                false
            }
            Phase::Stretch(_) => {
                self.judge(plan, cycles);
                let moved = self.jump(plan, cycles, system);
                if plan.settle == 0 || !moved {
                    self.begin(plan, cycles, system);
                } else {
                    self.phase = Phase::Wait(plan.settle);
                }
                moved
            }
        }
    }

    /// Begins a stretch.
    fn begin<S: TrackSystem>(&mut self, plan: &JumpPlan, cycles: &mut CycleRecorder, system: &S) {
        if let (true, Some(g)) = (plan.grains, system.grains()) {
            self.places = (0..g.model.body_count())
                .map(|b| (g.state.position(b), g.state.orientation(g.model, b)))
                .collect();
        }
        self.begun = cycles.latest;
        cycles.counting = true;
        let share = if plan.grains { 0.0 } else { STRETCH * f64::from(cycles.simulated()) };
        let left = plan.measure.max(share as u32);
        // The last cycles are simulated without another jump.
        let room = cycles.total() - cycles.number();
        self.phase = if room < left { Phase::Over } else { Phase::Stretch(left) };
    }

    /// Compares a stretch with the prediction.
    fn judge(&mut self, plan: &JumpPlan, cycles: &mut CycleRecorder) {
        let (now, Some([age, settlement, slope])) = (cycles.latest, self.predicted) else { return };
        let measured = (now[1] - self.begun[1]) / libm::log(now[0] / self.begun[0]);
        let Some(last) = self.jumps.last_mut() else { return };
        last.measured_slope = Some(measured);
        // Error of the jump: in settlement where the grains were moved, by the slope where they were not.
        let found = if plan.grains {
            last.error = (now[1] - settlement - slope * libm::log(now[0] / age)).abs();
            cycles.jump_error += last.error;
            last.error
        } else {
            (measured - slope).abs() * libm::log1p(f64::from(last.cycles) / f64::from(last.from))
        };
        let good = found <= plan.tolerance * cycles.done.last().map_or(0.0, |c| c.settlement.abs());
        self.growth = if good { (2.0 * self.growth).min(plan.largest) } else { 0.5 * self.growth };
        self.predicted = None;
    }

    /// Jumps, if the last cycles determine a slope; whether bodies were moved.
    fn jump<S: TrackSystem>(&mut self, plan: &JumpPlan, cycles: &mut CycleRecorder, system: &mut S) -> bool {
        let [age, settlement] = cycles.latest;
        let number = f64::from(cycles.number());
        let Some(fit) = settlement::slope(&cycles.measured, WINDOW * age).filter(|f| f.slope > 0.0) else {
            return false;
        };
        let reserve = plan.settle + plan.measure.max((STRETCH * f64::from(cycles.simulated())) as u32);
        let room = (cycles.total() - cycles.number()).saturating_sub(reserve);
        let mut skipped = ((self.growth * number) as u32).min(room);
        let mut change = None;
        let mut moves = Vec::new();
        if plan.grains {
            let Some(drift) = Drift::of(&self.places, system) else { return false };
            let own = (settlement - self.begun[1]) / libm::log(age / self.begun[0]);
            // Drift of a stretch that went up, or hardly down, has no reliable direction.
            if own < 0.25 * fit.slope {
                return false;
            }
            let whole =
                |n: u32| fit.slope * libm::log(1.0 + f64::from(n) / number) / (settlement - self.begun[1]);
            let most = plan.overlap / drift.overlap_change;
            if whole(skipped) > most {
                let ratio = libm::expm1(most * (settlement - self.begun[1]) / fit.slope);
                skipped = skipped.min((ratio * number) as u32);
            }
            change = Some(whole(skipped) * drift.overlap_change);
            moves = drift.moves(whole(skipped));
        }
        if skipped == 0 {
            return false;
        }
        let mut error = 0.0;
        if !plan.grains {
            let beyond = libm::log((number + f64::from(skipped)) / age);
            error = (2.0 * fit.error + self.slope_error()) * beyond;
            cycles.jump_error = error;
        }
        cycles.skip(skipped, if plan.grains { 0.0 } else { fit.slope });
        cycles.counting = !plan.grains;
        system.relocate(&moves);
        self.jumps.push(JumpRecord {
            from: number as u32,
            cycles: skipped,
            predicted_slope: fit.slope,
            measured_slope: None,
            error,
            overlap_change: change,
        });
        // The age goes on from here: with the number where the grains were moved, as before where they were not.
        self.predicted = Some([age, settlement, fit.slope]);
        plan.grains
    }

    /// Standard error of the slope by the stretches that were predicted: root of the sum of squared misses over their
    /// number [m].
    fn slope_error(&self) -> f64 {
        let miss = |j: &JumpRecord| j.measured_slope.map(|m| (m - j.predicted_slope).powi(2));
        let misses: Vec<f64> = self.jumps.iter().filter_map(miss).collect();
        misses.iter().sum::<f64>().sqrt() / misses.len().max(1) as f64
    }

    /// For the summary.
    pub fn summary(&self, plan: &JumpPlan, cycles: &CycleRecorder, energy: f64) -> JumpSummary {
        let settlement = cycles.done.last().map_or(0.0, |c| c.settlement);
        JumpSummary {
            method: if plan.grains { "grains" } else { "account" },
            simulated: cycles.simulated(),
            skipped: cycles.number() - cycles.simulated(),
            error_estimate: cycles.jump_error,
            relative_error_estimate: if settlement == 0.0 {
                0.0
            } else {
                cycles.jump_error / settlement.abs()
            },
            energy,
            jumps: self.jumps.clone(),
        }
    }
}

/// How the bodies moved through a stretch.
struct Drift {
    /// Shift [m] and turn [rad] of each body.
    motion: Vec<(dem::Vec3, dem::Vec3)>,
    /// Mean change of the overlaps over their mean, if the bodies moved on as far again.
    overlap_change: f64,
}

impl Drift {
    fn of<S: TrackSystem>(places: &Places, system: &S) -> Option<Drift> {
        let g = system.grains()?;
        let motion: Vec<(dem::Vec3, dem::Vec3)> = places
            .iter()
            .enumerate()
            .map(|(b, (x, q))| {
                let turn = g.state.orientation(g.model, b) * q.inverse();
                (g.state.position(b) - x, rotation::vector(&turn))
            })
            .collect();
        let at =
            |b: usize, point: &dem::Vec3| motion[b].0 + motion[b].1.cross(&(point - g.state.position(b)));
        let (mut change, mut overlap, mut known) = (0.0, 0.0, HashMap::new());
        for c in dem::measure::contacts(g.model, g.state) {
            let other = match c.b {
                Partner::Body(b) => at(b, &c.point),
                _ => dem::Vec3::zeros(),
            };
            // Summed in the order of the contacts, which does not depend on the threads.
            change += (at(c.a, &c.point) - other).dot(&c.normal).abs();
            overlap += c.overlap;
            *known.entry(c.a).or_insert(0_u32) += 1;
            if let Partner::Body(b) = c.b {
                *known.entry(b).or_insert(0) += 1;
            }
        }
        if overlap <= 0.0 {
            return None;
        }
        // A stone that is held by too few contacts rattles: it goes nowhere.
        let motion = motion
            .into_iter()
            .enumerate()
            .map(|(b, m)| if known.get(&b).is_some_and(|n| *n >= 3) { m } else { Default::default() })
            .collect();
        Some(Drift { motion, overlap_change: change / overlap })
    }

    /// Each body moved on by so many times the stretch.
    fn moves(&self, factor: f64) -> Vec<(usize, dem::Vec3, UnitQuaternion<f64>)> {
        let on = |(b, (shift, turn)): (usize, &(dem::Vec3, dem::Vec3))| {
            (b, shift * factor, rotation::by(&(turn * factor)))
        };
        self.motion.iter().enumerate().map(on).collect()
    }
}

#[cfg(test)]
#[path = "jump_tests.rs"]
mod tests;
