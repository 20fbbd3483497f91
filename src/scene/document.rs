//! Scene file as a tree with the line of every key, for error messages.

use super::include::{self, Included, IncludedText};
use super::renames::{self, Rename};
use super::value::Value;
use super::wording::explain;
use super::{Problem, SceneError};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};
use trackbed_io::read::source;
use trackbed_io::replaced;

/// Parsed scene file.
#[derive(Clone)]
pub struct Document {
    file: PathBuf,
    text: String,
    included: Vec<Included>,
    /// Command-line overrides; their spans lie past the text.
    overrides: Vec<(String, String)>,
    /// Overrides as given, with names instead of indices.
    given: Vec<String>,
    /// Texts of included files, read in place of the files.
    stored: Vec<IncludedText>,
    /// Whether any text or override may have an earlier name.
    has_earlier_names: bool,
    /// Whether the text replaces the text of the file, so that lines differ.
    in_memory: bool,
}

impl Document {
    /// Reads and parses `file`.
    ///
    /// # Errors
    /// I/O errors; invalid TOML.
    pub fn open(file: &Path) -> Result<Document, SceneError> {
        let text = source::text(file).map_err(|refusal| {
            let (found, expected) = refusal.words(|e| e.to_string());
            SceneError::whole(file, "file", found, expected)
        })?;
        Document::parse(file, text)
    }

    /// Parses `text` as the content of `file`.
    ///
    /// # Errors
    /// Invalid TOML.
    pub fn parse(file: &Path, text: String) -> Result<Document, SceneError> {
        Document::with_included(file, text, Vec::new())
    }

    /// Opens `file`, or `text` in its place: paths are relative to `file`, errors have no lines.
    ///
    /// # Errors
    /// As [`Document::open`].
    pub fn open_or(file: &Path, text: Option<&str>) -> Result<Document, SceneError> {
        let Some(text) = text else { return Document::open(file) };
        Ok(Document { in_memory: true, ..Document::parse(file, text.into())? })
    }

    /// Parses `text` as the content of `file`, with stored texts of included files.
    ///
    /// # Errors
    /// Invalid TOML.
    pub fn with_included(
        file: &Path,
        text: String,
        stored: Vec<IncludedText>,
    ) -> Result<Document, SceneError> {
        syntax(file, &text, 0)?;
        let mut document = Document {
            file: file.to_path_buf(),
            text,
            included: Vec::new(),
            overrides: Vec::new(),
            given: Vec::new(),
            stored,
            has_earlier_names: false,
            in_memory: false,
        };
        document.include()?;
        Ok(document)
    }

    fn tree(&self) -> Spanned<DeTable<'_>> {
        self.renamed_tree(&mut Vec::new())
    }

    /// `done`: see [`renames::apply`].
    fn renamed_tree(&self, done: &mut Vec<Rename>) -> Spanned<DeTable<'_>> {
        let mut tree = DeTable::parse(&self.text).expect("the text was parsed when the document was opened");
        let mut rename = |tree: &mut DeTable<'_>| {
            if self.has_earlier_names {
                renames::apply(tree, done);
            }
        };
        rename(tree.get_mut());
        for file in &self.included {
            let mut own = file.tree();
            rename(&mut own);
            include::merge(tree.get_mut(), own);
        }
        for (path, value) in &self.overrides {
            self.apply(tree.get_mut(), path, value).expect("the override was applied when it was set");
            rename(tree.get_mut());
        }
        tree
    }

    fn include(&mut self) -> Result<(), SceneError> {
        self.included = include::read(self)?;
        let mut texts = self.included.iter().map(Included::text).chain([&*self.text]);
        self.has_earlier_names |= texts.any(replaced::occurs_in);
        Ok(())
    }

    /// Sets one key; see [`Document::set_all`].
    ///
    /// # Errors
    /// As [`Document::set_all`].
    pub fn set(&mut self, assignment: &str) -> Result<(), SceneError> {
        self.set_all(&[assignment.to_string()])
    }

    /// Sets keys, given as `key.path=value`, in order. An empty value removes the key; a value that is not TOML
    /// is a string. Tables of an array are addressed by index or name: `solid.material.clay.young=2e7`; a table
    /// at the index after the last is appended.
    /// `include` replaces the included files.
    ///
    /// # Errors
    /// No `=`, a path through a value, an unreadable file.
    pub fn set_all(&mut self, assignments: &[String]) -> Result<(), SceneError> {
        if assignments.iter().any(|a| included_by(a).is_some()) {
            // Names are resolved again: their indices may differ in the new files.
            let all: Vec<String> = self.given.drain(..).chain(assignments.iter().cloned()).collect();
            let others;
            (self.given, others) = all.into_iter().partition(|a| included_by(a).is_some());
            let values = self.given.iter().filter_map(|a| included_by(a));
            self.overrides = values.map(|value| (include::KEY.into(), value.into())).collect();
            self.include()?;
            return self.set_all(&others);
        }
        self.has_earlier_names |= assignments.iter().any(|a| replaced::occurs_in(a));
        let mut set = Vec::new();
        let mut tree = self.tree();
        for assignment in assignments {
            let Some((path, value)) = assignment.split_once('=') else {
                return Err(override_error(assignment, assignment, "key.path=value"));
            };
            let path = current(tree.get_ref(), numbered(tree.get_ref(), path.trim()));
            self.apply(tree.get_mut(), &path, value.trim())?;
            if self.has_earlier_names {
                renames::apply(tree.get_mut(), &mut Vec::new());
            }
            set.push((path, value.trim().to_string()));
        }
        self.overrides.append(&mut set);
        self.given.extend_from_slice(assignments);
        Ok(())
    }

    fn apply<'a>(&self, root: &mut DeTable<'a>, path: &str, value: &'a str) -> Result<(), SceneError> {
        let end = self.end();
        let span = end..end;
        let parsed = match DeValue::parse(value) {
            Ok(v) => v.into_inner(),
            Err(_) => DeValue::String(value.into()),
        };
        let (parents, last) = path.rsplit_once('.').unwrap_or(("", path));
        let mut table = root;
        let mut parts = parents.split('.').filter(|p| !p.is_empty());
        while let Some(key) = parts.next() {
            if !table.contains_key(key) {
                // The first table of a list.
                if last == "0" && parts.clone().next().is_none() && matches!(parsed, DeValue::Table(_)) {
                    let mut list = DeArray::new();
                    list.push(Spanned::new(span.clone(), parsed));
                    let key = Spanned::new(span.clone(), key.to_string().into());
                    table.insert(key, Spanned::new(span, DeValue::Array(list)));
                    return Ok(());
                }
                table.insert(
                    Spanned::new(span.clone(), key.to_string().into()),
                    Spanned::new(span.clone(), DeValue::Table(DeTable::new())),
                );
            }
            table = match table.get_mut(key).expect("inserted above").get_mut() {
                DeValue::Table(t) => t,
                DeValue::Array(a) => {
                    let count = a.len();
                    let next = parts.next();
                    let index: Option<usize> = next.unwrap_or(last).parse().ok();
                    if next.is_none() && index == Some(count) && matches!(parsed, DeValue::Table(_)) {
                        a.push(Spanned::new(span, parsed));
                        return Ok(());
                    }
                    match index.filter(|_| next.is_some()).and_then(|i| a.get_mut(i)).map(|v| v.get_mut()) {
                        Some(DeValue::Table(t)) => t,
                        _ => {
                            let expected =
                                format!("an index below {count}, or the name of a table, after `{key}`");
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
        table.insert(Spanned::new(span.clone(), last.to_string().into()), Spanned::new(span, parsed));
        Ok(())
    }

    /// Deserialises the tree into `T`; suggests names for unknown keys.
    ///
    /// # Errors
    /// Unknown or missing keys, wrong types or units.
    pub fn read<T: for<'de> Deserialize<'de>>(&self) -> Result<T, SceneError> {
        let mut root = self.tree();
        root.get_mut().remove(include::KEY);
        T::deserialize(Value::root(root)).map_err(|fault| {
            let tree = self.tree();
            if let Some((key, new)) = renames::conflict(tree.get_ref()) {
                return self.problem(&key, Problem::conflict(format!("`{new}`")));
            }
            let value = value_at(tree.get_ref(), &fault.path);
            let (key, found, expected) = explain(&fault.message, &fault.path, value);
            self.error(&key, found, expected)
        })
    }

    /// Returns a note for each key or value that has an earlier name.
    pub fn renamed(&self) -> Vec<String> {
        let mut done = Vec::new();
        let tree = self.renamed_tree(&mut done);
        let hidden = |path: &str| self.overrides.iter().any(|(key, _)| is_below(path, key));
        let notes = done.iter().filter_map(|Rename { path, span, old, new }| match self.line(span) {
            Some((file, line)) if !hidden(path) => {
                Some(SceneError { line, ..SceneError::whole(file, path, old, new) }.to_string())
            }
            Some(_) => None,
            None => Some(override_error(path, old, new).to_string()),
        });
        let given = self.given.iter().filter_map(|assignment| {
            let path = numbered(tree.get_ref(), assignment.split_once('=')?.0.trim());
            let (new, old) = (replaced::key(&path)?, path.rsplit('.').next()?);
            Some(override_error(&path, &format!("`{old}`"), &format!("`{new}`")).to_string())
        });
        let mut all: Vec<String> = notes.chain(given).collect();
        all.dedup();
        all
    }

    /// Returns an error with its line for the key at `path`.
    pub fn error(&self, path: &str, found: impl Into<String>, expected: impl Into<String>) -> SceneError {
        self.problem(path, Problem::value(found, expected))
    }

    /// Returns an error of any form for the key at `path`.
    pub fn problem(&self, path: &str, problem: Problem) -> SceneError {
        // An override of a table covers its keys, and an overridden key the table that it creates.
        let made = |key: &str| is_below(key, path) && self.locate(path).is_none();
        let overridden = self.overrides.iter().any(|(key, _)| is_below(path, key) || made(key));
        let (file, line) = match self.locate(path) {
            _ if overridden => (Path::new("--set"), None),
            Some((file, line)) => (file, line),
            None => (self.file.as_path(), None),
        };
        SceneError { file: file.to_path_buf(), line, key: path.to_string(), problem, remedy: None }
    }

    /// Returns an error for the number farthest from 1: `quantity` would overflow.
    pub fn beyond_range(&self, quantity: &str) -> SceneError {
        let keys = self.keys();
        let extreme = keys.iter().max_by(|a, b| size(a.1).total_cmp(&size(b.1)));
        let (key, value) = extreme.map_or(("scene", "its numbers"), |(key, value)| (key, value));
        // In exponent form: the digits of 1e-300 fill lines.
        let value = value.parse().map_or(value.to_string(), |x: f64| format!("{x:e}"));
        self.error(key, value, format!("a number of usual size, as {quantity} would not be finite"))
    }

    /// Whether the scene has a key.
    pub fn has(&self, path: &str) -> bool {
        let parts: Vec<String> = path.split('.').map(String::from).collect();
        value_at(self.tree().get_ref(), &parts).is_some()
    }

    /// Returns a value as TOML, if present.
    pub fn value(&self, path: &str) -> Option<String> {
        self.keys().remove(path)
    }

    /// Returns the scene file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Returns the texts of the included files.
    pub fn included_texts(&self) -> impl Iterator<Item = IncludedText> {
        self.included.iter().map(Included::stored)
    }

    pub(super) fn stored_text(&self, name: &str) -> Option<&str> {
        self.stored.iter().find(|file| file.name == name).map(|file| file.text.as_str())
    }

    /// Returns the included files, as named in the scene.
    pub fn included(&self) -> impl Iterator<Item = &Path> {
        self.included.iter().map(|file| file.named.as_path())
    }

    /// Returns the text of the file.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the text if it replaces the text of the file.
    pub fn text_in_memory(&self) -> Option<&str> {
        self.in_memory.then_some(&self.text)
    }

    /// Returns the command-line overrides (key path, value).
    pub fn overrides(&self) -> &[(String, String)] {
        &self.overrides
    }

    /// Returns all keys with TOML values, overrides applied.
    pub fn keys(&self) -> BTreeMap<String, String> {
        fn visit(path: &str, value: &toml::Value, out: &mut BTreeMap<String, String>) {
            let below = |key: &str| if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
            match value {
                toml::Value::Table(t) => t.iter().for_each(|(k, v)| visit(&below(k), v, out)),
                toml::Value::Array(a) if a.iter().any(toml::Value::is_table) => {
                    a.iter().enumerate().for_each(|(i, v)| visit(&below(&i.to_string()), v, out));
                }
                other => {
                    out.insert(path.to_string(), other.to_string());
                }
            }
        }
        let mut out = BTreeMap::new();
        if let Ok(tree) = self.read::<toml::Table>() {
            visit("", &toml::Value::Table(tree), &mut out);
        }
        out
    }

    /// Resolves `path` relative to the scene file, else to the first included file that has it.
    pub fn resolve(&self, path: &Path) -> PathBuf {
        let beside = |file: &Path| file.parent().unwrap_or(Path::new("")).join(path);
        let own = beside(&self.file);
        if self.included.is_empty() || own.exists() {
            return own;
        }
        let others = self.included.iter().map(|file| beside(&file.file));
        others.into_iter().find(|there| there.exists()).unwrap_or(own)
    }

    /// End of all spans.
    fn end(&self) -> usize {
        self.included.last().map_or(self.text.len(), Included::end)
    }

    fn line(&self, span: &Range<usize>) -> Option<(&Path, Option<usize>)> {
        if span.start < self.text.len() {
            let line = (!self.in_memory).then(|| line_of(&self.text, span.start));
            return Some((&self.file, line));
        }
        let file = self.included.iter().find(|file| file.holds(span.start))?;
        Some((&file.file, Some(file.line(span.start))))
    }

    /// File and line of the deepest existing part of `path`.
    fn locate(&self, path: &str) -> Option<(&Path, Option<usize>)> {
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
                let a: &DeArray = a;
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

/// Value of an override of `include`.
fn included_by(assignment: &str) -> Option<&str> {
    let (path, value) = assignment.split_once('=')?;
    (path.trim() == include::KEY).then(|| value.trim())
}

/// Path with indices in place of names of tables; indices take precedence.
fn numbered(tree: &DeTable<'_>, path: &str) -> String {
    let (mut table, mut array) = (Some(tree), None::<&DeArray>);
    let mut parts: Vec<String> = path.split('.').map(String::from).collect();
    for part in &mut parts {
        let value = if let Some(t) = table {
            t.get(part.as_str())
        } else if let Some(rows) = array {
            let named = |row: &&Spanned<DeValue>| {
                let name = row.get_ref().as_table().and_then(|t| t.get("name"));
                name.and_then(|n| n.get_ref().as_str()) == Some(part.as_str())
            };
            let index = part.parse().ok().or_else(|| rows.iter().position(|row| named(&row)));
            if let Some(index) = index {
                *part = index.to_string();
            }
            index.and_then(|index| rows.get(index))
        } else {
            None
        };
        table = value.and_then(|v| v.get_ref().as_table());
        array = value.and_then(|v| v.get_ref().as_array());
    }
    parts.join(".")
}

/// Path of an override with the current name of its key, unless the earlier one is present.
fn current(tree: &DeTable<'_>, path: String) -> String {
    let Some((new, (table, _))) = replaced::key(&path).zip(path.rsplit_once('.')) else { return path };
    let parts: Vec<String> = path.split('.').map(String::from).collect();
    if value_at(tree, &parts).is_some() { path } else { format!("{table}.{new}") }
}

pub(super) fn syntax(file: &Path, text: &str, start: usize) -> Result<(), SceneError> {
    let wrong = |e: toml::de::Error| {
        let message = e.message().lines().collect::<Vec<_>>().join(", ");
        let (found, expected) = message.split_once(", expected ").unwrap_or((&message, "valid TOML"));
        SceneError {
            line: e.span().map(|s| line_of(&text[start..], s.start.saturating_sub(start))),
            ..SceneError::whole(file, "syntax", found, expected)
        }
    };
    DeTable::parse(text).map_err(wrong).map(drop)
}

/// Powers of ten between 1 and the farthest number of a value; 0 for zeros only.
fn size(value: &str) -> f64 {
    let numbers = value.split(|c: char| !(c.is_ascii_alphanumeric() || matches!(c, '.' | '-' | '+')));
    let powers = numbers.filter_map(|word| word.parse().ok()).filter(|x: &f64| *x != 0.0 && !x.is_nan());
    powers.map(|x| libm::log10(x.abs()).abs()).fold(0.0, f64::max)
}

fn override_error(key: &str, found: &str, expected: &str) -> SceneError {
    SceneError::whole(Path::new("--set"), key, found, expected)
}

fn value_at<'t>(table: &'t DeTable<'_>, path: &[String]) -> Option<&'t DeValue<'t>> {
    let (first, rest) = path.split_first()?;
    let mut value = table.get(first.as_str())?.get_ref();
    for key in rest {
        value = match value {
            DeValue::Table(t) => t.get(key.as_str())?.get_ref(),
            DeValue::Array(a) => a.get(key.parse::<usize>().ok()?)?.get_ref(),
            _ => return None,
        };
    }
    Some(value)
}

/// Whether `path` is `table` or a key in it.
fn is_below(path: &str, table: &str) -> bool {
    path.strip_prefix(table).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Line number (from 1) of a byte.
pub(super) fn line_of(text: &str, offset: usize) -> usize {
    text.as_bytes()[..offset.min(text.len())].iter().filter(|&&b| b == b'\n').count() + 1
}
