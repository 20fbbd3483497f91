//! System limits: memory, open files.

use super::super::support::{Folder, GRAINS, Outcome, repository, run};
use std::process::{Command, Stdio};

/// Runs with a limit such as `-n 4` and backtraces on.
fn limited(limit: &str, arguments: &[&str]) -> Outcome {
    // Code 124: timeout.
    let output = Command::new("timeout")
        .args(["60", "sh", "-c", &format!("ulimit {limit}; exec \"$0\" \"$@\"")])
        .arg(env!("CARGO_BIN_EXE_trackbed"))
        .args(arguments)
        .env("RUST_BACKTRACE", "1")
        .env("RAYON_NUM_THREADS", "2")
        .stdin(Stdio::null())
        .output()
        .unwrap();
    Outcome {
        code: output.status.code().unwrap_or(-1),
        stdout: String::from_utf8_lossy(&output.stdout).into_owned(),
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

fn commands(folder: &Folder) -> Vec<Vec<String>> {
    let scene = folder.write("scene.toml", GRAINS).display().to_string();
    let results = folder.join("results").display().to_string();
    run(&folder.join("scene.toml"), &folder.join("results"), &[]).good();
    let mesh = repository().join("inputs/coupled/embankment_tet10/embankment.msh").display().to_string();
    let study = repository().join("inputs/studies/newton_settlement.toml").display().to_string();
    let out = |name: &str| folder.join(name).display().to_string();
    let own = |words: &[&str]| words.iter().map(ToString::to_string).collect();
    vec![
        own(&["run", &scene, "--out", &out("run"), "--quiet", "--force", "--threads", "2"]),
        own(&["check", &scene]),
        own(&["report", &results, "--out", &out("page.html")]),
        own(&["view", &results, "--export", &out("view.html"), "--force"]),
        own(&["view", &results, "--no-open"]),
        own(&["mesh", "info", &mesh]),
        own(&["render", &results, "--out", &out("picture.png"), "--force"]),
        own(&["study", &study, "--out", &out("study")]),
    ]
}

#[test]
fn names_missing_file_handles() {
    let folder = Folder::new("handles");
    for words in commands(&folder) {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        for handles in [4, 5, 8, 10] {
            let said = limited(&format!("-n {handles}"), &words);
            assert_eq!((said.code, said.stdout.as_str()), (1, ""), "{handles}: {words:?}: {said:?}");
            let end = ", expected 16 or more. Raise the system limit (ulimit -n)\n";
            let found = said.stderr.strip_prefix("error: open files: found a limit of ");
            let found = found.and_then(|t| t.strip_suffix(end)?.parse::<u32>().ok());
            // Three standard streams, plus inherited files.
            assert!(found.is_some_and(|n| n <= handles - 3), "{handles}: {words:?}: {said:?}");
        }
    }
    for name in ["run", "page.html", "view.html", "picture.png", "study"] {
        assert!(!folder.join(name).exists(), "{name}");
    }
    for words in commands(&folder).iter().filter(|w| ends_soon(w)) {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        assert_eq!(limited("-n 40", &words).code, 0, "{words:?}");
    }
}

fn ends_soon(words: &[String]) -> bool {
    words[0] != "study" && words.last().is_some_and(|w| w != "--no-open")
}

#[test]
fn names_missing_memory() {
    let folder = Folder::new("memory");
    let size = std::fs::metadata(env!("CARGO_BIN_EXE_trackbed")).unwrap().len() / 1024;
    for words in commands(&folder).iter().filter(|w| ends_soon(w)) {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let mut named = 0;
        for more in [8_000, 20_000, 60_000, 110_000, 200_000] {
            let said = limited(&format!("-v {}", size + more), &words);
            // 127: the dynamic loader ran out of memory.
            assert!(matches!(said.code, 0 | 3 | 127), "{more}: {words:?}: {said:?}");
            if said.code == 3 {
                assert_eq!(said.stderr.lines().count(), 1, "{more}: {words:?}: {said:?}");
                assert!(said.stderr.contains("(ulimit -v"), "{more}: {words:?}: {said:?}");
                named += 1;
            }
        }
        assert!(named > 0 || words[0] != "run", "{words:?}");
    }
}

#[test]
fn names_file_beyond_size_limit() {
    let folder = Folder::new("file_size");
    for words in commands(&folder)
        .iter()
        .filter(|w| matches!(w[0].as_str(), "report" | "view" | "render") && ends_soon(w))
    {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let said = limited("-f 1", &words);
        assert_eq!((said.code, said.stderr.lines().count()), (1, 1), "{words:?}: {said:?}");
        assert!(said.stderr.contains("cannot be written: File too large"), "{words:?}: {said:?}");
    }
}
