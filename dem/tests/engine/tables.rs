//! Committed tables.

use std::path::Path;

/// Rows of a CSV of this crate, without comments and header; words become NaN.
pub fn read(name: &str) -> Vec<Vec<f64>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let row = |line: &str| line.split(',').map(|v| v.trim().parse().unwrap_or(f64::NAN)).collect();
    text.lines().filter(|l| !l.starts_with('#')).skip(1).map(row).collect()
}
