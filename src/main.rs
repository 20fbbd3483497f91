//! The command line of trackbed.
fn main() {}
