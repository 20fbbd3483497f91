//! Included files of a scene: `include = ["…"]`.
//!
//! Spans continue from file to file, so that each identifies its file.

use super::SceneError;
use super::document::{Document, line_of, syntax};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};
use trackbed_io::read::source;

pub(super) const KEY: &str = "include";

/// Text of an included file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct IncludedText {
    /// Name in the scene.
    pub name: String,
    /// Content.
    pub text: String,
}

#[derive(Clone)]
pub(super) struct Included {
    pub named: PathBuf,
    pub file: PathBuf,
    /// Text, after blanks for all spans before.
    text: String,
    start: usize,
}

impl Included {
    pub fn tree(&self) -> DeTable<'_> {
        DeTable::parse(&self.text).expect("the text was parsed when the file was read").into_inner()
    }

    pub fn stored(&self) -> IncludedText {
        let own = &self.text[self.start..];
        let text = own.strip_suffix('\n').unwrap_or(own).to_string();
        IncludedText { name: self.named.to_string_lossy().into_owned(), text }
    }

    pub fn text(&self) -> &str {
        &self.text
    }

    pub fn end(&self) -> usize {
        self.text.len()
    }

    pub fn holds(&self, place: usize) -> bool {
        (self.start..self.end()).contains(&place)
    }

    pub fn line(&self, place: usize) -> usize {
        line_of(&self.text[self.start..], place - self.start)
    }
}

/// Reads the files of `include` or of its override, relative to the scene's directory.
///
/// # Errors
/// `include` is no list of names; I/O errors; invalid TOML; nested includes.
pub(super) fn read(document: &Document) -> Result<Vec<Included>, SceneError> {
    let expected = "a list of files: include = [\"granite.toml\"]";
    let tree = DeTable::parse(document.text()).expect("the text was parsed before").into_inner();
    let set =
        document.overrides().iter().rev().find(|(path, _)| path == KEY).map(|(_, value)| value.as_str());
    let set = match set {
        Some("") => return Ok(Vec::new()),
        Some(value) => Some(DeValue::parse(value).map_or(DeValue::String(value.into()), Spanned::into_inner)),
        None => None,
    };
    let names = match set.as_ref().or_else(|| tree.get(KEY).map(Spanned::get_ref)) {
        None => return Ok(Vec::new()),
        Some(DeValue::Array(names)) => names,
        Some(_) => return Err(document.error(KEY, "no list", expected)),
    };
    let mut start = document.text().len();
    let mut all = Vec::new();
    for (k, name) in names.iter().enumerate() {
        let key = format!("{KEY}.{k}");
        let DeValue::String(name) = name.get_ref() else {
            return Err(document.error(&key, "no name", expected));
        };
        let file = document.file().parent().unwrap_or(Path::new("")).join(name.as_ref());
        let own = match document.stored_text(name) {
            Some(text) => text.to_string(),
            None => source::text(&file).map_err(|refusal| {
                let (found, expected) = refusal.words(|e| e.to_string());
                document.error(&key, format!("{}: {found}", file.display()), expected)
            })?,
        };
        let text = format!("{}{own}\n", " ".repeat(start));
        syntax(&file, &text, start)?;
        let included = Included { named: PathBuf::from(name.as_ref()), file, text, start };
        if included.tree().contains_key(KEY) {
            let found = format!("{}, which includes files itself", included.file.display());
            return Err(document.error(&key, found, "a file without `include`"));
        }
        start = included.end();
        all.push(included);
    }
    Ok(all)
}

/// Merges an included file key by key. Existing values of `own` stay; lists of tables are extended by tables
/// of new `name`.
pub(super) fn merge<'a>(own: &mut DeTable<'a>, other: DeTable<'a>) {
    for (key, value) in other {
        match (own.get_mut(key.get_ref().as_ref()).map(Spanned::get_mut), value.get_ref()) {
            (None, _) => {
                own.insert(key, value);
            }
            (Some(DeValue::Table(own)), DeValue::Table(_)) => {
                let DeValue::Table(other) = value.into_inner() else { unreachable!("seen above") };
                merge(own, other);
            }
            (Some(DeValue::Array(own)), DeValue::Array(list)) if tables(own) && tables(list) => {
                let DeValue::Array(other) = value.into_inner() else { unreachable!("seen above") };
                merge_lists(own, other);
            }
            _ => {}
        }
    }
}

fn tables(list: &DeArray<'_>) -> bool {
    list.iter().all(|value| matches!(value.get_ref(), DeValue::Table(_)))
}

fn merge_lists<'a>(own: &mut DeArray<'a>, other: DeArray<'a>) {
    for value in other {
        let there = name(value.get_ref())
            .and_then(|name| own.iter().position(|o| self::name(o.get_ref()) == Some(name)));
        match there.and_then(|k| own.get_mut(k)).map(Spanned::get_mut) {
            Some(DeValue::Table(own)) => {
                let DeValue::Table(other) = value.into_inner() else { unreachable!("a list of tables") };
                merge(own, other);
            }
            _ => own.push(value),
        }
    }
}

fn name<'t>(table: &'t DeValue<'_>) -> Option<&'t str> {
    table.as_table()?.get("name")?.get_ref().as_str()
}
