//! Floating hulls: draught, thrust, rudder; level-ice resistance of ships.

use super::{HAZARD, ICE, hazardous};
use crate::suite::support::{Folder, Table, json, run, trackbed};
use std::fs;

const BARGE: &str = r#"
[[walls]]
kind = "triangles"
name = "barge"
material = "ice"
vertices = [[-25, -2, 0], [-15, -2, 0], [-15, 2, 0], [-25, 2, 0], [-25, -2, 2], [-15, -2, 2], [-15, 2, 2], [-25, 2, 2]]
triangles = [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]]
record = true

[walls.body]
mass = "40 t"
centre = [-20, 0, 1]

[walls.body.water]
damping_ratio = [0.5, 0.5, 0.5]
drag = [0.2, 1, 1]

[walls.body.propulsion]
thrust = "4 kN"
point = [-25, 0, 0.3]
history = [[0, 0], ["10 s", 1]]
rudder = { area = 0.6, point = [-25, 0, 0.3], history = [["10 s", 0], ["12 s", "15 deg"]] }

[water]
level = 1.2
drag = 0.6
"#;

/// A barge of 40 t on 10 m × 4 m of fresh water draws 1 m: it sinks by −0.2 m, speeds up and turns to port.
#[test]
fn barge_floats_and_steers() {
    let folder = Folder::new("barge");
    let (before, rest) = ICE.split_once("[[grains]]\nname = \"pile\"").unwrap();
    let text = format!("{before}{BARGE}[time]{}", rest.split_once("[time]").unwrap().1);
    let text =
        text.replace("gravity = [0, 0, 0]", "gravity = [0, 0, -9.81]").replace("count = 20", "count = 4");
    let scene = folder.write("scene.toml", &text);
    let out = folder.join("out");
    run(&scene, &out, &["time.end=20", "time.grain_step_fraction=0.8", "output.history_interval=0.05"])
        .good();
    let table = Table::read(&out.join("history.csv"));
    let column = |name: &str| table.column(name);
    let (time, rise) = (column("time"), column("barge_displacement_z"));
    assert!((rise.last().unwrap() - 0.2).abs() < 2e-3, "{:?}", rise.last());
    let thrust = column("barge_thrust");
    assert!(time.iter().zip(&thrust).all(|(t, f)| (f - 400.0 * t.min(10.0)).abs() < 1e-6));
    let angle = column("barge_rudder_angle");
    assert!((angle.last().unwrap() - 15.0_f64.to_radians()).abs() < 1e-12);
    let [heading, force, speed] =
        ["barge_rotation_z", "barge_rudder_y", "barge_velocity_x"].map(|c| *column(c).last().unwrap());
    assert!(heading > 0.01 && force < 0.0 && speed > 0.5, "{heading} rad, {force} N, {speed} m/s");
    let water = column("barge_water_z");
    assert!((water.last().unwrap() / (40e3 * 9.81) - 1.0).abs() < 0.01, "{:?}", water.last());
    let record = &json(&out.join("summary.json"))["floating"][0];
    let mean = thrust.iter().sum::<f64>() / thrust.len() as f64;
    let propulsion = &record["propulsion"];
    assert!((propulsion["mean_applied"].as_f64().unwrap() / mean - 1.0).abs() < 1e-9, "{record}");
    assert_eq!(propulsion["mean_requested"], propulsion["mean_applied"]);
    assert_eq!(record["rotation"][2].as_f64().unwrap(), heading);
    let said = fs::read_to_string(out.join("log.txt")).unwrap();
    assert!(said.contains("propulsion of barge: thrust requested"), "{said}");
}

/// Lindqvist's resistance by hand: 192,080 + 112,134 + 248,447 N.
#[test]
fn hazard_refers_to_a_ship() {
    let folder = Folder::new("ship-ice");
    let (before, _) = HAZARD.split_once("[structure.hazard.level_ice]").unwrap();
    let ship = "[structure.hazard.level_ice]\nthickness = 1\nwidth = 20\nfriction = 0.1\nflexural_strength = 5e5\ndensity = 900\n\
        hull = { length = 80, draught = 7, stem_angle = \"30 deg\", entrance_angle = \"30 deg\", speed = 0, young = \"2 GPa\" }\n";
    let scene = folder.write("scene.toml", &hazardous().replace(HAZARD, &format!("{before}{ship}")));
    let out = folder.join("out");
    run(&scene, &out, &["time.end=0.3"]).good();
    let load = json(&out.join("summary.json"))["structures"][0]["hazard"]["level_ice"].as_f64().unwrap();
    assert!((load / 552_661.0 - 1.0).abs() < 2e-5, "{load}");
    let edit = |from: &str, to: &str| {
        let text = fs::read_to_string(&scene).unwrap().replace(from, to);
        let scene = folder.write("other.toml", &text);
        trackbed(["check", &scene.display().to_string()]).stderr
    };
    for (from, to, words) in [
        ("speed = 0", "speed = -1", "hull.speed: found -1, expected a speed of at least 0"),
        (
            "friction = 0.1\nflex",
            "friction = 2\nflex",
            "friction: found 2, expected a friction at which ice slides along the stem",
        ),
        (
            "width = 20",
            "width = 20\nangle = 1",
            "angle: found together with `hull`, expected only one of them",
        ),
    ] {
        let said = edit(from, to);
        assert!(said.contains(&format!("structure.0.hazard.level_ice.{words}")), "{said}");
    }
}
