//! Markdown tables of scene keys, from the schema.
//!
//! A page has marks such as `<!-- keys: solid.block -->` (`scene` for the top level). Tables without mark are
//! part of their parent.

mod description;
mod tables;

use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write;
use tables::{Key, Tables};

const MARK: (&str, &str) = ("<!-- keys: ", " -->");
const TOP: &str = "scene";

/// Mark of an unknown table.
#[derive(Clone, Debug, PartialEq)]
pub struct BadMark {
    /// Line number from 1.
    pub line: usize,
    /// Keys of the mark.
    pub keys: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Heading,
    Row,
    /// Other lines, and code blocks.
    Text,
}

#[derive(Clone, Debug)]
struct Section {
    heading: usize,
    /// Anchor of the heading.
    anchor: String,
}

/// Returns the page with the tables of `schema` replaced below its marks.
///
/// # Errors
/// A mark of an unknown table.
pub fn fill(schema: &Value, page: &str) -> Result<String, BadMark> {
    let sections = sections(schema, page)?;
    let mut tables = Tables::new(schema, sections.keys().map(ToString::to_string).collect());
    let (mut out, mut heading, mut filled) = (String::new(), 0, usize::MAX);
    let mut lines = lines(page).peekable();
    while let Some((_, line, kind)) = lines.next() {
        out.push_str(line);
        out.push('\n');
        heading += usize::from(kind == Kind::Heading);
        let Some(path) = marked(line) else { continue };
        while lines.next_if(|(_, _, kind)| *kind == Kind::Row).is_some() {}
        // Further tables of a section belong to keys of the first.
        let first = std::mem::replace(&mut filled, heading) != heading;
        let of = path.rsplit('.').next().filter(|_| !first);
        let keys = tables::find(schema, path).map(|name| tables.keys(name)).unwrap_or_default();
        table(&mut out, of, &keys, &|name| {
            let section = sections.get(name)?;
            (section.heading != heading).then(|| section.anchor.clone())
        });
    }
    Ok(out)
}

/// Returns a page with all tables of `schema`.
pub fn frame(schema: &Value) -> String {
    let mut page = String::from("# Keys of a scene\n");
    for path in tables::paths(schema) {
        let name = if path.is_empty() { TOP } else { &path };
        let _ = write!(page, "\n## {name}\n\n{}{name}{}\n", MARK.0, MARK.1);
    }
    page
}

fn sections<'a>(schema: &'a Value, page: &str) -> Result<BTreeMap<&'a str, Section>, BadMark> {
    let mut sections = BTreeMap::new();
    let mut section = Section { heading: 0, anchor: String::new() };
    for (number, line, kind) in lines(page) {
        if kind == Kind::Heading {
            section = Section { heading: section.heading + 1, anchor: anchor(line) };
        }
        let Some(path) = marked(line) else { continue };
        let name = tables::find(schema, path).ok_or(BadMark { line: number, keys: path.into() })?;
        sections.insert(name, section.clone());
    }
    Ok(sections)
}

fn marked(line: &str) -> Option<&str> {
    let path = line.strip_prefix(MARK.0)?.strip_suffix(MARK.1)?;
    Some(if path == TOP { "" } else { path })
}

fn lines(page: &str) -> impl Iterator<Item = (usize, &str, Kind)> {
    let mut code = false;
    page.lines().enumerate().map(move |(index, line)| {
        code ^= line.starts_with("```");
        let kind = match line.trim_start_matches('#') {
            _ if code => Kind::Text,
            text if text.len() < line.len() && text.starts_with(' ') => Kind::Heading,
            text if text.starts_with('|') => Kind::Row,
            _ => Kind::Text,
        };
        (index + 1, line, kind)
    })
}

/// Anchor of a heading, as on GitHub.
fn anchor(heading: &str) -> String {
    let text = heading.trim_start_matches('#').trim().to_lowercase();
    let kept = text.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

fn table(out: &mut String, of: Option<&str>, keys: &[Key], link: &dyn Fn(&str) -> Option<String>) {
    let head = of.map_or("key".to_string(), |of| format!("key of `{of}`"));
    let rows: Vec<[String; 5]> = keys.iter().map(|key| cells(key, link)).collect();
    let heads = [head.as_str(), "unit", "default", "range", "meaning"];
    let shown: Vec<usize> = (0..5).filter(|c| rows.iter().any(|row| !row[*c].is_empty())).collect();
    let mut line = |cells: &dyn Fn(usize) -> String| {
        out.push('|');
        for c in &shown {
            let cell = cells(*c);
            out.push_str(&if cell.is_empty() { " |".into() } else { format!(" {cell} |") });
        }
        out.push('\n');
    };
    line(&|c| heads[c].to_string());
    line(&|_| "---".to_string());
    for row in &rows {
        line(&|c| row[c].replace('|', "\\|"));
    }
}

fn cells(key: &Key, link: &dyn Fn(&str) -> Option<String>) -> [String; 5] {
    let mut name = format!("`{}`", key.name);
    if let Some(anchor) = key.table.as_deref().and_then(link) {
        name = format!("[{name}](#{anchor})");
    }
    if key.required {
        name = format!("**{name}**");
    }
    let described = &key.description;
    let mut meaning = described.meaning.clone();
    if !key.words.is_empty() {
        meaning.push_str(if meaning.is_empty() { "" } else { ": " });
        meaning.push_str(&words(&key.words));
    }
    for condition in &described.conditions {
        meaning.push_str("; ");
        meaning.push_str(condition);
    }
    [name, described.unit.clone(), described.default.clone(), described.range.clone(), meaning]
}

fn words(words: &[(String, String)]) -> String {
    let plain = words.iter().all(|(_, meaning)| meaning.is_empty());
    let one = |(word, meaning): &(String, String)| match meaning.as_str() {
        "" => format!("`\"{word}\"`"),
        meaning => format!("`\"{word}\"` {meaning}"),
    };
    words.iter().map(one).collect::<Vec<_>>().join(if plain { ", " } else { "; " })
}
