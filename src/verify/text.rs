//! Tables for terminal, `verify.md` and the guide.

use super::cell::{Cell, Column};
use super::matrix::{Difference, Matrix};
use super::plan::Row;
use crate::study::{Norm, aligned, four_digits, markdown};

/// Errors below it are not distinguished.
const SMALLEST: f64 = 1e-6;

/// Formats an error with two digits.
pub fn error(row: &Row, error: f64) -> String {
    let percent = row.quantity.norm == Norm::Relative;
    if error.abs() < SMALLEST {
        return if percent { "< 1e-4 %".into() } else { "< 1e-6".into() };
    }
    let value = if percent { 100.0 * error } else { error };
    let decimals = (1 - libm::log10(value.abs()).floor() as i32).max(0) as usize;
    let digits = if decimals > 4 { format!("{value:+.1e}") } else { format!("{value:+.decimals$}") };
    format!("{digits}{}", if percent { " %" } else { "" })
}

/// Formats the tolerance.
pub fn tolerance(row: &Row) -> String {
    match row.quantity.norm {
        Norm::Relative => format!("{} %", trimmed(100.0 * row.quantity.tolerance)),
        Norm::Absolute => format!("{:e}", row.quantity.tolerance),
    }
}

fn trimmed(value: f64) -> String {
    let text = four_digits(value);
    let (digits, exponent) =
        text.split_once('e').map_or((text.as_str(), String::new()), |(d, e)| (d, format!("e{e}")));
    let short =
        if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits };
    format!("{short}{exponent}")
}

/// Formats the reference with its unit.
pub fn reference(row: &Row) -> String {
    let unit = row.quantity.unit.as_deref().unwrap_or_default();
    format!("{} {unit}", trimmed(row.reference)).trim_end().into()
}

/// Formats a cell; `mark` surrounds errors above the tolerance.
fn shown(row: &Row, cell: &Cell, mark: &str, absent: &str) -> String {
    match cell {
        Cell::Computed { error: e, passed: true, .. } => error(row, *e),
        Cell::Computed { error: e, .. } => format!("{mark}{}{mark}", error(row, *e)),
        Cell::NotModelled { .. } => absent.into(),
        Cell::Skipped => "skipped".into(),
        Cell::Failed { .. } => format!("{mark}failed{mark}"),
    }
}

/// Formats the matrix for the terminal: errors, `!` above the tolerance.
pub fn printed(matrix: &Matrix) -> String {
    let mut heads = vec!["row".to_string(), "reference".into(), "tolerance".into()];
    heads.extend(matrix.columns.iter().map(|column| column.title.clone()));
    heads.push("s".into());
    let line = |(k, row): (usize, &Row)| {
        let mut cells = vec![row.table.name.clone(), reference(row), tolerance(row)];
        cells.extend(matrix.cells(k).map(|cell| shown(row, cell, "!", "not modelled")));
        cells.push(format!("{:.2}", matrix.columns[0].cells[k].seconds()));
        cells
    };
    let rows: Vec<Vec<String>> =
        std::iter::once(heads).chain(matrix.plan.rows.iter().enumerate().map(line)).collect();
    let mut text = aligned(&rows, |k| k == 0);
    matrix.columns.iter().for_each(|column| text += &format!("{}\n", program(column)));
    differences(matrix).iter().for_each(|line| text += &format!("{line}\n"));
    text
}

/// Formats version and score of a program.
fn program(column: &Column) -> String {
    let title = &column.title;
    if let Some(reason) = &column.missing {
        return format!("{title}: skipped, {reason}");
    }
    let (within, known) = column.score();
    let seconds: f64 = column.cells.iter().map(Cell::seconds).sum();
    let version = column.version.as_deref().unwrap_or("unknown");
    format!("{title} {version}: {within} of {known} rows within tolerance, {seconds:.1} s")
}

/// Formats the own failures, and the differences above tolerance by program and explanation.
fn differences(matrix: &Matrix) -> Vec<String> {
    let cells = |column: &Column| -> Vec<String> {
        let title = &column.title;
        let line = |(row, cell): (&Row, &Cell)| match cell {
            Cell::Failed { reason } => Some(format!("{title}: `{}` failed: {reason}", row.table.name)),
            cell if cell.passed() == Some(false) => {
                Some(format!("{title}: `{}` {}", row.table.name, shown(row, cell, "", "")))
            }
            _ => None,
        };
        matrix.plan.rows.iter().zip(&column.cells).filter_map(line).collect()
    };
    let failed = matrix.own().flat_map(cells);
    let mut lines: Vec<String> = failed.collect();
    let all = matrix.differences();
    let same = |a: &Difference<'_>, b: &Difference<'_>| {
        a.column.name == b.column.name && a.explanation == b.explanation
    };
    for (k, first) in all.iter().enumerate() {
        if all[..k].iter().any(|other| same(other, first)) {
            continue;
        }
        let alike = all.iter().filter(|other| same(other, first)).map(|d| match d.cell {
            Cell::Failed { reason } => format!("`{}` failed ({reason})", d.row.table.name),
            cell => format!("`{}` {}", d.row.table.name, shown(d.row, cell, "", "")),
        });
        let alike = alike.collect::<Vec<_>>().join(", ");
        let explanation = first.explanation.unwrap_or("not explained");
        lines.push(format!("{}: {alike}; {explanation}", first.column.title));
    }
    lines
}

/// Formats the table of groups for the guide: columns of programs that model a row of it.
pub fn groups(matrix: &Matrix, groups: &[&str]) -> String {
    let has = |row: &Row| groups.contains(&row.table.group.as_str());
    let of_group = || matrix.plan.rows.iter().enumerate().filter(|(_, row)| has(row));
    let models =
        |column: &&Column| of_group().any(|(k, _)| !matches!(column.cells[k], Cell::NotModelled { .. }));
    let columns: Vec<&Column> = matrix.columns.iter().filter(models).collect();
    let mut heads = vec!["row".to_string(), "reference".into(), "tolerance".into()];
    heads.extend(columns.iter().map(|column| column.title.clone()));
    let line = |(k, row): (usize, &Row)| {
        let table = &row.table;
        let mut cells = vec![
            format!("`{}`", table.name),
            format!("{}, {}", table.source, reference(row)),
            tolerance(row),
        ];
        cells.extend(columns.iter().map(|column| shown(row, &column.cells[k], "**", "–")));
        cells
    };
    markdown(&std::iter::once(heads).chain(of_group().map(line)).collect::<Vec<_>>())
}

/// Formats programs and versions.
pub fn programs(matrix: &Matrix) -> String {
    let program = |column: &Column| match (&column.version, &column.missing) {
        (Some(version), _) => format!("{} {version}", column.title),
        (None, Some(reason)) => format!("{} skipped ({reason})", column.title),
        (None, None) => column.title.clone(),
    };
    format!("{}\n", matrix.columns.iter().map(program).collect::<Vec<_>>().join(", "))
}

/// Formats the differences for the guide.
pub fn listed(matrix: &Matrix) -> String {
    let lines = differences(matrix);
    if lines.is_empty() { "None.\n".into() } else { lines.iter().map(|line| format!("* {line}\n")).collect() }
}

/// Formats `verify.md`: each case with formula, source and the results of all programs.
pub fn page(matrix: &Matrix) -> String {
    let mut text = format!("# Verification\n\n{}\n", programs(matrix));
    for (k, row) in matrix.plan.rows.iter().enumerate() {
        let table = &row.table;
        let (name, reference, tolerance) = (&row.quantity.name, reference(row), tolerance(row));
        text += &format!("## {}\n\n{}, `{}`", table.name, table.case, table.scene.display());
        table.set.iter().for_each(|assignment| text += &format!(" `--set {assignment}`"));
        text += &format!(
            "\n\n{name}: {reference}, {} ({}); tolerance {tolerance}\n\n",
            table.formula, table.source
        );
        let mut rows = vec![["program", "value", "error", "within", "s"].map(String::from).to_vec()];
        for (column, cell) in matrix.columns.iter().zip(matrix.cells(k)) {
            let own = |cells: [String; 4]| std::iter::once(column.title.clone()).chain(cells).collect();
            let none = || "–".to_string();
            rows.push(match cell {
                Cell::Computed { value, error: e, passed, seconds } => own([
                    format!("{value:.6e}"),
                    error(row, *e),
                    if *passed { "yes" } else { "no" }.into(),
                    format!("{seconds:.2}"),
                ]),
                Cell::NotModelled { reason } => {
                    own([format!("not modelled: {reason}"), none(), none(), none()])
                }
                Cell::Skipped => own(["skipped".into(), none(), none(), none()]),
                Cell::Failed { reason } => own([format!("failed: {reason}"), none(), "no".into(), none()]),
            });
        }
        text += &format!("{}\n", markdown(&rows));
    }
    text + &format!("## Differences above tolerance\n\n{}", listed(matrix))
}
