//! See `targets::vtkhdf`.
#![no_main]

#[path = "../limits.rs"]
mod limits;
#[path = "../targets.rs"]
#[allow(dead_code, reason = "each target calls one function")]
mod targets;

libfuzzer_sys::fuzz_target!(|data: &[u8]| limits::within(targets::vtkhdf, data));
