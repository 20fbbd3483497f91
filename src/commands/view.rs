//! `trackbed view`: results or a scene in a browser.

use std::path::Path;

use super::check;
use super::output::{print, refuse_existing};
use crate::cli::ViewArgs;
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_io::results::series;
use trackbed_io::system;
use trackbed_post::preview::{self, Preview, Source};
use trackbed_post::view::{self, Coding, Live, Results, Still};
use trackbed_run::size;

/// Serves results or a scene, or writes them as one HTML file.
///
/// # Errors
/// No results, no scene; see [`Failure`].
pub fn view(args: &ViewArgs) -> Result<(), Failure> {
    if let Some(source) = scene(&args.dir, &args.set)? {
        return match &args.export {
            Some(file) => export_scene(args, file, &source),
            None => serve_scene(args, source),
        };
    }
    match &args.export {
        Some(file) => export(args, file),
        None => serve(args),
    }
}

/// Returns the scene of a path; `None` for a results directory.
///
/// # Errors
/// Neither of them; overrides of results.
pub(super) fn scene(path: &Path, set: &[String]) -> Result<Option<Source>, Failure> {
    if let Some(file) = preview::scene_file(path) {
        let source = Source::new(&file, set);
        source.notes().iter().for_each(|note| message::note(note));
        return Ok(Some(source));
    }
    if !path.is_dir() {
        let found = if path.exists() { "a file" } else { "no such directory" };
        return Err(Failure::Input(format!(
            "{}: found {found}, expected the results directory of a run, or a scene (.toml)",
            path.display()
        )));
    }
    if set.is_empty() {
        return Ok(None);
    }
    Err(Failure::Input("--set: found, but it has no effect without a scene".to_string()))
}

fn export(args: &ViewArgs, file: &Path) -> Result<(), Failure> {
    refuse_existing(file, args.force)?;
    let results = Results::open(&args.dir, Coding::Compact)?.every(args.every.get());
    let name = args.dir.canonicalize()?.file_name().map(|n| n.to_string_lossy().into_owned());
    view::export::export(file, &name.unwrap_or_default(), &results)?;
    let bytes = std::fs::metadata(file)?.len();
    print(&format!("{}: {} frames, {}\n", file.display(), results.frames.len(), size(bytes)))
}

fn export_scene(args: &ViewArgs, file: &Path, source: &Source) -> Result<(), Failure> {
    refuse_existing(file, args.force)?;
    let (document, job) = source.resolve()?;
    let still = Still(Preview::new(&document, &job)?);
    view::export::export(file, &still.0.title, &still)?;
    let bytes = std::fs::metadata(file)?.len();
    print(&format!("{}: {} objects, {}\n", file.display(), still.0.items.len(), size(bytes)))
}

fn serve(args: &ViewArgs) -> Result<(), Failure> {
    // Study directories are shown run by run.
    if series::folders(&args.dir).is_empty() {
        Results::open(&args.dir, Coding::Exact)?;
    }
    let (listener, port) = begin(args)?;
    view::server::serve(listener, port, &args.dir)
}

/// Errors of the scene are shown in the page, where it recovers.
fn serve_scene(args: &ViewArgs, source: Source) -> Result<(), Failure> {
    if !source.file.is_file() {
        source.document()?;
    }
    let live = Live::new(source, |source| Ok(check::check(source, None, false)?.text(false)));
    let (listener, port) = begin(args)?;
    view::server::serve_scene(listener, port, live)
}

fn begin(args: &ViewArgs) -> Result<(std::net::TcpListener, u16), Failure> {
    let (listener, port) = view::server::bind(args.port)?;
    let address = format!("http://127.0.0.1:{port}/");
    print(&format!("{address} shows {}; Ctrl-C stops the server\n", args.dir.display()))?;
    if !args.no_open {
        open(&address);
    }
    Ok((listener, port))
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
