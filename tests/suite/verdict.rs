//! Checks of runs: pass, or exit code 3.

use super::support::{Folder, json, repository, run};
use serde_json::Value;
use std::fs;

fn judged<'a>(summary: &'a Value, what: &str) -> &'a Value {
    let all = summary["verdict"]["checks"].as_array().expect("accounts");
    let named = |j: &&Value| j["name"].as_str().is_some_and(|w| w.starts_with(what));
    all.iter().find(named).unwrap_or_else(|| panic!("{what} in {all:#?}"))
}

#[test]
fn divergent_solid_fails() {
    let folder = Folder::new("verdict-pulse");
    let set = [
        "solid.dynamics.beta=0",
        "solid.dynamics.gamma=0.5",
        "solid.dynamics.accept_conditional_stability=true",
        "output.frames=0",
    ];
    let outcome = run(&repository().join("inputs/solid/pulse.toml"), &folder.join("out"), &set);
    assert_eq!(outcome.code, 3, "{}", outcome.stderr);
    assert!(outcome.stderr.contains("energy error: "), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("at t = "), "{}", outcome.stderr);
    let summary = json(&folder.join("out/summary.json"));
    assert_eq!(summary["verdict"]["outcome"], "failed");
    assert!(summary["status"].as_str().unwrap().starts_with("failed"));
}

#[test]
fn a_solid_that_is_right_passes() {
    let folder = Folder::new("verdict-pass");
    let set = ["output.frames=0"];
    run(&repository().join("inputs/solid/pulse.toml"), &folder.join("out"), &set).good();
    let log = fs::read_to_string(folder.join("out/log.txt")).unwrap();
    assert!(log.contains("checks: passed, 1 balance"), "{log}");
    let summary = json(&folder.join("out/summary.json"));
    let energy = judged(&summary, "largest energy error");
    assert_eq!(energy["outcome"], "passed");
    assert!(energy["value"].as_f64().unwrap() < 1e-6, "{energy}");
}

#[test]
fn grains_that_heat_have_failed() {
    let folder = Folder::new("verdict-grains");
    folder.write(
        "scene.toml",
        r#"
[[material]]
name = "stone"
density = 2600.0
stiffness = 1e6
friction = 0.5
restitution = 0.9

[[grains]]
name = "spheres"
shape = "sphere"
material = "stone"
count = 200
size = [0.02, 0.02]
fill = { low = [-0.06, -0.06, 0.0], high = [0.06, 0.06] }

[[walls]]
name = "floor"
kind = "plane"
material = "stone"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]

[deposition]
max_time = 0.5
settled_speed = 0.1

[time]
end = 0.5
"#,
    );
    let scene = folder.join("scene.toml");
    run(&scene, &folder.join("good"), &["time.end=0.05"]).good();
    let summary = json(&folder.join("good/summary.json"));
    assert!(judged(&summary, "momentum error")["value"].as_f64().unwrap() < 1e-9);
    let limit = summary["model"]["grain_step_limit"].as_f64().unwrap();
    let step = format!("time.grain_step={}", 4.0 * limit);
    let long = run(&scene, &folder.join("long"), &[&step, "time.accept_step_above_limit=true"]);
    assert_eq!(long.code, 3, "{}{}", long.stdout, long.stderr);
}
