//! Lattices, radius expansion, containers, gradations, layers, compaction, saved packings.

use super::support::{Folder, json, numbers, repository, run, scene_folder};
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

fn scene(group: &str, rest: &str) -> String {
    format!(
        "gravity = [0, 0, 0]\n\n[[material]]\nname = \"stone\"\ndensity = 2650\nstiffness = \"1 MN/m\"\nfriction = 0.5\n\
         restitution = 0.4\n\n[[grains]]\nname = \"g\"\nmaterial = \"stone\"\n{group}\n\n{rest}\n[time]\nend = \"0.5 ms\"\n\n\
         [output]\nframes = 1\nvtk = false\npacking = true\n"
    )
}

fn ran(folder: &Folder, text: &str, out: &str) -> serde_json::Value {
    folder.write("scene.toml", text);
    run(&folder.join("scene.toml"), &folder.join(out), &[]).good();
    json(&folder.join(out).join("summary.json"))
}

fn rows(file: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(file).unwrap();
    text.lines().skip(1).map(|l| l.split(',').map(|f| f.parse().unwrap()).collect()).collect()
}

/// Porosities 1 − π/6 and 1 − π/(3√2) over whole periods.
#[test]
fn lattice_porosity_and_round_trip() {
    let d = 0.02;
    let (r3, rise) = (3.0_f64.sqrt(), (2.0_f64 / 3.0).sqrt());
    let close = 1.0 - PI / (3.0 * 2.0_f64.sqrt());
    for (kind, period, exact) in [
        ("loose", [d, d, d], 1.0 - PI / 6.0),
        ("hexagonal", [d, d * r3, 2.0 * d * rise], close),
        ("face_centred", [d, d * r3, 3.0 * d * rise], close),
    ] {
        let folder = Folder::new("lattice");
        let low = [0.051, 0.052, 0.053];
        let high: Vec<f64> = (0..3).map(|k| low[k] + period[k] * if k == 0 { 4.0 } else { 2.0 }).collect();
        let radial = "[[measure]]\nname = \"all\"\nbox = [[0, 0, 0], [0.2, 0.22, 0.24]]\nradial = { reach = \"45 mm\", bins = 15 }\n";
        let measure = format!("[[measure]]\nname = \"bulk\"\nbox = [{low:?}, {high:?}]\n{radial}");
        let lattice = format!(
            "shape = \"sphere\"\nlattice = {{ kind = \"{kind}\", size = \"20 mm\", low = [0, 0, 0], counts = [10, 11, 12] }}"
        );
        let summary = ran(&folder, &scene(&lattice, &measure), "first");
        let bulk = &summary["packing"]["measures"][0];
        let porosity = bulk["porosity"].as_f64().unwrap();
        assert!((porosity - exact).abs() < 1e-6, "{kind}: {porosity} {exact}");
        assert_eq!(summary["model"]["bodies"], 1320);

        let table = rows(&folder.join("first/radial.csv"));
        assert_eq!(table.len(), 15);
        if kind == "loose" {
            // Simple cubic neighbour distances: d, d√2, d√3, 2 d, d√5.
            let shell = |r: f64| 4.0 / 3.0 * PI * ((r + 0.0015).powi(3) - (r - 0.0015).powi(3)) / d.powi(3);
            let found: Vec<f64> = table.iter().filter(|r| r[2] > 0.0).map(|r| r[2] * shell(r[1])).collect();
            assert_eq!(found.len(), 5, "{table:?}");
            for (n, exact) in found.iter().zip([6.0, 12.0, 8.0, 6.0, 24.0]) {
                assert!((n / exact - 1.0).abs() < 1e-9, "{n} {exact}");
            }
            assert!(table.iter().all(|r| r[0] == 1.0));
        }
        let packing = folder.join("first/packing.csv");
        folder.write("bed.csv", &fs::read_to_string(&packing).unwrap());
        let again = ran(&folder, &scene("shape = \"sphere\"\npacking = \"bed.csv\"", &measure), "second");
        assert_eq!(fs::read(packing).unwrap(), fs::read(folder.join("second/packing.csv")).unwrap());
        assert_eq!(again["packing"]["measures"][0]["porosity"], bulk["porosity"]);
    }
}

#[test]
fn scattered_clumps_are_read_back() {
    let folder = Folder::new("clumps");
    let library = repository().join("inputs/track/cyclic/stones.toml").display().to_string();
    let group = format!(
        "shape = \"clump\"\nlibrary = \"{library}\"\nsizes = {{ law = \"normal\", mean = \"30 mm\", deviation = \"4 mm\", \
         low = \"20 mm\", high = \"40 mm\" }}\nregion = {{ box = [[0, 0, 0], [0.3, 0.3, 0.3]] }}\nsolid_fraction = 0.12\nseed = 8"
    );
    let measure = "[[measure]]\nname = \"all\"\nbox = [[0, 0, 0], [0.3, 0.3, 0.3]]\n";
    let summary = ran(&folder, &scene(&group, measure), "first");
    let porosity = summary["packing"]["measures"][0]["porosity"].as_f64().unwrap();
    assert!((porosity - 0.88).abs() < 1e-3, "{porosity}");
    let first = folder.join("first/packing.csv");
    let stones = rows(&first);
    assert!(stones.len() > 200 && stones.iter().any(|s| s[8] == 5.0) && stones.iter().all(|s| s[8] < 6.0));
    folder.write("bed.csv", &fs::read_to_string(&first).unwrap());
    let group = format!("shape = \"clump\"\nlibrary = \"{library}\"\npacking = \"bed.csv\"");
    ran(&folder, &scene(&group, measure), "second");
    // Quaternions are normalised every step.
    let again = rows(&folder.join("second/packing.csv"));
    assert_eq!(again.len(), stones.len());
    for (a, b) in stones.iter().flatten().zip(again.iter().flatten()) {
        assert!((a - b).abs() < 1e-13, "{a} {b}");
    }
}

#[test]
fn containers_hold_their_grains() {
    let folder = Folder::new("containers");
    folder.write(
        "rock.obj",
        "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\nf 1 3 5\nf 2 3 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\n\
         f 4 2 6\nf 1 4 6\n",
    );
    let sizes = "shape = \"sphere\"\nsizes = { law = \"bidisperse\", small = \"10 mm\", large = \"20 mm\", large_share = 0.5 }\n";
    let rock = format!(
        "{sizes}region = {{ surface = \"rock.obj\", scale = 0.2, shift = [1, 0, 0] }}\nsolid_fraction = 0.2"
    );
    ran(&folder, &scene(&rock, ""), "rock");
    let grains = rows(&folder.join("rock/packing.csv"));
    let volume: f64 = grains.iter().map(|g| 4.0 / 3.0 * PI * g[3].powi(3)).sum();
    assert!((volume / (4.0 / 3.0 * 0.008) - 0.2).abs() < 2e-3, "{volume}");
    for g in &grains {
        // Distance to the faces |x| + |y| + |z| = 0.2.
        let inside = (0.2 - (g[0] - 1.0).abs() - g[1].abs() - g[2].abs()) / 3.0_f64.sqrt();
        assert!(inside >= g[3] - 1e-12, "{g:?}");
    }
    let cone =
        "region = { cone = { from = [0, 0, 0], to = [0, 0, 0.4], radii = [0.05, 0.15] } }\ncount = 100";
    ran(&folder, &scene(&format!("{sizes}{cone}"), ""), "cone");
    let grains = rows(&folder.join("cone/packing.csv"));
    assert_eq!(grains.len(), 100);
    assert!(grains.iter().all(|g| g[0].hypot(g[1]) + g[3] <= 0.05 + 0.25 * g[2] && g[2] >= g[3]));
}

#[test]
fn growth_meets_the_porosity() {
    let folder = Folder::new("growth");
    let group = "shape = \"sphere\"\nsizes = { law = \"monodisperse\", size = \"20 mm\" }\nregion = { box = [[0, 0, 0], [0.2, 0.2, 0.16]] }\n\
                 growth = { porosity = 0.41 }";
    let measure = "[[measure]]\nname = \"all\"\nbox = [[0, 0, 0], [0.2, 0.2, 0.16]]\n";
    let summary = ran(&folder, &scene(group, measure), "out");
    let grown = summary["growth"][0]["porosity"].as_f64().unwrap();
    assert!((grown - 0.41).abs() < 0.005, "{grown}");
    assert_eq!(summary["stages"][0]["name"], "growing g");
    let grains = rows(&folder.join("out/packing.csv"));
    let expected = 0.59 * 0.2 * 0.2 * 0.16 / (PI / 6.0 * 8e-6);
    assert_eq!(grains.len(), expected.round() as usize);
    assert!(grains.iter().all(|g| (g[3] / 0.01 - 1.0).abs() < 1e-3 && g[3] == grains[0][3]));
}

fn shipped(name: &str, edits: &[(&str, &str)]) -> (Folder, serde_json::Value) {
    let text = fs::read_to_string(repository().join("inputs/grains").join(name)).unwrap();
    let folder = scene_folder("shipped", &text);
    for file in ["grains/stones.toml", "data/gradations.csv"] {
        let name = Path::new(file).file_name().unwrap().to_str().unwrap();
        folder.write(name, &fs::read_to_string(repository().join("inputs").join(file)).unwrap());
    }
    for (old, new) in edits {
        folder.edit("scene.toml", old, new);
    }
    run(&folder.join("scene.toml"), &folder.join("out"), &[]).good();
    let summary = json(&folder.join("out/summary.json"));
    (folder, summary)
}

#[test]
fn gradation_of_the_shipped_bed() {
    let (folder, summary) = shipped(
        "gradation.toml",
        &[
            ("../data/gradations.csv", "gradations.csv"),
            ("count = 1800", "count = 250"),
            ("high = [0.5, 0.5]", "high = [0.25, 0.25]"),
            ("point = [0.5, 0, 0]", "point = [0.25, 0, 0]"),
            ("point = [0, 0.5, 0]", "point = [0, 0.25, 0]"),
            ("max_time = \"1 s\"", "max_time = \"0.5 s\""),
            ("[[0.06, 0.06, 0.06], [0.44, 0.44, 0.20]]", "[[0.04, 0.04, 0.04], [0.21, 0.21, 0.1]]"),
        ],
    );
    let graded = &summary["packing"]["gradations"][0];
    assert_eq!(graded["stones"], 250);
    assert!(graded["largest_deviation"].as_f64().unwrap() < 0.025, "{graded}");
    for (a, b) in numbers(&graded["achieved"]).iter().zip(numbers(&graded["target"])) {
        assert!((a - b).abs() < 0.01, "{graded}");
    }
    let table = rows(&folder.join("out/gradation.csv"));
    assert_eq!(table.len(), 6);
    assert_eq!(table[2][1..4], [0.04, 0.3, 0.65]);
    assert!(table.iter().all(|r| r[5] >= r[2] - 0.02 && r[5] <= r[3] + 0.02), "{table:?}");
    let svg = fs::read_to_string(folder.join("out/gradation.svg")).unwrap();
    assert!(svg.contains("upper limit") && svg.matches("<polyline").count() == 4);
    let core = &summary["packing"]["measures"][0];
    assert!((0.3..0.6).contains(&core["porosity"].as_f64().unwrap()), "{core}");
    assert!(summary["packing"]["coordination"].as_f64().unwrap() > 2.0);
    assert_eq!(rows(&folder.join("out/packing.csv")).len(), 250);
}

#[test]
fn compaction_of_the_shipped_bed() {
    let region = "region = [[0.0, 0.0, 0.0], [0.2, 0.2, 0.12]]";
    let text = fs::read_to_string(repository().join("inputs/grains/compaction.toml")).unwrap();
    assert_eq!(text.matches(region).count(), 4);
    let (_, summary) = shipped(
        "compaction.toml",
        &[
            ("low = \"20 mm\", high = \"30 mm\"", "low = \"32 mm\", high = \"42 mm\""),
            ("cycles = 12", "cycles = 5"),
            ("cycles = 20", "cycles = 8"),
            ("layers = 3", "layers = 2"),
        ],
    );
    let stages = summary["compaction"].as_array().unwrap();
    let kinds: Vec<&str> = stages.iter().map(|s| s["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["vibration", "vibration", "tamping", "squeeze"]);
    for stage in stages {
        let [before, after] = ["porosity_before", "porosity_after"].map(|k| stage[k].as_f64().unwrap());
        println!("{}: {before:.4} {after:.4}", stage["kind"]);
        assert!(after < before - 1e-4 && (0.3..0.6).contains(&after), "{stage}");
    }
    let names: Vec<&str> =
        summary["stages"].as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(names[..3], ["layers", "settling", "compaction 1: vibration"]);
    // The wall keeps its position and force.
    assert!(stages[3]["wall_force"].as_f64().unwrap() > 1.0);
}

#[test]
fn walls_before_the_one_that_squeezes() {
    let fewer = [
        ("low = \"20 mm\", high = \"30 mm\"", "low = \"32 mm\", high = \"42 mm\""),
        ("cycles = 12", "cycles = 2"),
        ("cycles = 20", "cycles = 2"),
        ("layers = 3", "layers = 1"),
    ];
    let (plain, _) = shipped("compaction.toml", &fewer);
    let recorded = "[[walls]]\nrecord = true\nkind = \"plane\"\npoint = [0, 0, -9]\nnormal = [0, 0, 1]\nmaterial = \"stone\"\n\n[[walls]]\n\
                    kind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]";
    let edits = [
        ("[[walls]]\nkind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]", recorded),
        (
            "x\nkind = \"vibration\"\nwalls = [0, 1, 2, 3, 4]",
            "x\nkind = \"vibration\"\nwalls = [1, 2, 3, 4, 5]",
        ),
        (
            "gravity\nkind = \"vibration\"\nwalls = [0, 1, 2, 3, 4]",
            "gravity\nkind = \"vibration\"\nwalls = [1, 2, 3, 4, 5]",
        ),
        ("wall = 5", "wall = 6"),
    ];
    let (other, _) = shipped("compaction.toml", &[&fewer[..], &edits[..]].concat());
    let positions = |folder: &Folder| rows(&folder.join("out/packing.csv"));
    assert_eq!(positions(&plain), positions(&other));
}

#[test]
fn growth_of_the_shipped_funnel() {
    let (_, summary) =
        shipped("growth.toml", &[("count = 800", "count = 250"), ("end = \"0.4 s\"", "end = \"10 ms\"")]);
    let grown = &summary["growth"][0];
    assert!((grown["porosity"].as_f64().unwrap() - 0.42).abs() < 0.005, "{grown}");
}
