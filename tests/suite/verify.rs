//! `trackbed verify`: the verification matrix and its page.

use super::support::{Folder, Outcome, json, repository, trackbed_in};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

const PAGE: &str = "docs/guide/verification.md";

fn verify(folder: &Folder, more: &[&str]) -> Outcome {
    let out = folder.join("out").display().to_string();
    let mut arguments = vec!["verify", "--out", &out];
    arguments.extend(more);
    trackbed_in(repository(), arguments)
}

/// Cells of the page's tables by row.
fn page_rows() -> BTreeMap<String, Vec<String>> {
    let text = fs::read_to_string(repository().join(PAGE)).unwrap();
    let (matrix, _) = text.split_once("\n## Tests\n").unwrap();
    let lines = matrix.lines().filter(|line| line.starts_with("| `"));
    let cells = |line: &str| line.split('|').map(|c| c.trim().to_string()).collect::<Vec<_>>();
    lines.map(cells).map(|c| (c[1].trim_matches('`').to_string(), c[2..].to_vec())).collect()
}

/// The own column is within tolerance and on the page.
///
/// `trackbed verify --peers --page docs/guide/verification.md` renews the page.
#[test]
fn own_column_is_on_the_page() {
    let folder = Folder::new("verify");
    let outcome = verify(&folder, &[]);
    assert_eq!(outcome.code, 0, "{}\n{}", outcome.stdout, outcome.stderr);
    let page = page_rows();
    let content = json(&folder.join("out/verify.json"));
    let rows = content["rows"].as_array().unwrap();
    assert!(rows.len() >= 30 && rows.len() == page.len(), "{} rows, {} on the page", rows.len(), page.len());
    for row in rows {
        let name = row["name"].as_str().unwrap();
        let line = outcome.stdout.lines().find(|l| l.trim_start().starts_with(&format!("{name} "))).unwrap();
        let printed: Vec<&str> = line.split("  ").map(str::trim).filter(|c| !c.is_empty()).collect();
        let [reference, tolerance, own] = [printed[1], printed[2], printed[3]];
        let cells = page.get(name).unwrap_or_else(|| panic!("{name} is not on the page"));
        let expected = format!("{}, {reference}", row["source"].as_str().unwrap());
        assert_eq!(cells[0], expected, "{name}: renew {PAGE}");
        assert_eq!([&cells[1], &cells[2]], [tolerance, own], "{name}: renew {PAGE}");
    }
    for file in ["verify.md", "verify.svg"] {
        assert!(folder.join("out").join(file).exists(), "{file}");
    }
}

#[test]
fn differences_on_the_page_are_explained() {
    let text = fs::read_to_string(repository().join(PAGE)).unwrap();
    let (_, list) = text.split_once("<!-- verify: differences -->\n").unwrap();
    let lines: Vec<&str> = list.lines().take_while(|line| !line.is_empty()).collect();
    assert!(!lines.is_empty());
    for line in lines {
        assert!(!line.contains("not explained") && !line.contains("trackbed"), "{line}");
    }
}

/// Matrix of one row in a folder, with further keys.
fn matrix(folder: &Folder, exact: f64, more: &str, peers: &str) -> String {
    let scene = repository().join("inputs/verify/bounce.toml").display().to_string();
    let text = format!(
        "{peers}\n[[row]]\nname = \"bounce\"\ngroup = \"contact\"\ncase = \"ball\"\nscene = '{scene}'\nformula = \"e2\"\n\
         source = \"exact\"\nquantity = {{ file = \"history.csv\", column = \"grains_kinetic\", factor = 5.526204, \
         exact = {exact}, tolerance = 0.002 }}\n{more}\n"
    );
    folder.write("matrix.toml", &text).display().to_string()
}

/// A reference off by twice its tolerance fails with exit code 3.
#[test]
fn wrong_reference_fails() {
    let folder = Folder::new("verify_wrong");
    for (exact, code) in [(0.36, 0), (0.36 * 1.004, 3), (0.36 * 0.996, 3)] {
        let file = matrix(&folder, exact, "", "");
        let outcome = verify(&folder, &["--matrix", &file]);
        assert_eq!(outcome.code, code, "{exact}: {}", outcome.stderr);
        assert_eq!(
            outcome.stderr.contains("1 of 1 rows beyond their tolerance or failed: bounce"),
            code == 3
        );
        let page = fs::read_to_string(folder.join("out/verify.md")).unwrap();
        assert_eq!(page.contains("* trackbed: `bounce` "), code == 3, "{page}");
        assert_eq!(json(&folder.join("out/verify.json"))["passed"], code == 0);
    }
}

#[test]
fn wrong_matrices_are_rejected() {
    let folder = Folder::new("verify_rejected");
    let peer =
        "[[peer]]\nname = \"other\"\ntitle = \"Other\"\nscript = \"other.py\"\notherwise = \"nothing\"\n";
    for (more, words) in [
        ("peers = [\"another\"]", "row.0.peers: found \"another\", expected one of other"),
        ("peers = [\"other\"]\nnot_modelled = { other = \"x\" }", "expected a program not in `peers`"),
        ("explained = { other = \"so\" }", "expected a text that begins with \"law: \""),
        ("set = [\"nothing.at=1\"]", "failed: "),
    ] {
        let file = matrix(&folder, 0.36, more, peer);
        let outcome = verify(&folder, &["--matrix", &file]);
        let text = outcome.stderr + &outcome.stdout;
        assert!(outcome.code != 0 && text.contains(words), "{more}: {text}");
    }
    let outcome =
        verify(&folder, &["--matrix", &matrix(&folder, 0.36, "", &peer.replace("other\"", "../other\""))]);
    assert!(
        outcome.stderr.contains("peer.0.name: found \"../other\", expected letters"),
        "{}",
        outcome.stderr
    );
    let file = matrix(&folder, 0.36, "", "");
    let outcome = verify(&folder, &["--matrix", &file, "--only", "nothing"]);
    assert_eq!(outcome.code, 2);
    let expected = "--only: found \"nothing\", expected a row, or one of the groups contact";
    assert!(outcome.stderr.contains(expected), "{}", outcome.stderr);
}

fn has_python() -> bool {
    Command::new("python3").arg("-c").arg("pass").status().is_ok_and(|status| status.success())
}

fn script(folder: &Folder, name: &str, reply: &str) {
    folder.write(name, &format!("import sys\nprint('first line', sys.argv[1:])\nprint('''{reply}''')\n"));
}

/// Peers: a value within tolerance, one above it, a missing program by name; the page below its marks.
#[test]
fn peers_are_compared_or_skipped_by_name() {
    if !has_python() {
        return;
    }
    let folder = Folder::new("verify_peers");
    let mut peers = String::new();
    for name in ["good", "far", "absent"] {
        peers += &format!(
            "[[peer]]\nname = \"{name}\"\ntitle = \"{name}\"\nscript = \"{name}.py\"\notherwise = \"no\"\n"
        );
    }
    let value = |v: f64| {
        format!("{{\"version\": \"7\", \"rows\": {{\"bounce\": {{\"value\": {v}, \"seconds\": 1}}}}}}")
    };
    script(&folder, "good.py", &value(0.3604));
    script(&folder, "far.py", &value(0.4));
    script(&folder, "absent.py", "{\"missing\": \"no module\"}");
    let more = "peers = [\"good\", \"far\", \"absent\"]\nexplained = { far = \"law: another\" }";
    let file = matrix(&folder, 0.36, more, &peers);
    let page = folder.write(
        "page.md",
        "# Page\n\n<!-- verify: contact -->\n| old |\n\n<!-- verify: differences -->\n\nEnd\n",
    );
    let page = page.display().to_string();
    let outcome = verify(&folder, &["--matrix", &file, "--peers", "--page", &page]);
    assert_eq!(outcome.code, 0, "peers do not decide: {}", outcome.stderr);
    for words in
        ["good 7: 1 of 1 rows", "far 7: 0 of 1 rows", "absent: skipped, no module", "+11 %; law: another"]
    {
        assert!(outcome.stdout.contains(words), "{words}: {}", outcome.stdout);
    }
    let text = fs::read_to_string(&page).unwrap();
    let row = "| `bounce` | exact, 0.36 | 0.2 % | -0.026 % | +0.11 % | **+11 %** | skipped |\n\n";
    assert!(text.contains(row) && !text.contains("old") && text.ends_with("law: another\n\nEnd\n"), "{text}");
    folder.write("page.md", "<!-- verify: unknown -->\n");
    let outcome = verify(&folder, &["--matrix", &file, "--peers", "--page", &page]);
    assert!(
        outcome.code == 2 && outcome.stderr.contains("page.md:1: verify: found unknown"),
        "{}",
        outcome.stderr
    );
    assert!(Path::new(&folder.join("page.svg")).exists());
}
