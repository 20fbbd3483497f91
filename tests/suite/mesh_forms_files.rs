//! Truncated and changed mesh files: a valid mesh or one error.

use super::mesh_forms::{FORMS, full};
use super::support::Folder;
use std::path::{Path, PathBuf};
use trackbed::read::{MeshFile, read_mesh_file};
use trackbed::write::{MeshOptions, write_mesh_file};

fn sound(file: &MeshFile, what: &str) {
    let (nodes, elements) = (file.mesh.node_count(), file.mesh.element_count());
    assert!(file.mesh.connectivity.nodes().iter().all(|n| (*n as usize) < nodes), "{what}");
    assert!(file.constraints.iter().all(|c| (c.node as usize) < nodes && c.direction < 3), "{what}");
    assert!(file.node_sets.values().flatten().all(|n| (*n as usize) < nodes), "{what}");
    assert!(file.element_sets.values().flatten().all(|e| (*e as usize) < elements), "{what}");
    assert!(file.mesh.coordinates.as_flattened().iter().all(|x| x.is_finite()), "{what}");
}

struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % count.max(1)
    }
}

fn damage(folder: &Folder, file: &Path, read: &Path, random: &mut Random) -> usize {
    let good = std::fs::read(file).unwrap();
    let name = file.display().to_string();
    let copy = folder.join("damaged").join(file.file_name().unwrap());
    std::fs::create_dir_all(copy.parent().unwrap()).unwrap();
    let read = if read == file { copy.clone() } else { copy.parent().unwrap().to_path_buf() };
    let mut refused = 0;
    let mut try_it = |bytes: &[u8], what: &str| {
        std::fs::write(&copy, bytes).unwrap();
        match read_mesh_file(&read) {
            Ok(file) => sound(&file, &format!("{name}: {what}")),
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
        }
    };
    for cut in 0..60 {
        let at = if cut < 10 { cut * 7 } else { random.below(good.len()) }.min(good.len());
        try_it(&good[..at], &format!("cut at {at}"));
    }
    let letters = b"0123456789-+.eE,*$<>!\"= \n\r\xff/_azNDS";
    for round in 0..120 {
        let mut bytes = good.clone();
        for _ in 0..=round % 4 {
            let at = random.below(bytes.len());
            match round % 3 {
                0 => bytes[at] = letters[random.below(letters.len())],
                1 => {
                    bytes.remove(at);
                }
                _ => bytes.insert(at, letters[random.below(letters.len())]),
            }
        }
        try_it(&bytes, &format!("changed in round {round}"));
    }
    refused
}

#[test]
fn damaged_files_of_our_own() {
    let folder = Folder::new("damaged");
    let mut random = Random(17);
    for (name, msh2) in FORMS {
        let path = folder.join(name);
        write_mesh_file(&path, &full(), MeshOptions { msh2 }).unwrap();
        if path.is_dir() {
            let list = |name: &str| path.join(name);
            std::fs::create_dir_all(folder.join("damaged")).unwrap();
            for name in ["NODECOORD.DAT", "ELEMENTNUM.DAT", "DOF.DAT"] {
                std::fs::copy(list(name), folder.join("damaged").join(name)).unwrap();
            }
            for name in ["NODECOORD.DAT", "ELEMENTNUM.DAT", "DOF.DAT"] {
                assert!(damage(&folder, &list(name), &path, &mut random) > 20, "{name}");
                std::fs::copy(list(name), folder.join("damaged").join(name)).unwrap();
            }
        } else {
            assert!(damage(&folder, &path, &path, &mut random) > 40, "{name}");
        }
    }
}

#[test]
fn damaged_samples_of_other_programs() {
    let folder = Folder::new("damaged_samples");
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh");
    let mut samples: Vec<PathBuf> = std::fs::read_dir(&data).unwrap().map(|e| e.unwrap().path()).collect();
    samples.retain(|p| p.extension().is_some_and(|e| ["msh", "vtu", "vtk"].iter().any(|known| e == *known)));
    samples.sort();
    assert!(samples.len() >= 8, "{samples:?}");
    let mut random = Random(4);
    for sample in samples {
        assert!(damage(&folder, &sample, &sample, &mut random) > 20, "{}", sample.display());
    }
}

/// Files written by VTK in each encoding (tests/data/mesh/make_vtk.py).
#[test]
fn every_encoding_of_vtk() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh");
    let first = read_mesh_file(&data.join("vtk_ascii.vtu")).unwrap();
    assert_eq!(first.mesh.element_count(), 8);
    for name in [
        "vtk_binary.vtu",
        "vtk_binary_zlib.vtu",
        "vtk_appended_raw.vtu",
        "vtk_appended_raw_zlib64.vtu",
        "vtk_appended_base64.vtu",
        "vtk_appended_base64_zlib.vtu",
        "vtk_big_endian.vtu",
        "vtk_ascii.vtk",
        "vtk_binary.vtk",
        "vtk_binary42.vtk",
    ] {
        let file = read_mesh_file(&data.join(name)).unwrap();
        assert_eq!(file.mesh.connectivity, first.mesh.connectivity, "{name}");
        assert_eq!(file.mesh.materials, first.mesh.materials, "{name}");
        let near = |a: &[f64; 3], b: &[f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-9);
        let pairs = file.mesh.coordinates.iter().zip(&first.mesh.coordinates);
        assert!(
            pairs.clone().count() == first.mesh.node_count() && pairs.into_iter().all(|(a, b)| near(a, b))
        );
    }
    let lz4 = read_mesh_file(&data.join("vtk_lz4.vtu")).unwrap_err().to_string();
    assert!(lz4.contains("vtkLZ4DataCompressor, expected none or vtkZLibDataCompressor"), "{lz4}");
}
