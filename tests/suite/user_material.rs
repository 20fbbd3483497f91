//! User materials of shared libraries: runs, restarts, errors.

use super::checkpoint::broken;
use super::element::element;
use super::support::{
    COUPLED, Folder, PLASTIC, Table, compile, json, repository, run, scene_folder, trackbed,
};
use std::fs;
use std::path::Path;

/// Not the reference elasticity, so that Newton iterates.
const ELASTIC: &str = "constants = [15e6, 0.25]";
/// Cohesion 2 kPa, friction 0.6, dilation 0.1 rad on the compression cone.
const CONE: [f64; 5] = [20e6, 0.3, 0.8031588309704455, 2347.9480161789734, 0.11924594326272998];
const SAND: &str = "constants = [33, 1500e6, 0.28, 0.55, 0.95, 1.05, 0.25, 1.0, 10e3], states = [{ name = \"void_ratio\", initial = 0.7 }]";

fn cone() -> String {
    format!("constants = {CONE:?}, states = [{{ name = \"kappa\" }}], energy = \"library\"")
}

/// Overrides of the first material of the solid.
fn overrides(source: &str, keys: &str) -> [String; 2] {
    let library = compile(&repository().join("inputs/solid/umat").join(source));
    let table = format!("{{ library = {:?}, {keys} }}", library.display().to_string());
    ["solid.material.0.model=umat".into(), format!("solid.material.0.umat={table}")]
}

fn words(set: &[String]) -> Vec<&str> {
    set.iter().map(String::as_str).collect()
}

#[test]
fn grains_on_user_materials_resume() {
    let folder = scene_folder("umat_coupled", COUPLED);
    for (source, keys) in
        [("elastic.c", ELASTIC), ("drucker_prager.c", &cone()), ("hypoplastic_sand.c", SAND)]
    {
        let set = overrides(source, keys);
        broken(&folder.join("scene.toml"), &words(&set), &[0.0, 0.4, 0.8, 1.0], &["cycles.csv"]);
        let out = folder.join("energy");
        let mut set = words(&set);
        set.push("output.tables=true");
        run(&folder.join("scene.toml"), &out, &set).good();
        let summary = json(&out.join("summary.json"));
        let error = summary["energy"]["relative_error"].as_f64().unwrap();
        println!("{source}: energy error {error:.1e}");
        assert!(error < 1e-3, "{source}: {error}");
        fs::remove_dir_all(out).unwrap();
    }
}

#[test]
fn solids_of_user_materials_resume() {
    let folder = Folder::new("umat_solid");
    let scene = folder.write("scene.toml", PLASTIC);
    for (source, keys) in
        [("elastic.c", ELASTIC), ("drucker_prager.c", &cone()), ("hypoplastic_sand.c", SAND)]
    {
        let mut set = overrides(source, keys).to_vec();
        set.extend(["output.tables=true", "solid.gravity=true"].map(String::from));
        broken(&scene, &words(&set), &[0.3, 0.8, 1.0], &["gauss.csv", "history.csv"]);
    }
}

#[test]
fn drucker_prager_scene_matches_builtin_law() {
    let folder = Folder::new("umat_cone");
    let scene = folder.write("scene.toml", PLASTIC);
    let common = ["output.tables=true", "solid.newton.tolerance=1e-12", "solid.newton.max_iterations=60"];
    let ours = [
        "solid.material.0.model=drucker_prager",
        "solid.material.0.young=20e6",
        "solid.material.0.cohesion=2000",
        "solid.material.0.friction=0.6",
        "solid.material.0.dilation=0.1",
        "solid.material.0.cone=compression",
    ];
    run(&scene, &folder.join("ours"), &[&ours[..], &common[..]].concat()).good();
    let theirs = [overrides("drucker_prager.c", &cone()).to_vec(), vec![ours[1].into()]].concat();
    run(&scene, &folder.join("theirs"), &[&words(&theirs)[..], &common[..]].concat()).good();
    let [a, b] = ["ours", "theirs"].map(|out| Table::read(&folder.join(out).join("gauss.csv")));
    let largest = a.column("szz").iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    for name in ["sxx", "syy", "szz", "sxy", "syz", "szx", "equivalent_plastic_strain"] {
        let size = if name.starts_with('s') { largest } else { 1.0 };
        for (a, b) in a.column(name).iter().zip(b.column(name)) {
            assert!((a - b).abs() < 1e-10 * size, "{name}: {a} {b}");
        }
    }
    assert!(b.column("state_kappa").iter().any(|kappa| *kappa > 1e-3));
}

#[test]
fn shipped_scene_resumes() {
    let scene = repository().join("inputs/solid/umat/scene.toml");
    let library = compile(&repository().join("inputs/solid/umat/hypoplastic_sand.c"));
    let library = format!("solid.material.0.umat.library={}", library.display());
    let set = [library.as_str(), "time.solid_step=0.25", "solid.initial_stress.steps=2"];
    broken(&scene, &set, &[0.3, 1.0], &["gauss.csv", "history.csv"]);
}

#[test]
fn element_tests_accept_user_materials() {
    let folder = Folder::new("umat_element");
    let library = |source: &str| compile(&repository().join("inputs/solid/umat").join(source));
    let material = |name: &str, source: &str, keys: &str| {
        let library = library(source).display().to_string();
        format!(
            "[[material]]\nname = \"{name}\"\nmodel = \"umat\"\nyoung = \"20 MPa\"\npoisson = 0.3\ndensity = 1900\n\
             umat = {{ library = {library:?}, {keys} }}\n\n"
        )
    };
    let test = |kind: &str| {
        format!("[[test]]\nkind = \"{kind}\"\nstress = \"100 kPa\"\nstrain = 0.02\nsteps = 40\n\n")
    };
    let mut text = material("elastic", "elastic.c", ELASTIC) + &material("cone", "drucker_prager.c", &cone());
    text += &material("sand", "hypoplastic_sand.c", SAND);
    text += "[[material]]\nname = \"ours\"\nmodel = \"drucker_prager\"\nyoung = \"20 MPa\"\npoisson = 0.3\ndensity = 1900\n\
             cohesion = 2000\nfriction = 0.6\ndilation = 0.1\ncone = \"compression\"\n\n";
    let kinds = ["triaxial", "undrained", "oedometer", "simple_shear"];
    kinds.iter().for_each(|kind| text += &test(kind));
    let said = element(&folder.write("el.toml", &text), &folder.join("out"), &[]).good().stdout;
    assert_eq!(said.matches("    tangent: passed, ").count(), 16, "{said}");
    assert_eq!(said.matches("    dissipation: not applicable to this law").count(), 12, "{said}");
    for kind in kinds {
        let [a, b] =
            ["ours", "cone"].map(|name| Table::read(&folder.join(&format!("out/{kind}_{name}.csv"))));
        for name in ["p", "q", "stress_xx", "stress_zz", "stress_zx"] {
            let largest = a.column(name).iter().fold(1e3_f64, |m, s| m.max(s.abs()));
            for (a, b) in a.column(name).iter().zip(b.column(name)) {
                assert!((a - b).abs() < 1e-10 * largest, "{kind} {name}: {a} {b}");
            }
        }
    }
}

/// Line of the table `umat` in the scene of [`refused`].
fn line() -> usize {
    let before = PLASTIC.split("model = \"mohr_coulomb\"").next().unwrap();
    before.lines().count() + 5
}

/// Error of `run` and `check` for the solid of [`PLASTIC`] with `umat`.
fn refused(folder: &Folder, umat: &str) -> String {
    let text = PLASTIC.replace(
        "model = \"mohr_coulomb\"\nyoung = \"20 MPa\"\npoisson = 0.3\ndensity = 1900\ncohesion = \"20 kPa\"\nfriction = \"25 deg\"\ndilation = \"5 deg\"",
        &format!("model = \"umat\"\nyoung = \"20 MPa\"\npoisson = 0.3\ndensity = 1900\numat = {{ {umat} }}"),
    );
    let scene = folder.write("scene.toml", &text);
    let outcome = run(&scene, &folder.join("out"), &[]);
    assert_eq!(outcome.code, 2, "{}", outcome.stderr);
    let checked = trackbed([Path::new("check"), &scene]);
    assert_eq!((checked.code, &checked.stderr), (2, &outcome.stderr));
    outcome
        .stderr
        .replace(&format!("{}/", folder.path().canonicalize().unwrap().display()), "")
        .replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn rejects_unusable_libraries() {
    let folder = Folder::new("umat_bad");
    let system = format!("{} {}", std::env::consts::ARCH, std::env::consts::OS);
    let error = refused(&folder, "library = \"none.so\"");
    let expected = format!(
        "error: scene.toml:{}: solid.material.1.umat.library: found none.so (No such file or directory (os error 2)), expected an existing shared library\n",
        line()
    );
    assert_eq!(error, expected);

    let wanted = format!("expected a shared library for {system} without undefined symbols\n");
    folder.write("text.so", "no library");
    let error = refused(&folder, "library = \"text.so\"");
    assert!(error.contains("umat.library: found text.so: ") && error.ends_with(&wanted), "{error}");

    let good = compile(&repository().join("inputs/solid/umat/elastic.c"));
    let mut bytes = fs::read(&good).unwrap();
    // Another machine in the ELF header.
    bytes[18] = if bytes[18] == 0xb7 { 0x3e } else { 0xb7 };
    fs::write(folder.join("other.so"), bytes).unwrap();
    let error = refused(&folder, "library = \"other.so\"");
    assert!(error.contains("umat.library: found other.so: ") && error.ends_with(&wanted), "{error}");

    let source = "void xit_(void);\nvoid umat_(void) { xit_(); }\n";
    fs::copy(compile(&folder.write("undefined.c", source)), folder.join("undefined.so")).unwrap();
    let error = refused(&folder, "library = \"undefined.so\"");
    assert!(error.contains("undefined symbol: xit_") && error.ends_with(&wanted), "{error}");

    fs::copy(good, folder.join("good.so")).unwrap();
    let expectations = [
        (
            "routine = \"vumat_\"",
            "umat.routine: found no symbol `vumat_` in good.so, expected an exported symbol, in Fortran lower case with `_`",
        ),
        (
            "constants = [1, 2, 3]",
            "umat.constants: found 3 values, but good.so declares 2, expected 2 values",
        ),
        ("constants = [1, nan]", "umat.constants: found NaN, expected finite numbers"),
        (
            "constants = [1, 2], states = [{ name = \"e\" }]",
            "umat.states: found 1 variables, but good.so declares 0, expected 0 variables",
        ),
    ];
    for (keys, expected) in expectations {
        let error = refused(&folder, &format!("library = \"good.so\", {keys}"));
        assert_eq!(error, format!("error: scene.toml:{}: solid.material.1.{expected}\n", line()));
    }
}

#[test]
fn rejects_unusable_names_of_states() {
    let folder = Folder::new("umat_names");
    let library = compile(&repository().join("inputs/solid/umat/hypoplastic_sand.c"));
    fs::copy(library, folder.join("sand.so")).unwrap();
    for (name, found) in [
        ("void_ratio\" }, { name = \"void_ratio", "the name \"void_ratio\" twice"),
        ("Void ratio", "the name \"Void ratio\""),
    ] {
        let keys = SAND.replace("void_ratio", name);
        let error = refused(&folder, &format!("library = \"sand.so\", {keys}"));
        assert!(error.contains(&format!("umat.states: found {found}, expected ")), "{error}");
    }
}

#[test]
fn rejects_strength_reduction_and_missing_table() {
    let folder = Folder::new("umat_keys");
    let scene = folder.write("scene.toml", PLASTIC);
    let set = overrides("elastic.c", ELASTIC);
    let reduction = ["solid.quasi_static=", "time.end=", "time.solid_step=", "solid.strength_reduction={}"];
    let stderr = run(&scene, &folder.join("out"), &[&words(&set)[..], &reduction].concat()).stderr;
    assert!(stderr.contains("solid.material.0.model") && stderr.contains("strength_reduction"), "{stderr}");
    let outcome = run(&scene, &folder.join("out"), &[&set[0]]);
    assert!(outcome.code == 2 && outcome.stderr.contains("umat: found nothing"), "{}", outcome.stderr);
    let outcome = run(&scene, &folder.join("out"), &[&set[1]]);
    let expected = "umat: found, but it has no effect without `model = \"umat\"`";
    assert!(outcome.code == 2 && outcome.stderr.contains(expected), "{}", outcome.stderr);
}

#[test]
fn failing_routine_is_named() {
    let folder = Folder::new("umat_fails");
    let header = repository().join("inputs/solid/umat/umat.h");
    let source =
        format!("#include {:?}\nUMAT_DEFINITION {{ *pnewdt = 0.5; }}\n", header.display().to_string());
    let library = compile(&folder.write("fails.c", &source));
    let scene = folder.write("scene.toml", PLASTIC);
    let set = format!("solid.material.0.umat={{ library = {:?} }}", library.display().to_string());
    let outcome = run(&scene, &folder.join("out"), &["solid.material.0.model=umat", &set]);
    assert_eq!(outcome.code, 3, "{}", outcome.stderr);
    let expected = format!(
        "user material `umat_` of {} failed at time -1, element 1, integration point 1, in the smallest step: a shorter step requested (PNEWDT = 0.5)",
        library.canonicalize().unwrap().display()
    );
    assert!(outcome.stderr.contains(&expected), "{}", outcome.stderr);
}

#[test]
fn resume_rejects_changed_library() {
    let folder = Folder::new("umat_changed");
    let library = folder.join("law.so");
    fs::copy(compile(&repository().join("inputs/solid/umat/elastic.c")), &library).unwrap();
    let scene = folder.write("scene.toml", PLASTIC);
    let set = format!("solid.material.0.umat={{ library = \"law.so\", {ELASTIC} }}");
    let set = ["solid.material.0.model=umat", &set];
    let out = folder.join("out");
    run(&scene, &out, &set).good();
    let summary = json(&out.join("summary.json"));
    let record = &summary["libraries"][0];
    assert_eq!((record["material"].as_str(), record["routine"].as_str()), (Some("base"), Some("umat_")));
    assert_eq!(record["path"].as_str().map(Path::new), Some(&*library.canonicalize().unwrap()));
    assert_eq!(record["hash"].as_str().unwrap().len(), 16);
    let options = trackbed::run::Options {
        out: Some(out.clone()),
        set: set.iter().map(|s| s.to_string()).collect(),
        verbosity: trackbed::run::Verbosity::Quiet,
        interrupt: trackbed::run::Interrupt::after(3),
        force: true,
        ..Default::default()
    };
    trackbed::run::run(&scene, &options).unwrap_err();
    let mut other = fs::read(&library).unwrap();
    other.push(0);
    fs::remove_file(&library).unwrap();
    fs::write(&library, other).unwrap();
    let again = trackbed::run::Options { resume: true, force: false, ..options };
    let error = trackbed::run::run(&scene, &again).unwrap_err();
    assert!(error.code() == 2 && error.to_string().contains("law.so has changed"), "{error}");
}
