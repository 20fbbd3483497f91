//! Column headings with units.

use crate::scene::units::{Dimension, Force, Length, Time};
use std::path::Path;
use trackbed_io::read::ReadError;

/// Column of a table.
pub struct Column {
    /// Name in messages.
    pub name: &'static str,
    /// Lower-case names; `""` for a unit without name.
    names: &'static [&'static str],
    /// Units with factor to SI; empty for plain numbers.
    units: &'static [(&'static str, f64)],
    /// Words of other quantities, if the name may be any other, or several words with one of `names`.
    others: Option<&'static [&'static str]>,
}

impl Column {
    /// Plain number.
    pub const fn number(name: &'static str, names: &'static [&'static str]) -> Column {
        Column { name, names, units: &[], others: None }
    }

    /// A length [m].
    pub const fn length(name: &'static str, names: &'static [&'static str]) -> Column {
        Column { name, names, units: Length::UNITS, others: None }
    }

    /// SI unit.
    pub fn si_unit(&self) -> &'static str {
        self.units.first().map_or("", |(name, _)| name)
    }

    /// Accepts any name in a table without further columns.
    #[must_use]
    pub const fn of_any_name(self) -> Column {
        Column { others: Some(&[]), ..self }
    }

    fn is_named(&self, (name, unit): &Title) -> bool {
        if name.is_empty() {
            return self.names.contains(&"") && unit.is_some_and(|unit| of_unit(unit, self.units).is_some());
        }
        match self.others {
            None => self.names.contains(&name.as_str()),
            Some(others) => {
                words(name).any(|word| self.names.contains(&word))
                    && !words(name).any(|w| others.contains(&w))
            }
        }
    }

    fn accepts(&self, (name, unit): &Title) -> bool {
        let blank = name.is_empty() && unit.is_none();
        let other = |others: &[&str]| words(name).any(|word| others.contains(&word));
        self.others.is_some_and(|others| !other(others)) && !blank && name.parse::<f64>().is_err()
    }

    fn expected(&self) -> String {
        let names: Vec<&str> = self.names.iter().copied().filter(|name| !name.is_empty()).collect();
        match names.as_slice() {
            [] | [_] => format!("a column of {}", self.name),
            [first @ .., last] => format!("a column of {} ({} or {last})", self.name, first.join(", ")),
        }
    }

    fn factor(&self, unit: Option<&str>) -> Result<f64, String> {
        unit.map_or(Some(1.0), |unit| of_unit(unit, self.units)).ok_or_else(|| {
            let units: Vec<&str> = self.units.iter().map(|(unit, _)| *unit).collect();
            match units.len() {
                0 => "a number without a unit".to_string(),
                _ => format!("one of the units {}", units.join(", ")),
            }
        })
    }
}

/// A time [s].
pub const TIME: Column =
    Column { name: "time", names: &["time", "t", "zeit", "temps", ""], units: Time::UNITS, others: None };
/// Dimensionless factor.
pub const FACTOR: Column = Column {
    name: "factor",
    names: &["factor", "factors", "multiplier", "faktor", "facteur"],
    units: &[],
    others: Some(&[]),
};
/// Force [N].
pub const FORCE: Column = Column {
    name: "force",
    names: &["force", "load", "f", "fz", "q", "kraft", "last", ""],
    units: Force::UNITS,
    others: Some(&[
        "acceleration",
        "case",
        "cycle",
        "deflection",
        "displacement",
        "factor",
        "id",
        "moment",
        "number",
        "position",
        "pressure",
        "settlement",
        "speed",
        "step",
        "strain",
        "stress",
        "uplift",
        "velocity",
    ]),
};

/// Lower-case name and unit of a heading field.
type Title<'a> = (String, Option<&'a str>);

fn words(name: &str) -> impl Iterator<Item = &str> {
    name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty())
}

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

/// Columns of the quantities of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heading<const N: usize> {
    /// Number of columns.
    pub width: usize,
    /// Column of each quantity, from 0, and its factor to SI.
    pub columns: [(usize, f64); N],
}

impl<const N: usize> Heading<N> {
    /// Reads a heading: named columns in any order; without further columns, some names are free.
    ///
    /// # Errors
    /// Missing or ambiguous column, other unit.
    pub fn read(
        file: &Path,
        line: usize,
        fields: &[&str],
        columns: &[Column; N],
    ) -> Result<Heading<N>, ReadError> {
        let titles: Vec<Title> = fields.iter().map(|field| title(field)).collect();
        let mut at = [None; N];
        for (at, column) in at.iter_mut().zip(columns) {
            *at = named(column, &titles).map_err(|found| {
                super::fault(file, Some(line), "heading", found, format!("one column of {}", column.name))
            })?;
        }
        for k in 0..N {
            let free = (0..fields.len()).find(|i| !at.contains(&Some(*i)));
            if at[k].is_none() && fields.len() == N {
                at[k] = free.filter(|free| columns[k].accepts(&titles[*free]));
            }
            if at[k].is_none() {
                return Err(missing(file, line, fields, &columns[k], N, free));
            }
        }
        let at = at.map(|at| at.expect("missing columns are errors"));
        let mut heading = Heading { width: fields.len(), columns: at.map(|at| (at, 1.0)) };
        for ((place, factor), column) in heading.columns.iter_mut().zip(columns) {
            *factor = column.factor(titles[*place].1).map_err(|expected| {
                super::fault(file, Some(line), column.name, format!("\"{}\"", fields[*place]), expected)
            })?;
        }
        Ok(heading)
    }

    /// Whether a comment is a heading: it names every column.
    pub fn is_stated(fields: &[&str], columns: &[Column; N]) -> bool {
        let titles: Vec<Title> = fields.iter().map(|field| title(field)).collect();
        columns.iter().all(|column| titles.iter().any(|title| column.is_named(title)))
    }
}

/// Column with the name; of several, the standard one.
fn named(column: &Column, titles: &[Title]) -> Result<Option<usize>, String> {
    let all: Vec<usize> = (0..titles.len()).filter(|k| column.is_named(&titles[*k])).collect();
    let exact: Vec<usize> = all.iter().copied().filter(|k| titles[*k].0 == column.name).collect();
    match (all.as_slice(), exact.as_slice()) {
        ([], _) => Ok(None),
        ([one], _) | (_, [one]) => Ok(Some(*one)),
        _ => {
            let names: Vec<&str> = all.iter().map(|k| titles[*k].0.as_str()).collect();
            Err(format!("columns {}", names.join(", ")))
        }
    }
}

fn missing(
    file: &Path,
    line: usize,
    fields: &[&str],
    column: &Column,
    count: usize,
    free: Option<usize>,
) -> ReadError {
    let fault = |found: String, expected: String| super::fault(file, Some(line), "heading", found, expected);
    match (fields, free) {
        ([words], _) if is_row_of_blanks(words, column, count) => {
            let expected = "commas, semicolons or tabs between the columns".to_string();
            fault(format!("\"{words}\", separated by blanks"), expected)
        }
        (_, Some(free)) if fields.len() <= count => {
            fault(format!("\"{}\"", fields[free]), format!("{}, or a row of numbers", column.expected()))
        }
        _ => fault(format!("columns {}", fields.join(", ")), column.expected()),
    }
}

/// Numbers, or a heading that begins with the name of a column.
fn is_row_of_blanks(text: &str, column: &Column, count: usize) -> bool {
    let first = text.split_whitespace().next().unwrap_or_default();
    let begins = column.is_named(&title(first)) || first.parse::<f64>().is_ok();
    begins && count > 1 && text.split_whitespace().count() >= count
}

fn title(field: &str) -> Title<'_> {
    let (name, unit) = split(field);
    (name.to_lowercase(), unit)
}

/// Field of a comment that states another unit than SI.
pub fn foreign_unit<'a>(fields: &[&'a str], columns: &[Column]) -> Option<&'a str> {
    let foreign = |field: &&&str| {
        let (name, unit) = title(field);
        let known = unit.filter(|unit| {
            !name.is_empty()
                && (OTHERS.contains(unit) || WORDS.iter().any(|(word, _)| unit.eq_ignore_ascii_case(word)))
        });
        let of = columns.iter().find(|column| column.names.contains(&name.as_str()));
        known.zip(of).is_some_and(|(unit, column)| of_unit(unit, column.units) != Some(1.0))
    };
    fields.iter().find(foreign).copied()
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

    fn of(heading: &str, columns: &[Column; 2]) -> Result<[(usize, f64); 2], String> {
        let fields: Vec<&str> = heading.split(',').collect();
        let read = Heading::read(Path::new("c.csv"), 1, &fields, columns);
        read.map(|heading| heading.columns).map_err(|e| e.to_string())
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
            assert_eq!(of(heading, &[TIME, FACTOR]), Ok([(0, factor), (1, 1.0)]), "{heading}");
        }
        assert_eq!(of("time,factor [%]", &[TIME, FACTOR]), Ok([(0, 1.0), (1, 0.01)]));
        assert_eq!(of("time,%", &[TIME, FACTOR]), Ok([(0, 1.0), (1, 0.01)]));
        assert_eq!(of("time [ms],force [kN]", &[TIME, FORCE]), Ok([(0, 1e-3), (1, 1e3)]));
        for heading in ["time,load_kN", "time,F_z_kN", "s,kN", "t,Q (kN)", "time,Kraft [kN]"] {
            assert_eq!(of(heading, &[TIME, FORCE]), Ok([(0, 1.0), (1, 1e3)]), "{heading}");
        }
        let lengths = [Column::length("x", &["x"]), Column::length("r", &["r", "radius"])];
        assert_eq!(of("x [mm],Radius [mm]", &lengths), Ok([(0, 1e-3), (1, 1e-3)]));
    }

    #[test]
    fn names_select_columns() {
        for (heading, columns, at) in [
            ("time,load_case,factor", [TIME, FACTOR], [0, 2]),
            ("factor,time", [TIME, FACTOR], [1, 0]),
            ("displacement over its largest,time", [TIME, FACTOR], [1, 0]),
            ("n,load factor,remark,t", [TIME, FACTOR], [3, 1]),
            ("time,displacement,force", [TIME, FORCE], [0, 2]),
            ("u [mm],F [N],time [s],load case", [TIME, FORCE], [2, 1]),
            ("T,load,time,force", [TIME, FORCE], [2, 3]),
            ("-F [N],time", [TIME, FORCE], [1, 0]),
            ("signal,time", [TIME, FORCE], [1, 0]),
        ] {
            assert_eq!(of(heading, &columns).map(|found| found.map(|(k, _)| k)), Ok(at), "{heading}");
        }
        let pair = || [Column::number("a", &["a"]).of_any_name(), Column::number("b", &["b"]).of_any_name()];
        for (heading, at) in [("i,j", [0, 1]), ("b,a", [1, 0]), ("id,a,b", [1, 2])] {
            assert_eq!(of(heading, &pair()).map(|found| found.map(|(k, _)| k)), Ok(at), "{heading}");
        }
        assert!(of("id,i,j", &pair()).is_err());
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
                "factor,place",
                "c.csv:1: heading: found \"place\", expected a column of time (time, t, zeit or temps), or a row of numbers",
            ),
            (
                "time,load_case,displacement",
                "c.csv:1: heading: found columns time, load_case, displacement, expected a column of factor (factor, factors, \
                 multiplier, faktor or facteur)",
            ),
            (
                "time,factor x,factor y",
                "c.csv:1: heading: found columns factor x, factor y, expected one column of factor",
            ),
            (
                "time factor",
                "c.csv:1: heading: found \"time factor\", separated by blanks, expected commas, semicolons or tabs",
            ),
            ("time [s] factor [-]", "c.csv:1: heading: found \"time [s] factor [-]\", separated by blanks"),
            ("0 0", "c.csv:1: heading: found \"0 0\", separated by blanks"),
            ("O,1.5", "c.csv:1: heading: found \"O\""),
            ("time,1.5", "c.csv:1: heading: found \"1.5\""),
        ] {
            let found = of(heading, &[TIME, FACTOR]).unwrap_err();
            assert!(found.starts_with(message), "{heading}: {found}");
        }
        for heading in ["time,displacement", "time,pressure", "time,load step", "time,load,F"] {
            let found = of(heading, &[TIME, FORCE]).unwrap_err();
            assert!(found.starts_with("c.csv:1: heading: found "), "{heading}: {found}");
        }
        let lengths = [Column::length("x", &["x"]), Column::length("r", &["r", "radius"])];
        assert!(of("x,d", &lengths).unwrap_err().contains("found \"d\", expected a column of r"));
    }

    #[test]
    fn units_of_comments_need_a_name() {
        let columns = [TIME, FORCE];
        for field in ["time in milliseconds", "time [ms]", "t_ms", "force in kN", "F [kN]", "load (kN)"] {
            assert_eq!(foreign_unit(&["note", field], &columns), Some(field));
        }
        for field in
            ["time in s", "time", "force [N]", "largest load 80 kN", "10 mm ballast", "mm", "t = 5 ms", ""]
        {
            assert_eq!(foreign_unit(&[field], &columns), None, "{field}");
        }
        assert!(Heading::is_stated(&["force", "time [ms]"], &columns));
        assert!(!Heading::is_stated(&["time", "in seconds"], &[TIME, FACTOR]));
    }
}
