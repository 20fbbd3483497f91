//! Axis scale with ticks, linear or logarithmic.

use trackbed_io::write::svg::{minus, power_of_ten};

/// Tick; without label a thin line.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Value.
    pub value: f64,
    /// Label.
    pub label: Option<String>,
}

/// Axis scale.
#[derive(Clone, Debug)]
pub struct Ruler {
    low: f64,
    high: f64,
    logarithmic: bool,
    /// Ticks, ascending.
    pub ticks: Vec<Tick>,
}

impl Ruler {
    /// Creates a linear scale of up to `most` steps of 1, 2 or 5 times a power of ten, at least `least`;
    /// `tight` ends at extreme values.
    pub fn linear(values: impl Iterator<Item = f64>, most: usize, least: f64, tight: bool) -> Ruler {
        let (low, high) = widened(range(values).unwrap_or([0.0, 1.0]));
        let least = ((high - low) / most as f64).max(least);
        let power = libm::pow(10.0, libm::log10(least).floor());
        let steps = [1.0, 2.0, 5.0, 10.0].map(|m| m * power);
        let step = steps.into_iter().find(|s| *s >= least * (1.0 - 1e-9)).unwrap_or(power);
        // Rounding needs no further step.
        let first = (low / step + 1e-6).floor();
        let last = (high / step - 1e-6).ceil().max(first + 1.0);
        let largest = step * first.abs().max(last.abs());
        let label = |value: f64| label(value, step, largest);
        let ticks = (0..=(last - first) as usize).map(|k| (first + k as f64) * step);
        let mut ticks: Vec<Tick> = ticks.map(|value| Tick { value, label: Some(label(value)) }).collect();
        if tight {
            ticks.retain(|t| t.value >= low - 1e-6 * step && t.value <= high + 1e-6 * step);
            return Ruler { low, high, logarithmic: false, ticks };
        }
        Ruler { low: first * step, high: last * step, logarithmic: false, ticks }
    }

    /// Creates a logarithmic scale, labelled at 1, 2 and 5 of each decade, or at decades.
    pub fn logarithmic(values: impl Iterator<Item = f64>) -> Ruler {
        let [low, high] = range(values.filter(|v| *v > 0.0)).unwrap_or([1.0, 10.0]);
        let decades = libm::log10(high / low);
        let from = libm::log10(low).floor() as i32 - 1;
        let to = libm::log10(high).ceil() as i32 + 1;
        let every = 1 + decades as i32 / 8;
        let few = decades <= 2.2;
        let mut ends = Vec::new();
        let mut ticks = Vec::new();
        for decade in from..=to {
            for digit in 1..10 {
                let value = f64::from(digit) * libm::pow(10.0, f64::from(decade));
                let end = matches!(digit, 1 | 2 | 5);
                let named = if few { end } else { digit == 1 && decade % every == 0 };
                if end {
                    ends.push(value);
                }
                let label = named.then(|| power_of_ten(decade, digit));
                if every == 1 || label.is_some() {
                    ticks.push(Tick { value, label });
                }
            }
        }
        let near = 1e-9;
        let first = ends.iter().rposition(|v| *v <= low * (1.0 + near)).unwrap_or(0);
        let last = ends.iter().position(|v| *v >= high * (1.0 - near)).unwrap_or(ends.len() - 1);
        let last = last.max(first + 1);
        let (low, high) = (ends[first], ends[last]);
        ticks.retain(|t| t.value >= low * (1.0 - near) && t.value <= high * (1.0 + near));
        Ruler { low, high, logarithmic: true, ticks }
    }

    /// Returns the position of a value, 0 to 1.
    pub fn fraction(&self, value: f64) -> f64 {
        match self.logarithmic {
            true => libm::log(value / self.low) / libm::log(self.high / self.low),
            false => (value - self.low) / (self.high - self.low),
        }
    }

    /// Whether a value can be shown.
    pub fn holds(&self, value: f64) -> bool {
        value.is_finite() && (!self.logarithmic || value > 0.0)
    }
}

fn range(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let finite = values.filter(|v| v.is_finite());
    let [low, high] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v), h.max(v)]);
    (low <= high).then_some([low, high])
}

/// Widens a range below rounding.
fn widened([low, high]: [f64; 2]) -> (f64, f64) {
    if high - low > 1e-12 * high.abs().max(low.abs()) {
        return (low, high);
    }
    // Equal values: widen, including a near zero.
    match high.total_cmp(&0.0) {
        std::cmp::Ordering::Greater => (0.0, 2.0 * high),
        std::cmp::Ordering::Less => (2.0 * low, 0.0),
        std::cmp::Ordering::Equal => (-1.0, 1.0),
    }
}

fn label(value: f64, step: f64, largest: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let power = |v: f64| libm::log10(v * (1.0 + 1e-9)).floor();
    if largest >= 1e6 || step < 0.999e-4 {
        let decimals = (power(value.abs()) - power(step)).max(0.0) as usize;
        return minus(&format!("{value:.decimals$e}"));
    }
    let digits = (-power(step)).max(0.0) as usize;
    minus(&format!("{value:.digits$}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ruler: &Ruler) -> Vec<String> {
        ruler.ticks.iter().filter_map(|t| t.label.clone()).collect()
    }

    #[test]
    fn ticks_enclose_values() {
        assert_eq!(
            labels(&Ruler::linear([0.0, 30.24].into_iter(), 6, 0.0, false)),
            ["0", "10", "20", "30", "40"]
        );
        assert_eq!(
            labels(&Ruler::linear([-0.31, 0.52].into_iter(), 5, 0.0, false)),
            ["\u{2212}0.4", "\u{2212}0.2", "0", "0.2", "0.4", "0.6"]
        );
        assert_eq!(
            labels(&Ruler::linear([5.0, 5.0].into_iter(), 5, 0.0, false)),
            ["0", "2", "4", "6", "8", "10"]
        );
        assert_eq!(labels(&Ruler::linear([].into_iter(), 4, 0.0, false)), ["0", "0.5", "1.0"]);
        assert_eq!(labels(&Ruler::linear([0.0, 3.0].into_iter(), 7, 1.0, true)), ["0", "1", "2", "3"]);
        let tight = Ruler::linear([0.0, 0.41].into_iter(), 5, 0.0, true);
        assert_eq!((labels(&tight).last().unwrap().as_str(), tight.fraction(0.41)), ("0.4", 1.0));
        assert_eq!(labels(&Ruler::logarithmic([1.0, 10.0].into_iter())), ["1", "2", "5", "10"]);
        assert_eq!(labels(&Ruler::logarithmic([1.0, 1000.0].into_iter())), ["1", "10", "100", "1000"]);
        assert_eq!(labels(&Ruler::logarithmic([1.0].into_iter())), ["1", "2"]);
        assert_eq!(labels(&Ruler::logarithmic([0.0, -1.0, 30.0, 63.0].into_iter())), ["20", "50", "100"]);
        for (low, high) in [(1e-12, 1e9), (3.0, 3.1), (1e-30, 1e30), (99.0, 101.0), (1.0, 1e5)] {
            for ruler in [
                Ruler::linear([low, high].into_iter(), 6, 0.0, false),
                Ruler::logarithmic([low, high].into_iter()),
            ] {
                let (first, last) = (ruler.fraction(low), ruler.fraction(high));
                assert!(
                    (-1e-6..=last).contains(&first) && last <= 1.0 + 1e-6,
                    "{low} {high}: {first} {last}"
                );
                assert!((1..=12).contains(&labels(&ruler).len()), "{low} {high}: {:?}", labels(&ruler));
            }
        }
    }

    #[test]
    fn log_scale_rejects_nonpositive_values() {
        let ruler = Ruler::logarithmic([1.0, 5.0].into_iter());
        assert!(ruler.holds(2.0) && !ruler.holds(0.0) && !ruler.holds(f64::NAN));
    }
}
