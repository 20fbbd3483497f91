//! Tutorials: commands run in order in an empty directory and print the shown output.
//!
//! `sh` blocks are run.

use super::support::{Folder, ONE_THREAD, repository};
use std::path::Path;
use std::process::Command;

struct Block {
    language: String,
    text: String,
    line: usize,
}

fn blocks(page: &str) -> Vec<Block> {
    let mut all: Vec<Block> = Vec::new();
    let mut open = false;
    for (k, line) in page.lines().enumerate() {
        if let Some(language) = line.strip_prefix("```") {
            if !open {
                all.push(Block { language: language.into(), text: String::new(), line: k + 1 });
            }
            open = !open;
        } else if open {
            let block = all.last_mut().expect("a block is open");
            block.text += line;
            block.text.push('\n');
        }
    }
    all
}

/// Whether the parts between `…` occur in order.
fn is_in(line: &str, output: &str) -> bool {
    output.lines().any(|found| {
        let mut rest = found;
        line.trim().split('…').all(|part| {
            let at = rest.find(part);
            if let Some(at) = at {
                rest = &rest[at + part.len()..];
            }
            at.is_some()
        })
    })
}

fn run_page(name: &str) {
    let page = std::fs::read_to_string(repository().join("docs/tutorials").join(name)).unwrap();
    let folder = Folder::new(&format!("tutorial_{}", name.trim_end_matches(".md")));
    let program = Path::new(env!("CARGO_BIN_EXE_trackbed")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let (mut output, mut commands, mut shown) = (String::new(), 0, 0);
    for Block { language, text, line } in blocks(&page) {
        match language.as_str() {
            "sh" => {
                let done = Command::new("sh")
                    .args(["-e", "-c", &text])
                    .env("PATH", &path)
                    .env(ONE_THREAD.0, ONE_THREAD.1)
                    .current_dir(folder.path())
                    .output()
                    .unwrap();
                output = String::from_utf8_lossy(&done.stdout).into_owned()
                    + &String::from_utf8_lossy(&done.stderr);
                assert!(done.status.success(), "{name}:{line}: {output}");
                commands += 1;
            }
            "text" => {
                for expected in text.lines().filter(|l| !l.trim().is_empty()) {
                    assert!(is_in(expected, &output), "{name}:{line}: {expected}\nis not in\n{output}");
                    shown += 1;
                }
            }
            "toml" => {}
            other => panic!("{name}:{line}: a block of {other:?}"),
        }
    }
    assert!(commands >= 3 && shown >= 3, "{name}: {commands} commands, {shown} lines");
}

#[test]
fn a_settlement_curve() {
    run_page("settlement.md");
}

#[test]
fn a_packing_and_a_heap() {
    run_page("packing.md");
}

#[test]
fn a_footing() {
    run_page("footing.md");
}

#[test]
fn line_with_gap_matches_in_order() {
    assert!(is_in("a … c", "x\na b c"));
    assert!(!is_in("c … a", "a b c"));
    assert!(!is_in("a d", "a b c d"));
}
