//! Ice floes, fixed frusta, and packings of polyhedra.

use super::support::{Folder, Outcome, Table, json, run, trackbed};
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

mod hulls;

const ICE: &str = r#"gravity = [0, 0, 0]

[[material]]
name = "ice"
density = 915
stiffness = "2 MN/m"
friction = 0.1
restitution = 0.3

[[grains]]
name = "ice"
shape = "polyhedron"
material = "ice"
seed = 3
velocity = [0.5, 0, 0]
floes = { low = [-5, -5], high = [5, 5], count = 20, concentration = 0.64, thickness = 0.5, radius = 0.04, elevation = 1, clear = [[0, 0, 0.8]] }

[[grains]]
name = "pile"
shape = "polyhedron"
material = "ice"
frustum = { from = [0, 0, 0], to = [0, 0, 2], radii = [0.8, 0.8] }
prescribed_velocity = [0, 0, 0]

[time]
end = "1.5 s"

[output]
frames = 1
packing = true
"#;

fn rows(file: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(file).unwrap();
    text.lines().skip(1).map(|l| l.split(',').map(|f| f.parse().unwrap()).collect()).collect()
}

#[test]
fn floes_drift_against_a_pile() {
    let folder = Folder::new("floes");
    let scene = folder.write("scene.toml", ICE);
    let out = folder.join("out");
    run(&scene, &out, &[]).good();
    let bodies = json(&out.join("summary.json"))["model"]["bodies"].as_u64().unwrap();
    assert!((12..=20).contains(&bodies), "{bodies}");
    let history = Table::read(&out.join("history.csv"));
    for name in ["pile_x", "pile_y"] {
        assert!(history.column(name).iter().all(|x| x.abs() < 1e-12), "{name}");
    }
    assert!(history.column("pile_z").iter().all(|z| (z - 1.0).abs() < 1e-9));
    let force = history.column("pile_force_x");
    assert!(force[0] == 0.0 && force.iter().all(|f| *f >= -1.0), "{force:?}");
    assert!(force.iter().any(|f| *f > 100.0), "{force:?}");
    // Floes remain in their plane.
    let floes = rows(&out.join("packing_0.csv"));
    assert_eq!(floes.len() as u64, bodies - 1);
    assert!(floes.iter().all(|f| (f[2] - 1.0).abs() < 1e-3), "{floes:?}");
    let picture = folder.join("ice.png").display().to_string();
    trackbed(["render", &out.display().to_string(), "--out", &picture, "--size", "400x300"]).good();
    assert!(fs::metadata(&picture).unwrap().len() > 5000);
}

#[test]
fn a_pile_on_springs() {
    let folder = Folder::new("springs");
    let held = ICE.find("[[grains]]\nname = \"pile\"").unwrap()..ICE.find("[time]").unwrap();
    let pile = r#"[[walls]]
kind = "cylinder"
name = "leg"
material = "ice"
base = [0, 0, 0]
height = 2
radius = 0.8
record = true
body = { mass = "8 t", hold = ["y", "z"], mount = { frequency = ["2 Hz", 0, 0] } }

[[structure]]
name = "pile"
parts = ["leg"]
axis = [0, 0]

"#;
    let mut text = ICE.to_string();
    text.replace_range(held, pile);
    let run_in = |name: &str, text: &str| {
        let (scene, out) = (folder.write(&format!("{name}.toml"), text), folder.join(name));
        run(&scene, &out, &["output.history_interval=0.002"]).good();
        (Table::read(&out.join("history.csv")), json(&out.join("summary.json")), out)
    };
    let (table, summary, out) = run_in("sprung", &text);
    let column = |name: &str| table.column(name);
    let (way, acceleration, load) =
        (column("pile_motion_x"), column("pile_acceleration_x"), column("pile_load_x"));
    assert_eq!(way, column("leg_displacement_x"));
    let most = |values: &[f64]| values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(most(&load) > 1e3 && most(&way) > 1e-3, "{} {}", most(&load), most(&way));
    assert_eq!(most(&column("pile_motion_y")), 0.0);
    let square = (2.0 * 2.0 * PI).powi(2);
    let last_touch = load.iter().rposition(|f| *f != 0.0).unwrap();
    let swings: Vec<f64> = (0..load.len())
        .filter(|k| load[*k] == 0.0 && *k != last_touch + 1)
        .map(|k| acceleration[k] + square * way[k])
        .collect();
    assert!(swings.len() > 100 && most(&swings) < 0.02 * square * most(&way), "{}", most(&swings));
    let energy = column("mount_energy");
    let stiff = 8e3 * square;
    assert!((most(&energy) / (0.5 * stiff * most(&way).powi(2)) - 1.0).abs() < 0.02);
    assert_eq!(most(&column("dissipated_mounts")), 0.0);
    let record = &summary["structures"][0]["motion"];
    assert!((record["largest_displacement"].as_f64().unwrap() / most(&way) - 1.0).abs() < 1e-12);
    let mean = acceleration.iter().map(|a| a * a).sum::<f64>() / acceleration.len() as f64;
    assert!((record["rms_acceleration"].as_f64().unwrap() / mean.sqrt() - 1.0).abs() < 1e-9);
    assert!(most(&column("energy_error")) < 0.01 * column("grains_kinetic")[0]);
    let page = folder.join("page.html").display().to_string();
    trackbed(["report", &out.display().to_string(), "--out", &page]).good();
    assert!(fs::read_to_string(&page).unwrap().contains("Displacement of structures"));
    let (loose, ..) = run_in("loose", &text.replace(", mount = { frequency = [\"2 Hz\", 0, 0] }", ""));
    assert!(*loose.column("pile_motion_x").last().unwrap() > 3.0 * most(&way));
    let (fixed, ..) = run_in(
        "fixed",
        &text.replace(
            "hold = [\"y\", \"z\"], mount = { frequency = [\"2 Hz\", 0, 0] }",
            "hold = [\"x\", \"y\", \"z\"]",
        ),
    );
    assert_eq!(most(&fixed.column("pile_motion_x")), 0.0);
}

#[test]
fn circles_are_kept_clear() {
    let folder = Folder::new("clear");
    let clear = ", clear = [[0, 0, 0.8]]";
    let bodies = |with: &str| -> u64 {
        let text = ICE.replace(clear, with).replace("1.5 s", "1 ms");
        let text = text.split_once("[[grains]]\nname = \"pile\"").map(|(ice, _)| ice.to_string()).unwrap()
            + "[time]\nend = \"1 ms\"\n";
        run(&folder.write("scene.toml", &text), &folder.join("out"), &[]).good();
        json(&folder.join("out/summary.json"))["model"]["bodies"].as_u64().unwrap()
    };
    assert_eq!(bodies(""), 20);
    assert!(bodies(clear) < 20);
    refused(
        &ICE.replace(clear, ", clear = [[0, 0, 9]]"),
        "grains.0.floes.clear: found circles that meet all floes, expected room for a floe at least",
    );
}

#[track_caller]
pub fn refused(text: &str, expected: &str) {
    let folder = Folder::new("refused");
    let scene = folder.write("scene.toml", text).display().to_string();
    let Outcome { code, stderr, .. } = trackbed(["check", &scene]);
    assert!(code == 2 && stderr.contains(expected), "{code}: {stderr}\nexpected: {expected}");
}

#[test]
fn bad_floes_and_frusta_are_refused() {
    for (old, new, expected) in [
        ("high = [5, 5]", "high = [5, -5]", "floes.high: found -5, expected above `low`"),
        ("count = 20", "count = 0", "floes.count: found 0, expected 1 to 100000"),
        ("0.64", "1", "floes.concentration: found 1, expected above 0, below 1"),
        (
            "thickness = 0.5",
            "thickness = 0.08",
            "floes.thickness: found 0.08, expected above twice the radius",
        ),
        ("radius = 0.04", "radius = 0", "floes.radius: found 0, expected above 0"),
        ("0, 0, 0.8]]", "0, 0, -1]]", "floes.clear: found -1, expected a radius of 0 or more"),
        (
            "thickness = 0.5, radius = 0.04",
            "thickness = 50, radius = 9",
            "floes.radius: found 9, expected a radius that",
        ),
        ("to = [0, 0, 2]", "to = [0, 0, 0]", "frustum.to: found 0, expected another point than `from`"),
        ("radii = [0.8, 0.8]", "radii = [0.8, 0]", "frustum.radii: found 0, expected above 0"),
        ("radii = [0.8, 0.8]", "radii = [0.8, 0.8], sides = 5", "frustum.sides: found 5, expected 6 to 32"),
        (
            "radii = [0.8, 0.8]",
            "radii = [0.8, 0.8], radius = 1",
            "frustum.radius: found 1, expected a radius that",
        ),
        ("seed = 3", "seed = 3\ncount = 4", "grains.0.count: found, but it has no effect without"),
        (
            "material = \"ice\"\nseed",
            "material = \"ice\"\nlattice = { kind = \"loose\", size = 1, low = [0, 0, 0], counts = [1, 1, 1] }\nseed",
            "found together with `floes`, expected only one of them",
        ),
        (
            "shape = \"polyhedron\"\nmaterial = \"ice\"\nseed",
            "shape = \"sphere\"\nmaterial = \"ice\"\nseed",
            "grains.0.shape: found another shape",
        ),
    ] {
        assert_eq!(ICE.matches(old).count(), 1, "{old}");
        refused(&ICE.replace(old, new), expected);
    }
}

#[test]
fn small_floes_are_remarked() {
    let folder = Folder::new("small_floes");
    let text = ICE
        .replace("radius = 0.04", "radius = 0.24")
        .replace("count = 20", "count = 100")
        .replace("1.5 s", "1 ms");
    run(&folder.write("scene.toml", &text), &folder.join("out"), &[]).good();
    let summary = json(&folder.join("out/summary.json"));
    let warnings = summary["warnings"].to_string();
    assert!(warnings.contains("of 100 floes are left out"), "{warnings}");
}

#[test]
fn a_held_frustum_carries_a_heap() {
    let folder = Folder::new("heap");
    // 0.14 × 0.12 × 0.10 m, edge radius 10 mm, longest side along x.
    let (half, r) = ([0.06, 0.05, 0.04], 0.01);
    let sign = |k: usize, d: usize| if k >> d & 1 == 1 { 1.0 } else { -1.0 };
    let corners: Vec<[f64; 3]> = (0..8).map(|k| [0, 1, 2].map(|d| sign(k, d) * half[d])).collect();
    let library = format!(
        "name = \"block\"\nsource = \"test\"\n[[stones]]\nname = \"block\"\nradius = {r}\ncorners = {corners:?}\n"
    );
    folder.write("library.toml", &library);
    folder.write("heap.csv", "-0.075,0,0.05,1,0,0,0,1,0\n0.075,0,0.05,1,0,0,0,1,0\n0,0,0.15,1,0,0,0,1,0\n");
    let text = "[[material]]\nname = \"stone\"\ndensity = 2650\nstiffness = \"1 MN/m\"\nfriction = 0.5\nrestitution = 0.2\n\n\
         [[grains]]\nname = \"heap\"\nshape = \"polyhedron\"\nmaterial = \"stone\"\nlibrary = \"library.toml\"\npacking = \"heap.csv\"\n\n\
         [[grains]]\nname = \"cone\"\nshape = \"polyhedron\"\nmaterial = \"stone\"\nprescribed_velocity = [0, 0, 0]\n\
         frustum = { from = [0, 0, -0.3], to = [0, 0, 0], radii = [0.5, 0.3], sides = 16, radius = \"10 mm\" }\n\n\
         [deposition]\nmax_time = \"2 s\"\nsettled_speed = \"0.1 mm/s\"\nlocal_damping = 0.3\n\n\
         [time]\nend = \"20 ms\"\n\n[output]\nframes = 1\npacking = true\n";
    let scene = folder.write("scene.toml", text);
    run(&scene, &folder.join("out"), &[]).good();
    let [a, b, c] = half.map(|h| 2.0 * h);
    let volume =
        a * b * c + 2.0 * r * (a * b + b * c + c * a) + PI * r * r * (a + b + c) + 4.0 / 3.0 * PI * r.powi(3);
    let weight = 3.0 * 2650.0 * volume * 9.81;
    let force = Table::read(&folder.join("out/history.csv")).column("cone_force_z");
    let mean = force.iter().sum::<f64>() / force.len() as f64;
    assert!((-mean / weight - 1.0).abs() < 0.01, "{mean} {weight}");
    let heap = rows(&folder.join("out/packing_0.csv"));
    assert!(heap.len() == 3 && heap.iter().all(|s| s[7] == 1.0 && s[8] == 0.0), "{heap:?}");
    assert!((heap[2][2] - 0.15).abs() < 1e-3 && heap[2][0].abs() < 1e-3, "{heap:?}");

    fs::copy(folder.join("out/packing_0.csv"), folder.join("heap.csv")).unwrap();
    run(&scene, &folder.join("again"), &["deposition.max_time=1e-5", "time.end=1e-5"]).good();
    let again = rows(&folder.join("again/packing_0.csv"));
    for (a, b) in heap.iter().flatten().zip(again.iter().flatten()) {
        assert!((a - b).abs() < 1e-5, "{a} {b}");
    }
    refused_packing(&folder, "0,0,0,1,0,0,0,1,1\n", "expected the number of a stone of the library, 0 to 0");
}

fn refused_packing(folder: &Folder, row: &str, expected: &str) {
    folder.write("heap.csv", row);
    let Outcome { code, stderr, .. } = trackbed(["check", &folder.join("scene.toml").display().to_string()]);
    assert!(code == 2 && stderr.contains(expected), "{code}: {stderr}");
}

#[test]
fn loads_on_structures_are_recorded() {
    let (before, rest) = ICE.split_once("[[grains]]\nname = \"pile\"").unwrap();
    let after = rest.split_once("[time]").unwrap().1;
    let corners = [[0.7, 0.7], [-0.7, 0.7], [-0.7, -0.7], [0.7, -0.7]];
    let at = |z: f64| corners.map(|[x, y]| format!("[{x}, {y}, {z}]")).join(", ");
    let mesh = format!(
        "[[walls]]\nkind = \"triangles\"\nname = \"pile\"\nmaterial = \"ice\"\nrecord = true\nvertices = [{}, {}]\n\
         triangles = [[0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]]\n",
        at(-1.0),
        at(3.0)
    );
    let round = "[[walls]]\nkind = \"cylinder\"\nname = \"pile\"\nmaterial = \"ice\"\nrecord = true\nbase = [0, 0, -1]\n\
                 height = 4\nradius = 0.8\n";
    for (kind, wall) in [("round", round), ("mesh", &mesh)] {
        let text = format!(
            "{before}{wall}[[structure]]\nname = \"tower\"\nparts = [\"pile\"]\naxis = [0, 0]\nfoot = 1\nsectors = 12\n\
             levels = [0.7, 1.3]\n[periodic]\ny = [-8, 8]\n[time]{after}history_interval = \"2 ms\"\n"
        );
        let folder = Folder::new(&format!("loads_{kind}"));
        let scene = folder.write("scene.toml", &text);
        let out = folder.join("out");
        // With the default step an impact may start within one step of a row.
        run(&scene, &out, &["time.grain_step_fraction=0.2"]).good();
        let history = Table::read(&out.join("history.csv"));
        let column = |name: &str| history.column(name);
        let (load, force) = (column("tower_load_x"), column("pile_force_x"));
        let most = load.iter().fold(0.0_f64, |m, f| m.max(*f));
        let off: f64 = load.iter().zip(&force).map(|(a, b)| (a - b).abs()).sum::<f64>();
        let all: f64 = load.iter().map(|f| f.abs()).sum();
        assert!(most > 100.0 && off < 0.05 * all, "{kind}: {most} {off} {all}");
        let largest = |name: &str| column(name).iter().fold(0.0_f64, |m, f| m.max(*f));
        let sectors: Vec<f64> = (0..12).map(|k| largest(&format!("tower_sector{k}"))).collect();
        let front = sectors[4..8].iter().fold(0.0_f64, |m, f| m.max(*f));
        let back = sectors[..3].iter().chain(&sectors[9..]).fold(0.0_f64, |m, f| m.max(*f));
        assert!(front > 0.5 * most && back < 0.1 * front, "{kind}: {sectors:?}");
        let level = largest("tower_load_level");
        assert!(
            (largest("tower_layer1") / level - 1.0).abs() < 1e-9 && largest("tower_layer0") == 0.0,
            "{kind}"
        );
        // Floe height equals the reference height of moments.
        assert!(largest("tower_load_moment_y") < 0.25 * most, "{kind}");
        let record = &json(&out.join("summary.json"))["structures"][0];
        assert!((record["largest"].as_f64().unwrap() / level - 1.0).abs() < 1e-12, "{record}");
        assert_eq!(record["sectors"].as_array().unwrap().len(), 12);
        means_balance_load(kind, record, &history);
        let page = folder.join("page.html").display().to_string();
        trackbed(["report", &out.display().to_string(), "--out", &page]).good();
        let page = fs::read_to_string(&page).unwrap();
        for title in
            ["Largest load of each sector", "Mean load of each sector", "Mean horizontal load of each layer"]
        {
            assert!(page.contains(title), "{title}");
        }
        for (old, new, expected) in [
            (
                "[\"pile\"]",
                "[\"pole\"]",
                "structure.0.parts: found \"pole\", expected names among \"pile\", \"ice\"",
            ),
            ("[\"pile\"]", "[]", "structure.0.parts: found nothing"),
            ("levels = [0.7, 1.3]", "levels = [1.3, 0.7]", "structure.0.levels: found [1.3, 0.7]"),
            ("sectors = 12", "sectors = 361", "structure.0.sectors: found 361, expected at most 360"),
        ] {
            refused(&text.replace(old, new), expected);
        }
    }
}

/// Means by hand; around the frictionless cylinder the sectors' means add up to the mean load.
fn means_balance_load(kind: &str, record: &serde_json::Value, history: &Table) {
    let list = |key: &str| -> Vec<f64> {
        record[key].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
    };
    let mean = |name: &str| {
        let column = history.column(name);
        column.iter().sum::<f64>() / column.len() as f64
    };
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * mean("tower_load_level");
    for (key, column) in [("mean_sectors", "tower_sector"), ("mean_layers", "tower_layer")] {
        for (k, found) in list(key).iter().enumerate() {
            assert!(close(*found, mean(&format!("{column}{k}"))), "{kind}: {key} {k}");
        }
    }
    // The only loaded layer.
    let layers = list("mean_layers");
    assert!(layers.len() == 3 && close(layers.iter().sum(), mean("tower_load_level")), "{layers:?}");
    assert_eq!(list("layers").len(), 3);
}

/// Without friction the load of a cylinder is radial: F = −Σ mean load of a sector × its direction.
#[test]
fn mean_sector_loads_add_up() {
    let (before, rest) = ICE.split_once("[[grains]]\nname = \"pile\"").unwrap();
    let text = format!(
        "{before}[[walls]]\nkind = \"cylinder\"\nname = \"pile\"\nmaterial = \"ice\"\nbase = [0, 0, -1]\nheight = 4\nradius = 0.8\n\
         [[structure]]\nname = \"tower\"\nparts = [\"pile\"]\naxis = [0, 0]\nsectors = 360\n[periodic]\ny = [-8, 8]\n[time]{}\
         history_interval = \"2 ms\"\n",
        rest.split_once("[time]").unwrap().1
    );
    let folder = Folder::new("mean_sectors");
    let scene = folder.write("scene.toml", &text);
    run(&scene, &folder.join("out"), &["material.ice.friction=0", "time.grain_step_fraction=0.2"]).good();
    let record = &json(&folder.join("out/summary.json"))["structures"][0];
    let list = |key: &str| -> Vec<f64> {
        record[key].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
    };
    let (sectors, mean) = (list("mean_sectors"), list("mean"));
    let mut sum = [0.0; 2];
    for (k, load) in sectors.iter().enumerate() {
        let angle = (k as f64 + 0.5).to_radians();
        sum = [sum[0] - load * angle.cos(), sum[1] - load * angle.sin()];
    }
    let level = mean[0].hypot(mean[1]);
    let apart = (sum[0] - mean[0]).hypot(sum[1] - mean[1]) / level;
    println!("sum of sectors {sum:?} N, mean load {mean:?} N, apart by {apart:.1e}");
    // Half a sector: 0.0044 of the load.
    assert!(level > 1.0 && apart < 0.005, "{sum:?}, expected {mean:?}");
    // Loaded on the side that faces the drift only.
    let lee: f64 = sectors[..90].iter().chain(&sectors[270..]).map(|f| f.abs()).sum();
    assert!(lee < 1e-3 * level, "{lee} of {level}");
}

const HAZARD: &str = r#"
[structure.hazard]
threshold = 20
separation = "20 ms"
start = "0.1 s"
loads = [50, 100]
amber = 60
red = "1 MN"
law = "gumbel"
confidence = 0.95
exposure = "10 h"
return_periods = [1, 10]

[structure.hazard.level_ice]
thickness = 0.3
width = "6 m"
top_width = "4 m"
angle = "45 deg"
friction = 0.1
flexural_strength = "0.7 MPa"
density = 915
"#;

fn hazardous() -> String {
    let (before, rest) = ICE.split_once("[[grains]]\nname = \"pile\"").unwrap();
    format!(
        "{before}[[walls]]\nkind = \"cylinder\"\nname = \"pile\"\nmaterial = \"ice\"\nbase = [0, 0, -1]\nheight = 4\nradius = 0.8\n\
         [[structure]]\nname = \"tower\"\nparts = [\"pile\"]\naxis = [0, 0]\n{HAZARD}\n[periodic]\ny = [-8, 8]\n[time]{}\
         history_interval = \"2 ms\"\n",
        rest.split_once("[time]").unwrap().1
    )
}

/// Peaks, exceedance and warning level recomputed from `history.csv`; Ralston's load of the fifth decimal.
#[test]
fn hazard_follows_history() {
    let folder = Folder::new("hazard");
    let scene = folder.write("scene.toml", &hazardous());
    let out = folder.join("out");
    run(&scene, &out, &["time.grain_step_fraction=0.2", "time.end=3"]).good();
    let said = fs::read_to_string(out.join("log.txt")).unwrap();
    let history = Table::read(&out.join("history.csv"));
    let rows: Vec<(f64, f64)> = history
        .column("time")
        .iter()
        .zip(history.column("tower_load_level"))
        .map(|(t, f)| (*t, f))
        .filter(|(t, _)| *t >= 0.1)
        .collect();
    let hazard = &json(&out.join("summary.json"))["structures"][0]["hazard"];
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    // 200 points between two rows.
    let above = |level: f64| {
        let fine = rows.windows(2).map(|w| {
            let count = (0..200)
                .filter(|k| w[0].1 + (w[1].1 - w[0].1) * (f64::from(*k) + 0.5) / 200.0 > level)
                .count();
            count as f64 / 200.0 * (w[1].0 - w[0].0)
        });
        fine.sum::<f64>() / (rows.last().unwrap().0 - rows[0].0)
    };
    let levels = [50.0, 100.0, 60.0, 1e6];
    for (e, level) in hazard["exceedance"].as_array().unwrap().iter().zip(levels) {
        assert_eq!(number(&e["load"]), level);
        assert!((number(&e["fraction_of_time"]) - above(level)).abs() < 2e-5, "{e}");
    }
    assert!(above(50.0) > 0.0 && hazard["exceedance"].as_array().unwrap().len() == 4, "{hazard}");
    // Peaks: the largest row of each run of rows above 20 N, joined over less than 20 ms.
    let (mut peaks, mut last) = (Vec::<(f64, f64)>::new(), None::<usize>);
    for (k, row) in rows.iter().enumerate().filter(|(_, row)| row.1 > 20.0) {
        let gap = last.map(|l| if k == l + 1 { 0.0 } else { row.0 - rows[l + 1].0 });
        match peaks.last_mut() {
            Some(peak) if gap.unwrap() < 0.02 => {
                if row.1 > peak.1 {
                    *peak = *row;
                }
            }
            _ => peaks.push(*row),
        }
        last = Some(k);
    }
    // The end of the run cuts off the last one.
    assert!(rows[0].1 < 20.0 && rows.last().unwrap().1 > 20.0 && peaks.pop().is_some());
    let found = hazard["peaks"].as_array().unwrap();
    assert!(found.len() == peaks.len() && peaks.len() >= 5, "{} {}", found.len(), peaks.len());
    for (found, peak) in found.iter().zip(&peaks) {
        assert_eq!((number(&found[0]), number(&found[1])), *peak);
    }
    assert_eq!((&hazard["warning"], hazard["fit"]["law"].as_str()), (&"amber".into(), Some("gumbel")));
    let [location, scale] = ["location", "scale"].map(|key| number(&hazard["fit"][key]));
    let per_year = peaks.len() as f64 / number(&hazard["duration"]) * 36000.0;
    for (r, period) in hazard["return_loads"].as_array().unwrap().iter().zip([1.0, 10.0]) {
        let y = (number(&r["load"]["value"]) - location) / scale;
        let exceeded = 1.0 - (-(-y).exp()).exp();
        assert!((exceeded * per_year * period - 1.0).abs() < 1e-6, "{r}");
    }
    let largest = rows.iter().fold(0.0_f64, |m, row| m.max(row.1));
    assert!((number(&hazard["level_ice"]) / 179_500.129_2 - 1.0).abs() < 1e-8, "{hazard}");
    assert!((number(&hazard["over_level_ice"]) * 179_500.129_2 / largest - 1.0).abs() < 1e-8, "{hazard}");
    for text in ["warning level amber", "1-year load", "times the load of level ice"] {
        assert!(said.contains(text), "{text}: {said}");
    }
    let page = folder.join("page.html").display().to_string();
    trackbed(["report", &out.display().to_string(), "--out", &page]).good();
    let page = fs::read_to_string(&page).unwrap();
    for text in [
        "<h2>Hazard</h2>",
        "run warned",
        "Warning level amber.",
        "Peaks of the horizontal load",
        "return period [years]",
    ] {
        assert!(page.contains(text), "{text}");
    }
}

#[test]
fn rejects_bad_hazards() {
    let text = hazardous();
    for (old, new, expected) in [
        (
            "threshold = 20\n",
            "threshold = 0\n",
            "structure.0.hazard.threshold: found 0, expected a load above 0",
        ),
        (
            "[50, 100]",
            "[100, 50]",
            "structure.0.hazard.loads: found [100.0, 50.0], expected at most 100 loads above 0, ascending",
        ),
        ("red = \"1 MN\"", "red = 50", "structure.0.hazard.red: found 50, expected a load above `amber`"),
        (
            "confidence = 0.95",
            "confidence = 1",
            "structure.0.hazard.confidence: found 1, expected between 0 and 1",
        ),
        (
            "exposure = \"10 h\"\n",
            "",
            "structure.0.hazard.return_periods: found without `exposure`, expected both",
        ),
        (
            "return_periods = [1, 10]\n",
            "",
            "structure.0.hazard.exposure: found without `return_periods`, expected both",
        ),
        (
            "[1, 10]",
            "[0]",
            "structure.0.hazard.return_periods: found [0.0], expected at most 100 periods above 0",
        ),
        (
            "flexural_strength = \"0.7 MPa\"\n",
            "",
            "structure.0.hazard.level_ice.strength: found nothing, expected `strength` or `flexural_strength`",
        ),
        (
            "flexural_strength",
            "strength",
            "structure.0.hazard.level_ice.angle: found, but it has no effect without `flexural_strength`",
        ),
        (
            "top_width = \"4 m\"",
            "top_width = 7",
            "structure.0.hazard.level_ice.top_width: found 7, expected at least 0, below `width`",
        ),
        (
            "friction = 0.1\nflex",
            "friction = 3\nflex",
            "structure.0.hazard.level_ice.friction: found 3, expected a friction at which ice slides up the cone",
        ),
        ("law = \"gumbel\"", "law = \"normal\"", "structure.0.hazard.law: found"),
    ] {
        assert!(text.contains(old), "{old}");
        refused(&text.replace(old, new), expected);
    }
}

const PANCAKES: &str = r#"gravity = [0, 0, -9.81]

[[material]]
name = "ice"
density = 915
stiffness = "2 MN/m"
friction = 0.3
restitution = 0.3

[[grains]]
name = "pancakes"
shape = "disk"
material = "ice"
seed = 3
size = [0.5, 1]
floes = { low = [-5, -5], high = [5, 5], concentration = 0.6, thickness = 0.2, elevation = 0.1, clear = [[0, 0, 0.8]] }

[[walls]]
kind = "plane"
material = "ice"
point = [0, 0, 0]
normal = [0, 0, 1]

[time]
end = "0.2 s"

[output]
frames = 1
packing = true
"#;

#[test]
fn round_floes_lie_on_a_floor() {
    let folder = Folder::new("pancakes");
    let out = folder.join("out");
    run(&folder.write("scene.toml", PANCAKES), &out, &[]).good();
    let summary = json(&out.join("summary.json"));
    let floes = rows(&out.join("packing.csv"));
    assert_eq!(summary["model"]["bodies"].as_u64(), Some(floes.len() as u64));
    let covered = floes.len() as f64 / (0.6 * (100.0 - PI * 0.64));
    // Diameters uniform in 0.5–1 m: mean square 7/12 m².
    assert!((covered * 0.25 * PI * 7.0 / 12.0 - 1.0).abs() < 0.02, "{covered}");
    for floe in &floes {
        assert!(floe[0].hypot(floe[1]) > 1.05 && (floe[2] - 0.1).abs() < 1e-3, "{floe:?}");
        assert!(floe[3].abs() > 1.0 - 1e-6, "{floe:?}");
    }
    let warnings = summary["warnings"].to_string();
    assert!(warnings.contains("round floes cover 0."), "{warnings}");
}

#[test]
fn disks_fill_a_box() {
    let folder = Folder::new("disks");
    let walls: String = [("1, 0, 0", -0.5), ("-1, 0, 0", 0.5), ("0, 1, 0", -0.5), ("0, -1, 0", 0.5)]
        .map(|(n, x)| {
            let point = if n.contains("1, 0, 0") { format!("{x}, 0, 0") } else { format!("0, {x}, 0") };
            format!("[[walls]]\nkind = \"plane\"\nmaterial = \"ice\"\npoint = [{point}]\nnormal = [{n}]\n\n")
        })
        .concat();
    let filled = PANCAKES
        .replace("size = [0.5, 1]\n", "size = [0.3, 0.4]\ncount = 12\naspect = 0.25\n")
        .replace("[time]", &format!("{walls}[time]"));
    let at = filled.find("floes = ").unwrap();
    let end = at + filled[at..].find('\n').unwrap();
    let filled =
        format!("{}fill = {{ low = [-0.5, -0.5, 0], high = [0.5, 0.5] }}{}", &filled[..at], &filled[end..])
            .replace("0.2 s", "1 s");
    let out = folder.join("out");
    run(&folder.write("scene.toml", &filled), &out, &[]).good();
    let floes = rows(&out.join("packing.csv"));
    assert_eq!(floes.len(), 12);
    assert!(floes.iter().all(|f| f[2] > 0.03 && (0.3..=0.4).contains(&f[7]) && f[8] == 0.0), "{floes:?}");
    let again = filled
        .replace("size = [0.3, 0.4]\ncount = 12\n", "")
        .replace("fill = { low = [-0.5, -0.5, 0], high = [0.5, 0.5] }", "packing = \"out/packing.csv\"")
        .replace("1 s", "1 us");
    run(&folder.write("again.toml", &again), &folder.join("again"), &[]).good();
    let back = rows(&folder.join("again/packing.csv"));
    for (a, b) in floes.iter().zip(&back) {
        assert!((0..3).all(|d| (a[d] - b[d]).abs() < 1e-4) && a[7] == b[7], "{a:?} {b:?}");
    }
}

#[test]
fn bad_disks_are_refused() {
    for (old, new, expected) in [
        (
            "thickness = 0.2",
            "thickness = 0.6",
            "floes.thickness: found 0.6 m, expected less than the diameter",
        ),
        (
            "thickness = 0.2",
            "thickness = 0.2, count = 5",
            "floes.count: found together with `shape = \"disk\"`",
        ),
        (
            "thickness = 0.2",
            "thickness = 0.2, radius = 0.1",
            "floes.radius: found together with `shape = \"disk\"`",
        ),
        ("concentration = 0.6", "concentration = 0.93", "floes.concentration: found 0.93, at which floes"),
        (
            "size = [0.5, 1]",
            "aspect = 0.2\nsize = [0.5, 1]",
            "grains.0.aspect: found, but it has no effect without",
        ),
        (
            "size = [0.5, 1]\n",
            "",
            "grains.0.gradation: found nothing, expected `gradation`, `size` or `sizes`",
        ),
        ("shape = \"disk\"", "shape = \"sphere\"", "grains.0.size: found, but it has no effect without"),
    ] {
        assert_eq!(PANCAKES.matches(old).count(), 1, "{old}");
        refused(&PANCAKES.replace(old, new), expected);
    }
}
