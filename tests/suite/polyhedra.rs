//! Polyhedra: pouring, tamping, flow, track, rejected input.

use super::determinism::same_bits_on;
use super::scenes::vtk;
use super::support::{Folder, json, repository, run, trackbed};
use std::path::PathBuf;

const POURED: &str = r#"title = "Polyhedra poured and tamped"

[[material]]
name = "stone"
density = "2650 kg/m3"
stiffness = "3 MN/m"
tangential_ratio = 0.5
friction = 0.6
restitution = 0.4

[[grains]]
name = "bed"
shape = "polyhedron"
library = "LIBRARY"
material = "stone"
count = 14
size = ["60 mm", "70 mm"]
fill = { low = [0.0, 0.0, 0.0], high = [0.2, 0.2] }
seed = 2

[[grains]]
name = "more"
shape = "polyhedron"
library = "LIBRARY"
material = "stone"
count = 8
size = ["60 mm", "70 mm"]
fill = { low = [0.0, 0.0, 0.0], high = [0.2, 0.2] }
seed = 3

[[walls]]
kind = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
material = "stone"

[[walls]]
kind = "plane"
point = [0.0, 0.0, 0.0]
normal = [1.0, 0.0, 0.0]
material = "stone"

[[walls]]
kind = "plane"
point = [0.2, 0.0, 0.0]
normal = [-1.0, 0.0, 0.0]
material = "stone"

[[walls]]
kind = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 1.0, 0.0]
material = "stone"

[[walls]]
kind = "plane"
point = [0.0, 0.2, 0.0]
normal = [0.0, -1.0, 0.0]
material = "stone"

[deposition]
max_time = "0.3 s"
settled_speed = "20 mm/s"
local_damping = 0.2

[[compaction]]
kind = "pouring"
groups = ["more"]
rest = "0.2 s"
local_damping = 0.2
region = [[0.03, 0.03, 0.02], [0.17, 0.17, 0.1]]

[[compaction]]
kind = "tamping"
plate = { size = [0.15, 0.15, 0.03], mass = "10 kg", material = "stone" }
force = "1 kN"
frequency = "40 Hz"
cycles = 2
at = [[0.1, 0.1]]
rest = "0.1 s"
local_damping = 0.2
region = [[0.03, 0.03, 0.02], [0.17, 0.17, 0.1]]

[time]
end = "10 ms"

[output]
frames = 1
"#;

fn written(name: &str, text: &str) -> (Folder, PathBuf) {
    let folder = Folder::new(name);
    let library = repository().join("inputs/data/polyhedra.toml");
    let scene = folder.write("scene.toml", &text.replace("LIBRARY", &library.display().to_string()));
    (folder, scene)
}

#[test]
fn polyhedra_are_poured_and_tamped() {
    let (folder, scene) = written("polyhedra_poured", POURED);
    run(&scene, &folder.join("out"), &[]).good();
    let summary = json(&folder.join("out/summary.json"));
    assert_eq!(summary["verdict"]["outcome"], "passed");
    let stages = summary["compaction"].as_array().unwrap();
    let names: Vec<_> = stages.iter().map(|s| s["kind"].as_str().unwrap()).collect();
    assert_eq!(names, ["pouring", "tamping"]);
    for stage in stages {
        let porosity = |k: &str| stage[k].as_f64().unwrap();
        assert!(porosity("porosity_after") < porosity("porosity_before"), "{stage}");
    }
    assert!(summary["energy"]["relative_error"].as_f64().unwrap().abs() < 1e-3);
}

const FLYING: &str = r#"title = "Two stones fly"
gravity = [0, 0, 0]

[[material]]
name = "stone"
density = 2650
stiffness = "3 MN/m"
friction = 0.6
restitution = 0.4

[[grains]]
name = "slow"
shape = "polyhedron"
library = "LIBRARY"
material = "stone"
packing = "slow.csv"
velocity = [1.0, 2.0, 2.0]
spin = [0.0, 0.0, 5.0]

[[grains]]
name = "fast"
shape = "polyhedron"
library = "LIBRARY"
material = "stone"
packing = "fast.csv"
velocity = [0.0, 0.0, 9.0]

[[walls]]
kind = "plane"
point = [0.0, 0.0, -1.0]
normal = [0.0, 0.0, 1.0]
material = "stone"

[time]
end = "1 ms"

[output]
frames = 1
"#;

#[test]
fn frames_have_the_fields_of_polyhedra() {
    let (folder, scene) = written("polyhedra_fields", FLYING);
    for (name, x) in [("slow.csv", -0.1), ("fast.csv", 0.1)] {
        folder.write(name, &format!("{x}, 0, 0, 1, 0, 0, 0, 0.03, 0\n"));
    }
    let out = folder.join("out");
    run(&scene, &out, &[]).good();
    let (_, _, cells) = vtk(&out.join("frames/walls_00000.vtp"));
    let field =
        |name: &str| cells.get(name).unwrap_or_else(|| panic!("no {name} in {:?}", cells.keys())).clone();
    let (kind, part, velocity, spin) = (field("kind"), field("part"), field("velocity"), field("spin"));
    assert_eq!(
        (velocity.0, spin.0, field("force").0, field("mean_stress").0, field("coordination").0),
        (3, 3, 3, 1, 1)
    );
    let mut seen = [0; 3];
    for (k, own) in kind.1.iter().enumerate() {
        let apart = |of: &(usize, Vec<f64>), own: [f64; 3]| {
            (0..3).map(|d| (of.1[3 * k + d] - own[d]).abs()).fold(0.0, f64::max)
        };
        let expected = match (*own as u32, part.1[k] as u32) {
            (4, 0) => ([1.0, 2.0, 2.0], [0.0, 0.0, 5.0], 0),
            (4, 1) => ([0.0, 0.0, 9.0], [0.0; 3], 1),
            _ => ([0.0; 3], [0.0; 3], 2),
        };
        seen[expected.2] += 1;
        assert!(apart(&velocity, expected.0) < 1e-12 && apart(&spin, expected.1) < 1e-9, "polygon {k}");
    }
    assert!(seen[0] > 8 && seen[1] > 8 && seen[2] == 1, "{seen:?}");
    // 3 and 9 m/s are the limits of the colour scale: dark violet and yellow.
    let picture = |more: &[&str]| {
        let file = folder.join("picture.bmp");
        let view = [
            "--view",
            "front",
            "--hide",
            "caption,axes,scale,legends,edges,boundary",
            "--size",
            "200x100",
            "--force",
        ];
        let own = ["render", out.to_str().unwrap(), "--out", file.to_str().unwrap()];
        trackbed(own.iter().chain(&view).chain(more)).good();
        let pixels = super::render::files::Pixels::read(&file);
        let of = |like: &dyn Fn([u8; 3]) -> bool| {
            (0..200)
                .flat_map(|x| (0..100).map(move |y| (x, y)))
                .filter(|(x, y)| like(pixels.at(*x, *y)))
                .count()
        };
        // Violet: hardly any green; yellow: hardly any blue.
        [of(&|[r, g, b]| g < r / 2 && g < b / 2), of(&|[r, g, b]| b < r / 2 && b < g / 2)]
    };
    let [plain, coloured] = [picture(&[]), picture(&["--field", "grains=speed"])];
    let groups = picture(&["--field", "part"]);
    println!("violet and yellow pixels: {plain:?}, by speed {coloured:?}, by group {groups:?}");
    assert!(
        plain == [0, 0] && coloured.iter().all(|n| *n > 100) && groups != plain,
        "{plain:?} {coloured:?} {groups:?}"
    );
    run(&scene, &folder.join("few"), &["output.fields=[\"spin\"]"]).good();
    let (_, _, few) = vtk(&folder.join("few/frames/walls_00001.vtp"));
    let names: Vec<_> = few.keys().map(String::as_str).collect();
    assert_eq!(names, ["body", "centre", "id", "kind", "part", "spin"]);
}

/// A stone after 0.16 m in a box of 0.24 m is drawn at −0.08 m, as spheres and contacts.
#[test]
fn frames_wrap_stones() {
    let end = "\n[periodic]\ny = [-0.12, 0.12]\n\n[time]\nend = \"80 ms\"\n";
    let text = FLYING.replace("spin = [0.0, 0.0, 5.0]\n", "").replace("\n[time]\nend = \"1 ms\"\n", end);
    let (folder, scene) = written("polyhedra_wrapped", &text);
    for (name, x) in [("slow.csv", -0.1), ("fast.csv", 0.1)] {
        folder.write(name, &format!("{x}, 0, 0, 1, 0, 0, 0, 0.03, 0\n"));
    }
    let out = folder.join("out");
    run(&scene, &out, &[]).good();
    let (points, _, cells) = vtk(&out.join("frames/walls_00001.vtp"));
    let (body, centre) = (&cells["body"].1, &cells["centre"].1);
    let slow = body.iter().position(|b| *b == 0.0).unwrap();
    assert!((centre[3 * slow + 1] + 0.08).abs() < 1e-6, "{:?}", &centre[3 * slow..3 * slow + 3]);
    // The stone of x = −0.1 + 0.08 m and size 0.06 m; the plane is larger.
    let near = |k: &usize| (points[3 * k] + 0.02).abs() < 0.035 && points[3 * k + 2].abs() < 0.3;
    let heights: Vec<f64> = (0..points.len() / 3).filter(near).map(|k| points[3 * k + 1]).collect();
    assert!(heights.len() > 8 && heights.iter().all(|y| (y + 0.08).abs() < 0.04), "{heights:?}");
}

/// Rigid-body motion: v − v' = ω × (x − x').
#[test]
fn spheres_of_clumps_rotate() {
    let library = repository().join("inputs/data/clumps_six.toml").display().to_string();
    let text = FLYING.replace("\"polyhedron\"", "\"clump\"").replace("LIBRARY", &library);
    let (folder, scene) = written("spinning_clump", &text);
    folder.write("slow.csv", "0, 0, 0, 1, 0, 0, 0, 0.03, 0\n");
    folder.write("fast.csv", "0.2, 0, 0, 1, 0, 0, 0, 0.03, 0\n");
    run(&scene, &folder.join("out"), &[]).good();
    let (points, fields, _) = vtk(&folder.join("out/frames/grains_00000.vtp"));
    let vector = |of: &[f64], k: usize| [0, 1, 2].map(|d| of[3 * k + d]);
    let mut pairs = 0;
    let spheres: Vec<usize> = (0..points.len() / 3).filter(|&k| fields["part"].1[k] == 0.0).collect();
    for &k in &spheres[1..] {
        let apart = |of: &[f64]| {
            let (a, b) = (vector(of, spheres[0]), vector(of, k));
            [0, 1, 2].map(|d| b[d] - a[d])
        };
        let (x, v) = (apart(&points), apart(&fields["velocity"].1));
        let expected = [-5.0 * x[1], 5.0 * x[0], 0.0];
        assert!((0..3).all(|d| (v[d] - expected[d]).abs() < 1e-9), "{v:?}, expected {expected:?}");
        pairs += usize::from(v[0].hypot(v[1]) > 1e-2);
    }
    assert!(pairs > 2, "{} spheres, {pairs} of them apart", spheres.len());
}

#[test]
fn a_small_track_of_polyhedra() {
    let scene = repository().join("inputs/track/polyhedra/scene.toml");
    let folder = Folder::new("track_polyhedra");
    let set = [
        "grains.0.count=40",
        "deposition.max_time=0.1",
        "compaction.0.cycles=1",
        "compaction.0.force=2000",
        "compaction.0.rest=0.005",
        "track.load.cycles=1",
        "track.load.frequency=\"100 Hz\"",
        "track.load.maximum=\"20 kN\"",
        "track.load.rest=0.002",
        "track.load.ramp=0.002",
        "output.frames=2",
    ];
    run(&scene, &folder.join("out"), &set).good();
    let summary = json(&folder.join("out/summary.json"));
    let at = |path: &str| summary.pointer(path).and_then(serde_json::Value::as_f64).unwrap_or(f64::NAN);
    let (energy, force, moment) =
        (at("/energy/relative_error"), at("/coupling/transfer/force"), at("/coupling/transfer/moment"));
    println!("energy {energy:.1e}, force {force:.1e}, moment {moment:.1e}");
    assert!(energy.abs() < 5e-3 && force < 1e-11 && moment < 1e-11, "{energy} {force} {moment}");
    assert!(at("/coupling/transfer/exchanges") > 100.0);
    assert_eq!(summary["verdict"]["outcome"], "passed");
}

const BELT: &str = r#"title = "Stones on a belt"

[[material]]
name = "stone"
density = "2650 kg/m3"
stiffness = "1 MN/m"
tangential_ratio = 0.5
friction = 0.6
restitution = 0.4

[[grains]]
name = "stones"
shape = "polyhedron"
library = "LIBRARY"
material = "stone"
count = 20
size = ["40 mm", "50 mm"]
inlet = { box = [[0.0, 0.0, 0.16], [0.2, 0.2, 0.28]], grains_per_second = 40, velocity = [0, 0, -0.5] }

[[grains]]
name = "plates"
shape = "disk"
aspect = 0.4
material = "stone"
count = 8
size = ["40 mm", "50 mm"]
inlet = { box = [[0.0, 0.0, 0.3], [0.2, 0.2, 0.4]], grains_per_second = 20, velocity = [0, 0, -0.5] }

[[outlet]]
name = "end"
point = [0.35, 0.0, 0.0]
normal = [1.0, 0.0, 0.0]
recycle = true

[[walls]]
name = "belt"
kind = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
material = "stone"
velocity = ["0.8 m/s", 0, 0]

[[walls]]
kind = "plane"
point = [-0.02, 0.0, 0.0]
normal = [1.0, 0.0, 0.0]
material = "stone"

[time]
end = "1.2 s"

[output]
frames = 2
history_interval = "0.1 s"
"#;

#[test]
fn polyhedra_and_disks_come_and_go() {
    let (_folder, scene) = written("polyhedra_belt", BELT);
    let results = same_bits_on(["1", "3"], &scene, &[], &["history.csv", "frames/walls_00002.vtp"]);
    let summary = json(&results.join("1/summary.json"));
    let number = |path: &str| summary.pointer(path).and_then(serde_json::Value::as_f64).unwrap_or(f64::NAN);
    let (came, went) = (number("/flow/inserted/grains"), number("/flow/removed/grains"));
    let (stones, plates) = (number("/flow/inlets/0/amount/grains"), number("/flow/inlets/1/amount/grains"));
    let (energy, momentum) = (number("/energy/relative_error"), number("/momentum/linear"));
    println!(
        "{came} came ({stones} stones, {plates} plates), {went} went; account off by {energy:.1e}, momentum {momentum:.1e}"
    );
    assert!(stones > 20.0 && plates > 8.0 && came == stones + plates && went > 0.0 && went < came);
    assert!(energy.abs() < 5e-3, "{energy}");
    assert_eq!(summary["verdict"]["outcome"], "passed");
}

/// Polyhedra need flat facets; stiffened coupling needs spheres.
#[test]
fn refusals() {
    let scene = repository().join("inputs/track/polyhedra/scene.toml");
    let folder = Folder::new("polyhedra_refusals");
    for (set, expected) in [
        (
            "coupling.faces=\"curved\"",
            "coupling.faces: found \"curved\" with polyhedra, expected \"flat\". Polyhedra contact",
        ),
        (
            "coupling.scheme=\"stiffened\"",
            "coupling.scheme: found \"stiffened\" with polyhedra, expected \"predicted\"",
        ),
    ] {
        let outcome = run(&scene, &folder.join("out"), &[set]);
        assert!(outcome.code == 2 && outcome.stderr.contains(expected), "{set}: {}", outcome.stderr);
    }
}
