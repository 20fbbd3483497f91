//! `run --device gpu` up to where a device begins: what it refuses, and in which words.

use super::support::{COUPLED, GRAINS, Outcome, repository, scene_folder, trackbed};
use std::fs;

/// Runs a scene on a device, into a folder beside it; whether the folder is there afterwards.
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

/// What a device does not compute is named, with exit code 2, before anything is written.
#[test]
fn a_device_refuses_by_name() {
    let cylinder =
        "walls=[{ kind = \"cylinder\", base = [0, 0, -1], radius = 1, height = 3, material = \"stone\" }]";
    let inputs = repository().join("inputs").display().to_string();
    let stones = fs::read_to_string(repository().join("inputs/ballast/box-polyhedra.toml")).unwrap();
    let stones = stones.replace("\"../", &format!("\"{inputs}/"));
    let stones = stones.replace("\"granite-", &format!("\"{inputs}/ballast/granite-"));
    let cases: [(&str, &str, &[&str], &str); 4] = [
        ("device_solid", COUPLED, &[], "solids are not"),
        (
            "device_wall",
            GRAINS,
            &[cylinder],
            "walls other than triangles and planes of steady velocity are not",
        ),
        ("device_wind", GRAINS, &["wind={ drag = 0.9 }"], "body forces other than gravity are not"),
        ("device_stones", &stones, &[], "boxes and polyhedra are not"),
    ];
    for (name, text, set, words) in cases {
        let (outcome, written) = on_device(name, text, set);
        assert_eq!(outcome.code, 2, "{name}: {outcome:?}");
        let sentence = format!("--device gpu: {words} computed on a device, only on the processor");
        assert!(outcome.stderr.contains(&sentence), "{name}: {outcome:?}");
        assert!(!written, "{name}: a folder was left");
    }
}

/// Without the libraries of CUDA one sentence says which is missing; with them the scene runs.
#[test]
fn what_a_device_needs_is_named_where_it_is_missing() {
    let (outcome, written) = on_device("device_missing", GRAINS, &[]);
    let missing = outcome.stderr.contains("(libcuda) is not on this machine")
        || outcome.stderr.contains("(libnvrtc) is not on this machine");
    println!("{outcome:?}");
    match outcome.code {
        0 => assert!(written && !missing),
        code => assert!(code == 2 && missing && !written, "{outcome:?}"),
    }
    let lines = outcome.stderr.lines().filter(|l| l.contains("--device gpu")).count();
    assert!(outcome.code == 0 || lines == 1, "{outcome:?}");
}
