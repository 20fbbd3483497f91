//! Separators of columns and decimals.

/// Separator of columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Comma,
    Semicolon,
    Tab,
}

/// Separators of a table, given by its first line.
#[derive(Clone, Copy, Debug)]
pub struct Separators {
    columns: Separator,
    /// Decimal mark of the numbers so far.
    decimals: Option<char>,
}

impl Separators {
    /// Semicolon, tab or comma of a heading or row.
    pub fn of(line: &str) -> Separators {
        let mut quoted = false;
        let mut marks = line.chars().filter(|c| {
            quoted ^= *c == '"';
            !quoted
        });
        let whole = |piece: &str| !piece.trim().starts_with(',') && !piece.trim().ends_with(',');
        let columns = match () {
            () if marks.any(|c| c == ';') => Separator::Semicolon,
            () if line.contains('\t') && line.split('\t').all(whole) => Separator::Tab,
            () => Separator::Comma,
        };
        Separators { columns, decimals: None }
    }

    /// Trimmed, unquoted fields; a separator within quotes belongs to its field.
    pub fn fields(self, line: &str) -> Vec<&str> {
        let mark = match self.columns {
            Separator::Comma => ',',
            Separator::Semicolon => ';',
            Separator::Tab => '\t',
        };
        let mut quoted = false;
        let between = |c: char| {
            quoted ^= c == '"';
            c == mark && !quoted
        };
        line.trim().split(between).map(|field| field.trim().trim_matches('"').trim()).collect()
    }

    /// Reads a number; decimal commas only between semicolons, in all rows.
    ///
    /// # Errors
    /// The expected form.
    pub fn number(&mut self, field: &str) -> Result<f64, &'static str> {
        let mark = field.chars().find(|c| matches!(c, ',' | '.'));
        if mark == Some(',') && self.columns != Separator::Semicolon {
            return Err("a number with a decimal point; decimal commas only between semicolons");
        }
        let number = match mark {
            Some(',') => field.replacen(',', ".", 1).parse::<f64>(),
            _ => field.parse(),
        };
        let number = number.map_err(|_| "a number")?;
        if let Some(mark) = mark
            && self.columns == Separator::Semicolon
            && *self.decimals.get_or_insert(mark) != mark
        {
            return Err("decimal points or decimal commas, not both");
        }
        Ok(number)
    }

    /// Cause of a wrong number of columns in a row.
    pub fn hint(self, row: &str, too_many: bool) -> &'static str {
        match self.columns {
            Separator::Comma if too_many => "; decimals behind a point, not a comma",
            _ if too_many => "",
            Separator::Comma if row.contains([';', '\t']) => ", between commas",
            Separator::Semicolon if row.contains([',', '\t']) => ", between semicolons",
            Separator::Tab if row.contains([',', ';']) => ", between tabs",
            _ if row.contains(' ') && !row.contains(',') => ", between commas, semicolons or tabs",
            _ => "",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(first: &str, line: &str) -> Result<Vec<f64>, &'static str> {
        let mut separators = Separators::of(first);
        separators.fields(line).into_iter().map(|field| separators.number(field)).collect()
    }

    #[test]
    fn reads_semicolons_tabs_and_commas() {
        for (first, line) in [
            ("time,factor", "0.5,2"),
            ("0.5,2", "0.5,2"),
            ("time;factor", "0.5 ; 2"),
            ("time;factor", "0,5;2,0"),
            ("\"time [s], of the track\";factor", "\"0,5\";\"2\""),
            ("time\tload, relative", "0.5\t2"),
            ("0.5\t2", "0.5\t2"),
            ("0.5,\t2", "0.5,\t2"),
        ] {
            assert_eq!(row(first, line), Ok(vec![0.5, 2.0]), "{first}: {line}");
        }
        assert_eq!(Separators::of("a;b").fields("\"a; b\"; c"), ["a; b", "c"]);
    }

    #[test]
    fn rejects_other_decimal_marks() {
        for (line, expected) in [
            ("0,5\t2", "a number with a decimal point; decimal commas only between semicolons"),
            ("0,5;2.5", "decimal points or decimal commas, not both"),
            ("2.5;0,5", "decimal points or decimal commas, not both"),
            ("1.000,5;2", "a number"),
            ("1,000,000;2", "a number"),
        ] {
            assert_eq!(row(line, line), Err(expected), "{line}");
        }
    }
}
