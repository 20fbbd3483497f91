//! Partitioned and interrupted studies.

use super::{SWING, arguments, folder, steps, table, without_times};
use crate::suite::support::{Folder, snapshot, trackbed};
use std::fs;

#[test]
fn merged_parts_equal_full_study() {
    let folder = folder("study_parts", &steps());
    trackbed(arguments(&folder, "whole", &[])).good();
    for part in ["1/3", "3/3"] {
        let said = trackbed(arguments(&folder, "parts", &["--task", part, "--jobs", "1"])).good();
        assert!(said.stdout.contains("--merge"), "{}", said.stdout);
    }
    assert!(!folder.join("parts/study.csv").exists(), "a part makes no tables");
    let said = trackbed(arguments(&folder, "parts", &["--merge"])).good().stdout;
    assert!(said.contains("1 of 4 runs are missing: \"step=0.1 ms\"\n"), "{said}");
    let rows = table(&folder.join("parts/study.csv"));
    assert_eq!(rows[1]["reasons"], "step=0.1 ms: missing");
    trackbed(arguments(&folder, "parts", &["--task", "2/3", "--resume"])).good();
    let before = snapshot(&folder.join("parts/runs"));
    let said = trackbed(arguments(&folder, "parts", &["--merge"])).good().stdout;
    assert!(!said.contains("missing"), "{said}");
    assert_eq!(snapshot(&folder.join("parts/runs")), before, "a merger runs nothing");
    assert_eq!(without_times(&folder.join("parts")), without_times(&folder.join("whole")));
    let again = trackbed(arguments(&folder, "parts", &["--task", "1/3"]));
    assert_eq!(again.code, 2, "{}", again.stderr);
    let nowhere = trackbed(arguments(&folder, "nowhere", &["--merge"]));
    assert_eq!(nowhere.code, 2, "{}", nowhere.stderr);
    assert!(!folder.join("nowhere").exists());
}

#[test]
#[cfg(unix)]
fn an_interrupted_study_goes_on() {
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};
    let folder = Folder::new("study_interrupted");
    folder.write("scene.toml", &SWING.replace("end = \"1 ms\"", "end = \"0.8 s\""));
    let text =
        steps().replace("values = [\"0.1 ms\", \"0.05 ms\", \"0.025 ms\"]", "values = [1e-6, 1.25e-6, 2e-6]");
    let text = text.replace("set = [\"time.grain_step=3.125e-6\"]", "set = [\"time.grain_step=0.8e-6\"]");
    folder.write("study.toml", &text.replace(&format!("exact = {:?}\n", super::height()), ""));
    trackbed(arguments(&folder, "whole", &[])).good();
    let mut child = Command::new(env!("CARGO_BIN_EXE_trackbed"))
        .args(arguments(&folder, "out", &["--jobs", "2", "--threads", "1"]))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while !folder.join("out/runs/reference/history.csv").exists() {
        assert!(begun.elapsed() < Duration::from_secs(60), "the first run does not begin");
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let mut said = String::new();
    std::io::Read::read_to_string(&mut child.stderr.take().unwrap(), &mut said).unwrap();
    assert!(said.contains("interrupted; resume with: trackbed study"), "{said}");
    assert!(folder.join("out/runs/reference/checkpoint").exists(), "{said}");
    assert!(!folder.join("out/study.csv").exists());
    trackbed(arguments(&folder, "out", &["--resume"])).good();
    assert_eq!(without_times(&folder.join("out")), without_times(&folder.join("whole")));
    assert!(!folder.join("out/runs/reference/checkpoint").exists());
    // Without a checkpoint a run restarts from zero.
    let run = folder.join("out/runs/step=0.000002");
    fs::remove_file(run.join("summary.json")).unwrap();
    trackbed(arguments(&folder, "out", &["--resume"])).good();
    assert_eq!(without_times(&folder.join("out")), without_times(&folder.join("whole")));
}
