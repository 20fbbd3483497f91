//! Earlier names of keys and values ([`replaced`]) in a scene.

use toml::Spanned;
use toml::de::{DeTable, DeValue};
use trackbed_io::replaced;

/// Replaces earlier names by current ones unless both stand there; `said` receives path, found and new name.
pub(super) fn apply(tree: &mut DeTable<'_>, said: &mut dyn FnMut(&str, &str, &str)) {
    table("", tree, said);
}

fn table(prefix: &str, entries: &mut DeTable<'_>, said: &mut dyn FnMut(&str, &str, &str)) {
    let names: Vec<String> = entries.keys().map(|key| key.get_ref().to_string()).collect();
    for name in names {
        let path = format!("{prefix}{name}");
        let new = replaced::key(&path).filter(|new| !entries.contains_key(*new));
        let name = new.unwrap_or(&name).to_string();
        if let Some(new) = new {
            let old = path.rsplit('.').next().unwrap_or_default();
            said(&path, &format!("`{old}`"), &format!("`{new}`"));
            if let Some((key, value)) = entries.remove_entry(old) {
                entries.insert(Spanned::new(key.span(), new.into()), value);
            }
        }
        let Some(value) = entries.get_mut(name.as_str()) else { continue };
        visit(&format!("{prefix}{name}"), value.get_mut(), said);
    }
}

fn visit(path: &str, value: &mut DeValue<'_>, said: &mut dyn FnMut(&str, &str, &str)) {
    match value {
        DeValue::Table(entries) => table(&format!("{path}."), entries, said),
        DeValue::Array(items) => {
            for (k, item) in items.iter_mut().enumerate() {
                visit(&format!("{path}.{k}"), item.get_mut(), said);
            }
        }
        DeValue::String(word) => {
            if let Some(new) = replaced::value(path, word) {
                said(path, &format!("\"{word}\""), &format!("\"{new}\""));
                *word = new.into();
            }
        }
        _ => {}
    }
}

/// Returns the path with the current name of its key.
pub(super) fn path(path: String) -> String {
    match (replaced::key(&path), path.rsplit_once('.')) {
        (Some(new), Some((table, _))) => format!("{table}.{new}"),
        _ => path,
    }
}

/// Path of the first earlier name that stands beside its new name, and the new name.
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
