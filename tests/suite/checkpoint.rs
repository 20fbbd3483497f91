//! Resumed runs write the same bytes as uninterrupted ones, at any time and with any number of threads.

use super::support::{
    COUPLED, Folder, PLASTIC, SOLID, json, repository, results, run, scene_folder, shaft, trackbed,
    trackbed_in,
};
use std::fs;
use std::path::{Path, PathBuf};
use trackbed::failure::Failure;
use trackbed::run::{Interrupt, Options, Outcome, Verbosity};

fn bed() -> String {
    let library = repository().join("inputs/track/cyclic/stones.toml");
    let walls = shaft(0.4);
    format!(
        r#"title = "bed in a box"

[[material]]
name = "stone"
density = 2650
stiffness = "0.5 MN/m"
friction = 0.5
restitution = 0.4

[[grains]]
name = "stones"
shape = "clump"
library = "{}"
material = "stone"
count = 25
size = ["50 mm", "70 mm"]
fill = {{ low = [0.0, 0.0, 0.1], high = [0.4, 0.4] }}

[[grains]]
name = "marbles"
shape = "sphere"
material = "stone"
count = 25
size = ["40 mm", "60 mm"]
fill = {{ low = [0.0, 0.0, 0.3], high = [0.4, 0.4] }}

{walls}
[[walls]]
kind = "triangles"
material = "stone"
vertices = [[0.0, 0.0, 0.05], [0.4, 0.0, 0.05], [0.4, 0.4, 0.01], [0.0, 0.4, 0.01]]
triangles = [[0, 1, 2], [0, 2, 3]]
velocity = [0.02, 0.0, 0.0]

[deposition]
max_time = "0.25 s"
settled_speed = "20 mm/s"
level = "0.5 m"

[track.sleeper]
size = [0.38, 0.2, 0.1]
mass = 20
material = "stone"
centre = [0.2, 0.2]
hold = ["x", "y"]

[track.load]
kind = "haversine"
minimum = "100 N"
maximum = "500 N"
frequency = 50
cycles = 2
rest = "10 ms"
ramp = "10 ms"

[output]
frames = 5
"#,
        library.display()
    )
}

fn options(out: &Path, set: &[&str], threads: usize) -> Options {
    Options {
        out: Some(out.to_path_buf()),
        threads: Some(threads),
        set: set.iter().map(|s| s.to_string()).collect(),
        verbosity: Verbosity::Quiet,
        ..Options::default()
    }
}

fn steps(out: &Path) -> u64 {
    let count = |stage: &serde_json::Value, kind: &str| stage[kind].as_u64().unwrap();
    json(&out.join("summary.json"))["stages"]
        .as_array()
        .unwrap()
        .iter()
        .map(|s| match count(s, "windows") {
            0 => count(s, "grain_steps").max(count(s, "solid_steps")) - 1,
            windows => windows - 1,
        })
        .sum()
}

fn same(whole: &Path, broken: &Path) {
    let (whole, broken) = (results(whole), results(broken));
    assert!(whole.keys().eq(broken.keys()), "{:?}\n{:?}", whole.keys(), broken.keys());
    for (name, bytes) in &whole {
        assert!(*bytes == broken[name], "{name} differs after a restart");
    }
}

pub(super) fn broken(scene: &Path, set: &[&str], shares: &[f64], expected: &[&str]) {
    let folder = Folder::new("broken");
    let (whole, out) = (folder.join("whole"), folder.join("broken"));
    let Ok(Outcome::Done(summary)) = trackbed::run::run(scene, &options(&whole, set, 1)) else {
        panic!("the whole run fails")
    };
    // Plasticity must have occurred, so that there is a state to save.
    assert!(
        summary.solid.newton.is_none_or(|n| n.factorizations_symmetric + n.factorizations_unsymmetric > 2)
    );
    for name in expected {
        assert!(whole.join(name).exists(), "no {name}");
    }
    let total = steps(&whole);
    let mut before = 0;
    for (k, share) in shares.iter().enumerate() {
        let at = ((share * total as f64) as u64).clamp(before + 1, total);
        let options = Options {
            interrupt: Interrupt::after(at - before),
            resume: k > 0,
            ..options(&out, set, 2 - k % 2)
        };
        let failure = trackbed::run::run(scene, &options).unwrap_err();
        assert!(matches!(failure, Failure::Interrupted(_)) && failure.code() == 130, "{failure}");
        assert_eq!(json(&out.join("summary.json"))["status"], "interrupted");
        before = at;
    }
    let last = Options { resume: true, ..options(&out, set, 1 + shares.len() % 2) };
    trackbed::run::run(scene, &last).unwrap();
    same(&whole, &out);
    assert!(!out.join("checkpoint").exists(), "a finished run needs no checkpoint");
    assert!(matches!(trackbed::run::run(scene, &last), Ok(Outcome::WasDone(_))));
}

#[test]
fn clumps_and_spheres_that_settle() {
    let folder = Folder::new("bed");
    let scene = folder.write("scene.toml", &bed());
    let expected = ["history.csv", "cycles.csv", "sleeper.svg", "settlement.svg", "frames/grains_00005.vtp"];
    broken(&scene, &[], &[0.0, 0.1, 0.3, 0.58, 0.7, 0.7001, 0.9, 1.0], &expected);
}

#[test]
fn threaded_grains_on_solid() {
    let set = [
        "grains.0.count=250",
        "grains.1.count=10",
        "grains.2.count=10",
        "compaction=",
        "deposition.max_time=0.03",
        "deposition.level=9",
        "track.load.cycles=1",
        "track.load.frequency=400",
        "track.load.rest=0.002",
        "track.load.ramp=0.002",
        "output.frames=2",
        "output.tecplot=true",
    ];
    let scene = repository().join("inputs/track/cyclic/scene.toml");
    broken(&scene, &set, &[0.2, 0.992, 0.996, 1.0], &["cycles.csv", "tecplot/solid_00002.dat"]);
}

#[test]
fn a_bed_that_is_compacted() {
    let folder = Folder::new("compacted");
    let mut text = fs::read_to_string(repository().join("inputs/grains/compaction.toml")).unwrap();
    for (old, new) in [
        ("low = \"20 mm\", high = \"30 mm\"", "low = \"42 mm\", high = \"52 mm\""),
        ("cycles = 12", "cycles = 3"),
        ("cycles = 20", "cycles = 3"),
        ("layers = 3", "layers = 2"),
    ] {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    let scene = folder.write("scene.toml", &text);
    broken(&scene, &[], &[0.0, 0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 1.0], &["history.csv"]);
}

#[test]
fn spheres_on_an_elastic_block() {
    let folder = scene_folder("coupled", COUPLED);
    let set = ["output.tables=true"];
    broken(&folder.join("scene.toml"), &set, &[0.0, 0.3, 0.5, 0.8, 1.0], &["cycles.csv", "gauss.csv"]);
}

#[test]
fn spheres_on_block_by_scheme() {
    let folder = scene_folder("coupled_schemes", COUPLED);
    for (scheme, transfer) in
        [("lagged", "\"point\""), ("stiffened", "{ spread = 0.3 }"), ("iterated", "{ spread_factor = 2 }")]
    {
        let scheme = format!("coupling.scheme={scheme}");
        let transfer = format!("coupling.transfer={transfer}");
        let set = [scheme.as_str(), transfer.as_str(), "coupling.substeps=5", "track.load.cycles=1"];
        broken(&folder.join("scene.toml"), &set, &[0.3, 0.6, 1.0], &["cycles.csv", "history.csv"]);
    }
}

#[test]
fn spheres_on_a_plastic_block() {
    let folder = scene_folder("coupled_plastic", COUPLED);
    let set = [
        "solid.material.0.model=mohr_coulomb",
        "solid.material.0.cohesion=2000",
        "solid.material.0.friction=0.6",
        "solid.material.0.dilation=0.1",
    ];
    broken(&folder.join("scene.toml"), &set, &[0.0, 0.4, 0.8, 1.0], &["cycles.csv"]);
}

#[test]
fn plastic_solid_at_rest() {
    let folder = Folder::new("plastic");
    let scene = folder.write("scene.toml", PLASTIC);
    // Few iterations force step halving, whose step length is part of the state.
    let set =
        ["solid.newton.max_iterations=6", "time.solid_step=0.05", "output.tables=true", "solid.gravity=true"];
    broken(&scene, &set, &[0.0, 0.3, 0.5, 0.8, 1.0], &["history.csv", "gauss.csv", "frames/solid_00002.vtu"]);
}

#[test]
fn solids_in_motion() {
    let folder = Folder::new("motion");
    let scene = folder
        .write("scene.toml", &PLASTIC.replace("[solid.quasi_static]", "[solid.dynamics]\nhht_alpha = -0.1"));
    let set = [
        "time.solid_step=0.01",
        "time.end=0.3",
        "solid.support.1.history.duration=0.3",
        "solid.gravity=true",
    ];
    let plastic = [&set[..], &["solid.newton.max_iterations=4"]].concat();
    broken(&scene, &plastic, &[0.0, 0.3, 0.5, 1.0], &["history.csv"]);
    let elastic = [&set[..], &["solid.material.1.model=elastic"]].concat();
    let text = fs::read_to_string(&scene).unwrap();
    let cut = text.find("cohesion").unwrap()..text.find("[[solid.support]]").unwrap();
    fs::write(&scene, text.replace(&text[cut], "\n")).unwrap();
    broken(&scene, &elastic, &[0.0, 0.3, 0.5, 1.0], &["history.csv"]);
}

fn interrupted(name: &str) -> (Folder, PathBuf, PathBuf) {
    let folder = scene_folder(name, COUPLED);
    let (scene, out) = (folder.join("scene.toml"), folder.join("out"));
    for (steps, resume) in [(20, false), (10, true)] {
        let options = Options { interrupt: Interrupt::after(steps), resume, ..options(&out, &[], 1) };
        trackbed::run::run(&scene, &options).unwrap_err();
    }
    assert_eq!(fs::read_dir(out.join("checkpoint")).unwrap().count(), 2, "both slots are in use");
    (folder, scene, out)
}

/// Bad input on `--resume`: one line, no file changed.
#[track_caller]
fn refused(scene: &Path, out: &Path, set: &[&str], words: &[&str]) {
    let before = super::support::snapshot(out);
    let mut arguments: Vec<String> =
        ["run", &scene.display().to_string(), "--resume", "--quiet", "--out", &out.display().to_string()]
            .map(String::from)
            .into();
    set.iter().for_each(|s| arguments.extend(["--set".to_string(), s.to_string()]));
    let outcome = trackbed(arguments);
    assert_eq!(outcome.code, 2, "{outcome:?}");
    assert_eq!(outcome.stderr.lines().count(), 1, "{outcome:?}");
    for word in words {
        assert!(outcome.stderr.contains(word), "{word}: {outcome:?}");
    }
    assert!(super::support::snapshot(out) == before, "a refusal leaves the results as they are");
}

#[test]
fn nothing_to_go_on_from() {
    let (folder, scene, out) = interrupted("refusals");
    let nowhere = folder.join("nowhere");
    fs::create_dir(&nowhere).unwrap();
    refused(&scene, &nowhere, &[], &["--resume: no checkpoint in", "nowhere/checkpoint"]);
    refused(
        &scene,
        &out,
        &["coupling.substeps=20"],
        &["coupling.substeps was absent, now 20"].map(|_| "coupling.substeps was 10, now 20"),
    );
    folder.edit("scene.toml", "mass = 400", "mass = 401");
    refused(&scene, &out, &[], &["track.sleeper.mass was 400, now 401"]);
    folder.edit("scene.toml", "mass = 401", "mass = 400 # kg");
    refused(&scene, &out, &[], &["its text, overrides or --from have changed, but no key"]);
    folder.edit("scene.toml", "mass = 400 # kg", "mass = 400");
    let lists = fs::read_to_string(folder.join("DOF.DAT")).unwrap();
    fs::write(folder.join("DOF.DAT"), format!("{lists}\n")).unwrap();
    refused(&scene, &out, &[], &["DOF.DAT has changed"]);
    fs::write(folder.join("DOF.DAT"), lists).unwrap();
    let history = fs::read(out.join("history.csv")).unwrap();
    fs::write(out.join("history.csv"), &history[..history.len() / 2]).unwrap();
    refused(&scene, &out, &[], &["history.csv: is not the history of the checkpoint"]);
    fs::write(out.join("history.csv"), &history).unwrap();
    run(&scene, &folder.join("whole"), &[]).good();
    trackbed([
        "run",
        &scene.display().to_string(),
        "--resume",
        "--quiet",
        "--out",
        &out.display().to_string(),
    ])
    .good();
    same(&folder.join("whole"), &out);
    let outcome = trackbed_in(folder.path(), ["run", "scene.toml", "--resume", "--out", "out"]).good();
    assert!(outcome.stdout.contains("run completed"), "{outcome:?}");
    refused(&scene, &out, &["coupling.substeps=20"], &["contains the completed run of another scene"]);
}

/// FNV-1a, the checkpoint checksum.
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x0000_0100_0000_01b3))
}

#[test]
fn damaged_checkpoints() {
    let (folder, scene, out) = interrupted("damage");
    let [a, b] = ["a", "b"].map(|slot| out.join(format!("checkpoint/{slot}.checkpoint")));
    let whole = [&a, &b].map(|file| fs::read(file).unwrap());
    // Newer slot damaged: resumes from the older, with a note.
    let mut bytes = whole[1].clone();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&b, &bytes).unwrap();
    let resumed =
        ["run", &scene.display().to_string(), "--resume", "--quiet", "--out", &out.display().to_string()]
            .map(String::from);
    let outcome = trackbed(&resumed).good();
    let remark = "b.checkpoint is damaged: wrong checksum; the run resumes from";
    assert!(outcome.stderr.starts_with("warning: ") && outcome.stderr.contains(remark), "{outcome:?}");
    run(&scene, &folder.join("whole"), &[]).good();
    same(&folder.join("whole"), &out);

    let (folder, scene, out) = interrupted("damage_both");
    let [a, b] = ["a", "b"].map(|slot| out.join(format!("checkpoint/{slot}.checkpoint")));
    fs::write(&a, &whole[0][..100]).unwrap();
    fs::write(&b, "").unwrap();
    refused(&scene, &out, &[], &["a.checkpoint is damaged", "b.checkpoint is damaged"]);
    // Another program version with a valid checksum.
    let text = "\"version\":\"";
    let mut bytes = whole[0][..whole[0].len() - 8].to_vec();
    let at = bytes.windows(text.len()).position(|w| w == text.as_bytes()).unwrap() + text.len();
    bytes[at] = b'9';
    bytes.extend(checksum(&bytes).to_le_bytes());
    fs::write(&a, bytes).unwrap();
    let version = env!("CARGO_PKG_VERSION");
    let words = format!("found program version 9{}, expected {version}", &version[1..]);
    refused(&scene, &out, &[], &[&words]);
    drop(folder);
}

/// Exit code 3; a second attempt fails identically.
#[test]
fn numerical_failure_keeps_last_checkpoint() {
    let folder = Folder::new("failing");
    let scene = folder.write("scene.toml", PLASTIC);
    let set = ["solid.newton.max_iterations=2", "solid.quasi_static.smallest_step=0.5"];
    let (whole, out) = (folder.join("whole"), folder.join("out"));
    let alone = run(&scene, &whole, &set);
    assert_eq!(alone.code, 3, "{alone:?}");
    assert!(!alone.stderr.contains("checkpoint"), "{alone:?}");
    let stopped = Options { interrupt: Interrupt::after(1), ..options(&out, &set, 1) };
    assert_eq!(trackbed::run::run(&scene, &stopped).unwrap_err().code(), 130);
    for _ in 0..2 {
        let again = Options { resume: true, ..options(&out, &set, 2) };
        let failure = trackbed::run::run(&scene, &again).unwrap_err();
        assert_eq!(failure.code(), 3);
        assert!(failure.to_string().contains("Last checkpoint: "), "{failure}");
        assert!(out.join("checkpoint/a.checkpoint").is_file());
    }
    fs::remove_dir_all(out.join("checkpoint")).unwrap();
    same(&whole, &out);
}

#[test]
fn new_run_removes_old_checkpoints() {
    let (folder, scene, out) = interrupted("fresh");
    run(&scene, &out, &[]).good();
    run(&scene, &folder.join("whole"), &[]).good();
    same(&folder.join("whole"), &out);
    assert!(!out.join("checkpoint").exists());
}

#[test]
fn the_interval_is_checked() {
    let folder = scene_folder("interval", COUPLED);
    for (interval, found) in [("0", "0 s"), ("-1", "-1 s"), ("\"1 parsec\"", "parsec")] {
        let set = format!("output.checkpoint={interval}");
        let outcome = run(&folder.join("scene.toml"), &folder.join("out"), &[&set]);
        assert_eq!(outcome.code, 2, "{outcome:?}");
        assert!(
            outcome.stderr.contains("output.checkpoint") && outcome.stderr.contains(found),
            "{outcome:?}"
        );
    }
    let folder = scene_folder("interval_static", SOLID);
    let outcome = run(&folder.join("scene.toml"), &folder.join("out"), &["output.checkpoint=1"]);
    assert!(
        outcome.code == 2 && outcome.stderr.contains("it has no effect without [solid.dynamics]"),
        "{outcome:?}"
    );
}
