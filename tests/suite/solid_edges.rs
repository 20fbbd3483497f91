//! Limits of the solid: locking, small strains, skipped loads, overflow.

use super::support::{COUPLED, Folder, Table, json, run, write_lists};
use serde_json::Value;

const COLUMN: &str = r#"title = "column"

[solid]
gravity = false

[solid.block]
x = { lines = [0.0, 0.5], counts = [2] }
y = { lines = [0.0, 0.5], counts = [2] }
z = { lines = [0.0, 1.0, 2.0], counts = [2, 2] }
layer = [{ material = 1, top = 1.0 }, { material = 2 }]

[[solid.material]]
id = 1
young = "20 MPa"
poisson = 0.25
density = 2000

[[solid.material]]
id = 2
young = "20 MPa"
poisson = 0.25
density = 2000

[[solid.support]]
side = "z-"
directions = ["x", "y", "z"]

[[solid.load]]
kind = "pressure"
side = "z+"
pressure = "10 kPa"

[output]
vtk = false
"#;

fn column(change: &[(&str, &str)], set: &[&str]) -> (i32, String, Vec<String>) {
    let folder = Folder::new("edges");
    let mut text = COLUMN.to_string();
    for (old, new) in change {
        assert!(text.contains(old), "{old}");
        text = text.replacen(old, new, 1);
    }
    let scene = folder.write("scene.toml", &text);
    let outcome = run(&scene, &folder.join("out"), set);
    let summary = folder.join("out/summary.json");
    let warnings = if summary.exists() { json(&summary)["warnings"].clone() } else { Value::Null };
    let warnings = warnings.as_array().cloned().unwrap_or_default();
    (outcome.code, outcome.stderr, warnings.iter().map(|w| w.as_str().unwrap().to_string()).collect())
}

#[track_caller]
fn remarked(warnings: &[String], part: &str) {
    assert!(warnings.iter().any(|w| w.contains(part)), "{part:?} in {warnings:?}");
}

#[test]
fn locking_elements_name_remedy() {
    let soft = [("poisson = 0.25", "poisson = 0.4999")];
    for rule in ["full", "irons14"] {
        let rule = format!("solid.integration={rule}");
        let (code, _, warnings) = column(&soft, &[&rule]);
        assert_eq!(code, 0);
        remarked(
            &warnings,
            "hex20 elements lock: displacements come out too small; set solid.dilatation = \"mean\"",
        );
        let (code, _, warnings) = column(&soft, &[&rule, "solid.dilatation=mean"]);
        assert_eq!((code, warnings), (0, Vec::new()));
    }
    assert_eq!(column(&soft, &[]).2, Vec::<String>::new());
    // Linear hexahedra do not lock, but are too deep at the clamped base.
    let warnings = column(&soft, &["solid.order=linear"]).2;
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    remarked(&warnings, "deep at a clamped face");
}

#[test]
fn deep_clamped_elements_give_warning() {
    let beam = |counts: &str, set: &[&str]| {
        let change = [
            ("x = { lines = [0.0, 0.5], counts = [2] }", "x = { lines = [0.0, 5.0], counts = COUNTS }"),
            (
                "z = { lines = [0.0, 1.0, 2.0], counts = [2, 2] }",
                "z = { lines = [0.0, 0.25, 0.5], counts = [1, 1] }",
            ),
            ("top = 1.0", "top = 0.25"),
            ("COUNTS", counts),
            ("poisson = 0.25", "poisson = 0.4999"),
            ("poisson = 0.25", "poisson = 0.4999"),
            ("side = \"z-\"", "side = \"x-\""),
            ("kind = \"pressure\"", "kind = \"traction\""),
            ("side = \"z+\"", "side = \"x+\""),
            ("pressure = \"10 kPa\"", "traction = [0, 0, 10]"),
        ];
        let (code, error, warnings) = column(&change, set);
        assert_eq!(code, 0, "{error}");
        warnings
    };
    let linear = "solid.order=linear";
    remarked(
        &beam("[10]", &[linear]),
        "material 1 has Poisson's ratio 0.4999, and 2 of its hex8 elements are up to 1.00 widths of the section deep at a clamped face",
    );
    let none = Vec::<String>::new();
    assert_eq!(beam("[10]", &[]), none);
    assert_eq!(beam("[40]", &[linear]), none);
    let soft = ["solid.material.0.poisson=0.4", "solid.material.1.poisson=0.4", linear];
    assert_eq!(beam("[10]", &soft), none);
}

#[test]
fn rejects_locking_keys_without_effect() {
    let (code, error, _) = column(&[], &["solid.order=linear", "solid.dilatation=mean"]);
    assert_eq!(code, 2);
    assert!(
        error.contains("solid.dilatation: found, but it has no effect without quadratic elements"),
        "{error}"
    );
    let (code, error, _) = column(&[], &["solid.incompatible_modes=false"]);
    assert_eq!(code, 2);
    assert!(
        error.contains("solid.incompatible_modes: found, but it has no effect without 8-node hexahedra"),
        "{error}"
    );
}

#[test]
fn incompatible_modes_are_default() {
    let tip = |set: &[&str]| {
        let folder = Folder::new("beam");
        let beam = COLUMN
            .replace("lines = [0.0, 1.0, 2.0], counts = [2, 2]", "lines = [0.0, 5.0], counts = [10]")
            .replace("layer = [{ material = 1, top = 1.0 }, { material = 2 }]\n", "")
            .replace("x = { lines = [0.0, 0.5], counts = [2] }", "x = { lines = [0.0, 0.5], counts = [4] }")
            .replace("kind = \"pressure\"", "kind = \"traction\"")
            .replace("pressure = \"10 kPa\"", "traction = [1000, 0, 0]");
        let scene = folder.write("scene.toml", &beam);
        run(&scene, &folder.join("out"), set).good();
        json(&folder.join("out/summary.json"))["statics"]["largest_displacement"][0].as_f64().unwrap()
    };
    // F l³/(3 E I) + 1.2 F l/(G A), slightly less for the clamp.
    let (force, area, inertia) = (1000.0 * 0.25, 0.25, 0.5_f64.powi(4) / 12.0);
    let beam = force * 125.0 / (3.0 * 20e6 * inertia) + 1.2 * force * 5.0 / (8e6 * area);
    let (with, without) = (
        tip(&["solid.order=linear"]) / beam,
        tip(&["solid.order=linear", "solid.incompatible_modes=false"]) / beam,
    );
    println!("beam: {with:.4} with modes, {without:.4} without");
    assert!((with - 1.0).abs() < 0.02 && without < 0.8, "{with} {without}");
}

#[test]
fn large_strains_give_warning() {
    let (code, _, warnings) = column(&[("10 kPa", "2 MPa")], &[]);
    assert_eq!(code, 0);
    remarked(&warnings, "solid: strain ");
    let (code, _, warnings) = column(&[("10 kPa", "200 MPa")], &[]);
    assert_eq!(code, 0);
    remarked(&warnings, "more than its size of ");
    assert_eq!(column(&[], &[]).2, Vec::<String>::new());
}

#[test]
fn overflowing_load_stops_run() {
    let (code, error, _) = column(&[("10 kPa", "1e200 Pa")], &[]);
    assert_eq!(code, 3, "{error}");
    assert!(error.contains("strain energy"), "{error}");
}

const MOVING: [(&str, &str); 2] = [
    (
        "pressure = \"10 kPa\"",
        "pressure = \"10 kPa\"\nhistory = { kind = \"table\", points = [[0.0, 0.0], [0.0145, 0.0], [0.015, 1.0], [0.0155, 0.0]] }",
    ),
    ("[output]", "[solid.dynamics]\n\n[time]\nend = 0.1\nsolid_step = 0.01\n\n[output]"),
];

#[test]
fn skipped_pulse_gives_warning() {
    let (code, _, warnings) = column(&MOVING, &[]);
    assert_eq!(code, 0);
    remarked(
        &warnings,
        "solid.load.0: time.solid_step = 0.01 s resolves its history with points that miss the factor 1 at 0.015 s",
    );
    let fine = ["time.solid_step=0.0005", "output.history_interval=0.01"];
    let (code, _, warnings) = column(&MOVING, &fine);
    assert_eq!(code, 0);
    remarked(
        &warnings,
        "solid.load.0: output.history_interval = 0.01 s samples its history with points that miss",
    );
    assert_eq!(
        column(&MOVING, &["time.solid_step=0.0005", "output.history_interval=0.0005"]).2,
        Vec::<String>::new()
    );
}

#[test]
fn layered_k0_needs_unit_weights() {
    let k0 = [
        ("density = 2000", "density = 1000"),
        ("gravity = false", "gravity = true"),
        (
            "[output]",
            "[solid.initial_stress]\nmethod = \"k0\"\nk0 = 0.5\n\n[solid.quasi_static]\n\n[time]\nend = 1.0\nsolid_step = 1.0\n\n[output]",
        ),
    ];
    let (code, error, _) = column(&k0, &[]);
    assert_eq!(code, 2, "{error}");
    assert!(
        error.contains("solid.initial_stress.layers: found nothing, and materials of 1000 to 2000 kg/m3, expected the layers"),
        "{error}"
    );
    let (code, error, _) = column(&k0, &["solid.initial_stress.layers=[[2.0, 2000], [1.0, 1000]]"]);
    assert_eq!(code, 0, "{error}");
    let (code, error, _) = column(&k0[1..], &[]);
    assert_eq!(code, 0, "{error}");
}

#[test]
fn unlike_stiffnesses_are_named() {
    let (code, error, _) = column(&[("young = \"20 MPa\"", "young = 1e-6")], &[]);
    assert_eq!(code, 2, "{error}");
    assert!(error.contains("found an ill-conditioned stiffness matrix"), "{error}");
    assert!(error.contains("ratio of Young's moduli 2.0e13") && !error.contains("insufficiently"), "{error}");
}

#[test]
fn slower_reduction_gives_warning() {
    let folder = Folder::new("reduction");
    let mut mesh = trackbed_fem::Mesh::block([8, 8, 2], [2.0, 2.0, 1.0]);
    mesh.coordinates.iter_mut().for_each(|x| x[2] -= 1.0);
    write_lists(&mesh, folder.path());
    let scene = folder.write("scene.toml", COUPLED);
    let short =
        ["track.load.cycles=1", "track.load.rest=0.002", "track.load.ramp=0.002", "track.load.frequency=200"];
    for (reduction, dearer) in
        [("{ kind = \"surface\", modes = 400 }", true), ("{ kind = \"modes\", modes = 10 }", false)]
    {
        let reduction = format!("solid.reduction={reduction}");
        let set: Vec<&str> = short.iter().copied().chain([reduction.as_str()]).collect();
        run(&scene, &folder.join("out"), &set).good();
        let warnings = json(&folder.join("out/summary.json"))["warnings"].to_string();
        println!("{reduction}: {warnings}");
        assert_eq!(warnings.contains("× slower ("), dearer, "{warnings}");
    }
}

/// Unbalanced forces of a reduced solid show its error in the motion since the start: large with few modes under single contacts.
#[test]
fn reduced_solid_states_its_error() {
    let folder = Folder::new("reduction_error");
    let mut mesh = trackbed_fem::Mesh::block([8, 8, 4], [2.0, 2.0, 1.0]);
    mesh.coordinates.iter_mut().for_each(|x| x[2] -= 1.0);
    write_lists(&mesh, folder.path());
    let scene = folder.write("scene.toml", COUPLED);
    let case = |reduction: &[&str]| {
        let set = ["track.load.cycles=1", "output.frames=10", "coupling.substeps=\"auto\""];
        let set: Vec<&str> = set.iter().chain(reduction).copied().collect();
        run(&scene, &folder.join("out"), &set).good();
        let summary = json(&folder.join("out/summary.json"));
        let error = &summary["coupling"]["reduction"];
        let warned = summary["warnings"].to_string().contains("solid.reduction: error of displacements");
        let rows = Table::read(&folder.join("out/history.csv")).column("middle_u_z");
        let sunk = rows[0] - rows.iter().fold(0.0_f64, |m, u| m.min(*u));
        println!("{reduction:?}: {error}, middle sinks {sunk:.4e} m");
        (sunk, error["displacement"].as_f64(), warned)
    };
    let (full, none, _) = case(&[]);
    assert!(none.is_none());
    let (sunk, found, warned) = case(&["solid.reduction={ kind = \"surface\" }"]);
    assert!((sunk / full - 1.0).abs() < 1e-3 && found.unwrap() < 2e-3 && !warned);
    let (sunk, found, warned) = case(&["solid.reduction={ kind = \"modes\" }"]);
    let off = (sunk / full - 1.0).abs();
    assert!(off > 0.5 && warned && (found.unwrap() / off - 1.0).abs() < 0.2, "{off}");
}
