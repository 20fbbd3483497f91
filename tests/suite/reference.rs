//! `docs/scene.md` against the doc comments of keys.

use super::support::{Folder, repository, trackbed};
use std::fs;
use trackbed::scene::{reference, schema};

/// Updates the page.
const RENEW: &str = "trackbed schema --markdown docs/scene.md";

fn page() -> String {
    fs::read_to_string(repository().join("docs/scene.md")).unwrap()
}

#[test]
fn page_agrees_with_comments() {
    let page = page();
    let made = reference::fill(&schema::keys(), &page).unwrap();
    for (number, (found, expected)) in page.lines().zip(made.lines()).enumerate() {
        let line = number + 1;
        assert_eq!(
            found, expected,
            "docs/scene.md:{line} differs from the comments in src/scene; renew it: {RENEW}"
        );
    }
    assert!(
        page == made,
        "docs/scene.md is longer or shorter than the comments in src/scene make it; renew it: {RENEW}"
    );
}

fn words(text: &str) -> usize {
    text.split_whitespace().filter(|word| word.contains(char::is_alphanumeric)).count()
}

#[test]
fn descriptions_are_short_and_complete() {
    let keys = schema::keys();
    let made = reference::fill(&keys, &reference::frame(&keys)).unwrap();
    let (mut heads, mut count, mut faults) = (Vec::new(), 0, Vec::new());
    for line in made.lines().filter(|line| line.starts_with('|') && !line.starts_with("| ---")) {
        let cells: Vec<&str> = line.trim_matches('|').split(" |").map(str::trim).collect();
        if cells[0].starts_with("key") {
            heads = cells;
            continue;
        }
        count += 1;
        let cell = |head: &str| heads.iter().position(|h| *h == head).map_or("", |c| cells[c]);
        let (key, meaning) = (cells[0], cell("meaning"));
        let phrase = meaning.split("; ").next().and_then(|m| m.split(": `\"").next()).unwrap_or_default();
        if phrase.is_empty() || words(phrase) > 15 {
            faults.push(format!("{key}: {} words, expected 1 to 15: {phrase}", words(phrase)));
        }
        let table = key.contains("](#");
        if !key.starts_with("**")
            && !table
            && cell("default").is_empty()
            && !meaning.contains("with ")
            && !meaning.contains("needed")
        {
            faults.push(format!("{key}: found neither a default nor alternatives nor a condition"));
        }
    }
    assert!(count > 400, "{count} keys");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn command_renews_pages() {
    let folder = Folder::new("reference");
    let page = page();
    let file = folder.write("scene.md", &page.replace("| `title` |", "| `heading` |"));
    trackbed(["schema", "--markdown", file.to_str().unwrap()]).good();
    assert!(fs::read_to_string(&file).unwrap() == page, "{} is not docs/scene.md", file.display());
    let all = trackbed(["schema", "--markdown"]).good().stdout;
    assert!(all.contains("\n## track.load.seating\n") && all.contains("\n| `title` |"), "{all}");
    let mark = "\n<!-- keys: solid.blok -->\n";
    let file = folder.write("bad.md", mark);
    let outcome = trackbed(["schema", "--markdown", file.to_str().unwrap()]);
    let expected = "bad.md:2: keys: found solid.blok, expected the keys of a table of a scene, or `scene`";
    assert!(outcome.code == 2 && outcome.stderr.contains(expected), "{outcome:?}");
    assert_eq!(fs::read_to_string(&file).unwrap(), mark);
}
