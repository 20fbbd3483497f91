//! `trackbed report`: HTML report of runs.

use super::output::print;
use crate::cli::ReportArgs;
use crate::failure::Failure;
use crate::report::{self, Options};

/// Writes a report and prints its path.
///
/// # Errors
/// Input and I/O errors.
pub fn report(args: ReportArgs) -> Result<(), Failure> {
<<<<<<< HEAD
    let options =
        Options { folders: args.folders, out: args.out, title: args.title, axle_load: args.axle_load };
=======
    let options = Options { folders: args.folders, out: args.out, title: args.title, force: args.force };
>>>>>>> h-files
    let page = report::write(&options)?;
    print(&format!("{} written\n", page.display()))
}
