//! Text of a stone library.

use std::fmt::Write;

use trackbed_dem::insert::library::Stone;

/// At sieve size 1 m, far below contact overlaps.
const DECIMALS: usize = 9;

/// Reference of the measures of stones from surfaces, for [`text`].
pub const OF_SURFACES: &str =
    "Ratios are to the surface that each stone stands for, lengths to its sieve size.";

/// Returns a library as TOML; `source` is the origin of the shapes, `note` explains the measures.
pub fn text(name: &str, source: &str, note: &str, stones: &[(&Stone, String)]) -> String {
    let mut out = String::new();
    let mut line = |t: &str| writeln!(out, "{t}").expect("writing to a string does not fail");
    line(
        "# Stones as spheres; sieve size 1 m, so scale = sieve size in metres. Frame: centre of mass, principal axes.",
    );
    line(&format!("# {note}"));
    line(&format!("name = {}", quoted(name)));
    line(&format!("source = {}", quoted(source)));
    for (stone, measures) in stones {
        line("\n[[stones]]");
        line(&format!("name = {}", quoted(&stone.name)));
        line(&format!("# {measures}"));
        if let Some(factor) = stone.density_factor {
            line(&format!("density_factor = {factor:.9}"));
        }
        line("spheres = [");
        for [x, y, z, r] in &stone.spheres {
            line(&format!("    [{x:.DECIMALS$}, {y:.DECIMALS$}, {z:.DECIMALS$}, {r:.DECIMALS$}],"));
        }
        line("]");
        if !stone.bonds.is_empty() {
            line("bonds = [");
            for row in stone.bonds.chunks(8) {
                let pairs: Vec<String> = row.iter().map(|[a, b]| format!("[{a}, {b}]")).collect();
                line(&format!("    {},", pairs.join(", ")));
            }
            line("]");
        }
    }
    out
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_string()).to_string()
}
