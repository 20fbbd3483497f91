//! Hostile input and environment.
#![cfg(target_os = "linux")]

mod files;
mod folders;
mod limits;
mod mutations;
mod readers;
mod streams;

use super::support::Outcome;
use std::ffi::OsStr;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Memory limit of a rejection [kB], with thread stacks.
const MEMORY: u64 = 2_000_000;

/// Address space reserved by the dense-product library [kB]: twice the last cache per thread
/// (private-gemm-x86 0.1.22, `lib.rs`), 1.9 GB for 480 MiB.
fn reserved() -> u64 {
    let size = std::fs::read_to_string("/sys/devices/system/cpu/cpu0/cache/index3/size").unwrap_or_default();
    let number = |unit| size.trim().strip_suffix(unit).and_then(|n| n.parse::<u64>().ok());
    2 * 2 * number('K').or(number('M').map(|n| 1024 * n)).unwrap_or(0)
}

/// Runs with limited memory; `None` after `seconds`.
fn within<A: AsRef<OsStr>>(seconds: u64, arguments: impl IntoIterator<Item = A>) -> Option<Outcome> {
    let mut child = Command::new("sh")
        .args([
            "-c",
            &format!("ulimit -v {}; exec \"$0\" \"$@\"", MEMORY + reserved()),
            env!("CARGO_BIN_EXE_trackbed"),
        ])
        .args(arguments)
        .env("RAYON_NUM_THREADS", "2")
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // The output fits the pipe.
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > Duration::from_secs(seconds) {
            child.kill().unwrap();
            child.wait().unwrap();
            return None;
        }
        sleep(Duration::from_millis(2));
    }
    let output = child.wait_with_output().unwrap();
    Some(Outcome {
        code: output.status.code().unwrap_or(-1),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    })
}

#[track_caller]
fn refused<A: AsRef<OsStr>>(arguments: impl IntoIterator<Item = A>, words: &str) {
    let outcome = within(20, arguments).expect("a refusal comes at once");
    assert_eq!((outcome.code, outcome.stderr.lines().count()), (2, 1), "{outcome:?}");
    assert!(outcome.stderr.contains(words), "no {words:?} in {:?}", outcome.stderr);
}
