//! Identical files with 1, 2 and 3 threads, except threads, times and memory in the summary.

use super::support::{Folder, SOLID, json, repository, results, scene_folder, trackbed};
use std::path::Path;

/// Small reference case with more than 2500 spheres, the threshold for threads.
pub(super) const SMALL: [&str; 12] = [
    "grains.0.count=640",
    "grains.1.count=10",
    "grains.2.count=10",
    "compaction=",
    "deposition.max_time=0.06",
    "deposition.level=9",
    "track.load.cycles=1",
    "track.load.frequency=200",
    "track.load.rest=0.004",
    "track.load.ramp=0.004",
    "output.frames=2",
    "output.tecplot=true",
];

/// Runs with 1, 2 and 3 threads; requires equal files, `expected` among them.
pub(super) fn same_bits(scene: &Path, set: &[&str], expected: &[&str]) -> Folder {
    same_bits_on(["1", "2", "3"], scene, set, expected)
}

pub(super) fn same_bits_on<const N: usize>(
    threads: [&str; N],
    scene: &Path,
    set: &[&str],
    expected: &[&str],
) -> Folder {
    let folder = Folder::new("threads");
    let outs = threads.map(|threads| {
        let out = folder.join(threads);
        let mut arguments: Vec<String> =
            ["run", &scene.display().to_string(), "--quiet", "--threads", threads, "--out"]
                .map(String::from)
                .into();
        arguments.push(out.display().to_string());
        set.iter().for_each(|s| arguments.extend(["--set".to_string(), s.to_string()]));
        trackbed(arguments).good();
        assert_eq!(json(&out.join("summary.json"))["threads"].to_string(), threads);
        out
    });
    let files = outs.each_ref().map(|out| results(out));
    let (one, others) = files.split_first().expect("one thread at least");
    for name in expected {
        assert!(one.contains_key(*name), "no {name} among {:?}", one.keys());
    }
    for (other, threads) in others.iter().zip(&threads[1..]) {
        assert!(one.keys().eq(other.keys()), "{threads} threads leave other files");
        for (name, bytes) in one {
            assert!(*bytes == other[name], "{name} differs between 1 and {threads} threads");
        }
    }
    folder
}

#[test]
fn clumps_and_sleeper_on_an_embankment() {
    let expected = [
        "history.csv",
        "cycles.csv",
        "frames/solid_00002.vtu",
        "frames/grains_00002.vtp",
        "frames/chains_00002.vtp",
        "tecplot/solid_00002.dat",
    ];
    let folder = same_bits(&repository().join("inputs/track/cyclic/scene.toml"), &SMALL, &expected);
    let summary = json(&folder.join("2/summary.json"));
    assert!(summary["model"]["spheres"].as_u64().unwrap() >= 2500, "{}", summary["model"]);
    assert!(summary["energy"]["flows"]["surface_on_grains"].as_f64().unwrap() != 0.0);
    assert!(summary["energy"]["flows"]["dashpot"].as_f64().unwrap() > 0.0);
}

#[test]
fn embankment_in_motion() {
    let set = [
        "solid.dynamics.beta=0.25",
        "solid.rayleigh.alpha_m=4.0",
        "solid.rayleigh.beta_k=0.0003",
        "time.end=0.02",
        "time.solid_step=0.001",
        "output.frames=2",
        "output.tecplot=true",
    ];
    let scene = repository().join("tests/data/fem/E3_embankment_patch/scene.toml");
    same_bits(
        &scene,
        &set,
        &["history.csv", "nodes.csv", "gauss.csv", "frames/solid_00002.vtu", "tecplot/solid_00002.dat"],
    );
}

#[test]
fn static_block() {
    let folder = scene_folder("static_threads", SOLID);
    same_bits(&folder.join("scene.toml"), &[], &["nodes.csv", "gauss.csv", "frames/solid_00000.vtu"]);
}
