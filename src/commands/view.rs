//! `trackbed view`: results in a browser.

use std::path::Path;

use super::output::print;
use crate::cli::ViewArgs;
use crate::failure::Failure;
use crate::message;
use crate::results::series;
use crate::run::size;
use crate::system;
use crate::view::{self, Coding, Results};

/// Serves results, or exports one HTML file.
///
/// # Errors
/// No results; see [`Failure`].
pub fn view(args: &ViewArgs) -> Result<(), Failure> {
    let dir = &args.dir;
    if !dir.is_dir() {
        let found = if dir.exists() { "a file" } else { "no such directory" };
        return Err(Failure::Input(format!(
            "{}: found {found}, expected the results directory of a run",
            dir.display()
        )));
    }
    match &args.export {
        Some(file) => export(args, file),
        None => serve(args),
    }
}

fn export(args: &ViewArgs, file: &Path) -> Result<(), Failure> {
    if file.exists() && !args.force {
        return Err(Failure::Input(format!(
            "{}: found an existing file, expected a new file, or --force to overwrite it",
            file.display()
        )));
    }
    let results = Results::open(&args.dir, Coding::Compact)?.every(args.every.get());
    let name = args.dir.canonicalize()?.file_name().map(|n| n.to_string_lossy().into_owned());
    view::export::export(file, &name.unwrap_or_default(), &results)?;
    let bytes = std::fs::metadata(file)?.len();
    print(&format!("{}: {} frames, {}\n", file.display(), results.frames.len(), size(bytes)))
}

fn serve(args: &ViewArgs) -> Result<(), Failure> {
    // Study directories are shown run by run.
    if series::folders(&args.dir).is_empty() {
        Results::open(&args.dir, Coding::Exact)?;
    }
    let (listener, port) = view::server::bind(args.port)?;
    let address = format!("http://127.0.0.1:{port}/");
    print(&format!("{address} shows {}; Ctrl-C stops the server\n", args.dir.display()))?;
    if !args.no_open {
        open(&address);
    }
    view::server::serve(listener, port, &args.dir)
}

fn open(address: &str) {
    let program = system::BROWSER;
    let quiet = std::process::Stdio::null;
    let started = std::process::Command::new(program)
        .arg(address)
        .stdin(quiet())
        .stdout(quiet())
        .stderr(quiet())
        .spawn();
    if started.is_err() {
        message::note(&format!("no browser started ({program}); open {address}"));
    }
}
