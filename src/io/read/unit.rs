//! Units that a file states outside its data.
//!
//! Only statements count: `units: mm`, `UNIT = mm`, a line of columns such as `NODE X [mm] Y [mm] Z [mm]`,
//! and the command /UNITS of ANSYS.

use std::path::Path;

use super::error::ReadError;

/// Lengths other than metres, with metres per unit.
const LENGTHS: [(&str, f64); 23] = [
    ("mm", 1e-3),
    ("millimetre", 1e-3),
    ("millimetres", 1e-3),
    ("millimeter", 1e-3),
    ("millimeters", 1e-3),
    ("cm", 1e-2),
    ("centimetre", 1e-2),
    ("centimetres", 1e-2),
    ("centimeter", 1e-2),
    ("centimeters", 1e-2),
    ("dm", 0.1),
    ("km", 1e3),
    ("um", 1e-6),
    ("µm", 1e-6),
    ("nm", 1e-9),
    ("ft", 0.3048),
    ("feet", 0.3048),
    ("foot", 0.3048),
    ("inch", 0.0254),
    ("inches", 0.0254),
    ("in", 0.0254),
    ("yd", 0.9144),
    ("mil", 2.54e-5),
];

/// Other units than SI that follow a statement.
const OTHERS: [&str; 18] = [
    "ms",
    "us",
    "µs",
    "msec",
    "milliseconds",
    "min",
    "minutes",
    "h",
    "hours",
    "kn",
    "mn",
    "kpa",
    "mpa",
    "gpa",
    "bar",
    "lbf",
    "g",
    "t",
];

const SI: [&str; 19] = [
    "m", "metre", "metres", "meter", "meters", "s", "sec", "second", "seconds", "n", "newton", "kg", "pa",
    "si", "mks", "k", "j", "rad", "deg",
];

const COORDINATES: [&str; 13] = [
    "x",
    "y",
    "z",
    "xc",
    "yc",
    "zc",
    "xcoord",
    "ycoord",
    "zcoord",
    "coord",
    "coords",
    "coordinate",
    "coordinates",
];

fn length(word: &str) -> Option<f64> {
    LENGTHS.iter().find(|(unit, _)| *unit == word).map(|(_, metres)| *metres)
}

pub(super) fn is_length(word: &str) -> bool {
    length(word).is_some()
}

/// Lower-case units that follow `units:` or `unit =` directly.
fn statement(comment: &str) -> Vec<String> {
    let body = comment.trim_start_matches(|c: char| !c.is_alphanumeric()).to_lowercase();
    let heads = ["length units", "length unit", "units of length", "unit of length", "units", "unit"];
    let rest = heads.iter().find_map(|head| body.strip_prefix(head)?.trim_start().strip_prefix([':', '=']));
    let separators = |c: char| c.is_whitespace() || ",;/|()[]-".contains(c);
    let words = rest.unwrap_or_default().split(separators).filter(|word| !word.is_empty());
    let words: Vec<&str> = words.collect();
    let known = |word: &str| is_length(word) || OTHERS.contains(&word) || SI.contains(&word);
    let units = words.iter().take_while(|word| known(word)).count();
    // `units: in the report` is prose.
    let prose = words.first() == Some(&"in") && units == 1 && words.len() > 1;
    let units = if prose { 0 } else { units };
    words[..units].iter().map(|word| word.to_string()).collect()
}

/// First unit other than SI of a statement such as `units: s, kN`, in lower case.
pub fn stated(comment: &str) -> Option<String> {
    statement(comment).into_iter().find(|unit| !SI.contains(&unit.as_str()))
}

/// Unit directly behind the name of a coordinate: `X [mm]`, `y(in)`, `z_mm`.
fn of_coordinate(comment: &str) -> Option<String> {
    let lower = comment.to_lowercase();
    let last_word = |text: &str| {
        let word = text.trim_end().rsplit(|c: char| !c.is_alphanumeric() && c != '_').next();
        word.is_some_and(|word| COORDINATES.contains(&word))
    };
    let bracket = lower.char_indices().filter(|(_, c)| matches!(c, '[' | '(')).find_map(|(at, _)| {
        let (unit, _) = lower[at + 1..].split_once([']', ')'])?;
        (is_length(unit.trim()) && last_word(&lower[..at])).then(|| unit.trim().to_string())
    });
    let joined = |word: &str| {
        let (name, unit) = word.split_once('_')?;
        (is_length(unit) && COORDINATES.contains(&name)).then(|| unit.to_string())
    };
    let words = || lower.split(|c: char| !c.is_alphanumeric() && c != '_');
    bracket.or_else(|| words().find_map(joined))
}

/// Label and length of /UNITS, if other than metres.
fn of_command(body: &str) -> Option<(String, &'static str)> {
    let mut fields = body.split(',').map(|field| field.trim().to_ascii_uppercase());
    if !fields.next()?.starts_with("/UNIT") {
        return None;
    }
    let label = fields.next()?;
    let length = match label.as_str() {
        "CGS" => "cm",
        "MPA" => "mm",
        "UMKS" => "µm",
        "BFT" => "ft",
        "BIN" => "in",
        _ => return None,
    };
    Some((label, length))
}

/// Error of a length unit other than metres in a comment of a mesh, or the command /UNITS.
pub(super) fn refusal(file: &Path, line: usize, text: &str) -> Option<ReadError> {
    refusal_without(file, line, text, "solid.scale")
}

/// As [`refusal`]; its remedy is the key `scale`.
pub(super) fn refusal_without(file: &Path, line: usize, text: &str, key: &str) -> Option<ReadError> {
    let text = text.trim();
    let remedy = |unit: &str| {
        let scale = length(unit).unwrap_or(1.0);
        format!("Set {key} = {scale}, or convert the file")
    };
    if let Some((label, unit)) = of_command(text) {
        let error = ReadError::at(file, line, "/UNITS", format!("{label} ({unit})"), "SI or MKS (m)");
        return Some(error.remedy(remedy(unit)));
    }
    let unit = statement(text).into_iter().find(|unit| is_length(unit)).or_else(|| of_coordinate(text))?;
    let shown: String = text.chars().take(60).collect();
    let error = ReadError::at(file, line, "unit of the comment", format!("{unit} in \"{shown}\""), "metres");
    Some(error.remedy(remedy(&unit)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> Option<String> {
        refusal(Path::new("m.cdb"), 3, text).map(|error| error.to_string())
    }

    #[test]
    fn statements_name_their_unit() {
        for (text, unit) in [
            ("! NODE X [mm] Y [mm] Z [mm]", "mm"),
            ("# x(in) y(in) z(in)", "in"),
            ("! node x_mm y_mm z_mm", "mm"),
            ("# units: mm", "mm"),
            ("** UNITS: MM, N, MPA", "mm"),
            ("** Units: N-mm-s", "mm"),
            ("! unit = cm", "cm"),
            ("# length unit: inches", "inches"),
            ("! coordinates [ft]", "ft"),
            ("! units: in", "in"),
        ] {
            let error = refused(text).unwrap_or_default();
            let start =
                format!("m.cdb:3: unit of the comment: found {unit} in \"{text}\", expected metres. Set ");
            assert!(error.starts_with(&start), "{text}: {error}");
        }
        assert_eq!(
            refused("/UNITS,MPA"),
            Some(
                "m.cdb:3: /UNITS: found MPA (mm), expected SI or MKS (m). Set solid.scale = 0.001, or convert the file."
                    .into()
            )
        );
        assert!(refused("/units, bin").is_some_and(|error| error.contains("found BIN (in)")));
        assert_eq!(stated("units: s, kN"), Some("kn".into()));
    }

    #[test]
    fn prose_and_metres_are_no_statement() {
        for text in [
            "! ballast of 31.5 mm",
            "# mesh of 200 mm elements, exported in mm steps",
            "# thickness (mm) is in the report",
            "! units: m",
            "** UNITS: SI",
            "** UNITS: m, kg, s",
            "! units: in the report",
            "! units as in the drawing: mm",
            "! units: see mm table",
            "! NODE X [m] Y [m] Z [m]",
            "! x y z",
            "** Element size_mm 20",
            "/UNITS,SI",
            "/UNITS,MKS",
            "/units,USER",
            "/PREP7",
            "/COM,units of the model",
            "",
        ] {
            assert_eq!(refused(text), None, "{text}");
        }
        assert_eq!(stated("units: s, N"), None);
        assert_eq!(stated("time in ms"), None);
    }
}
