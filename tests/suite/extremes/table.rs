//! `cargo test --workspace --release --test suite extremes::table -- --ignored --nocapture` runs and prints
//! every row.

use super::super::support::repository;
use super::PARTS;
use std::fs;

/// Result of a row.
pub struct Row {
    /// Tried values.
    pub tried: String,
    /// Observed outcome with numbers.
    pub outcome: String,
    /// Source of the reference result.
    pub source: &'static str,
}

impl Row {
    /// Creates a row.
    pub fn new(tried: impl Into<String>, outcome: impl Into<String>, source: &'static str) -> Row {
        Row { tried: tried.into(), outcome: outcome.into(), source }
    }
}

/// Row of the table.
pub struct Entry {
    /// Module and function; its test is `row::` and that name.
    pub name: &'static str,
    /// Description of the extreme.
    pub edge: &'static str,
    /// Runs and asserts the row.
    pub row: fn() -> Row,
}

/// Declares rows with one test each; those after `long` are `--ignored`.
macro_rules! rows {
    ($($name:ident: $edge:literal;)* $([long $why:literal] $long:ident: $long_edge:literal;)*) => {
        /// Rows of this file in table order.
        pub const ROWS: &[$crate::suite::extremes::table::Entry] = &[
            $($crate::suite::extremes::table::Entry { name: concat!(module_path!(), "::", stringify!($name)), edge: $edge, row: $name },)*
            $($crate::suite::extremes::table::Entry { name: concat!(module_path!(), "::", stringify!($long)), edge: $long_edge, row: $long },)*
        ];

        mod row {
            $(#[test] fn $name() { println!("{}", super::$name().outcome); })*
            $(#[test] #[ignore = $why] fn $long() { println!("{}", super::$long().outcome); })*
        }
    };
}
pub(super) use rows;

/// Number with two digits.
pub fn figure(x: f64) -> String {
    let size = x.abs();
    if size == 0.0 {
        "0".into()
    } else if (1e-2..1e4).contains(&size) {
        let digits = (1.0 - size.log10().floor()).max(0.0) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.1e}")
    }
}

fn shown(name: &str) -> &str {
    name.rsplit_once("extremes::").map_or(name, |(_, shown)| shown)
}

/// Numbers formatted by [`figure`].
pub fn figures(values: &[f64]) -> String {
    values.iter().map(|&x| figure(x)).collect::<Vec<_>>().join(", ")
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

/// Runs every row, long ones included; `docs/extremes.md` shows the worst results only.
#[test]
#[ignore = "runs every row again, the long ones too: some minutes"]
fn printed() {
    for (title, part) in PARTS {
        println!("\n## {title}\n\n| row | edge | tried | the program | right by |\n|---|---|---|---|---|");
        for Entry { name, edge, row } in part.iter().copied().flatten() {
            let Row { tried, outcome, source } = row();
            println!(
                "| `{}` | {edge} | {} | {} | {} |",
                shown(name),
                cell(&tried),
                cell(&outcome),
                cell(source)
            );
        }
    }
}

#[test]
fn page_matches_rows() {
    let page = fs::read_to_string(repository().join("docs/extremes.md")).expect("the page is there");
    let titles = PARTS.map(|(title, _)| format!("## {title}"));
    let found: Vec<String> = page
        .lines()
        .filter(|line| line.starts_with("| `") || titles.iter().any(|title| title == line))
        .map(|line| line.split(" | ").take(2).collect::<Vec<_>>().join(" | "))
        .collect();
    let mut expected = Vec::new();
    for ((_, part), title) in PARTS.iter().zip(&titles) {
        expected.push(title.clone());
        let rows = part.iter().copied().flatten();
        expected.extend(rows.map(|entry| format!("| `{}` | {}", shown(entry.name), entry.edge)));
    }
    assert_eq!(found, expected, "docs/extremes.md does not have the rows of the code: print the table again");
}
