//! Results per load cycle. Theory manual: eqs. (6.14), (6.15), (6.16).
//!
//! Cycle numbers include jumped cycles. With extrapolation only, the bed is younger: settlement is the
//! measured value plus slope × ln(number/age).

use super::load::CyclicLoad;
use serde::{Deserialize, Serialize};

/// Results of one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// From 1, with jumped cycles.
    pub number: u32,
    /// Simulated cycles.
    pub simulated: u32,
    /// Settlement since the start of the first cycle [m].
    pub settlement: f64,
    /// Settlement since the start of seating [m].
    pub total_settlement: f64,
    /// Settlement per cycle since the last row [m].
    pub rate: f64,
    /// Resilient deflection [m].
    pub resilient_deflection: f64,
    /// Secant stiffness [N/m].
    pub secant_stiffness: f64,
    /// Bed stiffness on the loading branch [N/m]; 0 if not reached.
    pub bed_stiffness: f64,
    /// Resilient modulus [Pa].
    pub resilient_modulus: f64,
    /// Work of the load [J].
    pub dissipated_energy: f64,
    /// Largest formation pressure per face and window [Pa]; 0 without a solid.
    pub peak_formation_pressure: f64,
    /// Settlement error of jumps [m].
    pub jump_error: f64,
}

/// Ballast column under the sleeper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BedColumn {
    /// Base area of the sleeper [m²].
    pub area: f64,
    /// Initial bed height minus height of the sleeper centre [m].
    pub below: f64,
}

/// Records cycles of the observed sleeper.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CycleRecorder {
    begin: f64,
    /// Start of seating [s] and height then [m].
    seating_begins: f64,
    unseated: f64,
    period: f64,
    total: u32,
    /// For the bed stiffness [N].
    between: [f64; 2],
    column: BedColumn,
    /// Initial height [m].
    datum: f64,
    lowest: f64,
    load_range: (f64, f64),
    work_before: f64,
    pressure: f64,
    /// Load [N] and height [m] one window ago; height at the lower of `between`.
    last: (f64, f64),
    passed: Option<f64>,
    stiffness: f64,
    simulated: u32,
    skipped: u32,
    /// Slope of the extrapolation [m].
    slope: f64,
    /// Settlement error of jumps [m].
    pub jump_error: f64,
    /// Bed age in cycles and measured settlement [m].
    pub latest: [f64; 2],
    /// Whether cycles count for fits.
    pub counting: bool,
    /// Completed cycles.
    pub done: Vec<Cycle>,
    /// `latest` of all counting cycles.
    pub measured: Vec<[f64; 2]>,
}

impl CycleRecorder {
    /// Recorder of `load`; bed stiffness between two loads [N].
    pub fn new(load: &CyclicLoad, between: [f64; 2], column: BedColumn) -> CycleRecorder {
        CycleRecorder {
            begin: load.cycles_begin(),
            seating_begins: load.seating_begins(),
            unseated: 0.0,
            period: load.period(),
            total: load.cycles(),
            between,
            column,
            datum: 0.0,
            lowest: f64::INFINITY,
            load_range: (f64::INFINITY, f64::NEG_INFINITY),
            work_before: 0.0,
            pressure: 0.0,
            last: (f64::INFINITY, 0.0),
            passed: None,
            stiffness: 0.0,
            simulated: 0,
            skipped: 0,
            slope: 0.0,
            jump_error: 0.0,
            latest: [0.0; 2],
            counting: true,
            done: Vec::new(),
            measured: Vec::new(),
        }
    }

    /// Cycles of the load.
    pub fn total(&self) -> u32 {
        self.total
    }

    /// Last completed cycle.
    pub fn number(&self) -> u32 {
        self.simulated + self.skipped
    }

    /// Simulated cycles.
    pub fn simulated(&self) -> u32 {
        self.simulated
    }

    /// Settlement by seating pulses [m].
    pub fn seating(&self) -> f64 {
        self.unseated - self.datum
    }

    /// Whether the last cycle is complete.
    pub fn over(&self) -> bool {
        self.number() >= self.total
    }

    /// Skips cycles; `slope` ds/d(ln N) [m], 0 if grains are displaced.
    pub fn skip(&mut self, cycles: u32, slope: f64) {
        self.skipped += cycles;
        self.slope = slope;
    }

    /// Whether a step of `dt` [s] to `t` [s] belongs to a cycle.
    pub fn counts(&self, t: f64, dt: f64) -> bool {
        // By its middle, so rounding of t is harmless.
        t - 0.5 * dt >= self.begin && !self.over()
    }

    /// Records the state at `t` [s] after a step of `dt` [s]; returns a cycle just completed.
    ///
    /// Arguments: sleeper height [m], load [N], work so far [J], largest formation pressure of the step [Pa].
    pub fn record(
        &mut self,
        t: f64,
        dt: f64,
        height: f64,
        load: f64,
        work: f64,
        pressure: f64,
    ) -> Option<Cycle> {
        if t - 0.5 * dt < self.begin {
            if t - 0.5 * dt < self.seating_begins {
                self.unseated = height;
            }
            self.datum = height;
            self.lowest = height;
            self.work_before = work;
            self.last = (load, height);
            return None;
        }
        if self.over() {
            return None;
        }
        self.lowest = self.lowest.min(height);
        self.load_range = (self.load_range.0.min(load), self.load_range.1.max(load));
        self.pressure = self.pressure.max(pressure);
        self.follow_loading(load, height);
        let next = f64::from(self.simulated + 1);
        if t + 0.5 * dt < self.begin + next * self.period {
            return None;
        }
        self.simulated += 1;
        let (number, age) = (self.number(), f64::from(self.simulated));
        let (range, resilient) = (self.load_range.1 - self.load_range.0, height - self.lowest);
        let over = |x: f64| if resilient > 0.0 { x / resilient } else { 0.0 };
        let measured = self.datum - height;
        // Displaced grains have the age of the cycle number.
        let moved = self.slope == 0.0;
        let settlement = measured + if moved { 0.0 } else { self.slope * libm::log(f64::from(number) / age) };
        let before = self.done.last().map_or((0, 0.0), |c| (c.number, c.settlement));
        let cycle = Cycle {
            number,
            simulated: self.simulated,
            settlement,
            total_settlement: settlement + self.seating(),
            rate: (settlement - before.1) / f64::from(number - before.0),
            resilient_deflection: resilient,
            secant_stiffness: over(range),
            bed_stiffness: self.stiffness,
            resilient_modulus: if self.column.area > 0.0 {
                over(range / self.column.area * (self.datum + self.column.below))
            } else {
                0.0
            },
            dissipated_energy: work - self.work_before,
            peak_formation_pressure: self.pressure,
            jump_error: self.jump_error,
        };
        self.done.push(cycle);
        self.latest = [if moved { f64::from(number) } else { age }, measured];
        if self.counting {
            self.measured.push(self.latest);
        }
        self.lowest = height;
        self.load_range = (load, load);
        self.work_before = work;
        self.pressure = 0.0;
        self.stiffness = 0.0;
        Some(cycle)
    }

    fn follow_loading(&mut self, load: f64, height: f64) {
        let (load_before, height_before) = self.last;
        let [low, high] = self.between;
        let at = |f: f64| {
            let share = (f - load_before) / (load - load_before);
            (load_before < f && f <= load).then_some(height_before + share * (height - height_before))
        };
        self.passed = at(low).or(self.passed);
        if let (Some(from), Some(to)) = (self.passed, at(high)) {
            self.stiffness = if from > to { (high - low) / (from - to) } else { 0.0 };
            self.passed = None;
        }
        self.last = (load, height);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{Seating, Waveform};

    fn load(sine: bool) -> CyclicLoad {
        let waveform = Waveform::Wave { sine, minimum: 0.0, maximum: 100.0, frequency: 10.0 };
        CyclicLoad { waveform, cycles: 3, rest: 0.1, ramp: 0.1, seating: None, places: vec![0.0] }
    }

    #[test]
    fn recovers_stiffness_and_drift() {
        let load = load(false);
        let column = BedColumn { area: 0.5, below: -0.8 };
        let mut recorder = CycleRecorder::new(&load, [25.0, 75.0], column);
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
            assert!((c.rate - 1e-3).abs() < 3e-6, "{c:?}");
            assert!((c.resilient_deflection - 0.0095).abs() < 5e-6, "{c:?}");
            assert!((c.secant_stiffness - 100.0 / 0.0095).abs() < 10.0, "{c:?}");
            // 200 Pa over the strain of a bed 0.2 m high.
            assert!((c.resilient_modulus - 200.0 / (0.0095 / 0.2)).abs() < 4.0, "{c:?}");
            let expected = 50.0 / (0.005 + 0.001 / 6.0);
            assert!((c.bed_stiffness / expected - 1.0).abs() < 1e-3, "{c:?} {expected}");
            assert!((c.dissipated_energy - 0.2).abs() < 1e-3, "{c:?}");
            assert!((c.peak_formation_pressure - 700.0).abs() < 1.0, "{c:?}");
        }
    }

    #[test]
    fn sine_has_loading_branch() {
        let load = load(true);
        let mut recorder = CycleRecorder::new(&load, [25.0, 75.0], BedColumn::default());
        for step in 1..=5000 {
            let t = f64::from(step) * 1e-4;
            let f = load.on(0, t);
            recorder.record(t, 1e-4, 1.0 - f / 1e4, f, 0.0, 0.0);
        }
        // Not in the first cycle.
        assert!(recorder.done[1..].iter().all(|c| (c.bed_stiffness / 1e4 - 1.0).abs() < 1e-6));
    }

    #[test]
    fn extrapolates_along_logarithm() {
        let load = load(false);
        let mut recorder = CycleRecorder::new(&load, [25.0, 75.0], BedColumn::default());
        recorder.total = 1000;
        let mut jumped = false;
        for step in 1..=6000 {
            let t = f64::from(step) * 1e-4;
            let age = ((t - 0.2) * 10.0).max(0.0);
            recorder.record(t, 1e-4, 1.0 - 0.01 * (1.0 + age).ln(), load.on(0, t), 0.0, 0.0);
            if recorder.simulated() == 2 && !jumped {
                recorder.skip(500, 0.01);
                jumped = true;
            }
        }
        let last = recorder.done[3];
        assert_eq!((last.number, last.simulated), (504, 4));
        assert!((last.settlement - 0.01 * (5.0_f64.ln() + (504.0_f64 / 4.0).ln())).abs() < 1e-6, "{last:?}");
        assert!((recorder.measured[3][1] - 0.01 * 5.0_f64.ln()).abs() < 1e-6);
        assert_eq!(recorder.measured[3][0], 4.0);
        let jump = recorder.done[2];
        let before = recorder.done[1];
        assert_eq!(jump.number - before.number, 501);
        assert!((jump.rate - (jump.settlement - before.settlement) / 501.0).abs() < 1e-15);
    }

    #[test]
    fn seating_is_stated_apart() {
        let seating = Seating { cycles: 2, maximum: 300.0, frequency: 20.0 };
        let load = CyclicLoad { seating: Some(seating), ..load(false) };
        assert!((load.cycles_begin() - 0.3).abs() < 1e-12 && (load.end() - 0.6).abs() < 1e-12);
        assert!((load.on(0, 0.225) - 300.0).abs() < 1e-9 && load.on(0, 0.25).abs() < 1e-9);
        assert!((load.on(0, 0.35) - 100.0).abs() < 1e-9);
        let mut recorder = CycleRecorder::new(&load, [25.0, 75.0], BedColumn::default());
        let dt = 1e-4;
        for step in 1..=6000 {
            let t = f64::from(step) * dt;
            let height = 1.0 - 0.05 * (t - 0.2).clamp(0.0, 0.1) - 0.01 * (t - 0.3).max(0.0);
            recorder.record(t, dt, height, load.on(0, t), 0.0, 0.0);
        }
        assert!((recorder.seating() - 5e-3).abs() < 1e-5, "{}", recorder.seating());
        for (i, c) in recorder.done.iter().enumerate() {
            assert!((c.settlement - 1e-3 * (i + 1) as f64).abs() < 3e-6, "{c:?}");
            assert!((c.total_settlement - c.settlement - recorder.seating()).abs() < 1e-15, "{c:?}");
        }
        assert_eq!(recorder.done.len(), 3);
    }
}
