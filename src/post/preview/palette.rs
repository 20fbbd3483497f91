//! Colours of a preview.

/// Soil and structure, from below.
const GROUND: [&str; 8] = ["c2a878", "9aa7b3", "b58d6e", "a3b18a", "8f8a9e", "d2c29d", "7f9aa8", "b0a296"];
/// As groups of grains in pictures (Okabe and Ito 2008, and lighter variants).
const GROUPS: [&str; 12] = [
    "e69f00", "56b4e9", "009e73", "f0e442", "0072b2", "d55e00", "cc79a7", "999999", "ffd37a", "a8dcf8",
    "7fd6bd", "7fb3dd",
];
/// Directions x, y, z.
pub const AXES: [&str; 3] = ["cc2924", "218f33", "2957cc"];

pub fn ground(k: usize) -> &'static str {
    GROUND[k % GROUND.len()]
}

pub fn group(k: usize) -> &'static str {
    GROUPS[k % GROUPS.len()]
}
