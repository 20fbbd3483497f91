//! Bonded ice sheets.

use super::floes::refused;
use super::support::{Folder, Table, json, run};

const SHEET: &str = r#"gravity = [0, 0, 0]

[[material]]
name = "ice"
density = 915
stiffness = "5 MN/m"
friction = 0.1
restitution = 0.3

[[grains]]
name = "sheet"
shape = "polyhedron"
material = "ice"
bond = "level ice"
seed = 3
velocity = [0.5, 0, 0]
floes = { low = [-6, -3], high = [-1, 3], count = 30, gap = "10 mm", relax = 30, thickness = 0.5, radius = 0.02 }

[[grains]]
name = "pile"
shape = "polyhedron"
material = "ice"
frustum = { from = [0, 0, -1], to = [0, 0, 1], radii = [0.98, 0.98] }
prescribed_velocity = [0, 0, 0]

[[bond]]
name = "level ice"
damping = 0.1
face = { young = "1 GPa", tensile_strength = "100 kPa", shear_strength = "100 kPa" }

[time]
end = "0.3 s"

[output]
frames = 1
"#;

#[test]
fn a_sheet_breaks_or_holds() {
    let folder = Folder::new("sheets");
    let scene = folder.write("scene.toml", SHEET);
    let of = |name: &str, set: &[&str]| {
        let out = folder.join(name);
        run(&scene, &out, set).good();
        (json(&out.join("summary.json")), Table::read(&out.join("history.csv")))
    };
    let (weak, _) = of("weak", &[]);
    let bonds = &weak["bonds"];
    let made = bonds["made"].as_u64().unwrap();
    // About three bonds per cell, fewer at borders (Euler).
    assert!((60..90).contains(&made), "{made}");
    let broken = bonds["broken_by_tension"].as_u64().unwrap() + bonds["broken_by_shear"].as_u64().unwrap();
    assert!(broken > 2 && broken < made, "{broken} of {made}");
    assert!(bonds["energy_of_breaks"].as_f64().unwrap() > 0.0);
    assert!(weak["energy"]["relative_error"].as_f64().unwrap().abs() < 1e-3, "{}", weak["energy"]);

    let (strong, history) = of("strong", &["bond.0.face={ young = \"1 GPa\" }", "time.end=0.6"]);
    assert_eq!(strong["bonds"]["broken_by_tension"].as_u64(), Some(0));
    assert_eq!(strong["bonds"]["fragments"].as_u64(), Some(2), "the sheet and the pile");
    let bonds = history.column("bonds");
    assert!(bonds.iter().all(|b| *b == made as f64));
}

#[test]
fn bad_sheets_are_refused() {
    for (old, new, expected) in [
        ("gap = \"10 mm\"", "gap = 0", "floes.gap: found 0, expected above 0"),
        (
            "gap = \"10 mm\"",
            "gap = \"10 mm\", concentration = 0.9",
            "floes.concentration: found together with `gap`, expected only one of them",
        ),
        ("gap = \"10 mm\", ", "", "floes.concentration: found nothing, expected `concentration` or `gap`"),
        ("relax = 30", "relax = 20000", "floes.relax: found 20000, expected 0 to 10000"),
        (
            "bond = \"level ice\"",
            "bond = \"ice\"",
            "grains.0.bond: found \"ice\", expected the name of a [[bond]] with `face`: level ice",
        ),
        (
            "bond = \"level ice\"\n",
            "",
            "bond.0.face: found, but it has no effect without [[grains]] of `floes` with this `bond`",
        ),
        (
            "damping = 0.1",
            "damping = 0.1\ngap = 1",
            "bond.0.face: found together with `gap`, expected only one of them",
        ),
        ("young = \"1 GPa\"", "young = 0", "bond.0.face.young: found 0, expected above 0"),
        (
            "tensile_strength = \"100 kPa\"",
            "tensile_strength = -1",
            "bond.0.face.tensile_strength: found -1, expected 0 or more",
        ),
        (
            "face = {",
            "parallel = { young = 1e9 }\nface = {",
            "bond.0.parallel: found together with `face`, expected only one of them",
        ),
    ] {
        assert_eq!(SHEET.matches(old).count(), 1, "{old}");
        refused(&SHEET.replace(old, new), expected);
    }
}
