//! Abaqus input as keywords with their options and data lines.

use std::path::{Path, PathBuf};

use super::error::ReadError;
use super::mesh_file::{Builder, read_text};

/// Files within files that are followed.
const DEPTH: usize = 10;
/// Files that may be included in all, one as often as it is named.
const FILES: usize = 200;

/// A keyword line and the data lines below it.
pub(super) struct Block {
    pub file: PathBuf,
    pub line: usize,
    /// Upper case, without blanks and star.
    pub keyword: String,
    /// Upper-case names and values as written.
    options: Vec<(String, String)>,
    /// Data lines with their numbers.
    data: Vec<(usize, String)>,
}

impl Block {
    /// The value of an option; empty for one without a value.
    pub fn option(&self, name: &str) -> Option<&str> {
        self.options.iter().find(|(n, _)| n == name).map(|(_, value)| value.as_str())
    }

    /// The value of an option that must be there.
    pub fn required(&self, builder: &Builder, name: &str) -> Result<&str, ReadError> {
        self.option(name).filter(|v| !v.is_empty()).ok_or_else(|| {
            builder.fault(self.line, format!("*{}", self.keyword), format!("no {name}"), format!("{name}=…"))
        })
    }

    /// Number of data lines.
    pub fn len(&self) -> usize {
        self.data.len()
    }

    /// Data line `at`: its number and its fields; a comma at the end leaves an empty last field.
    pub fn row(&self, at: usize) -> Option<(usize, Vec<&str>)> {
        self.data.get(at).map(|(line, text)| (*line, fields(text).collect()))
    }

    /// All data lines.
    pub fn rows(&self) -> impl Iterator<Item = (usize, Vec<&str>)> {
        (0..self.len()).filter_map(|at| self.row(at))
    }
}

/// The fields of a line between commas, trimmed, without the quotes of names; a comma within quotes belongs to its name.
fn fields(text: &str) -> impl Iterator<Item = &str> {
    let mut quoted = false;
    let outside = move |c: char| {
        quoted ^= c == '"';
        c == ',' && !quoted
    };
    text.split(outside).map(|field| unquoted(field.trim()))
}

fn unquoted(text: &str) -> &str {
    text.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).unwrap_or(text)
}

/// The keywords of a file and of those that it includes.
pub(super) fn read_blocks(file: &Path) -> Result<Vec<Block>, ReadError> {
    let mut blocks = Vec::new();
    follow(file, 0, &mut blocks, &mut Vec::new())?;
    Ok(blocks)
}

/// The file and those that it includes, as far as they can be read; what is missing shows when it is read as a mesh.
pub(super) fn files(file: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    // Faults are for the reader to report.
    let _ = follow(file, 0, &mut Vec::new(), &mut files);
    files
}

fn follow(
    file: &Path,
    depth: usize,
    blocks: &mut Vec<Block>,
    files: &mut Vec<PathBuf>,
) -> Result<(), ReadError> {
    files.push(file.to_path_buf());
    let text = read_text(file, "Abaqus input")?;
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with("**"));
    while let Some((number, text)) = lines.next() {
        let (line, text) = (number + 1, text.trim());
        if text.is_empty() {
            continue;
        }
        let Some(keyword) = text.strip_prefix('*') else {
            match blocks.last_mut() {
                // Data behind *INCLUDE goes on with the keyword before it.
                Some(block) => block.data.push((line, text.to_string())),
                None => {
                    let shown: String = text.chars().take(40).collect();
                    let found = format!("\"{shown}\"");
                    return Err(ReadError::at(file, line, "Abaqus input", found, "a keyword such as *NODE"));
                }
            }
            continue;
        };
        // A keyword line that ends with a comma goes on in the next line.
        let mut whole = keyword.to_string();
        while whole.ends_with(',') {
            match lines.next() {
                Some((_, more)) => whole += more.trim(),
                None => break,
            }
        }
        let mut parts = fields(&whole);
        let squeezed = |s: &str| s.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_uppercase();
        let keyword = squeezed(parts.next().unwrap_or_default());
        let options = parts
            .filter(|p| !p.is_empty())
            .map(|part| match part.split_once('=') {
                Some((name, value)) => (squeezed(name), unquoted(value.trim()).to_string()),
                None => (squeezed(part), String::new()),
            })
            .collect();
        let block = Block { file: file.to_path_buf(), line, keyword, options, data: Vec::new() };
        if block.keyword != "INCLUDE" {
            blocks.push(block);
            continue;
        }
        let Some(input) = block.option("INPUT").filter(|i| !i.is_empty()) else {
            return Err(ReadError::at(file, line, "*INCLUDE", "no INPUT", "INPUT=file"));
        };
        if depth == DEPTH {
            return Err(ReadError::at(file, line, "*INCLUDE", "files within files", format!("{DEPTH} deep")));
        }
        if files.len() > FILES {
            let found = format!("{} files included", files.len());
            return Err(ReadError::at(file, line, "*INCLUDE", found, format!("at most {FILES}")));
        }
        follow(&file.parent().unwrap_or(Path::new("")).join(input), depth + 1, blocks, files)?;
    }
    Ok(())
}
