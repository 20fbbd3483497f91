//! Pictures of the last frames.

use crate::data::{RunData, State};
use crate::page::{self, Section, joined, paragraph, plots};
use maud::Markup;
use trackbed_post::render;

/// Most pictures of a page.
const MOST: usize = 4;

/// Columns and rows of a single picture, and of one of several.
const SIZES: [[usize; 2]; 2] = [[1120, 630], [640, 400]];

/// Formats a picture of each run; runs without readable frames have none.
pub fn picture(runs: &[RunData]) -> Option<Section> {
    let alone = runs.len() == 1;
    let size = SIZES[usize::from(!alone)];
    // Mode shapes have no scale.
    let drawn = runs.iter().filter(|run| run.state() != State::Modes).take(MOST).filter_map(|run| {
        let (bytes, remark) = match render::last_frame(&run.dir, size) {
            Ok(drawn) => drawn?,
            // Without frames there is none.
            Err(_) if !run.dir.join("frames").is_dir() => return None,
            Err(_) => return Some(paragraph(&format!("{}: the last frame cannot be read.", run.label))),
        };
        Some(page::picture("jpeg", &bytes, &if alone { remark } else { format!("{}: {remark}", run.label) }))
    });
    let figures: Vec<Markup> = drawn.collect();
    let html = if alone { joined(figures) } else { plots(figures) };
    Section::new("picture", "Last frame", html)
}
