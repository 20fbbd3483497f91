//! Validity checks: balances close, but the theory does not apply.

use super::support::{Folder, Table, json, repository, run, trackbed};
use serde_json::Value;
use std::fs;

/// Soil block with inertia, pressure ten times the collapse load.
const COLLAPSE: &str = r#"
[solid]
gravity = false
dynamics = {}
integration = "full"
[solid.block]
x = { lines = [0.0, 2.0], counts = [2] }
y = { lines = [0.0, 1.0], counts = [1] }
z = { lines = [0.0, 1.0], counts = [2] }
[[solid.material]]
id = 1
young = 1e7
poisson = 0.3
density = 2000
model = "mohr_coulomb"
cohesion = 1e4
friction = "20 deg"
dilation = 0
[[solid.support]]
side = "z-"
directions = ["x", "y", "z"]
[[solid.load]]
kind = "pressure"
side = "z+"
pressure = 1e6
history = { kind = "ramp", duration = 0.1 }
[time]
end = 0.2
solid_step = 0.005
[output]
vtk = false
"#;

const DROP: &str = r#"
[[material]]
name = "m"
density = 2650
stiffness = 1e6
friction = 0.5
restitution = 0.9
[[walls]]
kind = "plane"
name = "floor"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "m"
[[grains]]
name = "g"
shape = "sphere"
material = "m"
spheres = [[0, 0, 0.1, 0.01]]
[time]
end = 0.1
[output]
vtk = false
"#;

const BED: &str = r#"
[[material]]
name = "m"
density = 2650
stiffness = 1e5
friction = 0.5
restitution = 0.3
[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "m"
[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [1, 0, 0]
material = "m"
[[walls]]
kind = "plane"
point = [0.2, 0, 0]
normal = [-1, 0, 0]
material = "m"
[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
material = "m"
[[walls]]
kind = "plane"
point = [0, 0.2, 0]
normal = [0, -1, 0]
material = "m"
[[grains]]
name = "g"
shape = "sphere"
material = "m"
count = 300
size = [0.018, 0.022]
fill = { low = [0, 0, 0], high = [0.2, 0.2] }
[deposition]
max_time = 0.6
settled_speed = 0.01
local_damping = 0.3
[[measure]]
name = "core"
box = [[0.02, 0.02, 0.02], [0.18, 0.18, 0.05]]
[time]
end = 0.001
[output]
vtk = false
"#;

fn summary(name: &str, scene: &str, set: &[&str]) -> (Value, String) {
    let folder = Folder::new(name);
    let file = folder.write("scene.toml", scene);
    run(&file, &folder.join("out"), set).good();
    let log = fs::read_to_string(folder.join("out/log.txt")).unwrap();
    (json(&folder.join("out/summary.json")), log)
}

fn status(summary: &Value, name: &str) -> String {
    let all = summary["validity"].as_array().expect("checks of validity");
    let named = |c: &&Value| c["name"].as_str().is_some_and(|n| n.contains(name));
    let check = all.iter().find(named).unwrap_or_else(|| panic!("{name} in {all:#?}"));
    check["status"].as_str().unwrap().to_string()
}

fn warned(summary: &Value, part: &str) -> bool {
    summary["warnings"].as_array().unwrap().iter().any(|w| w.as_str().unwrap().contains(part))
}

#[test]
fn flowing_soil_is_invalid() {
    let (far, log) = summary("validity-collapse", COLLAPSE, &[]);
    assert_eq!(far["verdict"]["outcome"], "failed", "{far:#}");
    assert_eq!(status(&far, "largest strain of the solid"), "failed");
    assert!(log.contains("validity: failed, 3 checks") && warned(&far, "solid: strain "), "{log}");
    let (near, log) = summary("validity-stands", COLLAPSE, &["solid.load.0.pressure=2e4"]);
    assert_eq!(near["verdict"]["outcome"], "passed", "{near:#}");
    assert!(log.contains("validity: passed, 3 checks"), "{log}");
}

#[test]
fn footing_at_its_collapse_load_passes() {
    let folder = Folder::new("validity-footing");
    run(&repository().join("inputs/solid/footing.toml"), &folder.join("out"), &["output.vtk=false"]).good();
    let s = json(&folder.join("out/summary.json"));
    assert_eq!(s["verdict"]["outcome"], "passed", "{s:#}");
    assert!(s["warnings"].as_array().is_none_or(Vec::is_empty), "{}", s["warnings"]);
}

#[test]
fn falling_scaled_masses_are_invalid() {
    for (factor, end, outcome) in [(100, 0.3, "failed"), (4, 0.1, "failed"), (2, 0.3, "failed")] {
        let set = [format!("time.mass_factor={factor}"), format!("time.end={end}")];
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let (found, _) = summary("validity-drop", DROP, &set);
        assert_eq!(status(&found, "scaled masses"), outcome, "{factor}");
        assert_eq!(found["verdict"]["outcome"], outcome);
        assert!(warned(&found, "Remove time.mass_factor"));
    }
    let (plain, _) = summary("validity-drop-plain", DROP, &[]);
    assert_eq!(plain["verdict"]["outcome"], "passed");
}

#[test]
fn measurement_box_above_bed_warns() {
    let (good, _) = summary("validity-box", BED, &[]);
    assert_eq!(status(&good, "measure core"), "passed", "{good:#}");
    for top in ["0.15", "0.3"] {
        let set = format!("measure.0.box=[[0.02, 0.02, 0.02], [0.18, 0.18, {top}]]");
        let (high, _) = summary("validity-box-high", BED, &[&set]);
        assert_eq!(status(&high, "measure core"), "warned", "{high:#}");
        assert!(
            warned(&high, "measure core: top at z = ") && warned(&high, "above the mean bed surface at z = ")
        );
        assert_eq!(high["verdict"]["outcome"], "warned");
    }
    let (none, _) =
        summary("validity-box-none", BED, &["measure.0.box=[[0.02, 0.02, 0.2], [0.18, 0.18, 0.3]]"]);
    assert_eq!(status(&none, "measure core"), "warned");
}

#[test]
fn measurement_box_beside_bed_warns() {
    for (corners, at) in [
        (
            "[[0.1, 0.02, 0.02], [0.3, 0.18, 0.05]]",
            "side at x = 0.3000 m, beyond the bed that ends at 0.2000 m",
        ),
        ("[[0.02, 0.02, -0.05], [0.18, 0.18, 0.05]]", "side at z = -0.0500 m, beyond the bed"),
    ] {
        let (found, _) = summary("validity-box-beside", BED, &[&format!("measure.0.box={corners}")]);
        assert_eq!(status(&found, "fraction of measure core outside the bed"), "warned", "{found:#}");
        assert!(warned(&found, &format!("measure core: {at}")), "{found:#}");
    }
    let whole = "measure.0.box=[[0, 0, 0], [0.2, 0.2, 0.05]]";
    let (whole, _) = summary("validity-box-whole", BED, &[whole]);
    assert_eq!(status(&whole, "fraction of measure core outside the bed"), "passed", "{whole:#}");
}

#[test]
fn run_ends_at_its_end() {
    for interval in ["1 ms", "0.1 ms", "0.07 ms"] {
        let folder = Folder::new("validity-end");
        let file = folder.write("scene.toml", DROP);
        let set = format!("output.history_interval={interval}");
        run(&file, &folder.join("out"), &[&set, "time.end=0.3"]).good();
        let times = Table::read(&folder.join("out/history.csv")).column("time");
        assert!((times[times.len() - 1] - 0.3).abs() < 1e-9, "{interval}: {:?}", times.last());
    }
}

#[test]
fn open_borders_are_named() {
    let folder = Folder::new("validity-border");
    let walls: Vec<&str> = BED.split("[[walls]]").collect();
    let ground = r#"
[solid]
[solid.block]
x = { lines = [-1.0, 1.0], counts = [4] }
y = { lines = [0.0, 0.2], counts = [1] }
z = { lines = [-1.0, 0.0], counts = [2] }
[[solid.material]]
id = 1
young = 1e8
poisson = 0.3
density = 1900
[[solid.support]]
side = "z-"
directions = ["x", "y", "z"]
[coupling]
material = "m"
substeps = "auto"
"#;
    let check = |name: &str, kept: &[usize]| {
        let mut text = walls[0].to_string();
        kept.iter().for_each(|k| text += &format!("[[walls]]{}", walls[*k]));
        let rest = &BED[BED.find("[[grains]]").unwrap()..];
        if !kept.contains(&5) {
            text += rest;
        }
        trackbed(["check", &folder.write(name, &(text + ground)).to_string_lossy()]).good().stdout
    };
    let both = check("both.toml", &[4, 5]);
    assert!(!both.contains("border of the solid"), "{both}");
    let one = check("one.toml", &[4]);
    assert!(one.contains("border of the solid at y = 0.2 m, without a wall there"), "{one}");
    let none = check("none.toml", &[]);
    assert!(none.contains("at y = 0 m, y = 0.2 m, without a wall there"), "{none}");
}

#[test]
fn large_bond_rotations_warn() {
    let chain = r#"
gravity = [0, 0, -9.81]
[[material]]
name = "m"
density = 2650
stiffness = 1e6
friction = 0
restitution = 0.5
[[grains]]
name = "w"
shape = "sphere"
material = "m"
spheres = [[0, 0, 0, 0.01]]
prescribed_velocity = [0, 0, 0]
[[grains]]
name = "b"
shape = "sphere"
material = "m"
spheres = [[0.02, 0, 0, 0.01], [0.04, 0, 0, 0.01], [0.06, 0, 0, 0.01]]
[[bond]]
name = "c"
gap = "1 mm"
damping = 0.7
[bond.parallel]
young = 1e3
stiffness_ratio = 2.5
[time]
end = 0.5
[output]
vtk = false
frames = 0
"#;
    let (soft, _) = summary("validity-bond", chain, &[]);
    assert_ne!(status(&soft, "largest rotation of a bond"), "passed", "{soft:#}");
    assert!(warned(&soft, ": rotation "), "{soft:#}");
    assert!(!warned(&soft, "lost below all walls"), "{soft:#}");
    let (stiff, _) = summary("validity-bond-stiff", chain, &["bond.0.parallel.young=1e7", "time.end=0.05"]);
    assert_eq!(status(&stiff, "largest rotation of a bond"), "passed", "{stiff:#}");
    assert_eq!(stiff["verdict"]["outcome"], "passed");
}
