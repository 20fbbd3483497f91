//! Periodic axes with a solid and sleepers.

use super::support::{Folder, json, repository, run, trackbed};

/// Reference case without its front and back planes.
const WALLS: &str = "walls=[{ kind = \"plane\", point = [-1.5, 0, 0], normal = [1, 0, 0], material = \"stone\" }, \
                     { kind = \"plane\", point = [1.5, 0, 0], normal = [-1, 0, 0], material = \"stone\" }]";
const FEW: [&str; 8] = [
    "grains.0.count=150",
    "grains.1.count=1",
    "grains.2.count=1",
    "deposition.max_time=0.05",
    "compaction=[]",
    "track.load.cycles=1",
    "track.load.frequency=100",
    "output.vtk=false",
];

fn refused(set: &[&str], words: &str) {
    let scene = repository().join("inputs/track/cyclic/scene.toml").display().to_string();
    let set = [WALLS].into_iter().chain(FEW).chain(set.iter().copied()).flat_map(|set| ["--set", set]);
    let said = trackbed(["check", &scene].into_iter().chain(set));
    assert!(said.code == 2 && said.stderr.contains(words), "{}", said.stderr);
}

#[test]
fn box_ends_with_the_solid_and_holds_the_sleepers() {
    let ends = "expected the ends of the contact surface of the solid, [0, 0.6]";
    refused(&["periodic={ y = [0.0, 0.7] }"], ends);
    let sleepers = "track.sleeper: found sleepers from";
    refused(&["periodic={ y = [0.0, 0.6] }", "track.sleeper.centre=[0, 0.9]"], sleepers);
    refused(&["periodic={ y = [0.0, 0.6] }", "track.sleeper.size=[2.6, 0.7, 0.2]"], sleepers);
}

/// Momentum across the interface and energy close as between planes.
#[test]
fn slice_of_track_is_periodic() {
    let folder = Folder::new("periodic_slice");
    let scene = repository().join("inputs/track/cyclic/scene.toml");
    let set: Vec<&str> = [WALLS, "periodic={ y = [0.0, 0.6] }"].into_iter().chain(FEW).collect();
    run(&scene, &folder.join("out"), &set).good();
    let summary = json(&folder.join("out/summary.json"));
    assert_eq!(summary["verdict"]["outcome"], "passed", "{}", summary["verdict"]);
    let transfer = &summary["coupling"]["transfer"];
    let errors = [
        &transfer["force"],
        &transfer["moment"],
        &summary["momentum"]["linear"],
        &summary["momentum"]["angular"],
    ];
    let errors = errors.map(|error| error.as_f64().unwrap());
    assert!(
        transfer["exchanges"].as_u64().unwrap() > 1000 && errors.iter().all(|e| *e < 1e-10),
        "{errors:?}"
    );
}
