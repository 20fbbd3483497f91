//! Statistics of a load history: exceedance, events, peaks, extreme values with confidence intervals.
//!
//! Maximum likelihood of the Gumbel law; a Weibull law of X is a Gumbel law of −ln X. Confidence of quantiles
//! by the delta method on the expected information (Kotz and Nadarajah 2000, Extreme Value Distributions,
//! section 2.6).

use serde::{Deserialize, Serialize};

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Fewest values of a fit: the interval of fewer is no guide.
pub const FEWEST: usize = 5;

/// Event: excursions above a level, joined if they are closer than the separation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Time of the peak [s].
    pub time: f64,
    /// Peak.
    pub peak: f64,
}

/// Returns the fraction of time above a level; the history is linear between its rows.
pub fn fraction_above(times: &[f64], values: &[f64], level: f64) -> f64 {
    let mut above = 0.0;
    for (t, x) in times.windows(2).zip(values.windows(2)) {
        let [low, high] = if x[0] < x[1] { [x[0], x[1]] } else { [x[1], x[0]] };
        let fraction = match () {
            () if low > level => 1.0,
            () if high <= level => 0.0,
            () => (high - level) / (high - low),
        };
        above += fraction * (t[1] - t[0]);
    }
    let all = times.last().copied().unwrap_or(0.0) - times.first().copied().unwrap_or(0.0);
    if all > 0.0 { above / all } else { 0.0 }
}

/// Returns the events above a level that are at least `separation` [s] below it apart.
pub fn events(times: &[f64], values: &[f64], level: f64, separation: f64) -> Vec<Event> {
    let mut events: Vec<Event> = Vec::new();
    // Time of the first row below since the last one above.
    let mut below = Some(f64::NEG_INFINITY);
    for (&time, &value) in times.iter().zip(values) {
        if value <= level {
            below = below.or(Some(time));
            continue;
        }
        let joined = below.take().is_none_or(|since| time - since < separation);
        match events.last_mut().filter(|_| joined) {
            Some(event) if value > event.peak => *event = Event { time, peak: value },
            Some(_) => {}
            None => events.push(Event { time, peak: value }),
        }
    }
    events
}

/// Returns the events without those that the ends of the history cut off: their peaks are not known.
pub fn whole(mut events: Vec<Event>, values: &[f64], level: f64) -> Vec<Event> {
    if values.last().is_some_and(|x| *x > level) {
        events.pop();
    }
    if values.first().is_some_and(|x| *x > level) && !events.is_empty() {
        events.remove(0);
    }
    events
}

/// Law of extreme values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Law {
    /// F(x) = exp(−exp(−(x − location) / scale)).
    Gumbel,
    /// F(x) = 1 − exp(−((x − origin) / scale)^shape).
    Weibull,
}

/// Value with the limits of its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// Estimate.
    pub value: f64,
    /// Lower limit.
    pub low: f64,
    /// Upper limit.
    pub high: f64,
}

/// Fitted law.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Law.
    pub law: Law,
    /// Number of values.
    pub count: usize,
    /// Location of the Gumbel law, origin of the Weibull law.
    pub location: f64,
    /// Scale.
    pub scale: f64,
    /// Shape of the Weibull law, 1 of the Gumbel law.
    pub shape: f64,
    /// Largest difference between fitted and empirical distribution (Kolmogorov and Smirnov).
    pub distance: f64,
}

impl Fit {
    /// Fits by maximum likelihood; `origin` of the Weibull law. None for fewer than [`FEWEST`] distinct values.
    pub fn of(law: Law, origin: f64, values: &[f64]) -> Option<Fit> {
        let reduced: Vec<f64> = match law {
            Law::Gumbel => values.to_vec(),
            Law::Weibull => values.iter().map(|x| -libm::log(x - origin)).collect(),
        };
        if values.len() < FEWEST || reduced.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let [location, scale] = gumbel(&reduced)?;
        let mut fit = match law {
            Law::Gumbel => Fit { law, count: values.len(), location, scale, shape: 1.0, distance: 0.0 },
            Law::Weibull => {
                let (scale, shape) = (libm::exp(-location), 1.0 / scale);
                Fit { law, count: values.len(), location: origin, scale, shape, distance: 0.0 }
            }
        };
        fit.distance = fit.distance_from(values);
        Some(fit)
    }

    /// Returns the probability that a value is exceeded.
    pub fn exceedance(&self, x: f64) -> f64 {
        let z = (x - self.location) / self.scale;
        match self.law {
            Law::Gumbel => -libm::expm1(-libm::exp(-z)),
            Law::Weibull if z <= 0.0 => 1.0,
            Law::Weibull => libm::exp(-libm::pow(z, self.shape)),
        }
    }

    /// Returns the value exceeded with a probability, with its confidence interval at `confidence`.
    pub fn quantile(&self, exceedance: f64, confidence: f64) -> Interval {
        let width = normal_quantile(0.5 + 0.5 * confidence) / (self.count as f64).sqrt();
        match self.law {
            Law::Gumbel => {
                let y = -libm::log(-libm::log1p(-exceedance));
                let half = self.scale * width * relative_error(y);
                let value = self.location + self.scale * y;
                Interval { value, low: value - half, high: value + half }
            }
            Law::Weibull => {
                // −ln(x − origin) has a Gumbel law of scale 1 / shape; there the value is a lower quantile.
                let y = -libm::log(-libm::log(exceedance));
                let half = width * relative_error(y) / self.shape;
                let at = |shift: f64| self.location + self.scale * libm::exp(shift - y / self.shape);
                Interval { value: at(0.0), low: at(-half), high: at(half) }
            }
        }
    }

    fn distance_from(&self, values: &[f64]) -> f64 {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let n = sorted.len() as f64;
        let of = |(k, x): (usize, &f64)| {
            let below = 1.0 - self.exceedance(*x);
            (below - k as f64 / n).abs().max(((k + 1) as f64 / n - below).abs())
        };
        sorted.iter().enumerate().map(of).fold(0.0, f64::max)
    }
}

/// Standard error of a Gumbel quantile at reduced variate `y`, times √n over the scale.
fn relative_error(y: f64) -> f64 {
    let six = 6.0 / (std::f64::consts::PI * std::f64::consts::PI);
    let z = 1.0 - EULER + y;
    (1.0 + six * z * z).sqrt()
}

/// Location and scale of largest likelihood; none for equal values.
fn gumbel(values: &[f64]) -> Option<[f64; 2]> {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n;
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let deviation = variance.sqrt();
    let varies = deviation.is_finite() && deviation > 1e-12 * mean.abs();
    if !varies {
        return None;
    }
    // Shifted: no overflow. The residual rises with the scale.
    let residual = |scale: f64| {
        let (mut sum, mut weighted) = (0.0, 0.0);
        for x in values {
            let weight = libm::exp((low - x) / scale);
            sum += weight;
            weighted += weight * x;
        }
        (scale - mean + weighted / sum, sum)
    };
    let [mut below, mut above] = [1e-3 * deviation, 10.0 * deviation];
    while residual(above).0 < 0.0 {
        above *= 2.0;
    }
    while residual(below).0 > 0.0 {
        below *= 0.5;
    }
    for _ in 0..200 {
        let middle = 0.5 * (below + above);
        if middle <= below || middle >= above {
            break;
        }
        if residual(middle).0 < 0.0 { below = middle } else { above = middle }
    }
    let scale = 0.5 * (below + above);
    Some([low - scale * libm::log(residual(scale).1 / n), scale])
}

/// Quantile of the standard normal law, by bisection of the error function.
pub fn normal_quantile(p: f64) -> f64 {
    let [mut low, mut high] = [-40.0_f64, 40.0];
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        let below = 0.5 * libm::erfc(-middle / std::f64::consts::SQRT_2);
        if below < p { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
#[path = "extremes_tests.rs"]
mod tests;
