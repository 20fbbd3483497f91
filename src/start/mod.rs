//! `trackbed new`: directory with a commented, runnable scene.

use std::path::{Path, PathBuf};
use trackbed_io::failure::Failure;
use trackbed_io::write::WriteError;
use trackbed_io::write::atomic;

/// Template of a scene.
pub struct Template {
    /// Name on the command line.
    pub name: &'static str,
    /// One-line description.
    pub about: &'static str,
    /// Path in `inputs/`.
    pub source: &'static str,
    text: &'static str,
    /// Files of the scene.
    files: &'static [Beside],
}

struct Beside {
    /// Name in the scene of `inputs/`.
    named: &'static str,
    bytes: &'static [u8],
}

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
    template!(
        "axle",
        "an axle along an embankment, absorbing base and ends (FEM only)",
        "solid",
        "moving_load.toml",
        []
    ),
    template!("triaxial", "drained triaxial test of clay (FEM only)", "solid", "triaxial_drained.toml", []),
    template!(
        "rock",
        "uniaxial compression of a block of bonded grains",
        "geo/rock-ucs",
        "scene.toml",
        ["rock.csv", "top.csv", "bottom.csv"]
    ),
];

/// Scene name in the new directory.
pub const SCENE: &str = "scene.toml";

impl Template {
    /// Returns file names and contents, with paths in the scene replaced by names.
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

fn name_of(path: &'static str) -> &'static str {
    path.rsplit('/').next().unwrap_or(path)
}

/// Writes template `name` into `folder` without replacing files; returns the scene's path.
///
/// # Errors
/// Unknown template, existing file; I/O errors.
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
    // The scene is last: if it exists, so do its files.
    for (file, bytes) in &contents {
        let file = folder.join(file);
        atomic::write(&file, |out| out.write_all(bytes).map_err(WriteError::io(&file)))?;
    }
    Ok(folder.join(SCENE))
}

/// Returns one line per template.
pub fn list() -> String {
    TEMPLATES.iter().map(|t| format!("{:<18}{}\n", t.name, t.about)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scene_paths_stay_in_directory() {
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
