//! Score of blind predictions against measured values, beside two null models.
//!
//! All files have a row per test, cycle and strain; the null models know one given curve only.

use super::layout::{Cell, Table};
use super::statistics::rank_correlation;
use serde::Deserialize;
use std::path::Path;
use trackbed_io::failure::Failure;
use trackbed_io::read::source;

/// Ratio within which a prediction is as good as a second laboratory.
const CLOSE: f64 = 1.5;
const COLUMNS: &str =
    "columns test, pressure [kPa], deviator [kPa], frequency [Hz], N, strain, value [%], low [%], high [%]";

/// Measured strain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Strain {
    /// Permanent axial strain, compression positive.
    Axial,
    /// Permanent volumetric strain, compaction positive.
    Volumetric,
}

/// Row of a file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    test: String,
    /// Cell pressure.
    #[serde(rename = "pressure [kPa]")]
    pressure: f64,
    /// Largest deviator stress.
    #[serde(rename = "deviator [kPa]")]
    deviator: f64,
    #[serde(rename = "frequency [Hz]")]
    frequency: f64,
    /// Load cycle.
    #[serde(rename = "N")]
    cycle: f64,
    strain: Strain,
    /// Mean of the specimens; empty: none.
    #[serde(rename = "value [%]")]
    value: Option<f64>,
    /// Smallest and largest value of the specimens.
    #[serde(rename = "low [%]")]
    low: Option<f64>,
    #[serde(rename = "high [%]")]
    high: Option<f64>,
}

impl Row {
    fn is_of(&self, other: &Row) -> bool {
        self.test == other.test && self.cycle == other.cycle && self.strain == other.strain
    }

    fn stress_ratio(&self) -> f64 {
        self.deviator / self.pressure
    }
}

fn read(file: &Path) -> Result<Vec<Row>, Failure> {
    let refuse = |line: u64, found: String, expected: &str| {
        Failure::Input(format!("{}:{line}: found {found}, expected {expected}", file.display()))
    };
    let bytes = source::bytes(file, source::LARGEST_TEXT).map_err(|r| Failure::Input(r.sentence(file)))?;
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(&bytes[..]);
    let heads = reader.headers().map_err(|e| refuse(1, e.to_string(), COLUMNS))?.clone();
    let mut rows: Vec<Row> = Vec::new();
    for record in reader.records() {
        let record = record
            .map_err(|e| refuse(e.position().map_or(1, csv::Position::line), e.to_string(), COLUMNS))?;
        let line = record.position().map_or(1, csv::Position::line);
        let row: Row = record.deserialize(Some(&heads)).map_err(|e| {
            let text = match e.kind() {
                csv::ErrorKind::Deserialize { err, .. } => err.kind().to_string(),
                _ => e.to_string(),
            };
            let (found, expected) = text.split_once(", expected ").unwrap_or((&text, COLUMNS));
            refuse(line, found.into(), expected)
        })?;
        for (name, value, positive) in [
            ("pressure", Some(row.pressure), true),
            ("deviator", Some(row.deviator), true),
            ("frequency", Some(row.frequency), true),
            ("N", Some(row.cycle), true),
            ("value", row.value, false),
            ("low", row.low, false),
            ("high", row.high, false),
        ] {
            let fits = |v: f64| v.is_finite() && (!positive || v > 0.0);
            if let Some(value) = value.filter(|v| !fits(*v)) {
                let expected = if positive { "a number above 0" } else { "a finite number" };
                return Err(refuse(line, format!("{name} {value}"), expected));
            }
        }
        if rows.iter().any(|other| other.is_of(&row)) {
            return Err(refuse(line, format!("N = {} of {} twice", row.cycle, row.test), "one row each"));
        }
        rows.push(row);
    }
    match rows.is_empty() {
        true => Err(refuse(1, "no rows".into(), COLUMNS)),
        false => Ok(rows),
    }
}

/// Strain of the given curve after a cycle, linear in ln N between and beyond its rows; none with less than two.
fn on_curve(given: &[Row], strain: Strain, cycle: f64) -> Option<f64> {
    let rows = given.iter().filter(|row| row.strain == strain);
    let mut points: Vec<(f64, f64)> =
        rows.filter_map(|row| Some((libm::log(row.cycle), row.value?))).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let x = libm::log(cycle);
    let last = points.len().checked_sub(2)?;
    let first = points[1..=last].iter().take_while(|p| p.0 < x).count();
    let [a, b] = [points[first], points[first + 1]];
    Some(a.1 + (b.1 - a.1) * (x - a.0) / (b.0 - a.0))
}

/// Null model: the given curve for all tests, or `scaled` by their q/p.
fn null_model(measured: &[Row], given: &[Row], scaled: bool) -> Vec<Row> {
    let row = |row: &Row| {
        let factor = if scaled { row.stress_ratio() / given[0].stress_ratio() } else { 1.0 };
        let value = on_curve(given, row.strain, row.cycle).map(|value| factor * value);
        Row { value, low: None, high: None, ..row.clone() }
    };
    measured.iter().map(row).collect()
}

/// Agreement of one model with measured values.
#[derive(Debug, Default, PartialEq)]
struct Score {
    /// Measured values, and those without a prediction.
    count: usize,
    missing: usize,
    /// Fraction within 1.5 times, of axial and volumetric strains; a missing one is outside.
    close: [Option<f64>; 2],
    /// Median of the factor between predicted and measured axial strain.
    factor: Option<f64>,
    /// Mean rank correlation of axial strain over tests of equal cycle.
    order: Option<f64>,
    /// Fraction of measured values between smallest and largest prediction.
    spread: Option<f64>,
}

fn is_close(predicted: f64, measured: f64) -> bool {
    let ratio = predicted / measured;
    (1.0 / CLOSE..=CLOSE).contains(&ratio)
}

fn fraction(all: impl Iterator<Item = bool>) -> Option<f64> {
    let (count, good) = all.fold((0, 0), |(count, good), one| (count + 1, good + usize::from(one)));
    (count > 0).then(|| good as f64 / count as f64)
}

/// Median of ascending values; none without any.
fn median(sorted: &[f64]) -> Option<f64> {
    let middle = sorted.len() / 2;
    let upper = *sorted.get(middle)?;
    Some(if sorted.len() % 2 == 1 { upper } else { 0.5 * (sorted[middle - 1] + upper) })
}

fn score(measured: &[Row], model: &[Row]) -> Score {
    let found = |row: &Row| model.iter().find(|other| other.is_of(row));
    // Measured row and value, prediction.
    let pairs: Vec<(&Row, f64, Option<&Row>)> = measured
        .iter()
        .filter_map(|row| Some((row, row.value?, found(row).filter(|p| p.value.is_some()))))
        .collect();
    let of = |strain: Strain| pairs.iter().filter(move |(row, ..)| row.strain == strain);
    let predicted = |pair: &(&Row, f64, Option<&Row>)| pair.2.and_then(|p| p.value);
    let close = |strain| fraction(of(strain).map(|p| predicted(p).is_some_and(|v| is_close(v, p.1))));
    let mut factors: Vec<f64> = of(Strain::Axial)
        .filter_map(|p| Some(libm::log(predicted(p)? / p.1).abs()).filter(|f| f.is_finite()))
        .collect();
    factors.sort_by(f64::total_cmp);
    let mut cycles: Vec<f64> = of(Strain::Axial).map(|p| p.0.cycle).collect();
    cycles.sort_by(f64::total_cmp);
    cycles.dedup();
    let order = |cycle: &f64| {
        let tests: Vec<_> = of(Strain::Axial).filter(|p| p.0.cycle == *cycle).collect();
        let values: Vec<(f64, f64)> = tests.iter().filter_map(|p| Some((p.1, predicted(p)?))).collect();
        let (x, y): (Vec<f64>, Vec<f64>) = values.into_iter().unzip();
        rank_correlation(&x, &y)
    };
    let orders: Vec<f64> = cycles.iter().filter_map(order).collect();
    let ranges = pairs.iter().filter_map(|p| Some((p.1, p.2?.low?, p.2?.high?)));
    Score {
        count: pairs.len(),
        missing: pairs.iter().filter(|p| p.2.is_none()).count(),
        close: [Strain::Axial, Strain::Volumetric].map(close),
        factor: median(&factors).map(libm::exp),
        order: (!orders.is_empty()).then(|| orders.iter().sum::<f64>() / orders.len() as f64),
        spread: fraction(ranges.map(|(value, low, high)| (low..=high).contains(&value))),
    }
}

/// Scores predictions, and with the `given` curve the null models; returns the table.
///
/// # Errors
/// Unreadable or invalid files; predictions of none of the measured values.
pub fn scored(predictions: &Path, measured: &Path, given: Option<&Path>) -> Result<String, Failure> {
    let (own, known) = (read(predictions)?, read(measured)?);
    let mut models = vec![("predictions", score(&known, &own))];
    if models[0].1.missing == models[0].1.count {
        return Err(Failure::Input(format!(
            "{}: found no value of a test, cycle and strain of {}, expected one or more",
            predictions.display(),
            measured.display()
        )));
    }
    if let Some(given) = given {
        let given = read(given)?;
        models.push(("given curve times q/p", score(&known, &null_model(&known, &given, true))));
        models.push(("given curve for all tests", score(&known, &null_model(&known, &given, false))));
    }
    let heads = [
        "model",
        "values",
        "missing",
        "axial within 1.5",
        "volumetric within 1.5",
        "median factor",
        "order of tests",
        "inside spread",
    ];
    let row = |(name, s): &(&str, Score)| {
        let count = |n: usize| Cell::text(n.to_string());
        let numbers = [s.close[0], s.close[1], s.factor, s.order, s.spread].map(Cell::number);
        let first = [Cell::text(*name), count(s.count), count(s.missing)];
        first.into_iter().chain(numbers).collect::<Vec<Cell>>()
    };
    let table = Table { heads: heads.map(String::from).to_vec(), rows: models.iter().map(row).collect() };
    Ok(table.aligned(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(test: &str, pressure: f64, cycle: f64, strain: Strain, value: Option<f64>) -> Row {
        let (deviator, frequency, test) = (230.0, 5.0, test.to_string());
        Row { test, pressure, deviator, frequency, cycle, strain, value, low: None, high: None }
    }

    #[test]
    fn score_counts_close_ordered_and_missing() {
        use Strain::{Axial, Volumetric};
        let value = |test, p, n, strain, v: f64| row(test, p, n, strain, Some(v));
        let measured = [
            value("a", 10.0, 10.0, Axial, 4.0),
            value("b", 30.0, 10.0, Axial, 2.0),
            value("c", 60.0, 10.0, Axial, 1.0),
            value("a", 10.0, 10.0, Volumetric, -0.2),
            value("b", 30.0, 10.0, Volumetric, 0.3),
        ];
        let mut model = measured.to_vec();
        (model[0].value, model[1].value, model[2].value) = (Some(5.9), Some(3.1), Some(0.9));
        (model[0].low, model[0].high) = (Some(3.0), Some(6.0));
        (model[1].low, model[1].high) = (Some(2.5), Some(3.5));
        // Dilation predicted as compaction is not close; the last one is missing.
        model[3].value = Some(0.2);
        model[4].value = None;
        let found = score(&measured, &model);
        assert_eq!((found.count, found.missing), (5, 1));
        assert_eq!(found.close, [Some(2.0 / 3.0), Some(0.0)]);
        assert!((found.factor.unwrap() - 1.475).abs() < 1e-12, "{found:?}");
        assert_eq!((found.order, found.spread), (Some(1.0), Some(0.5)));
        assert_eq!(score(&measured, &measured).close, [Some(1.0), Some(1.0)]);
        let close =
            [(1.5, 1.0), (1.0, 1.5), (1.6, 1.0), (1.0, 1.6), (-1.0, 1.0)].map(|(a, b)| is_close(a, b));
        assert_eq!(close, [true, true, false, false, false]);
        assert_eq!(
            [median(&[]), median(&[1.0, 3.0]), median(&[1.0, 2.0, 9.0])],
            [None, Some(2.0), Some(2.0)]
        );
    }

    #[test]
    fn null_models_follow_given_curve() {
        let given = [1.0, 10.0, 100.0]
            .map(|n: f64| row("given", 30.0, n, Strain::Axial, Some(libm::log10(n).powi(2))));
        // Between and beyond the rows; at four times the pressure a quarter of the strain.
        for (cycle, expected) in [(10.0, 1.0), (libm::pow(10.0, 1.5), 2.5), (1000.0, 7.0), (0.1, -1.0)] {
            let measured = [row("x", 120.0, cycle, Strain::Axial, None)];
            for (scaled, factor) in [(true, 0.25), (false, 1.0)] {
                let found = null_model(&measured, &given, scaled)[0].value.unwrap();
                assert!((found - factor * expected).abs() < 1e-9, "{cycle}: {found}");
            }
        }
        assert_eq!(null_model(&[row("x", 30.0, 1.0, Strain::Volumetric, None)], &given, true)[0].value, None);
    }
}
