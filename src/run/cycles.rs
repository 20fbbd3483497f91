//! Results per load cycle: settlement, resilience, stiffness, dissipation, formation pressure.

use crate::model::seat_load::CyclicLoad;
use serde::{Deserialize, Serialize};

/// What one cycle did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// Cycle number, from 1.
    pub number: u32,
    /// Lowering of the sleeper since the first cycle began, at the end of this cycle [m].
    pub settlement: f64,
    /// Rise of the sleeper from its lowest place in this cycle to the cycle's end [m].
    pub resilient_deflection: f64,
    /// Range of the load over the resilient deflection [N/m].
    pub secant_stiffness: f64,
    /// Work of the load over the cycle [J].
    pub dissipated_energy: f64,
    /// Largest pressure on a face of the formation, as the mean over one exchange [Pa]; 0 without a solid.
    pub peak_formation_pressure: f64,
}

/// Follows the sleeper through the cycles.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CycleRecorder {
    begin: f64,
    period: f64,
    total: u32,
    /// Height of the sleeper when the first cycle began [m].
    datum: f64,
    lowest: f64,
    load_range: (f64, f64),
    work_before: f64,
    pressure: f64,
    /// Finished cycles.
    pub done: Vec<Cycle>,
}

impl CycleRecorder {
    /// A recorder of all cycles of `load`.
    pub fn new(load: &CyclicLoad) -> CycleRecorder {
        CycleRecorder {
            begin: load.cycles_begin(),
            period: load.period(),
            total: load.cycles(),
            datum: 0.0,
            lowest: f64::INFINITY,
            load_range: (f64::INFINITY, f64::NEG_INFINITY),
            work_before: 0.0,
            pressure: 0.0,
            done: Vec::with_capacity(load.cycles() as usize),
        }
    }

    /// Takes in the state at time `t` [s] after a step of length `dt` [s]: height of the sleeper's centre [m], load
    /// [N], work of the load so far [J], largest formation pressure of the step [Pa]. Returns the cycle that has
    /// just ended, if one has.
    pub fn record(
        &mut self,
        t: f64,
        dt: f64,
        height: f64,
        load: f64,
        work: f64,
        pressure: f64,
    ) -> Option<Cycle> {
        // A step belongs to the cycle that holds its middle, so that rounding of t does not matter.
        if t - 0.5 * dt < self.begin {
            self.datum = height;
            self.lowest = height;
            self.work_before = work;
            return None;
        }
        if self.done.len() as u32 == self.total {
            return None;
        }
        self.lowest = self.lowest.min(height);
        self.load_range = (self.load_range.0.min(load), self.load_range.1.max(load));
        self.pressure = self.pressure.max(pressure);
        let number = self.done.len() as u32 + 1;
        if t + 0.5 * dt < self.begin + f64::from(number) * self.period {
            return None;
        }
        let resilient = height - self.lowest;
        let cycle = Cycle {
            number,
            settlement: self.datum - height,
            resilient_deflection: resilient,
            secant_stiffness: if resilient > 0.0 {
                (self.load_range.1 - self.load_range.0) / resilient
            } else {
                0.0
            },
            dissipated_energy: work - self.work_before,
            peak_formation_pressure: self.pressure,
        };
        self.done.push(cycle);
        self.lowest = height;
        self.load_range = (load, load);
        self.work_before = work;
        self.pressure = 0.0;
        Some(cycle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::seat_load::Course;

    #[test]
    fn a_spring_with_drift_yields_its_own_stiffness_and_settlement() {
        let course = Course::Wave { sine: false, minimum: 0.0, maximum: 100.0, frequency: 10.0 };
        let load = CyclicLoad { course, cycles: 3, rest: 0.1, ramp: 0.1, places: vec![0.0] };
        let mut recorder = CycleRecorder::new(&load);
        // Height 1 − F/k − drift·(t − 0.2): k = 10 kN/m, drift 1 mm per cycle.
        let (dt, k, drift) = (1e-4, 1e4, 0.01);
        for step in 1..=5000 {
            let t = f64::from(step) * dt;
            let f = load.on(0, t);
            let height = 1.0 - f / k - drift * (t - 0.2).max(0.0);
            recorder.record(t, dt, height, f, 2.0 * t, 7.0 * f);
        }
        assert_eq!(recorder.done.len(), 3);
        for (i, c) in recorder.done.iter().enumerate() {
            assert!((c.settlement - 1e-3 * (i + 1) as f64).abs() < 3e-6, "{c:?}");
            assert!((c.resilient_deflection - 0.0095).abs() < 5e-6, "{c:?}");
            assert!((c.secant_stiffness - 100.0 / 0.0095).abs() < 10.0, "{c:?}");
            assert!((c.dissipated_energy - 0.2).abs() < 1e-3, "{c:?}");
            assert!((c.peak_formation_pressure - 700.0).abs() < 1.0, "{c:?}");
        }
    }
}
