//! Tables of the matrix in a page of the guide.
//!
//! A mark `<!-- verify: NAME -->` is followed by a generated part: the table of one or several groups, `programs`, or `differences`.

use super::matrix::Matrix;
use super::text;

const MARK: (&str, &str) = ("<!-- verify: ", " -->");

/// Mark without content.
#[derive(Clone, Debug, PartialEq)]
pub struct BadMark {
    /// Line number from 1.
    pub line: usize,
    /// Name of the mark.
    pub name: String,
}

/// Returns the page with the parts below its marks renewed. Rows of tables and lists up to the next empty line are replaced.
///
/// # Errors
/// A mark that is no group.
pub fn fill(matrix: &Matrix, page: &str) -> Result<String, BadMark> {
    let groups = matrix.plan.groups();
    let mut out = String::new();
    let mut lines = page.lines().enumerate().peekable();
    while let Some((k, line)) = lines.next() {
        out += line;
        out.push('\n');
        let Some(name) = line.strip_prefix(MARK.0).and_then(|rest| rest.strip_suffix(MARK.1)) else {
            continue;
        };
        while lines.next_if(|(_, line)| !line.is_empty()).is_some() {}
        out += &match name {
            "programs" => text::programs(matrix),
            "differences" => text::listed(matrix),
            names if names.split(' ').all(|group| groups.contains(&group)) => {
                text::groups(matrix, &names.split(' ').collect::<Vec<_>>())
            }
            other => return Err(BadMark { line: k + 1, name: other.into() }),
        };
    }
    Ok(out)
}
