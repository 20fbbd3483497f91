//! `run --device gpu`: unsupported features, and runs with stand-ins for the CUDA libraries.

use super::support::{
    COUPLED, Folder, GRAINS, ONE_THREAD, Outcome, repository, results, run, scene_folder, trackbed,
};
use std::fs;
use std::path::Path;
use std::process::Command;

fn on_device(name: &str, text: &str, set: &[&str]) -> (Outcome, bool) {
    let folder = scene_folder(name, text);
    let (scene, out) = (folder.path().join("scene.toml"), folder.path().join("out"));
    let mut arguments: Vec<String> =
        ["run", &scene.display().to_string(), "--out", &out.display().to_string(), "--device", "gpu"]
            .map(String::from)
            .to_vec();
    set.iter().for_each(|s| arguments.extend(["--set".into(), s.to_string()]));
    (trackbed(arguments), out.exists())
}

#[test]
fn a_device_refuses_by_name() {
    let inputs = repository().join("inputs").display().to_string();
    let stones = fs::read_to_string(repository().join("inputs/ballast/box-polyhedra.toml")).unwrap();
    let stones = stones.replace("\"../", &format!("\"{inputs}/"));
    let stones = stones.replace("\"polyhedra-", &format!("\"{inputs}/ballast/polyhedra-"));
    let solid = &COUPLED[..COUPLED.find("[[material]]").unwrap()];
    let cases: [(&str, &str, &[&str], &str); 3] = [
        ("device_solid", solid, &[], "scenes without grains"),
        ("device_wind", GRAINS, &["wind={ drag = 0.9 }"], "body forces other than gravity"),
        ("device_stones", &stones, &[], "scenes of boxes and polyhedra only"),
    ];
    for (name, text, set, words) in cases {
        let (outcome, written) = on_device(name, text, set);
        assert_eq!(outcome.code, 2, "{name}: {outcome:?}");
        let sentence = format!("--device gpu: not supported on a GPU: {words}");
        assert!(outcome.stderr.contains(&sentence), "{name}: {outcome:?}");
        assert!(!written, "{name}: a folder was left");
    }
}

#[test]
fn missing_cuda_library_is_named() {
    let (outcome, written) = on_device("device_missing", GRAINS, &[]);
    let missing =
        outcome.stderr.contains("(libcuda) not found") || outcome.stderr.contains("(libnvrtc) not found");
    println!("{outcome:?}");
    match outcome.code {
        0 => assert!(written && !missing),
        code => assert!(code == 2 && missing && !written, "{outcome:?}"),
    }
    let lines = outcome.stderr.lines().filter(|l| l.contains("--device gpu")).count();
    assert!(outcome.code == 0 || lines == 1, "{outcome:?}");
}

/// Stand-ins for CUDA, compiled from `tests/stand_in`; `None` without a C compiler.
fn stand_in() -> Option<Folder> {
    let folder = Folder::new("stand_in");
    for (source, library) in [("driver.c", "libcuda.so.1"), ("compiler.c", "libnvrtc.so.13")] {
        let options = ["-std=gnu11", "-O1", "-shared", "-fPIC", "-o"];
        let source = repository().join("tests/stand_in").join(source);
        let made = Command::new("cc").args(options).args([folder.join(library), source]).arg("-ldl").output();
        let Ok(made) = made else {
            eprintln!("skipped: no C compiler (cc) on this machine");
            return None;
        };
        assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    }
    Some(folder)
}

fn with_libraries(libraries: &Path, settings: &[(&str, &str)], arguments: &[&str]) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    command.args(arguments).env("LD_LIBRARY_PATH", libraries).env("STAND_IN_FOLDER", libraries);
    command.env(ONE_THREAD.0, ONE_THREAD.1);
    let output = command.envs(settings.iter().copied()).output().unwrap();
    Outcome {
        code: output.status.code().unwrap_or(-1),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

#[test]
fn stand_in_matches_cpu_bitwise() {
    let Some(libraries) = stand_in() else { return };
    let folder = Folder::new("device_runs");
    let scenes: [(&str, &[&str]); 8] = [
        ("verify/asperities/scene.toml", &["time.end=0.1 s"]),
        ("grains/bonded_stone/scene.toml", &["time.end=0.01 s"]),
        ("grains/block.toml", &["time.end=0.02 s", "grains.0.count=120"]),
        ("grains/two_laws.toml", &["time.end=0.05 s"]),
        ("grains/shear.toml", &["time.end=0.02 s"]),
        ("grains/column.toml", &["time.end=0.02 s", "grains.0.count=700"]),
        ("grains/drum.toml", &["time.end=0.05 s"]),
        ("grains/servo.toml", &["time.end=0.05 s"]),
    ];
    for (name, set) in scenes {
        let scene = repository().join("inputs").join(name).display().to_string();
        let out = |kind: &str| folder.join(&format!("{kind}_{}", name.replace('/', "_")));
        run(Path::new(&scene), &out("processor"), set).good();
        let device = out("device").display().to_string();
        let mut arguments = vec!["run", &scene, "--quiet", "--device", "gpu", "--out", &device];
        set.iter().for_each(|s| arguments.extend(["--set", s]));
        with_libraries(libraries.path(), &[], &arguments).good();
        let (ours, theirs) = (results(Path::new(&device)), results(&out("processor")));
        assert!(ours.len() > 4 && ours.keys().eq(theirs.keys()), "{name}");
        ours.iter().for_each(|(file, bytes)| assert!(bytes == &theirs[file], "{name}: {file} differs"));
    }
}

#[test]
fn coupled_stand_in_matches_cpu_bitwise() {
    let Some(libraries) = stand_in() else { return };
    let folder = scene_folder("device_coupled", COUPLED);
    let scene = folder.join("scene.toml").display().to_string();
    for scheme in ["predicted", "stiffened", "lagged", "iterated"] {
        let scheme = format!("coupling.scheme=\"{scheme}\"");
        let set = [&scheme[..], "track.load.cycles=1", "output.checkpoint=2 ms"];
        let out = |kind: &str| folder.join(&format!("{kind}_{}", &scheme[17..scheme.len() - 1]));
        run(Path::new(&scene), &out("processor"), &set).good();
        let device = out("device").display().to_string();
        let mut arguments = vec!["run", &scene, "--quiet", "--out", &device];
        set.iter().for_each(|s| arguments.extend(["--set", s]));
        let begin = [&arguments[..], &["--device", "gpu"]].concat();
        let failed = with_libraries(libraries.path(), &[("STAND_IN_LAUNCHES", "900")], &begin);
        assert_eq!(failed.code, 3, "{failed:?}");
        with_libraries(libraries.path(), &[], &[&begin[..], &["--resume"]].concat()).good();
        let (ours, theirs) = (results(Path::new(&device)), results(&out("processor")));
        assert!(ours.len() > 4 && ours.keys().eq(theirs.keys()), "{scheme}");
        ours.iter().for_each(|(file, bytes)| assert!(bytes == &theirs[file], "{scheme}: {file} differs"));
    }
}

#[test]
fn verification_has_columns_of_device_and_ranks() {
    let folder = Folder::new("device_verify");
    let verified = |libraries: &Path, name: &str| {
        let (matrix, out) = (repository().join("inputs/verify/matrix.toml"), folder.join(name));
        let [file, to] = [&matrix, &out].map(|path| path.display().to_string());
        let rows = ["--only", "oxide-restitution", "thick-cylinder"];
        let arguments =
            [&["verify", "--gpu", "--ranks", "2", "--quiet", "--matrix", &file, "--out", &to][..], &rows]
                .concat();
        with_libraries(libraries, &[], &arguments).good();
        let text = fs::read_to_string(out.join("verify.json")).unwrap();
        serde_json::from_str::<serde_json::Value>(&text).unwrap()
    };
    let absent = verified(folder.path(), "without");
    if absent["rows"][0]["cells"]["trackbed_gpu"]["state"] == "skipped" {
        let missing = absent["programs"][1]["missing"].as_str().unwrap();
        assert!(missing.contains("not found"), "{missing}");
    }
    if cfg!(not(feature = "mpi")) {
        assert_eq!(absent["programs"][2]["missing"], "built without the feature `mpi`");
    }
    let Some(libraries) = stand_in() else { return };
    let found = verified(libraries.path(), "with");
    let cells = |k: usize, name: &str| found["rows"][k]["cells"][name].clone();
    assert_eq!(cells(0, "trackbed_gpu")["value"], cells(0, "trackbed")["value"]);
    assert!(cells(0, "trackbed_gpu")["value"].is_f64(), "{found}");
    assert_eq!(cells(1, "trackbed_gpu")["state"], "not_modelled");
    // A device that fails, fails the verification.
    let matrix = repository().join("inputs/verify/matrix.toml").display().to_string();
    let out = folder.join("failed").display().to_string();
    let arguments = ["verify", "--gpu", "--matrix", &matrix, "--out", &out, "--only", "oxide-restitution"];
    let failed = with_libraries(libraries.path(), &[("STAND_IN_LAUNCHES", "90")], &arguments);
    assert!(
        failed.code == 3 && failed.stdout.contains("trackbed, GPU: `oxide-restitution` failed: "),
        "{failed:?}"
    );
}

#[test]
fn a_device_that_fails_is_named() {
    let Some(libraries) = stand_in() else { return };
    let folder = scene_folder("device_fails", GRAINS);
    let (scene, out) = (folder.join("scene.toml"), folder.join("out"));
    let (scene, out) = (scene.display().to_string(), out.display().to_string());
    let arguments = ["run", &scene, "--out", &out, "--force", "--device", "gpu"];
    let cases =
        [("STAND_IN_LAUNCHES", "40", 3, "LAUNCH_FAILED"), ("STAND_IN_MEMORY", "300", 2, "OUT_OF_MEMORY")];
    for (setting, value, code, words) in cases {
        let outcome = with_libraries(libraries.path(), &[(setting, value)], &arguments);
        println!("{}", outcome.stderr);
        assert_eq!(outcome.code, code, "{outcome:?}");
        assert!(outcome.stderr.contains(words), "{outcome:?}");
    }
}

#[test]
fn resumes_after_device_failure() {
    let Some(libraries) = stand_in() else { return };
    let folder = Folder::new("device_goes_on");
    let scene = repository().join("inputs/grains/block.toml").display().to_string();
    let set = ["time.end=0.02 s", "grains.0.count=120", "output.checkpoint=1 ms"];
    run(Path::new(&scene), &folder.join("whole"), &set).good();
    for more in [&["--resume", "--device", "gpu"][..], &["--resume"]] {
        let out = folder.join(&format!("out_{}", more.len())).display().to_string();
        let mut arguments = vec!["run", &scene, "--quiet", "--out", &out];
        set.iter().for_each(|s| arguments.extend(["--set", s]));
        let begin = [&arguments[..], &["--device", "gpu"]].concat();
        let failed = with_libraries(libraries.path(), &[("STAND_IN_LAUNCHES", "2500")], &begin);
        assert_eq!(failed.code, 3, "{failed:?}");
        with_libraries(libraries.path(), &[], &[&arguments[..], more].concat()).good();
        let (ours, theirs) = (results(Path::new(&out)), results(&folder.join("whole")));
        assert!(ours.keys().eq(theirs.keys()));
        ours.iter().for_each(|(file, bytes)| assert!(bytes == &theirs[file], "{more:?}: {file} differs"));
    }
}
