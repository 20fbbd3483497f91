//! Reads quantities from results.

use super::curve::{self, Sample};
use super::file::Take;
use super::quantity::{Quantity, Reduced, Source};
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
        Source::Column(reduced) => {
            let table = Table::read(folder, &reduced.file)?;
            let (values, unit) = table.sum(&reduced.columns)?;
            let points: Vec<[f64; 2]> = table
                .abscissa(reduced.against.as_ref())?
                .into_iter()
                .zip(values)
                .map(|(x, y)| [x, y])
                .collect();
            (Sample::Number(reduce(reduced, points)?), unit)
        }
        Source::Curve { file, columns, against, log } => {
            let table = Table::read(folder, file)?;
            let (values, unit) = table.sum(columns)?;
            let abscissa = table.abscissa(against.as_ref())?;
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

/// Reads a quantity that is a number.
///
/// # Errors
/// Missing file, column or number; a curve.
pub fn number(quantity: &Quantity, folder: &Path) -> Result<f64, String> {
    match read(quantity, folder)?.0 {
        Sample::Number(value) => Ok(value),
        Sample::Curve(_) => Err("a curve is no number".into()),
    }
}

fn reduce(reduced: &Reduced, points: Vec<[f64; 2]>) -> Result<f64, String> {
    let value = |at: f64| {
        let Sample::Curve(points) = Sample::curve(points.clone()) else { unreachable!("a curve") };
        curve::value_at(&points, at).ok_or_else(|| format!("{} has no rows around {at}", reduced.file))
    };
    let zero = reduced.since.map(value).transpose()?.unwrap_or(0.0);
    if let Some(at) = reduced.at {
        return Ok(value(at)? - zero);
    }
    let kept = || points.iter().filter(|p| reduced.from.is_none_or(|from| p[0] >= from));
    let values: Vec<f64> = kept().map(|p| p[1] - zero).collect();
    let Some(last) = values.last() else {
        let from = reduced.from.map_or(String::new(), |from| format!(" from {from} on"));
        return Err(format!("{} has no rows{from}", reduced.file));
    };
    let largest = || values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = || values.iter().copied().fold(f64::INFINITY, f64::min);
    Ok(match reduced.take {
        Take::Last | Take::Curve | Take::At => *last,
        Take::Mean => values.iter().sum::<f64>() / values.len() as f64,
        Take::Max => largest(),
        Take::Min => least(),
        Take::Range => largest() - least(),
        Take::Duration => {
            let mut active = kept().filter(|p| p[1] - zero != 0.0).map(|p| p[0]);
            active.next().map_or(0.0, |first| active.next_back().unwrap_or(first) - first)
        }
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

    /// First column, or the one of that name.
    fn abscissa(&self, name: Option<&String>) -> Result<Vec<f64>, String> {
        match name {
            Some(name) => Ok(self.column(name)?.0),
            None => Ok(self.rows.iter().map(|row| row[0]).collect()),
        }
    }

    /// Sum of columns, with the unit of the first.
    fn sum(&self, names: &[String]) -> Result<(Vec<f64>, String), String> {
        let (mut sum, unit) = self.column(&names[0])?;
        for name in &names[1..] {
            let (values, other) = self.column(name)?;
            if other != unit {
                return Err(format!("{}: columns of [{unit}] and [{other}] have no sum", self.file));
            }
            sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
        }
        Ok((sum, unit))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn reduced(take: Take) -> Reduced {
        let columns = vec!["a".into(), "b".into()];
        Reduced {
            file: "history.csv".into(),
            columns,
            take,
            against: None,
            at: None,
            from: None,
            since: None,
        }
    }

    fn points() -> Vec<[f64; 2]> {
        vec![[0.0, 1.0], [1.0, 5.0], [2.0, 3.0], [4.0, 4.0]]
    }

    #[test]
    fn columns_are_reduced() {
        let of = |r: Reduced| reduce(&r, points()).unwrap();
        assert_eq!(of(reduced(Take::Range)), 4.0);
        assert_eq!(of(Reduced { from: Some(2.0), ..reduced(Take::Range) }), 1.0);
        assert_eq!(of(Reduced { from: Some(1.5), ..reduced(Take::Max) }), 4.0);
        assert_eq!(of(reduced(Take::Duration)), 4.0);
        assert_eq!(of(Reduced { since: Some(0.0), ..reduced(Take::Duration) }), 3.0);
        assert_eq!(of(Reduced { at: Some(3.0), ..reduced(Take::At) }), 3.5);
        assert_eq!(of(Reduced { at: Some(3.0), since: Some(0.5), ..reduced(Take::At) }), 0.5);
        assert_eq!(of(Reduced { since: Some(0.0), ..reduced(Take::Last) }), 3.0);
        let fault = reduce(&Reduced { at: Some(9.0), ..reduced(Take::At) }, points()).unwrap_err();
        assert_eq!(fault, "history.csv has no rows around 9");
        let fault = reduce(&Reduced { from: Some(9.0), ..reduced(Take::Last) }, points()).unwrap_err();
        assert_eq!(fault, "history.csv has no rows from 9 on");
    }

    #[test]
    fn columns_of_equal_units_are_added() {
        let heads = ["time [s]", "a [m]", "b [m]", "c [N]"].map(String::from).to_vec();
        let table = Table { file: "history.csv", heads, rows: vec![vec![0.0, 1.0, 2.0, 4.0]] };
        let (sum, unit) = table.sum(&["a".into(), "b".into()]).unwrap();
        assert_eq!((sum, unit.as_str()), (vec![3.0], "m"));
        let fault = table.sum(&["a".into(), "c".into()]).unwrap_err();
        assert_eq!(fault, "history.csv: columns of [m] and [N] have no sum");
    }
}
