//! Writer of meshes in all formats of `read::read_mesh_file`.

use std::collections::BTreeMap;
use std::path::Path;

use crate::read::MeshFile;

use super::error::{WriteError, check_field};
use super::{abaqus, ansys_lists, cdb, gmsh, vtk_legacy, vtu};

/// Format options.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshOptions {
    /// `.msh` in format 2.2 instead of 4.1.
    pub msh2: bool,
}

/// Writes a mesh, with its format given by the extension of `path`; without one, a directory with the ANSYS
/// lists. Returns content lost in the format, one sentence each.
///
/// | format | constraints | sets | face sets | elastic constants |
/// |---|---|---|---|---|
/// | `.cdb` | yes | yes | as node sets | yes |
/// | `.inp` | yes | yes | yes | yes |
/// | `.msh` | no | yes | yes | no |
/// | `.vtu`, `.vtk` | yes | yes | yes | no |
/// | lists | yes | no | no | no |
///
/// # Errors
/// Unknown extensions, non-finite numbers, node id 0 if reserved by the format; I/O errors.
pub fn write_mesh_file(
    path: &Path,
    file: &MeshFile,
    options: MeshOptions,
) -> Result<Vec<String>, WriteError> {
    let nodes = file.mesh.node_count();
    check_field(path, "coordinates", file.mesh.coordinates.as_flattened(), 3, nodes)?;
    let values: Vec<f64> = file.constraints.iter().map(|c| c.value).collect();
    check_field(path, "values of constraints", &values, 1, values.len())?;
    let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let (mut lost, [constraints, sets, faces, materials]) = match ending.as_str() {
        "cdb" => (cdb::write_cdb(path, file)?, [true, true, false, true]),
        "inp" => (abaqus::write_inp(path, file)?, [true, true, true, true]),
        "msh" => (gmsh::write_gmsh(path, file, options.msh2)?, [false, true, true, false]),
        "vtu" => {
            vtu::write_mesh_file(path, file)?;
            (Vec::new(), [true, true, true, false])
        }
        "vtk" => {
            vtk_legacy::write_vtk(path, file)?;
            (Vec::new(), [true, true, true, false])
        }
        "" => {
            no_zero(path, file)?;
            std::fs::create_dir_all(path).map_err(WriteError::io(path))?;
            ansys_lists::write_lists(&file.mesh, &file.constraints, path)?;
            (Vec::new(), [true, false, false, false])
        }
        _ => {
            let expected = ".cdb, .msh, .inp, .vtu, .vtk, or no extension for a directory of lists";
            return Err(WriteError::format(
                path,
                format!("file extension: found \".{ending}\", expected {expected}"),
            ));
        }
    };
    let count = file.node_sets.len() + file.element_sets.len();
    for (held, what, count) in [
        (constraints, "constraints", file.constraints.len()),
        (sets, "sets", count),
        (faces, "sets of faces", file.face_sets.len()),
        (materials, "materials with elastic constants", file.materials.len()),
    ] {
        if !held && count > 0 {
            let left = if what == "sets of faces" && sets { "become sets of nodes" } else { "are left out" };
            lost.push(format!("this format contains no {what}: {count} {left}"));
        }
    }
    Ok(lost)
}

pub(super) fn no_zero(path: &Path, file: &MeshFile) -> Result<(), WriteError> {
    if file.mesh.node_ids.contains(&0) {
        return Err(WriteError::format(
            path,
            "a node has number 0, which this format reserves for missing nodes",
        ));
    }
    Ok(())
}

/// Number as `1.2345678901234567E+002`: 17 digits read back exactly.
pub(super) fn fortran(value: f64) -> String {
    let text = format!("{value:.16E}");
    let (mantissa, exponent) = text.split_once('E').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{mantissa}E{sign}{:03}", exponent.abs())
}

/// Valid set names: `_`, a leading `S`, truncation, then suffixes; no `reserved` ones. Changes are listed in
/// `lost`.
pub(super) fn plain_names<'a, T>(
    sets: &'a BTreeMap<String, Vec<T>>,
    reserved: &[String],
    most: usize,
    lost: &mut Vec<String>,
) -> Vec<(String, &'a [T])> {
    let mut used: Vec<String> = reserved.to_vec();
    sets.iter()
        .map(|(name, members)| {
            let fits = |c: char| if c.is_ascii_alphanumeric() || c == '_' { c } else { '_' };
            let mut plain: String = name.chars().map(fits).collect();
            if !plain.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
                plain.insert(0, 'S');
            }
            plain.truncate(most);
            let base = plain.clone();
            let mut number = 2;
            while used.iter().any(|t| t.eq_ignore_ascii_case(&plain)) {
                let end = format!("_{number}");
                plain = base[..base.len().min(most - end.len())].to_string() + &end;
                number += 1;
            }
            if plain != *name {
                lost.push(format!("set \"{name}\" is called {plain} in the file"));
            }
            used.push(plain.clone());
            (plain, members.as_slice())
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_bits() {
        for value in [0.0, -1.0, 0.1, 1e300, -5e-324, f64::MAX, 1.0 / 3.0] {
            let text = fortran(value);
            assert_eq!(text.replace('E', "e").parse::<f64>().unwrap().to_bits(), value.to_bits(), "{text}");
            assert!(text.len() <= 24, "{text}");
        }
        assert_eq!(fortran(-123.0), "-1.2300000000000000E+002");
    }

    #[test]
    fn names_are_made_plain_and_distinct() {
        let sets: BTreeMap<String, Vec<u32>> =
            ["a b", "a_b", "1st", "Ä", "A_B", "x"].map(|n| (n.to_string(), vec![])).into();
        let mut lost = Vec::new();
        let names: Vec<String> =
            plain_names(&sets, &["X".into()], 5, &mut lost).into_iter().map(|n| n.0).collect();
        assert_eq!(names, ["S1st", "A_B", "a_b_2", "a_b_3", "x_2", "_"]);
        assert_eq!(lost.len(), 5);
    }
}
