//! Specimens between platens: elastic lattice, cracks and events, rejected input.

use super::support::{Folder, Table, json, run, trackbed};
use std::f64::consts::PI;
use std::fs;

fn column(bond: &str) -> String {
    let layer = |name: &str, low: f64, layers: u32, motion: &str| {
        format!(
            "[[grains]]\nname = \"{name}\"\nshape = \"sphere\"\nmaterial = \"rock\"\n\
             lattice = {{ kind = \"loose\", size = 0.02, low = [0, 0, {low}], counts = [3, 3, {layers}] }}\n{motion}\n"
        )
    };
    format!(
        "gravity = [0, 0, 0]\n[[material]]\nname = \"rock\"\ndensity = 2600\nstiffness = 1e7\nfriction = 0.5\nrestitution = 0.5\n\
         {}{}{}[[bond]]\nname = \"b\"\ngap = 1e-4\ndamping = 0.7\n[bond.parallel]\nyoung = 1e9\n{bond}\n\
         [specimen]\ntest = \"compression\"\nbottom = \"foot\"\ntop = \"head\"\nlength = 0.22\narea = 0.0036\n\
         [time]\nend = 0.02\n[output]\nframes = 1\nhistory_interval = 1e-4\n",
        layer("foot", 0.0, 1, "prescribed_velocity = [0, 0, 0]\nrecord = true"),
        layer("rock", 0.02, 10, ""),
        layer("head", 0.22, 1, "prescribed_velocity = [0, 0, -0.01]\nrecord = true"),
    )
}

/// Bond area π r² per cell of (2 r)²: E π/4, no lateral strain.
#[test]
fn lattice_modulus_matches_bonds() {
    let folder = Folder::new("lattice");
    let file = folder.write("scene.toml", &column(""));
    run(&file, &folder.join("r"), &[]).good();
    let specimen = &json(&folder.join("r/summary.json"))["specimen"];
    let of = |key: &str| specimen[key].as_f64().unwrap();
    println!(
        "modulus {:.5e}, closed form {:.5e}; by platens {:.5e}",
        of("modulus"),
        1e9 * PI / 4.0,
        of("platen_modulus")
    );
    assert!((of("modulus") / (1e9 * PI / 4.0) - 1.0).abs() < 0.02, "{specimen}");
    assert!((of("platen_modulus") / (1e9 * PI / 4.0) - 1.0).abs() < 0.02, "{specimen}");
    assert!(of("poisson").abs() < 1e-3, "{specimen}");
    let table = Table::read(&folder.join("r/history.csv"));
    for (time, strain) in table.column("time").iter().zip(table.column("specimen_strain")) {
        assert!((strain - 0.01 * time / 0.22).abs() < 1e-9, "{time} {strain}");
    }
    assert!(fs::read_to_string(folder.join("r/specimen.svg")).unwrap().contains("axial, of the grains"));
    let frame = fs::read_to_string(folder.join("r/frames/grains_00001.vtp")).unwrap();
    assert!(frame.contains("Name=\"broken_bonds\""));
}

#[test]
fn a_column_that_breaks_has_events() {
    let folder = Folder::new("breaks");
    let bond = "tensile_strength = 2e5\nshear_strength = 4e5";
    let file = folder.write("scene.toml", &column(bond));
    let set = ["grains.head.prescribed_velocity=[0, 0, 0.01]", "events={ distance = 0.03, time = 1e-3 }"];
    run(&file, &folder.join("r"), &set).good();
    let summary = json(&folder.join("r/summary.json"));
    let (bonds, events) = (&summary["bonds"], &summary["bonds"]["events"]);
    assert!(bonds["broken_by_tension"].as_u64().unwrap() >= 9, "{bonds}");
    assert!(
        events["count"].as_u64().unwrap() >= 1 && events["most_breaks"].as_u64().unwrap() >= 9,
        "{events}"
    );
    let table = Table::read(&folder.join("r/events.csv"));
    let energy: f64 = table.column("energy").iter().sum();
    assert!((energy / bonds["energy_of_breaks"].as_f64().unwrap() - 1.0).abs() < 1e-9, "{bonds}");
    let breaks: f64 = table.column("breaks").iter().sum();
    assert_eq!(
        breaks,
        bonds["broken_by_tension"].as_f64().unwrap() + bonds["broken_by_shear"].as_f64().unwrap()
    );
    // Tensile stress is negative; compression only from waves.
    let stress = Table::read(&folder.join("r/history.csv")).column("specimen_stress");
    let least = stress.iter().copied().fold(0.0, f64::min);
    assert!((least / (-2e5 * PI / 4.0) - 1.0).abs() < 0.1, "{least}");
}

#[test]
fn what_is_no_specimen_is_refused() {
    let folder = Folder::new("refused");
    let file = folder.write("scene.toml", &column(""));
    for (set, sentence) in [
        (
            "specimen.top=\"x\"",
            "specimen.top: found \"x\", expected the name of a wall or of a gripped group with `record`",
        ),
        ("specimen.top=\"rock\"", "specimen.top: found \"rock\", expected the name of a wall"),
        ("specimen.area=", "specimen.area: found nothing, expected the section of the specimen"),
        (
            "specimen.thickness=1",
            "specimen.thickness: found, but it has no effect without `test = \"brazilian\"`",
        ),
        (
            "specimen.test=\"brazilian\"",
            "specimen.area: found, but it has no effect without `test = \"compression\"`",
        ),
        ("specimen.length=0", "specimen.length: found 0, expected a length above 0"),
        (
            "specimen.sides=[\"w\"]",
            "specimen.sides.0: found \"w\", expected the name of a wall with `record`",
        ),
        ("specimen.side_area=1", "specimen.side_area: found, but it has no effect without `sides`"),
        (
            "specimen.between=[0.5, 0.2]",
            "specimen.between: found [0.5, 0.2], expected two rising shares from 0 to 1",
        ),
        (
            "specimen.groups=[\"x\"]",
            "specimen.groups.0: found \"x\", expected the name of a [[grains]]: foot, rock, head",
        ),
        ("events={ distance = -1, time = 0 }", "events.distance: found -1, expected 0 or more"),
    ] {
        let outcome = trackbed(["check", &file.display().to_string(), "--set", set]);
        assert_eq!(outcome.code, 2, "{set}: {outcome:?}");
        assert!(outcome.stderr.contains(sentence), "{sentence}\n{}", outcome.stderr);
    }
}
