//! `[[extreme]]`: values of return periods from seeds.

use super::arguments;
use crate::suite::support::{Folder, json, trackbed};
use std::fs;

const SCENE: &str = r#"gravity = [0, 0, 0]
[[material]]
name = "stone"
density = 2650
stiffness = "1 MN/m"
friction = 0.5
restitution = 0.5
[[grains]]
name = "balls"
shape = "sphere"
material = "stone"
count = 1
size = [0.1, 0.1]
region = { box = [[0, 0, 0], [2, 2, 2]] }
[time]
end = 1e-4
[output]
frames = 0
vtk = false
"#;

const STUDY: &str = r#"title = "Numbers of balls"
scene = "scene.toml"

[seeds]
values = [1, 2, 3, 4, 5, 7]
keys = ["grains.0.count"]

[[quantity]]
name = "balls"
summary = "model.bodies"

[[extreme]]
quantity = "balls"
events_per_year = 12
return_periods = [10, 100]
confidence = 0.9
"#;

fn folder(study: &str) -> Folder {
    let folder = Folder::new("study_extreme");
    folder.write("scene.toml", SCENE);
    folder.write("study.toml", study);
    folder
}

/// The seeds are the values. scipy's `gumbel_r.fit` and `isf`; half width of the interval by the published
/// variances.
#[test]
fn values_of_return_periods_match_scipy() {
    let folder = folder(STUDY);
    let said = trackbed(arguments(&folder, "out", &["--jobs", "2"])).good().stdout;
    let row = &json(&folder.join("out/study.json"))["extremes"][0];
    let close = |found: &serde_json::Value, expected: f64, limit: f64| {
        let found = found.as_f64().unwrap();
        assert!((found / expected - 1.0).abs() < limit, "{found}, expected {expected}: {row}");
    };
    assert_eq!((&row["quantity"], &row["runs"]), (&"balls".into(), &6.into()));
    close(&row["fit"]["location"], 2.718_353_473_6, 2e-8);
    close(&row["fit"]["scale"], 1.654_677_599_8, 2e-8);
    for (k, (period, value)) in [(10.0, 10.633_190_269_8), (100.0, 14.449_455_105_8)].iter().enumerate() {
        let [found, interval] = [&row["values"][k][0], &row["values"][k][1]];
        close(found, *period, 1e-12);
        close(&interval["value"], *value, 2e-8);
        if k == 0 {
            close(&interval["high"], value + 4.645_018, 1e-4);
            close(&interval["low"], value - 4.645_018, 1e-4);
        }
    }
    let page = fs::read_to_string(folder.join("out/study.md")).unwrap();
    assert!(page.contains("## Return periods") && said.contains("return period [years]"), "{page}\n{said}");
    trackbed(["report", &folder.join("out").display().to_string()]).good();
    let report = fs::read_to_string(folder.join("out/report.html")).unwrap();
    assert!(report.contains("Return periods"));
}

#[test]
fn rejects_bad_extremes() {
    for (old, new, line) in [
        (
            "quantity = \"balls\"",
            "quantity = \"way\"",
            "extreme.0.quantity: found \"way\", expected one of \"balls\"",
        ),
        ("= 12", "= 0", "extreme.0.events_per_year: found 0, expected a number above 0"),
        (
            "[10, 100]",
            "[0.05]",
            "extreme.0.return_periods: found [0.05], expected return periods of more than one event",
        ),
        ("confidence = 0.9", "confidence = 1", "extreme.0.confidence: found 1, expected between 0 and 1"),
        (
            "[1, 2, 3, 4, 5, 7]",
            "[1, 2]",
            "seeds.values: found 2 seeds, expected at least 5 seeds with [[extreme]]",
        ),
    ] {
        let folder = folder(&STUDY.replace(old, new));
        let outcome = trackbed(arguments(&folder, "out", &[]));
        assert!(outcome.code == 2 && outcome.stderr.contains(line), "{}\nexpected: {line}", outcome.stderr);
    }
}
