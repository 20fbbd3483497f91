//! Lines that are printed below divan's table.

use std::sync::Mutex;

static REMARKS: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Keeps a line for [`print`].
pub fn add(line: String) {
    REMARKS.lock().expect("no benchmark panicked").push(line);
}

/// Prints what was remarked, in order.
pub fn print() {
    for line in REMARKS.lock().expect("no benchmark panicked").drain(..) {
        println!("{line}");
    }
}
