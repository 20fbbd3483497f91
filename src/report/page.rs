//! HTML page, self-contained and well-formed XML.
//!
//! [`Markup`] escapes all text. [`PreEscaped`] is only for program constants and plots, which escape their text.

use super::quantity::{Scale, exact, number, scale, with_unit};
use base64::prelude::{BASE64_STANDARD, Engine};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use std::path::{Path, PathBuf};
use trackbed_io::plot::minus;

/// Section of the page.
#[derive(Clone, Debug)]
pub struct Section {
    /// Anchor.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// Content.
    pub html: Markup,
}

impl Section {
    /// Creates a section; none if empty.
    pub fn new(id: &'static str, title: &'static str, html: Markup) -> Option<Section> {
        (!html.0.trim().is_empty()).then_some(Section { id, title, html })
    }
}

const STYLE: &str = "
:root { color-scheme: light dark; --ink: #111; --paper: #fff; --line: #bbb; --faint: #ddd; --note: #444; --code: #f6f6f6;
  --link: #00558a; --grid: #d8d8d8; --grid2: #efefef; --bad: #fdecea; --care: #fff6e0; }
@media screen and (prefers-color-scheme: dark) { :root { --ink: #e8e8e8; --paper: #16181b; --line: #555; --faint: #33373c;
  --note: #b8bcc2; --code: #22262b; --link: #7cc4f2; --grid: #3c4148; --grid2: #272b30; --bad: #4a1f1a; --care: #43340f; } }
body { font: 15px/1.45 Helvetica, Arial, sans-serif; color: var(--ink); background: var(--paper); margin: 0 auto; max-width: 1180px;
  padding: 0 20px 60px; }
h1 { font-size: 25px; margin: 26px 0 4px; overflow-wrap: anywhere; }
h2 { font-size: 19px; margin: 34px 0 8px; padding-top: 10px; border-top: 1px solid var(--line); }
h3 { font-size: 16px; margin: 18px 0 6px; }
p, li { max-width: 85ch; }
nav { font-size: 14px; margin: 14px 0; }
nav a { margin-right: 14px; white-space: nowrap; }
a { color: var(--link); }
.tables { overflow-x: auto; }
table { border-collapse: collapse; margin: 8px 0 14px; font-size: 14px; }
th, td { padding: 3px 12px 3px 6px; text-align: left; border-bottom: 1px solid var(--faint); vertical-align: top;
  overflow-wrap: anywhere; }
thead th { border-bottom: 1.5px solid var(--note); overflow-wrap: normal; }
tbody th { font-weight: normal; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td small { color: var(--note); }
thead th.n { text-align: right; }
mark { background: var(--care); color: inherit; }
.facts td.n, .facts th.n { text-align: left; }
.plots { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(420px, 100%), 1fr)); gap: 18px 26px; align-items: start; }
figure { margin: 6px 0; max-width: 620px; break-inside: avoid; }
figure > svg, figure > img { width: 100%; height: auto; display: block; }
figure.picture { max-width: 900px; }
svg text { fill: var(--ink); } svg .major { stroke: var(--grid); } svg .minor { stroke: var(--grid2); }
svg .frame { stroke: var(--note); } svg .hollow { fill: var(--paper); }
figcaption { font-weight: bold; font-size: 14px; margin: 0 0 4px 40px; }
ul.legend { list-style: none; margin: 4px 0 0 40px; padding: 0; display: flex; flex-wrap: wrap; gap: 2px 18px;
  font-size: 13px; }
ul.legend li { overflow-wrap: anywhere; }
ul.legend svg { vertical-align: -1px; margin-right: 6px; }
.note { color: var(--note); font-size: 14px; }
.run { border: 1px solid var(--line); border-left-width: 8px; padding: 8px 14px; margin: 10px 0; break-inside: avoid; }
.run h3 { margin: 0 0 4px; overflow-wrap: anywhere; }
.run ul { margin: 6px 0; padding-left: 22px; }
.passed { border-left-color: #009e73; } .warned { border-left-color: #e69f00; background: var(--care); }
.failed { border-left-color: #d5300a; background: var(--bad); } .open { border-left-color: #0072b2; }
.bar { display: inline-block; height: 10px; background: #0072b2; vertical-align: middle; }
pre { font-size: 12.5px; background: var(--code); padding: 10px; overflow-x: auto; white-space: pre-wrap;
  overflow-wrap: anywhere; }
summary { cursor: pointer; }
@page { margin: 16mm 14mm; }
@media print { body { font-size: 10pt; max-width: none; padding: 0; } nav, details { display: none; }
  h2, h3, thead { break-after: avoid; } tr, figure, .run { break-inside: avoid; } thead { display: table-header-group; }
  .tables { overflow: visible; } .plots { grid-template-columns: 1fr 1fr; } a { color: inherit; text-decoration: none; } }
";

/// Void elements, closed as in XML.
const METAS: &str =
    "<meta charset=\"utf-8\"/>\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n";

/// Formats the page.
pub fn page(title: &str, head: &Markup, sections: &[Section]) -> String {
    let page = html! {
        (DOCTYPE) "\n"
        html lang="en" {
            head {
                "\n" (PreEscaped(METAS))
                title { (title) } "\n"
                // CSS needs no escaping of `>`.
                style { (PreEscaped(STYLE)) } "\n"
            }
            "\n"
            body {
                "\n"
                h1 { (title) } "\n"
                (head)
                nav { "\n" @for s in sections { a href={ "#" (s.id) } { (s.title) } "\n" } } "\n"
                @for s in sections {
                    section id=(s.id) { "\n" h2 { (s.title) } "\n" (s.html) } "\n"
                }
            }
        }
        "\n"
    };
    page.0.chars().map(printable).collect()
}

/// Replaces control characters, which XML forbids.
fn printable(c: char) -> char {
    let fits = !c.is_control() && !matches!(c, '\u{fffe}' | '\u{ffff}');
    if fits || matches!(c, '\n' | '\t') { c } else { '\u{fffd}' }
}

/// Path for display: a report may be passed on, so absolute paths are shortened to their last part.
pub fn shown_path(path: &Path) -> PathBuf {
    match path.file_name() {
        Some(name) if path.is_absolute() => PathBuf::from(name),
        _ => path.to_path_buf(),
    }
}

/// Formats a text paragraph.
pub fn paragraph(text: &str) -> Markup {
    html! { p class="note" { (text) } "\n" }
}

/// Formats a picture, such as a `png`, with its caption.
pub fn picture(kind: &str, bytes: &[u8], caption: &str) -> Markup {
    // Base64 needs no escaping; XML closes the element.
    let image =
        format!("<img alt=\"Picture\" src=\"data:image/{kind};base64,{}\"/>", BASE64_STANDARD.encode(bytes));
    html! {
        figure class="picture" {
            figcaption { (caption) } "\n"
            (PreEscaped(image)) "\n"
        }
        "\n"
    }
}

/// Adds a heading to non-empty content.
pub fn headed(heading: &str, content: Markup) -> Markup {
    if content.0.is_empty() {
        content
    } else {
        html! { h3 { (heading) } "\n" (content) }
    }
}

/// Arranges plots side by side.
pub fn plots(figures: impl IntoIterator<Item = Markup>) -> Markup {
    let all = joined(figures);
    if all.0.is_empty() {
        all
    } else {
        html! { div class="plots" { "\n" (all) } "\n" }
    }
}

/// Concatenates parts.
pub fn joined(parts: impl IntoIterator<Item = Markup>) -> Markup {
    html! { @for part in parts { (part) } }
}

/// Table cell.
#[derive(Clone, Debug)]
pub enum Cell {
    /// Empty.
    Nothing,
    /// Text.
    Text(String),
    /// SI value with prefix; exact as tooltip.
    Value(f64, &'static str),
    /// SI value in the column unit.
    Scaled(f64, Scale, &'static str),
    /// SI value with the difference from a reference in per cent.
    Compared(f64, &'static str, f64),
    /// Markup.
    Html(Markup),
}

impl Cell {
    /// Creates a value cell.
    pub fn of(value: Option<f64>, unit: &'static str) -> Cell {
        value.filter(|v| v.is_finite()).map_or(Cell::Nothing, |v| Cell::Value(v, unit))
    }

    /// Creates a text cell.
    pub fn text(text: impl Into<String>) -> Cell {
        Cell::Text(text.into())
    }

    fn html(&self) -> Markup {
        html! {
            @match self {
                Cell::Nothing => td class="n" { "\u{2013}" },
                Cell::Text(text) => td { (text) },
                Cell::Html(content) => td { (content) },
                Cell::Value(v, unit) => td class="n" title=(exact(*v, unit)) { (with_unit(*v, unit)) },
                Cell::Compared(v, unit, percent) => {
                    td class="n" title=(exact(*v, unit)) { (with_unit(*v, unit)) small { " (" (signed(*percent)) ")" } }
                },
                Cell::Scaled(v, scale, unit) => {
                    td class="n" title=(exact(*v, unit)) { (number(v * scale.factor)) }
                },
            }
        }
    }

    fn is_number(&self) -> bool {
        matches!(self, Cell::Value(..) | Cell::Compared(..) | Cell::Scaled(..))
    }
}

/// Formats per cent with sign: three digits, at most one decimal.
fn signed(percent: f64) -> String {
    let decimals = if percent.abs() < 99.95 { 1 } else { 0 };
    minus(&format!("{percent:+.decimals$} %"))
}

/// Formats a left-aligned table of mixed rows.
pub fn facts_table(heads: &[&str], rows: &[(String, Vec<Cell>)]) -> Markup {
    table_of(Some("facts"), heads, rows)
}

/// Formats a table with named rows; nothing without rows.
pub fn table(heads: &[&str], rows: &[(String, Vec<Cell>)]) -> Markup {
    table_of(None, heads, rows)
}

fn table_of(class: Option<&str>, heads: &[&str], rows: &[(String, Vec<Cell>)]) -> Markup {
    if rows.is_empty() {
        return Markup::default();
    }
    let is_number = |k: usize| k > 0 && rows.iter().any(|r| r.1.get(k - 1).is_some_and(Cell::is_number));
    html! {
        div class="tables" {
            table class=[class] {
                "\n"
                thead {
                    tr {
                        @for (k, head) in heads.iter().enumerate() {
                            th scope="col" class=[is_number(k).then_some("n")] { (head) }
                        }
                    }
                }
                "\n"
                tbody {
                    "\n"
                    @for (name, cells) in rows {
                        tr { th scope="row" { (name) } @for cell in cells { (cell.html()) } } "\n"
                    }
                }
            }
        }
        "\n"
    }
}

/// Formats value columns (name, unit, values), each with one prefix.
pub fn columns(first: &str, names: &[String], columns: &[(&str, &'static str, Vec<Option<f64>>)]) -> Markup {
    let scales: Vec<Scale> = columns
        .iter()
        .map(|(_, unit, values)| scale(unit, values.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()))))
        .collect();
    let mut heads = vec![first.to_string()];
    for ((name, _, _), scale) in columns.iter().zip(&scales) {
        heads.push(if scale.unit.is_empty() { name.to_string() } else { format!("{name} [{}]", scale.unit) });
    }
    let cell = |k: usize, row: usize| {
        let (_, unit, values) = &columns[k];
        let value = values.get(row).copied().flatten().filter(|v| v.is_finite());
        value.map_or(Cell::Nothing, |v| Cell::Scaled(v, scales[k].clone(), unit))
    };
    let rows: Vec<(String, Vec<Cell>)> = names
        .iter()
        .enumerate()
        .map(|(row, name)| (name.clone(), (0..columns.len()).map(|k| cell(k, row)).collect()))
        .collect();
    table(&heads.iter().map(String::as_str).collect::<Vec<_>>(), &rows)
}
