//! Tamping by tines, stabilizing, compaction of a bed from another run.

use super::support::{Folder, Outcome, Table, json, run, scene_folder, trackbed};
use std::path::Path;

/// A blade presses a sphere against a fixed one, below a held sleeper; gap 0.07 m, both gaps of the sphere 5 mm.
const PRESSED: &str = r#"title = "Blade against a sphere"
gravity = [0, 0, 0]

[[material]]
name = "stone"
density = 2650
stiffness = "2 MN/m"
friction = 0.5
restitution = 0.5

[[grains]]
name = "pressed"
shape = "sphere"
material = "stone"
spheres = [[0.0, 0.085, -0.05, 0.03]]

[[walls]]
kind = "plane"
point = [0, 0, -0.2]
normal = [0, 0, 1]
material = "stone"

[[walls]]
kind = "sphere"
base = [0, 0.035, -0.05]
radius = 0.02
material = "stone"

[[compaction]]
kind = "tines"
frequency = "35 Hz"
rest = "5 ms"
region = [[-0.1, 0.05, -0.1], [0.1, 0.15, 0]]
tines = { size = [0.1, 0.02, 0.4], material = "stone", at = [0], lift = 0, depth = 0.1, gap = 0.07, travel = 0.0054, amplitude = 0, squeeze = 0.002 }

[track.sleeper]
size = [0.3, 0.1, 0.1]
mass = "50 kg"
material = "stone"
centre = [0, 0]
hold = ["x", "y", "z", "rx", "ry", "rz"]

[time]
end = "5 ms"
"#;

/// Two contacts in series: half their stiffness.
const SERIES: f64 = 1e6;

fn tamping(out: &Path) -> serde_json::Value {
    json(&out.join("summary.json"))["tamping"][0].clone()
}

#[test]
fn blades_press_by_their_travel_up_to_their_force() {
    let folder = scene_folder("tines", PRESSED);
    let (scene, out) = (folder.join("scene.toml"), folder.join("out"));
    run(&scene, &out, &[]).good();
    let free = tamping(&out);
    let force = free["squeeze_force"].as_f64().unwrap();
    assert!((force / (SERIES * 0.4e-3) - 1.0).abs() < 0.01, "{free}");
    assert_eq!(free["travel"].as_f64().unwrap(), 0.0054);
    // The blade that meets nothing closes by its travel.
    run(&scene, &out, &["compaction.0.tines.force=150"]).good();
    let limited = tamping(&out);
    let expected = 0.5 * (0.0054 + 0.005 + 150.0 / SERIES);
    assert!((limited["travel"].as_f64().unwrap() - expected).abs() < 2e-6, "{limited}");
    let force = limited["squeeze_force"].as_f64().unwrap();
    assert!((force / 150.0 - 1.0).abs() < 0.05, "{limited}");
}

#[test]
fn blades_between_the_walls_with_room_to_close() {
    let folder = scene_folder("tines_refused", PRESSED);
    let scene = folder.join("scene.toml");
    let refused = |set: &str, words: &str| {
        let said = run(&scene, &folder.join("none"), &[set]);
        assert!(said.code == 2 && said.stderr.contains(words), "{set}: {said:?}");
    };
    refused(
        "compaction.0.tines.travel=0.07",
        "tines.gap: found 0.07, expected more than `travel` and `amplitude`",
    );
    refused(
        "compaction.0.tines.at=[0.2]",
        "tines.at: found [0.2], expected at least one position, each within 0.100 m",
    );
    refused("compaction.0.tines.depth=0.35", "tines.depth: found 0.35, expected above 0, within the blades");
    refused("compaction.0.force=10", "compaction.0.force: found, but it has no effect without");
    refused("compaction.0.tines=", "compaction.0.tines: found nothing, expected the tines");
    refused(
        "track.sleeper={size=[0.3,0.1,0.1],mass=50,material=\"stone\",centre=[0,0],count=2,spacing=0.11}",
        "through sleeper 2",
    );
    refused("track=", "compaction.0.kind: found \"tines\", expected rigid sleepers ([track.sleeper])");
    refused(
        "walls.2={kind=\"plane\",point=[0,0.12,0],normal=[0,-1,0],material=\"stone\"}",
        "expected blades between walls and sleepers",
    );
}

/// Displacement and velocity of a free mass after the cycles: a = F w(t) sin 2πft/m, with the rise and fall w.
fn shaken([force, mass, frequency, cycles]: [f64; 4]) -> [f64; 2] {
    let steps = 400_000;
    let dt = cycles / frequency / f64::from(steps);
    let [mut x, mut v] = [0.0, 0.0];
    for k in 0..steps {
        let turns = (f64::from(k) + 0.5) * dt * frequency;
        let edge = (4.0 * turns.min(cycles - turns) / cycles).min(1.0);
        let share = (0.5 * std::f64::consts::PI * edge).sin().powi(2);
        v += force * share * (std::f64::consts::TAU * turns).sin() / mass * dt;
        x += v * dt;
    }
    [x, v]
}

/// Sleeper on a smooth plane.
#[test]
fn a_shaken_sleeper_moves_as_a_free_mass() {
    let stage = "[[compaction]]\nkind = \"stabilizing\"\nfrequency = 20\ncycles = 4\nforce = 1000\nsway = 500\nrest = \"1 ms\"\n\
        region = [[-0.1, -0.1, -0.1], [0.1, 0.1, 0]]\n\n[track.sleeper]";
    let begin = PRESSED.find("[[compaction]]").unwrap();
    let end = PRESSED.find("[track.sleeper]").unwrap();
    let text = [&PRESSED[..begin], stage, &PRESSED[end + "[track.sleeper]".len()..]].concat();
    let text = text
        .replace("gravity = [0, 0, 0]", "gravity = [0, 0, -9.81]")
        .replace("friction = 0.5", "friction = 0")
        .replace("hold = [\"x\", \"y\", \"z\"", "hold = [\"x\", \"y\"")
        .replace("point = [0, 0, -0.2]", "point = [0, 0, 0]")
        .replace("spheres = [[0.0, 0.085, -0.05, 0.03]]", "spheres = [[0.4, 0.4, 0.03, 0.03]]")
        .replace("base = [0, 0.035, -0.05]", "base = [0.4, -0.4, 0.02]");
    let folder = scene_folder("stabilizing", &text);
    let out = folder.join("out");
    run(&folder.join("scene.toml"), &out, &[]).good();
    let x = Table::read(&out.join("history.csv")).column("sleeper_x")[0];
    let [expected, speed] = shaken([500.0, 50.0, 20.0, 4.0]);
    let amplitude = 500.0 / (50.0 * (std::f64::consts::TAU * 20.0).powi(2));
    // The rest lasts at most a millisecond.
    assert!((x - expected).abs() < 0.002 * amplitude + 1e-3 * speed.abs(), "{x}, not {expected}");
    assert!(expected.abs() > 0.1 * amplitude, "{expected} tests nothing");
}

fn from(scene: &Path, out: &Path, before: &Path, set: &[&str]) -> Outcome {
    let mut words = vec!["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap(), "--from"];
    words.push(before.to_str().unwrap());
    let set: Vec<String> = set.iter().map(|s| format!("--set={s}")).collect();
    words.extend(set.iter().map(String::as_str));
    trackbed(words)
}

const BED: [&str; 8] = [
    "grains.0.count=150",
    "grains.1.count=60",
    "grains.2.count=20",
    "deposition.max_time=0.3",
    "compaction.0.rest=0.05",
    "compaction.1.rest=0.2",
    "compaction.2.cycles=1",
    "compaction.2.rest=0.05",
];
const REST: [&str; 3] = ["track.load=", "track.jump=", "time.end=0.01"];

#[test]
fn added_compaction_acts_on_the_bed_of_another_run() {
    let folder = Folder::new("reworked");
    let scene = super::support::repository().join("inputs/track/life/bay.toml");
    let first = folder.join("first");
    let common = [&BED[..], &REST].concat();
    run(&scene, &first, &common).good();
    let pressed = "compaction.3={kind=\"bedding\",force=30000,frequency=40,cycles=1,rest=0.05,region=[[0.1,0.1,0.01],[1.2,0.82,0.05]]}";
    let (second, third) = (folder.join("second"), folder.join("third"));
    from(&scene, &second, &first, &[&common[..], &[pressed]].concat()).good();
    let summary = json(&second.join("summary.json"));
    let stages: Vec<&str> =
        summary["stages"].as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(stages, ["compaction 4: bedding", "run"]);
    assert_eq!(
        summary["checks"].as_str().or(Some("")).unwrap_or(""),
        summary["checks"].as_str().unwrap_or("")
    );
    let height = |out: &Path| Table::read(&out.join("history.csv")).column("sleeper_z");
    let [before, after] = [height(&first), height(&second)];
    let settled = before.last().unwrap() - after[0];
    assert!(settled > 1e-4 && settled < 0.05, "{settled}");
    // Both runs have the same stages now: nothing is compacted again.
    from(&scene, &third, &second, &[&common[..], &[pressed]].concat()).good();
    assert_eq!(json(&third.join("summary.json"))["stages"].as_array().unwrap().len(), 1);
    // A stage of the earlier run stays as it was.
    let changed =
        from(&scene, &folder.join("none"), &second, &[&common[..], &["compaction.3.force=1"]].concat());
    assert!(changed.code == 2 && !folder.join("none").exists(), "{changed:?}");
}

#[test]
fn a_held_sleeper_is_freed_by_the_next_run() {
    let folder = Folder::new("freed");
    let scene = super::support::repository().join("inputs/track/life/bay.toml");
    let (first, pushed) = (folder.join("first"), folder.join("pushed"));
    run(&scene, &first, &[&BED[..], &REST].concat()).good();
    let push = [
        "track.load=",
        "track.jump=",
        "track.push={direction=[1,0],speed=0.05,displacement=0.003,rest=0.01}",
        "track.sleeper.hold=[\"y\",\"rx\",\"ry\",\"rz\"]",
    ];
    from(&scene, &pushed, &first, &[&BED[..], &push].concat()).good();
    let force = json(&pushed.join("summary.json"))["push"]["peak"].as_f64().unwrap();
    assert!(force > 50.0 && force < 5e3, "{force}");
    let x = Table::read(&pushed.join("history.csv")).column("sleeper_x");
    assert!(x.last().unwrap() - x[0] > 1e-3, "{} {}", x[0], x[x.len() - 1]);
}

/// A group in prescribed motion stands still while the bed is packed.
#[test]
fn prescribed_grains_do_not_fall_during_compaction() {
    let held = "[[grains]]\nname = \"held\"\nshape = \"sphere\"\nmaterial = \"stone\"\nspheres = [[0.4, 0.4, 0.5, 0.03]]\n\
        prescribed_velocity = [0, 0, 0]\n\n[[probe]]\nname = \"held\"\ngrain = 1\n\n[[walls]]";
    let text =
        PRESSED.replace("gravity = [0, 0, 0]", "gravity = [0, 0, -9.81]").replacen("[[walls]]", held, 1);
    let folder = scene_folder("gripped", &text);
    let out = folder.join("out");
    run(&folder.join("scene.toml"), &out, &[]).good();
    assert_eq!(Table::read(&out.join("history.csv")).column("held_z")[0], 0.5);
}
