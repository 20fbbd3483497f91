//! Rewords parser messages without type names.

use toml::de::DeValue;

/// Key, found and expected, from a parser message about `value` at `path`.
pub(super) fn explain(
    message: &str,
    path: &[String],
    value: Option<&DeValue<'_>>,
) -> (String, String, String) {
    let here = path.join(".");
    if let Some(rest) = message.strip_prefix("unknown field ") {
        return unknown_key(rest, path, here);
    }
    if let Some(rest) = message.strip_prefix("missing field ") {
        return (join(&here, quoted(rest)), "nothing".into(), "a value for this key".into());
    }
    if let Some(rest) = message.strip_prefix("unknown variant ") {
        let expected = rest.split_once("expected ").map_or("another word", |(_, e)| e);
        return (here, format!("\"{}\"", quoted(rest)), expected.replace('`', "\""));
    }
    for prefix in ["invalid value: ", "invalid type: ", "invalid length "] {
        if let Some((found, expected)) =
            message.strip_prefix(prefix).and_then(|r| r.split_once(", expected "))
        {
            let found = match found {
                "map" => "a table".to_string(),
                "sequence" => "a list".to_string(),
                count if prefix == "invalid length " => format!("a list of {count}"),
                other => other.replace('`', ""),
            };
            return (here, found.clone(), expectation(&found, expected));
        }
    }
    if message == super::value::NO_WORD {
        return (here, kind_of(value).into(), "a word in quotes".into());
    }
    (here, message.lines().collect::<Vec<_>>().join(", "), "a valid value".into())
}

fn unknown_key(rest: &str, path: &[String], here: String) -> (String, String, String) {
    let unknown = quoted(rest);
    let known: Vec<&str> = rest
        .split_once("expected")
        .map(|(_, e)| e.split('`').skip(1).step_by(2).collect())
        .unwrap_or_default();
    let key = if path.last().is_some_and(|last| last == unknown) { here } else { join(&here, unknown) };
    let nearest = known.iter().min_by_key(|k| edit_distance(k, unknown));
    let expected = match nearest {
        Some(k) if edit_distance(k, unknown) <= 1 + k.len() / 3 => format!("`{k}`"),
        _ => format!("one of {}", known.join(", ")),
    };
    (key, format!("the unknown key `{unknown}`"), expected)
}

fn expectation(found: &str, expected: &str) -> String {
    let too_large = |most: u64| {
        let number = found.strip_prefix("integer ").and_then(|n| n.parse::<u64>().ok());
        number.filter(|n| *n > most).map(|_| format!("a whole number, {most} at most"))
    };
    let most = match expected {
        "u8" => too_large(u64::from(u8::MAX)),
        "u16" => too_large(u64::from(u16::MAX)),
        "u32" => too_large(u64::from(u32::MAX)),
        _ => None,
    };
    let length = ["an array of length ", "a tuple of size "].iter().find_map(|p| expected.strip_prefix(p));
    match (expected, most, length) {
        (_, Some(most), _) => most,
        (_, _, Some(length)) => format!("a list of {length}"),
        ("u8" | "u16" | "u32" | "u64" | "usize", ..) => "a whole number of 0 or more".into(),
        ("i8" | "i16" | "i32" | "i64", ..) => "a whole number".into(),
        ("f32" | "f64", ..) => "a number".into(),
        ("a boolean", ..) => "true or false".into(),
        ("a sequence", ..) => "a list".into(),
        ("a map", ..) => "a table".into(),
        ("variant identifier" | "string or map" | "map with a single key", ..) => "a word in quotes".into(),
        ("fewer elements in sequence" | "fewer elements in array", ..) => "a shorter list".into(),
        ("path string", ..) => "the path of a file, as a string".into(),
        (named, ..) if ["struct ", "internally tagged enum "].iter().any(|p| named.starts_with(p)) => {
            "a table".into()
        }
        (other, ..) => other.into(),
    }
}

fn kind_of(value: Option<&DeValue<'_>>) -> &'static str {
    match value {
        Some(DeValue::String(_)) => "a string",
        Some(DeValue::Integer(_) | DeValue::Float(_)) => "a number",
        Some(DeValue::Boolean(_)) => "true or false",
        Some(DeValue::Datetime(_)) => "a date",
        Some(DeValue::Array(_)) => "a list",
        Some(DeValue::Table(_)) => "a table",
        None => "something else",
    }
}

fn quoted(text: &str) -> &str {
    text.split('`').nth(1).unwrap_or_default()
}

fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_string() } else { format!("{path}.{key}") }
}

/// Levenshtein distance, for suggestions.
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for j in 0..b.len() {
            let substitute = diagonal + usize::from(ca != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = substitute.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.len()]
}
