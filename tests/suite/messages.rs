//! What the program says beside its results: all faults of a scene at once, colours, lines of progress.

use super::support::{Folder, GRAINS, Outcome, SOLID, scene_folder, trackbed};
use std::process::Command;

fn faults(outcome: &Outcome) -> Vec<&str> {
    assert_eq!(outcome.code, 2, "{outcome:?}");
    let lines: Vec<&str> = outcome.stderr.lines().collect();
    lines.iter().map(|l| l.strip_prefix("error: ").unwrap_or_else(|| panic!("{outcome:?}"))).collect()
}

/// Every fault of the form of a scene is named, each once with its line; `check` and `run` say the same.
#[test]
fn all_faults_of_form_are_named_at_once() {
    let folder = Folder::new("faults_of_form");
    let text = GRAINS
        .replace("friction = 0.5", "fricton = 0.5")
        .replace("\"20 ms\"", "\"20 mm\"")
        .replace("frames = 2", "frames = \"two\"")
        .replace("kind = \"plane\"", "kind = \"plain\"");
    let scene = folder.write("scene.toml", &text);
    let (scene, out) = (scene.to_str().unwrap(), folder.join("out"));
    let checked = trackbed(["check", scene]);
    let lines = faults(&checked);
    let line = |word: &str| 1 + text.lines().position(|l| l.contains(word)).unwrap();
    for (word, key) in [
        ("fricton", "material.0.fricton"),
        ("\"20 mm\"", "time.end"),
        ("\"two\"", "output.frames"),
        ("plain", "walls.0"),
    ] {
        let place = format!("scene.toml:{}: {key}", line(word));
        assert_eq!(lines.iter().filter(|l| l.contains(&place)).count(), 1, "{place}: {lines:#?}");
    }
    assert_eq!(lines.len(), 4, "{lines:#?}");
    let run = trackbed(["run", scene, "--out", out.to_str().unwrap()]);
    assert!(run.stderr == checked.stderr && !out.exists(), "{run:?}");
}

/// Values out of range in tables apart are named together; what only follows from a fault is not.
#[test]
fn values_of_tables_apart_are_named_at_once() {
    let folder = scene_folder("faults_of_values", SOLID);
    let scene = folder.join("scene.toml");
    let check = |set: &[&str]| {
        let set = set.iter().flat_map(|s| ["--set", *s]);
        trackbed(["check", scene.to_str().unwrap()].into_iter().chain(set))
    };
    let outcome = check(&["solid.material.0.young=-5", "probe.0.node=77777", "output.frames=2000000"]);
    let found = faults(&outcome);
    let keys = ["material.0.young", "probe.0", "output.frames"];
    let named = |key: &&str| found.iter().filter(|line| line.contains(*key)).count() == 1;
    assert!(found.len() == keys.len() && keys.iter().all(named), "{found:#?}");
    // Poisson's ratio may be judged by what is given beside it: the first alone.
    let outcome = check(&["solid.material.0.young=-5", "solid.material.0.poisson=0.7"]);
    assert_eq!(faults(&outcome).len(), 1, "{outcome:?}");
    // A material that has no name any more is not missed by others.
    let folder = Folder::new("faults_of_names");
    let scene = folder.write("scene.toml", &GRAINS.replace("name = \"stone\"", "name = \"\""));
    let outcome = trackbed(["check", scene.to_str().unwrap()]);
    assert_eq!(faults(&outcome).len(), 1, "{outcome:?}");
}

/// Colours are for terminals, and for those who force them; `NO_COLOR` has the last word.
#[test]
fn colours_are_for_terminals() {
    let folder = Folder::new("colours");
    let scene = folder.write("scene.toml", &GRAINS.replace("0.05]", "-0.05]"));
    let said = |variables: &[(&str, &str)]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
        command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE").envs(variables.iter().copied());
        let output = command.arg("check").arg(&scene).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    };
    let plain = said(&[]);
    assert!(plain.starts_with("error: ") && !plain.contains('\u{1b}'), "{plain:?}");
    let coloured = said(&[("CLICOLOR_FORCE", "1")]);
    assert!(coloured.starts_with("\u{1b}[1m\u{1b}[31merror:\u{1b}[0m "), "{coloured:?}");
    assert_eq!(said(&[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")]), plain);
}

/// `--verbose`: a line each second with where the run is; `--quiet` nothing; both are refused.
#[test]
fn lines_of_a_verbose_run() {
    let folder = Folder::new("verbose");
    let scene = super::support::repository().join("inputs/grains/box.toml");
    let run = |more: &[&str], out: &str| {
        let out = folder.join(out);
        let own = ["run", scene.to_str().unwrap(), "--threads", "1", "--out", out.to_str().unwrap()];
        trackbed(
            own.into_iter()
                .chain(["--set", "grains.0.count=3000", "--set", "time.end=0.3"])
                .chain(more.iter().copied()),
        )
    };
    let verbose = run(&["--verbose"], "verbose").good();
    let lines: Vec<&str> = verbose.stderr.lines().filter(|l| l.contains(" % ")).collect();
    assert!(!lines.is_empty(), "{verbose:?}");
    for line in lines {
        assert!(line.trim_start().starts_with("running") && line.contains(" of about "), "{line}");
        assert!(line.contains(" DEM steps, ") && line.ends_with(" contacts"), "{line}");
    }
    assert_eq!(run(&["--quiet"], "quiet").good().stderr, "");
    assert_eq!(run(&["--quiet", "--verbose"], "both").code, 2);
}
