//! What is called with bytes at random, by cargo-fuzz and by the tests: whatever comes of it, it returns, soon and in little
//! memory.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use trackbed::read::{MESH_ENDINGS, SURFACE_ENDINGS, read_mesh_file, read_surface};
use trackbed::scene::{Document, Scene};

/// A file of its own for each call at one time.
fn file(ending: &str, bytes: &[u8]) -> PathBuf {
    static NUMBER: AtomicU32 = AtomicU32::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed) % 64;
    let name = format!("trackbed_target_{}_{number}.{ending}", std::process::id());
    let file = std::env::temp_dir().join(name);
    std::fs::write(&file, bytes).expect("the folder for temporary files can be written");
    file
}

/// Readers of meshes: the first byte chooses the form, the rest is the file.
pub fn mesh(data: &[u8]) {
    let Some((form, bytes)) = data.split_first() else { return };
    let file = file(MESH_ENDINGS[*form as usize % MESH_ENDINGS.len()], bytes);
    drop(read_mesh_file(&file));
    let _ = std::fs::remove_file(file);
}

/// Readers of surfaces, the same way.
pub fn surface(data: &[u8]) {
    let Some((form, bytes)) = data.split_first() else { return };
    let file = file(SURFACE_ENDINGS[*form as usize % SURFACE_ENDINGS.len()], bytes);
    drop(read_surface(&file));
    let _ = std::fs::remove_file(file);
}

/// The parser of scenes; the last line is an override as `--set` takes it.
pub fn scene(data: &[u8]) {
    let text = String::from_utf8_lossy(data).into_owned();
    let (text, set) = text.rsplit_once('\n').unwrap_or((&text, &text));
    let Ok(mut document) = Document::parse(Path::new("scene.toml"), text.to_string()) else { return };
    drop(document.read::<Scene>());
    if document.set(set).is_ok() {
        drop(document.read::<Scene>());
    }
    drop(document.error("solid.material.0.young", "a", "b").to_string());
}
