//! Extremes of sleepers while the load cycles last: forces, lowering, loss of contact, bending.
//!
//! Theory manual: equation (6.5) of `docs/theory/track.md`.

use serde::{Deserialize, Serialize};

/// Share of a sleeper's weight below which a contact force is rounding.
const NEGLIGIBLE: f64 = 1e-9;

/// A sleeper at the end of a window.
#[derive(Clone, Copy, Debug)]
pub(super) struct Observation {
    /// Downward force on its seats [N].
    pub force: f64,
    /// Height [m].
    pub height: f64,
    /// Deflection of the rail over it, upwards [m].
    pub rail: f64,
    /// Rise of the ends of a meshed sleeper's base over its middle [m].
    pub bend: f64,
}

/// Extremes of a sleeper while the load cycles last.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Extremes {
    force: [f64; 2],
    /// Height when the cycles began, and the least since [m].
    height: [f64; 2],
    /// Greatest height since [m].
    highest: f64,
    /// Time without any contact force, and when that first began [s].
    lifted_time: f64,
    lifted: Option<f64>,
    /// Least deflection of the rail over it [m].
    rail: f64,
    /// Least and largest rise of a meshed sleeper's ends over its middle [m].
    bend: [f64; 2],
}

impl Extremes {
    /// At the beginning of the cycles.
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

    /// A window from `begin` of length `duration` [s], in which no contact carried the sleeper where it was `lifted`.
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

    /// For the summary. `axle` is the load of the heaviest axle [N], `static_force` the largest force of wheels that stand still
    /// [N]; `rail` and `meshed` whether there is a rail with mass and whether the sleeper consists of elements.
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
            lifted_off: self.lifted.map(|first| LiftOff {
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

/// What shows whether contacts carry a sleeper in the present window: what its momentum would be without contacts.
#[derive(Default)]
pub(super) struct MomentumCheck {
    /// Step at which the window began.
    from: Option<u64>,
    /// Upward speed of each sleeper then [m/s].
    speed: Vec<f64>,
    /// Upward impulse of its seats since [N s].
    impulse: Vec<f64>,
    /// Time by which velocities have advanced [s].
    duration: f64,
}

impl MomentumCheck {
    /// A new window begins.
    pub fn reset(&mut self) {
        self.from = None;
    }

    /// Notes the speeds at the first step of a window, and the time `kick` by which velocities advance in every step [s]; a
    /// window that is repeated begins at the same step.
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

    /// Adds an upward impulse on the seats of sleeper `k` [N s].
    pub fn add(&mut self, k: usize, impulse: f64) {
        self.impulse[k] += impulse;
    }

    /// Whether the momentum of sleeper `k` has changed by no more than what its seats and its weight gave it. `force` is its
    /// weight, upwards positive [N], `speed` its upward speed now [m/s].
    pub fn is_free(&self, k: usize, mass: f64, force: f64, speed: f64) -> bool {
        if self.from.is_none() {
            return false;
        }
        let weight = force * self.duration;
        let gained = mass * (speed - self.speed[k]);
        (gained - self.impulse[k] - weight).abs() <= NEGLIGIBLE * weight.abs()
    }
}

/// Sleepers while the load cycles last.
#[derive(Clone, Debug, Serialize)]
pub struct TrackRecord {
    /// In their order along the track.
    pub sleepers: Vec<SleeperRecord>,
}

/// One sleeper while the load cycles last.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct SleeperRecord {
    /// Largest downward force on its seats together [N], at the end of any window.
    pub largest_force: f64,
    /// Smallest one; negative where it was lifted.
    pub smallest_force: f64,
    /// Largest lowering since the cycles began [m].
    pub lowering: f64,
    /// That no contact carried it for a while; absent where there always was one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lifted_off: Option<LiftOff>,
    /// Largest force over the load of one axle, where there are axles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_share: Option<f64>,
    /// Largest downward deflection of the rail over it since the rail was laid [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rail_deflection: Option<f64>,
    /// Largest force when the wheels stand still, on a bed of the rail's `foundation` under every sleeper [N].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub static_force: Option<f64>,
    /// Largest force over that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dynamic_amplification: Option<f64>,
    /// Least and largest rise of the ends of a meshed sleeper's base over its middle [m].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bend: Option<[f64; 2]>,
}

/// A sleeper that no contact carried for a while.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LiftOff {
    /// When that first began [s].
    pub first: f64,
    /// How long that was, all in all [s].
    pub seconds: f64,
    /// How far it rose above its place when the cycles began [m].
    pub rise: f64,
}

impl TrackRecord {
    /// Warnings about sleepers that were lifted off.
    pub fn remarks(&self) -> impl Iterator<Item = String> + '_ {
        self.sleepers.iter().enumerate().filter_map(|(k, s)| {
            let LiftOff { first, seconds, rise } = s.lifted_off?;
            Some(format!(
                "sleeper {}: without contact for {seconds:.6} s in total, first at t = {first:.6} s; largest uplift {:.3} mm since the first cycle",
                k + 1,
                1e3 * rise
            ))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 100 kg that fall freely for ten steps under their weight and a push of the seats are free; with 1 mN of a contact
    /// they are not.
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
    fn a_lifted_sleeper_is_reported_with_time_and_rise() {
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
        let text = TrackRecord { sleepers: vec![record] }.remarks().next().unwrap();
        assert!(text.contains("first at t = 0.100000 s"), "{text}");
    }
}
