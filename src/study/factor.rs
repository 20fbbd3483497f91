//! Varied parameters as numbers.

use super::axis::Setting;
use serde::{Deserialize, Serialize};

/// Ratio of largest to smallest value from which an axis with listed values is logarithmic.
const LOGARITHMIC: f64 = 100.0;

/// Varied parameter: a number, or a category.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Factor {
    /// Name.
    pub name: String,
    /// Unit, or empty.
    pub unit: String,
    /// Whether logarithmic.
    pub log: bool,
    /// Smallest and largest value.
    pub range: [f64; 2],
    /// Categories, numbered from 1; empty for numbers.
    pub categories: Vec<String>,
    /// Whether a seed of random specimens.
    #[serde(default)]
    pub random: bool,
}

impl Factor {
    /// Returns name and unit.
    pub fn head(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{} [{}]", self.name, self.unit) }
    }

    /// Returns the value as regressor.
    pub fn regressor(&self, value: f64) -> f64 {
        if self.log { libm::log10(value) } else { value }
    }

    /// Formats a value: number or category.
    pub fn text(&self, value: f64) -> String {
        match self.categories.get((value as usize).wrapping_sub(1)) {
            Some(category) => category.clone(),
            None => value.to_string(),
        }
    }

    /// Creates the factor of axis `index`, with its value in each case; a case without levels has none.
    pub fn of_axis(name: &str, index: usize, settings: &[Setting]) -> (Factor, Vec<Option<f64>>) {
        let levels: Vec<Option<&str>> =
            settings.iter().map(|s| s.levels.get(index).map(String::as_str)).collect();
        let split: Option<Vec<(f64, &str)>> = levels.iter().flatten().map(|l| number(l)).collect();
        if let Some(numbers) = split.filter(|n| n.iter().all(|(_, unit)| *unit == n[0].1)) {
            let values = || numbers.iter().map(|(value, _)| *value);
            let range = [values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max)];
            let log = range[0] > 0.0 && range[1] >= LOGARITHMIC * range[0];
            let unit = numbers.first().map_or("", |n| n.1).to_string();
            let factor = Factor { name: name.into(), unit, log, range, ..Factor::default() };
            return (factor, levels.iter().map(|l| Some(number((*l)?)?.0)).collect());
        }
        let mut categories: Vec<String> = Vec::new();
        let mut values = Vec::new();
        for level in levels {
            values.push(level.map(|level| {
                let known = categories.iter().position(|c| c == level);
                let at = known.unwrap_or_else(|| {
                    categories.push(level.into());
                    categories.len() - 1
                });
                (at + 1) as f64
            }));
        }
        let range = [1.0, categories.len() as f64];
        (Factor { name: name.into(), range, categories, ..Factor::default() }, values)
    }
}

/// Splits `0.1 ms` into number and unit.
fn number(level: &str) -> Option<(f64, &str)> {
    let (value, unit) = level.trim().split_once(' ').unwrap_or((level.trim(), ""));
    Some((value.parse().ok().filter(|v: &f64| v.is_finite())?, unit.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(levels: &[&str]) -> (Factor, Vec<Option<f64>>) {
        let setting = |level: &&str| Setting {
            label: String::new(),
            levels: if level.is_empty() { Vec::new() } else { vec![level.to_string()] },
            set: Vec::new(),
        };
        Factor::of_axis("x", 0, &levels.iter().map(setting).collect::<Vec<_>>())
    }

    #[test]
    fn levels_become_numbers_or_categories() {
        let (numbers, values) = factor(&["", "60 kPa", "35 kPa"]);
        assert_eq!((numbers.head().as_str(), numbers.range, numbers.log), ("x [kPa]", [35.0, 60.0], false));
        assert_eq!(values, [None, Some(60.0), Some(35.0)]);
        let (decades, _) = factor(&["1e-5", "1e-2"]);
        assert!(decades.log && (decades.regressor(1e-2) + 2.0).abs() < 1e-12);
        // Different units are not converted.
        let (categories, values) = factor(&["1 s", "10 ms", "1 s"]);
        assert_eq!((categories.categories.len(), values[2]), (2, Some(1.0)));
        assert_eq!((categories.text(2.0).as_str(), numbers.text(35.0).as_str()), ("10 ms", "35"));
    }
}
