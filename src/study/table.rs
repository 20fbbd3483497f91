//! Machine-readable tables: `study.csv`, `study.json`, `samples.csv`, `sensitivity.csv`, `targets.csv`.

use super::analysis::Analysis;
use super::file::Norm;
use super::outcome::{Outcome, cpu};
use super::plan::Plan;
use super::quantity::Quantity;
use super::target::Target;
use serde_json::json;

/// Returns a column header: name and unit.
pub fn head(quantity: &Quantity, unit: &str) -> String {
    if unit.is_empty() { quantity.name.clone() } else { format!("{} [{unit}]", quantity.name) }
}

fn text(value: Option<f64>) -> String {
    value.map_or(String::new(), |v| v.to_string())
}

/// Formats rows, the first of them headers.
fn written(rows: impl IntoIterator<Item = Vec<String>>) -> Result<String, csv::Error> {
    let mut out = csv::Writer::from_writer(Vec::new());
    rows.into_iter().try_for_each(|row| out.write_record(&row))?;
    let bytes = out.into_inner().map_err(|e| e.into_error())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Formats the cases; errors and speed-up only with a reference.
///
/// # Errors
/// Never: writing to memory.
pub fn cases(plan: &Plan, outcome: &Outcome, analysis: &Analysis) -> Result<String, csv::Error> {
    let (compared, fitted) = (plan.has_reference(), !plan.targets.is_empty());
    let mut heads = vec!["case".to_string()];
    heads.extend(plan.axes.iter().cloned());
    heads.extend(["runs", "done"].map(String::from));
    for (quantity, unit) in plan.quantities.iter().zip(&outcome.units) {
        let with = |name: &str, unit: &str| match unit {
            "" => format!("{} {name}", quantity.name),
            unit => format!("{} {name} [{unit}]", quantity.name),
        };
        heads.push(head(quantity, unit));
        heads.extend(["standard deviation", "standard error"].map(|name| with(name, unit)));
        if compared {
            let unit = if quantity.norm == Norm::Absolute { unit } else { "" };
            heads.extend(["error", "error standard error"].map(|name| with(name, unit)));
        }
    }
    heads.extend(fitted.then(|| "misfit".to_string()));
    heads.extend(compared.then(|| "within".to_string()));
    heads.extend(["reasons", "steps", "cpu [s]", "wall [s]"].map(String::from));
    heads.extend(compared.then(|| "speed_up".to_string()));
    heads.push("peak_memory [bytes]".into());
    let row = |(row, point): (&super::outcome::Row, &super::point::Point)| {
        let mut cells = vec![row.case.clone()];
        cells.extend((0..plan.axes.len()).map(|k| row.levels.get(k).cloned().unwrap_or_default()));
        cells.extend([row.runs.to_string(), row.done.to_string()]);
        for cell in &row.quantities {
            cells.extend([cell.value, cell.standard_deviation, cell.standard_error].map(text));
            if compared {
                cells.extend([cell.error, cell.error_standard_error].map(text));
            }
        }
        cells.extend(fitted.then(|| text(point.misfit)));
        cells.extend(compared.then(|| if row.within { "yes" } else { "no" }.to_string()));
        cells.push(row.reasons.join("; "));
        let cost = row.cost.as_ref();
        cells.push(text(cost.map(|c| c.steps)));
        cells.extend([cpu(row), cost.map(|c| c.wall_seconds)].map(text));
        cells.extend(compared.then(|| text(row.speed_up)));
        cells.push(cost.and_then(|c| c.peak_memory).map_or(String::new(), |m| m.to_string()));
        cells
    };
    written(std::iter::once(heads).chain(outcome.rows.iter().zip(&analysis.points).map(row)))
}

/// Formats the samples.
///
/// # Errors
/// Never: writing to memory.
pub fn samples(plan: &Plan) -> Result<String, csv::Error> {
    let heads = std::iter::once("case".to_string()).chain(plan.axes.iter().cloned()).collect();
    let row = |s: &super::axis::Setting| {
        std::iter::once(s.label.clone()).chain(s.levels.iter().cloned()).collect::<Vec<String>>()
    };
    written(std::iter::once(heads).chain(plan.settings.iter().map(row)))
}

/// Formats the sensitivities: one row per quantity and parameter.
///
/// # Errors
/// Never: writing to memory.
pub fn sensitivities(analysis: &Analysis) -> Result<String, csv::Error> {
    let heads = [
        "quantity",
        "parameter",
        "low",
        "high",
        "result at low",
        "result at high",
        "effect",
        "standardized coefficient",
        "coefficient standard error",
        "r_squared",
        "rank correlation",
    ];
    let mut rows = vec![heads.map(String::from).to_vec()];
    for (result, s) in analysis.results.iter().zip(&analysis.sensitivities) {
        for (j, factor) in analysis.factors.iter().enumerate() {
            let ends = s.ends(j, factor);
            let end = |k: usize| ends.map_or(String::new(), |e| factor.text(e[k][0]));
            let fit = s.regression.as_ref();
            let own = fit.filter(|_| factor.categories.is_empty());
            let mut row = vec![result.head(), factor.head(), end(0), end(1)];
            row.extend(
                [
                    ends.map(|e| e[0][1]),
                    ends.map(|e| e[1][1]),
                    s.effect(j, factor),
                    own.map(|f| f.coefficients[j]),
                    own.map(|f| f.standard_errors[j]),
                    fit.map(|f| f.r_squared),
                    s.rank_correlations[j],
                ]
                .map(text),
            );
            rows.push(row);
        }
    }
    written(rows)
}

/// Formats the deviations from the targets, smallest misfit first.
///
/// # Errors
/// Never: writing to memory.
pub fn targets(analysis: &Analysis) -> Result<String, csv::Error> {
    let mut heads = vec!["case".to_string()];
    heads.extend(analysis.factors.iter().map(super::factor::Factor::head));
    heads.push("misfit".into());
    for target in &analysis.targets {
        let result = &analysis.results[target.quantity];
        heads.extend([result.head(), format!("{} deviation [tolerances]", result.name)]);
        heads.push(format!("{} within tolerance", result.name));
    }
    let row = |k: &usize| {
        let point = &analysis.points[*k];
        let mut row = vec![point.case.clone()];
        let value = |(f, v): (&super::factor::Factor, &Option<f64>)| v.map_or(String::new(), |v| f.text(v));
        row.extend(analysis.factors.iter().zip(&point.values).map(value));
        row.push(text(point.misfit));
        for target in &analysis.targets {
            let value = point.results[target.quantity][0];
            let deviation = value.map(|v| target.deviation(v));
            row.extend([value, deviation].map(text));
            row.push(deviation.map_or("", |d| if d.abs() <= 1.0 { "yes" } else { "no" }).into());
        }
        row
    };
    written(std::iter::once(heads).chain(analysis.best.iter().map(row)))
}

/// Formats all results as JSON.
pub fn json(plan: &Plan, outcome: &Outcome, analysis: &Analysis) -> String {
    let quantity = |(q, unit): (&Quantity, &String)| {
        json!({
            "name": q.name,
            "unit": unit,
            "norm": if q.norm == Norm::Relative { "relative" } else { "absolute" },
            "tolerance": q.tolerance,
            "exact": q.exact,
        })
    };
    let target = |t: &Target| {
        json!({
            "quantity": plan.quantities[t.quantity].name,
            "value": t.value,
            "tolerance": t.tolerance,
        })
    };
    let label = |k: usize| outcome.rows[k].case.clone();
    let value = json!({
        "title": plan.title,
        "scene": plan.scene,
        "axes": plan.axes,
        "quantities": plan.quantities.iter().zip(&outcome.units).map(quantity).collect::<Vec<_>>(),
        "targets": plan.targets.iter().map(target).collect::<Vec<_>>(),
        "reference": plan.has_reference().then(|| label(outcome.reference)),
        "recommended": outcome.recommended.map(label),
        "front": outcome.front.iter().copied().map(label).collect::<Vec<_>>(),
        "cases": outcome.rows,
        "extremes": outcome.extremes,
        "analysis": analysis,
    });
    format!("{value:#}\n")
}
