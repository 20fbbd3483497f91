//! Splits key descriptions into table columns.
//!
//! Clauses between semicolons: noun phrase with unit in brackets, default (`default …`) or alternatives (`or
//! …`), range (from a number or one of `> ≥ < ≤`), conditions.

/// Columns of a description.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Description {
    /// Unit or empty.
    pub unit: String,
    /// Default value or alternative keys.
    pub default: String,
    /// Allowed values.
    pub range: String,
    /// Noun phrase.
    pub meaning: String,
    /// Conditions and notes.
    pub conditions: Vec<String>,
}

impl Description {
    /// Splits the description `text` into columns.
    pub fn parse(text: &str) -> Description {
        let mut clauses = clauses(text).into_iter();
        let (meaning, unit) = without_unit(clauses.next().unwrap_or_default());
        let mut parsed = Description { meaning, unit, ..Description::default() };
        for clause in clauses {
            let (column, text) = match clause.strip_prefix("default ") {
                Some(default) => (&mut parsed.default, default),
                None if clause.starts_with("or ") => (&mut parsed.default, clause.as_str()),
                None if is_range(&clause) => (&mut parsed.range, clause.as_str()),
                None => {
                    parsed.conditions.push(clause);
                    continue;
                }
            };
            if !column.is_empty() {
                column.push_str(", ");
            }
            column.push_str(text);
        }
        parsed
    }
}

fn is_range(clause: &str) -> bool {
    let number = clause.trim_start_matches(['-', '−']);
    number.starts_with(|c: char| c.is_ascii_digit() || "><≥≤".contains(c))
}

fn clauses(text: &str) -> Vec<String> {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut parts = vec![String::new()];
    let mut code = false;
    for c in text.trim_end_matches('.').chars() {
        code ^= c == '`';
        match parts.last_mut() {
            Some(last) if c != ';' || code => last.push(c),
            _ => parts.push(String::new()),
        }
    }
    parts.into_iter().map(|part| part.trim().to_string()).collect()
}

/// Clause and its unit.
fn without_unit(clause: String) -> (String, String) {
    let unit = clause.strip_suffix(']').and_then(|start| start.rsplit_once(" ["));
    match unit {
        Some((meaning, unit)) => (meaning.to_string(), unit.to_string()),
        None => (clause, String::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clauses_become_columns() {
        let text = "Young's modulus `[a; b]`\nof the contact [Pa]; default 1; or `stiffness`; > 0; −1 – 2; with `poisson`; not with\n`x`.";
        let parsed = Description::parse(text);
        assert_eq!(parsed.meaning, "Young's modulus `[a; b]` of the contact");
        assert_eq!((parsed.unit.as_str(), parsed.default.as_str()), ("Pa", "1, or `stiffness`"));
        assert_eq!(parsed.range, "> 0, −1 – 2");
        assert_eq!(parsed.conditions, ["with `poisson`", "not with `x`"]);
    }

    #[test]
    fn keeps_trailing_lists() {
        assert_eq!(Description::parse("Corners `[[x, y], [x, y]]`.").unit, "");
        assert_eq!(Description::parse("Corners `[[x, y], [x, y]]` [m].").unit, "m");
    }
}
