//! Scenes with all wall kinds.

use super::support::{Folder, Table, json, repository, run};
use std::fs;

fn scene(name: &str) -> std::path::PathBuf {
    repository().join("inputs/grains").join(format!("{name}.toml"))
}

fn good_energy(dir: &std::path::Path, bound: f64) {
    let summary = json(&dir.join("summary.json"));
    let error = summary["energy"]["relative_error"].as_f64().unwrap();
    let momentum = summary["momentum"]["linear"].as_f64().unwrap();
    println!("{}: energy error {error:.1e}, momentum error {momentum:.1e}", dir.display());
    assert!(error < bound && momentum < 1e-11, "{error:e} {momentum:e}");
}

#[test]
fn hopper_discharges() {
    let out = Folder::new("hopper");
    let set = [
        "grains.0.count=250",
        "deposition.max_time=0.25",
        "time.end=0.25",
        "output.frames=2",
        "walls.0.radii=[0.03,0.1]",
        "walls.1.radii=[0.03,0.0]",
    ];
    run(&scene("hopper"), out.path(), &set).good();
    good_energy(out.path(), 0.02);
    let history = Table::read(&out.join("history.csv"));
    let scale = history.column("scale_force_z");
    let time = history.column("time");
    let early = time.iter().zip(&scale).filter(|(t, _)| **t < 0.12).all(|(_, f)| *f == 0.0);
    assert!(early, "nothing reaches the scale within the time of a fall of 0.15 m less a bead");
    assert!(scale.iter().any(|f| *f < -1e-3), "beads must have reached it");
    let hopper = history.column("hopper_force_z");
    assert!(hopper[0] < -0.05, "the cone carries the bed at the start: {}", hopper[0]);
    let frame = fs::read_to_string(out.join("frames/walls_00002.vtp")).unwrap();
    assert!(frame.contains("Polys"));
}

#[test]
fn drum_lifts_its_bed() {
    let out = Folder::new("drum");
    let set = ["grains.0.count=220", "deposition.max_time=0.2", "time.end=0.6", "output.frames=1"];
    run(&scene("drum"), out.path(), &set).good();
    good_energy(out.path(), 0.02);
    let history = Table::read(&out.join("history.csv"));
    let moment = history.column("drum_moment_y");
    let late = &moment[moment.len() / 2..];
    let mean = late.iter().sum::<f64>() / late.len() as f64;
    assert!(mean < -1e-3, "{mean}");
    let work = *history.column("work").last().unwrap();
    let all: f64 = moment.iter().sum::<f64>() / moment.len() as f64;
    assert!((work / (-all * 2.0 * 0.6) - 1.0).abs() < 0.2, "{work} against {all} N m times 1.2 rad");
}

#[test]
fn oedometer_follows_its_programme() {
    let out = Folder::new("servo");
    let set = [
        "grains.0.count=400",
        "walls.2.point=[0.0,0.0,0.05]",
        "walls.2.servo.history=[[0.0,1.0],[0.25,1.0],[0.27,0.5]]",
        "deposition.max_time=0.2",
        "deposition.level=0.044",
        "time.end=0.5",
        "output.frames=1",
    ];
    run(&scene("servo"), out.path(), &set).good();
    good_energy(out.path(), 0.05);
    let history = Table::read(&out.join("history.csv"));
    let (time, force) = (history.column("time"), history.column("plate_force_z"));
    let target = 0.5 * 2e4 * 0.00785398;
    for (t, f) in time.iter().zip(&force).filter(|(t, _)| **t > 0.35) {
        assert!((f / target - 1.0).abs() < 0.01, "{t}: {f} against {target}");
    }
    let (bottom, mould) = (history.column("bottom_force_z"), history.column("mould_force_z"));
    let last = force.len() - 1;
    let carried = -bottom[last] - mould[last];
    let grains = carried - target;
    assert!(
        grains > 0.0 && grains < 0.1 * target,
        "bottom and mould carry plate and grains: {carried} {target}"
    );
    assert!(history.column("plate_displacement_z")[last] < -1e-4);
}

#[test]
fn a_servo_follows_pulses() {
    let out = Folder::new("servo_pulses");
    let set = [
        "grains.0.count=400",
        "walls.2.point=[0.0,0.0,0.05]",
        "walls.2.servo.history=",
        "walls.2.servo.pulses={ peak = 3.0, frequency = 5.0, count = 2, start = 0.25 }",
        "deposition.max_time=0.2",
        "deposition.level=0.044",
        "time.end=0.75",
        "output.frames=1",
    ];
    run(&scene("servo"), out.path(), &set).good();
    let history = Table::read(&out.join("history.csv"));
    let (time, force) = (history.column("time"), history.column("plate_force_z"));
    let base = 2e4 * 0.00785398;
    let (rest, flank) = (0.01, 0.01);
    let expected = [
        (0.24, 1.0, rest),
        (0.30, 2.0, flank),
        (0.35, 3.0, rest),
        (0.45, 1.0, rest),
        (0.55, 3.0, rest),
        (0.74, 1.0, rest),
    ];
    for (at, factor, tolerance) in expected {
        let near: Vec<f64> =
            time.iter().zip(&force).filter(|(t, _)| (**t - at).abs() < 3e-3).map(|(_, f)| *f).collect();
        let mean = near.iter().sum::<f64>() / near.len() as f64;
        assert!((mean / (factor * base) - 1.0).abs() < tolerance, "{at}: {mean} against {}", factor * base);
    }
}

#[test]
fn displacement_control_follows_force() {
    let out = Folder::new("servo_driven");
    let set = [
        "grains.0.count=400",
        "walls.2.point=[0.0,0.0,0.05]",
        "walls.2.servo.history=",
        "walls.2.servo.displacement_control={ from = 0.3, speed = \"10 mm/s\" }",
        "deposition.max_time=0.2",
        "deposition.level=0.044",
        "time.end=0.4",
        "output.frames=1",
    ];
    run(&scene("servo"), out.path(), &set).good();
    let history = Table::read(&out.join("history.csv"));
    let (time, force) = (history.column("time"), history.column("plate_force_z"));
    let (target, travel) = (history.column("plate_target"), history.column("plate_displacement_z"));
    let at = |t: f64| time.iter().position(|x| *x >= t - 1e-9).unwrap();
    assert!((force[at(0.29)] / target[at(0.29)] - 1.0).abs() < 0.01, "{} {}", force[at(0.29)], target[0]);
    let speed = (travel[at(0.3)] - travel[at(0.39)]) / (time[at(0.39)] - time[at(0.3)]);
    assert!((speed / 0.01 - 1.0).abs() < 1e-3, "{speed}");
    assert!(force[at(0.39)] > 1.5 * target[at(0.29)], "the bed resists");
    let summary = json(&out.join("summary.json"));
    assert!(summary["loads"][0]["error"].as_f64().unwrap() < 0.02, "{}", summary["loads"]);
    assert!((summary["loads"][0]["target"]["mean"].as_f64().unwrap() / target[0] - 1.0).abs() < 1e-12);
}

#[test]
fn block_comes_to_rest() {
    let out = Folder::new("block");
    let set = [
        "grains.0.count=180",
        "deposition.max_time=0.25",
        "deposition.level=0.1",
        "time.end=0.8",
        "output.frames=2",
    ];
    run(&scene("block"), out.path(), &set).good();
    good_energy(out.path(), 0.02);
    let history = Table::read(&out.join("history.csv"));
    let (force, fall) = (history.column("block_force_z"), history.column("block_displacement_z"));
    let late = &force[4 * force.len() / 5..];
    let mean = late.iter().sum::<f64>() / late.len() as f64;
    assert!((mean / (1.2 * 9.81) - 1.0).abs() < 0.05, "{mean}");
    assert!(fall[0] == 0.0 && *fall.last().unwrap() < -0.01, "{fall:?}");
}

#[test]
fn mesh_from_a_file() {
    let folder = Folder::new("mesh_wall");
    let facet = |a: &str, b: &str, c: &str| {
        format!("facet normal 0 0 1\nouter loop\nvertex {a}\nvertex {b}\nvertex {c}\nendloop\nendfacet\n")
    };
    let (a, b, c, d) = ("-100 -100 0", "100 -100 0", "100 100 0", "-100 100 0");
    folder.write("plate.stl", &format!("solid plate\n{}{}endsolid plate\n", facet(a, b, c), facet(a, c, d)));
    folder.write("plate.obj", "v -100 -100 0\nv 100 -100 0\nv 100 100 0\nv -100 100 0\nf 1 2 3 4\n");
    folder.write("plate.dat", "4 2\n-100 -100 0\n100 -100 0\n100 100 0\n-100 100 0\n1 2 3\n1 3 4\n");
    for ending in ["stl", "obj", "dat"] {
        let text = format!(
            r#"
[[material]]
name = "stone"
density = 2600
stiffness = 1e5
friction = 0.5
restitution = 0.2
[[grains]]
name = "ball"
shape = "sphere"
material = "stone"
spheres = [[0.02, 0.01, 0.0601, 0.01]]
[[walls]]
name = "plate"
kind = "mesh"
material = "stone"
file = "plate.{ending}"
scale = 0.001
translation = [0.0, 0.0, 0.05]
record = true
[time]
end = 0.2
[output]
frames = 1
"#
        );
        let file = folder.write("scene.toml", &text);
        let out = folder.join(ending);
        run(&file, &out, &[]).good();
        let weight = 2600.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6 * 9.81;
        let force = *Table::read(&out.join("history.csv")).column("plate_force_z").last().unwrap();
        assert!((force / -weight - 1.0).abs() < 1e-6, "{ending}: {force} {weight}");
    }
}

#[test]
fn keys_of_motion_reach_the_engine() {
    let folder = Folder::new("wall_keys");
    let text = r#"
[[material]]
name = "stone"
density = 2600
stiffness = 1e5
friction = 0.5
restitution = 0.2
[[grains]]
name = "ball"
shape = "sphere"
material = "stone"
spheres = [[0.1, 0.0, 0.0101, 0.01], [1.0, 0.0, -0.0899, 0.01]]
[[walls]]
name = "table"
kind = "cone"
material = "stone"
base = [0.0, 0.0, 0.0]
height = 0.0
radii = [0.3, 0.0]
angular_velocity = [0.0, 0.0, 1.0]
oscillation = { amplitude = "0.1 mm", direction = [0, 0, 2], frequency = "20 Hz", phase = "90 deg" }
record = true
[[walls]]
name = "bowl"
kind = "sphere"
material = "stone"
base = [1.0, 0.0, 0.0]
radius = 0.1
velocity = [0.0, "10 mm/s", 0.0]
record = true
[time]
end = 0.1
[output]
frames = 1
history_interval = "5 ms"
"#;
    let file = folder.write("scene.toml", text);
    let out = folder.join("out");
    run(&file, &out, &[]).good();
    let history = Table::read(&out.join("history.csv"));
    let time = history.column("time");
    let (table, bowl) = (history.column("table_displacement_z"), history.column("bowl_displacement_y"));
    for ((t, z), y) in time.iter().zip(&table).zip(&bowl) {
        let swing = 1e-4 * ((std::f64::consts::TAU * 20.0 * t).cos() - 1.0);
        assert!((z - swing).abs() < 1e-10 && (y - 0.01 * t).abs() < 1e-10, "{t}: {z} {swing} {y}");
    }
    assert!(history.column("table_moment_z").iter().any(|m| *m < -1e-4), "the ball is dragged along");
    assert!(history.column("bowl_force_z").iter().any(|f| *f < -0.05));
}

#[test]
fn flow_goes_round_a_periodic_box() {
    let out = Folder::new("shear");
    let set = ["grains.1.count=150", "time.end=0.25", "output.frames=2", "output.packing=true"];
    run(&scene("shear"), out.path(), &set).good();
    good_energy(out.path(), 0.02);
    let packing = fs::read_to_string(out.join("packing_1.csv")).unwrap();
    let rows: Vec<Vec<f64>> =
        packing.lines().skip(1).map(|l| l.split(',').map(|f| f.parse().unwrap()).collect()).collect();
    assert_eq!(rows.len(), 150);
    for row in &rows {
        assert!((0.0..=0.06).contains(&row[0]) && (0.0..=0.03).contains(&row[1]), "{row:?}");
    }
}

#[test]
fn adhesion_holds_ball_on_ceiling() {
    let folder = Folder::new("adhesion");
    let weight = 2600.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6 * 9.81;
    for (share, holds) in [(1.02, true), (0.98, false)] {
        let work = share * weight / (2.0 * std::f64::consts::PI * 0.01);
        let text = format!(
            r#"
[[material]]
name = "stone"
density = 2600
stiffness = 1e5
friction = 0.5
restitution = 0.2
[[contact]]
between = ["stone", "stone"]
adhesion = "{} mJ/m2"
[[grains]]
name = "ball"
shape = "sphere"
material = "stone"
spheres = [[0.0, 0.0, -0.0099999999, 0.01]]
[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, -1]
material = "stone"
[time]
end = 0.1
[output]
frames = 1
packing = true
"#,
            work * 1e3
        );
        let file = folder.write("scene.toml", &text);
        let out = folder.join(if holds { "holds" } else { "falls" });
        run(&file, &out, &[]).good();
        let packing = fs::read_to_string(out.join("packing.csv")).unwrap();
        let z: f64 = packing.lines().nth(1).unwrap().split(',').nth(2).unwrap().parse().unwrap();
        assert!((z > -0.01) == holds, "{share}: {z}");
    }
}
