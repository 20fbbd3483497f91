//! Parameter sets of a study.

use super::file::{AxisTable, Combine, StudyFile};
use crate::scene::{Document, SceneError};

/// Most runs.
pub const MOST_RUNS: usize = 100_000;
/// Label in one-at-a-time studies.
const BASE: &str = "base";

/// Parameter set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Label.
    pub label: String,
    /// Axis value labels.
    pub levels: Vec<String>,
    /// Overrides, common ones first.
    pub set: Vec<String>,
}

/// Resolved axis.
pub struct Axis {
    /// Name.
    pub name: String,
    values: Vec<(String, Vec<String>)>,
}

impl Axis {
    /// Resolves axis `index`.
    ///
    /// # Errors
    /// Input errors.
    pub fn new(document: &Document, index: usize, table: &AxisTable) -> Result<Axis, SceneError> {
        let place = |key: &str| format!("axis.{index}.{key}");
        let of_key = table.key.as_deref().map(|key| key.rsplit('.').next().unwrap_or(key).to_string());
        let Some(name) = table.name.clone().or(of_key).filter(|n| !n.trim().is_empty()) else {
            return Err(document.error(&place("name"), "nothing", "a name, or `key`"));
        };
        if name.contains(['=', ',', '|', '"', '\n']) {
            return Err(document.error(
                &place("name"),
                format!("{name:?}"),
                "a name without = , | or quotes",
            ));
        }
        if table.values.is_empty() {
            return Err(document.error(&place("values"), "no value", "at least one"));
        }
        let value = |k: usize| match &table.key {
            Some(key) => Ok(value_of_key(key, &table.values[k])),
            None => labelled(document, &place(&format!("values.{k}")), &table.values[k]),
        };
        let values = (0..table.values.len()).map(value).collect::<Result<Vec<_>, _>>()?;
        Ok(Axis { name, values })
    }

    fn label(&self, value: usize) -> String {
        format!("{}={}", self.name, self.values[value].0)
    }
}

fn value_of_key(key: &str, value: &toml::Value) -> (String, Vec<String>) {
    let label = match value {
        toml::Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    (label, vec![format!("{key}={value}")])
}

fn labelled(
    document: &Document,
    place: &str,
    value: &toml::Value,
) -> Result<(String, Vec<String>), SceneError> {
    let expected = "a table with `label` and `set`, or `key` with `values`";
    let Some(table) = value.as_table() else {
        return Err(document.error(place, value.to_string(), expected));
    };
    if let Some(key) = table.keys().find(|k| *k != "label" && *k != "set") {
        return Err(document.error(
            &format!("{place}.{key}"),
            format!("the unknown key `{key}`"),
            "`label` or `set`",
        ));
    }
    let label = table.get("label").and_then(toml::Value::as_str).filter(|l| !l.trim().is_empty());
    let Some(label) = label else {
        return Err(document.error(&format!("{place}.label"), found(table.get("label")), "a text"));
    };
    let texts = |list: &Vec<toml::Value>| list.iter().map(|v| v.as_str().map(String::from)).collect();
    let set: Option<Vec<String>> = table.get("set").and_then(toml::Value::as_array).and_then(texts);
    match set {
        Some(set) => Ok((label.to_string(), set)),
        None => {
            let expected = "a list of texts key.path=value";
            Err(document.error(&format!("{place}.set"), found(table.get("set")), expected))
        }
    }
}

fn found(value: Option<&toml::Value>) -> String {
    value.map_or("nothing".into(), ToString::to_string)
}

/// Combines the axes.
///
/// # Errors
/// Incompatible axes.
pub fn combine(document: &Document, file: &StudyFile, axes: &[Axis]) -> Result<Vec<Setting>, SceneError> {
    let counts: Vec<usize> = axes.iter().map(|a| a.values.len()).collect();
    let picks: Vec<Vec<usize>> = match file.combine {
        Combine::Grid => {
            let all = counts.iter().try_fold(1_usize, |n, c| n.checked_mul(*c)).filter(|n| *n <= MOST_RUNS);
            let Some(all) = all else {
                return Err(document.error("axis", "too many cases", format!("at most {MOST_RUNS} runs")));
            };
            (0..all).map(|k| mixed_radix(k, &counts)).collect()
        }
        Combine::List => {
            if let Some(k) = counts.iter().position(|c| *c != counts[0]) {
                let found = format!("{} values", counts[k]);
                let expected =
                    format!("{}, as many as the first axis has, for combine = \"list\"", counts[0]);
                return Err(document.error(&format!("axis.{k}.values"), found, expected));
            }
            (0..counts.first().copied().unwrap_or(1)).map(|k| vec![k; axes.len()]).collect()
        }
        Combine::OneAtATime => {
            let base = vec![0; axes.len()];
            let varied = (0..axes.len()).flat_map(|a| (1..counts[a]).map(move |v| (a, v)));
            let varied =
                varied.map(|(a, v)| base.iter().enumerate().map(move |(k, b)| if k == a { v } else { *b }));
            std::iter::once(base.clone()).chain(varied.map(Iterator::collect)).collect()
        }
    };
    let setting = |pick: &Vec<usize>| {
        let chosen = || axes.iter().zip(pick.iter().copied());
        let alone = file.combine == Combine::OneAtATime;
        let parts: Vec<String> =
            chosen().filter(|(_, v)| !alone || *v > 0).map(|(axis, v)| axis.label(v)).collect();
        let label = if parts.is_empty() { BASE.to_string() } else { parts.join(", ") };
        let levels = chosen().map(|(axis, v)| axis.values[v].0.clone()).collect();
        let own = chosen().flat_map(|(axis, v)| axis.values[v].1.iter().cloned());
        Setting { label, levels, set: file.base.set.iter().cloned().chain(own).collect() }
    };
    Ok(picks.iter().map(setting).collect())
}

fn mixed_radix(mut number: usize, counts: &[usize]) -> Vec<usize> {
    let mut digits = vec![0; counts.len()];
    for (digit, count) in digits.iter_mut().zip(counts).rev() {
        *digit = number % count;
        number /= count;
    }
    digits
}
