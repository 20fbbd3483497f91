//! `trackbed report`: HTML report of runs.

use super::output::print;
use crate::cli::ReportArgs;
use trackbed_io::failure::Failure;
use trackbed_post::report::{self, Options};

/// Writes a report and prints its path.
///
/// # Errors
/// Input and I/O errors.
pub fn report(args: ReportArgs) -> Result<(), Failure> {
    let ReportArgs { folders, out, title, axle_load, force } = args;
    let options = Options { folders, out, title, axle_load, force };
    let page = report::write(&options)?;
    print(&format!("{} written\n", page.display()))
}
