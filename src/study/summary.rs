//! Readable tables of responses, sensitivities and targets.

use super::analysis::Analysis;
use super::hazard;
use super::layout::{Cell, Table, four_digits};
use super::statistics::significant_correlation;

/// Cases of smallest misfit in the tables.
const BEST: usize = 5;
/// Smallest R² of a response that is nearly linear (Saltelli et al. 2008).
const LINEAR: f64 = 0.7;

/// Returns all cases, or those of `order`.
pub fn points(analysis: &Analysis, order: &[usize]) -> Table {
    let targeted = !analysis.targets.is_empty();
    let mut heads = vec!["case".to_string()];
    heads.extend(analysis.factors.iter().map(|f| f.head()));
    heads.extend(analysis.results.iter().map(|r| r.head()));
    heads.extend(targeted.then(|| "misfit".to_string()));
    let row = |k: &usize| {
        let point = &analysis.points[*k];
        let mut row = vec![Cell::text(&point.case)];
        row.extend(values(analysis, *k));
        row.extend(point.results.iter().map(|[mean, _, error]| match mean {
            Some(mean) => Cell::Number(*mean, *error),
            None => Cell::Nothing,
        }));
        row.extend(targeted.then(|| Cell::number(point.misfit)));
        row
    };
    Table { heads, rows: order.iter().map(row).collect() }
}

fn values(analysis: &Analysis, k: usize) -> Vec<Cell> {
    let value = |(factor, value): (&super::factor::Factor, &Option<f64>)| match value {
        Some(value) if factor.categories.is_empty() => Cell::Number(*value, None),
        Some(value) => Cell::Text(factor.text(*value)),
        None => Cell::Nothing,
    };
    analysis.factors.iter().zip(&analysis.points[k].values).map(value).collect()
}

/// Returns the `most` cases of smallest misfit with their deviations from the targets.
pub fn best(analysis: &Analysis, most: usize) -> Table {
    let mut heads = vec!["case".to_string()];
    heads.extend(analysis.factors.iter().map(|f| f.head()));
    for target in &analysis.targets {
        heads.extend([analysis.results[target.quantity].head(), "deviation [tolerances]".into()]);
    }
    heads.push("misfit".into());
    let row = |k: &usize| {
        let point = &analysis.points[*k];
        let mut row = vec![Cell::text(&point.case)];
        row.extend(values(analysis, *k));
        for target in &analysis.targets {
            let [mean, _, error] = point.results[target.quantity];
            row.push(mean.map_or(Cell::Nothing, |mean| Cell::Number(mean, error)));
            row.push(Cell::number(mean.map(|mean| target.deviation(mean))));
        }
        row.push(Cell::number(point.misfit));
        row
    };
    Table { heads, rows: analysis.best.iter().take(most).map(row).collect() }
}

/// Returns each target with the number of cases within its tolerance.
pub fn targets(analysis: &Analysis) -> Table {
    let heads = ["target", "value", "tolerance", "cases within tolerance"].map(String::from).to_vec();
    let row = |target: &super::target::Target| {
        let known = analysis.points.iter().filter_map(|p| p.results[target.quantity][0]);
        let within: Vec<bool> = known.map(|v| target.deviation(v).abs() <= 1.0).collect();
        let count = format!("{} of {}", within.iter().filter(|w| **w).count(), within.len());
        vec![
            Cell::text(analysis.results[target.quantity].head()),
            Cell::Number(target.value, None),
            Cell::Number(target.tolerance, None),
            Cell::Text(count),
        ]
    };
    Table { heads, rows: analysis.targets.iter().map(row).collect() }
}

/// Returns the sensitivities by quantity and parameter.
pub fn sensitivities(analysis: &Analysis) -> Table {
    let heads = ["quantity", "parameter", "effect", "standardized coefficient", "R²", "rank correlation"];
    let mut rows = Vec::new();
    for (result, s) in analysis.results.iter().zip(&analysis.sensitivities) {
        for (j, factor) in analysis.factors.iter().enumerate() {
            let fit = s.regression.as_ref();
            rows.push(vec![
                Cell::text(result.head()),
                Cell::text(factor.head()),
                Cell::number(s.effect(j, factor)),
                fit.filter(|_| factor.categories.is_empty())
                    .map_or(Cell::Nothing, |f| Cell::Number(f.coefficients[j], Some(f.standard_errors[j]))),
                Cell::number(fit.map(|f| f.r_squared)),
                Cell::number(s.rank_correlations[j]),
            ]);
        }
    }
    Table { heads: heads.map(String::from).to_vec(), rows }
}

/// Returns notes on the sensitivities.
pub fn notes(analysis: &Analysis) -> Vec<String> {
    let mut notes = Vec::new();
    for (result, s) in analysis.results.iter().zip(&analysis.sensitivities) {
        match &s.regression {
            Some(fit) if fit.r_squared < LINEAR => notes.push(format!(
                "{}: R² {:.2}, below {LINEAR}: the response is not linear, or scatters. Compare rank correlation and plots",
                result.name, fit.r_squared
            )),
            None if analysis.sampled => notes.push(format!(
                "{}: no regression. It requires a result that varies and at least {} completed cases",
                result.name,
                analysis.factors.len() + 2
            )),
            _ => {}
        }
    }
    if let Some(reason) = &analysis.without_posterior {
        notes.push(format!("no posterior: {reason}"));
    }
    let count = analysis.points.iter().filter(|p| p.done > 0).count();
    if significant_correlation(count) < 1.0
        && analysis.sensitivities.iter().any(|s| s.rank_correlations.iter().any(Option::is_some))
    {
        notes.push(format!(
            "Rank correlations below {} ({count} cases) are not significant at the 5 % level",
            four_digits(significant_correlation(count))
        ));
    }
    notes
}

/// Formats targets, sensitivities and notes as Markdown.
pub fn sections(analysis: &Analysis) -> String {
    let mut text = String::new();
    if !analysis.hazard.is_empty() {
        text += &format!("\n## Hazard\n\n{}", hazard::table(&analysis.hazard).markdown());
        text += &format!("\n{}.\n", hazard::note(&analysis.hazard));
    }
    if !analysis.targets.is_empty() {
        text += &format!("\n## Targets\n\n{}", targets(analysis).markdown());
        text += &format!("\n## Cases of smallest misfit\n\n{}", best(analysis, BEST).markdown());
    }
    if let Some(posterior) = &analysis.posterior {
        text += &format!("\n## Posterior\n\n{}", posterior.parameter_table().markdown());
        text += &format!("\n{}\n", posterior.prediction_table().markdown());
        posterior.notes().iter().for_each(|note| text += &format!("* {note}.\n"));
    }
    if !analysis.factors.is_empty() {
        text += &format!("\n## Sensitivity\n\n{}", sensitivities(analysis).markdown());
        let notes = notes(analysis);
        text += if notes.is_empty() { "" } else { "\n" };
        notes.iter().for_each(|note| text += &format!("* {note}.\n"));
    }
    text
}

/// Formats a study of sampled parameters as Markdown.
pub fn markdown(title: &str, scene: &str, analysis: &Analysis) -> String {
    let runs: usize = analysis.points.iter().map(|p| p.runs).sum();
    let done: usize = analysis.points.iter().map(|p| p.done).sum();
    let count = analysis.points.len();
    let mut text = format!("# {}\n\n", title.replace('\n', " "));
    text += &format!("Scene `{scene}`, {count} cases, {done} of {runs} runs completed.");
    text += " ± is the standard error over the seeds, or of the coefficient.\n";
    text += &sections(analysis);
    let all: Vec<usize> = (0..count).collect();
    text += &format!("\n## Cases\n\n{}", points(analysis, &all).markdown());
    if !analysis.failed.is_empty() {
        text += "\n## Runs without results\n\n";
        analysis.failed.iter().for_each(|reason| text += &format!("* {reason}\n"));
    }
    text
}

/// Formats the cases of smallest misfit, or the first `most`, and the sensitivities for a terminal.
pub fn printed(analysis: &Analysis, most: usize) -> String {
    let mut text = String::new();
    if analysis.targets.is_empty() {
        let order: Vec<usize> = (0..analysis.points.len().min(most)).collect();
        text += &points(analysis, &order).aligned(1);
        if analysis.points.len() > most {
            text += &format!("  … {} more in study.md\n", analysis.points.len() - most);
        }
    }
    text += &format!("\n{}", sensitivities(analysis).aligned(2));
    notes(analysis).iter().for_each(|note| text += &format!("note: {note}.\n"));
    text + &printed_best(analysis)
}

/// Formats the areas of the hazard maps for a terminal; nothing without maps.
pub fn printed_hazard(analysis: &Analysis) -> String {
    if analysis.hazard.is_empty() {
        return String::new();
    }
    let (table, note) = (hazard::table(&analysis.hazard), hazard::note(&analysis.hazard));
    format!("\n{}note: {note}.\n", table.aligned(1))
}

/// Formats targets and cases of smallest misfit for a terminal; nothing without targets.
pub fn printed_best(analysis: &Analysis) -> String {
    if analysis.targets.is_empty() {
        return String::new();
    }
    let best = best(analysis, BEST);
    let cases = if best.rows.is_empty() {
        "No case has values of all targets.\n".to_string()
    } else {
        format!("Cases of smallest misfit:\n{}", best.aligned(1))
    };
    let mut text = format!("\n{}\n{cases}", targets(analysis).aligned(1));
    if let Some(posterior) = &analysis.posterior {
        text += &format!("\nPosterior:\n{}\n", posterior.parameter_table().aligned(1));
        text += &posterior.prediction_table().aligned(1);
        posterior.notes().iter().for_each(|note| text += &format!("note: {note}.\n"));
    }
    text
}
