//! Column headings with units.

use crate::read::ReadError;
use crate::scene::units::{Dimension, Force, Length, Time};
use std::path::Path;

/// Column of a table.
pub struct Column {
    /// Name in messages.
    pub name: &'static str,
    names: &'static [&'static str],
    /// Units with factor to SI; empty for plain numbers.
    units: &'static [(&'static str, f64)],
}

impl Column {
    /// Plain number.
    pub const fn number(name: &'static str, names: &'static [&'static str]) -> Column {
        Column { name, names, units: &[] }
    }

    /// A length [m].
    pub const fn length(name: &'static str, names: &'static [&'static str]) -> Column {
        Column { name, names, units: Length::UNITS }
    }
}

/// A time [s].
pub const TIME: Column =
    Column { name: "time", names: &["time", "t", "zeit", "temps", ""], units: Time::UNITS };
/// Dimensionless factor, any heading.
pub const FACTOR: Column = Column { name: "factor", names: &[], units: &[] };
/// Force [N], any heading.
pub const FORCE: Column = Column { name: "force", names: &[], units: Force::UNITS };

const WORDS: [(&str, &str); 22] = [
    ("sec", "s"),
    ("secs", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("msec", "ms"),
    ("millisecond", "ms"),
    ("milliseconds", "ms"),
    ("µs", "us"),
    ("microseconds", "us"),
    ("minutes", "min"),
    ("hr", "h"),
    ("hours", "h"),
    ("metre", "m"),
    ("metres", "m"),
    ("meter", "m"),
    ("meters", "m"),
    ("millimetres", "mm"),
    ("millimeters", "mm"),
    ("kilonewton", "kN"),
    ("newton", "N"),
    ("-", ""),
    ("1", ""),
];

/// Foreign units, recognised to report them.
const OTHERS: [&str; 21] = [
    "s", "ms", "us", "min", "h", "m", "mm", "cm", "km", "in", "ft", "N", "kN", "MN", "Pa", "kPa", "MPa",
    "bar", "kg", "%", "lbf",
];

/// Returns factors to SI by column.
///
/// # Errors
/// Unknown heading or unit.
pub fn factors<const N: usize>(
    file: &Path,
    line: usize,
    fields: &[&str],
    columns: &[Column; N],
) -> Result<[f64; N], ReadError> {
    let mut factors = [1.0; N];
    for ((factor, column), field) in factors.iter_mut().zip(columns).zip(fields) {
        let (name, unit) = split(field);
        let known = column.names.is_empty() || column.names.contains(&name.to_lowercase().as_str());
        // A unit alone may denote time.
        if !known || name.is_empty() && unit.is_none() || name.parse::<f64>().is_ok() {
            let expected = format!("a column of {}, or a row of numbers", column.name);
            return Err(super::fault(file, Some(line), "heading", format!("\"{field}\""), expected));
        }
        *factor = unit.map_or(Some(1.0), |unit| of_unit(unit, column.units)).ok_or_else(|| {
            let units: Vec<&str> = column.units.iter().map(|(unit, _)| *unit).collect();
            let expected = match units.len() {
                0 => "a number without a unit".to_string(),
                _ => format!("one of the units {}", units.join(", ")),
            };
            super::fault(file, Some(line), column.name, format!("\"{field}\""), expected)
        })?;
    }
    Ok(factors)
}

/// `time [ms]`, `time (ms)`, `time/ms`, `time_ms`, `time in ms`, `ms`.
fn split(field: &str) -> (&str, Option<&str>) {
    let field = field.trim();
    for (open, close) in [('[', ']'), ('(', ')'), ('{', '}'), ('<', '>')] {
        if let Some((name, unit)) = field.strip_suffix(close).and_then(|rest| rest.rsplit_once(open)) {
            return (name.trim(), Some(unit.trim()));
        }
    }
    let at = field.rfind(|c: char| "/_ ,".contains(c));
    let (name, last) = at.map_or((&field[..0], field), |at| (&field[..at], &field[at + 1..]));
    if OTHERS.contains(&last) || WORDS.iter().any(|(word, _)| last.eq_ignore_ascii_case(word)) {
        let name = name.trim_end_matches(|c: char| "/_ ,".contains(c));
        return (name.strip_suffix(" in").unwrap_or(name), Some(last));
    }
    (field, None)
}

fn of_unit(unit: &str, units: &[(&str, f64)]) -> Option<f64> {
    let unit = unit.strip_prefix("in ").unwrap_or(unit);
    let word = WORDS.iter().find(|(word, _)| unit.eq_ignore_ascii_case(word)).map_or(unit, |(_, unit)| unit);
    match units.iter().find(|(known, _)| *known == word) {
        Some((_, factor)) => Some(*factor),
        None if word.is_empty() => Some(1.0),
        None if word == "%" && units.is_empty() => Some(0.01),
        None => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(heading: &str, columns: &[Column; 2]) -> Result<[f64; 2], String> {
        let fields: Vec<&str> = heading.split(',').collect();
        factors(Path::new("c.csv"), 1, &fields, columns).map_err(|e| e.to_string())
    }

    #[test]
    fn units_of_headings_are_obeyed() {
        for (heading, factor) in [
            ("time [ms],factor", 1e-3),
            ("time (ms),factor", 1e-3),
            ("Time/ms,load factor", 1e-3),
            ("t_ms,f", 1e-3),
            ("time in ms,factor [-]", 1e-3),
            ("time [milliseconds],factor [1]", 1e-3),
            ("ms,factor", 1e-3),
            ("time [s],displacement over its largest", 1.0),
            ("time,factor", 1.0),
            ("t [min],pressure over 10 kPa at most", 60.0),
        ] {
            assert_eq!(of(heading, &[TIME, FACTOR]), Ok([factor, 1.0]), "{heading}");
        }
        assert_eq!(of("time,factor [%]", &[TIME, FACTOR]), Ok([1.0, 0.01]));
        assert_eq!(of("time [ms],force [kN]", &[TIME, FORCE]), Ok([1e-3, 1e3]));
        assert_eq!(of("time,load_kN", &[TIME, FORCE]), Ok([1.0, 1e3]));
        let lengths = [Column::length("x", &["x"]), Column::length("r", &["r", "radius"])];
        assert_eq!(of("x [mm],Radius [mm]", &lengths), Ok([1e-3, 1e-3]));
    }

    #[test]
    fn other_units_and_columns_are_refused() {
        for (heading, message) in [
            (
                "time [ft],factor",
                "c.csv:1: time: found \"time [ft]\", expected one of the units s, ms, us, min, h",
            ),
            ("time,force [kN]", "c.csv:1: factor: found \"force [kN]\", expected a number without a unit"),
            ("time,pressure_kPa", "c.csv:1: factor: found \"pressure_kPa\""),
            (
                "factor,time",
                "c.csv:1: heading: found \"factor\", expected a column of time, or a row of numbers",
            ),
            ("O,1.5", "c.csv:1: heading: found \"O\""),
            ("time,1.5", "c.csv:1: heading: found \"1.5\""),
        ] {
            let found = of(heading, &[TIME, FACTOR]).unwrap_err();
            assert!(found.starts_with(message), "{heading}: {found}");
        }
        let lengths = [Column::length("x", &["x"]), Column::length("r", &["r", "radius"])];
        assert!(of("x,d", &lengths).unwrap_err().contains("found \"d\", expected a column of r"));
    }
}
