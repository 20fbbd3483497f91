//! Earlier names of keys and values ([`replaced`]) in a scene.

use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};
use trackbed_io::replaced;

/// Earlier name that was replaced.
pub(super) struct Rename {
    /// Path as written.
    pub path: String,
    /// Place in the text.
    pub span: Range<usize>,
    /// Name as written, quoted.
    pub old: String,
    /// Current name, quoted.
    pub new: String,
}

/// Replaces earlier names by current ones; a key whose current name is present stays.
pub(super) fn apply(tree: &mut DeTable<'_>, done: &mut Vec<Rename>) {
    table("", tree, done);
}

fn table(prefix: &str, entries: &mut DeTable<'_>, done: &mut Vec<Rename>) {
    let names: Vec<String> = entries.keys().map(|key| key.get_ref().to_string()).collect();
    for name in names {
        let path = format!("{prefix}{name}");
        let new = replaced::key(&path).filter(|new| !entries.contains_key(*new));
        if let Some((new, (key, value))) = new.and_then(|new| Some((new, entries.remove_entry(&*name)?))) {
            let span = key.span();
            entries.insert(Spanned::new(span.clone(), new.into()), value);
            done.push(Rename { path, span, old: format!("`{name}`"), new: format!("`{new}`") });
        }
        let name = new.unwrap_or(&name);
        if let Some(value) = entries.get_mut(name) {
            visit(&format!("{prefix}{name}"), value, done);
        }
    }
}

fn visit(path: &str, value: &mut Spanned<DeValue<'_>>, done: &mut Vec<Rename>) {
    let span = value.span();
    match value.get_mut() {
        DeValue::Table(entries) => table(&format!("{path}."), entries, done),
        DeValue::Array(items) => {
            items.iter_mut().enumerate().for_each(|(k, item)| visit(&format!("{path}.{k}"), item, done));
        }
        DeValue::String(word) => {
            if let Some(new) = replaced::value(path, word) {
                let (old, new_text) = (format!("\"{word}\""), format!("\"{new}\""));
                done.push(Rename { path: path.into(), span, old, new: new_text });
                *word = new.into();
            }
        }
        _ => {}
    }
}

/// Path of the first key that stands beside its current name, and that name.
pub(super) fn conflict(tree: &DeTable<'_>) -> Option<(String, &'static str)> {
    fn table(prefix: &str, entries: &DeTable<'_>) -> Option<(String, &'static str)> {
        entries.iter().find_map(|(key, value)| {
            let path = format!("{prefix}{}", key.get_ref());
            match replaced::key(&path) {
                Some(new) => Some((path, new)),
                None => visit(&path, value.get_ref()),
            }
        })
    }
    fn visit(path: &str, value: &DeValue<'_>) -> Option<(String, &'static str)> {
        match value {
            DeValue::Table(entries) => table(&format!("{path}."), entries),
            DeValue::Array(items) => {
                items.iter().enumerate().find_map(|(k, item)| visit(&format!("{path}.{k}"), item.get_ref()))
            }
            _ => None,
        }
    }
    table("", tree)
}
