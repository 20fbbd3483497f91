//! Runs that go on from the end of another (`--from`).

use super::support::{Folder, Table, json, repository, results, run, trackbed};
use std::path::Path;

fn from(scene: &Path, out: &Path, before: &Path, set: &[&str]) -> super::support::Outcome {
    let mut words = vec!["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap(), "--from"];
    words.push(before.to_str().unwrap());
    set.iter().for_each(|s| words.extend(["--set", s]));
    trackbed(words)
}

/// Grains that fall, hit and slide: two runs of 100 windows leave them where one of 200 does, to the last bit, with every contact's memory.
#[test]
fn two_halves_are_a_whole() {
    let folder = Folder::new("from_halves");
    let scene = repository().join("inputs/grains/box.toml");
    let common =
        ["grains.0.count=300", "output.history_interval=0.001", "output.packing=true", "output.frames=2"];
    let with = |end: &'static str| [&common[..], &[end]].concat();
    let [whole, first, second, short] = ["whole", "first", "second", "short"].map(|name| folder.join(name));
    run(&scene, &whole, &with("time.end=0.1993")).good();
    run(&scene, &first, &with("time.end=0.0995")).good();
    from(&scene, &second, &first, &with("time.end=0.0995")).good();
    let packing = |out: &Path| std::fs::read_to_string(out.join("packing.csv")).unwrap();
    assert!(packing(&second) == packing(&whole), "the second half ends elsewhere");
    assert!(packing(&first) != packing(&whole));
    // Time and accounts begin anew, and close.
    let (half, all) = (json(&second.join("summary.json")), json(&whole.join("summary.json")));
    let error = |s: &serde_json::Value| s["energy"]["largest_relative_error"].as_f64().unwrap();
    assert!(error(&half) < 2.0 * error(&all) + 1e-3, "{} {}", error(&half), error(&all));
    assert!(half["momentum"]["linear"].as_f64().unwrap() < 1e-9, "{half:#}");
    let history = Table::read(&second.join("history.csv"));
    assert_eq!(history.column("time")[0], 0.0);
    // What a run leaves depends on where it came from, and on nothing else.
    assert_ne!(half["scene_hash"], json(&first.join("summary.json"))["scene_hash"]);
    let again = folder.join("again");
    let mut words = vec!["run", scene.to_str().unwrap(), "--out", again.to_str().unwrap(), "--threads", "1"];
    words.extend(["--from", first.to_str().unwrap()]);
    let set = with("time.end=0.0995");
    set.iter().for_each(|s| words.extend(["--set", s]));
    trackbed(words).good();
    let (a, b) = (results(&second), results(&again));
    assert!(a.keys().eq(b.keys()) && a.iter().all(|(name, bytes)| *bytes == b[name]));
    // A run that did not keep its end cannot be gone on from.
    run(&scene, &short, &with("output.state=false")).good();
    let refused = from(&scene, &folder.join("none"), &short, &with("time.end=0.0995"));
    assert_eq!((refused.code, refused.stderr.lines().count()), (2, 1), "{refused:?}");
    assert!(
        refused.stderr.contains("found no end.state, expected the folder of a finished run"),
        "{refused:?}"
    );
}

/// The main job with more cycles, a higher load and a softer ground: the sleeper goes on from where it was.
#[test]
fn a_track_goes_on_with_another_load_and_ground() {
    let folder = Folder::new("from_track");
    let scene = repository().join("inputs/track/cyclic/scene.toml");
    // A small bed that settles soon.
    let common = [
        "grains.0.count=150",
        "grains.1.count=20",
        "grains.2.count=20",
        "deposition.level=\"0.12 m\"",
        "compaction.1.level=\"0.2 m\"",
        "compaction.0.region=[[-1.2, 0.1, 0.02], [1.2, 0.5, 0.1]]",
        "compaction.1.region=[[-1.2, 0.1, 0.02], [1.2, 0.5, 0.1]]",
        "compaction.2.region=[[-1.2, 0.1, 0.02], [1.2, 0.5, 0.1]]",
        "grains.1.fill={ low = [-1.5, 0.0, 0.0], high = [1.5, 0.2] }",
        "track.load.cycles=2",
        "output.frames=2",
    ];
    let (first, more, soft) = (folder.join("first"), folder.join("more"), folder.join("soft"));
    run(&scene, &first, &common).good();
    from(&scene, &more, &first, &common).good();
    let next = [&common[..], &["track.load.maximum=\"100 kN\"", "solid.material.subgrade.young=\"60 MPa\""]]
        .concat();
    from(&scene, &soft, &first, &next).good();
    let [hard, soft] =
        [&more, &soft].map(|out| Table::read(&out.join("cycles.csv")).column("resilient_deflection"));
    // More load on softer ground: a larger deflection.
    assert!(soft[1] > 1.1 * hard[1] && hard[1] > 0.0, "{hard:?} {soft:?}");
    let summary = json(&more.join("summary.json"));
    assert!(summary["energy"]["largest_relative_error"].as_f64().unwrap() < 0.01, "{summary:#}");
    let stages: Vec<&str> =
        summary["stages"].as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(stages, ["run"], "nothing is packed again");
    // The sleeper starts where it stood: heights follow each other without a gap.
    let height = |out: &Path| Table::read(&out.join("history.csv")).column("sleeper_z");
    let (before, after) = (height(&first), height(&more));
    assert!((before[before.len() - 1] - after[0]).abs() < 1e-12, "{} {}", before[before.len() - 1], after[0]);
    // The report says how the run comes again, where it came from included.
    let page = folder.join("report.html");
    trackbed(["report", more.to_str().unwrap(), "--out", page.to_str().unwrap()]).good();
    let page = std::fs::read_to_string(&page).unwrap();
    assert!(page.contains(&format!(" --from {}", first.display())), "no --from in the report");
    // Another model is refused, by its key, and nothing is written.
    for (set, words) in [
        ("grains.0.count=151", "grains.0.count: found 151, expected 150, as in "),
        ("coupling.scheme=lagged", "coupling.scheme: found \"lagged\", expected nothing, as in "),
        (
            "material.stone.rolling_friction=0.1",
            "material.0.rolling_friction: found 0.1, expected nothing, as in ",
        ),
    ] {
        let out = folder.join("other");
        let other = from(&scene, &out, &first, &[&common[..], &[set]].concat());
        assert!(other.code == 2 && other.stderr.contains(words) && !out.exists(), "{set}: {other:?}");
    }
    // A damaged state is refused.
    let state = first.join("end.state");
    let mut bytes = std::fs::read(&state).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&state, &bytes).unwrap();
    let damaged = from(&scene, &folder.join("damaged"), &first, &common);
    assert!(damaged.code == 2 && damaged.stderr.contains("end.state: damaged"), "{damaged:?}");
}
