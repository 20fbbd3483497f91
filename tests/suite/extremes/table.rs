//! Rows of the table: what each holds, how the table is printed, and that its page has the rows of the code.
//!
//! `cargo test --workspace --release --test suite extremes::table -- --ignored --nocapture` runs every row and prints the table.

use super::super::support::repository;
use super::PARTS;
use std::fs;

/// What a row has found.
pub struct Row {
    /// Values that were tried.
    pub tried: String,
    /// What the program did, with the figures.
    pub outcome: String,
    /// Where the right result comes from.
    pub source: &'static str,
}

impl Row {
    /// A row of `tried` values, their `outcome` and the `source` of the right result.
    pub fn new(tried: impl Into<String>, outcome: impl Into<String>, source: &'static str) -> Row {
        Row { tried: tried.into(), outcome: outcome.into(), source }
    }
}

/// A row of the table before it is run.
pub struct Entry {
    /// Module and name of its function; the test is `row::` and that name in the same module.
    pub name: &'static str,
    /// The edge in words.
    pub edge: &'static str,
    /// Runs the program at the edge and asserts what it does.
    pub row: fn() -> Row,
}

/// Rows of a part of the suite: a test for each, which those after `long` leave to `--ignored`, and the list for the table.
macro_rules! rows {
    ($($name:ident: $edge:literal;)* $([long $why:literal] $long:ident: $long_edge:literal;)*) => {
        /// Rows of this file in the order of the table.
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

/// A number with two digits, as tables show it.
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

/// Name of a row as the table shows it: the last two parts of its path.
fn shown(name: &str) -> &str {
    name.rsplit_once("extremes::").map_or(name, |(_, shown)| shown)
}

/// Several numbers as [`figure`] writes them.
pub fn figures(values: &[f64]) -> String {
    values.iter().map(|&x| figure(x)).collect::<Vec<_>>().join(", ")
}

/// A text without what would end a cell of a Markdown table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

/// Runs every row, those of long runs too, and prints the full table; `docs/extremes.md` has its rows with the worst results only.
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

/// The page has the rows of the code, in their order, with the same edges.
#[test]
fn page_has_the_rows_of_the_code() {
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
