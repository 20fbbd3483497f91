//! Descriptions of keys, taken apart into the columns of a table.
//!
//! A description is clauses between semicolons: a noun phrase of at most 15 words with the unit in brackets at its end, the default
//! (`default …`) or the alternatives (`or …`), the range (from a number or one of `> ≥ < ≤` on), and conditions.

/// Columns of a description.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Description {
    /// Unit, or nothing.
    pub unit: String,
    /// Default value, or the keys that may be given instead.
    pub default: String,
    /// Allowed values.
    pub range: String,
    /// Noun phrase.
    pub meaning: String,
    /// Conditions and other remarks.
    pub conditions: Vec<String>,
}

impl Description {
    /// The columns of the description `text`.
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

/// Whether a clause states the allowed values.
fn is_range(clause: &str) -> bool {
    let number = clause.trim_start_matches(['-', '−']);
    number.starts_with(|c: char| c.is_ascii_digit() || "><≥≤".contains(c))
}

/// The parts of `text` between semicolons outside of code, without its line breaks and its last point.
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

/// A clause and the unit in brackets at its end.
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
    fn lists_at_the_end_are_no_units() {
        assert_eq!(Description::parse("Corners `[[x, y], [x, y]]`.").unit, "");
        assert_eq!(Description::parse("Corners `[[x, y], [x, y]]` [m].").unit, "m");
    }
}
