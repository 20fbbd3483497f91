//! Blocks of an ANSYS archive: fixed-width rows below their Fortran format.

use std::path::{Path, PathBuf};

use super::cdb::{Archive, Component};
use super::cdb_elements::RawElement;
use super::error::ReadError;
use super::mesh_file::Builder;
use super::{number, unit};

pub(super) struct Lines<'a> {
    file: PathBuf,
    lines: std::iter::Peekable<std::iter::Enumerate<std::str::Lines<'a>>>,
    /// Unit other than metres in a comment or /UNITS.
    pub unit: Option<Box<ReadError>>,
}

impl<'a> Lines<'a> {
    pub fn new(file: &Path, text: &'a str) -> Lines<'a> {
        Lines { file: file.to_path_buf(), lines: text.lines().enumerate().peekable(), unit: None }
    }

    /// Next command without comments.
    pub fn next(&mut self) -> Option<(usize, &'a str)> {
        for (number, line) in self.lines.by_ref() {
            let body = line.split('!').next().unwrap_or_default().trim();
            if !body.is_empty() && !body.starts_with('/') {
                return Some((number + 1, body));
            }
            if self.unit.is_none() {
                let text = line.trim_start();
                let text = text.strip_prefix("/COM,").or_else(|| text.strip_prefix("/com,")).unwrap_or(text);
                self.unit = unit::refusal(&self.file, number + 1, text).map(Box::new);
            }
        }
        None
    }

    /// Next raw row; the end of the file is an error.
    fn row(&mut self, block: &str) -> Result<(usize, &'a str), ReadError> {
        match self.lines.next() {
            Some((number, line)) => Ok((number + 1, line)),
            None => Err(ReadError::whole(&self.file, block, "the end of the file", "the end of the block")),
        }
    }

    fn numeric(&mut self) -> bool {
        let number =
            |line: &str| line.trim_start().trim_start_matches('-').starts_with(|c: char| c.is_ascii_digit());
        self.lines.peek().is_some_and(|(_, line)| number(line))
    }

    fn fault(&self, line: usize, key: &str, found: impl Into<String>, expected: &str) -> ReadError {
        ReadError::at(&self.file, line, key, found, expected)
    }
}

/// Row format: integers, then reals, as in `(3i9,6e21.13e3)` or `(1i7,2i9,6e21.13)`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Format {
    pub whole: Vec<usize>,
    pub real: usize,
    pub real_width: usize,
}

impl Format {
    pub fn parse(text: &str) -> Option<Format> {
        let inner = text.trim().strip_prefix('(')?.split(')').next()?.to_ascii_lowercase();
        let mut parts = inner.split(',').map(str::trim);
        let item = |part: &str, letters: &[char]| -> Option<(usize, usize)> {
            let (count, rest) = part.split_once(letters)?;
            let width = rest.split(['.', 'e']).next()?;
            let (count, width) =
                (if count.is_empty() { 1 } else { count.parse().ok()? }, width.parse().ok()?);
            ((1..=100).contains(&count) && (1..=100).contains(&width)).then_some((count, width))
        };
        let mut whole = Vec::new();
        let mut part = parts.next();
        while let Some((count, width)) = part.and_then(|part| item(part, &['i'])) {
            whole.extend(std::iter::repeat_n(width, count));
            part = parts.next();
        }
        let reals = part.and_then(|part| item(part, &['e', 'f', 'g', 'a']));
        let (real, real_width) = reals.unwrap_or((0, 1));
        (!whole.is_empty()).then_some(Format { whole, real, real_width })
    }

    fn place(&self, at: usize) -> usize {
        self.whole[..at].iter().sum()
    }

    /// `None` if blank or beyond the end.
    fn whole<'a>(&self, row: &'a str, at: usize) -> Option<&'a str> {
        field(row, self.place(at), *self.whole.get(at)?)
    }

    fn real<'a>(&self, row: &'a str, at: usize) -> Option<&'a str> {
        field(row, self.place(self.whole.len()) + at * self.real_width, self.real_width)
    }
}

fn field(row: &str, start: usize, width: usize) -> Option<&str> {
    let row = row.trim_end();
    let end = (start + width).min(row.len());
    row.get(start..end).map(str::trim).filter(|text| !text.is_empty())
}

fn format(lines: &mut Lines, block: &str) -> Result<Format, ReadError> {
    let (line, text) = lines.row(block)?;
    Format::parse(text).ok_or_else(|| {
        lines.fault(line, block, format!("\"{}\"", text.trim()), "a format such as (3i9,6e21.13e3)")
    })
}

fn whole_row(
    lines: &Lines,
    format: &Format,
    line: usize,
    row: &str,
    key: &str,
) -> Result<Vec<u32>, ReadError> {
    let end = row.trim_end().len();
    (0..format.whole.len())
        .take_while(|at| format.place(*at) < end)
        .map(|at| whole(lines, line, format.whole(row, at).unwrap_or("0"), key))
        .collect()
}

fn whole(lines: &Lines, line: usize, text: &str, key: &str) -> Result<u32, ReadError> {
    number::whole(text)
        .ok_or_else(|| lines.fault(line, key, format!("\"{text}\""), "a whole number of 0 or more"))
}

fn ends(row: &str) -> bool {
    let row = row.trim();
    row.split([',', ' ']).next() == Some("-1")
        || (row.starts_with(['N', 'n', 'E', 'e']) && row.split(',').any(|f| f.trim() == "-1"))
}

/// `NBLOCK`: id, two entries of the solid model, coordinates, angles; or id and coordinates.
pub(super) fn nodes(
    lines: &mut Lines,
    _line: usize,
    _fields: &[&str],
    builder: &mut Builder,
    archive: &mut Archive,
) -> Result<(), ReadError> {
    let format = format(lines, "NBLOCK")?;
    if format.real < 3 {
        return Err(builder.fault(0, "NBLOCK", format!("{} reals in its format", format.real), "3 or more"));
    }
    loop {
        let (line, row) = lines.row("NBLOCK")?;
        if ends(row) {
            return Ok(());
        }
        let id = whole(lines, line, format.whole(row, 0).unwrap_or(""), "node number")?;
        let mut values = [0.0; 6];
        for (at, value) in values.iter_mut().enumerate().take(format.real) {
            // Trailing zeros are omitted.
            let Some(text) = format.real(row, at) else { continue };
            let key = format!("coordinates of node {id}");
            *value = number::real(text)
                .ok_or_else(|| lines.fault(line, &key, format!("\"{text}\""), "a number"))?;
        }
        builder.node(line, id, [values[0], values[1], values[2]])?;
        if values[3..].iter().any(|angle| *angle != 0.0) {
            archive.turned.insert(id, line);
        }
    }
}

/// `EBLOCK`: eleven entries (SOLID) or five, then the nodes.
pub(super) fn elements(
    lines: &mut Lines,
    line: usize,
    fields: &[&str],
    archive: &mut Archive,
) -> Result<(), ReadError> {
    let solid = fields.get(2).is_some_and(|f| f.eq_ignore_ascii_case("SOLID"));
    let format = format(lines, "EBLOCK")?;
    let entries = if solid { 11 } else { 5 };
    if format.whole.len() <= entries {
        let found = format!("{} numbers a row", format.whole.len());
        return Err(lines.fault(line, "EBLOCK", found, "more than its entries before the nodes"));
    }
    loop {
        let (line, row) = lines.row("EBLOCK")?;
        if ends(row) {
            return Ok(());
        }
        let first = whole_row(lines, &format, line, row, "element")?;
        if first.len() <= entries {
            let found = format!("{} numbers", first.len());
            return Err(lines.fault(line, "element", found, "entries and nodes"));
        }
        let mut element = if solid {
            RawElement { line, material: first[0], kind: first[1], id: first[10], nodes: Vec::new() }
        } else {
            RawElement { line, material: first[3], kind: first[1], id: first[0], nodes: Vec::new() }
        };
        element.nodes.extend(&first[entries..]);
        if solid {
            let count = first[8] as usize;
            if count > 20 {
                let found = format!("{count} nodes");
                return Err(lines.fault(line, &format!("element {}", element.id), found, "20 or fewer"));
            }
            while element.nodes.len() < count {
                let (line, row) = lines.row("EBLOCK")?;
                if ends(row) {
                    let (key, found) = (format!("element {}", element.id), "the end of the block");
                    return Err(lines.fault(line, &key, found, &format!("{count} nodes")));
                }
                element.nodes.extend(whole_row(lines, &format, line, row, "node of an element")?);
            }
            element.nodes.truncate(count.max(1));
        } else if first.len() == 15 && archive.takes_two_rows(element.kind) {
            let (line, row) = lines.row("EBLOCK")?;
            element.nodes.extend(whole_row(lines, &format, line, row, "node of an element")?);
        }
        archive.elements.push(element);
    }
}

impl Archive {
    /// Whether a compact element needs a second row. Archives define types first.
    fn takes_two_rows(&self, kind: u32) -> bool {
        self.types.get(&kind).is_some_and(|t| super::cdb_elements::node_count(*t) > 10)
    }
}

pub(super) fn types(lines: &mut Lines, _line: usize, archive: &mut Archive) -> Result<(), ReadError> {
    let format = format(lines, "ETBLOCK")?;
    loop {
        let (line, row) = lines.row("ETBLOCK")?;
        if ends(row) {
            return Ok(());
        }
        let number = whole(lines, line, format.whole(row, 0).unwrap_or(""), "element type number")?;
        let kind = whole(lines, line, format.whole(row, 1).unwrap_or(""), "element type")?;
        archive.types.insert(number, kind);
    }
}

/// Components of the solid model are skipped.
const GEOMETRY: [&str; 8] = ["KP", "KPS", "LINE", "LINES", "AREA", "AREAS", "VOLU", "VOLUS"];

/// `CMBLOCK, name, NODE or ELEM, count`: a negative number ends the range begun by its predecessor.
pub(super) fn component(
    lines: &mut Lines,
    line: usize,
    fields: &[&str],
) -> Result<Option<Component>, ReadError> {
    let (Some(name), Some(kind), Some(count)) = (fields.get(1), fields.get(2), fields.get(3)) else {
        return Err(lines.fault(line, "CMBLOCK", fields.join(","), "CMBLOCK, name, NODE or ELEM, count"));
    };
    let upper = kind.to_ascii_uppercase();
    let of_nodes = match upper.as_str() {
        "NODE" | "NODES" => true,
        "ELEM" | "ELEMENT" | "ELEMENTS" => false,
        _ if GEOMETRY.contains(&upper.as_str()) => false,
        _ => return Err(lines.fault(line, "CMBLOCK", format!("\"{kind}\""), "NODE or ELEM")),
    };
    let count = whole(lines, line, count, "count of a component")? as usize;
    let format = format(lines, "CMBLOCK")?;
    let mut ranges: Vec<(u32, u32)> = Vec::new();
    let mut read = 0;
    while read < count {
        if !lines.numeric() {
            let found = format!("{read} numbers");
            return Err(lines.fault(line, &format!("component {name}"), found, &format!("{count} numbers")));
        }
        let (line, row) = lines.row("CMBLOCK")?;
        for at in 0..format.whole.len().min(count - read) {
            let Some(text) = format.whole(row, at) else { break };
            let key = format!("component {name}");
            match text.strip_prefix('-') {
                None => {
                    let id = whole(lines, line, text, &key)?;
                    ranges.push((id, id));
                }
                Some(end) => {
                    let end = whole(lines, line, end, &key)?;
                    match ranges.last_mut() {
                        Some(range) if range.0 == range.1 && end >= range.0 => range.1 = end,
                        _ => return Err(lines.fault(line, &key, text, "a range after its first number")),
                    }
                }
            }
            read += 1;
        }
        if format.whole(row, 0).is_none() {
            return Err(lines.fault(line, &format!("component {name}"), "an empty row", "numbers"));
        }
    }
    let of_mesh = !GEOMETRY.contains(&upper.as_str());
    Ok(of_mesh.then(|| Component { name: name.to_string(), of_nodes, ranges }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats() {
        let parsed = |text| Format::parse(text).map(|f| (f.whole, f.real, f.real_width));
        assert_eq!(parsed("(3i9,6e21.13e3)"), Some((vec![9; 3], 6, 21)));
        assert_eq!(parsed(" (3I8,6E20.13) "), Some((vec![8; 3], 6, 20)));
        assert_eq!(parsed("(1i9,3e20.9e3)"), Some((vec![9], 3, 20)));
        assert_eq!(parsed("(1i7,2i9,6e21.13)"), Some((vec![7, 9, 9], 6, 21)));
        assert_eq!(parsed("(i8,i9,i10,3e20.9)"), Some((vec![8, 9, 10], 3, 20)));
        assert_eq!(parsed("(19i10)"), Some((vec![10; 19], 0, 1)));
        for text in ["", "(", "()", "(3x9)", "(0i9)", "(3i0)", "(999999i9)", "3i9"] {
            assert_eq!(parsed(text), None, "{text}");
        }
    }

    #[test]
    fn ends_of_blocks() {
        assert!(
            ends("       -1") && ends("N,R5.3,LOC,       -1,") && ends("-1") && ends("EN,R5.5,ATTR, -1,")
        );
        assert!(!ends("        1        0") && !ends("      -11"));
    }
}
