//! Fields at points, areas and boxes as curves.

use super::checkpoint::broken;
use super::scenes::vtk;
use super::support::{COUPLED, Folder, GRAINS, Table, json, run, scene_folder, trackbed};
use std::fs;
use std::path::Path;

/// Column 1 m × 1 m × 4 m under 100 kPa on smooth supports.
const COLUMN: &str = r#"title = "column"

[solid]
gravity = false

[solid.block]
x = { lines = [0.0, 1.0], counts = [2] }
y = { lines = [0.0, 1.0], counts = [1] }
z = { lines = [0.0, 4.0], counts = [4] }

[[solid.material]]
id = 1
name = "soil"
young = "20 MPa"
poisson = 0.3
density = 1900

[[solid.support]]
name = "base"
side = "z-"
directions = ["z"]

[[solid.support]]
side = "x-"
directions = ["x"]

[[solid.support]]
side = "y-"
directions = ["y"]

[[solid.load]]
kind = "pressure"
side = "z+"
pressure = "100 kPa"
history = { kind = "ramp", duration = 1.0 }

[solid.quasi_static]

[time]
end = 1.0
solid_step = 0.25

[[probe]]
name = "a"
at = [0.3, 0.7, 1.3]
fields = ["displacement", "velocity", "acceleration", "stress", "strain"]

[[probe]]
box = [[0.0, 0.0, 0.0], [1.0, 1.0, 2.0]]

[[probe]]
plane = [[0.1, 0.1, 2.5], [0.9, 0.9, 2.5]]

[output]
frames = 1
history_interval = 0.25
"#;

/// Elastic, and with stresses kept at integration points.
const MODELS: [&str; 2] =
    ["", "model = \"mohr_coulomb\"\ncohesion = \"10 MPa\"\nfriction = 0.4\ndilation = 0.4\n"];

#[test]
fn uniform_stress_is_exact() {
    let folder = Folder::new("curve");
    for model in MODELS {
        let text = COLUMN.replace("name = \"soil\"\n", &format!("name = \"soil\"\n{model}"));
        run(&folder.write("scene.toml", &text), &folder.join("r"), &[]).good();
        let table = Table::read(&folder.join("r/history.csv"));
        for (k, time) in table.column("time").into_iter().enumerate() {
            let (p, young) = (100e3 * time, 20e6);
            let near = |name: &str, expected: f64, scale: f64| {
                let found = table.column(name)[k];
                assert!((found - expected).abs() <= 1e-9 * scale, "{name} at {time}: {found}, {expected}");
            };
            for (name, part) in
                [("xx", 0.0), ("yy", 0.0), ("zz", -1.0), ("xy", 0.0), ("yz", 0.0), ("zx", 0.0)]
            {
                near(&format!("a_stress_{name}"), part * p, 100e3);
            }
            for (name, part) in
                [("xx", 0.3), ("yy", 0.3), ("zz", -1.0), ("xy", 0.0), ("yz", 0.0), ("zx", 0.0)]
            {
                near(&format!("a_strain_{name}"), part * p / young, 5e-3);
            }
            near("a_u_z", -1.3 * p / young, 5e-3);
            near("a_u_x", 0.3 * 0.3 * p / young, 5e-3);
            for name in ["box_vertical_stress", "box_vertical_stress_largest"] {
                near(name, -table.column("base_reaction_z")[k], 100e3);
            }
            for name in ["box_mean_stress", "box_mean_stress_largest"] {
                near(name, -p / 3.0, 100e3);
            }
            near("plane_vertical_stress", -p, 100e3);
            near("plane_vertical_stress_largest", -p, 100e3);
        }
    }
}

/// Five points along the axis of the column.
#[test]
fn line_has_equally_spaced_points() {
    let folder = Folder::new("line");
    let line = "[[probe]]\nname = \"axis\"\nline = [[0.5, 0.5, 0.0], [0.5, 0.5, 4.0]]\npoints = 5\nfields = [\"displacement\", \"stress\"]\n\n[output]";
    run(&folder.write("scene.toml", &COLUMN.replace("[output]", line)), &folder.join("r"), &[]).good();
    let table = Table::read(&folder.join("r/history.csv"));
    let last = |name: &str| table.column(name).pop().unwrap();
    for k in 1..=5 {
        let (u, stress) = (last(&format!("axis_{k}_u_z")), last(&format!("axis_{k}_stress_zz")));
        let expected = -f64::from(k - 1) * 100e3 / 20e6;
        assert!((u - expected).abs() < 1e-9 && (stress + 100e3).abs() < 1e-3, "{k}: {u} {stress}");
    }
    assert!(!table.heads.iter().any(|head| head == "axis_6_u_z" || head == "axis_u_z"));
}

/// Cantilever 2 m × 0.2 m × 0.2 m, 400 N at its end: 12 F (L − x) (z − h/2)/(b h³) to 1 %.
#[test]
fn bending_stress_matches_beam_theory() {
    let beam = r#"[solid]
gravity = false

[solid.block]
x = { lines = [0.0, 2.0], counts = [10] }
y = { lines = [0.0, 0.2], counts = [2] }
z = { lines = [0.0, 0.2], counts = [2] }

[[solid.material]]
id = 1
name = "steel"
young = "210 GPa"
poisson = 0.0
density = 7800

[[solid.support]]
side = "x-"
directions = ["x", "y", "z"]

[[solid.load]]
kind = "traction"
side = "x+"
traction = [0, 0, "-10 kPa"]

[solid.quasi_static]

[time]
end = 1.0
solid_step = 1.0

[[probe]]
name = "upper"
at = [1.03, 0.08, 0.15]
fields = ["stress"]

[[probe]]
name = "lower"
at = [0.7, 0.1, 0.02]
fields = ["stress"]
"#;
    let folder = Folder::new("beam");
    run(&folder.write("scene.toml", beam), &folder.join("r"), &[]).good();
    let table = Table::read(&folder.join("r/history.csv"));
    for (name, x, z) in [("upper", 1.03, 0.15), ("lower", 0.7, 0.02)] {
        let exact = 12.0 * 400.0 * (2.0 - x) * (z - 0.1) / 0.2_f64.powi(4);
        let found = *table.column(&format!("{name}_stress_xx")).last().unwrap();
        assert!((found / exact - 1.0).abs() < 0.01, "{name}: {found}, {exact}");
    }
}

const PROBES: &str = r#"
[[probe]]
name = "centre"
at = [1.0, 1.0, 0.0]
fields = ["strain", "stress"]

[[probe]]
name = "below"
box = [[0.5, 0.5, -0.5], [1.5, 1.5, 0.0]]

[[probe]]
plane = [[0.5, 0.5, -0.1], [1.5, 1.5, -0.1]]

[[measure]]
name = "bed"
box = [[0.5, 0.5, 0.0], [1.5, 1.5, 0.2]]
history = true
"#;

fn coupled() -> String {
    COUPLED.replace("tecplot = true\n", "fields = [\"stress\", \"strain\"]\n") + PROBES
}

/// Times of the frames with the solid [s].
fn frames(out: &Path) -> Vec<f64> {
    let list = fs::read_to_string(out.join("results.pvd")).unwrap();
    let time = |line: &str| line.split("timestep=\"").nth(1)?.split('"').next()?.parse().ok();
    list.lines().filter(|l| l.contains("solid_")).map(|l| time(l).unwrap()).collect()
}

#[test]
fn curves_agree_with_frames_and_cycles() {
    let folder = scene_folder("curves", &coupled());
    let out = folder.join("out");
    // A row per window.
    let set = ["output.history_interval=1e-4", "output.frames_at_peaks=true", "output.frames_at=[0.013]"];
    run(&folder.join("scene.toml"), &out, &set).good();
    let table = Table::read(&out.join("history.csv"));
    assert!(!table.heads.iter().any(|h| h.starts_with("middle_stress")), "{:?}", table.heads);
    let time = table.column("time");
    let times = frames(&out);
    let expected = [0.0, 0.013, 0.04, 0.05, 0.07, 0.08];
    assert_eq!(times.len(), expected.len(), "{times:?}");
    assert!(times.iter().zip(expected).all(|(t, e)| (t - e).abs() < 1e-3), "{times:?}");
    for (frame, at) in times.iter().enumerate() {
        let (points, point, _) = vtk(&out.join(format!("frames/solid_{frame:05}.vtu")));
        let node = (0..points.len() / 3).find(|n| points[3 * n..3 * n + 3] == [1.0, 1.0, 0.0]).unwrap();
        let row = time.iter().position(|t| t == at).unwrap();
        for (part, place) in [("xx", 0), ("yy", 4), ("zz", 8), ("xy", 1), ("yz", 5), ("zx", 2)] {
            for field in ["stress", "strain"] {
                let found = table.column(&format!("centre_{field}_{part}"))[row];
                assert_eq!(found, point[field].1[9 * node + place], "{field} {part} in frame {frame}");
            }
        }
    }
    let cycles = Table::read(&out.join("cycles.csv"));
    for name in ["centre_stress_zz", "centre_stress_xy", "plane_vertical_stress", "below_mean_stress_largest"]
    {
        let (values, step) = (table.column(name), time[1] - time[0]);
        for k in 0..2 {
            let end = 0.04 + 0.02 * (k + 1) as f64;
            let inside = |t: f64| t - 0.5 * step >= end - 0.02 && t - 0.5 * step < end;
            let of: Vec<f64> = (0..time.len()).filter(|i| inside(time[*i])).map(|i| values[i]).collect();
            let peak = of.iter().copied().fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
            let mean = of.iter().sum::<f64>() / of.len() as f64;
            assert_eq!(cycles.column(&format!("{name}_peak"))[k], peak, "{name}");
            assert!((cycles.column(&format!("{name}_mean"))[k] - mean).abs() <= 1e-9 * peak.abs(), "{name}");
        }
    }
    let last = |name: &str| *table.column(name).last().unwrap();
    let bed = &json(&out.join("summary.json"))["packing"]["measures"][0];
    assert_eq!(bed["porosity"].as_f64().unwrap(), last("bed_porosity"));
    assert_eq!(bed["coordination"].as_f64().unwrap(), last("bed_coordination"));
    let mean = (0..3).map(|k| bed["stress"][k].as_f64().unwrap()).sum::<f64>() / 3.0;
    assert!((mean - last("bed_mean_stress")).abs() <= 1e-12 * mean.abs() && mean < 0.0, "{mean}");
}

#[test]
fn curves_survive_restarts() {
    let folder = scene_folder("resumed", &coupled());
    let set = ["output.frames_at_peaks=true"];
    let expected = ["cycles.csv", "frames/solid_00004.vtu"];
    broken(&folder.join("scene.toml"), &set, &[0.3, 0.6, 0.62, 0.85], &expected);
}

#[test]
fn rejects_probes_outside_the_solid() {
    let folder = scene_folder("outside", &coupled());
    let column = folder.write("column.toml", COLUMN);
    let grains =
        folder.write("grains.toml", &format!("{GRAINS}\n[[probe]]\nat = [0, 0, 0]\nfields = [\"stress\"]\n"));
    let coupled = folder.join("scene.toml");
    for (scene, set, sentence) in [
        (
            &coupled,
            "probe.1.at=[9, 9, 9]",
            "probe.1.at: found (9, 9, 9), expected a point of the solid, which lies between [0.0, 0.0, -1.0] and [2.0, 2.0, 0.0]",
        ),
        (&coupled, "probe.1.fields=[]", "probe.1.fields: found an empty list, expected one field or more"),
        (&coupled, "probe.1.fields=[\"strss\"]", "found \"strss\", expected"),
        (
            &coupled,
            "probe.2.fields=[\"stress\"]",
            "probe.2.fields: found together with `box`, expected only one of them",
        ),
        (
            &coupled,
            "probe.2.box=[[0, 0, -0.001], [2, 2, 0]]",
            "probe.2.box: found no integration point in it",
        ),
        (
            &coupled,
            "probe.3.plane=[[0.5, 0.5, -0.2], [1.5, 1.5, -0.1]]",
            "probe.3.plane: found [0.5, 0.5, -0.2] and [1.5, 1.5, -0.1], expected the lower corner, then the upper",
        ),
        (
            &coupled,
            "probe.3.plane=[[0.5, 0.5, 1], [1.5, 1.5, 1]]",
            "probe.3.plane: found (0.53125, 0.53125, 1)",
        ),
        (
            &coupled,
            "output.frames_at=[7]",
            "output.frames_at.0: found 7, expected above 0, at most the end at",
        ),
        (
            &column,
            "output.frames_at_peaks=true",
            "output.frames_at_peaks: found, but it has no effect without [track.load]",
        ),
        (&coupled, "probe.1.points=3", "probe.1.points: found, but it has no effect without `line`"),
        (
            &coupled,
            "probe=[{ line = [[0, 0, 0], [0, 0, 0]] }]",
            "probe.0.line: found [0.0, 0.0, 0.0] twice, expected two points",
        ),
        (
            &coupled,
            "probe=[{ line = [[1, 1, 0], [1, 1, -1]], points = 1 }]",
            "probe.0.points: found 1, expected 2 to 1000",
        ),
        (&coupled, "probe=[{ line = [[1, 1, 0], [1, 1, 9]] }]", "probe.0.line: found (1, 1, 0.9)"),
        (&grains, "title=\"grains\"", "probe.0: found a probe of the solid, expected a scene with [solid]"),
    ] {
        let outcome = trackbed(["check", &scene.display().to_string(), "--set", set]);
        assert_eq!(outcome.code, 2, "{set}: {outcome:?}");
        assert!(outcome.stderr.contains(sentence), "{sentence}\n{}", outcome.stderr);
    }
}
