//! Energy balance as a stop criterion, and initial energies of stages.

use super::support::{Folder, Outcome, Table, json, run};

const MATERIALS: &str = r#"gravity = [0, 0, 0]
[[material]]
name = "s"
density = 2500
stiffness = "5 MN/m"
friction = 0.5
restitution = 0.3
[[material]]
name = "w"
friction = 0.3
restitution = 0.3
"#;

fn scene(name: &str, text: &str, set: &[&str]) -> (Folder, Outcome) {
    let folder = Folder::new(name);
    let file = folder.write("scene.toml", text);
    let outcome = run(&file, &folder.join("out"), set);
    (folder, outcome)
}

fn energy(folder: &Folder, key: &str) -> f64 {
    json(&folder.join("out/summary.json"))["energy"][key].as_f64().unwrap()
}

#[test]
fn rounding_stops_no_run() {
    let text = format!(
        "{MATERIALS}
[[walls]]
name = \"stop\"
kind = \"plane\"
point = [0, 0, 0]
normal = [1, 0, 0]
material = \"w\"
record = true
[[walls]]
name = \"plate\"
kind = \"plane\"
point = [0.31, 0, 0]
normal = [-1, 0, 0]
material = \"w\"
record = true
velocity = [-0.02, 0, 0]
[[grains]]
name = \"g\"
shape = \"sphere\"
material = \"s\"
spheres = [[0.05, 0, 0, 0.05], [0.15, 0, 0, 0.05], [0.25, 0, 0, 0.05]]
[time]
end = \"0.55 s\"
[output]
frames = 1
history_interval = \"1 ms\"
"
    );
    let (folder, outcome) = scene("balance-rounding", &text, &[]);
    outcome.good();
    let history = Table::read(&folder.join("out/history.csv"));
    let last = |name: &str| *history.column(name).last().unwrap();
    assert!((last("stop_force_x") + 1683.0).abs() < 20.0, "{}", last("stop_force_x"));
    assert!((last("plate_force_x") - 1683.0).abs() < 20.0, "{}", last("plate_force_x"));
}

#[test]
fn rounding_at_rest_stops_no_run() {
    let two = "spheres = [[0.05, 0, 0, 0.05], [0.15, 0, 0, 0.05]]";
    let floor = "[[walls]]\nkind = \"plane\"\npoint = [0, 0, 0.2]\nnormal = [0, 0, 1]\nmaterial = \"w\"\n";
    let springs = MATERIALS.to_string();
    let hertz = springs.replace("stiffness = \"5 MN/m\"", "young = \"1 GPa\"\npoisson = 0.2");
    let hertz = hertz.replace("name = \"w\"", "name = \"w\"\nyoung = \"1 GPa\"\npoisson = 0.2");
    let cases = [
        ("two", two, "", &springs),
        ("floor", "spheres = [[0, 0, 0.3, 0.1]]", floor, &springs),
        ("far", "spheres = [[100.05, 0, 0, 0.05], [100.15, 0, 0, 0.05]]", "", &springs),
        ("row", "spheres = [[0.05, 0, 0, 0.05], [0.15, 0, 0, 0.05], [0.25, 0, 0, 0.05]]", "", &hertz),
        ("hertz", two, "", &hertz),
    ];
    for (name, spheres, walls, materials) in cases {
        let text = format!(
            "{materials}{walls}[[grains]]\nname = \"g\"\nshape = \"sphere\"\nmaterial = \"s\"\n{spheres}\n[time]\nend = 0.01\n\
             [output]\nframes = 1\n"
        );
        let (_, outcome) = scene(&format!("balance-rest-{name}"), &text, &[]);
        outcome.good();
    }
}

const CANTILEVER: &str = r#"gravity = [0, 0, 0]
[[material]]
name = "s"
density = 2600
stiffness = "1 MN/m"
friction = 0.0
restitution = 1.0
[[grains]]
name = "wall"
shape = "sphere"
material = "s"
spheres = [[0, 0, 0, 0.01]]
prescribed_velocity = [0, 0, 0]
[[grains]]
name = "beam"
shape = "sphere"
material = "s"
spheres = [[0.02, 0, 0, 0.01], [0.04, 0, 0, 0.01]]
[[bond]]
name = "cement"
gap = "1 mm"
damping = 0.5
[bond.direct]
stiffness = [1.5708e7, 6.2832e6, 392.70, 314.16]
strength = [62.83, 125.66, 0.15708, 0.31416]
criterion = "sum"
[[walls]]
kind = "triangles"
name = "ram"
material = "s"
vertices = [[0.035, -0.01, 0.010001], [0.045, -0.01, 0.010001], [0.045, 0.01, 0.010001], [0.035, 0.01, 0.010001]]
triangles = [[0, 1, 2], [0, 2, 3]]
servo = { direction = [0, 0, -1], force = 1.0, history = [[0, 0.0], [1.0, 1.0]], max_speed = 0.002 }
record = true
[time]
end = 0.02
[output]
frames = 0
"#;

#[test]
fn outcome_does_not_depend_on_rows() {
    let errors = ["1e-3", "2e-3", "3.7e-3"].map(|interval| {
        let set = format!("output.history_interval={interval}");
        let (folder, outcome) = scene(&format!("balance-ramp-{interval}"), CANTILEVER, &[&set]);
        outcome.good();
        assert_eq!(json(&folder.join("out/summary.json"))["verdict"]["outcome"], "passed");
        let of = |folder: &Folder| {
            ["largest_relative_error", "largest_error", "relative_error"].map(|key| energy(folder, key))
        };
        let fixed = [set.as_str(), "time.grain_step=2e-6"];
        let (other, outcome) = scene(&format!("balance-rows-{interval}"), CANTILEVER, &fixed);
        outcome.good();
        // Rows closer than DEM steps (10 µs) change the windows.
        let close = [set.as_str(), "output.history_interval=1e-5"];
        scene(&format!("balance-close-{interval}"), CANTILEVER, &close).1.good();
        [of(&folder), of(&other)]
    });
    assert!(errors[0] == errors[1] && errors[1] == errors[2], "{errors:?}");
}

#[test]
fn servo_touches_without_false_stop() {
    for (force, speed, restitution) in
        [(1.0, 0.2, 0.3), (10.0, 0.5, 0.3), (50.0, 0.2, 0.05), (200.0, 0.2, 0.3), (200.0, 0.5, 0.05)]
    {
        let text = format!(
            "{}
[[walls]]
kind = \"plane\"
point = [0, 0, 0]
normal = [0, 0, 1]
material = \"w\"
[[walls]]
name = \"plate\"
kind = \"plane\"
point = [0, 0, 0.21]
normal = [0, 0, -1]
material = \"w\"
record = true
servo = {{ force = {force}, max_speed = {speed} }}
[[grains]]
name = \"g\"
shape = \"sphere\"
material = \"s\"
spheres = [[0, 0, 0.05, 0.05], [0, 0, 0.15, 0.05]]
[time]
end = 0.5
[output]
frames = 0
",
            MATERIALS.replace("restitution = 0.3", &format!("restitution = {restitution}"))
        );
        let (folder, outcome) = scene("balance-servo", &text, &[]);
        outcome.good();
        let history = Table::read(&folder.join("out/history.csv"));
        let held = *history.column("plate_force_z").last().unwrap();
        let error = energy(&folder, "largest_relative_error");
        println!("{force} N, {speed} m/s, e = {restitution}: {held:.4} N, energy error {error:.2e}");
        assert!((held / force - 1.0).abs() < 0.02, "{force} N at {speed} m/s: {held}");
        assert!(error < 0.1, "{force} N at {speed} m/s: {error}");
    }
}

#[test]
fn spurious_energy_stops_run() {
    let text = format!(
        "{MATERIALS}
[[walls]]
kind = \"plane\"
point = [0, 0, 0]
normal = [1, 0, 0]
material = \"w\"
velocity = [0.01, 0, 0]
[[grains]]
name = \"g\"
shape = \"sphere\"
material = \"s\"
spheres = [[0.05, 0, 0, 0.05], [0.15, 0, 0, 0.05], [0.25, 0, 0, 0.05]]
[time]
end = 0.5
grain_step = \"3 ms\"
accept_step_above_limit = true
[output]
frames = 0
"
    );
    let (_, outcome) = scene("balance-long-steps", &text, &[]);
    assert_eq!(outcome.code, 3, "{}", outcome.stderr);
}

fn pair(second: &str, more: &str) -> String {
    format!(
        "{MATERIALS}[[grains]]\nname = \"g\"\nshape = \"sphere\"\nmaterial = \"s\"\nspheres = [[0, 0, 0, 0.01], {second}]\n{more}[time]\n\
         end = 0.001\n[output]\nframes = 0\n"
    )
}

#[test]
fn rejects_deep_start_overlap() {
    let deep = [
        ("pair", pair("[0.015, 0, 0, 0.01]", "")),
        ("small", pair("[0.0105, 0, 0, 0.001]", "")),
        ("just", pair("[0.0189, 0, 0, 0.01]", "")),
        ("beyond", pair("[0.005, 0, 0, 0.01]", "")),
        ("beyond-settling", pair("[0.005, 0, 0, 0.01]", "[deposition]\nmax_time = 0.1\n")),
    ];
    for (name, text) in &deep {
        let (folder, outcome) = scene(&format!("balance-overlap-{name}"), text, &[]);
        assert_eq!(outcome.code, 2, "{name}: {}", outcome.stderr);
        assert!(
            outcome.stderr.contains("% of the smaller radius, expected at most 10 % at the start"),
            "{}",
            outcome.stderr
        );
        let both = ["grain 0 of \"g\"", "grain 1 of \"g\""];
        assert!(both.iter().all(|name| outcome.stderr.contains(name)), "{}", outcome.stderr);
        assert!(!folder.join("out/summary.json").exists());
    }
    let floor = "[[walls]]\nkind = \"plane\"\npoint = [0, 0, -0.008]\nnormal = [0, 0, 1]\nmaterial = \"w\"\n";
    let (_, outcome) = scene("balance-overlap-plane", &pair("[0.5, 0, 0.5, 0.01]", floor), &[]);
    assert_eq!(outcome.code, 2, "{}", outcome.stderr);
    let (_, outcome) =
        scene("balance-overlap-behind", &pair("[0.5, 0, 0.5, 0.01]", &floor.replace("-0.008", "0.004")), &[]);
    assert_eq!(outcome.code, 2, "{}", outcome.stderr);
    assert!(outcome.stderr.contains("grain 0 of \"g\" and wall"), "{}", outcome.stderr);
    let (_, outcome) =
        scene("balance-overlap-accepted", &pair("[0.015, 0, 0, 0.01]", "accept_overlap = true\n"), &[]);
    outcome.good();
    let (_, outcome) = scene("balance-overlap-light", &pair("[0.0191, 0, 0, 0.01]", ""), &[]);
    outcome.good();
}

/// Boulder on grains a hundredth of its size, strong local damping. Without damping in the step, the
/// spurious energy is 0.68 J at a reference energy of 0.001 J.
#[test]
fn local_damping_keeps_grains_at_rest() {
    let text = r#"
[[material]]
name = "stone"
density = 2600
friction = 0.5
stiffness = 5e4
restitution = 0.3
rolling_friction = 0.1
[[grains]]
name = "fines"
shape = "sphere"
material = "stone"
lattice = { kind = "hexagonal", size = 0.001, low = [-0.006, -0.0045, 0.0], counts = [12, 10, 2] }
[[grains]]
name = "boulder"
shape = "sphere"
material = "stone"
spheres = [[0.0, 0.0, 0.05184, 0.05]]
[[walls]]
kind = "plane"
material = "stone"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
[deposition]
max_time = 0.04
local_damping = 0.8
[time]
end = 1e-4
[output]
vtk = false
"#;
    let (folder, outcome) = scene("balance-damped-bed", text, &[]);
    outcome.good();
    let stage = &json(&folder.join("out/summary.json"))["stage_energy"][0];
    let value = |key: &str| stage[key].as_f64().unwrap();
    println!("{stage}");
    assert!(value("relative_error").abs() < 0.1 && value("reference_energy") < 0.01, "{stage}");
    assert!(value("kinetic") < 1e-6, "{stage}");
}
