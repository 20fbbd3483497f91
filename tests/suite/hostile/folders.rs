//! Results directories: locking, overwriting, and mesh files in the scene hash.

use super::super::support::{
    COUPLED, Folder, GRAINS, SOLID, json, repository, results, scene_folder, small_block, snapshot, trackbed,
    trackbed_in, write_lists,
};
use super::refused;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use trackbed::run::{Interrupt, Options, Verbosity};

fn arguments<'a>(scene: &'a Path, out: &'a Path, more: &[&'a str]) -> Vec<&'a str> {
    let own = ["run", scene.to_str().unwrap(), "--quiet", "--out", out.to_str().unwrap()];
    [&own, more].concat()
}

/// H1: a killed run leaves no effective lock.
#[test]
fn one_run_per_directory() {
    let folder = Folder::new("locked");
    let (scene, out) = (repository().join("inputs/grains/box.toml"), folder.join("out"));
    let long = arguments(&scene, &out, &["--set", "time.end=60"]);
    let mut first =
        Command::new(env!("CARGO_BIN_EXE_trackbed")).args(&long).stderr(Stdio::null()).spawn().unwrap();
    let begun = Instant::now();
    while !out.join("history.csv").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60) && first.try_wait().unwrap().is_none());
        sleep(Duration::from_millis(1));
    }
    let words =
        format!("found it in use by process {}, expected a directory without an active run", first.id());
    for more in [&[][..], &["--force"]] {
        refused(arguments(&scene, &out, more), &words);
    }
    first.kill().unwrap();
    first.wait().unwrap();
    assert!(out.join("run.lock").exists());
    refused(arguments(&scene, &out, &[]), "expected another --out, or --force to overwrite them");
    let short = ["--set", "grains.0.count=20", "--set", "time.end=0.01", "--force"];
    trackbed(arguments(&scene, &out, &short)).good();
    assert!(json(&out.join("summary.json"))["status"] == "done" && !out.join("run.lock").exists());
}

/// H1: needs `--resume` or `--force`.
#[test]
fn checkpoint_is_not_overwritten_silently() {
    let folder = scene_folder("kept", COUPLED);
    let (scene, out) = (folder.join("scene.toml"), folder.join("out"));
    let options = Options {
        out: Some(out.clone()),
        threads: Some(1),
        verbosity: Verbosity::Quiet,
        interrupt: Interrupt::after(20),
        ..Options::default()
    };
    trackbed::run::run(&scene, &options).unwrap_err();
    let before = snapshot(&out);
    let words =
        "found the checkpoint of an interrupted run, expected --resume, --force to start from scratch";
    refused(arguments(&scene, &out, &[]), words);
    assert!(snapshot(&out) == before, "a refusal leaves everything");
    trackbed(arguments(&scene, &out, &["--resume"])).good();
    assert_eq!(trackbed(arguments(&scene, &out, &["--resume", "--force"])).code, 2);
}

/// H1: also for the same scene; the message offers both remedies.
#[test]
fn results_are_not_replaced_in_silence() {
    let folder = Folder::new("again");
    folder.write("a/scene.toml", GRAINS);
    folder.write("b/a.toml", &GRAINS.replace("two spheres", "two\\u0007others"));
    let run = |scene: &str, more: &[&str]| {
        trackbed_in(folder.path(), [&["run", scene, "--quiet", "--out", "out"], more].concat())
    };
    run("a/scene.toml", &[]).good();
    let before = snapshot(&folder.join("out"));
    let own = "out: found the completed results of this scene, expected another --out, or --force to overwrite them; nothing to resume";
    let other = "out: found the results of another scene (\"two spheres\"), expected another --out, or --force to overwrite them";
    for (outcome, words) in [
        (run("a/scene.toml", &[]), own),
        (run("a/scene.toml", &["--set", "time.end=0.01"]), other),
        (run("b/a.toml", &[]), other),
    ] {
        assert!(outcome.code == 2 && outcome.stderr.contains(words), "{outcome:?}");
        assert_eq!(outcome.stderr.lines().count(), 1, "{outcome:?}");
    }
    assert!(snapshot(&folder.join("out")) == before, "a refusal leaves everything");
    let resumed = run("a/scene.toml", &["--resume"]).good();
    assert!(resumed.stdout.contains("nothing to resume"), "{resumed:?}");
    run("b/a.toml", &["--force"]).good();
    let log = fs::read_to_string(folder.join("out/log.txt")).unwrap();
    assert!(log.starts_with("two\\u{7}others\n"), "{log}");
}

#[test]
fn default_folders_are_distinct() {
    let folder = Folder::new("variants");
    folder.write("a/scene.toml", GRAINS);
    folder.write("b/a.toml", GRAINS);
    let runs: [&[&str]; 5] = [
        &["a/scene.toml"],
        &["a/scene.toml", "--set", "time.end=0.01"],
        &["a/scene.toml", "--set", "time.end=0.012"],
        &["b/a.toml"],
        &["b/a.toml", "--set", "time.end=0.01"],
    ];
    let place = |more: &[&str], force: &[&str]| {
        let said = trackbed_in(folder.path(), [&["run"], more, force].concat()).good();
        let last = said.stdout.lines().last().unwrap().to_string();
        last.strip_prefix("results are in ").unwrap_or_else(|| panic!("{last}")).to_string()
    };
    let first: Vec<String> = runs.iter().map(|more| place(more, &[])).collect();
    assert_eq!(first[0], "results/a");
    for (k, name) in first.iter().enumerate() {
        assert!(!first[..k].contains(name) && name.starts_with("results/a"), "{first:?}");
        assert_eq!(json(&folder.join(name).join("summary.json"))["status"], "done");
    }
    let again: Vec<String> = runs.iter().map(|more| place(more, &["--force"])).collect();
    assert_eq!(first, again);
    for more in runs {
        let said = trackbed_in(folder.path(), [&["run", "--resume"], more].concat()).good();
        assert!(said.stdout.contains("nothing to resume"), "{said:?}");
    }
}

/// H1: results follow a directory renamed during a run; resuming is bitwise identical.
#[test]
fn renamed_directory_keeps_its_run() {
    let folder = Folder::new("renamed");
    let scene = repository().join("inputs/grains/box.toml");
    let [whole, out, moved] = ["whole", "out", "moved"].map(|name| folder.join(name));
    let set = [
        "--set",
        "grains.0.count=800",
        "--set",
        "time.end=0.4",
        "--set",
        "output.frames=3",
        "--set",
        "output.checkpoint=0.02",
        "--threads",
        "1",
    ];
    trackbed(arguments(&scene, &whole, &set)).good();
    let mut child = Command::new(env!("CARGO_BIN_EXE_trackbed"))
        .args(arguments(&scene, &out, &set))
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    let rows = || fs::read_to_string(out.join("history.csv")).map_or(0, |t| t.lines().count());
    while rows() < 20 || !out.join("checkpoint").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60) && child.try_wait().unwrap().is_none());
        sleep(Duration::from_millis(1));
    }
    fs::rename(&out, &moved).unwrap();
    let said = child.wait_with_output().unwrap();
    let text = String::from_utf8(said.stderr).unwrap();
    assert_eq!((said.status.code(), text.lines().count()), (Some(1), 1), "{text}");
    let words = "out: results directory was renamed or removed during the run";
    assert!(text.contains(words) && text.contains(&format!("--resume --out {}", moved.display())), "{text}");
    assert!(!out.exists(), "nothing is made under the old name");
    assert!(!moved.join("run.lock").exists());
    trackbed(arguments(&scene, &moved, &[&set[..], &["--resume"]].concat())).good();
    let (whole, moved) = (results(&whole), results(&moved));
    assert!(whole.keys().eq(moved.keys()), "{:?} {:?}", whole.keys(), moved.keys());
    whole.iter().for_each(|(name, bytes)| assert!(*bytes == moved[name], "{name} differs"));
}

/// H4: unrelated files stay.
#[test]
fn files_of_others_stay() {
    let folder = scene_folder("foreign", SOLID);
    let scene = folder.join("scene.toml");
    for name in
        ["history.csv", "nodes.csv", "results.pvd", "frames/mine.vtu", "packing_3.csv", "summary.json"]
    {
        let own = Folder::new("foreign_files");
        own.write(name, "mine");
        let words = format!("found {name}, an unrelated file, expected another --out, or --force");
        refused(arguments(&scene, own.path(), &[]), &words);
        assert_eq!(fs::read_to_string(own.join(name)).unwrap(), "mine");
        assert_eq!(snapshot(own.path()).len(), 1);
        trackbed(arguments(&scene, own.path(), &["--force"])).good();
    }
    let own = Folder::new("foreign_names");
    own.write("notes.txt", "mine");
    own.write("frames/notes.txt", "mine");
    trackbed(arguments(&scene, own.path(), &[])).good();
    assert_eq!(fs::read_to_string(own.join("notes.txt")).unwrap(), "mine");
}

/// H1: output equals input file.
#[test]
fn rejects_conversion_onto_input() {
    let folder = scene_folder("onto_itself", SOLID);
    let convert = |input: &str, output: &str| trackbed_in(folder.path(), ["mesh", "convert", input, output]);
    convert(".", "mesh.inp").good();
    let text = fs::read_to_string(folder.join("mesh.inp")).unwrap();
    folder.write("outer.inp", "*INCLUDE, INPUT=mesh.inp\n");
    std::os::unix::fs::symlink("mesh.inp", folder.join("link.inp")).unwrap();
    let before = snapshot(folder.path());
    for (input, output) in [
        ("mesh.inp", "mesh.inp"),
        ("mesh.inp", "./link.inp"),
        ("link.inp", "mesh.inp"),
        ("outer.inp", "mesh.inp"),
        (".", "."),
        ("scene.toml", "."),
    ] {
        let outcome = convert(input, output);
        assert_eq!((outcome.code, outcome.stderr.lines().count()), (2, 1), "{input} {output}: {outcome:?}");
        assert!(outcome.stderr.contains("the input file, expected another file"), "{outcome:?}");
    }
    assert!(snapshot(folder.path()) == before);
    convert("mesh.inp", "lists").good();
    assert_eq!(text, fs::read_to_string(folder.join("mesh.inp")).unwrap());
}

/// H2.
#[test]
fn hash_covers_all_mesh_files() {
    let folder = Folder::new("mesh_hash");
    fs::create_dir(folder.join("lists")).unwrap();
    write_lists(&small_block(), &folder.join("lists"));
    trackbed_in(folder.path(), ["mesh", "convert", "lists", "inner.inp"]).good();
    folder.write("outer.inp", "** a mesh in another file\n*INCLUDE, INPUT=inner.inp\n");
    let lists = "nodes = \"NODECOORD.DAT\"\nelements = \"ELEMENTNUM.DAT\"\nconstraints = \"DOF.DAT\"\n";
    for (mesh, changed) in [("lists", "lists/NODECOORD.DAT"), ("outer.inp", "inner.inp")] {
        let scene = folder.write("scene.toml", &COUPLED.replace(lists, &format!("mesh = \"{mesh}\"\n")));
        let out = folder.join(mesh.trim_end_matches(".inp")).join("out");
        let out = if mesh == "lists" { folder.join("out_of_lists") } else { out };
        let options = Options {
            out: Some(out.clone()),
            threads: Some(1),
            verbosity: Verbosity::Quiet,
            interrupt: Interrupt::after(20),
            ..Options::default()
        };
        assert_eq!(trackbed::run::run(&scene, &options).unwrap_err().code(), 130);
        let text = fs::read_to_string(folder.join(changed)).unwrap();
        fs::write(folder.join(changed), format!("{text}\n")).unwrap();
        refused(arguments(&scene, &out, &["--resume"]), &format!("{changed} has changed"));
        fs::write(folder.join(changed), text).unwrap();
        trackbed(arguments(&scene, &out, &["--resume"])).good();
    }
}

/// H3: one flipped digit of the format version damages that slot only.
#[test]
fn damaged_slot_leaves_other_valid() {
    let folder = scene_folder("flipped", COUPLED);
    let (scene, out) = (folder.join("scene.toml"), folder.join("out"));
    for (steps, resume) in [(20, false), (10, true)] {
        let options = Options {
            out: Some(out.clone()),
            threads: Some(1),
            verbosity: Verbosity::Quiet,
            resume,
            interrupt: Interrupt::after(steps),
            ..Options::default()
        };
        trackbed::run::run(&scene, &options).unwrap_err();
    }
    let slot = out.join("checkpoint/b.checkpoint");
    let mut bytes = fs::read(&slot).unwrap();
    let digit = b"trackbed checkpoint ".len();
    bytes[digit] ^= 1;
    fs::write(&slot, bytes).unwrap();
    let outcome = trackbed(arguments(&scene, &out, &["--resume"])).good();
    let remark = "b.checkpoint is damaged: wrong checksum; the run resumes from";
    assert!(outcome.stderr.starts_with("warning: ") && outcome.stderr.contains(remark), "{outcome:?}");
}

#[test]
fn check_finds_errors_of_later_stages() {
    let folder = Folder::new("beforehand");
    let bonds = "[[bond]]\nname = \"glue\"\ngap = 0.001\nbetween = [\"pair\", \"pair\"]\n\
                 direct = { stiffness = [1e6, 1e6, 1e3, 1e3] }\n";
    let one = GRAINS.replace(", [0.01, 0.0, 0.152, 0.05]]", "]");
    for (name, text) in [
        ("apart", GRAINS.replace("0.152", "0.352")),
        ("alone", format!("{one}\n[deposition]\nmax_time = 0.1\nsettled_speed = 0.01\n")),
    ] {
        let scene = folder.write(&format!("{name}.toml"), &format!("{text}\n{bonds}"));
        let out = folder.join(name);
        let words = "bond.0: found no pair for \"glue\", expected a bond that joins grains";
        refused([Path::new("check"), &scene], words);
        refused(arguments(&scene, &out, &[]), words);
        assert!(!out.exists());
    }
    let lateral = repository().join("inputs/ballast/lateral.toml");
    let set = ["--set", "track.push.stiffness=1e14", "--set", "time.grain_step=5e-7"];
    refused(
        ["check", lateral.to_str().unwrap(), set[0], set[1], set[2], set[3]],
        "track.push.stiffness: found 1.000e14 N/m",
    );
    let begun = Instant::now();
    refused(arguments(&lateral, &folder.join("lateral"), &set), "track.push.stiffness: found 1.000e14 N/m");
    assert!(begun.elapsed() < Duration::from_secs(10) && !folder.join("lateral").exists());
}
