//! Closed or full outputs, signals, and internal errors.

use super::super::support::{COUPLED, Folder, PLASTIC, json, repository, results, run, scene_folder};
use super::{refused, within};
use std::fs::{self, File};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

fn program(scene: &Path, out: &Path, set: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    command.arg("run").arg(scene).arg("--out").arg(out).args(["--threads", "1"]);
    set.iter().for_each(|s| {
        command.args(["--set", s]);
    });
    command
}

const SHORT: [&str; 3] = ["grains.0.count=50", "time.end=0.02", "output.frames=1"];

#[test]
fn a_run_needs_nobody_who_listens() {
    let folder = Folder::new("listeners");
    let scene = repository().join("inputs/ballast/box.toml");
    let set = [
        "grains.0.count=20",
        "deposition.max_time=0.01",
        "time.end=",
        "track.load.cycles=1",
        "output.frames=1",
    ];
    let scene_of_beds = (scene.as_path(), &set[..]);
    let spheres = repository().join("inputs/grains/box.toml");
    for (name, (scene, set)) in [("spheres", (spheres.as_path(), &SHORT[..])), ("bed", scene_of_beds)] {
        for kind in ["closed", "full"] {
            let out = folder.join(&format!("{name}_{kind}"));
            let mut command = program(scene, &out, set);
            let code = if kind == "full" {
                let full = || File::options().write(true).open("/dev/full").unwrap();
                command.stdout(full()).stderr(full()).status().unwrap().code()
            } else {
                let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
                drop((child.stdout.take(), child.stderr.take()));
                child.wait().unwrap().code()
            };
            assert_eq!(code, Some(0), "{name}, {kind}");
            assert_eq!(json(&out.join("summary.json"))["status"], "done");
        }
    }
    // For a command whose output is text, a full device is an error.
    let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
    let full = File::options().write(true).open("/dev/full").unwrap();
    let output = command.arg("check").arg(&spheres).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8(output.stderr).unwrap().starts_with("error: "));
}

fn kill(signal: &str, child: &Child) {
    let status = Command::new("kill").args([&format!("-{signal}"), &child.id().to_string()]).status();
    assert!(status.unwrap().success());
}

fn wait_for(rows: usize, out: &Path, child: &mut Child) {
    let begun = Instant::now();
    while fs::read_to_string(out.join("history.csv")).map_or(0, |t| t.lines().count()) < rows {
        assert!(begun.elapsed() < Duration::from_secs(120), "the run does not begin");
        assert!(child.try_wait().unwrap().is_none(), "the run ends too early");
        sleep(Duration::from_millis(1));
    }
}

/// Restores the default SIGHUP, which `nohup` would suppress in the child.
fn with_default_hangup(mut command: Command) -> Command {
    // SAFETY: `signal`, the only call between fork and exec, is async-signal-safe.
    unsafe {
        command.pre_exec(|| match libc::signal(libc::SIGHUP, libc::SIG_DFL) {
            libc::SIG_ERR => Err(std::io::Error::last_os_error()),
            _ => Ok(()),
        })
    };
    command
}

/// G6: SIGHUP saves a checkpoint, except under `nohup`.
#[test]
fn hanging_up_leaves_a_checkpoint() {
    let folder = Folder::new("hang_up");
    let scene = repository().join("inputs/grains/box.toml");
    let set = ["grains.0.count=3000", "time.end=0.2", "output.frames=2"];
    let out = folder.join("out");
    let mut command = with_default_hangup(program(&scene, &out, &set));
    let mut child = command.stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    wait_for(4, &out, &mut child);
    kill("HUP", &child);
    let said = child.wait_with_output().unwrap();
    assert_eq!(said.status.code(), Some(130), "{said:?}");
    assert!(out.join("checkpoint/a.checkpoint").is_file() && !out.join("run.lock").exists());
    let ignoring = folder.join("ignoring");
    let mut command = Command::new("sh");
    command.args(["-c", "trap '' HUP; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_trackbed"), "run"]);
    command.arg(&scene).arg("--out").arg(&ignoring).args([
        "--quiet",
        "--set",
        set[0],
        "--set",
        "time.end=0.05",
    ]);
    let mut child = command.spawn().unwrap();
    wait_for(4, &ignoring, &mut child);
    kill("HUP", &child);
    assert_eq!(child.wait().unwrap().code(), Some(0));
}

/// G6.
#[test]
fn file_size_limit_names_file() {
    let folder = Folder::new("file_size");
    let scene = repository().join("inputs/grains/box.toml");
    let out = folder.join("out");
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -f 16; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_trackbed"), "run"]);
    command.arg(&scene).arg("--out").arg(&out).args(["--quiet", "--set", "output.history_interval=1e-5"]);
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), text.lines().count()), (Some(1), 1), "{text}");
    assert!(text.starts_with("error: ") && text.contains("cannot be written"), "{text}");
}

#[test]
fn an_interrupt_is_acknowledged_at_once() {
    let folder = Folder::new("acknowledged");
    let scene = repository().join("inputs/solid/embankment_large.toml");
    let out = folder.join("out");
    let set = ["solid.block.x.counts=[60]", "solid.block.y.counts=[24]", "solid.block.z.counts=[8, 8]"];
    let mut child = program(&scene, &out, &set).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    let begun = Instant::now();
    while !out.join("run.lock").exists() {
        assert!(begun.elapsed() < Duration::from_secs(600) && child.try_wait().unwrap().is_none());
        sleep(Duration::from_millis(2));
    }
    kill("INT", &child);
    let begun = Instant::now();
    let said = child.wait_with_output().unwrap();
    let text = String::from_utf8(said.stderr).unwrap();
    // 50 ms, plus machine load.
    assert!(begun.elapsed() < Duration::from_secs(5), "{:?}: {text}", begun.elapsed());
    assert_eq!(said.status.code(), Some(130), "{text}");
    assert!(text.lines().any(|l| l == "interrupted: nothing to save"), "{text}");
}

/// G6: checked between plastic iterations; resuming is bitwise identical.
#[test]
fn a_plastic_step_hears_the_interrupt() {
    let folder = Folder::new("plastic_interrupt");
    let scene = folder.write("scene.toml", PLASTIC);
    // Two steps of twenty iterations.
    let set = [
        "solid.block.x.counts=[6]",
        "solid.block.y.counts=[5]",
        "solid.block.z.counts=[4, 5]",
        "time.solid_step=0.5",
    ];
    let (whole, out) = (folder.join("whole"), folder.join("out"));
    let begun = Instant::now();
    run(&scene, &whole, &set).good();
    let all = begun.elapsed();
    let mut child = program(&scene, &out, &set).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    wait_for(2, &out, &mut child);
    sleep(all / 10);
    kill("INT", &child);
    let begun = Instant::now();
    let said = child.wait_with_output().unwrap();
    let (took, text) = (begun.elapsed(), String::from_utf8(said.stderr).unwrap());
    assert_eq!(said.status.code(), Some(130), "{text}");
    assert!(text.contains("interrupted: stage \"run\", step 0, t = 0.000000e0 s"), "{text}");
    assert!(took < all / 2, "{took:?} of {all:?} to hear it");
    let mut resumed = program(&scene, &out, &set);
    assert!(resumed.args(["--resume", "--quiet"]).status().unwrap().success());
    let (whole, out) = (results(&whole), results(&out));
    assert!(whole.keys().eq(out.keys()));
    whole.iter().for_each(|(name, bytes)| assert!(*bytes == out[name], "{name} differs after a restart"));
}

#[test]
fn panic_is_one_line() {
    let folder = scene_folder("fault", COUPLED);
    let scene = folder.join("scene.toml");
    // Rounding of such dashpots makes the reduced matrix indefinite.
    let set = [
        "solid.absorbing=[{ side = \"x-\", normal = 1e150 }]",
        "solid.reduction={ kind = \"surface\", modes = 0 }",
    ];
    let output =
        program(&scene, &folder.join("out"), &set).arg("--quiet").env_remove("RUST_BACKTRACE").output();
    let output = output.unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), text.lines().count()), (Some(3), 1), "{text}");
    assert!(text.starts_with("error: internal error: a damped body at rest"), "{text}");
    assert!(text.contains("reduced.rs") && text.contains("please report it"), "{text}");
    let status = json(&folder.join("out/summary.json"))["status"].as_str().unwrap().to_string();
    assert!(status.starts_with("failed: internal error"), "{status}");
}

#[test]
fn messages_are_short_and_printable() {
    let folder = Folder::new("tokens");
    let scene = folder.write(
        "scene.toml",
        &format!(
            "title = \"{}\"\nodd = 1\n[solid]\nmesh = \"x\\u001b[31m.{}\"\n",
            "t".repeat(200_000),
            "y".repeat(200_000)
        ),
    );
    for arguments in [
        vec!["check".to_string(), scene.display().to_string()],
        vec!["mesh".into(), "info".into(), scene.display().to_string()],
    ] {
        let outcome = within(20, &arguments).unwrap();
        assert!(outcome.code == 2 && outcome.stderr.len() < 9000, "{} bytes", outcome.stderr.len());
        assert!(!outcome.stderr.trim_end().contains(|c: char| c.is_control()), "{outcome:?}");
    }
    let nodes = folder.write("NODECOORD.DAT", &format!("1 0 0 {}\n", "9".repeat(200_000) + "x\u{7}"));
    folder.write("ELEMENTNUM.DAT", "1 1 1\n");
    refused([Path::new("mesh"), Path::new("info"), nodes.parent().unwrap()], "… (20000");
}
