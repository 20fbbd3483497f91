//! Protection of existing results without `--force`.

use super::checkpoint::{Origin, Slots};
use super::folder;
use super::lock::Lock;
use super::run_file;
use std::path::Path;
use trackbed_io::failure::Failure;
use trackbed_io::message::shown;
use trackbed_io::read::source;

const LONGEST: usize = 80;

/// Rejects a new run over a checkpoint, results, or unrelated files.
///
/// # Errors
/// Input errors.
pub fn check(dir: &Path, origin: &Origin, slots: &Slots, lock: &Lock) -> Result<(), Failure> {
    let refuse = |found: &str, expected: &str| {
        Err(Failure::Input(format!("{}: found {found}, expected {expected}", dir.display())))
    };
    if slots.any() {
        let expected = "--resume, --force to start from scratch, or another --out";
        return refuse("the checkpoint of an interrupted run", expected);
    }
    let bytes = source::bytes(&dir.join("summary.json"), source::LARGEST_TEXT).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_slice(&bytes).unwrap_or_default();
    let replace = "another --out, or --force to overwrite them";
    if let Some(hash) = summary["scene_hash"].as_str() {
        let title = shown(summary["title"].as_str().unwrap_or_default(), LONGEST);
        let (own, done) = (hash == origin.scene_hash, summary["status"] == "done");
        return match (own, done) {
            (true, true) => refuse(
                "the completed results of this scene",
                "another --out, or --force to overwrite them; nothing to resume",
            ),
            (false, true) => refuse(&format!("the results of another scene (\"{title}\")"), replace),
            (_, false) => refuse(
                &format!("output of an incomplete run of \"{title}\" without a checkpoint"),
                &format!("{replace}; nothing to resume"),
            ),
        };
    }
    let Some(file) = folder::first_result(dir) else { return Ok(()) };
    if lock.left_behind || dir.join(run_file::FILE).exists() {
        return refuse(
            "output of a killed run without a checkpoint",
            &format!("{replace}; nothing to resume"),
        );
    }
    let name = file.strip_prefix(dir).unwrap_or(&file).display().to_string();
    let expected = "another --out, or --force to overwrite files of the same names";
    refuse(&format!("{name}, an unrelated file"), expected)
}
