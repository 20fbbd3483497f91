//! Header lines of lists.
//!
//! | form | example |
//! |---|---|
//! | column heading | `NODE  X [m]  Y [m]  Z [m]` |
//! | ANSYS listing | `LIST ALL SELECTED NODES.   DSYS=      0` |
//! | rule | `----------` |
//! | other script, no digits | `节点 坐标` |
//!
//! Headings must have SI units and the column order of the list.

use super::unit;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Content {
    Nodes,
    Elements,
    Constraints,
    Surface,
}

/// Heading words with their list column, if fixed.
type Words = &'static [(&'static str, u8)];

impl Content {
    pub fn name(self) -> &'static str {
        match self {
            Content::Nodes => "node list",
            Content::Elements => "element list",
            Content::Constraints => "constraint list",
            Content::Surface => "surface",
        }
    }

    pub fn example(self) -> &'static str {
        match self {
            Content::Nodes => "id x y z",
            Content::Elements => "id mat n1…n20",
            Content::Constraints => "node dir value",
            Content::Surface => "x y z",
        }
    }

    fn words(self) -> Words {
        match self {
            Content::Nodes => &[
                ("node", 1),
                ("nodes", 1),
                ("id", 1),
                ("n", 1),
                ("x", 2),
                ("y", 3),
                ("z", 4),
                ("xc", 2),
                ("yc", 3),
                ("zc", 4),
                ("xcoord", 2),
                ("ycoord", 3),
                ("zcoord", 4),
                ("thxy", 5),
                ("thyz", 6),
                ("thzx", 7),
            ],
            Content::Elements => &[
                ("elem", 1),
                ("element", 1),
                ("elements", 1),
                ("id", 1),
                ("mat", 2),
                ("material", 2),
                ("typ", 3),
                ("type", 3),
                ("rel", 4),
                ("real", 4),
                ("esy", 5),
                ("sys", 5),
                ("sec", 6),
                ("section", 6),
                ("node", 7),
                ("nodes", 7),
                ("n", 7),
            ],
            Content::Constraints => &[
                ("node", 1),
                ("nodes", 1),
                ("id", 1),
                ("n", 1),
                ("dir", 2),
                ("direction", 2),
                ("label", 2),
                ("dof", 2),
                ("value", 3),
                ("displacement", 3),
                ("real", 3),
                ("imag", 4),
            ],
            Content::Surface => &[
                ("vertices", 0),
                ("vertex", 0),
                ("triangles", 0),
                ("triangle", 0),
                ("faces", 0),
                ("surface", 0),
                ("x", 1),
                ("y", 2),
                ("z", 3),
            ],
        }
    }
}

const PLAIN: [&str; 28] = [
    "list",
    "table",
    "of",
    "the",
    "all",
    "and",
    "no",
    "nr",
    "num",
    "number",
    "numbers",
    "coord",
    "coords",
    "coordinate",
    "coordinates",
    "global",
    "cartesian",
    "mesh",
    "unit",
    "units",
    "deg",
    "si",
    "m",
    "metre",
    "metres",
    "meter",
    "meters",
    "selected",
];

const CURVILINEAR: [&str; 9] =
    ["r", "theta", "phi", "rho", "radius", "cylindrical", "spherical", "polar", "toroidal"];

/// Key, found and expected for an unknown line; `None` for a known header.
pub(super) fn refusal(body: &str, content: Content) -> Option<(&'static str, String, String)> {
    if body.chars().all(|c| "-=_+.~| ".contains(c)) {
        return None;
    }
    let upper = body.to_ascii_uppercase();
    if let Some((_, system)) = upper.split_once("DSYS") {
        let system = system.trim_start_matches(['=', ' ']).split_whitespace().next().unwrap_or_default();
        if system != "0" {
            let expected = "DSYS = 0: global Cartesian coordinates (DSYS,0 before the listing)";
            return Some(("coordinate system", format!("DSYS = {system}"), expected.into()));
        }
    }
    let listed = ["NODES", "ELEMENTS", "CONSTRAINTS"].iter().any(|what| upper.contains(what));
    if upper.starts_with("LIST ") && listed
        || ["SORT TABLE ON", "CURRENTLY SELECTED"].iter().any(|start| upper.starts_with(start))
    {
        return None;
    }
    if !body.is_ascii() && !body.bytes().any(|b| b.is_ascii_digit()) && !body.contains(',') {
        return None;
    }
    heading(body, content)
}

/// Apart from `in`, which is also a word.
fn is_unit(word: &str) -> bool {
    word != "in" && unit::is_length(word)
}

fn heading(body: &str, content: Content) -> Option<(&'static str, String, String)> {
    let shown: String = body.chars().take(60).collect();
    let lower = body.to_lowercase();
    let words: Vec<&str> =
        lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let mut last = 0;
    for (at, word) in words.iter().enumerate() {
        let plain = word.trim_end_matches(|c: char| c.is_ascii_digit());
        // `coordinates in m`; otherwise `in` means inches.
        let of_unit = words.get(at + 1).is_some_and(|next| is_unit(next) || PLAIN.contains(next));
        if is_unit(word) || *word == "in" && !of_unit {
            let expected =
                "metres; convert the list, or set solid.scale and take the unit out of the heading";
            return Some(("unit of the heading", format!("{word} in \"{shown}\""), expected.into()));
        }
        if CURVILINEAR.contains(&plain) {
            let expected = "global Cartesian coordinates x y z";
            return Some(("coordinate system", format!("\"{shown}\""), expected.into()));
        }
        if let Some(&(_, place)) = content.words().iter().find(|(known, _)| *known == plain) {
            if place < last {
                let expected = format!("columns in the order {}", content.example());
                return Some(("heading", format!("\"{shown}\""), expected));
            }
            last = place;
        } else if !PLAIN.contains(word) && *word != "in" {
            return Some(unknown(body, content));
        }
    }
    None
}

fn unknown(body: &str, content: Content) -> (&'static str, String, String) {
    let shown: String = body.chars().take(60).collect();
    let (first, rest) = body.split_once(',').unwrap_or((body, ""));
    let name = first.trim();
    let is_command =
        !rest.is_empty() && (1..=8).contains(&name.len()) && name.chars().all(|c| c.is_ascii_alphanumeric());
    if is_command {
        let expected = format!("rows of numbers, {}; commands are read from a .cdb file", content.example());
        return ("row", format!("the command \"{shown}\""), expected);
    }
    let expected = format!(
        "a row of numbers, {0}, a column heading such as \"{0}\", or a comment that begins with !",
        content.example()
    );
    (content.name(), format!("\"{shown}\""), expected)
}

/// A column heading ends the page header of a listing.
pub(super) fn is_heading(body: &str, content: Content) -> bool {
    let letters = body.bytes().any(|b| b.is_ascii_alphabetic());
    letters && heading(body, content).is_none()
}

/// Overflowed number: `*****` of Fortran, `#####` of a spreadsheet. `within`: rows of numbers precede, so
/// marks alone are no rule.
pub(super) fn overflow(body: &str, within: bool) -> Option<String> {
    let mut fields = body.split([' ', '\t', ',']).filter(|f| !f.is_empty());
    let first = fields.next()?;
    let mark = first.chars().next().filter(|c| matches!(c, '*' | '#'))?;
    let digits = first.trim_start_matches(mark);
    let marks = first.len() - digits.len();
    if marks < if mark == '*' { 2 } else { 3 } {
        return None;
    }
    let number = |f: &str| f.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
    let direction = |f: &str| ["UX", "UY", "UZ", "ALL"].contains(&f.to_ascii_uppercase().as_str());
    let of_row = |f: &str| number(f) || direction(f) || f.chars().all(|c| c == mark);
    if !(digits.is_empty() || number(digits)) {
        return None;
    }
    let rest: Vec<&str> = fields.collect();
    let alone = rest.is_empty() && digits.is_empty();
    let row = if alone { within } else { rest.iter().all(|f| of_row(f)) };
    row.then(|| first.to_string())
}

#[cfg(test)]
#[path = "header_tests.rs"]
mod tests;
