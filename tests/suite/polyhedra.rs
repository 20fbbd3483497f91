//! Polyhedra on a solid, through the program: what a small track scene finds, and what is refused.

use super::support::{Folder, json, repository, run};

/// A small bed of polyhedra on the main job's mesh, pressed by its sleeper and poured around, under one quick cycle: the accounts
/// close (energy within 0.5 %, force and moment across the interface within 1e-11).
#[test]
fn a_small_track_of_polyhedra() {
    let scene = repository().join("inputs/track/polyhedra/scene.toml");
    let folder = Folder::new("track_polyhedra");
    let set = [
        "grains.0.count=40",
        "grains.1.count=6",
        "deposition.max_time=0.1",
        "compaction.0.cycles=1",
        "compaction.0.force=2000",
        "compaction.0.rest=0.005",
        "compaction.1.rest=0.05",
        "track.load.cycles=1",
        "track.load.frequency=\"100 Hz\"",
        "track.load.maximum=\"20 kN\"",
        "track.load.rest=0.002",
        "track.load.ramp=0.002",
        "output.frames=2",
    ];
    run(&scene, &folder.join("out"), &set).good();
    let summary = json(&folder.join("out/summary.json"));
    let at = |path: &str| summary.pointer(path).and_then(serde_json::Value::as_f64).unwrap_or(f64::NAN);
    let (energy, force, moment) =
        (at("/energy/relative_error"), at("/coupling/transfer/force"), at("/coupling/transfer/moment"));
    println!("energy {energy:.1e}, force {force:.1e}, moment {moment:.1e}");
    assert!(energy.abs() < 5e-3 && force < 1e-11 && moment < 1e-11, "{energy} {force} {moment}");
    assert!(at("/coupling/transfer/exchanges") > 100.0);
    assert_eq!(summary["verdict"]["outcome"], "passed");
}

/// Polyhedra touch flat faces only, the stiffened exchange knows spheres only.
#[test]
fn refusals() {
    let scene = repository().join("inputs/track/polyhedra/scene.toml");
    let folder = Folder::new("polyhedra_refusals");
    for (set, expected) in [
        (
            "coupling.faces=\"curved\"",
            "coupling.faces: found \"curved\", expected \"flat\", or no such key: polyhedra touch",
        ),
        (
            "coupling.scheme=\"stiffened\"",
            "coupling.scheme: found \"stiffened\", expected another scheme beside polyhedra",
        ),
    ] {
        let outcome = run(&scene, &folder.join("out"), &[set]);
        assert!(outcome.code == 2 && outcome.stderr.contains(expected), "{set}: {}", outcome.stderr);
    }
}
