//! `trackbed report`: a page of one or several runs.

use super::output::print;
use crate::cli::ReportArgs;
use crate::failure::Failure;
use crate::report::{self, Options};

/// Writes the report of folders of results, and prints where it is.
///
/// # Errors
/// Bad input, or a page that cannot be written.
pub fn report(args: ReportArgs) -> Result<(), Failure> {
    let options = Options { folders: args.folders, out: args.out, title: args.title };
    let page = report::write(&options)?;
    print(&format!("{} written\n", page.display()))
}
