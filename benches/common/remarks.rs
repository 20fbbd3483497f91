//! Lines below divan's table.

use std::sync::Mutex;

static REMARKS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Stores a line for [`print`].
pub fn add(line: String) {
    REMARKS.lock().expect("no benchmark panicked").push(line);
}

/// Prints the stored lines.
pub fn print() {
    for line in REMARKS.lock().expect("no benchmark panicked").drain(..) {
        println!("{line}");
    }
}
