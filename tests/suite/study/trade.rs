//! `study SCENE --trade`.

use super::{SWING, numbers, table};
use crate::suite::support::{Folder, repository, trackbed};
use std::fs;

/// Command of the table in docs/guide/speed-accuracy.md.
const COMMAND: &str = "trackbed study inputs/solid/footing.toml --trade --set time.end=0.4";

#[test]
fn shipped_table_is_current() {
    let folder = Folder::new("trade_footing");
    let scene = repository().join("inputs/solid/footing.toml").display().to_string();
    let out = folder.join("out").display().to_string();
    let set = COMMAND.split("--set ").nth(1).unwrap();
    let arguments = ["study", &scene, "--trade", "--set", set, "--out", &out, "--jobs", "1"];
    let said = trackbed(arguments).good().stdout;
    let rows = table(&folder.join("out/study.csv"));
    let page = fs::read_to_string(repository().join("docs/guide/speed-accuracy.md")).unwrap();
    let shown = page.split(COMMAND).nth(1).expect("the command stands before its table");
    let cells = |line: &str| line.split('|').map(|c| c.trim().to_string()).collect::<Vec<_>>();
    let printed: Vec<Vec<String>> = shown.lines().filter(|l| l.starts_with("| `")).map(cells).collect();
    assert_eq!(printed.len() + 1, rows.len(), "all cases but the reference");
    for (row, cells) in rows[1..].iter().zip(&printed) {
        assert_eq!(format!("`{}`", row["case"]), cells[1]);
        let error: f64 = row["force of footing error"].parse().unwrap();
        assert_eq!(format!("{:.2} %", 100.0 * error), cells[2], "{}", row["case"]);
    }
    // The finest values, not the scene's.
    let errors = numbers(&rows, "force of footing error");
    assert!(errors[0] == 0.0 && errors[1] > 0.005, "{errors:?}");
    let steps = numbers(&rows, "steps");
    assert_eq!((steps[0], steps[1]), (40.0, 20.0));
    for words in ["Pareto front, with CPU time", "Cheapest case within 5 %: "] {
        assert!(said.contains(words), "{said}");
    }
    // What was made is a study that can be edited.
    let file = folder.join("out/trade.toml").display().to_string();
    let again = trackbed(["study", &file, "--merge", "--out", &out]).good().stdout;
    assert_eq!(again, said);
}

#[test]
fn rejected_settings_are_left_out() {
    let folder = Folder::new("trade_ball");
    let scene =
        SWING.replace("[[grains]]", "[wind]\ndrag = 0.4\ndensity = 1.2\nvelocity = [0, 0, 0]\n[[grains]]");
    let probed = scene + "\n[[measure]]\nname = \"near\"\nbox = [[-1, -1, -1], [1, 1, 1]]\n";
    let file = folder.write("scene.toml", &probed).display().to_string();
    let out = folder.join("out").display().to_string();
    let arguments = |more: &[&str]| {
        ["study", &file, "--trade", "--out", &out]
            .iter()
            .chain(more)
            .map(ToString::to_string)
            .collect::<Vec<_>>()
    };
    let said = trackbed(arguments(&["--seeds", "2", "--tolerance", "0.5"])).good().stdout;
    assert!(said.contains("left out: mass factor=4: "), "{said}");
    let rows = table(&folder.join("out/study.csv"));
    let cases: Vec<&str> = rows.iter().map(|r| r["case"].as_str()).collect();
    assert!(cases.contains(&"grain step=half") && !cases.iter().any(|c| c.contains("mass")), "{cases:?}");
    assert!(rows.iter().all(|row| row["runs"] == "2"));
    let text = fs::read_to_string(folder.join("out/trade.toml")).unwrap();
    assert!(text.starts_with("# Left out: mass factor=4: ") && text.contains("tolerance = 0.5\n"), "{text}");
    for (more, found) in [(["--seeds", "2"], "found the run "), (["--seeds", "3"], "found another study")] {
        let again = trackbed(arguments(&[&more[..], &["--tolerance", "0.5"]].concat()));
        assert!(again.code == 2 && again.stderr.contains(found), "{}", again.stderr);
    }
}

#[test]
fn scenes_without_results_are_rejected() {
    let folder = Folder::new("trade_nothing");
    let file = folder.write("scene.toml", SWING).display().to_string();
    let out = folder.join("out").display().to_string();
    let outcome = trackbed(["study", &file, "--trade", "--out", &out]);
    let words = "scene: found no results to compare, expected load cycles, displacements of supports";
    assert!(outcome.code == 2 && outcome.stderr.contains(words), "{}", outcome.stderr);
    let outcome = trackbed(["study", &file, "--trade", "--out", &out, "--set", "time.end=-1"]);
    assert!(outcome.code == 2 && outcome.stderr.contains("time.end: found -1"), "{}", outcome.stderr);
    let outcome = trackbed(["study", &file, "--seeds", "2"]);
    assert!(outcome.code == 2 && outcome.stderr.contains("--trade"), "{}", outcome.stderr);
    assert!(!folder.join("out").exists());
}

/// Runs of other steps end together: errors come from the step alone.
#[test]
fn steps_keep_the_duration() {
    let folder = Folder::new("trade_steps");
    let scene = SWING.replace("end = \"1 ms\"", "steps = 10")
        + "\n[[measure]]\nname = \"near\"\nbox = [[-1, -1, -1], [1, 1, 1]]\n";
    let file = folder.write("scene.toml", &scene).display().to_string();
    let out = folder.join("out").display().to_string();
    trackbed(["study", &file, "--trade", "--out", &out]).good();
    let rows = table(&folder.join("out/study.csv"));
    let steps = numbers(&rows, "steps");
    let at = |case: &str| steps[rows.iter().position(|r| r["case"] == case).unwrap()];
    assert_eq!([at("reference"), at("base"), at("grain step=half")], [40.0, 10.0, 20.0]);
    // 50 steps of 0.02 s: 2 and 5 divide them, 4 does not.
    let footing = repository().join("inputs/solid/footing.toml").display().to_string();
    let out = folder.join("footing").display().to_string();
    let set = ["solid.order=linear", "solid.block.x.counts=[2, 2]", "solid.block.z.counts=[3]"];
    let set: Vec<&str> = set.iter().flat_map(|set| ["--set", *set]).collect();
    trackbed(["study", &footing, "--trade", "--out", &out].iter().chain(&set)).good();
    let rows = table(&folder.join("footing/study.csv"));
    let cases: Vec<&str> = rows.iter().map(|r| r["case"].as_str()).collect();
    let steps: Vec<&&str> = cases.iter().filter(|c| c.starts_with("solid step")).collect();
    assert_eq!(steps, [&"solid step=2 times", &"solid step=5 times"]);
    // Linear elements have one rule.
    assert!(!cases.iter().any(|c| c.contains("integration")), "{cases:?}");
}

#[test]
fn options_of_the_other_kind_are_rejected() {
    let folder = Folder::new("trade_kind");
    let file = folder.write("scene.toml", SWING).display().to_string();
    let study = folder.write("study.toml", "scene = \"scene.toml\"\n").display().to_string();
    let rejected = |arguments: &[&str], words: &str| {
        let outcome = trackbed(arguments);
        assert!(outcome.code == 2 && outcome.stderr.contains(words), "{}", outcome.stderr);
    };
    rejected(&["study", &file], "scene.toml: found a scene, expected a study, or the option --trade");
    rejected(&["study", &study, "--trade"], "study.toml: found a study with --trade, expected a scene");
    rejected(&["study", &file, "--trade", "--tolerance", "0"], "--tolerance: found 0, expected above 0");
    rejected(&["study", &file, "--trade", "--seeds", "5000"], "--seeds: found 5000, expected at most 1000");
}
