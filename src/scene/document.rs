//! The scene file as a tree with the line of every key, so that each message can name its place.

use super::SceneError;
use crate::read::source;
use serde::Deserialize;
use serde::de::IntoDeserializer;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A parsed scene file.
pub struct Document {
    file: PathBuf,
    text: String,
    /// Overrides given on the command line as (key path, value); their values carry spans past the text.
    overrides: Vec<(String, String)>,
}

impl Document {
    /// Reads and parses `file`.
    ///
    /// # Errors
    /// The file is missing or unreadable, or it is not TOML.
    pub fn open(file: &Path) -> Result<Document, SceneError> {
        let text = source::text(file).map_err(|refusal| {
            let (found, expected) = refusal.words(|e| e.to_string());
            SceneError { file: file.to_path_buf(), line: None, key: "file".into(), found, expected }
        })?;
        Document::parse(file, text)
    }

    /// Parses `text` as the content of `file`.
    ///
    /// # Errors
    /// The text is not TOML.
    pub fn parse(file: &Path, text: String) -> Result<Document, SceneError> {
        DeTable::parse(&text).map_err(|e| {
            let message = e.message().lines().collect::<Vec<_>>().join(", ");
            let (found, expected) = message.split_once(", expected ").unwrap_or((&message, "valid TOML"));
            SceneError {
                file: file.to_path_buf(),
                line: e.span().map(|s| line_of(&text, s.start)),
                key: "syntax".into(),
                found: found.into(),
                expected: expected.into(),
            }
        })?;
        Ok(Document { file: file.to_path_buf(), text, overrides: Vec::new() })
    }

    /// The tree of the text with the overrides applied.
    fn tree(&self) -> Spanned<DeTable<'_>> {
        let mut tree = DeTable::parse(&self.text).expect("the text was parsed when the document was opened");
        for (path, value) in &self.overrides {
            self.apply(tree.get_mut(), path, value).expect("the override was applied when it was set");
        }
        tree
    }

    /// Replaces or adds one key, given as `key.path=value` with a TOML value; a value that is not TOML is taken
    /// as a string, and nothing after the `=` takes the key away. Tables of an array are addressed by index: `solid.material.0.young=2e7`.
    ///
    /// # Errors
    /// No `=`, or a path through something that is not a table or an array.
    pub fn set(&mut self, assignment: &str) -> Result<(), SceneError> {
        let Some((path, value)) = assignment.split_once('=') else {
            return Err(override_error(assignment, assignment, "key.path=value"));
        };
        let (path, value) = (path.trim().to_string(), value.trim().to_string());
        self.apply(self.tree().get_mut(), &path, &value)?;
        self.overrides.push((path, value));
        Ok(())
    }

    fn apply<'a>(&self, root: &mut DeTable<'a>, path: &'a str, value: &'a str) -> Result<(), SceneError> {
        let span = self.text.len()..self.text.len();
        let parsed = match DeValue::parse(value) {
            Ok(v) => v.into_inner(),
            Err(_) => DeValue::String(value.into()),
        };
        let (parents, last) = path.rsplit_once('.').unwrap_or(("", path));
        let mut table = root;
        let mut parts = parents.split('.').filter(|p| !p.is_empty());
        while let Some(key) = parts.next() {
            if !table.contains_key(key) {
                table.insert(
                    Spanned::new(span.clone(), key.into()),
                    Spanned::new(span.clone(), DeValue::Table(DeTable::new())),
                );
            }
            table = match table.get_mut(key).expect("inserted above").get_mut() {
                DeValue::Table(t) => t,
                DeValue::Array(a) => {
                    let count = a.len();
                    let index: Option<usize> = parts.next().and_then(|i| i.parse().ok());
                    match index.and_then(|i| a.get_mut(i)).map(|v| v.get_mut()) {
                        Some(DeValue::Table(t)) => t,
                        _ => {
                            let expected = format!("an index below {count} after `{key}`");
                            return Err(override_error(path, path, &expected));
                        }
                    }
                }
                _ => {
                    return Err(override_error(path, &format!("`{key}`, which is a value"), "a table there"));
                }
            };
        }
        table.remove(last);
        if value.is_empty() {
            return Ok(());
        }
        table.insert(Spanned::new(span.clone(), last.into()), Spanned::new(span, parsed));
        Ok(())
    }

    /// Reads the tree into `T`, refusing unknown keys with a suggestion.
    ///
    /// # Errors
    /// A key is unknown, missing or of the wrong type or unit.
    pub fn read<T: for<'de> Deserialize<'de>>(&self) -> Result<T, SceneError> {
        T::deserialize(self.tree().into_deserializer()).map_err(|e: toml::de::Error| {
            let span = e.span().unwrap_or(0..0);
            let mut path = Vec::new();
            deepest(self.tree().get_ref(), &span, &mut path);
            let (key, found, expected) = explain(e.message(), &path);
            let overridden = span.start >= self.text.len();
            let file = if overridden { PathBuf::from("--set") } else { self.file.clone() };
            SceneError { file, line: self.line(&span), key, found, expected }
        })
    }

    /// An error about the key at `path` (such as `solid.material.0.poisson`), with its line.
    pub fn error(&self, path: &str, found: impl Into<String>, expected: impl Into<String>) -> SceneError {
        // A table given on the command line answers for all its keys, and a key for the table that it makes.
        let below = |long: &str, short: &str| {
            long.strip_prefix(short).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        let made = |key: &str| below(key, path) && self.locate(path).is_none();
        let overridden = self.overrides.iter().any(|(key, _)| below(path, key) || made(key));
        SceneError {
            file: if overridden { PathBuf::from("--set") } else { self.file.clone() },
            line: if overridden { None } else { self.locate(path) },
            key: path.to_string(),
            found: found.into(),
            expected: expected.into(),
        }
    }

    /// File that was read.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The text of the file, for the hash of a run.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Overrides given on the command line, as (key path, value).
    pub fn overrides(&self) -> &[(String, String)] {
        &self.overrides
    }

    /// `path` relative to the folder of the scene file.
    pub fn resolve(&self, path: &Path) -> PathBuf {
        self.file.parent().unwrap_or(Path::new("")).join(path)
    }

    fn line(&self, span: &Range<usize>) -> Option<usize> {
        (span.start < self.text.len()).then(|| line_of(&self.text, span.start))
    }

    /// Line of the deepest existing part of `path`.
    fn locate(&self, path: &str) -> Option<usize> {
        let tree = self.tree();
        let mut span = 0..0;
        let mut table = Some(tree.get_ref());
        let mut array = None;
        for part in path.split('.') {
            let value = if let Some(t) = table {
                let Some((key, value)) = t.get_key_value(part) else { break };
                span = key.span();
                value
            } else if let Some(a) = array.take() {
                let a: &toml::de::DeArray = a;
                let Some(value) = part.parse::<usize>().ok().and_then(|i| a.get(i)) else { break };
                span = value.span();
                value
            } else {
                break;
            };
            table = value.get_ref().as_table();
            array = value.get_ref().as_array();
        }
        if span == (0..0) { None } else { self.line(&span) }
    }
}

/// An error in a `--set` argument.
fn override_error(key: &str, found: &str, expected: &str) -> SceneError {
    SceneError {
        file: PathBuf::from("--set"),
        line: None,
        key: key.into(),
        found: found.into(),
        expected: expected.into(),
    }
}

/// Keys on the way to the innermost value whose text holds `span`.
fn deepest(table: &DeTable<'_>, span: &Range<usize>, path: &mut Vec<String>) {
    for (key, value) in table {
        let within = |outer: Range<usize>| outer.start <= span.start && span.end <= outer.end;
        if within(key.span()) || within(value.span()) {
            path.push(key.get_ref().to_string());
            descend(value.get_ref(), span, path);
            return;
        }
        // The span of a `[table]` header does not reach over its keys: look inside in any case.
        let before = path.len();
        path.push(key.get_ref().to_string());
        let inner = path.len();
        descend(value.get_ref(), span, path);
        if path.len() > inner {
            return;
        }
        path.truncate(before);
    }
}

fn descend(value: &DeValue<'_>, span: &Range<usize>, path: &mut Vec<String>) {
    if let Some(table) = value.as_table() {
        deepest(table, span, path);
    } else if let Some(array) = value.as_array() {
        for (i, item) in array.iter().enumerate() {
            let before = path.len();
            path.push(i.to_string());
            let inner = path.len();
            descend(item.get_ref(), span, path);
            let outer = item.span();
            if path.len() > inner || (outer.start <= span.start && span.end <= outer.end) {
                return;
            }
            path.truncate(before);
        }
    }
}

/// Key, what was found and what was expected, from a message of serde.
fn explain(message: &str, path: &[String]) -> (String, String, String) {
    let here = path.join(".");
    let quoted = |text: &str| text.split('`').nth(1).unwrap_or_default().to_string();
    if let Some(rest) = message.strip_prefix("unknown field ") {
        let unknown = quoted(rest);
        let known: Vec<&str> = rest
            .split_once("expected")
            .map(|(_, e)| e.split('`').skip(1).step_by(2).collect())
            .unwrap_or_default();
        let key = if path.last() == Some(&unknown) { here } else { join(&here, &unknown) };
        let nearest = known.iter().min_by_key(|k| edit_distance(k, &unknown));
        let expected = match nearest {
            Some(k) if edit_distance(k, &unknown) <= 1 + k.len() / 3 => format!("`{k}`"),
            _ => format!("one of {}", known.join(", ")),
        };
        return (key, format!("the unknown key `{unknown}`"), expected);
    }
    if let Some(rest) = message.strip_prefix("missing field ") {
        return (join(&here, &quoted(rest)), "nothing".into(), "a value for this key".into());
    }
    if let Some(rest) = message.strip_prefix("unknown variant ") {
        let expected = rest.split_once("expected ").map_or("another word", |(_, e)| e);
        return (here, format!("\"{}\"", quoted(rest)), expected.replace('`', "\""));
    }
    for prefix in ["invalid value: ", "invalid type: ", "invalid length "] {
        if let Some((found, expected)) =
            message.strip_prefix(prefix).and_then(|r| r.split_once(", expected "))
        {
            let expected = match expected {
                "u8" | "u32" | "u64" | "usize" => "a whole number of 0 or more",
                "f64" => "a number",
                "a boolean" => "true or false",
                other => other,
            };
            return (here, found.replace('`', ""), expected.to_string());
        }
    }
    (here, message.lines().collect::<Vec<_>>().join(", "), "a valid value".into())
}

fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_string() } else { format!("{path}.{key}") }
}

/// Levenshtein distance, for suggestions.
pub(super) fn edit_distance(a: &str, b: &str) -> usize {
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

/// Line number (from 1) of byte `offset` of `text`.
fn line_of(text: &str, offset: usize) -> usize {
    text.as_bytes()[..offset.min(text.len())].iter().filter(|&&b| b == b'\n').count() + 1
}
