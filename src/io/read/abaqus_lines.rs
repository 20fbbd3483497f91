//! Splits Abaqus input into keywords with options and data lines.

use std::path::{Path, PathBuf};

use super::error::ReadError;
use super::mesh_file::{Builder, read_text};
use super::unit;

/// Nesting depth of *INCLUDE.
const DEPTH: usize = 10;
/// Included files, repeats counted.
const FILES: usize = 200;

pub(super) struct Block {
    pub file: PathBuf,
    pub line: usize,
    /// Upper case, without blanks and star.
    pub keyword: String,
    /// Upper-case names with their values.
    options: Vec<(String, String)>,
    data: Vec<(usize, String)>,
}

impl Block {
    pub fn option(&self, name: &str) -> Option<&str> {
        self.options.iter().find(|(n, _)| n == name).map(|(_, value)| value.as_str())
    }

    pub fn required(&self, builder: &Builder, name: &str) -> Result<&str, ReadError> {
        self.option(name).filter(|v| !v.is_empty()).ok_or_else(|| {
            builder.fault(self.line, format!("*{}", self.keyword), format!("no {name}"), format!("{name}=…"))
        })
    }

    pub fn len(&self) -> usize {
        self.data.len()
    }

    /// Line number and fields of data line `at`.
    pub fn row(&self, at: usize) -> Option<(usize, Vec<&str>)> {
        self.data.get(at).map(|(line, text)| (*line, fields(text).collect()))
    }

    pub fn rows(&self) -> impl Iterator<Item = (usize, Vec<&str>)> {
        (0..self.len()).filter_map(|at| self.row(at))
    }
}

/// Trimmed fields without quotes; a comma within quotes belongs to the name.
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

/// Blocks, and a stated length unit other than metres.
pub(super) fn read_blocks(file: &Path) -> Result<(Vec<Block>, Option<Box<ReadError>>), ReadError> {
    let (mut blocks, mut unit) = (Vec::new(), None);
    follow(file, 0, &mut blocks, &mut Vec::new(), &mut unit)?;
    let headings = blocks.iter().filter(|block: &&Block| block.keyword == "HEADING");
    let stated = headings.flat_map(|block| block.data.iter().map(|(line, text)| (&block.file, *line, text)));
    let of_heading =
        stated.filter_map(|(file, line, text)| unit::refusal(file, line, text)).map(Box::new).next();
    Ok((blocks, unit.or(of_heading)))
}

fn unit_of_comments(file: &Path, text: &str) -> Option<Box<ReadError>> {
    let nodes = |line: &str| line.get(..5).is_some_and(|start| start.eq_ignore_ascii_case("*node"));
    let above = (1..).zip(text.lines()).take_while(|(_, line)| !nodes(line));
    let mut comments = above.filter(|(_, line)| line.starts_with("**"));
    comments.find_map(|(line, text)| unit::refusal(file, line, text)).map(Box::new)
}

/// Readable files among `file` and its includes.
pub(super) fn files(file: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let _ = follow(file, 0, &mut Vec::new(), &mut files, &mut None);
    files
}

fn follow(
    file: &Path,
    depth: usize,
    blocks: &mut Vec<Block>,
    files: &mut Vec<PathBuf>,
    unit: &mut Option<Box<ReadError>>,
) -> Result<(), ReadError> {
    files.push(file.to_path_buf());
    let text = read_text(file, "Abaqus input")?;
    if unit.is_none() {
        *unit = unit_of_comments(file, &text);
    }
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with("**"));
    while let Some((number, text)) = lines.next() {
        let (line, text) = (number + 1, text.trim());
        if text.is_empty() {
            continue;
        }
        let Some(keyword) = text.strip_prefix('*') else {
            match blocks.last_mut() {
                // Data after *INCLUDE belong to the preceding keyword.
                Some(block) => block.data.push((line, text.to_string())),
                None => {
                    let shown: String = text.chars().take(40).collect();
                    let found = format!("\"{shown}\"");
                    return Err(ReadError::at(file, line, "Abaqus input", found, "a keyword such as *NODE"));
                }
            }
            continue;
        };
        // A trailing comma continues the keyword line.
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
        follow(&file.parent().unwrap_or(Path::new("")).join(input), depth + 1, blocks, files, unit)?;
    }
    Ok(())
}
