//! Axes with ticks: linear, logarithmic, categories.

/// Characters along an axis.
const CHARACTERS: usize = 56;

/// Axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// Quantity, such as `settlement`.
    pub name: String,
    /// Unit, or empty.
    pub unit: String,
    /// Whether logarithmic.
    pub logarithmic: bool,
    /// Whether it increases downwards.
    pub downwards: bool,
    /// Whether it starts at zero.
    pub from_zero: bool,
    /// Whether values are counts with integer ticks.
    pub whole: bool,
    /// Names of the values 1, 2, …; empty for numbers.
    pub categories: Vec<String>,
}

/// Ends of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// At the extreme values; of a logarithmic axis at ticks.
    Values,
    /// At ticks that enclose the values.
    Ticks,
    /// At ticks outside the values.
    Beyond,
}

impl Axis {
    /// Creates a linear axis.
    pub fn new(name: &str, unit: &str) -> Axis {
        Axis { name: name.into(), unit: unit.into(), ..Axis::default() }
    }

    /// Creates an axis of counts.
    pub fn count(name: &str) -> Axis {
        Axis { whole: true, ..Axis::new(name, "") }
    }

    /// Makes it logarithmic.
    pub fn logarithmic(self) -> Axis {
        Axis { logarithmic: true, ..self }
    }

    /// Makes it increase downwards.
    pub fn downwards(self) -> Axis {
        Axis { downwards: true, ..self }
    }

    /// Makes it start at zero.
    pub fn with_zero(self) -> Axis {
        Axis { from_zero: true, ..self }
    }

    /// Returns name and unit.
    pub fn label(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{} [{}]", self.name, self.unit) }
    }

    /// Returns the value, or its logarithm; not finite if it cannot be shown.
    pub fn position(&self, value: f64) -> f64 {
        position(self.logarithmic, value)
    }

    /// Creates the scale of `values`, with up to `most` steps if linear.
    pub fn ruler(&self, values: impl Iterator<Item = f64>, most: usize, ends: Ends) -> Ruler {
        let ([low, high], ticks) = match (self.categories.len(), self.logarithmic) {
            (0, true) => logarithmic(values, ends),
            (0, false) => {
                let least = if self.whole { 1.0 } else { 0.0 };
                linear(values.chain(self.from_zero.then_some(0.0)), most, least, ends)
            }
            (count, _) => {
                let name = |name| Some(cut(name, CHARACTERS / count));
                let names = self.categories.iter().enumerate();
                let ticks = names.map(|(k, n)| Tick { value: (k + 1) as f64, label: name(n) }).collect();
                ([0.5, count as f64 + 0.5], ticks)
            }
        };
        let [low, high] = [low, high].map(|v| self.position(v));
        let (low, high) = if self.downwards { (high, low) } else { (low, high) };
        Ruler { low, high, logarithmic: self.logarithmic, ticks }
    }
}

/// Tick; without label a thin line.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Value.
    pub value: f64,
    /// Label.
    pub label: Option<String>,
}

/// Axis scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Ruler {
    low: f64,
    high: f64,
    logarithmic: bool,
    /// Ticks, ascending.
    pub ticks: Vec<Tick>,
}

impl Ruler {
    /// Returns the position of a value, 0 to 1 to the right or upwards.
    pub fn fraction(&self, value: f64) -> f64 {
        (position(self.logarithmic, value) - self.low) / (self.high - self.low)
    }

    /// Whether a value can be shown.
    pub fn shows(&self, value: f64) -> bool {
        position(self.logarithmic, value).is_finite()
    }
}

fn position(logarithmic: bool, value: f64) -> f64 {
    if logarithmic { libm::log(value) } else { value }
}

/// Steps of 1, 2 or 5 times a power of ten, at least `least`.
fn linear(values: impl Iterator<Item = f64>, most: usize, least: f64, ends: Ends) -> ([f64; 2], Vec<Tick>) {
    let [low, high] = widened(range(values).unwrap_or([0.0, 1.0]));
    let least = ((high - low) / most as f64).max(least);
    let power = libm::pow(10.0, libm::log10(least).floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|m| m * power);
    let step = steps.into_iter().find(|s| *s >= least * (1.0 - 1e-9)).unwrap_or(power);
    // Rounding needs no further step.
    let slack = if ends == Ends::Beyond { -1e-6 } else { 1e-6 };
    let first = (low / step + slack).floor();
    let last = (high / step - slack).ceil().max(first + 1.0);
    let largest = step * first.abs().max(last.abs());
    let values = (0..=(last - first) as usize).map(|k| (first + k as f64) * step);
    let mut ticks: Vec<Tick> =
        values.map(|value| Tick { value, label: Some(label(value, step, largest)) }).collect();
    if ends == Ends::Values {
        ticks.retain(|t| t.value >= low - 1e-6 * step && t.value <= high + 1e-6 * step);
        return ([low, high], ticks);
    }
    ([first * step, last * step], ticks)
}

/// Labels at 1, 2 and 5 of each decade, or at decades.
fn logarithmic(values: impl Iterator<Item = f64>, ends: Ends) -> ([f64; 2], Vec<Tick>) {
    let [low, high] = range(values.filter(|v| *v > 0.0)).unwrap_or([1.0, 10.0]);
    let decades = libm::log10(high / low);
    let every = 1 + decades as i32 / 8;
    let [from, to] = [libm::log10(low).floor() as i32 - 1, libm::log10(high).ceil() as i32 + 1];
    let all = || (from..=to).flat_map(|decade| (1..10).map(move |digit| (decade, digit)));
    let value = |(decade, digit): (i32, u32)| f64::from(digit) * libm::pow(10.0, f64::from(decade));
    let round = |digit: u32| matches!(digit, 1 | 2 | 5);
    let near = if ends == Ends::Beyond { -1e-9 } else { 1e-9 };
    let stops = || all().filter(|t| round(t.1)).map(value);
    let low = stops().filter(|v| *v <= low * (1.0 + near)).fold(0.0, f64::max);
    let high = stops().filter(|v| *v >= high * (1.0 - near) && *v > low).fold(f64::INFINITY, f64::min);
    let tick = |(decade, digit)| {
        let named = if decades <= 2.2 { round(digit) } else { digit == 1 && decade % every == 0 };
        let tick = Tick { value: value((decade, digit)), label: named.then(|| power_of_ten(decade, digit)) };
        let within = tick.value >= low * (1.0 - 1e-9) && tick.value <= high * (1.0 + 1e-9);
        (within && (named || every == 1)).then_some(tick)
    };
    ([low, high], all().filter_map(tick).collect())
}

fn range(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let finite = values.filter(|v| v.is_finite());
    let [low, high] = finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v), h.max(v)]);
    (low <= high).then_some([low, high])
}

/// Widens a range below rounding, to zero if it is near.
fn widened([low, high]: [f64; 2]) -> [f64; 2] {
    if high - low > 1e-12 * high.abs().max(low.abs()) {
        return [low, high];
    }
    match high.total_cmp(&0.0) {
        std::cmp::Ordering::Greater => [0.0, 2.0 * high],
        std::cmp::Ordering::Less => [2.0 * low, 0.0],
        std::cmp::Ordering::Equal => [-1.0, 1.0],
    }
}

fn label(value: f64, step: f64, largest: f64) -> String {
    let power = |v: f64| libm::log10(v * (1.0 + 1e-9)).floor();
    if value == 0.0 {
        "0".into()
    } else if largest >= 1e6 || step < 0.999e-4 {
        let decimals = (power(value.abs()) - power(step)).max(0.0) as usize;
        minus(&format!("{value:.decimals$e}"))
    } else {
        let digits = (-power(step)).max(0.0) as usize;
        minus(&format!("{value:.digits$}"))
    }
}

/// Digit times a power of ten, in plain form if short.
fn power_of_ten(decade: i32, digit: u32) -> String {
    match decade {
        0..=4 => format!("{digit}{}", "0".repeat(decade as usize)),
        -3..=-1 => format!("0.{}{digit}", "0".repeat((-decade - 1) as usize)),
        _ => minus(&format!("{digit}e{decade}")),
    }
}

/// Replaces hyphens by the typographic minus, as wide as a digit.
pub fn minus(text: &str) -> String {
    text.replace('-', "\u{2212}")
}

/// Cuts a text to `most` characters.
pub fn cut(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.into();
    }
    text.chars().take(most.max(2) - 1).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(ruler: &Ruler) -> Vec<String> {
        ruler.ticks.iter().filter_map(|t| t.label.clone()).collect()
    }

    fn linear(values: &[f64], most: usize, ends: Ends) -> Ruler {
        Axis::default().ruler(values.iter().copied(), most, ends)
    }

    fn logarithmic(values: &[f64], ends: Ends) -> Ruler {
        Axis::default().logarithmic().ruler(values.iter().copied(), 6, ends)
    }

    #[test]
    fn linear_ticks_are_round() {
        let of = |values: &[f64], most| labels(&linear(values, most, Ends::Ticks));
        assert_eq!(of(&[0.0, 10.0], 5), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(of(&[0.0, 30.24], 6), ["0", "10", "20", "30", "40"]);
        assert_eq!(of(&[-0.31, 0.52], 5), ["−0.4", "−0.2", "0", "0.2", "0.4", "0.6"]);
        assert_eq!(of(&[5.0, 5.0], 5), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(of(&[], 4), ["0", "0.5", "1.0"]);
        assert_eq!(of(&[0.0, 2.0e7], 4), ["0", "5e6", "1.0e7", "1.5e7", "2.0e7"]);
        assert_eq!(of(&[0.0, 3.0e-5], 3), ["0", "1e−5", "2e−5", "3e−5"]);
        assert_eq!(labels(&linear(&[0.0, 10.0], 5, Ends::Beyond)).last().unwrap(), "12");
        let whole = Axis::count("n").ruler([0.0, 3.0].into_iter(), 7, Ends::Values);
        assert_eq!(labels(&whole), ["0", "1", "2", "3"]);
        let tight = linear(&[0.0, 0.41], 5, Ends::Values);
        assert_eq!((labels(&tight).last().unwrap().as_str(), tight.fraction(0.41)), ("0.4", 1.0));
        let zero = Axis::default().with_zero().ruler([3.0, 4.0].into_iter(), 5, Ends::Ticks);
        assert_eq!(zero.fraction(0.0), 0.0);
        let down = Axis::default().downwards().ruler([0.0, 4.0].into_iter(), 5, Ends::Ticks);
        assert_eq!([0.0, 1.0, 4.0].map(|v| down.fraction(v)), [1.0, 0.75, 0.0]);
    }

    #[test]
    fn logarithmic_ticks_are_round() {
        let of = |values: &[f64]| labels(&logarithmic(values, Ends::Ticks));
        assert_eq!(of(&[1.0, 10.0]), ["1", "2", "5", "10"]);
        assert_eq!(of(&[1.0, 1000.0]), ["1", "10", "100", "1000"]);
        assert_eq!(of(&[1.0]), ["1", "2"]);
        assert_eq!(of(&[0.0, -1.0, 30.0, 63.0]), ["20", "50", "100"]);
        let beyond = |values: &[f64]| labels(&logarithmic(values, Ends::Beyond));
        assert_eq!(beyond(&[0.3, 4.0]), ["0.2", "0.5", "1", "2", "5"]);
        assert_eq!(beyond(&[1.0]), ["0.5", "1", "2"]);
        assert_eq!(beyond(&[2e-5, 0.3]), ["1e−5", "1e−4", "0.001", "0.01", "0.1"]);
        assert_eq!(beyond(&[]), ["0.5", "1", "2", "5", "10", "20"]);
    }

    #[test]
    fn ticks_enclose_values() {
        let positive = [(1e-12, 1e9), (3.0, 3.1), (1e-30, 1e30), (99.0, 101.0), (1.0, 1e5), (1e-9, 2e-9)];
        let others = [(-5e8, 7e11), (0.1, 0.1 + 1e-7), (1e5, 1e5 + 0.3), (0.0, 0.3)];
        for (low, high) in positive.into_iter().chain(others) {
            for ends in [Ends::Values, Ends::Ticks, Ends::Beyond] {
                let log = (low > 0.0).then(|| logarithmic(&[low, high], ends));
                for ruler in log.into_iter().chain([linear(&[low, high], 6, ends)]) {
                    let (first, last, names) = (ruler.fraction(low), ruler.fraction(high), labels(&ruler));
                    let slack = if ends == Ends::Beyond { 0.0 } else { 1e-6 };
                    let found = format!("{low} {high} {ends:?}: {first} {last} {names:?}");
                    assert!(-slack <= first && first < last && last <= 1.0 + slack, "{found}");
                    assert!(ends != Ends::Beyond || (first > 0.0 && last < 1.0), "{found}");
                    assert!((1..=12).contains(&names.len()), "{found}");
                    assert!(names.windows(2).all(|w| w[0] != w[1]), "{found}");
                }
            }
        }
    }

    #[test]
    fn log_scale_rejects_nonpositive_values() {
        let ruler = logarithmic(&[1.0, 5.0], Ends::Ticks);
        assert!(ruler.shows(2.0) && !ruler.shows(0.0) && !ruler.shows(f64::NAN));
    }

    #[test]
    fn categories_have_names() {
        let axis = Axis { categories: ["a".into(), "b".repeat(40)].to_vec(), ..Axis::default() };
        let ruler = axis.ruler([].into_iter(), 6, Ends::Ticks);
        assert_eq!(labels(&ruler), ["a".to_string(), "b".repeat(27) + "…"]);
        assert_eq!([1.0, 2.0].map(|v| ruler.fraction(v)), [0.25, 0.75]);
        assert_eq!([cut("abc", 3), cut("abcd", 3), cut("abcd", 0)], ["abc", "ab…", "a…"]);
    }
}
