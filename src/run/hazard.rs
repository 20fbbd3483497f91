//! Statistics of the horizontal load on a structure.

use serde::{Deserialize, Serialize};
use trackbed_input::model::grains::HazardPlan;
use trackbed_io::extremes::{self, Fit, Interval, Law};

/// Statistics of a load history.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HazardRecord {
    /// Warning level of the largest load, if the scene has one.
    pub warning: Option<Warning>,
    /// Loads of the amber and red warnings [N].
    pub amber: Option<f64>,
    pub red: Option<f64>,
    /// Time of the statistics [s].
    pub duration: f64,
    /// Exceedance of the loads of the scene, then of the warnings.
    pub exceedance: Vec<Exceedance>,
    /// Load above which peaks are fitted [N].
    pub threshold: f64,
    /// Peak of each event above the threshold: time [s], load [N].
    pub peaks: Vec<[f64; 2]>,
    /// Fitted law; none for too few or equal peaks.
    pub fit: Option<Fit>,
    /// Confidence of the intervals.
    pub confidence: f64,
    /// Loads exceeded once per return period on average.
    pub return_loads: Vec<ReturnLoad>,
    /// Number of return periods with less than one peak on average, which have no load.
    pub short_periods: usize,
    /// Load of level ice [N], and the largest load over it.
    pub level_ice: Option<f64>,
    pub over_level_ice: Option<f64>,
}

/// Warning level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Warning {
    /// Below all levels.
    Green,
    /// Above the amber level.
    Amber,
    /// Above the red level.
    Red,
}

impl Warning {
    /// Name of the level.
    pub fn name(self) -> &'static str {
        match self {
            Warning::Green => "green",
            Warning::Amber => "amber",
            Warning::Red => "red",
        }
    }
}

/// Exceedance of a load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Exceedance {
    /// Load [N].
    pub load: f64,
    /// Fraction of time above it.
    pub fraction_of_time: f64,
    /// Number of events above it.
    pub events: usize,
}

/// Load of a return period.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReturnLoad {
    /// Return period [years].
    pub period: f64,
    /// Load with its confidence interval [N].
    pub load: Interval,
}

/// Evaluates rows of time [s] and load [N].
pub fn record(plan: &HazardPlan, rows: &[[f64; 2]]) -> HazardRecord {
    let rows: Vec<[f64; 2]> = rows.iter().copied().filter(|[time, _]| *time >= plan.start).collect();
    let (times, loads): (Vec<f64>, Vec<f64>) = rows.iter().map(|[time, load]| (*time, *load)).unzip();
    let duration = times.last().copied().unwrap_or(0.0) - times.first().copied().unwrap_or(0.0);
    let largest = loads.iter().copied().fold(0.0, f64::max);
    let [amber, red] = plan.warnings;
    let events = |level: f64| extremes::events(&times, &loads, level, plan.separation);
    let exceedance = plan.loads.iter().chain(amber.iter()).chain(red.iter()).map(|&load| Exceedance {
        load,
        fraction_of_time: extremes::fraction_above(&times, &loads, load),
        events: events(load).len(),
    });
    let whole = extremes::whole(events(plan.threshold), &loads, plan.threshold);
    let peaks: Vec<[f64; 2]> = whole.iter().map(|e| [e.time, e.peak]).collect();
    let values: Vec<f64> = peaks.iter().map(|[_, load]| *load).collect();
    let fit = Fit::of(plan.law, plan.threshold, &values);
    let per_year = peaks.len() as f64 / duration.max(f64::MIN_POSITIVE) * plan.exposure;
    let return_load = |period: &f64| {
        let exceedance = 1.0 / (per_year * period);
        // Less than one peak per period.
        let fit = fit.as_ref().filter(|_| exceedance < 1.0)?;
        Some(ReturnLoad { period: *period, load: fit.quantile(exceedance, plan.confidence) })
    };
    let return_loads: Vec<ReturnLoad> = plan.return_periods.iter().filter_map(return_load).collect();
    let short_periods = if fit.is_some() { plan.return_periods.len() - return_loads.len() } else { 0 };
    let above = |level: Option<f64>| level.is_some_and(|level| largest > level);
    let warning = match () {
        () if amber.or(red).is_none() => None,
        () if above(red) => Some(Warning::Red),
        () if above(amber) => Some(Warning::Amber),
        () => Some(Warning::Green),
    };
    HazardRecord {
        warning,
        amber,
        red,
        duration,
        exceedance: exceedance.collect(),
        threshold: plan.threshold,
        return_loads,
        short_periods,
        peaks,
        fit,
        confidence: plan.confidence,
        level_ice: plan.level_ice,
        over_level_ice: plan.level_ice.map(|load| largest / load),
    }
}

impl HazardRecord {
    /// Formats the record for a terminal, without the name of the structure.
    pub fn text(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if let Some(warning) = self.warning {
            lines.push(format!("warning level {}", warning.name()));
        }
        for e in &self.exceedance {
            lines.push(format!(
                "above {:.3e} N {:.3} % of the time, {} events",
                e.load,
                100.0 * e.fraction_of_time,
                e.events
            ));
        }
        let plural = if self.peaks.len() == 1 { "" } else { "s" };
        let peaks = format!("{} peak{plural} above {:.3e} N", self.peaks.len(), self.threshold);
        lines.push(match &self.fit {
            None => format!("{peaks}, no fit (at least {} different peaks)", extremes::FEWEST),
            Some(Fit { law: Law::Gumbel, location, scale, .. }) => {
                format!("{peaks}, Gumbel law with location {location:.3e} N, scale {scale:.3e} N")
            }
            Some(Fit { law: Law::Weibull, scale, shape, .. }) => {
                format!("{peaks}, Weibull law of the excess with scale {scale:.3e} N, shape {shape:.3}")
            }
        });
        if self.short_periods > 0 {
            lines.push(format!("{} return periods with less than one peak: no load", self.short_periods));
        }
        for r in &self.return_loads {
            lines.push(format!(
                "{}-year load {:.3e} N ({:.3e} to {:.3e} N, {} % confidence)",
                r.period,
                r.load.value,
                r.load.low,
                r.load.high,
                100.0 * self.confidence
            ));
        }
        if let (Some(load), Some(ratio)) = (self.level_ice, self.over_level_ice) {
            lines.push(format!("maximum {ratio:.3} times the load of level ice {load:.3e} N"));
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half sines of the given peaks [N], 1 s each, then 1 s without load; rows 1 ms apart.
    fn pulses(peaks: &[f64]) -> Vec<[f64; 2]> {
        let load = |t: f64| {
            let (k, phase) = ((t / 2.0).floor() as usize, t % 2.0);
            let peak = peaks.get(k).copied().unwrap_or(0.0);
            if phase < 1.0 { peak * libm::sin(std::f64::consts::PI * phase) } else { 0.0 }
        };
        (0..=2000 * peaks.len()).map(|k| 1e-3 * k as f64).map(|t| [t, load(t)]).collect()
    }

    fn plan(law: Law) -> HazardPlan {
        HazardPlan {
            threshold: 40.0,
            loads: vec![100.0],
            separation: 0.5,
            start: 0.0,
            law,
            confidence: 0.9,
            exposure: 3600.0,
            return_periods: vec![1e-5, 1.0, 100.0],
            warnings: [Some(150.0), Some(200.0)],
            level_ice: Some(500.0),
        }
    }

    #[test]
    fn record_of_known_pulses() {
        let peaks = [231.0, 77.0, 142.0, 90.0, 52.0, 219.0, 67.0, 30.0];
        let record = record(&plan(Law::Gumbel), &pulses(&peaks));
        assert!((record.duration - 16.0).abs() < 1e-9, "{record:?}");
        let found: Vec<f64> = record.peaks.iter().map(|p| p[1]).collect();
        assert_eq!(found, peaks[..7]);
        assert!((record.peaks[2][0] - 4.5).abs() < 1e-9);
        // A half sine of 1 s and peak P is above F for 1 - 2/π asin(F/P) s.
        for (e, load, count) in [(0, 100.0, 3), (1, 150.0, 2), (2, 200.0, 2)] {
            let above = |p: &f64| 1.0 - 2.0 / std::f64::consts::PI * libm::asin((load / p).min(1.0));
            let expected = peaks.iter().map(above).sum::<f64>() / 16.0;
            let e = &record.exceedance[e];
            assert!((e.fraction_of_time - expected).abs() < 1e-5 && e.events == count, "{e:?} {expected}");
        }
        assert_eq!(record.warning, Some(Warning::Red));
        assert_eq!(record.over_level_ice, Some(0.462));
        // 7 peaks in 16 s, one hour per year: 1575 peaks per year; the first period has less than one.
        let fit = record.fit.unwrap();
        assert_eq!(record.return_loads.len(), 2);
        for (r, period) in record.return_loads.iter().zip([1.0, 100.0]) {
            assert!(r.period == period && (r.load.low..r.load.high).contains(&r.load.value));
            assert!((fit.exceedance(r.load.value) * 1575.0 * period - 1.0).abs() < 1e-9, "{r:?}");
        }
    }

    #[test]
    fn warning_follows_largest_load() {
        for (peak, expected) in [(149.0, Warning::Green), (151.0, Warning::Amber), (201.0, Warning::Red)] {
            assert_eq!(record(&plan(Law::Weibull), &pulses(&[peak])).warning, Some(expected));
        }
        let silent = HazardPlan { warnings: [None, None], ..plan(Law::Weibull) };
        let record = record(&silent, &pulses(&[300.0]));
        assert_eq!((record.warning, record.exceedance.len(), record.fit), (None, 1, None));
        assert!(record.return_loads.is_empty());
    }

    #[test]
    fn start_omits_earlier_rows() {
        let late = HazardPlan { start: 2.0, ..plan(Law::Weibull) };
        let record = record(&late, &pulses(&[231.0, 77.0]));
        assert_eq!(record.peaks.iter().map(|p| p[1]).collect::<Vec<_>>(), [77.0]);
        assert_eq!(record.warning, Some(Warning::Green));
    }
}
