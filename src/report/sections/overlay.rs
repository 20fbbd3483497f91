//! Shared curves and tables of sections.

use crate::data::RunData;
use crate::page::{Cell, facts_table};
use crate::plot::{Curve, Style};
use maud::Markup;
use trackbed_io::columns::Name;

/// Longer curves have no markers.
const FEW: usize = 60;

/// Named curve in SI units.
pub type Named = (String, Vec<[f64; 2]>);

/// Collects the curves of all runs, coloured by curve or by run.
pub fn overlay(runs: &[RunData], of: impl Fn(&RunData) -> Vec<Named>) -> Vec<Curve> {
    let several = runs.len() > 1;
    let mut curves = Vec::new();
    for (r, run) in runs.iter().enumerate() {
        for (k, (name, points)) in of(run).into_iter().enumerate().filter(|(_, c)| !c.1.is_empty()) {
            let colour = if several { r } else { k };
            let style = Style { colour, dash: k, line: true, marks: points.len() <= FEW };
            let name = match (several, name.as_str()) {
                (true, "") => run.label.clone(),
                (true, name) => format!("{}: {name}", run.label),
                (false, _) => name,
            };
            curves.push(Curve::new(name, points, style));
        }
    }
    curves
}

/// Collects one unnamed curve per run.
pub fn one(runs: &[RunData], of: impl Fn(&RunData) -> Option<Vec<[f64; 2]>>) -> Vec<Curve> {
    overlay(runs, |run| of(run).map(|points| vec![(String::new(), points)]).unwrap_or_default())
}

/// Fact name, cell of a run.
pub type Fact<'a> = (&'a str, &'a dyn Fn(&RunData) -> Cell);

/// Formats a table of runs by facts, without empty rows.
pub fn facts(runs: &[RunData], rows: &[Fact<'_>]) -> Markup {
    let rows: Vec<(String, Vec<Cell>)> = rows
        .iter()
        .map(|(name, of)| (name.to_string(), runs.iter().map(of).collect::<Vec<_>>()))
        .filter(|(_, cells)| !cells.iter().all(|c| matches!(c, Cell::Nothing)))
        .collect();
    let labels = runs.iter().map(|r| if runs.len() > 1 { r.label.as_str() } else { "value" });
    let heads: Vec<&str> = std::iter::once("").chain(labels).collect();
    facts_table(&heads, &rows)
}

/// Returns the most variable component of a history vector: (axis, values).
pub fn dominant<'a>(run: &'a RunData, vector: Name<'_>) -> Option<(&'static str, &'a [f64])> {
    let table = run.table("history")?;
    let spread = |values: &[f64]| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low
    };
    let axes = ["x", "y", "z"].into_iter().enumerate();
    let all = axes.filter_map(|(k, axis)| Some((axis, table.column(vector.at(k))?)));
    all.max_by(|a, b| spread(a.1).total_cmp(&spread(b.1))).filter(|a| spread(a.1) > 0.0)
}
