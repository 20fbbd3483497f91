//! Scene `inputs/track/train`, small: fewer, larger stones, coarser mesh, shorter and faster pass.

use super::support::{Folder, json, repository, results};
use super::track::options;
use std::path::{Path, PathBuf};
use trackbed::run::{Interrupt, Options};

const SMALL: [&str; 20] = [
    "solid.block.x.counts=[6]",
    "solid.block.y.counts=[3]",
    "solid.block.z.counts=[2,2]",
    "grains.0.count=70",
    "grains.0.size=[0.28,0.32]",
    "deposition.max_time=0.5",
    "compaction.0.cycles=1",
    "compaction.0.frequency=100",
    "compaction.0.at=[[0.0,0.9]]",
    "compaction.0.rest=0.005",
    "coupling.substeps=8",
    "track.rail.extension=1.8",
    "track.load.speed=100",
    "track.load.wheelbase=1.2",
    "track.load.rest=0.002",
    "track.load.ramp=0.004",
    "output.frames=2",
    "output.tecplot=false",
    "output.history_interval=0.0005",
    "solid.material.1.cohesion=2000",
];

/// As in the scene's README.
const ELASTIC: &str = "solid.material=[{ id = 1, young = 8e7, poisson = 0.3, density = 1950 }, \
                       { id = 2, young = 1.5e8, poisson = 0.3, density = 2100 }]";

fn small(out: &Path, threads: usize, more: &[&str]) -> Options {
    let set = SMALL.iter().chain(more).map(|s| s.to_string()).collect();
    Options { set, ..options(out, threads) }
}

fn scene(name: &str) -> PathBuf {
    repository().join("inputs/track/train").join(name)
}

#[test]
fn a_small_train_on_an_embankment() {
    let folder = Folder::new("train");
    let out = folder.join("out");
    trackbed::run::run(&scene("scene.toml"), &small(&out, 1, &[])).unwrap();
    let summary = json(&out.join("summary.json"));
    let sleepers = summary["track"]["sleepers"].as_array().unwrap();
    assert_eq!(sleepers.len(), 3);
    for s in sleepers {
        let share = s["load_share"].as_f64().unwrap();
        assert!((0.05..1.0).contains(&share), "{s}");
        assert!(s["rail_deflection"].as_f64().unwrap() > 0.0 && s["lowering"].as_f64().unwrap() > 0.0);
    }
    assert!(summary["newton"]["iterations"].as_u64().unwrap() > 0);
    let energy = &summary["energy"];
    assert!(energy["flows"]["plastic"].as_f64().unwrap() > 0.0, "{energy}");
    assert!(energy["flows"]["pads"].as_f64().unwrap() > 0.0, "{energy}");
    assert!(energy["relative_error"].as_f64().unwrap() < 0.02, "{energy}");
    assert!(energy["flows"]["wheels"].as_f64().unwrap() > 0.0);
}

#[test]
fn train_on_elastic_embankment() {
    let folder = Folder::new("train");
    let out = folder.join("out");
    let set = SMALL[..19].iter().chain(&[ELASTIC, "solid.newton="]).map(|s| s.to_string()).collect();
    trackbed::run::run(&scene("scene.toml"), &Options { set, ..options(&out, 1) }).unwrap();
    let summary = json(&out.join("summary.json"));
    assert!(summary["newton"].is_null());
    assert!(summary["energy"]["relative_error"].as_f64().unwrap() < 0.02, "{}", summary["energy"]);
}

#[test]
fn breakage_and_plasticity_resume_bitwise() {
    let folder = Folder::new("train");
    let (whole, broken) = (folder.join("whole"), folder.join("broken"));
    let weak = [
        "bond.0.parallel.tensile_strength=3e5",
        "bond.0.parallel.shear_strength=5e5",
        "time.grain_step=1.2e-5",
        "time.accept_step_above_limit=true",
        "coupling.substeps=16",
    ];
    let file = scene("breakable.toml");
    trackbed::run::run(&file, &small(&whole, 1, &weak)).unwrap();
    let summary = json(&whole.join("summary.json"));
    let count = |key: &str| summary["bonds"][key].as_u64().unwrap();
    assert!(count("broken_by_tension") + count("broken_by_shear") > 0, "{}", summary["bonds"]);
    assert!(summary["energy"]["flows"]["plastic"].as_f64().unwrap() > 0.0);
    assert!(summary["energy"]["relative_error"].as_f64().unwrap() < 0.02, "{}", summary["energy"]);
    let windows = summary["stages"].as_array().unwrap().last().unwrap()["solid_steps"].as_u64().unwrap();
    let [settled, tamped] = [0, 1].map(|k| summary["stages"][k]["grain_steps"].as_u64().unwrap());
    let breaks = [settled / 2, settled - settled / 2 + tamped + windows / 3, windows / 3];
    for (k, &steps) in breaks.iter().enumerate() {
        let interrupt = Interrupt::after(steps);
        let how = Options { interrupt, resume: k > 0, ..small(&broken, 2 + k % 2, &weak) };
        let stopped = trackbed::run::run(&file, &how).unwrap_err();
        assert_eq!(stopped.code(), 130, "{stopped}");
    }
    trackbed::run::run(&file, &Options { resume: true, ..small(&broken, 3, &weak) }).unwrap();
    let (whole, broken) = (results(&whole), results(&broken));
    assert!(whole.keys().eq(broken.keys()), "{:?}\n{:?}", whole.keys(), broken.keys());
    for (name, bytes) in &whole {
        assert!(*bytes == broken[name], "{name} differs after a restart");
    }
}
