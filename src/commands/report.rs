//! `trackbed report`: HTML report of runs, or of a study.

use super::output::print;
use crate::cli::ReportArgs;
use crate::study;
use trackbed_io::failure::Failure;
use trackbed_report::{self as report, Options};

/// Writes a report and prints its path.
///
/// # Errors
/// Input and I/O errors.
pub fn report(args: ReportArgs) -> Result<(), Failure> {
    let ReportArgs { folders, out, title, axle_load, force } = args;
    let options = Options { folders, out, title, axle_load, force };
    let page = match options.folders.as_slice() {
        [dir] if study::is_study(dir) => study::report(&options)?,
        _ => report::write(&options)?,
    };
    print(&format!("{} written\n", page.display()))
}
