//! Element tests of soil models: shipped file, closed forms, rejected input.

use super::columns::expect_defined;
use super::support::{Folder, Outcome, Table, json, repository, snapshot, trackbed};
use std::fs;
use std::path::Path;

pub(super) fn element(file: &Path, out: &Path, more: &[&str]) -> Outcome {
    let paths = [file.display().to_string(), "--out".into(), out.display().to_string()];
    let words = std::iter::once("element".to_string()).chain(paths);
    trackbed(words.chain(more.iter().map(|word| word.to_string())))
}

fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found / expected - 1.0).abs() < tolerance, "{found}, expected {expected}");
}

/// Mohr–Coulomb strength in triaxial compression [Pa] at 100 kPa.
fn strength(cohesion: f64, friction: f64) -> f64 {
    let phi = friction.to_radians();
    2.0 * phi.sin() / (1.0 - phi.sin()) * (100e3 + cohesion / phi.tan())
}

#[test]
fn shipped_tests_match_closed_forms() {
    let folder = Folder::new("element");
    let out = folder.join("out");
    let said = element(&repository().join("inputs/solid/element.toml"), &out, &[]).good().stdout;
    assert_eq!(said.matches("    tangent: passed, ").count(), 6, "{said}");
    assert_eq!(said.matches("    dissipation: passed, ").count(), 6, "{said}");
    assert_eq!(said.matches("    objectivity: passed, ").count(), 6, "{said}");
    let summary = json(&out.join("summary.json"));
    let tests = summary["tests"].as_array().unwrap();
    let figure = |k: usize, name: &str| tests[k]["figures"][name].as_f64().unwrap();
    let soils = [(25e3, 28.0, 0.0, 80e6), (40e3, 35.0, 5.0, 150e6)];
    for (k, (cohesion, friction, dilation, young)) in soils.into_iter().enumerate() {
        near(figure(k, "peak_q"), strength(cohesion, friction), 1e-8);
        near(figure(k, "stiffness_start"), young, 1e-9);
        near(figure(k, "stiffness_50"), young, 1e-9);
        assert!((figure(k, "dilation").to_degrees() - dilation).abs() < 1e-6);
        let table = Table::read(&out.join(tests[k]["file"].as_str().unwrap()));
        near(*table.column("q").last().unwrap(), strength(cohesion, friction), 1e-8);
        near(*table.column("axial_strain").last().unwrap(), 0.02, 1e-12);
        assert_eq!(table.rows.len(), 201);
    }
    near(figure(2, "stress_ratio_end"), 0.95, 1e-5);
    // p falls to 200 kPa 2^-(1 - kappa/lambda) at constant volume; lateral stress p - q/3.
    let p = 200e3 * 2.0_f64.powf(-(1.0 - 0.035 / 0.093));
    near(figure(2, "pore_pressure"), 200e3 - p * (1.0 - 0.95 / 3.0), 1e-5);
    near(figure(4, "stiffness_start"), 80e6 / 2.6, 1e-9);
    let names: Vec<&str> = tests.iter().map(|test| test["file"].as_str().unwrap()).collect();
    let expected = ["drained-100-kPa_fill.csv", "drained-100-kPa_formation.csv", "undrained-200-kPa.csv"];
    assert_eq!(names[..3], expected);
    let page = fs::read_to_string(out.join("element.html")).unwrap();
    assert!(
        page.contains("<h1>Soils of the track embankment</h1>") && page.contains("volumetric strain [%]")
    );
    let header = fs::read_to_string(out.join(names[0])).unwrap();
    expect_defined(Path::new("element tests"), header.lines().next().unwrap());
    let again = element(&repository().join("inputs/solid/element.toml"), &out, &[]);
    let expected = format!(
        "error: {}: found summary.json, expected another --out, or --force to overwrite files of the same names\n",
        out.display()
    );
    assert_eq!((again.code, again.stderr), (2, expected));
}

const FILE: &str = r#"[[material]]
name = "fill"
model = "mohr_coulomb"
young = "80 MPa"
poisson = 0.3
density = 1950
cohesion = "25 kPa"
friction = "28 deg"
dilation = 0.0

[[test]]
kind = "triaxial"
stress = "100 kPa"
strain = 0.02
"#;

#[test]
fn path_follows_stress_and_strain() {
    let folder = Folder::new("element_path");
    let controls = r#"kind = "path"
steps = 10
controls = ["stress", "stress", "strain", "strain", "strain", "strain"]
points = [["100 kPa", 1e5, 0.001, 0, 0, 0], ["110 kPa", "110 kPa", 0.001, 0, 0, 2e-4]]
"#;
    let file = folder
        .write("a.toml", &FILE.replace("kind = \"triaxial\"\n", controls).replace("strain = 0.02\n", ""));
    let out = folder.join("out");
    let said = element(&file, &out, &["--json"]).good().stdout;
    assert_eq!(serde_json::from_str::<serde_json::Value>(&said).unwrap(), json(&out.join("summary.json")));
    let table = Table::read(&out.join("path.csv"));
    let at = |name: &str, row: usize| table.column(name)[row];
    near(at("stress_zz", 10), 100e3 + 80e6 * 1e-3, 1e-9);
    // Lateral stress at constant axial strain: 2 nu times its change.
    near(at("stress_zz", 20), 180e3 + 0.6 * 10e3, 1e-9);
    near(at("stress_xx", 20), 110e3, 1e-9);
    near(at("stress_zx", 20), 80e6 / 2.6 * 2e-4, 1e-9);
}

/// Extension first, then the larger q of compression.
#[test]
fn secant_stiffness_is_of_first_loading() {
    let folder = Folder::new("element_cycle");
    let cycle = "strain = -0.01\nleast = 0.01\ncycles = 1\n";
    let file = folder.write("a.toml", &FILE.replace("strain = 0.02\n", cycle));
    element(&file, &folder.join("out"), &[]).good();
    let figures = &json(&folder.join("out/summary.json"))["tests"][0]["figures"];
    near(figures["stiffness_50"].as_f64().unwrap(), 80e6, 1e-9);
    near(figures["peak_q"].as_f64().unwrap(), strength(25e3, 28.0), 1e-8);
}

#[test]
fn scene_gives_materials() {
    let folder = Folder::new("element_scene");
    let scene = repository().join("inputs/track/train/scene.toml");
    let tests = "[[test]]\nkind = \"triaxial\"\nmaterial = \"fill\"\nstress = 1e5\nstrain = 0.01\n";
    let file = folder.write("a.toml", &format!("scene = \"{}\"\n{tests}", scene.display()));
    element(&file, &folder.join("out"), &[]).good();
    let summary = json(&folder.join("out/summary.json"));
    near(summary["tests"][0]["figures"]["peak_q"].as_f64().unwrap(), strength(25e3, 28.0), 1e-8);
}

#[test]
fn rejects_bad_input_with_whole_messages() {
    let folder = Folder::new("element_input");
    for (old, new, expected) in [
        ("strain = 0.02\n", "", "a.toml:11: test.0.strain: found nothing, expected the strain at the end"),
        ("strain = 0.02", "strain = 2", "a.toml:14: test.0.strain: found 2, expected -1 to 1, not 0"),
        (
            "\"100 kPa\"",
            "-1e5",
            "a.toml:13: test.0.stress: found -100000, expected a compressive stress of 0 or more",
        ),
        (
            "kind = \"triaxial\"",
            "kind = \"triaxal\"",
            "a.toml:12: test.0.kind: found \"triaxal\", expected one of \"triaxial\", \"undrained\", \"oedometer\", \
             \"simple_shear\", \"path\"",
        ),
        (
            "strain = 0.02",
            "strain = 0.02\nmaterial = \"fil\"",
            "a.toml:15: test.0.material: found \"fil\", expected one of \"fill\"",
        ),
        (
            "strain = 0.02",
            "strain = 0.02\nleast = 0.01",
            "a.toml:15: test.0.least: found, but it has no effect without `cycles`",
        ),
        (
            "strain = 0.02",
            "strain = 0.02\nsteps = 0",
            "a.toml:15: test.0.steps: found 0, expected 1 to 100000 (at most 100000 steps of a test)",
        ),
        (
            "kind = \"triaxial\"",
            "kind = \"path\"",
            "a.toml:14: test.0.strain: found together with `kind = \"path\"`, expected only one of them",
        ),
        (
            "young = \"80 MPa\"\n",
            "",
            "a.toml:1: material.0.young: found nothing, expected a value for the model `mohr_coulomb`",
        ),
        (
            "strain = 0.02",
            "strian = 0.02",
            "a.toml:14: test.0.strian: found the unknown key `strian`, expected `strain`",
        ),
        (
            "cohesion = \"25 kPa\"",
            "cohesion = 0.0\ntension = 0.0\nk0 = 0.5",
            "a.toml:9: material.0.k0: found, but it has no effect without `[solid.initial_stress]` of a scene",
        ),
    ] {
        let file = folder.write("a.toml", FILE);
        folder.edit("a.toml", old, new);
        let before = snapshot(folder.path());
        let outcome = element(&file, &folder.join("out"), &[]);
        let said = outcome.stderr.replace(&format!("{}/", folder.path().display()), "");
        assert_eq!((outcome.code, said), (2, format!("error: {expected}\n")));
        assert!(outcome.stdout.is_empty() && snapshot(folder.path()) == before, "nothing is written");
    }
}

#[test]
fn step_without_solution_is_a_numerical_failure() {
    let folder = Folder::new("element_failure");
    let stress = "kind = \"path\"\ncontrols = [\"stress\", \"stress\", \"stress\", \"strain\", \"strain\", \"strain\"]\n\
                  points = [[1e5, 1e5, 1e6, 0, 0, 0]]\nsteps = 10\n";
    let file =
        folder.write("a.toml", &FILE.replace("kind = \"triaxial\"\n", stress).replace("strain = 0.02\n", ""));
    let outcome = element(&file, &folder.join("out"), &[]);
    let start = "error: test \"path\", material \"fill\": step 3 not converged: residual ";
    assert!(outcome.code == 3 && outcome.stderr.starts_with(start), "{}", outcome.stderr);
    assert!(outcome.stderr.ends_with(" of the stress (limit 1e-10) with 1024 parts\n"), "{}", outcome.stderr);
    assert!(!folder.join("out").exists());
}
