//! Tables as text.

/// Cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Empty.
    Nothing,
    /// Text.
    Text(String),
    /// Number, and its standard error.
    Number(f64, Option<f64>),
}

impl Cell {
    /// Creates a text cell.
    pub fn text(text: impl Into<String>) -> Cell {
        Cell::Text(text.into())
    }

    /// Creates a number cell.
    pub fn number(value: Option<f64>) -> Cell {
        value.map_or(Cell::Nothing, |v| Cell::Number(v, None))
    }

    /// Returns the printed text.
    pub fn shown(&self) -> String {
        match self {
            Cell::Nothing => "–".into(),
            Cell::Text(text) => text.clone(),
            Cell::Number(value, None) => four_digits(*value),
            Cell::Number(value, Some(error)) => {
                format!("{} ± {}", four_digits(*value), significant(*error, 2))
            }
        }
    }
}

/// Table with a header.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Headers.
    pub heads: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    fn texts(&self) -> Vec<Vec<String>> {
        let rows = self.rows.iter().map(|row| row.iter().map(Cell::shown).collect());
        std::iter::once(self.heads.clone()).chain(rows).collect()
    }

    /// Formats Markdown.
    pub fn markdown(&self) -> String {
        markdown(&self.texts())
    }

    /// Formats aligned columns, the first `left` of them to the left.
    pub fn aligned(&self, left: usize) -> String {
        aligned(&self.texts(), |k| k < left)
    }
}

/// Formats Markdown from rows, the first of them headers.
pub fn markdown(rows: &[Vec<String>]) -> String {
    let line = |cells: &Vec<String>| {
        let cells: Vec<String> = cells.iter().map(|c| c.replace('|', "\\|")).collect();
        format!("| {} |\n", cells.join(" | "))
    };
    let mut text = line(&rows[0]);
    text += &format!("|{}\n", "---|".repeat(rows[0].len()));
    rows[1..].iter().for_each(|row| text += &line(row));
    text
}

/// Formats aligned columns.
pub fn aligned(rows: &[Vec<String>], is_left: impl Fn(usize) -> bool) -> String {
    let columns = rows[0].len();
    let width = |k: usize| rows.iter().map(|r| r[k].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let cells: Vec<String> = (0..columns)
            .map(|k| match is_left(k) {
                true => format!("{:<w$}", row[k], w = widths[k]),
                false => format!("{:>w$}", row[k], w = widths[k]),
            })
            .collect();
        text += &format!("  {}\n", cells.join("  ").trim_end());
    }
    text
}

/// Formats four significant digits.
pub fn four_digits(value: f64) -> String {
    significant(value, 4)
}

fn significant(value: f64, digits: usize) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".into();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{value:.*e}", digits - 1);
    }
    let decimals = (digits as i32 - 1 - libm::log10(size).floor() as i32).max(0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_have_significant_digits() {
        let shown = |value, error| Cell::Number(value, error).shown();
        assert_eq!(shown(0.40812, Some(0.005278)), "0.4081 ± 0.0053");
        assert_eq!(shown(-12345.6, Some(123.4)), "-12346 ± 123");
        assert_eq!([shown(1.5e-7, None), shown(0.0, None)], ["1.500e-7", "0"]);
        let table =
            Table { heads: vec!["a".into(), "b".into()], rows: vec![vec![Cell::text("x|y"), Cell::Nothing]] };
        assert_eq!(table.markdown(), "| a | b |\n|---|---|\n| x\\|y | – |\n");
        assert_eq!(table.aligned(1), "  a    b\n  x|y  –\n");
    }
}
