//! What a folder of results holds before a run: nothing that is worth keeping is replaced without `--force`.

use super::checkpoint::{Origin, Slots};
use super::folder;
use super::lock::Lock;
use crate::failure::Failure;
use crate::message::shown;
use crate::read::source;
use std::path::Path;

/// Longest title of another scene in a message [characters].
const LONGEST: usize = 80;

/// Refuses to begin a run anew in a folder with the checkpoint of an interrupted run, with the finished results of another
/// scene or of this one with other overrides or files, or with files of others under the names of results.
///
/// # Errors
/// Bad input.
pub fn check(dir: &Path, origin: &Origin, slots: &Slots, lock: &Lock) -> Result<(), Failure> {
    let refuse = |found: &str, expected: &str| {
        Err(Failure::Input(format!("{}: found {found}, expected {expected}", dir.display())))
    };
    if slots.any() {
        let expected = "--resume to go on with it, --force to begin anew, or another --out";
        return refuse("the checkpoint of an interrupted run", expected);
    }
    let bytes = source::bytes(&dir.join("summary.json"), source::LARGEST_TEXT).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_slice(&bytes).unwrap_or_default();
    if let Some(hash) = summary["scene_hash"].as_str() {
        if summary["status"] == "done" && hash != origin.scene_hash {
            let title = summary["title"].as_str().unwrap_or_default();
            let found = format!("the results of another scene (\"{}\")", shown(title, LONGEST));
            return refuse(&found, "another --out, or --force to replace them");
        }
        return Ok(());
    }
    // A run that was killed before its first summary.
    if lock.left_behind {
        return Ok(());
    }
    match folder::first_result(dir) {
        None => Ok(()),
        Some(file) => {
            let name = file.strip_prefix(dir).unwrap_or(&file).display().to_string();
            let expected = "another --out, or --force to replace files of its names";
            refuse(&format!("{name}, which no run has left there"), expected)
        }
    }
}
