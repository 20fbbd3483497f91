//! Settlement extrapolated with ln N, with an error estimate from forecasts of the simulated cycles.
//!
//! The slope b = ds/d(ln N) is fitted from a quarter of the age n on. Forecasts from n/2, n/4 and n/8 are compared
//! with what came: their root-mean-square miss of the slope, with the standard error of b, gives the error.
//! Theory manual: eqs. (6.24), (6.26).

use super::settlement::{self, Slope};
use serde::{Deserialize, Serialize};

/// First cycle of the slope over the last.
pub const WINDOW: f64 = 0.25;
/// Forecasts begin at these parts of the age.
const PARTS: [f64; 3] = [0.5, 0.25, 0.125];
/// Standard errors of the estimate.
const ERRORS: f64 = 2.0;

/// Forecast from earlier cycles, compared with the simulated one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Forecast {
    /// Last cycle that it uses.
    pub from: f64,
    /// Cycle.
    pub cycle: f64,
    /// Forecast settlement [m].
    pub predicted: f64,
    /// Its estimated error [m].
    pub error_estimate: f64,
    /// Simulated settlement [m].
    pub settlement: f64,
}

/// Slope at the last of `cycles` (age, settlement [m]).
pub fn slope(cycles: &[[f64; 2]]) -> Option<Slope> {
    settlement::slope(cycles, WINDOW * cycles.last()?[0])
}

/// Estimated error [m] of an extrapolation over `span` = ln(N/n) with the slope `fit` of `cycles`; where no forecast
/// can be compared, the slope itself counts as its miss.
pub fn error(cycles: &[[f64; 2]], fit: &Slope, span: f64) -> f64 {
    let Some([age, settlement]) = cycles.last().copied() else { return 0.0 };
    let miss = |(earlier, own): (&[[f64; 2]], Slope)| {
        let [from, before] = *earlier.last()?;
        Some((settlement - before) / libm::log(age / from) - own.slope)
    };
    let misses: Vec<f64> = earlier(cycles).filter_map(miss).collect();
    let square = match misses.len() {
        0 => fit.slope * fit.slope,
        count => misses.iter().map(|m| m * m).sum::<f64>() / count as f64,
    };
    ERRORS * (fit.error * fit.error + square).sqrt() * span
}

/// Forecasts of the last of `cycles`, latest first.
pub fn forecasts(cycles: &[[f64; 2]]) -> Vec<Forecast> {
    let Some([cycle, settlement]) = cycles.last().copied() else { return Vec::new() };
    let forecast = |(earlier, fit): (&[[f64; 2]], Slope)| {
        let [from, before] = *earlier.last()?;
        let span = libm::log(cycle / from);
        let (predicted, error_estimate) = (before + fit.slope * span, error(earlier, &fit, span));
        Some(Forecast { from, cycle, predicted, error_estimate, settlement })
    };
    earlier(cycles).filter_map(forecast).collect()
}

/// Cycles up to parts of the age at which the sleeper is seated, with their slope.
fn earlier(cycles: &[[f64; 2]]) -> impl Iterator<Item = (&[[f64; 2]], Slope)> {
    let age = cycles.last().map_or(0.0, |c| c[0]);
    PARTS.into_iter().map(move |part| part * age).filter(|age| *age >= settlement::FIRST).filter_map(|age| {
        let part = &cycles[..cycles.partition_point(|c| c[0] <= age)];
        Some((part, slope(part)?))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cycles(count: u32, law: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        (1..=count).map(|n| [f64::from(n), law(f64::from(n))]).collect()
    }

    fn estimate(cycles: &[[f64; 2]], span: f64) -> f64 {
        error(cycles, &slope(cycles).unwrap(), span)
    }

    #[test]
    fn a_logarithm_has_no_error() {
        let law = cycles(200, |n| 1e-3 * (2.0 + 0.3 * n.ln()));
        assert!(estimate(&law, 5.0) < 1e-12);
        assert!(
            forecasts(&law).iter().all(|f| (f.predicted - f.settlement).abs() < 1e-12),
            "{:?}",
            forecasts(&law)
        );
        assert_eq!(forecasts(&law).iter().map(|f| f.from).collect::<Vec<_>>(), [100.0, 50.0, 25.0]);
    }

    /// s = a N: from h, the slope of the regression over [h/4, h] is short of that to n by what `forecasts` find.
    #[test]
    fn misses_of_forecasts_give_the_error() {
        let law = cycles(400, |n| 1e-5 * n);
        let found: Vec<f64> =
            forecasts(&law).iter().map(|f| (f.settlement - f.predicted) / (f.cycle / f.from).ln()).collect();
        let rms = (found.iter().map(|m| m * m).sum::<f64>() / 3.0).sqrt();
        let estimated = estimate(&law, 1.0);
        assert!(found.len() == 3 && rms > 1e-3 * 0.5, "{found:?}");
        assert!((estimated / (2.0 * rms) - 1.0).abs() < 0.02, "{estimated} {rms}");
        // The truth at twice the age.
        let fit = slope(&law).unwrap();
        let miss = 8e-3 - (4e-3 + fit.slope * 2.0_f64.ln());
        let estimated = estimate(&law, 2.0_f64.ln());
        assert!(miss > 0.5 * estimated && miss < 1.2 * estimated, "{miss} {estimated}");
    }

    #[test]
    fn seating_is_no_forecast() {
        assert_eq!(forecasts(&cycles(19, f64::sqrt)), []);
        assert_eq!(forecasts(&cycles(20, f64::sqrt)).len(), 1);
        assert_eq!(error(&[], &Slope { slope: 1.0, error: 1.0 }, 1.0), 0.0);
        // Without a forecast the extrapolation is unchecked, however smooth the cycles are.
        let law = cycles(19, |n| 1e-3 * n.ln());
        assert!((estimate(&law, 1.0) / 2e-3 - 1.0).abs() < 1e-9);
    }
}
