//! Studies: errors, resumed runs, tables, rejected input.

use super::support::{Folder, json, snapshot, trackbed};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

mod extreme;
mod parameters;
mod parts;
mod refused;
mod refused_parameters;
mod shipped;
mod trade;

/// Sphere against a wall at 1 m/s: half a period of a mass on a spring, stopped midway.
const SWING: &str = r#"title = "sphere on a spring"
gravity = [0.0, 0.0, 0.0]

[[material]]
name = "stone"
density = 2650
stiffness = "1 MN/m"
friction = 0.0
restitution = 1.0

[[grains]]
name = "ball"
shape = "sphere"
material = "stone"
spheres = [[0.0, 0.0, 0.05, 0.05]]
velocity = [0.0, 0.0, -1.0]
record = true

[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "stone"

[time]
end = "1 ms"
grain_step = "0.1 ms"

[output]
frames = 0
vtk = false
"#;

/// Height after 1 ms [m]: r - v/w sin(w t), w^2 = k/m.
fn height() -> f64 {
    let mass = 2650.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.05_f64.powi(3);
    let frequency = (1e6 / mass).sqrt();
    0.05 - (frequency * 1e-3).sin() / frequency
}

fn steps() -> String {
    format!(
        r#"title = "Step of a swing"
scene = "scene.toml"
tolerance = 0.0005

[[axis]]
name = "step"
key = "time.grain_step"
values = ["0.1 ms", "0.05 ms", "0.025 ms"]

[[quantity]]
name = "height"
file = "history.csv"
column = "ball_z"
scale = 0.001
exact = {:?}

[[quantity]]
name = "path"
file = "history.csv"
column = "ball_z"
take = "curve"
scale = 0.001

[reference]
set = ["time.grain_step=3.125e-6"]
"#,
        height()
    )
}

fn folder(name: &str, study: &str) -> Folder {
    let folder = Folder::new(name);
    folder.write("scene.toml", SWING);
    folder.write("study.toml", study);
    folder
}

fn arguments(folder: &Folder, out: &str, more: &[&str]) -> Vec<String> {
    let (study, out) = (folder.join("study.toml"), folder.join(out));
    let mut all =
        vec!["study".to_string(), study.display().to_string(), "--out".into(), out.display().to_string()];
    all.extend(more.iter().map(ToString::to_string));
    all
}

fn table(file: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let heads: Vec<String> = reader.headers().unwrap().iter().map(String::from).collect();
    let row = |r: Result<csv::StringRecord, csv::Error>| {
        heads.iter().cloned().zip(r.unwrap().iter().map(String::from)).collect()
    };
    reader.records().map(row).collect()
}

fn numbers(rows: &[BTreeMap<String, String>], head: &str) -> Vec<f64> {
    rows.iter().map(|r| r[head].parse().unwrap_or_else(|_| panic!("{head}: {:?}", r[head]))).collect()
}

fn without_times(dir: &Path) -> (Vec<BTreeMap<String, String>>, serde_json::Value) {
    let mut rows = table(&dir.join("study.csv"));
    for row in &mut rows {
        for head in ["cpu [s]", "wall [s]", "speed_up", "peak_memory [bytes]"] {
            row.remove(head).unwrap();
        }
    }
    let mut all = json(&dir.join("study.json"));
    for case in all["cases"].as_array_mut().unwrap() {
        for key in ["cpu_seconds", "wall_seconds", "peak_memory"] {
            case["cost"][key].take();
        }
        case["speed_up"].take();
    }
    all["recommended"].take();
    all["front"].take();
    (rows, all)
}

/// Velocity Verlet is second order.
#[test]
fn errors_are_those_of_the_method() {
    let folder = folder("study_order", &steps());
    let said = trackbed(arguments(&folder, "out", &[])).good();
    let rows = table(&folder.join("out/study.csv"));
    let labels: Vec<&str> = rows.iter().map(|r| r["case"].as_str()).collect();
    assert_eq!(labels, ["reference", "step=0.1 ms", "step=0.05 ms", "step=0.025 ms"]);
    for head in ["height error", "path error"] {
        let errors = numbers(&rows, head);
        println!("{head}: {errors:?}");
        for pair in errors[1..].windows(2) {
            assert!((3.7..4.3).contains(&(pair[0] / pair[1])), "{head}: {errors:?}");
        }
    }
    // The exact height gives the reference run a nonzero error.
    let values = numbers(&rows, "height [m]");
    let of_reference = numbers(&rows, "height error")[0];
    assert!((values[0] / height() - 1.0).abs() < 1e-6 && of_reference > 0.0, "{values:?} {of_reference}");
    let error = (values[1] - height()).abs() / 0.001;
    assert!((error / numbers(&rows, "height error")[1] - 1.0).abs() < 1e-9);
    assert_eq!(numbers(&rows, "path error")[0], 0.0);
    assert_eq!(numbers(&rows, "steps")[1..], [10.0, 20.0, 40.0]);
    assert!(numbers(&rows, "cpu [s]").iter().all(|s| *s > 0.0));
    let page = fs::read_to_string(folder.join("out/study.md")).unwrap();
    let line = page.lines().find(|l| l.starts_with("Cheapest case within 0.05 %")).expect("one is within");
    assert!(said.stdout.contains(line), "{}", said.stdout);
    let all = json(&folder.join("out/study.json"));
    let recommended = all["recommended"].as_str().unwrap();
    assert!(line.contains(&format!("\"{recommended}\"")), "{line}");
    let row = rows.iter().find(|r| r["case"] == recommended).unwrap();
    assert_eq!(row["within"], "yes");
    let cheaper = rows.iter().filter(|r| r["within"] == "yes").map(|r| r["cpu [s]"].parse::<f64>().unwrap());
    assert!(cheaper.fold(f64::INFINITY, f64::min) == row["cpu [s]"].parse::<f64>().unwrap());
    let plot = fs::read_to_string(folder.join("out/pareto.svg")).unwrap();
    for word in ["CPU time of a run [s]", "largest relative error [1]", "front", "reference", "tolerance"] {
        assert!(plot.contains(word), "{word}");
    }
}

#[test]
fn no_recommendation_beyond_tolerance() {
    let folder = folder("study_none", &steps().replace("tolerance = 0.0005", "tolerance = 0.00002"));
    let said = trackbed(arguments(&folder, "out", &[])).good().stdout;
    assert!(
        said.contains("No case but the reference \"reference\" is within 0.002 % for all quantities."),
        "{said}"
    );
    folder.edit("study.toml", &format!("exact = {:?}", height()), "exact = 100");
    let said = trackbed(arguments(&folder, "out", &["--merge"])).good().stdout;
    assert!(said.contains("No case is within 0.002 % for all quantities."), "{said}");
}

#[test]
fn resume_runs_only_missing_cases() {
    let folder = folder("study_resume", &steps());
    trackbed(arguments(&folder, "out", &[])).good();
    let runs = folder.join("out/runs");
    let before = snapshot(&runs);
    let again = trackbed(arguments(&folder, "out", &[]));
    let expected =
        "found the run \"reference\", expected --resume, --force to start from scratch, or another --out";
    assert_eq!((again.code, again.stderr.trim_end().ends_with(expected)), (2, true), "{}", again.stderr);
    fs::write(runs.join("reference/mark"), "").unwrap();
    let added = steps().replace("\"0.025 ms\"]", "\"0.025 ms\", \"0.0125 ms\"]");
    folder.write("study.toml", &added);
    let said = trackbed(arguments(&folder, "out", &["--resume"])).good();
    assert!(said.stderr.contains("4 of 5 runs exist"), "{}", said.stderr);
    let after = snapshot(&runs);
    assert!(before.iter().all(|(name, bytes)| after[name] == *bytes), "a finished run has changed");
    assert!(after.contains_key("reference/mark"));
    let rows = table(&folder.join("out/study.csv"));
    assert_eq!(rows.len(), 5);
    let errors = numbers(&rows, "height error");
    assert!((3.7..4.3).contains(&(errors[3] / errors[4])), "{errors:?}");
    folder.edit("scene.toml", "density = 2650", "density = 2660");
    for option in ["--resume", "--merge"] {
        let refused = trackbed(arguments(&folder, "out", &[option]));
        assert_eq!(refused.code, 2);
        assert!(refused.stderr.contains("of a changed scene"), "{}", refused.stderr);
    }
    trackbed(arguments(&folder, "out", &["--force"])).good();
    assert!(
        !runs.join("reference/mark").exists()
            || snapshot(&runs)["reference.json"] != before["reference.json"]
    );
}

#[test]
fn scene_changed_during_study() {
    let folder = folder("study_changed", &steps());
    trackbed(arguments(&folder, "out", &[])).good();
    let summary = "out/runs/reference/summary.json";
    let text = fs::read_to_string(folder.join(summary)).unwrap();
    let hash = text.split("\"scene_hash\": \"").nth(1).unwrap().split('"').next().unwrap();
    folder.edit(summary, hash, "another");
    let said = trackbed(arguments(&folder, "out", &["--merge"]));
    let shown = format!("{}{}", said.stdout, said.stderr);
    assert!(shown.contains("scene changed during the study"), "{shown}");
}

#[test]
fn a_failed_run_is_a_row() {
    let unstable = r#", { label = "unstable", set = ["time.grain_step=0.0026", "time.accept_step_above_limit=true", "time.end=0.2"] }]"#;
    let text = steps().replace("key = \"time.grain_step\"\n", "").replace(
        "[\"0.1 ms\", \"0.05 ms\", \"0.025 ms\"]",
        &format!("[{{ label = \"fine\", set = [] }}{unstable}"),
    );
    let folder = folder("study_failed", &text);
    let said = trackbed(arguments(&folder, "out", &["--jobs", "1"])).good();
    let rows = table(&folder.join("out/study.csv"));
    let failed = rows.iter().find(|r| r["case"] == "step=unstable").unwrap();
    assert_eq!((failed["done"].as_str(), failed["within"].as_str()), ("0", "no"));
    assert!(failed["reasons"].starts_with("step=unstable: failed, exit code 3: "), "{}", failed["reasons"]);
    assert!(failed["height error"].is_empty());
    assert!(rows.iter().all(|r| r["case"] == "step=unstable" || r["done"] == "1"));
    assert!(said.stdout.contains("failed, exit code 3"), "{}", said.stdout);
    let record = fs::read(folder.join("out/runs/step=unstable.json")).unwrap();
    trackbed(arguments(&folder, "out", &["--resume"])).good();
    assert_eq!(fs::read(folder.join("out/runs/step=unstable.json")).unwrap(), record);
    folder.edit("study.toml", "set = [\"time.grain_step=3.125e-6\"]", "label = \"step=unstable\"");
    let said = trackbed(arguments(&folder, "out", &["--resume"]));
    assert_eq!(said.code, 3);
    assert!(said.stderr.contains("error: reference run failed"), "{}", said.stderr);
    assert!(table(&folder.join("out/study.csv")).iter().all(|r| r["path error"].is_empty()));
}

#[test]
fn scatter_is_that_of_the_seeds() {
    let folder = Folder::new("study_seeds");
    let grains = SWING
        .replace(
            "spheres = [[0.0, 0.0, 0.05, 0.05]]",
            "count = 30\nsize = [\"20 mm\", \"40 mm\"]\nfill = { low = [0.0, 0.0, 0.0], high = [0.2, 0.2] }",
        )
        .replace("grain_step = \"0.1 ms\"\n", "")
        .replace("\"1 ms\"", "\"20 ms\"");
    folder.write("scene.toml", &grains);
    folder.write(
        "study.toml",
        r#"scene = "scene.toml"
[[axis]]
key = "material.0.stiffness"
values = [1e6, 1.001e6]
[seeds]
values = [1, 2, 5]
[[quantity]]
name = "energy"
file = "history.csv"
column = "grains_kinetic"
"#,
    );
    let said = trackbed(arguments(&folder, "out", &[])).good().stdout;
    let rows = table(&folder.join("out/study.csv"));
    assert_eq!(rows.iter().map(|r| r["runs"].as_str()).collect::<Vec<_>>(), ["3", "3"]);
    let label = |seed: u32| format!("out/runs/stiffness=1001000.0_seed={seed}/history.csv");
    let last = |seed: u32| {
        let history = super::support::Table::read(&folder.join(&label(seed)));
        *history.column("grains_kinetic").last().unwrap()
    };
    let values = [1, 2, 5].map(last);
    let mean = values.iter().sum::<f64>() / 3.0;
    let deviation = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 2.0).sqrt();
    assert!(deviation > 1e-6 * mean, "other seeds, other places: {values:?}");
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs();
    assert!(close(numbers(&rows, "energy [J]")[1], mean));
    assert!(close(numbers(&rows, "energy standard deviation [J]")[1], deviation));
    let deviations = numbers(&rows, "energy standard deviation [J]");
    let scatter =
        (deviations.iter().map(|d| d * d / 3.0).sum::<f64>()).sqrt() / numbers(&rows, "energy [J]")[0];
    assert!(close(numbers(&rows, "energy error standard error")[1], scatter));
    assert!(said.contains("not significant"), "{said}");
}
