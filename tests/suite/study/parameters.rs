//! Parameter studies: samples, sensitivities, targets, failed and interrupted runs, report.

use super::{SWING, arguments, numbers, table};
use crate::suite::report::Page;
use crate::suite::support::{Folder, json, snapshot, trackbed};
use std::fs;

const LINEAR: &str = r#"title = "Height of a free sphere"
scene = "scene.toml"

[sampling]
method = "latin-hypercube"
samples = 8
seed = 3

[[parameter]]
name = "duration"
key = "time.end"
range = [0.2, 2]
unit = "ms"

[[parameter]]
key = "material.0.friction"
range = [0.1, 10]
scale = "log"

[[quantity]]
name = "height"
file = "history.csv"
column = "ball_z"
factor = 1e3
unit = "mm"

[[target]]
quantity = "height"
value = 59.0
tolerance = 0.25
"#;

/// Steps beyond 2/ω = 2.36 ms are unstable.
const UNSTABLE: &str = r#"scene = "scene.toml"

[sampling]
method = "sobol"
samples = 4

[[parameter]]
name = "step"
key = "time.grain_step"
range = [0.2, 3.6]
unit = "ms"

[base]
set = ["time.accept_step_above_limit=true", "time.end=0.2"]

[[quantity]]
name = "height"
file = "history.csv"
column = "ball_z"
"#;

pub(super) fn folder(name: &str, study: &str) -> Folder {
    let folder = Folder::new(name);
    let free = SWING.replace("0.05, 0.05]]", "0.06, 0.05]]").replace("grain_step = \"0.1 ms\"\n", "");
    folder.write("scene.toml", &free);
    folder.write("study.toml", study);
    folder
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance
}

#[test]
fn linear_response_is_recovered() {
    let folder = folder("study_linear", LINEAR);
    let said = trackbed(arguments(&folder, "out", &[])).good().stdout;
    let samples = table(&folder.join("out/samples.csv"));
    assert_eq!(samples.len(), 8);
    let mut strata: Vec<i64> =
        numbers(&samples, "duration [ms]").iter().map(|t| ((t - 0.2) / 1.8 * 8.0) as i64).collect();
    strata.sort_unstable();
    assert_eq!(strata, (0..8).collect::<Vec<i64>>());
    assert!(numbers(&samples, "friction").iter().all(|f| (0.1..=10.0).contains(f)));
    let rows = table(&folder.join("out/study.csv"));
    for (height, time) in numbers(&rows, "height [mm]").iter().zip(numbers(&rows, "duration [ms]")) {
        assert!(close(*height, 60.0 - time, 1e-9), "{height} after {time} ms");
    }
    let found = table(&folder.join("out/sensitivity.csv"));
    let heads = ["standardized coefficient", "effect", "r_squared"];
    let [coefficients, effects, r_squared] = heads.map(|head| numbers(&found, head));
    assert!(close(coefficients[0], -1.0, 1e-6) && close(coefficients[1], 0.0, 1e-6), "{coefficients:?}");
    assert!(close(effects[0], -1.8, 1e-6) && close(effects[1], 0.0, 1e-6), "{effects:?}");
    assert!(close(r_squared[0], 1.0, 1e-9), "{r_squared:?}");
    assert!(close(numbers(&found, "rank correlation")[0], -1.0, 1e-12));
    assert_eq!((found[0]["low"].as_str(), found[0]["high"].as_str()), ("0.2", "2"));
    assert!(said.contains("duration [ms]") && said.contains("Cases of smallest misfit:"), "{said}");
    for name in ["Effects-on-height", "height-against-duration", "height-against-friction"] {
        let plot = fs::read_to_string(folder.join(&format!("out/plots/{name}.svg"))).unwrap();
        assert!(plot.contains("height [mm]") && plot.starts_with("<svg"), "{name}");
    }
    assert!(folder.join("out/runs/sample=001/summary.json").exists());
    assert!(!folder.join("out/pareto.svg").exists(), "no errors without a reference");
}

#[test]
fn misfit_ranks_cases() {
    let folder = folder("study_misfit", LINEAR);
    trackbed(arguments(&folder, "out", &[])).good();
    let ranked = table(&folder.join("out/targets.csv"));
    let misfits = numbers(&ranked, "misfit");
    assert!(ranked.len() == 8 && misfits.is_sorted(), "{misfits:?}");
    for (row, misfit) in ranked.iter().zip(misfits) {
        let expected = (numbers(std::slice::from_ref(row), "height [mm]")[0] - 59.0) / 0.25;
        let deviation = numbers(std::slice::from_ref(row), "height deviation [tolerances]")[0];
        assert!(close(deviation, expected, 1e-9) && close(misfit, expected.abs(), 1e-9), "{row:?}");
        let within = if expected.abs() <= 1.0 { "yes" } else { "no" };
        assert_eq!(row["height within tolerance"], within);
    }
    let listed = table(&folder.join("out/study.csv"));
    let best = listed
        .iter()
        .min_by(|a, b| a["misfit"].parse::<f64>().unwrap().total_cmp(&b["misfit"].parse().unwrap()));
    assert_eq!(best.unwrap()["case"], ranked[0]["case"]);
}

#[test]
fn listed_values_have_responses() {
    let text = LINEAR.split("[sampling]").next().unwrap().to_string()
        + "combine = \"one_at_a_time\"\n[[axis]]\nname = \"duration\"\nkey = \"time.end\"\nvalues = [\"1 ms\", \"0.5 ms\", \"2 ms\"]\n\
           [[axis]]\nkey = \"material.0.friction\"\nvalues = [0.1, 0.4]\n"
        + &LINEAR[LINEAR.find("[[quantity]]").unwrap()..];
    let folder = folder("study_listed", &text);
    let said = trackbed(arguments(&folder, "out", &[])).good().stdout;
    let found = table(&folder.join("out/sensitivity.csv"));
    assert_eq!(found[0]["parameter"], "duration [ms]");
    let effects = numbers(&found, "effect");
    assert!(close(effects[0], -1.5, 1e-9) && close(effects[1], 0.0, 1e-9), "{effects:?}");
    assert!(said.contains("Cheapest case") && said.contains("Cases of smallest misfit:"), "{said}");
    assert_eq!(table(&folder.join("out/targets.csv"))[0]["case"], "base");
    assert!(folder.join("out/pareto.svg").exists() && !folder.join("out/samples.csv").exists());
}

#[test]
fn failed_run_does_not_end_study() {
    let folder = folder("study_unstable", UNSTABLE);
    let outcome = trackbed(arguments(&folder, "out", &["--jobs", "1"]));
    assert_eq!(outcome.code, 3, "{}", outcome.stderr);
    let rows = table(&folder.join("out/study.csv"));
    let (failed, done): (Vec<_>, Vec<_>) = rows.iter().partition(|r| r["done"] == "0");
    assert!(rows.len() == 4 && !failed.is_empty() && !done.is_empty(), "{rows:?}");
    assert!(done.iter().all(|r| !r["height [m]"].is_empty() && r["reasons"].is_empty()), "{rows:?}");
    assert!(done.last().unwrap()["case"] > failed[0]["case"], "{rows:?}");
    let reason = format!("{}: failed, exit code 3: ", failed[0]["case"]);
    assert!(failed[0]["height [m]"].is_empty() && failed[0]["reasons"].starts_with(&reason), "{rows:?}");
    let words = format!("error: {} of 4 runs failed, not in the tables of ", failed.len());
    assert!(outcome.stderr.contains(&words), "{}", outcome.stderr);
    assert!(outcome.stderr.contains(&format!("\"{}\": failed, exit code 3: ", failed[0]["case"])));
    let before = snapshot(&folder.join("out/runs"));
    let again = trackbed(arguments(&folder, "out", &["--resume"]));
    assert_eq!((again.code, snapshot(&folder.join("out/runs"))), (3, before), "{}", again.stderr);
    let report = trackbed(["report", &folder.join("out").display().to_string()]).good();
    assert!(report.stdout.ends_with("report.html written\n"));
    let page = Page::read(&folder.join("out/report.html"));
    assert!(page.sections.iter().any(|s| s == "failed"), "{:?}", page.sections);
    assert!(page.text.contains(&reason), "{}", page.text);
}

#[test]
fn sobol_study_is_extended() {
    let folder = folder(
        "study_extended",
        &LINEAR.replace("latin-hypercube\"\nsamples = 8\nseed = 3", "sobol\"\nsamples = 2"),
    );
    trackbed(arguments(&folder, "out", &[])).good();
    let before = snapshot(&folder.join("out/runs"));
    folder.edit("study.toml", "samples = 2", "samples = 4");
    let said = trackbed(arguments(&folder, "out", &["--resume"])).good();
    assert!(said.stderr.contains("2 of 4 runs exist"), "{}", said.stderr);
    let after = snapshot(&folder.join("out/runs"));
    assert!(before.iter().all(|(name, bytes)| after[name] == *bytes), "a completed run has changed");
    assert_eq!(numbers(&table(&folder.join("out/samples.csv")), "duration [ms]"), [0.2, 1.1, 1.55, 0.65]);
    folder.edit("study.toml", "samples = 4", "samples = 4\nseed = 9");
    let other = trackbed(arguments(&folder, "out", &["--resume"]));
    assert!(other.code == 2 && other.stderr.contains("of a changed scene"), "{}", other.stderr);
}

#[test]
#[cfg(unix)]
fn killed_study_is_resumed() {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};
    let text = LINEAR.replace("range = [0.2, 2]\nunit = \"ms\"", "range = [0.3, 0.5]");
    let folder = folder(
        "study_killed",
        &text.replace("[sampling]", "[base]\nset = [\"time.grain_step=2e-6\"]\n\n[sampling]"),
    );
    trackbed(arguments(&folder, "whole", &["--jobs", "1"])).good();
    let mut child = Command::new(env!("CARGO_BIN_EXE_trackbed"))
        .args(arguments(&folder, "out", &["--jobs", "1", "--threads", "1"]))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while !folder.join("out/runs/sample=003").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "the third run does not begin");
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    assert!(!child.wait().unwrap().success());
    let early = trackbed(["report", &folder.join("out").display().to_string()]);
    let expected = "study.json: found nothing, expected the tables of a study";
    assert!(early.code == 2 && early.stderr.contains(expected), "{}", early.stderr);
    let first = folder.join("out/runs/sample=001/summary.json");
    let before = fs::read(&first).unwrap();
    let said = trackbed(arguments(&folder, "out", &["--resume"])).good();
    assert!(said.stderr.contains("2 of 8 runs exist"), "{}", said.stderr);
    assert_eq!(fs::read(&first).unwrap(), before);
    let values = |out: &str| numbers(&table(&folder.join(&format!("{out}/study.csv"))), "height [mm]");
    assert_eq!(values("out"), values("whole"));
    for file in ["samples.csv", "sensitivity.csv", "targets.csv"] {
        let read = |out: &str| fs::read(folder.join(&format!("{out}/{file}"))).unwrap();
        assert_eq!(read("out"), read("whole"), "{file}");
    }
}

#[test]
fn report_shows_study() {
    let folder = folder("study_report", LINEAR);
    trackbed(arguments(&folder, "out", &[])).good();
    let out = folder.join("out").display().to_string();
    trackbed(["report", &out]).good();
    let page = Page::read(&folder.join("out/report.html"));
    assert_eq!(page.sections, ["overview", "targets", "posterior", "sensitivity", "responses", "cases"]);
    assert_eq!(page.figures, 3, "a tornado chart and two response plots");
    for text in [
        "Height of a free sphere",
        "height [mm]",
        "8 of 8",
        "Cases of smallest misfit",
        "sample=008",
        "low end",
    ] {
        assert!(page.text.contains(text), "{text:?}: {}", page.text);
    }
    let effect: f64 = table(&folder.join("out/sensitivity.csv"))[0]["effect"].parse().unwrap();
    assert!(page.numbers.contains(&effect), "{effect}");
    trackbed(["report", &out]).good();
    let other = folder.write("other.html", "<p>mine</p>").display().to_string();
    let refused = trackbed(["report", &out, "--out", &other]);
    assert!(refused.code == 2 && refused.stderr.contains("found an existing file"), "{}", refused.stderr);
    trackbed(["report", &out, "--out", &other, "--force", "--title", "a < b"]).good();
    assert!(fs::read_to_string(&other).unwrap().contains("a &lt; b"));
    let refused = trackbed(["report", &out, "--axle-load", "20"]);
    assert!(
        refused.code == 2 && refused.stderr.contains("--axle-load: found 20 with a study"),
        "{}",
        refused.stderr
    );
    let mut study = json(&folder.join("out/study.json"));
    study["analysis"]["sensitivities"][0]["responses"] = serde_json::json!([]);
    folder.write("out/study.json", &study.to_string());
    let refused = trackbed(["report", &out]);
    assert!(
        refused.code == 2 && refused.stderr.contains("found lists of different lengths"),
        "{}",
        refused.stderr
    );
}

#[test]
fn report_shows_errors_of_cases() {
    let folder = super::folder("study_report_errors", &super::steps());
    trackbed(arguments(&folder, "out", &[])).good();
    trackbed(["report", &folder.join("out").display().to_string()]).good();
    let page = Page::read(&folder.join("out/report.html"));
    assert_eq!(page.sections, ["overview", "sensitivity", "responses", "cases", "errors"]);
    for text in ["step [ms]", "height error", "recommended", "reference"] {
        assert!(page.text.contains(text), "{text:?}: {}", page.text);
    }
    let rows = table(&folder.join("out/study.csv"));
    assert!(page.numbers.contains(&numbers(&rows, "height error")[1]));
}
