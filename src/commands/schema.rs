//! `trackbed schema`: scene keys.

use super::output::print;
use std::path::{Path, PathBuf};
use trackbed_input::scene::{reference, schema as scene_schema};
use trackbed_io::failure::Failure;
use trackbed_io::read::source;
use trackbed_io::write::{WriteError, atomic};

/// Prints the JSON schema, or key tables with `markdown`; updates a given page.
///
/// # Errors
/// I/O errors, or a mark without table.
pub fn schema(markdown: Option<Option<PathBuf>>) -> Result<(), Failure> {
    let keys = scene_schema::keys();
    match markdown {
        None => print(&format!("{:#}\n", scene_schema::schema())),
        Some(None) => {
            let frame = reference::frame(&keys);
            print(&reference::fill(&keys, &frame).map_err(|mark| fault(Path::new("tables"), &mark))?)
        }
        Some(Some(page)) => {
            let text = source::text(&page).map_err(|refusal| Failure::Input(refusal.sentence(&page)))?;
            let text = reference::fill(&keys, &text).map_err(|mark| fault(&page, &mark))?;
            atomic::write(&page, |out| out.write_all(text.as_bytes()).map_err(WriteError::io(&page)))?;
            print(&format!("{} written\n", page.display()))
        }
    }
}

fn fault(page: &Path, mark: &reference::BadMark) -> Failure {
    let reference::BadMark { line, keys } = mark;
    let expected = "the keys of a table of a scene, or `scene`";
    Failure::Input(format!("{}:{line}: keys: found {keys}, expected {expected}", page.display()))
}
