//! Additional output: grain probes, fine intervals, strains, plastic state.

use super::support::{Folder, Table, json, run, trackbed};
use std::fs;
use std::path::Path;
use vtkio::model::{Attribute, DataSet};

const FALL: &str = r#"gravity = [0, 0, -10]
[[material]]
name = "rock"
density = 2600
stiffness = 1e5
friction = 0.5
restitution = 0.5
[[grains]]
name = "pair"
shape = "sphere"
material = "rock"
spheres = [[0, 0, 1, 0.01], [0, 0, 2, 0.02]]
[[probe]]
grain = 1
[[probe]]
group = "pair"
[[probe]]
name = "low"
region = [[-1, -1, 0], [1, 1, 1.5]]
[time]
end = 0.2
[output]
frames = 2
last = { time = 0.05, frames = 5 }
fields = ["acceleration", "displacement"]
"#;

#[test]
fn falling_spheres_are_observed() {
    let folder = Folder::new("observed");
    let file = folder.write("scene.toml", FALL);
    run(&file, &folder.join("r"), &[]).good();
    let table = Table::read(&folder.join("r/history.csv"));
    let last = |name: &str| *table.column(name).last().unwrap();
    let time = last("time");
    let fall = 5.0 * time * time;
    assert!((last("grain1_x_z") - (2.0 - fall)).abs() < 1e-9, "{}", last("grain1_x_z"));
    // Mid-step velocities.
    assert!((last("grain1_v_z") + 10.0 * time).abs() < 10.0 * 2e-3, "{}", last("grain1_v_z"));
    // Mass ratio 1:8.
    assert!((last("pair_x_z") - (17.0 / 9.0 - fall)).abs() < 1e-9, "{}", last("pair_x_z"));
    assert_eq!((last("pair_grains"), last("low_grains")), (2.0, 1.0));
    assert!((last("low_x_z") - (1.0 - fall)).abs() < 1e-9);
    let list = fs::read_to_string(folder.join("r/results.pvd")).unwrap();
    let times: Vec<f64> = list
        .lines()
        .filter(|l| l.contains("grains_"))
        .map(|l| l.split("timestep=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap())
        .collect();
    let expected = [0.0, 0.075, 0.15, 0.16, 0.17, 0.18, 0.19, 0.2];
    assert_eq!(times.len(), expected.len(), "{times:?}");
    for (t, e) in times.iter().zip(expected) {
        assert!((t - e).abs() < 2e-3, "{times:?}");
    }
    let frame = folder.join("r/frames/grains_00007.vtp");
    let a = points(&frame, "acceleration");
    assert_eq!(a, [0.0, 0.0, -10.0, 0.0, 0.0, -10.0]);
    assert!((points(&frame, "displacement")[2] + fall).abs() < 1e-9);
    for (set, sentence) in [
        ("probe.0.node=1", "probe.0.node: found together with `grain`, expected only one of them"),
        ("probe.0.grain=2", "probe.0.grain: found 2, expected the number of a grain, 0 to 1"),
        ("probe.1.group=\"x\"", "probe.1.group: found \"x\", expected the name of a [[grains]]: pair"),
        ("output.last.time=0.2", "output.last.time: found 0.2, expected above 0, below the end at 0.2 s"),
        ("output.last.frames=0", "output.last.frames: found 0, expected 1 or more"),
        ("output.fields=[\"strain\"]", "output.fields.0: found \"strain\", expected one of acceleration"),
    ] {
        let outcome = trackbed(["check", &file.display().to_string(), "--set", set]);
        assert_eq!(outcome.code, 2, "{set}: {outcome:?}");
        assert!(outcome.stderr.contains(sentence), "{sentence}\n{}", outcome.stderr);
    }
}

fn points(file: &Path, name: &str) -> Vec<f64> {
    let data = match vtkio::Vtk::import(file).unwrap().data {
        DataSet::PolyData { mut pieces, .. } => pieces.remove(0).into_loaded_piece_data(None).unwrap().data,
        DataSet::UnstructuredGrid { mut pieces, .. } => {
            pieces.remove(0).into_loaded_piece_data(None).unwrap().data
        }
        other => panic!("{other:?}"),
    };
    let found = data.point.into_iter().find_map(|a| match a {
        Attribute::DataArray(a) if a.name == name => a.data.cast_into::<f64>(),
        _ => None,
    });
    found.unwrap_or_else(|| panic!("no {name} in {}", file.display()))
}

const COLUMN: &str = r#"gravity = [0, 0, 0]
[solid]
block = { x = { lines = [0, 1], counts = [1] }, y = { lines = [0, 1], counts = [1] }, z = { lines = [0, 1], counts = [2] } }
[[solid.material]]
id = 1
model = "von_mises"
young = 1e6
poisson = 0.25
density = 1000
yield_stress = 1e3
hardening = 1e5
[[solid.support]]
side = "z-"
directions = ["z"]
[[solid.support]]
side = "x-"
directions = ["x"]
[[solid.support]]
side = "y-"
directions = ["y"]
[[solid.support]]
side = "z+"
directions = ["z"]
displacement = 0.01
history = { kind = "ramp", duration = 1.0 }
[solid.quasi_static]
[time]
end = 1.0
solid_step = 0.1
[output]
frames = 1
fields = ["strain", "plastic_strain"]
"#;

/// 1 % elongation, E = 1 MPa, yield stress 1 kPa, H = 0.1 MPa: plastic strain (E ε − σ_y)/(E + H), total
/// lateral strain −ν σ/E − ε_p/2.
#[test]
fn strains_of_a_bar_that_yields() {
    let folder = Folder::new("bar");
    let file = folder.write("scene.toml", COLUMN);
    run(&file, &folder.join("r"), &[]).good();
    let frame = folder.join("r/frames/solid_00001.vtu");
    let (strain, plastic) = (points(&frame, "strain"), points(&frame, "plastic_strain"));
    let expected = (1e6 * 0.01 - 1e3) / (1e6 + 1e5);
    let stress = 1e6 * (0.01 - expected);
    let across = -0.25 * stress / 1e6 - 0.5 * expected;
    for (s, p) in strain.chunks(9).zip(plastic.chunks(9)) {
        assert!(
            (s[8] - 0.01).abs() < 1e-7 && (s[0] - across).abs() < 1e-7 && s[1].abs() < 1e-9,
            "{s:?} {across}"
        );
        assert!((p[8] - expected).abs() < 1e-7 && (p[4] + 0.5 * expected).abs() < 1e-7, "{p:?} {expected}");
    }
    let solid = &json(&folder.join("r/summary.json"))["plastic"];
    assert_eq!(solid["yielded_share"], 1.0);
    assert!((solid["largest_plastic_strain"].as_f64().unwrap() - expected).abs() < 1e-7, "{solid}");
}

#[test]
fn steps_are_counted() {
    let folder = Folder::new("steps");
    let grains = folder.write("grains.toml", &FALL.replace("last = { time = 0.05, frames = 5 }\n", ""));
    let step = ["time.end=", "time.steps=1000", "time.grain_step=\"30 us\""];
    let every = ["output.frames=", "output.frame_steps=250", "output.history_steps=125"];
    run(&grains, &folder.join("g"), &[&step[..], &every].concat()).good();
    let summary = json(&folder.join("g/summary.json"));
    assert_eq!(summary["stages"][0]["grain_steps"], 1000, "{}", summary["stages"]);
    let rows = Table::read(&folder.join("g/history.csv")).column("time");
    assert_eq!(rows.len(), 9);
    for (k, t) in rows.iter().enumerate() {
        assert!((t - k as f64 * 125.0 * 30e-6).abs() < 1e-12, "{rows:?}");
    }
    let frames = |out: &str| fs::read_dir(folder.join(out).join("frames")).unwrap().count();
    assert!(frames("g") == 5 || frames("g") == 10, "{}", frames("g"));
    let refused = |set: &[&str], sentence: &str| {
        let outcome = run(&grains, &folder.join("bad"), set);
        assert!(outcome.code == 2 && outcome.stderr.contains(sentence), "{outcome:?}");
    };
    refused(
        &step[..2],
        "time.grain_step: found nothing, expected a step that stays the same, since time.steps counts steps",
    );
    refused(&step[1..], "time.steps: found together with `end`, expected only one of them");
    refused(
        &["output.frame_steps=3"],
        "output.frame_steps: found together with the key for times or numbers",
    );
    refused(&["time.steps=0", step[0], step[2]], "time.steps: found 0, expected 1 to");
    let block = "[solid]\ngravity = false\n[solid.block]\nx = { lines = [0.0, 1.0], counts = [1] }\ny = { lines = [0.0, 1.0], counts = [1] }\n\
        z = { lines = [0.0, 1.0], counts = [2] }\n[solid.dynamics]\n[[solid.support]]\nside = \"z-\"\ndirections = [\"x\", \"y\", \"z\"]\n\
        [[solid.material]]\nid = 1\nname = \"soil\"\nyoung = \"50 MPa\"\npoisson = 0.3\ndensity = 1900\n[time]\nsolid_step = \"0.7 ms\"\nsteps = 49\n\
        [output]\nframe_steps = 7\nhistory_steps = 7\n";
    let solid = folder.write("solid.toml", block);
    run(&solid, &folder.join("s"), &[]).good();
    let summary = json(&folder.join("s/summary.json"));
    assert_eq!(summary["stages"][0]["solid_steps"], 49, "{}", summary["stages"]);
    assert_eq!((frames("s"), Table::read(&folder.join("s/history.csv")).column("time").len()), (8, 8));
}
