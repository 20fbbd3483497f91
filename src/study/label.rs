//! Directory names from labels.

use trackbed_run::Hash;

/// Longest name [bytes]; most file systems allow 255 with extension.
const LONGEST: usize = 100;

/// Returns the directory name of a run.
///
/// Plain labels are kept, with `_` between parts; others get a hash.
pub fn folder_name(label: &str) -> String {
    let joined = label.replace(", ", "_");
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-=+".contains(c);
    let safe: String = joined.chars().map(|c| if plain(c) { c } else { '-' }).collect();
    // Not hidden, no parent, distinct on case-insensitive file systems.
    let kept = safe == joined && safe.len() <= LONGEST && !safe.starts_with('.') && !safe.is_empty();
    if kept && !joined.chars().any(|c| c.is_ascii_uppercase()) && !label.contains('_') {
        return safe;
    }
    let mut hash = Hash::default();
    hash.add(label.as_bytes());
    let start: String = safe.trim_start_matches('.').chars().take(LONGEST).collect();
    format!("{start}-{:.8}", hash.hex())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain_and_distinct() {
        assert_eq!(folder_name("step=0.4, count=300"), "step=0.4_count=300");
        assert_eq!(folder_name("base"), "base");
        let labels =
            ["a=b c", "a=b/c", "a=b-c", "a=../c", "a=B", "a=b", "a=b, c", "a=b_c", "..", "", "ü=1", "ä=1"];
        let mut names: Vec<String> = labels.iter().map(|l| folder_name(l).to_lowercase()).collect();
        assert!(names.iter().all(|n| !n.starts_with('.') && !n.contains('/') && n.is_ascii()), "{names:?}");
        names.sort();
        names.dedup();
        assert_eq!(names.len(), labels.len());
        let long = "x".repeat(400);
        assert!(folder_name(&long).len() <= LONGEST + 9);
        assert_ne!(folder_name(&long), folder_name(&long[1..]));
    }
}
