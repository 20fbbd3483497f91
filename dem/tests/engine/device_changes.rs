//! Changes of the text of the kernels that a comparison must detect. Each runs in a process of its own: a changed kernel may write beyond
//! its buffers, which would end the process of the tests or spoil the memory of other tests.

use crate::c_machine::device_is_there;
use crate::device::{STEPS, compare_events, gas, smooth};
use crate::scene::stone;
use std::process::{Command, ExitStatus};

/// Environment variable with the number of the change that a child process runs.
const CHANGE: &str = "TRACKBED_KERNEL_CHANGE";
/// Line of a child process whose changed kernels are compiled and loaded.
const LOADED: &str = "changed kernels loaded";
/// Exit code of a child process whose comparison has detected the change.
const DETECTED: i32 = 42;

/// End of the comparison with one changed kernel.
#[derive(Debug, PartialEq)]
enum End {
    /// The states or the ledgers differ, or a step fails.
    Differs,
    /// The changed kernel has ended its process by a signal or a panic.
    Crashes,
    /// Every bit is as it was.
    Same,
}

/// Reports that kernels are compiled and loaded, where this is the process of a change: a crash after this is that of the kernels.
pub(crate) fn report_loaded() {
    if std::env::var_os(CHANGE).is_some() {
        println!("\n{LOADED}");
    }
}

/// Runs `compare` for each change of a text, `from` and `to` of its first place, in a process of its own: that of `test` alone, which
/// must call this function with the same changes.
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
        // Nothing is freed: the kernel may have spoiled what the allocator keeps.
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

/// End of a comparison by the status and the output of its process; `None` where no changed kernel has run.
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

/// Fails where a comparison does not detect one of the changes.
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

/// A kernel that crashes is detected, and one that differs in a blank is not. A device of CUDA has other words for a crash.
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
