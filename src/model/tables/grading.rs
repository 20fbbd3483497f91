//! Sieve limits of a grade, from CSV.

use super::{fault, rows, text};
use crate::read::ReadError;
use std::collections::BTreeSet;
use std::path::Path;
use trackbed_dem::insert::gradation::Gradation;

/// Sieve limits and their mean curve.
#[derive(Clone, Debug)]
pub struct Grading {
    /// Target curve.
    pub curve: Gradation,
    /// By ascending sieve: size [m], least and largest fraction passing.
    pub limits: Vec<[f64; 3]>,
}

impl Grading {
    /// Scales sizes by `s`.
    pub fn scaled(&self, s: f64) -> Grading {
        let limits = self.limits.iter().map(|[size, low, high]| [size * s, *low, *high]).collect();
        Grading { curve: self.curve.scaled(s), limits }
    }
}

/// Normalises a name: `EN 13450` to `EN13450`.
fn plain(name: &str) -> String {
    name.chars().filter(|c| c.is_alphanumeric() || *c == '.').flat_map(char::to_lowercase).collect()
}

/// Reads the limits of a grade.
///
/// # Errors
/// Missing file or grade, or invalid limits.
pub fn gradation(file: &Path, standard: &str, grade: &str) -> Result<Grading, ReadError> {
    let content = text(file, "gradation")?;
    let mut columns: Option<[usize; 5]> = None;
    let mut table: Vec<[f64; 3]> = Vec::new();
    let mut others = BTreeSet::new();
    for (line, fields) in rows(&content) {
        let Some([s, g, size, low, high]) = columns else {
            let names = ["standard", "grade", "sieve_mm", "passing_lo_pct", "passing_hi_pct"];
            let mut found = [0; 5];
            for (k, name) in names.into_iter().enumerate() {
                found[k] = fields.iter().position(|f| *f == name).ok_or_else(|| {
                    fault(file, Some(line), name, "no such column", format!("columns {}", names.join(", ")))
                })?;
            }
            columns = Some(found);
            continue;
        };
        let field = |k: usize| fields.get(k).copied().unwrap_or_default();
        if plain(field(s)) != plain(standard) || plain(field(g)) != plain(grade) {
            others.insert(format!("{} {}", field(s), field(g)));
            continue;
        }
        let number = |k: usize, name: &str| {
            field(k)
                .parse::<f64>()
                .ok()
                .filter(|v| v.is_finite())
                .ok_or_else(|| fault(file, Some(line), name, format!("\"{}\"", field(k)), "a number"))
        };
        table.push([
            1e-3 * number(size, "sieve_mm")?,
            1e-2 * number(low, "passing_lo_pct")?,
            1e-2 * number(high, "passing_hi_pct")?,
        ]);
    }
    if table.is_empty() {
        let found = format!("\"{standard}\" \"{grade}\"");
        let expected = match others.is_empty() {
            true => "rows of grades below the heading".to_string(),
            false => format!("one of {}", others.into_iter().collect::<Vec<_>>().join(", ")),
        };
        return Err(fault(file, None, "gradation", found, expected));
    }
    table.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let limits = table.clone();
    // Of sieves passing everything, only the first matters.
    let full = table.iter().position(|r| r[1] + r[2] >= 2.0).unwrap_or(table.len() - 1);
    table.truncate(full + 1);
    let column = |k: usize| table.iter().map(|r| r[k]).collect::<Vec<_>>();
    let curve = Gradation::from_limits(&column(0), &column(1), &column(2), None)
        .map_err(|e| fault(file, None, "gradation", e.to_string(), "limits that make a curve"))?;
    Ok(Grading { curve, limits })
}
