//! `trackbed reproduce`: a finished run again.

use super::support::{Folder, repository, run, trackbed_in};
use std::fs;

#[test]
fn finished_run_is_reproduced() {
    let folder = Folder::new("reproduce");
    let inputs = repository().join("inputs/grains");
    fs::copy(inputs.join("rolling.toml"), folder.join("scene.toml")).unwrap();
    let out = folder.join("out");
    let outcome = run(&folder.join("scene.toml"), &out, &["output.frames=3"]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    let again = || trackbed_in(&folder.join(""), ["reproduce", "out", "--out", "again", "--threads", "2"]);
    let same = again();
    assert_eq!(same.code, 0, "{}", same.stderr);
    assert!(same.stdout.starts_with("out: reproduced, ") && same.stdout.ends_with(" files identical\n"));
    fs::remove_dir_all(folder.join("again")).unwrap();

    // A changed result is found: column and size.
    let file = out.join("history.csv");
    let text = fs::read_to_string(&file).unwrap();
    let (head, rows) = text.split_once('\n').unwrap();
    fs::write(&file, format!("{head}\n{}", rows.replacen('0', "7", 1))).unwrap();
    let other = again();
    assert_eq!(other.code, 1, "{}", other.stdout);
    assert!(
        other.stderr.contains("1 of ") && other.stderr.contains("history.csv: by up to "),
        "{}",
        other.stderr
    );
    fs::write(&file, text).unwrap();

    // So are changed inputs, before anything runs.
    fs::remove_dir_all(folder.join("again")).unwrap();
    let scene = folder.join("scene.toml");
    let changed = fs::read_to_string(&scene).unwrap() + "# changed\n";
    fs::write(&scene, changed).unwrap();
    let refused = again();
    assert_eq!(refused.code, 2);
    assert!(
        refused.stderr.contains("found another text than in run.json of the results"),
        "{}",
        refused.stderr
    );
    assert!(!folder.join("again").exists());
    let nothing = trackbed_in(&folder.join(""), ["reproduce", "."]);
    assert_eq!(nothing.code, 2);
    assert!(nothing.stderr.contains("run.json: found nothing readable, expected the results of a run"));
}

#[test]
fn a_run_from_another_is_reproduced() {
    let folder = Folder::new("reproduce_from");
    let scene = repository().join("inputs/grains/rolling.toml").display().to_string();
    let go = |words: &[&str]| trackbed_in(&folder.join(""), words).good();
    go(&["run", &scene, "--out", "first", "--quiet"]);
    go(&["run", &scene, "--out", "second", "--from", "first", "--quiet"]);
    let same = go(&["reproduce", "second"]);
    assert!(same.stdout.starts_with("second: reproduced, "), "{same:?}");
    // Another final state is another run.
    go(&["run", &scene, "--out", "first", "--force", "--quiet", "--set", "time.end=0.01"]);
    let other = trackbed_in(&folder.join(""), ["reproduce", "second", "--out", "third"]);
    assert!(other.code == 2 && !folder.join("third").exists(), "{other:?}");
}
