//! Commands, result locations and exit codes.

use super::support::{
    COUPLED, Folder, GRAINS, SOLID, Table, compile, json, repository, run, scene_folder, small_block,
    trackbed, trackbed_in, write_lists,
};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

#[test]
fn help_names_every_command_and_option() {
    let help = trackbed(["--help"]).good().stdout;
    for word in ["run", "check", "explain", "study", "mesh", "stone", "--help", "--version"] {
        assert!(help.contains(word), "{word} is missing in {help}");
    }
    let help = trackbed(["run", "--help"]).good().stdout;
    for word in ["SCENE", "--out", "--threads", "--set", "--quiet"] {
        assert!(help.contains(word), "{word} is missing in {help}");
    }
    let help = trackbed(["mesh", "--help"]).good().stdout;
    for word in ["info", "check", "convert"] {
        assert!(help.contains(word), "{word} is missing in {help}");
    }
}

/// `explain` adds stages, kernels, memory and time to the output of `check`.
#[test]
fn explain_reports_more_than_check() {
    let scene = repository().join("inputs/grains/rolling.toml").display().to_string();
    let (checked, explained) =
        (trackbed(["check", &scene]).good().stdout, trackbed(["explain", &scene]).good().stdout);
    let more = explained.strip_prefix(&checked).expect("explain begins as check does");
    for word in ["stages: run", "Hertz-Mindlin", "rolling and twisting", " B per sphere", "M sphere-steps/s"]
    {
        assert!(more.contains(word), "{word} is missing in {more}");
    }
    let bytes = more
        .split(" B per sphere")
        .next()
        .and_then(|t| t.rsplit(' ').next())
        .and_then(|t| t.parse::<f64>().ok());
    assert!(bytes.is_some_and(|b| (150.0..600.0).contains(&b)), "{more}");
}

#[test]
fn version_is_that_of_the_package() {
    assert_eq!(trackbed(["--version"]).good().stdout, format!("trackbed {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn wrong_usage_is_bad_input() {
    for arguments in
        [&[][..], &["run"], &["dance"], &["run", "scene.toml", "--threads", "two"], &["mesh", "info"]]
    {
        let outcome = trackbed(arguments);
        assert_eq!(outcome.code, 2, "{arguments:?}: {outcome:?}");
        assert!(!outcome.stderr.is_empty() && !outcome.stderr.contains("panicked"), "{outcome:?}");
    }
    let folder = scene_folder("threads_zero", SOLID);
    let scene = folder.join("scene.toml").display().to_string();
    let outcome = trackbed_in(folder.path(), ["run", &scene, "--threads", "0"]);
    assert_eq!(outcome.code, 2);
    assert!(outcome.stderr.starts_with("error: --threads: found 0, expected 1 to "), "{outcome:?}");
    assert!(!folder.join("results").exists());
}

#[test]
fn replaced_options_name_the_new_one() {
    for (arguments, old, new) in [
        (["render", "results", "--least", "0.1"], "--least", "--min-force"),
        (["explain", "scene.toml", "--rehearse", "1"], "--rehearse", "--trial"),
    ] {
        let outcome = trackbed(arguments);
        let line = format!("error: {}: found `{old}`, expected `{new}`\n", arguments[0]);
        assert_eq!((outcome.code, outcome.stderr.as_str()), (2, line.as_str()));
    }
    let together = trackbed(["render", "results", "--least=0.1"]);
    assert!(together.stderr.contains("found `--least`, expected `--min-force`"), "{together:?}");
    let other = trackbed(["explain", "scene.toml", "--least", "1"]);
    assert!(other.code == 2 && !other.stderr.contains("--min-force`"), "{other:?}");
}

fn scenes(dir: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(scenes(&path));
        } else if path.file_name().is_some_and(|n| n == "scene.toml") {
            found.push(path);
        }
    }
    found
}

/// Builds the library of `inputs/solid/umat` beside its scene, as the header of the scene states.
fn build_library() {
    static BUILT: OnceLock<()> = OnceLock::new();
    BUILT.get_or_init(|| {
        let folder = repository().join("inputs/solid/umat");
        let beside = folder.join(format!("{}.so", std::process::id()));
        fs::copy(compile(&folder.join("hypoplastic_sand.c")), &beside).unwrap();
        fs::rename(beside, folder.join("hypoplastic_sand.so")).unwrap();
    });
}

/// Shipped scenes that run: files with a title that are no studies.
pub fn inputs() -> Vec<PathBuf> {
    build_library();
    let mut found = Vec::new();
    let mut folders = vec![repository().join("inputs")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "toml") {
                let text = fs::read_to_string(&path).unwrap();
                let has = |key: &str| text.lines().any(|line| line.starts_with(key));
                let is_scene = has("title =") && !has("scene =");
                // A free body has modes, but no run.
                let runs = is_scene && !text.contains("trackbed modal");
                found.extend(runs.then_some(path));
            }
        }
    }
    found.sort();
    found
}

#[test]
fn explain_reports_every_shipped_scene() {
    explain_all(|k| k % 4 == 0);
}

#[test]
#[ignore = "trial runs of all scenes, 2 min"]
fn explain_tries_every_shipped_scene() {
    explain_all(|_| true);
}

/// `tries`: scenes with a trial run.
fn explain_all(tries: impl Fn(usize) -> bool) {
    let scenes = inputs();
    assert!(scenes.len() >= 35, "{scenes:?}");
    for (k, scene) in scenes.into_iter().enumerate() {
        // A trial run completes a radius expansion and a strength reduction once begun.
        let long = ["rock-ucs/specimen", "rock-ucs/triaxial", "rock-ucs/brazilian", "solid/slope"];
        let long = !tries(k) || long.iter().any(|name| scene.ends_with(format!("{name}.toml")));
        let words =
            [Path::new("explain"), &scene, Path::new("--trial"), Path::new(if long { "0" } else { "0.03" })];
        let explained = trackbed(words).good().stdout;
        assert!(explained.contains("\n  stages: "), "{scene:?}: {explained}");
        assert!(long || explained.contains(", from a trial run: "), "{scene:?}: {explained}");
        assert!(!explained.contains("NaN") && !explained.contains("inf "), "{scene:?}: {explained}");
        assert_eq!(
            explained.contains("\n  grains: "),
            explained.contains("M sphere-steps/s"),
            "{scene:?}: {explained}"
        );
    }
}

#[test]
fn explain_survives_materials_beyond_reason() {
    let scene = repository().join("inputs/grains/column.toml").display().to_string();
    for stiffness in ["1e-300", "1e300"] {
        let set = format!("material.0.stiffness={stiffness}");
        let outcome = trackbed(["explain", &scene, "--set", &set, "--trial", "0.2"]);
        assert!(!outcome.stderr.contains("panicked"), "{outcome:?}");
        assert!(outcome.code == 2 || outcome.stdout.contains("stages: "), "{outcome:?}");
    }
}

#[test]
fn a_short_run_is_rehearsed_whole() {
    let scene = repository().join("inputs/verify/bounce.toml").display().to_string();
    let folder = Folder::new("rehearsed");
    let explain = |more: &[&str]| -> serde_json::Value {
        let words = ["explain", &scene, "--json", "--threads", "1"].into_iter().chain(more.iter().copied());
        let words: Vec<&str> = words.collect();
        let program = env!("CARGO_BIN_EXE_trackbed");
        let outcome = Command::new(program).args(&words).env("TMPDIR", folder.path()).output().unwrap();
        serde_json::from_slice(&outcome.stdout).unwrap()
    };
    let time = &explain(&["--trial", "60"])["time"];
    assert_eq!(time["threads"], 1);
    let stages = time["stages"].as_array().unwrap();
    assert!(stages.iter().all(|s| s["known"] == "measured"), "{time}");
    assert_eq!(stages.last().unwrap()["name"], "run");
    let sum: f64 = stages.iter().map(|s| s["seconds"].as_f64().unwrap()).sum();
    assert!(sum > 0.0 && (time["seconds"].as_f64().unwrap() - sum).abs() < 1e-9 * sum, "{time}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0, "the folder of the rehearsal is removed");
    assert!(explain(&["--trial", "0"]).get("time").is_none());
    let refused = trackbed(["explain", &scene, "--trial=-1"]);
    assert!(refused.code == 2 && refused.stderr.contains("--trial: found -1, expected 0 to"), "{refused:?}");
}

#[test]
fn long_run_is_estimated_from_trial() {
    let scene = repository().join("inputs/grains/rolling.toml").display().to_string();
    let words = ["explain", &scene, "--json", "--threads", "1", "--trial", "0.2", "--set", "time.end=1000"];
    let report: serde_json::Value = serde_json::from_str(&trackbed(words).good().stdout).unwrap();
    let last = report["time"]["stages"].as_array().unwrap().last().unwrap();
    assert_eq!((last["name"].as_str(), last["known"].as_str()), (Some("run"), Some("expected")), "{report}");
    assert!(last["seconds"].as_f64().unwrap() > 1.0, "{report}");
}

#[test]
fn check_accepts_every_shipped_scene() {
    build_library();
    let shipped = [scenes(&repository().join("inputs")), scenes(&repository().join("tests/data"))].concat();
    assert!(shipped.len() >= 8, "{shipped:?}");
    for scene in shipped {
        let outcome = trackbed([Path::new("check"), &scene]).good();
        assert!(outcome.stderr.is_empty(), "{}", outcome.stderr);
        assert!(
            outcome.stdout.contains("solid: ") || outcome.stdout.contains("grains: "),
            "{}",
            outcome.stdout
        );
    }
}

#[test]
fn check_tells_sizes_steps_and_stability() {
    let folder = scene_folder("check", COUPLED);
    let scene = folder.join("scene.toml");
    let brief = trackbed([Path::new("check"), &scene]).good().stdout;
    assert!(!brief.contains("stability W") && !brief.contains("Gauss2"), "{brief}");
    let text = trackbed([Path::new("check"), &scene, Path::new("--verbose")]).good().stdout;
    let parts = [
        "spheres on a block\n",
        "81 nodes, 8 elements, 180 unknowns",
        "5 bodies with 5 spheres",
        "step ",
        "effective mass",
        "4 faces, 10 DEM steps per window",
        "stability W = ",
    ];
    for part in parts {
        assert!(text.contains(part), "{part} is missing in {text}");
    }
    assert!(!folder.join("results").exists(), "check writes nothing");
    folder.write("scene.toml", SOLID);
    assert!(
        trackbed([Path::new("check"), &folder.join("scene.toml")])
            .good()
            .stdout
            .contains("statics: one solve")
    );
}

#[test]
fn results_directory_follows_scene_name() {
    let folder = Folder::new("default");
    folder.write("pair/scene.toml", GRAINS);
    folder.write("two_spheres.toml", GRAINS);
    // `scene.toml` takes its directory's name.
    trackbed_in(folder.path(), ["run", "pair/scene.toml"]).good();
    trackbed_in(folder.path(), ["run", "two_spheres.toml"]).good();
    for name in ["pair", "two_spheres"] {
        let summary = json(&folder.join("results").join(name).join("summary.json"));
        assert_eq!(summary["status"], "done");
    }
    assert_eq!(fs::read_dir(folder.join("results")).unwrap().count(), 2);
}

#[test]
fn quiet_is_silent_default_reports() {
    let folder = scene_folder("quiet", COUPLED);
    let (scene, out) = (folder.join("scene.toml"), folder.join("out"));
    let outcome = run(&scene, &out, &[]).good();
    assert_eq!((outcome.stdout.as_str(), outcome.stderr.as_str()), ("", ""));
    let outcome = trackbed([Path::new("run"), &scene, Path::new("--force"), Path::new("--out"), &out]).good();
    for part in ["run: ", "DEM steps", "energy error", "interface: ", "settlement after each cycle"] {
        assert!(outcome.stdout.contains(part), "{part} is missing in {}", outcome.stdout);
    }
}

#[test]
fn overrides_change_the_scene() {
    let folder = scene_folder("override", SOLID);
    let scene = folder.join("scene.toml");
    let lowest = |set: &[&str]| {
        run(&scene, &folder.join("out"), set).good();
        Table::read(&folder.join("out/nodes.csv")).column("uz").into_iter().fold(0.0, f64::min)
    };
    let (soft, stiff) = (lowest(&[]), lowest(&["solid.material.0.young=40 MPa"]));
    assert!((soft / stiff - 2.0).abs() < 1e-9, "twice the modulus, half the displacement: {soft} {stiff}");
    assert_eq!(json(&folder.join("out/summary.json"))["overrides"][0], "solid.material.0.young=40 MPa");
}

#[test]
fn rejects_file_as_output() {
    let folder = scene_folder("unwritable", SOLID);
    folder.write("taken", "a file");
    let outcome = run(&folder.join("scene.toml"), &folder.join("taken"), &[]);
    assert_eq!((outcome.code, outcome.stderr.lines().count()), (2, 1), "{outcome:?}");
    assert!(outcome.stderr.contains("taken: found a file, expected a directory"), "{outcome:?}");
    assert_eq!(fs::read_to_string(folder.join("taken")).unwrap(), "a file");
}

#[test]
fn mesh_info_of_the_main_scene() {
    let lists = repository().join("inputs/track/cyclic");
    let by_folder = trackbed([Path::new("mesh"), Path::new("info"), &lists]).good().stdout;
    let by_scene = trackbed([Path::new("mesh"), Path::new("info"), &lists.join("scene.toml")]).good().stdout;
    assert_eq!(by_folder, by_scene);
    let row = |name: &str| {
        by_folder.lines().find(|l| l.trim_start().starts_with(name)).unwrap_or_default().to_string()
    };
    for (name, value) in
        [("nodes", "3834"), ("elements", "684"), ("volume", "28.9800"), ("material 2", "264 elements")]
    {
        assert!(row(name).contains(value), "{name} should be {value}:\n{by_folder}");
    }
}

#[test]
fn mesh_check_detects_bad_elements() {
    let check = |input: &Path| trackbed([Path::new("mesh"), Path::new("check"), input]);
    let sound = check(&repository().join("inputs/track/cyclic")).good();
    assert!(sound.stdout.contains("no defects found"), "{}", sound.stdout);

    let broken = |name: &str, change: &dyn Fn(&mut trackbed_fem::Mesh), parts: &[&str]| {
        let folder = Folder::new(name);
        let mut mesh = small_block();
        change(&mut mesh);
        write_lists(&mesh, folder.path());
        let outcome = check(folder.path());
        assert_eq!((outcome.code, outcome.stderr.lines().count()), (2, 1), "{outcome:?}");
        assert!(outcome.stderr.starts_with("error: ") && outcome.stdout.is_empty(), "{outcome:?}");
        for part in parts {
            assert!(outcome.stderr.contains(part), "{part} is missing in {}", outcome.stderr);
        }
    };
    // Bottom and top swapped: I…L with M…P, Q…T with U…X.
    let turn = |m: &mut trackbed_fem::Mesh| {
        m.connectivity[1][..8].rotate_left(4);
        m.connectivity[1][8..16].rotate_left(4);
    };
    broken("upside_down", &turn, &["element 2 is inverted"]);
    // Only corners swapped: positive at reduced Gauss points, negative at corners.
    broken("tangled", &|m| m.connectivity[1][..8].rotate_left(4), &["element 2 is inverted at corner"]);
    let apart = |m: &mut trackbed_fem::Mesh| {
        let shift = m.coordinates.len() as u32;
        let other = small_block();
        m.coordinates.extend(other.coordinates.iter().map(|[x, y, z]| [x + 5.0, *y, *z]));
        m.node_ids.extend((1..=shift).map(|n| n + shift));
        for (e, nodes) in other.connectivity.iter().enumerate() {
            let nodes: Vec<u32> = nodes.iter().map(|n| n + shift).collect();
            m.push_element(9 + e as u32, 1, trackbed_fem::ElementKind::Hex20, &nodes);
        }
    };
    broken("apart", &apart, &["2 unconnected parts", "element 1 (8 in all)", "element 9 (8 in all)"]);

    let folder = Folder::new("loose");
    write_lists(&small_block(), folder.path());
    fs::remove_file(folder.join("DOF.DAT")).unwrap();
    let outcome = check(folder.path()).good();
    assert!(outcome.stdout.contains("the mesh contains no constraints"), "{outcome:?}");
    let outcome = check(&folder.join("nowhere"));
    assert_eq!((outcome.code, outcome.stderr.lines().count()), (2, 1), "{outcome:?}");
}

#[test]
fn mesh_convert_rejects_unknown_extensions() {
    let folder = Folder::new("convert");
    let lists = repository().join("inputs/track/cyclic");
    let convert = |output: &Path| trackbed([Path::new("mesh"), Path::new("convert"), &lists, output]);
    let file = folder.join("mesh.vtu");
    convert(&file).good();
    let vtkio::model::DataSet::UnstructuredGrid { mut pieces, .. } = vtkio::Vtk::import(&file).unwrap().data
    else {
        panic!("no grid")
    };
    let piece = pieces.remove(0).into_loaded_piece_data(None).unwrap();
    assert_eq!((piece.points.len(), piece.cells.types.len()), (3 * 3834, 684));

    let kept = folder.write("lists/DOF.DAT", "mine");
    for output in [&file, &folder.join("lists")] {
        let outcome = convert(output);
        let sentence = "found an existing file, expected a new file, or --force to overwrite it\n";
        assert!(outcome.code == 2 && outcome.stderr.ends_with(sentence), "{outcome:?}");
    }
    assert_eq!(std::fs::read_to_string(kept).unwrap(), "mine");
    trackbed([Path::new("mesh"), Path::new("convert"), &lists, &file, Path::new("--force")]).good();

    let outcome = convert(&folder.join("mesh.stl"));
    assert_eq!(outcome.code, 2, "{outcome:?}");
    assert!(outcome.stderr.contains("expected a file .cdb") && !folder.join("mesh.stl").exists());
}

#[test]
fn check_reports_coupling_stability() {
    let scene = repository().join("inputs/track/cyclic/scene.toml");
    let numbers = |substeps: &str| {
        let set = format!("coupling.substeps={substeps}");
        let scheme = "coupling.scheme=predicted";
        let outcome =
            trackbed(["check", scene.to_str().unwrap(), "--verbose", "--set", &set, "--set", scheme]).good();
        let after = |mark: &str| -> f64 {
            let rest = outcome.stdout.split_once(mark).unwrap().1;
            rest.split([',', ' ']).next().unwrap().parse().unwrap()
        };
        [after("W = "), after("D = ")]
    };
    let (shipped, twice) = (numbers("40"), numbers("80"));
    for k in 0..2 {
        assert!(shipped[k] > 0.05 && shipped[k] < 1.0, "{shipped:?}");
        assert!((twice[k] / shipped[k] - 2.0).abs() < 0.01, "{shipped:?} {twice:?}");
    }
}
