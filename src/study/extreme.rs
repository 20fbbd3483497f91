//! Loads of return periods from the largest value of each run.

use super::curve::Sample;
use super::file::ExtremeTable;
use super::layout::{Cell, Table};
use super::quantity::{Quantity, Source};
use serde::{Deserialize, Serialize};
use trackbed_input::scene::{Document, SceneError};
use trackbed_io::extremes::{FEWEST, Fit, Interval, Law};

/// Confidence of the intervals.
const CONFIDENCE: f64 = 0.9;

/// Extreme values of a quantity: one event per run.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// Index of the quantity.
    pub quantity: usize,
    /// Events per year.
    pub events_per_year: f64,
    /// Return periods [years].
    pub return_periods: Vec<f64>,
    /// Confidence of the intervals.
    pub confidence: f64,
}

/// Extreme values of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ExtremeRow {
    /// Label of the case.
    pub case: String,
    /// Name and unit of the quantity.
    pub quantity: String,
    /// Number of runs.
    pub runs: usize,
    /// Gumbel law; none for too few or equal values.
    pub fit: Option<Fit>,
    /// Confidence of the intervals.
    pub confidence: f64,
    /// Return period [years] and value.
    pub values: Vec<(f64, Interval)>,
}

/// Resolves the tables.
///
/// # Errors
/// Input errors.
pub fn resolve(
    document: &Document,
    tables: &[ExtremeTable],
    quantities: &[Quantity],
    seeds: usize,
) -> Result<Vec<Extreme>, SceneError> {
    let mut extremes: Vec<Extreme> = Vec::new();
    for (k, table) in tables.iter().enumerate() {
        let error = |key: &str, found: String, expected: &str| {
            document.error(&format!("extreme.{k}.{key}"), found, expected)
        };
        let quoted = || format!("{:?}", table.quantity);
        let Some(quantity) = quantities.iter().position(|q| q.name == table.quantity) else {
            let names: Vec<String> = quantities.iter().map(|q| format!("{:?}", q.name)).collect();
            return Err(error("quantity", quoted(), &format!("one of {}", names.join(", "))));
        };
        if matches!(quantities[quantity].source, Source::Curve { .. }) {
            return Err(error("quantity", quoted(), "a quantity without take = \"curve\""));
        }
        let events = table.events_per_year;
        if !(events.is_finite() && events > 0.0) {
            return Err(error("events_per_year", events.to_string(), "a number above 0"));
        }
        let periods = &table.return_periods;
        if periods.is_empty() || !periods.iter().all(|t| t.is_finite() && t * events > 1.0) {
            let expected = "return periods of more than one event";
            return Err(error("return_periods", format!("{periods:?}"), expected));
        }
        let confidence = table.confidence.unwrap_or(CONFIDENCE);
        if !(confidence > 0.0 && confidence < 1.0) {
            return Err(error("confidence", confidence.to_string(), "between 0 and 1"));
        }
        if seeds < FEWEST {
            let expected = format!("at least {FEWEST} seeds with [[extreme]]");
            return Err(document.error("seeds.values", format!("{seeds} seeds"), expected));
        }
        let return_periods = periods.clone();
        extremes.push(Extreme { quantity, events_per_year: events, return_periods, confidence });
    }
    Ok(extremes)
}

impl Extreme {
    /// Fits the completed runs of a case.
    pub fn row(&self, case: &str, quantity: String, samples: &[Sample]) -> ExtremeRow {
        let values: Vec<f64> = samples.iter().map(Sample::shown).collect();
        let fit = Fit::of(Law::Gumbel, 0.0, &values);
        let of = |fit: &Fit, period: f64| {
            (period, fit.quantile(1.0 / (self.events_per_year * period), self.confidence))
        };
        let all = fit.as_ref().map(|fit| self.return_periods.iter().map(|t| of(fit, *t)).collect());
        ExtremeRow {
            case: case.into(),
            quantity,
            runs: values.len(),
            confidence: self.confidence,
            values: all.unwrap_or_default(),
            fit,
        }
    }
}

/// Returns the values of all return periods.
pub fn table(rows: &[ExtremeRow]) -> Table {
    let heads =
        ["case", "quantity", "runs", "location", "scale", "return period [years]", "value", "interval"];
    let of = |row: &ExtremeRow| {
        let fit = row.fit.as_ref();
        let start = [
            Cell::text(&row.case),
            Cell::text(&row.quantity),
            Cell::Text(row.runs.to_string()),
            Cell::number(fit.map(|f| f.location)),
            Cell::number(fit.map(|f| f.scale)),
        ];
        let shown = |value: f64| Cell::Number(value, None).shown();
        let line = |(period, value): &(f64, Interval)| {
            let limits =
                format!("{} to {} ({} %)", shown(value.low), shown(value.high), 100.0 * row.confidence);
            let end = [Cell::Number(*period, None), Cell::Number(value.value, None), Cell::Text(limits)];
            start.iter().cloned().chain(end).collect::<Vec<Cell>>()
        };
        let none =
            start.iter().cloned().chain([Cell::Nothing, Cell::Nothing, Cell::text("no fit")]).collect();
        if row.values.is_empty() { vec![none] } else { row.values.iter().map(line).collect() }
    };
    Table { heads: heads.map(String::from).to_vec(), rows: rows.iter().flat_map(of).collect() }
}

/// Formats the values as Markdown.
pub fn section(rows: &[ExtremeRow]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let law = "Gumbel law of the values of the runs, by maximum likelihood; interval of the fit.";
    format!("\n## Return periods\n\n{law}\n\n{}", table(rows).markdown())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn return_value_is_exceeded_once_per_period() {
        let extreme = Extreme {
            quantity: 0,
            events_per_year: 12.0,
            return_periods: vec![10.0, 100.0],
            confidence: 0.9,
        };
        let loads = [231.0, 77.0, 142.0, 90.0, 52.0, 219.0].map(Sample::Number);
        let row = extreme.row("base", "load [kN]".into(), &loads);
        let fit = row.fit.unwrap();
        for (period, value) in &row.values {
            assert!((fit.exceedance(value.value) * 12.0 * period - 1.0).abs() < 1e-9, "{row:?}");
        }
        assert_eq!((row.runs, row.values.len(), table(&[row]).rows.len()), (6, 2, 2));
        let few = extreme.row("base", "load [kN]".into(), &loads[..4]);
        assert!(few.fit.is_none() && few.values.is_empty());
        assert!(section(&[few]).contains("| base | load [kN] | 4 | – | – | – | – | no fit |"));
        assert_eq!(section(&[]), "");
    }
}
