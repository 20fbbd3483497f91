//! File names from labels.

use std::collections::BTreeMap;
use trackbed_run::Hash;

/// Longest name [bytes]; most file systems allow 255 with extension.
const LONGEST: usize = 100;

/// Returns distinct file names.
pub fn file_names<'a>(labels: impl Iterator<Item = &'a str>) -> Vec<String> {
    let labels: Vec<&str> = labels.collect();
    let plain: Vec<String> = labels.iter().map(|label| file_name(label)).collect();
    // Case-insensitive file systems.
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    plain.iter().for_each(|name| *counts.entry(name.to_lowercase()).or_default() += 1);
    let distinct = |(name, label): (&String, &&str)| {
        if counts[&name.to_lowercase()] == 1 && name.len() < LONGEST && !name.is_empty() {
            return name.clone();
        }
        let mut hash = Hash::default();
        hash.add(label.as_bytes());
        format!("{name}-{:.8}", hash.hex())
    };
    plain.iter().zip(&labels).map(distinct).collect()
}

fn file_name(label: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "._-=+".contains(c) { c } else { '-' };
    let name: String = label.replace(", ", "_").chars().map(plain).collect();
    // Not hidden, no parent.
    name.trim_start_matches('.').chars().take(LONGEST).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(labels: &[&str]) -> Vec<String> {
        file_names(labels.iter().copied())
    }

    #[test]
    fn names_are_plain_and_distinct() {
        let plain = ["step=0.4_count=300", "base", "pressure=60-kPa_seed=1", "law=A_B"];
        assert_eq!(names(&["step=0.4, count=300", "base", "pressure=60 kPa, seed=1", "law=A_B"]), plain);
        let labels =
            ["a=b c", "a=b/c", "a=b-c", "a=../c", "a=B", "a=b", "a=b, c", "a=b_c", "..", "", "ü=1", "ä=1"];
        let mut all: Vec<String> = names(&labels).iter().map(|name| name.to_lowercase()).collect();
        assert!(all.iter().all(|n| !n.starts_with('.') && !n.contains('/') && n.is_ascii()), "{all:?}");
        all.sort();
        all.dedup();
        assert_eq!(all.len(), labels.len());
        let long = "x".repeat(400);
        let cut = names(&[&long, &long[1..]]);
        assert!(cut[0].len() <= LONGEST + 9 && cut[0] != cut[1]);
    }
}
