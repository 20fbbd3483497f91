//! Extremes of sleepers during the load cycles.
//!
//! Theory manual: eq. (6.5).

use super::rolling::RollingRecord;
use serde::{Deserialize, Serialize};

/// Rounding, over sleeper weight.
const NEGLIGIBLE: f64 = 1e-9;

#[derive(Clone, Copy, Debug)]
pub(super) struct Observation {
    /// Downward seat force [N].
    pub force: f64,
    /// Height [m].
    pub height: f64,
    /// Upward rail deflection [m].
    pub rail: f64,
    /// Base ends above the middle [m].
    pub bend: f64,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Extremes {
    force: [f64; 2],
    /// Initial and smallest height [m].
    height: [f64; 2],
    /// Largest height [m].
    highest: f64,
    /// Time without contact, first start [s].
    lifted_time: f64,
    lifted: Option<f64>,
    /// Smallest rail deflection [m].
    rail: f64,
    /// Base ends above the middle [m].
    bend: [f64; 2],
}

impl Extremes {
    pub fn start(now: &Observation) -> Extremes {
        Extremes {
            force: [now.force; 2],
            height: [now.height; 2],
            highest: now.height,
            lifted_time: 0.0,
            lifted: None,
            rail: now.rail,
            bend: [now.bend; 2],
        }
    }

    /// Adds a window from `begin` of `duration` [s]; `lifted`: without contact.
    pub fn update(&mut self, now: &Observation, lifted: bool, begin: f64, duration: f64) {
        self.highest = self.highest.max(now.height);
        if lifted {
            self.lifted.get_or_insert(begin);
            self.lifted_time += duration;
        }
        self.force = [self.force[0].min(now.force), self.force[1].max(now.force)];
        self.height[1] = self.height[1].min(now.height);
        self.rail = self.rail.min(now.rail);
        self.bend = [self.bend[0].min(now.bend), self.bend[1].max(now.bend)];
    }

    /// Summary record. `axle`: heaviest axle load [N]; `static_force`: largest force of standing wheels [N].
    pub fn record(
        &self,
        axle: Option<f64>,
        static_force: Option<f64>,
        rail: bool,
        meshed: bool,
    ) -> SleeperRecord {
        SleeperRecord {
            largest_force: self.force[1],
            smallest_force: self.force[0],
            lowering: self.height[0] - self.height[1],
            lifted_off: self.lifted.map(|first| ContactLoss {
                first,
                seconds: self.lifted_time,
                rise: self.highest - self.height[0],
            }),
            load_share: axle.map(|p| self.force[1] / p),
            rail_deflection: rail.then_some(-self.rail),
            static_force,
            dynamic_amplification: static_force.map(|f| self.force[1] / f),
            bend: meshed.then_some(self.bend),
        }
    }
}

/// Detects windows in which seat forces and weight explain the momentum.
#[derive(Default)]
pub(super) struct MomentumCheck {
    from: Option<u64>,
    /// Initial upward speeds [m/s].
    speed: Vec<f64>,
    /// Upward seat impulses [N s].
    impulse: Vec<f64>,
    /// Velocity time increment so far [s].
    duration: f64,
}

impl MomentumCheck {
    pub fn reset(&mut self) {
        self.from = None;
    }

    /// Stores speeds at the first step of a (possibly repeated) window; `kick`: velocity time increment [s].
    pub fn begin(&mut self, step: u64, kick: f64, speeds: impl Iterator<Item = f64>) {
        if self.from.is_none_or(|from| step <= from) {
            self.from = Some(step);
            self.speed.clear();
            self.speed.extend(speeds);
            self.impulse.clear();
            self.impulse.resize(self.speed.len(), 0.0);
            self.duration = 0.0;
        }
        self.duration += kick;
    }

    /// Adds an upward seat impulse [N s].
    pub fn add(&mut self, k: usize, impulse: f64) {
        self.impulse[k] += impulse;
    }

    /// Mean downward seat force of sleeper `k` in the window [N]; none before its first step.
    pub fn mean_force(&self, k: usize) -> Option<f64> {
        self.from?;
        (self.duration > 0.0).then(|| -self.impulse[k] / self.duration)
    }

    /// Whether sleeper `k` had no contact; upward weight `force` [N], upward `speed` [m/s].
    pub fn is_free(&self, k: usize, mass: f64, force: f64, speed: f64) -> bool {
        if self.from.is_none() {
            return false;
        }
        let weight = force * self.duration;
        let gained = mass * (speed - self.speed[k]);
        (gained - self.impulse[k] - weight).abs() <= NEGLIGIBLE * weight.abs()
    }
}

/// Sleeper extremes.
#[derive(Clone, Debug, Serialize)]
pub struct TrackRecord {
    /// In order along the track.
    pub sleepers: Vec<SleeperRecord>,
    /// Vehicles on the rails.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vehicles: Option<RollingRecord>,
}

/// Extremes of one sleeper.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct SleeperRecord {
    /// Largest downward seat force [N].
    pub largest_force: f64,
    /// Smallest seat force [N], negative in uplift.
    pub smallest_force: f64,
    /// Largest settlement since the first cycle [m].
    pub lowering: f64,
    /// Loss of contact, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lifted_off: Option<ContactLoss>,
    /// Largest force over one axle load, with axles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_share: Option<f64>,
    /// Largest downward rail deflection [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rail_deflection: Option<f64>,
    /// Largest force of standing wheels on springs `foundation` [N].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub static_force: Option<f64>,
    /// Largest force over the static one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dynamic_amplification: Option<f64>,
    /// Base ends above the middle, meshed sleeper [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bend: Option<[f64; 2]>,
}

/// Loss of contact of a sleeper.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ContactLoss {
    /// First start [s].
    pub first: f64,
    /// Total time [s].
    pub seconds: f64,
    /// Largest uplift since the first cycle [m].
    pub rise: f64,
}

impl TrackRecord {
    /// Warnings about loss of contact of sleepers and axles, and about contact forces of axles.
    pub fn warnings(&self) -> impl Iterator<Item = String> + '_ {
        let sleepers = self.sleepers.iter().enumerate().filter_map(|(k, s)| {
            let ContactLoss { first, seconds, rise } = s.lifted_off?;
            Some(format!(
                "sleeper {}: without contact for {seconds:.6} s in total, first at t = {first:.6} s; largest uplift {:.3} mm since the first cycle",
                k + 1,
                1e3 * rise
            ))
        });
        sleepers.chain(self.vehicles.iter().flat_map(RollingRecord::warnings))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contact_shows_in_the_momentum() {
        let (mass, gravity, dt, steps) = (100.0, -9.81, 1e-3, 10);
        let mut check = MomentumCheck::default();
        let mut speed = 0.2;
        for k in 0..steps {
            check.begin(5 + k, dt, [if k == 0 { 0.2 } else { 9.0 }].into_iter());
            check.add(0, -300.0 * dt);
            speed += dt * (gravity - 300.0 / mass);
        }
        assert!(check.is_free(0, mass, mass * gravity, speed));
        assert!(!check.is_free(0, mass, mass * gravity, speed + 1e-3 * dt * 10.0 / mass));
        check.reset();
        assert!(!check.is_free(0, mass, mass * gravity, speed), "nothing known of a new window");
    }

    #[test]
    fn reports_uplift_of_sleeper() {
        let at = |height: f64, force: f64| Observation { force, height, rail: 0.0, bend: 0.0 };
        let mut e = Extremes::start(&at(1.0, 5.0));
        e.update(&at(0.998, 9.0), false, 0.0, 0.1);
        e.update(&at(1.003, -2.0), true, 0.1, 0.1);
        e.update(&at(1.002, -1.0), true, 0.2, 0.1);
        let record = e.record(Some(18.0), None, false, false);
        let lift = record.lifted_off.unwrap();
        assert!((lift.first - 0.1).abs() < 1e-15 && (lift.seconds - 0.2).abs() < 1e-15);
        assert!((lift.rise - 0.003).abs() < 1e-12 && (record.lowering - 0.002).abs() < 1e-12);
        assert_eq!((record.largest_force, record.smallest_force, record.load_share), (9.0, -2.0, Some(0.5)));
        assert_eq!((record.rail_deflection, record.bend), (None, None));
        let text = TrackRecord { sleepers: vec![record], vehicles: None }.warnings().next().unwrap();
        assert!(text.contains("first at t = 0.100000 s"), "{text}");
    }
}
