//! Cycle jumps: settlement extrapolated with the logarithm of the number of cycles.
//!
//! Rounds of a simulated *stretch*, comparison with the predicted slope b = ds/d(ln N), and a jump. Relative
//! to N it doubles if the last error is within the tolerance, else halves.
//!
//! * `extrapolate`: grains stay; settlement is the measured one plus b ln(N/n), n the age of the bed. Error: by
//!   forecasts of the simulated cycles (`extrapolation`).
//! * `displace`: bodies are displaced along their drift, limited by the change of overlaps; recovery cycles
//!   do not count. Errors after each stretch are summed.
//!
//! Jumps wait after steps of the settlement, changes of the resilient deflection and broken bonds, and are shorter
//! where the slope changes (`change`). Not supported: changing loads. Theory manual: eqs. (6.24), (6.25), (6.26), (6.27).

use super::change::{self, Change};
use super::cycles::CycleRecorder;
use super::extrapolation::{self, Forecast, WINDOW};
use super::system::TrackSystem;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use trackbed_dem as dem;
use trackbed_dem::Partner;
use trackbed_dem::integrate::rotation;

/// First jump over the largest one.
const START: f64 = 0.25;
/// Smallest stretch of `extrapolate` over simulated cycles.
const STRETCH: f64 = 0.1;

/// Parameters of cycle jumps.
#[derive(Clone, Copy, Debug)]
pub struct CycleJumpOptions {
    /// Displace the grains.
    pub grains: bool,
    /// Simulated cycles before the first jump.
    pub first: u32,
    /// Cycles of a measured stretch.
    pub measure: u32,
    /// Recovery cycles after a jump.
    pub settle: u32,
    /// Relative error up to which jumps grow.
    pub tolerance: f64,
    /// Largest jump over the cycles before it.
    pub largest: f64,
    /// Largest mean relative change of overlaps.
    pub overlap: f64,
}

impl CycleJumpOptions {
    /// Simulated of `total` cycles, if all errors are within the tolerance and no jump is limited.
    pub fn fewest_simulated(&self, total: u32) -> u32 {
        let (mut number, mut simulated, mut growth) = (self.first, self.first, START * self.largest);
        while number < total {
            let stretch = self.stretch(simulated);
            let room = (total - number).saturating_sub(self.settle + stretch);
            number += ((growth * f64::from(number)) as u32).min(room);
            let left = (self.settle + stretch).min(total - number);
            (number, simulated) = (number + left, simulated + left);
            growth = (2.0 * growth).min(self.largest);
        }
        simulated
    }

    /// Measured cycles after `simulated`.
    fn stretch(&self, simulated: u32) -> u32 {
        let share = if self.grains { 0.0 } else { STRETCH * f64::from(simulated) };
        self.measure.max(share as u32)
    }
}

/// One jump.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct JumpRecord {
    /// Last cycle before it.
    pub from: u32,
    /// Skipped cycles.
    pub cycles: u32,
    /// Predicted slope ds/d(ln N) [m].
    pub predicted_slope: f64,
    /// Slope of the next stretch [m].
    pub measured_slope: Option<f64>,
    /// Estimated settlement error [m]: of this jump (`displace`), or of all so far (`extrapolate`).
    pub error: f64,
    /// Mean relative change of overlaps; `displace` only.
    pub overlap_change: Option<f64>,
}

/// Jump that waits, because the cycles before it follow no single law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DelayRecord {
    /// Last cycle before it.
    pub cycle: u32,
    /// Reason.
    pub reason: String,
}

/// Results of a run with jumps.
#[derive(Clone, Debug, Serialize)]
pub struct JumpSummary {
    /// `"extrapolate"` or `"displace"`.
    pub method: &'static str,
    /// Simulated cycles.
    pub simulated: u32,
    /// Skipped cycles.
    pub skipped: u32,
    /// Estimated error of the last settlement [m].
    pub error_estimate: f64,
    /// The same, relative.
    pub relative_error_estimate: f64,
    /// Energy added by jumps [J].
    pub energy: f64,
    /// Jumps.
    pub jumps: Vec<JumpRecord>,
    /// Forecasts of the last simulated cycle from earlier ones; `extrapolate` only.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub forecasts: Vec<Forecast>,
    /// Jumps that a change delayed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub delays: Vec<DelayRecord>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Phase {
    /// Before the first stretch, or recovery.
    Wait(u32),
    /// Measured cycles.
    Stretch(u32),
    /// No further jump.
    Over,
}

/// Centre and orientation per body.
type BodyPoses = Vec<(dem::Vec3, UnitQuaternion<f64>)>;

/// Jump controller, part of checkpoints.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CycleJumper {
    phase: Phase,
    /// Next jump over the cycles before it.
    growth: f64,
    /// At the start of the stretch; `stretch_start`: age, settlement.
    places: BodyPoses,
    stretch_start: [f64; 2],
    /// Age, settlement and predicted slope at the last jump.
    predicted: Option<[f64; 3]>,
    /// Jumps so far.
    pub jumps: Vec<JumpRecord>,
    /// Delays so far.
    delays: Vec<DelayRecord>,
    /// Broken bonds and bodies at the start of the stretch.
    broken: usize,
    bodies: usize,
}

impl CycleJumper {
    /// Controller at the start of a run.
    pub fn new(plan: &CycleJumpOptions) -> CycleJumper {
        CycleJumper {
            phase: Phase::Wait(plan.first - plan.measure),
            growth: START * plan.largest,
            places: Vec::new(),
            stretch_start: [0.0; 2],
            predicted: None,
            jumps: Vec::new(),
            delays: Vec::new(),
            broken: 0,
            bodies: 0,
        }
    }

    /// Continues after a cycle; returns whether bodies were displaced.
    pub fn after_cycle<S: TrackSystem>(
        &mut self,
        plan: &CycleJumpOptions,
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
                self.check_prediction(plan, cycles);
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

    fn begin<S: TrackSystem>(&mut self, plan: &CycleJumpOptions, cycles: &mut CycleRecorder, system: &S) {
        if let (true, Some(g)) = (plan.grains, system.grains()) {
            self.places = (0..g.model.body_count())
                .map(|b| match g.state.present(b) {
                    true => (g.state.position(b), g.state.orientation(g.model, b)),
                    false => (dem::Vec3::zeros(), UnitQuaternion::identity()),
                })
                .collect();
        }
        self.stretch_start = cycles.latest;
        self.broken = broken_bonds(system);
        self.bodies = bodies(system);
        cycles.counting = true;
        let left = plan.stretch(cycles.simulated());
        let room = cycles.total() - cycles.number();
        self.phase = if room < left { Phase::Over } else { Phase::Stretch(left) };
    }

    fn check_prediction(&mut self, plan: &CycleJumpOptions, cycles: &mut CycleRecorder) {
        let (now, Some([age, settlement, slope])) = (cycles.latest, self.predicted) else { return };
        let measured = (now[1] - self.stretch_start[1]) / libm::log(now[0] / self.stretch_start[0]);
        let Some(last) = self.jumps.last_mut() else { return };
        last.measured_slope = Some(measured);
        // Error in settlement (grains displaced) or by the slope.
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

    /// Returns whether bodies were displaced.
    fn jump<S: TrackSystem>(
        &mut self,
        plan: &CycleJumpOptions,
        cycles: &mut CycleRecorder,
        system: &mut S,
    ) -> bool {
        let [age, settlement] = cycles.latest;
        let number = f64::from(cycles.number());
        let Some(fit) = extrapolation::slope(&cycles.measured).filter(|f| f.slope > 0.0) else {
            return false;
        };
        // A tenth of the cycles also after displacements: it checks the last one.
        let reserve = plan.settle + plan.measure.max((STRETCH * f64::from(cycles.simulated())) as u32);
        let room = (cycles.total() - cycles.number()).saturating_sub(reserve);
        if room == 0 {
            return false;
        }
        // The error of the last displacement is no change.
        let jumped = self.jumps.last().filter(|_| plan.grains).map_or(0, |j| j.from + j.cycles);
        let begun = f64::from(jumped).max(WINDOW * age);
        let broken = broken_bonds(system) > self.broken;
        let event = match bodies(system) == self.bodies {
            true => broken.then_some("bonds broke"),
            false => Some("grains left"),
        };
        let growth = match change::of(cycles, begun, plan.tolerance * settlement.abs(), event) {
            None => self.growth,
            Some(Change::Turn(span)) => self.growth.min(libm::expm1(span)),
            Some(Change::Break(reason)) => {
                self.delays.push(DelayRecord { cycle: cycles.number(), reason: reason.into() });
                return false;
            }
        };
        let mut skipped = ((growth * number) as u32).min(room);
        let mut change = None;
        let mut moves = Vec::new();
        if plan.grains {
            let Some(drift) = Drift::of(&self.places, system) else { return false };
            let own = (settlement - self.stretch_start[1]) / libm::log(age / self.stretch_start[0]);
            // Uplift or small settlement gives no reliable drift direction.
            if own < 0.25 * fit.slope {
                return false;
            }
            let whole = |n: u32| {
                fit.slope * libm::log(1.0 + f64::from(n) / number) / (settlement - self.stretch_start[1])
            };
            let most = plan.overlap / drift.overlap_change;
            if whole(skipped) > most {
                let ratio = libm::expm1(most * (settlement - self.stretch_start[1]) / fit.slope);
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
            error = extrapolation::error(&cycles.measured, &fit, beyond);
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
        // Displaced grains age with the cycle number.
        self.predicted = Some([age, settlement, fit.slope]);
        plan.grains
    }

    /// Summary.
    pub fn summary(&self, plan: &CycleJumpOptions, cycles: &CycleRecorder, energy: f64) -> JumpSummary {
        let settlement = cycles.done.last().map_or(0.0, |c| c.settlement);
        JumpSummary {
            method: if plan.grains { "displace" } else { "extrapolate" },
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
            forecasts: if plan.grains { Vec::new() } else { extrapolation::forecasts(&cycles.measured) },
            delays: self.delays.clone(),
        }
    }
}

fn bodies<S: TrackSystem>(system: &S) -> usize {
    system.grains().map_or(0, |g| g.state.present_count())
}

fn broken_bonds<S: TrackSystem>(system: &S) -> usize {
    system.grains().map_or(0, |g| g.state.breaks().len())
}

/// Body motion through a stretch.
struct Drift {
    /// Displacement [m] and rotation [rad] per body.
    motion: Vec<(dem::Vec3, dem::Vec3)>,
    /// Mean relative change of overlaps for a repeated drift.
    overlap_change: f64,
}

impl Drift {
    fn of<S: TrackSystem>(places: &BodyPoses, system: &S) -> Option<Drift> {
        let g = system.grains()?;
        let motion: Vec<(dem::Vec3, dem::Vec3)> = places
            .iter()
            .enumerate()
            .map(|(b, (x, q))| {
                // Bodies that left do not move.
                if !g.state.present(b) {
                    return Default::default();
                }
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
            // The order of contacts is thread-independent.
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
        // Rattlers have no drift.
        let motion = motion
            .into_iter()
            .enumerate()
            .map(|(b, m)| if known.get(&b).is_some_and(|n| *n >= 3) { m } else { Default::default() })
            .collect();
        Some(Drift { motion, overlap_change: change / overlap })
    }

    fn moves(&self, factor: f64) -> Vec<(usize, dem::Vec3, UnitQuaternion<f64>)> {
        let on = |(b, (shift, turn)): (usize, &(dem::Vec3, dem::Vec3))| {
            (b, shift * factor, rotation::by(&(turn * factor)))
        };
        let moving = self.motion.iter().enumerate().filter(|(_, motion)| **motion != Default::default());
        moving.map(on).collect()
    }
}

#[cfg(test)]
#[path = "cycle_jump_tests.rs"]
mod tests;
