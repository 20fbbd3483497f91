//! Wrong types at every key of every shipped scene.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use trackbed::scene::Document;

/// Parser and source terms that must not appear.
const TERMS: [&str; 14] = [
    "struct ",
    "enum",
    "sequence",
    "map",
    "tuple",
    "array",
    "variant identifier",
    "Option",
    "f64",
    "u32",
    "usize",
    "wanted",
    "a valid value",
    "something else",
];

const VALUES: [&str; 13] = [
    "5",
    "-5",
    "99999999999",
    "1.5",
    "inf",
    "true",
    "\"word\"",
    "[]",
    "[1.0]",
    "[[\"x\"]]",
    "{}",
    "{ x = 1 }",
    "2024-01-01",
];

fn scenes(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            scenes(&path, found);
        } else if path.extension().is_some_and(|e| e == "toml") {
            found.push(path);
        }
    }
}

fn paths(value: &toml::Value, at: &str, found: &mut BTreeSet<String>) {
    let below = |key: &str| if at.is_empty() { key.to_string() } else { format!("{at}.{key}") };
    match value {
        toml::Value::Table(t) => t.iter().for_each(|(k, v)| {
            found.insert(below(k));
            paths(v, &below(k), found);
        }),
        toml::Value::Array(a) => {
            let tables = a.iter().enumerate().filter(|(_, v)| v.is_table());
            tables.for_each(|(i, v)| paths(v, &below(&i.to_string()), found));
        }
        _ => {}
    }
}

#[test]
fn wrong_types_give_plain_messages() {
    let mut files = Vec::new();
    scenes(&Path::new(env!("CARGO_MANIFEST_DIR")).join("inputs"), &mut files);
    let (mut seen, mut refused, mut bad) = (BTreeSet::new(), 0, BTreeSet::new());
    for file in &files {
        let text = std::fs::read_to_string(file).unwrap();
        let Ok(document) = Document::parse(file, text.clone()) else { continue };
        if document.scene().is_err() {
            continue;
        }
        let mut keys = BTreeSet::new();
        paths(&toml::Value::Table(text.parse().unwrap()), "", &mut keys);
        for key in keys {
            // Same key, same type: once.
            let kind: String =
                key.split('.').filter(|k| k.parse::<u32>().is_err()).collect::<Vec<_>>().join(".");
            if !seen.insert(kind) {
                continue;
            }
            for value in VALUES {
                let mut changed = Document::parse(file, text.clone()).unwrap();
                let set = changed.set(&format!("{key}={value}"));
                let Err(error) = set.and_then(|()| changed.scene()) else { continue };
                refused += 1;
                let sentence = format!("{key}={value}: {}", error.problem);
                if TERMS.iter().any(|term| sentence.contains(term)) {
                    bad.insert(sentence);
                }
            }
        }
    }
    println!("{} keys, {refused} values refused", seen.len());
    assert!(seen.len() > 250 && refused > 2000, "{} keys, {refused} refused", seen.len());
    assert!(bad.is_empty(), "{}", bad.into_iter().collect::<Vec<_>>().join("\n"));
}
