//! Sieve limits of a grade, from CSV.

use super::separator::Separators;
use super::{fault, text};
use std::collections::BTreeSet;
use std::path::Path;
use trackbed_dem::insert::gradation::Gradation;
use trackbed_io::read::ReadError;

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

const NAMES: [&str; 5] = ["standard", "grade", "sieve_mm", "passing_lo_pct", "passing_hi_pct"];

fn find_columns(file: &Path, line: usize, fields: &[&str]) -> Result<[usize; 5], ReadError> {
    let mut found = [0; 5];
    for (at, name) in found.iter_mut().zip(NAMES) {
        let place = fields.iter().position(|field| field.eq_ignore_ascii_case(name));
        *at = place.ok_or_else(|| {
            let of_file = format!("columns {}", fields.join(", "));
            fault(file, Some(line), name, of_file, format!("columns {}", NAMES.join(", ")))
        })?;
    }
    Ok(found)
}

/// Reads the limits of a grade.
///
/// # Errors
/// Missing file or grade, or invalid limits.
pub fn gradation(file: &Path, standard: &str, grade: &str) -> Result<Grading, ReadError> {
    let content = text(file, "gradation")?;
    let mut columns: Option<([usize; 5], usize)> = None;
    let mut separators: Option<Separators> = None;
    let mut table: Vec<[f64; 3]> = Vec::new();
    let mut others = BTreeSet::new();
    let lines = (1..).zip(content.lines().map(str::trim));
    for (line, body) in lines.filter(|(_, body)| !body.is_empty() && !body.starts_with('#')) {
        let separators = separators.get_or_insert_with(|| Separators::of(body));
        let fields = separators.fields(body);
        let Some(([s, g, size, low, high], width)) = columns else {
            columns = Some((find_columns(file, line, &fields)?, fields.len()));
            continue;
        };
        if fields.len() != width {
            let expected =
                format!("{width}, as in the heading{}", separators.hint(body, fields.len() > width));
            return Err(fault(file, Some(line), "columns", fields.len().to_string(), expected));
        }
        if plain(fields[s]) != plain(standard) || plain(fields[g]) != plain(grade) {
            others.insert(format!("{} {}", fields[s], fields[g]));
            continue;
        }
        let mut number = |k: usize, name: &str| {
            let number = separators.number(fields[k]);
            let number = number.and_then(|v| if v.is_finite() { Ok(v) } else { Err("a number") });
            number.map_err(|expected| fault(file, Some(line), name, format!("\"{}\"", fields[k]), expected))
        };
        table.push([
            1e-3 * number(size, NAMES[2])?,
            1e-2 * number(low, NAMES[3])?,
            1e-2 * number(high, NAMES[4])?,
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
