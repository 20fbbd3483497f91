//! Kernel changes that a comparison must detect. Each runs in its own process: a changed kernel may write
//! outside its buffers.

use crate::c_machine::device_is_there;
use crate::device::{STEPS, compare_events, gas, smooth};
use crate::scene::stone;
use std::process::{Command, ExitStatus};

/// Environment variable with the index of a child's change.
const CHANGE: &str = "TRACKBED_KERNEL_CHANGE";
/// Output of a child after loading its changed kernels.
const LOADED: &str = "changed kernels loaded";
/// Exit code of a child that detected the change.
const DETECTED: i32 = 42;

#[derive(Debug, PartialEq)]
enum End {
    /// State, balance or error differs.
    Differs,
    /// Ended by a signal or panic.
    Crashes,
    /// Bitwise identical.
    Same,
}

/// Marks kernels as loaded, in a child: later crashes are theirs.
pub(crate) fn report_loaded() {
    if std::env::var_os(CHANGE).is_some() {
        println!("\n{LOADED}");
    }
}

/// Runs `compare` for each change (`from`, `to`, first place) in a child that executes only `test`.
fn ends(
    test: &str,
    changes: &[(&str, &str)],
    compare: impl Fn(usize, &dyn Fn(String) -> String) -> Option<usize>,
) -> Vec<End> {
    if let Ok(number) = std::env::var(CHANGE) {
        let k: usize = number.parse().expect("the number of a change");
        let (from, to) = changes[k];
        let differs = compare(k, &|text| {
            assert!(text.contains(from), "{from}");
            text.replacen(from, to, 1)
        });
        println!("{from} -> {to}: {differs:?}");
        // Skips freeing: the heap may be corrupt.
        std::process::exit(if differs.is_some() { DETECTED } else { 0 });
    }
    let program = std::env::current_exe().expect("the path of the tests");
    let run = |k: usize| {
        let output = Command::new(&program)
            .args([test, "--exact", "--nocapture", "--test-threads=1"])
            .env(CHANGE, k.to_string())
            .output()
            .expect("a process of the tests");
        let text = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
        let end = end_of(output.status, &text);
        println!("{} -> {}: {end:?}", changes[k].0, changes[k].1);
        end.unwrap_or_else(|| panic!("{}: no comparison: {}: {text}", changes[k].0, output.status))
    };
    (0..changes.len()).map(run).collect()
}

/// `None` if no changed kernel ran.
fn end_of(status: ExitStatus, text: &str) -> Option<End> {
    if !text.lines().any(|line| line == LOADED) {
        return None;
    }
    Some(match status.code() {
        Some(DETECTED) => End::Differs,
        Some(0) => End::Same,
        _ => End::Crashes,
    })
}

pub(crate) fn assert_detected(
    test: &str,
    changes: &[(&str, &str)],
    compare: impl Fn(usize, &dyn Fn(String) -> String) -> Option<usize>,
) {
    let ends = ends(test, changes, compare);
    for ((from, to), end) in changes.iter().zip(ends) {
        assert_ne!(end, End::Same, "{from} -> {to}");
    }
}

#[test]
fn crash_of_changed_kernel_is_detected() {
    if device_is_there() && std::env::var_os("TRACKBED_DEVICE").is_none() {
        let lane = "unsigned k = lane;";
        let changes = [
            (lane, "unsigned k = lane + (__builtin_trap(), 0u);"),
            (lane, "unsigned  k = lane;"),
            (lane, "unsigned k = lane + (1u << 30);"),
        ];
        let ends = ends("device_changes::crash_of_changed_kernel_is_detected", &changes, |_, change| {
            compare_events(gas([stone(), smooth()], Vec::new()), STEPS / 10, change, |_, _| false).0
        });
        assert_eq!(ends, [End::Crashes, End::Same, End::Differs]);
    }
}
