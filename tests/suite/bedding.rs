//! Seating of sleepers during compaction, and pouring around them.

use super::support::{Folder, Table, json, run};

/// Spheres in a box with a plate; `{stages}`: compaction.
const SCENE: &str = r#"title = "bedding"

[[material]]
name = "stone"
density = 2650
stiffness = "2 MN/m"
friction = 0.6
restitution = 0.3

[[grains]]
name = "bed"
shape = "sphere"
material = "stone"
count = 220
size = ["22 mm", "30 mm"]
fill = { low = [0, 0, 0], high = [0.3, 0.2] }
seed = 3

[[grains]]
name = "crib"
shape = "sphere"
material = "stone"
count = 60
size = ["22 mm", "30 mm"]
fill = { low = [0, 0, 0], high = [0.3, 0.05] }
seed = 4

[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "stone"

[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [1, 0, 0]
material = "stone"

[[walls]]
kind = "plane"
point = [0.3, 0, 0]
normal = [-1, 0, 0]
material = "stone"

[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
material = "stone"

[[walls]]
kind = "plane"
point = [0, 0.2, 0]
normal = [0, -1, 0]
material = "stone"

[deposition]
max_time = "0.5 s"
settled_speed = "10 mm/s"
local_damping = 0.2

{stages}

[track.sleeper]
size = [0.28, 0.12, 0.06]
mass = "5 kg"
material = "stone"
centre = [0.15, 0.12]
hold = ["x", "y", "rx", "ry", "rz"]

[track.load]
kind = "haversine"
minimum = "50 N"
maximum = "1 kN"
frequency = "20 Hz"
cycles = 2
rest = "20 ms"
ramp = "20 ms"

[output]
frames = 1
vtk = false
packing = true
"#;

const REGION: &str = "region = [[0.05, 0.05, 0.02], [0.25, 0.18, 0.08]]";

fn pouring() -> String {
    format!(
        "[[compaction]]\nkind = \"pouring\"\ngroups = [\"crib\"]\nlayers = 2\nlevel = \"0.16 m\"\nrest = \"0.3 s\"\n\
         local_damping = 0.2\n{REGION}\n"
    )
}

fn bedding(force: &str) -> String {
    format!(
        "[[compaction]]\nkind = \"bedding\"\nforce = \"{force}\"\nfrequency = \"20 Hz\"\ncycles = 3\n{REGION}\n"
    )
}

fn scene(stages: &[String]) -> String {
    SCENE.replace("{stages}", &stages.join("\n"))
}

fn heights(folder: &Folder, out: &str, group: usize) -> Vec<f64> {
    let file = folder.join(out).join(format!("packing_{group}.csv"));
    Table::read(&file).column("z")
}

#[test]
fn a_bedded_sleeper_has_seated() {
    let folder = Folder::new("bedded");
    let settled = |name: &str, stages: &[String]| {
        let file = folder.write("scene.toml", &scene(stages));
        run(&file, &folder.join(name), &["output.packing=false"]).good();
        let summary = json(&folder.join(name).join("summary.json"));
        let kinds: Vec<String> = summary["compaction"]
            .as_array()
            .unwrap()
            .iter()
            .map(|s| s["kind"].as_str().unwrap().to_string())
            .collect();
        assert_eq!(kinds.len(), stages.len());
        assert!(kinds.iter().all(|k| k == "bedding" || k == "pouring"), "{kinds:?}");
        Table::read(&folder.join(name).join("cycles.csv")).column("settlement")[1]
    };
    let loose = settled("loose", &[pouring()]);
    let pressed = settled("pressed", &[bedding("2 kN"), pouring(), bedding("2 kN")]);
    println!("settlement after two cycles: {loose:e} m set on the stones, {pressed:e} m bedded");
    assert!(loose > 1e-3 && pressed.abs() < 0.1 * loose, "{loose} {pressed}");
}

#[test]
fn poured_grains_lie_around_the_sleeper() {
    let folder = Folder::new("poured");
    let file = folder.write("scene.toml", &scene(&[bedding("2 kN"), pouring()]));
    run(&file, &folder.join("out"), &["track.load.cycles=1"]).good();
    let (bed, crib) = (heights(&folder, "out", 0), heights(&folder, "out", 1));
    assert_eq!(bed.len(), 220);
    assert!((10..60).contains(&crib.len()), "{} poured grains are left", crib.len());
    let mean = |z: &[f64]| z.iter().sum::<f64>() / z.len() as f64;
    println!("{} of 60 are left, mean heights {:.4} and {:.4} m", crib.len(), mean(&bed), mean(&crib));
    assert!(mean(&crib) > mean(&bed) + 0.02);
    assert!(crib.iter().all(|&z| z < 0.17), "{crib:?}");
}

#[test]
fn pouring_begins_without_energy() {
    let folder = Folder::new("poured_crushed");
    let soft = pouring().replace("local_damping", "stiffness_factor = 0.1\nlocal_damping");
    let corners = "young = \"50 MPa\"\npoisson = 0.2\ncorner_strength = \"2 MPa\"\ncorner_angle = \"70 deg\"";
    let text = scene(&[bedding("2 kN"), soft]).replace("stiffness = \"2 MN/m\"", corners);
    let file = folder.write("scene.toml", &text);
    run(&file, &folder.join("out"), &["track.load.cycles=1"]).good();
    let summary = json(&folder.join("out/summary.json"));
    let stages = summary["stage_energy"].as_array().unwrap();
    let springs: Vec<[f64; 2]> =
        stages.iter().map(|s| [0, 1].map(|k| s["springs"][k].as_f64().unwrap())).collect();
    println!("{springs:?}");
    assert!(stages.len() == 4 && springs[1][1] > 0.0, "{stages:?}");
    springs.iter().skip(1).for_each(|[start, _]| assert!(*start < 1e-6, "{springs:?}"));
}

#[test]
fn refusals() {
    let folder = Folder::new("bedding_refused");
    let cases = [
        (
            scene(&[pouring()]).replace("\"crib\"]", "\"cribs\"]"),
            "compaction.0.groups.0: found \"cribs\", expected the name of a group in [[grains]]",
        ),
        (
            scene(&[pouring(), pouring()]),
            "compaction.1.groups.0: found \"crib\", expected a group of grains that are not bonded, at rest, and that nothing \
             else lets in",
        ),
        (
            scene(&[pouring()]).replace("layers = 2", "layers = 0"),
            "compaction.0.layers: found 0, expected 1 to 1000",
        ),
        (scene(&[bedding("0 N")]), "compaction.0.force: found 0, expected above 0"),
        (
            scene(&[bedding("1 kN").replace("cycles = 3", "cycles = 3\nlevel = 1")]),
            "compaction.0.level: found, but it has no effect without `kind = \"pouring\"`",
        ),
    ];
    for (text, expected) in cases {
        let file = folder.write("scene.toml", &text);
        let refused = run(&file, &folder.join("out"), &[]);
        assert_eq!(refused.code, 2, "{}", refused.stderr);
        assert!(refused.stderr.contains(expected), "{}\n{expected}", refused.stderr);
        assert!(!folder.join("out").exists());
    }
    let text = scene(&[bedding("1 kN")]);
    let (head, rest) = text.split_at(text.find("[track.sleeper]").unwrap());
    let rest = &rest[rest.find("[output]").unwrap()..];
    let file = folder.write("scene.toml", &format!("{head}[time]\nend = 0.01\n\n{rest}"));
    let refused = run(&file, &folder.join("out"), &[]);
    assert!(
        refused.stderr.contains("compaction.0.kind: found \"bedding\", expected rigid sleepers"),
        "{}",
        refused.stderr
    );
}

#[test]
fn bedding_goes_on_bit_for_bit() {
    let folder = Folder::new("bedding_broken");
    let file = folder.write("scene.toml", &scene(&[bedding("2 kN"), pouring(), bedding("1 kN")]));
    let expected = ["cycles.csv", "packing_1.csv"];
    super::checkpoint::broken(&file, &["track.load.cycles=1"], &[0.2, 0.4, 0.6, 0.8, 0.95], &expected);
}
