//! Reads quantities from results.

use super::curve::Sample;
use super::file::Take;
use super::quantity::{Quantity, Source};
use std::path::Path;
use trackbed_io::read::source;
use trackbed_io::replaced;

/// Reads a quantity and its unit.
///
/// # Errors
/// Missing file, column or number.
pub fn read(quantity: &Quantity, folder: &Path) -> Result<(Sample, String), String> {
    let own = quantity.unit.clone();
    let (sample, unit) = match &quantity.source {
        Source::Summary(path) => (Sample::Number(number_at(folder, path)?), String::new()),
        Source::Column(file, column, take) => {
            let (values, unit) = Table::read(folder, file)?.column(column)?;
            (Sample::Number(reduce(file, &values, *take)?), unit)
        }
        Source::Curve { file, column, against, log } => {
            let table = Table::read(folder, file)?;
            let (values, unit) = table.column(column)?;
            let abscissa = match against {
                Some(name) => table.column(name)?.0,
                None => table.rows.iter().map(|row| row[0]).collect(),
            };
            let points = abscissa.into_iter().zip(values);
            let points = points.map(|(x, y)| [if *log { libm::log10(x) } else { x }, y]);
            // The row at 0 has no logarithm.
            let points: Vec<[f64; 2]> = points.filter(|p| p[0].is_finite()).collect();
            if points.is_empty() {
                return Err(format!("{file}: no row to compare"));
            }
            (Sample::curve(points), unit)
        }
    };
    let sample = match sample {
        Sample::Number(value) => Sample::Number(value * quantity.factor),
        Sample::Curve(points) => {
            Sample::Curve(points.iter().map(|p| [p[0], p[1] * quantity.factor]).collect())
        }
    };
    let unit = own.unwrap_or(if quantity.factor == 1.0 { unit } else { String::new() });
    Ok((sample, unit))
}

fn reduce(file: &str, values: &[f64], take: Take) -> Result<f64, String> {
    let Some(last) = values.last() else { return Err(format!("{file} has no rows")) };
    Ok(match take {
        Take::Last | Take::Curve => *last,
        Take::Mean => values.iter().sum::<f64>() / values.len() as f64,
        Take::Max => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        Take::Min => values.iter().copied().fold(f64::INFINITY, f64::min),
    })
}

fn number_at(folder: &Path, path: &str) -> Result<f64, String> {
    let file = "summary.json";
    let bytes = source::bytes(&folder.join(file), source::LARGEST_TEXT)
        .map_err(|refusal| format!("{file}: {}", refusal.words(|e| e.to_string()).0))?;
    let mut summary: serde_json::Value =
        serde_json::from_slice(&bytes).map_err(|e| format!("{file}: {e}"))?;
    replaced::update(&mut summary);
    let mut value = &summary;
    for part in path.split('.') {
        let next = match value {
            serde_json::Value::Array(list) if part == "last" => list.last(),
            serde_json::Value::Array(list) => match part.parse::<usize>() {
                Ok(index) => list.get(index),
                Err(_) => list.iter().find(|entry| entry["name"] == part),
            },
            other => other.get(part),
        };
        value = next.ok_or_else(|| format!("{file} has no `{part}` of `{path}`"))?;
    }
    let number = value.as_f64().filter(|v| v.is_finite());
    number.ok_or_else(|| format!("{file} has no number at `{path}`"))
}

struct Table<'a> {
    file: &'a str,
    heads: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table<'_> {
    fn read<'a>(folder: &Path, file: &'a str) -> Result<Table<'a>, String> {
        let bytes = source::bytes(&folder.join(file), source::LARGEST)
            .map_err(|refusal| format!("{file}: {}", refusal.words(|e| e.to_string()).0))?;
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        let heads = reader.headers().map_err(|e| format!("{file}: {e}"))?.iter().map(String::from).collect();
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|e| format!("{file}: {e}"))?;
            let row = record.iter().map(|cell| cell.parse().ok().filter(|v: &f64| v.is_finite()));
            rows.push(
                row.collect::<Option<Vec<f64>>>()
                    .ok_or_else(|| format!("{file} has a cell that is no number"))?,
            );
        }
        Ok(Table { file, heads, rows })
    }

    fn column(&self, name: &str) -> Result<(Vec<f64>, String), String> {
        let split = |head: &str| {
            let (name, unit) = head.split_once(" [").unwrap_or((head, ""));
            (name.to_string(), unit.trim_end_matches(']').to_string())
        };
        let Some(at) = self.heads.iter().position(|head| split(head).0 == name) else {
            let names: Vec<String> = self.heads.iter().map(|h| split(h).0).collect();
            return Err(format!("{} has no column `{name}`, but {}", self.file, names.join(", ")));
        };
        Ok((self.rows.iter().map(|row| row[at]).collect(), split(&self.heads[at]).1))
    }
}
