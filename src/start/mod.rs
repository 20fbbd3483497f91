//! `trackbed new`: a folder with a commented scene that runs, to begin one's own work with.
//!
//! The scenes are those of `inputs/`, with the files that they name; the program carries them, so that it needs nothing beside
//! itself. A template is one entry of [`TEMPLATES`].

use crate::failure::Failure;
use crate::write::WriteError;
use crate::write::atomic;
use std::path::{Path, PathBuf};

/// A scene to begin with.
pub struct Template {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it is, in one line.
    pub about: &'static str,
    /// Its place in `inputs/`.
    pub source: &'static str,
    /// The scene.
    text: &'static str,
    /// Files that it names.
    files: &'static [Beside],
}

/// A file beside a scene.
struct Beside {
    /// As the scene in `inputs/` names it.
    named: &'static str,
    bytes: &'static [u8],
}

/// A template from the folder `inputs/`: name, line, scene, files beside it.
macro_rules! template {
    ($name:literal, $about:literal, $folder:literal, $scene:literal, [$($file:literal),*]) => {
        Template {
            name: $name,
            about: $about,
            source: concat!($folder, "/", $scene),
            text: include_str!(concat!("../../inputs/", $folder, "/", $scene)),
            files: &[$(Beside {
                named: $file,
                bytes: include_bytes!(concat!("../../inputs/", $folder, "/", $file)),
            }),*],
        }
    };
}

/// All templates.
pub const TEMPLATES: &[Template] = &[
    template!(
        "track",
        "a sleeper on ballast, embankment and subgrade (ANSYS lists), loaded in cycles",
        "track/cyclic",
        "scene.toml",
        [
            "../../ballast/granite.toml",
            "NODECOORD.DAT",
            "ELEMENTNUM.DAT",
            "DOF.DAT",
            "../../data/ballast_stones.toml",
            "gradation.csv"
        ]
    ),
    template!(
        "box",
        "ballast stones in a box, a plate loaded in cycles",
        "ballast",
        "box.toml",
        ["granite.toml", "../data/ballast_stones.toml", "../data/gradations.csv"]
    ),
    template!(
        "bay",
        "a sleeper bay at full scale with a free shoulder, half of the track",
        "track/bay",
        "scene.toml",
        [
            "../../ballast/granite.toml",
            "../../data/ballast_stones.toml",
            "../../data/gradations.csv",
            "NODECOORD.DAT",
            "ELEMENTNUM.DAT",
            "DOF.DAT"
        ]
    ),
    template!(
        "shear",
        "direct shear test of ballast",
        "ballast",
        "direct-shear.toml",
        ["granite.toml", "../data/ballast_stones.toml", "../data/gradations.csv"]
    ),
    template!(
        "packing",
        "stones of a sieve curve settle in a box",
        "grains",
        "gradation.toml",
        ["stones.toml", "../data/gradations.csv"]
    ),
    template!("heap", "a column of grains that collapses into a heap", "grains", "column.toml", []),
    template!("hopper", "a hopper that empties onto the ground", "grains", "hopper.toml", []),
    template!("servo", "grains pressed by a plate that holds its pressure", "grains", "servo.toml", []),
    template!("footing", "bearing capacity of a strip footing (FEM only)", "solid", "footing.toml", []),
    template!("slope", "factor of safety of a slope (FEM only)", "solid", "slope.toml", []),
    template!("triaxial", "drained triaxial test of clay (FEM only)", "solid", "triaxial_drained.toml", []),
    template!(
        "rock",
        "uniaxial compression of a block of bonded grains",
        "geo/rock-ucs",
        "scene.toml",
        ["rock.csv", "top.csv", "bottom.csv"]
    ),
];

/// Name of the scene in the new folder.
pub const SCENE: &str = "scene.toml";

impl Template {
    /// The files to write: name and content. Paths in the scene become names beside it.
    pub fn contents(&self) -> Vec<(&'static str, Vec<u8>)> {
        let mut text = self.text.to_string();
        let mut all = Vec::new();
        for file in self.files {
            let name = name_of(file.named);
            text = text.replace(&format!("\"{}\"", file.named), &format!("\"{name}\""));
            all.push((name, file.bytes.to_vec()));
        }
        all.push((SCENE, text.into_bytes()));
        all
    }
}

/// The last part of a path with slashes.
fn name_of(path: &'static str) -> &'static str {
    path.rsplit('/').next().unwrap_or(path)
}

/// Writes the template `name` into `folder`; the path of its scene. Nothing is replaced.
///
/// # Errors
/// No such template; one of the files is there already; what the system refuses.
pub fn make(name: &str, folder: &Path) -> Result<PathBuf, Failure> {
    let Some(template) = TEMPLATES.iter().find(|t| t.name == name) else {
        let names: Vec<&str> = TEMPLATES.iter().map(|t| t.name).collect();
        let expected = names.join(", ");
        return Err(Failure::Input(format!("new: found {name}, expected one of {expected}")));
    };
    let contents = template.contents();
    for (file, _) in &contents {
        let there = folder.join(file);
        if there.symlink_metadata().is_ok() {
            let sentence =
                format!("{}: found a file, expected a directory without files of this name", there.display());
            return Err(Failure::Input(sentence));
        }
    }
    std::fs::create_dir_all(folder)
        .map_err(|e| Failure::Input(format!("{}: found {e}, expected a directory", folder.display())))?;
    // The scene comes last: where it is, everything that it names is there.
    for (file, bytes) in &contents {
        let file = folder.join(file);
        atomic::write(&file, |out| out.write_all(bytes).map_err(WriteError::io(&file)))?;
    }
    Ok(folder.join(SCENE))
}

/// The templates, a line each.
pub fn list() -> String {
    TEMPLATES.iter().map(|t| format!("{:<18}{}\n", t.name, t.about)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_path_of_a_scene_leaves_its_folder() {
        for template in TEMPLATES {
            let contents = template.contents();
            let (name, scene) = contents.last().unwrap();
            let text = String::from_utf8(scene.clone()).unwrap();
            assert_eq!(*name, SCENE);
            let leaves = text.lines().find(|line| line.split('#').next().unwrap_or("").contains("../"));
            assert_eq!(leaves, None, "{}", template.name);
            for (file, _) in &contents[..contents.len() - 1] {
                assert!(text.contains(&format!("\"{file}\"")), "{}: {file} is not named", template.name);
            }
        }
    }
}
