//! Compared quantities of runs.

use super::file::{Norm, QuantityTable, Take};
use trackbed_input::scene::{Document, Problem, SceneError};
use trackbed_io::columns::{Definition, cycles};
use trackbed_io::replaced;

/// Resolved quantity.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Name.
    pub name: String,
    /// Unit, if different from the column.
    pub unit: Option<String>,
    /// Scale factor.
    pub factor: f64,
    /// Source.
    pub source: Source,
    /// Error norm.
    pub norm: Norm,
    /// Scale of relative errors.
    pub scale: Option<f64>,
    /// Exact value instead of the reference.
    pub exact: Option<f64>,
    /// Tolerance.
    pub tolerance: f64,
}

/// Source of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// Path in `summary.json`.
    Summary(String),
    /// Reduced table column.
    Column(Reduced),
    /// Column over another, default the first.
    Curve {
        /// Table.
        file: String,
        /// Columns whose sum counts.
        columns: Vec<String>,
        /// Abscissa.
        against: Option<String>,
        /// Logarithmic abscissa.
        log: bool,
    },
}

/// Sum of columns, reduced to a number.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced {
    /// Table.
    pub file: String,
    /// Columns.
    pub columns: Vec<String>,
    /// Reduction.
    pub take: Take,
    /// Abscissa of `at`, `from` and `since`; default the first column.
    pub against: Option<String>,
    /// Abscissa of the value, with `Take::At`.
    pub at: Option<f64>,
    /// Smallest abscissa.
    pub from: Option<f64>,
    /// Abscissa whose value is subtracted.
    pub since: Option<f64>,
}

/// Resolves the quantities; `cycles`: the scene has load cycles.
///
/// # Errors
/// Input errors.
pub fn resolve(
    document: &Document,
    tables: &[QuantityTable],
    cycles: bool,
    tolerance: f64,
) -> Result<Vec<Quantity>, SceneError> {
    if tables.is_empty() {
        let expected = "at least one [[quantity]]: the scene has no load cycles";
        return if cycles {
            Ok(of_cycles(tolerance))
        } else {
            Err(document.error("quantity", "nothing", expected))
        };
    }
    let all: Vec<Quantity> = tables
        .iter()
        .enumerate()
        .map(|(k, table)| resolve_one(document, &format!("quantity.{k}"), table, tolerance))
        .collect::<Result<_, _>>()?;
    for (k, quantity) in all.iter().enumerate() {
        if all[..k].iter().any(|earlier| earlier.name == quantity.name) {
            let found = format!("\"{}\" twice", quantity.name);
            return Err(document.error(&format!("quantity.{k}.name"), found, "distinct names"));
        }
    }
    Ok(all)
}

/// Rejects keys of the comparison with a reference.
///
/// # Errors
/// Input errors.
pub fn reject_errors(document: &Document, tables: &[QuantityTable]) -> Result<(), SceneError> {
    for (k, table) in tables.iter().enumerate() {
        let keys = [
            ("norm", table.norm.is_some()),
            ("scale", table.scale.is_some()),
            ("exact", table.exact.is_some()),
            ("tolerance", table.tolerance.is_some()),
        ];
        if let Some((key, _)) = keys.iter().find(|(_, given)| *given) {
            return Err(document.problem(&format!("quantity.{k}.{key}"), Problem::conflict("`parameter`")));
        }
    }
    Ok(())
}

fn of_cycles(tolerance: f64) -> Vec<Quantity> {
    let file = "cycles.csv".to_string();
    let of = |name: &str, unit: &str, factor: f64, source: Source| Quantity {
        name: name.into(),
        unit: Some(unit.into()),
        factor,
        source,
        norm: Norm::Relative,
        scale: None,
        exact: None,
        tolerance,
    };
    let column = |column: &Definition, take| {
        let (file, columns) = (file.clone(), vec![column.name.into()]);
        Source::Column(Reduced { file, columns, take, against: None, at: None, from: None, since: None })
    };
    let curve = Source::Curve {
        file: file.clone(),
        columns: vec![cycles::SETTLEMENT.name.into()],
        against: None,
        log: true,
    };
    vec![
        of("settlement", "mm", 1e3, column(cycles::SETTLEMENT, Take::Last)),
        of("settlement over log N", "mm", 1e3, curve),
        of("secant stiffness", "kN/mm", 1e-6, column(cycles::SECANT_STIFFNESS, Take::Mean)),
        of("dissipated energy", "J", 1.0, column(cycles::DISSIPATED_ENERGY, Take::Mean)),
    ]
}

/// Resolves the quantity of the table at `path`; `study`: default tolerance.
///
/// # Errors
/// Input errors.
pub fn resolve_one(
    document: &Document,
    path: &str,
    table: &QuantityTable,
    study: f64,
) -> Result<Quantity, SceneError> {
    let place = |key: &str| format!("{path}.{key}");
    let fault = |key: &str, found: String, expected: &str| Err(document.error(&place(key), found, expected));
    let source = source_of(document, path, table)?;
    let default = match &source {
        Source::Summary(path) => path.rsplit('.').next().unwrap_or(path).to_string(),
        Source::Column(Reduced { columns, .. }) | Source::Curve { columns, .. } => columns.join(" + "),
    };
    let name = table.name.clone().unwrap_or(default);
    if name.trim().is_empty() || name.contains(['"', '\n', '|']) {
        return fault("name", format!("{name:?}"), "a name without quotes or |");
    }
    if !table.factor.is_finite() || table.factor == 0.0 {
        return fault("factor", table.factor.to_string(), "a finite number that is not 0");
    }
    let norm = table.norm.unwrap_or_default();
    let relative = norm == Norm::Relative;
    if let Some(scale) = table.scale.filter(|s| !(s.is_finite() && *s > 0.0 && relative)) {
        return fault("scale", scale.to_string(), "a number above 0, with norm = \"relative\"");
    }
    let curve = matches!(source, Source::Curve { .. });
    if let Some(exact) = table.exact.filter(|e| curve || !e.is_finite()) {
        return fault("exact", exact.to_string(), "a finite number, not with take = \"curve\"");
    }
    if table.exact == Some(0.0) && relative && table.scale.is_none() {
        return fault("exact", "0".into(), "another value, or norm = \"absolute\", or `scale`");
    }
    let tolerance = match table.tolerance {
        Some(t) if t.is_finite() && t > 0.0 => t,
        Some(t) => return fault("tolerance", t.to_string(), "a number above 0"),
        None if relative => study,
        None => return fault("tolerance", "nothing".into(), "a value with norm = \"absolute\""),
    };
    let (unit, factor) = (table.unit.clone(), table.factor);
    Ok(Quantity { name, unit, factor, source, norm, scale: table.scale, exact: table.exact, tolerance })
}

fn source_of(document: &Document, path: &str, table: &QuantityTable) -> Result<Source, SceneError> {
    let place = |key: &str| format!("{path}.{key}");
    let problem = |key: &str, problem: Problem| Err(document.problem(&place(key), problem));
    let fault = |key: &str, found: &str, expected: &str| problem(key, Problem::value(found, expected));
    let of_table = [
        ("file", table.file.is_some()),
        ("column", table.column.is_some()),
        ("take", table.take.is_some()),
        ("at", table.at.is_some()),
        ("from", table.from.is_some()),
        ("since", table.since.is_some()),
    ];
    if let Some(path) = &table.summary {
        let other = of_table.iter().find(|(_, given)| *given);
        return match other {
            Some((key, _)) => problem(key, Problem::conflict("`summary`")),
            None => match replaced::result(path) {
                Some(new) => fault("summary", &format!("{path:?}"), &format!("{new:?}")),
                None => Ok(Source::Summary(path.clone())),
            },
        };
    }
    let Some(file) = &table.file else {
        return problem("file", Problem::missing("a table such as \"cycles.csv\", or `summary`"));
    };
    if !file.ends_with(".csv") || file.contains(['/', '\\']) {
        return fault(
            "file",
            &format!("{file:?}"),
            "the name of a CSV table of a run, such as \"cycles.csv\"",
        );
    }
    let columns = table.column.as_ref().map(|columns| columns.0.clone()).unwrap_or_default();
    if columns.is_empty() {
        return problem("column", Problem::missing("a column of the table"));
    }
    let take = table.take.unwrap_or_default();
    let is_at = take == Take::At;
    if table.at.is_some() != is_at {
        return match is_at {
            true => problem("at", Problem::missing("a number with `take = \"at\"`")),
            false => problem("at", Problem::no_effect("`take = \"at\"`")),
        };
    }
    if is_at && table.from.is_some() {
        return problem("from", Problem::conflict("`take = \"at\"`"));
    }
    for (key, value) in [("at", table.at), ("from", table.from), ("since", table.since)] {
        if let Some(value) = value.filter(|v| !v.is_finite()) {
            return fault(key, &value.to_string(), "a finite number");
        }
    }
    let (file, against) = (file.clone(), table.against.clone());
    if take == Take::Curve {
        if let Some((key, _)) =
            [("from", table.from), ("since", table.since)].iter().find(|(_, v)| v.is_some())
        {
            return problem(key, Problem::conflict("`take = \"curve\"`"));
        }
        return Ok(Source::Curve { file, columns, against, log: table.log.unwrap_or(false) });
    }
    if against.is_some() && table.at.or(table.from).or(table.since).is_none() {
        return problem("against", Problem::no_effect("`take = \"curve\"`, `at`, `from` or `since`"));
    }
    if table.log.is_some() {
        return problem("log", Problem::no_effect("`take = \"curve\"`"));
    }
    let QuantityTable { at, from, since, .. } = *table;
    Ok(Source::Column(Reduced { file, columns, take, against, at, from, since }))
}
