//! Targets for random bytes (cargo-fuzz and tests): they return, fast and with little memory.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use trackbed::read::{MESH_ENDINGS, SURFACE_ENDINGS, read_mesh_file, read_surface};
use trackbed::results::grains::GrainFile;
use trackbed::results::lines::{Chains, Walls};
use trackbed::results::solid::{self, Skin};
use trackbed::run::check_checkpoint;
use trackbed::scene::Document;
use trackbed::study::count_runs;
use trackbed::write::hdf5;

/// Unique file per concurrent call.
fn file(ending: &str, bytes: &[u8]) -> PathBuf {
    static NUMBER: AtomicU32 = AtomicU32::new(0);
    let number = NUMBER.fetch_add(1, Ordering::Relaxed) % 64;
    let name = format!("trackbed_target_{}_{number}.{ending}", std::process::id());
    let file = std::env::temp_dir().join(name);
    std::fs::write(&file, bytes).expect("the folder for temporary files can be written");
    file
}

/// Mesh readers; the first byte selects the format.
pub fn mesh(data: &[u8]) {
    let Some((form, bytes)) = data.split_first() else { return };
    let file = file(MESH_ENDINGS[*form as usize % MESH_ENDINGS.len()], bytes);
    drop(read_mesh_file(&file));
    let _ = std::fs::remove_file(file);
}

/// Surface readers; the first byte selects the format.
pub fn surface(data: &[u8]) {
    let Some((form, bytes)) = data.split_first() else { return };
    let file = file(SURFACE_ENDINGS[*form as usize % SURFACE_ENDINGS.len()], bytes);
    drop(read_surface(&file));
    let _ = std::fs::remove_file(file);
}

/// Frame readers; the first byte selects the part.
pub fn frame(data: &[u8]) {
    let Some((part, bytes)) = data.split_first() else { return };
    let is_solid = part % 4 == 3;
    let file = file(if is_solid { "vtu" } else { "vtp" }, bytes);
    match part % 4 {
        0 => {
            if let Ok(grains) = GrainFile::open(&file) {
                grains.fields().iter().for_each(|name| drop(grains.field(name)));
                drop((grains.bounds(), grains.bodies.extents()));
            }
        }
        1 => drop(Chains::open(&file)),
        2 => {
            if let Ok(walls) = Walls::open(&file) {
                walls.fields().iter().for_each(|name| drop(walls.field(name)));
            }
        }
        _ => {
            if let Ok(skin) = Skin::open(&file) {
                let names = solid::fields(&file).unwrap_or_default();
                names.iter().for_each(|name| drop(skin.field(&file, name)));
                drop((skin.bounds(), skin.displacement(&file)));
            }
        }
    }
    let _ = std::fs::remove_file(file);
}

/// VTKHDF file of a resumed run: length byte, mark, file.
pub fn vtkhdf(data: &[u8]) {
    let Some((&length, bytes)) = data.split_first() else { return };
    let (mark, content) = bytes.split_at(bytes.len().min(usize::from(length)));
    let file = file("vtkhdf", content);
    if let Ok(mut resumed) = hdf5::File::resume(&file, mark) {
        drop(resumed.commit());
    }
    let _ = std::fs::remove_file(file);
}

/// Checkpoint and state reader.
pub fn checkpoint(data: &[u8]) {
    let file = file("checkpoint", data);
    drop(check_checkpoint(&file));
    let _ = std::fs::remove_file(file);
}

/// Study reader.
pub fn study(data: &[u8]) {
    let file = file("toml", data);
    drop(count_runs(&file));
    let _ = std::fs::remove_file(file);
}

/// Target by name, equal to its file in `fuzz_targets` and directory in `corpus`.
pub fn named(name: &str) -> fn(&[u8]) {
    match name {
        "mesh" => mesh,
        "surface" => surface,
        "scene" => scene,
        "frame" => frame,
        "vtkhdf" => vtkhdf,
        "checkpoint" => checkpoint,
        "study" => study,
        other => panic!("no target {other}"),
    }
}

/// Scene parser; the last line is an override.
pub fn scene(data: &[u8]) {
    let text = String::from_utf8_lossy(data).into_owned();
    let (text, set) = text.rsplit_once('\n').unwrap_or((&text, &text));
    let Ok(mut document) = Document::parse(Path::new("scene.toml"), text.to_string()) else { return };
    drop(document.scene());
    if document.set(set).is_ok() {
        drop(document.scene());
    }
    drop(document.error("solid.material.0.young", "a", "b").to_string());
}
