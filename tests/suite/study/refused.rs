//! Bad study files: exit code 2, one line, nothing written.

use super::{arguments, folder, steps};
use crate::suite::support::trackbed;

#[track_caller]
fn refused(old: &str, new: &str, line: &str) {
    let folder = folder("study_refused", &steps());
    folder.edit("study.toml", old, new);
    let outcome = trackbed(arguments(&folder, "out", &[]));
    let said = outcome.stderr.replace(&format!("{}/", folder.path().display()), "");
    assert_eq!((outcome.code, said.as_str()), (2, format!("error: {line}\n").as_str()));
    assert!(!folder.join("out").exists(), "a refused study leaves nothing");
    let forms = [["found ", ", expected "], ["found, but", "no effect without"]];
    assert!(line.contains(": ") && forms.iter().any(|f| f.iter().all(|w| line.contains(w))), "{line}");
}

#[test]
fn keys_and_values_of_a_study() {
    let line = "study.toml:3: tolerence: found the unknown key `tolerence`, expected `tolerance`";
    refused("tolerance = 0.0005", "tolerence = 0.01", line);
    refused(
        "tolerance = 0.0005",
        "tolerance = 2",
        "study.toml:3: tolerance: found 2, expected above 0, at most 1",
    );
    refused("tolerance = 0.0005", "jobs = 0", "study.toml:3: jobs: found 0, expected at least 1");
    refused(
        "\"scene.toml\"",
        "\"none.toml\"",
        "study.toml:2: scene: found \"none.toml\", expected a scene file",
    );
    let line = "study.toml:3: combine: found \"all\", expected one of \"grid\", \"list\", \"one_at_a_time\"";
    refused("tolerance = 0.0005", "combine = \"all\"", line);
    let line = "study.toml:8: axis.0.values.0: found \"0.1 ms\", expected a table with `label` and `set`, or `key` with `values`";
    refused("key = \"time.grain_step\"\n", "\n", line);
    let line = "study.toml:8: axis.0.values: found no value, expected at least one";
    refused("[\"0.1 ms\", \"0.05 ms\", \"0.025 ms\"]", "[]", line);
    let line =
        "study.toml:5: axis: found the case \"step=0.1 ms\" twice, expected cases with distinct labels";
    refused("\"0.05 ms\"", "\"0.1 ms\"", line);
    let line = "study.toml:13: quantity.0.colum: found the unknown key `colum`, expected `column`";
    refused("column = \"ball_z\"\nscale", "colum = \"ball_z\"\nscale", line);
    let line = "study.toml:12: quantity.0.summary: found \"energy.spent.dashpot_lag\", expected \"energy.flows.interface_dashpot_error\"";
    let path = "summary = \"energy.spent.dashpot_lag\"\nscale";
    refused("file = \"history.csv\"\ncolumn = \"ball_z\"\nscale", path, line);
    let line = "study.toml:10: quantity.0.at: found nothing, expected a number with `take = \"at\"`";
    refused("column = \"ball_z\"\nscale", "column = \"ball_z\"\ntake = \"at\"\nscale", line);
    let line = "study.toml:13: quantity.0.column: found integer 5, expected a column or a list of columns";
    refused("column = \"ball_z\"\nscale", "column = 5\nscale", line);
    let line = "study.toml:14: quantity.0.at: found, but it has no effect without `take = \"at\"`";
    refused("column = \"ball_z\"\nscale", "column = \"ball_z\"\nat = 1\nscale", line);
    let line = "study.toml:14: quantity.0.against: found, but it has no effect without `take = \"curve\"`, `at`, `from` or `since`";
    refused("column = \"ball_z\"\nscale", "column = \"ball_z\"\nagainst = \"time\"\nscale", line);
    let line =
        "study.toml:14: quantity.0.scale: found 0, expected a number above 0, with norm = \"relative\"";
    refused("scale = 0.001\nexact", "scale = 0\nexact", line);
    let line = "study.toml:15: quantity.0.exact: found 0, expected another value, or norm = \"absolute\", or `scale`";
    refused(&format!("scale = 0.001\nexact = {:?}", super::height()), "\nexact = 0", line);
    let line = "study.toml:25: reference.label: found \"step=1\", expected one of \"step=0.1 ms\", \"step=0.05 ms\", \"step=0.025 ms\"";
    refused("set = [\"time.grain_step=3.125e-6\"]", "label = \"step=1\"", line);
}

#[test]
fn settings_that_a_run_would_refuse() {
    let line = "study.toml: \"step=0.5 s\": --set: time.grain_step: found ";
    let folder = folder("study_settings", &steps().replace("\"0.05 ms\"", "\"0.5 s\""));
    let outcome = trackbed(arguments(&folder, "out", &[]));
    assert_eq!(outcome.code, 2);
    assert!(outcome.stderr.contains(line) && outcome.stderr.lines().count() == 1, "{}", outcome.stderr);
    assert!(!folder.join("out").exists());
    folder.edit("study.toml", "\"0.025 ms\"", "\"1 m\"");
    let outcome = trackbed(arguments(&folder, "out", &[]));
    let words =
        ["study.toml: 2 runs rejected: \"step=0.5 s\": --set", "; \"step=1 m\": --set: time.grain_step"];
    assert!(outcome.code == 2 && words.iter().all(|w| outcome.stderr.contains(w)), "{}", outcome.stderr);
}

#[test]
fn a_fault_of_all_settings() {
    let folder = folder("study_scene", &steps());
    folder.edit("scene.toml", "friction = 0.0", "friction = -1.0");
    let outcome = trackbed(arguments(&folder, "out", &[]));
    let words = ["study.toml: \"reference\" and 3 more: ", "scene.toml:8: material.0.friction: found -1"];
    assert!(outcome.code == 2 && words.iter().all(|w| outcome.stderr.contains(w)), "{}", outcome.stderr);
}

#[test]
fn quantities_that_runs_do_not_leave() {
    let folder = folder("study_columns", &steps().replace("\"ball_z\"\ntake", "\"bal_z\"\ntake"));
    let outcome = trackbed(arguments(&folder, "out", &["--jobs", "1"]));
    let words = ["study.toml: quantity.1: found that history.csv has no column `bal_z`, but time, "];
    assert!(outcome.code == 2 && words.iter().all(|w| outcome.stderr.contains(w)), "{}", outcome.stderr);
    let begun =
        std::fs::read_dir(folder.join("out/runs")).unwrap().filter(|e| e.as_ref().unwrap().path().is_dir());
    assert!(
        begun.count() <= 2 && !folder.join("out/study.csv").exists(),
        "the others are not run for nothing"
    );
    folder.edit("study.toml", "\"bal_z\"", "\"ball_z\"");
    trackbed(arguments(&folder, "out", &["--resume"])).good();
}

#[test]
fn options_that_do_not_go_together() {
    let folder = folder("study_options", &steps());
    for options in [
        &["--task", "1/3", "--merge"][..],
        &["--resume", "--force"],
        &["--task", "4/3"],
        &["--jobs", "0"],
        &["--threads", "0"],
    ] {
        let outcome = trackbed(arguments(&folder, "out", options));
        assert_eq!(outcome.code, 2, "{options:?}: {}", outcome.stderr);
        assert!(!folder.join("out").exists(), "{options:?}");
    }
}
