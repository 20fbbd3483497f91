//! Checks written files with VTK itself: `tests/vtk_check.py`.
//!
//! Needs Python with package `vtk`: `TRACKBED_PYTHON` makes the test mandatory, otherwise it is skipped
//! without VTK.

use super::choice::Choice;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use trackbed_fem::mesh::{Constraint, Mesh};

use super::pvd::Series;
use super::{ChainFrame, GrainFrame, Values, WallFrame, sample, vtp, vtu};
use crate::mesh_tools;
use crate::read::MeshFile;

pub(super) fn python() -> Option<PathBuf> {
    if let Some(given) = std::env::var_os("TRACKBED_PYTHON") {
        return Some(given.into());
    }
    let has_vtk = Command::new("python3").args(["-c", "import vtkmodules.vtkIOXML"]).output();
    match has_vtk {
        Ok(output) if output.status.success() => Some("python3".into()),
        _ => {
            eprintln!("skipped: python3 has no package vtk, and TRACKBED_PYTHON is not set");
            None
        }
    }
}

fn check(python: &Path, arguments: &[String]) -> Output {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/vtk_check.py");
    Command::new(python).arg(script).args(arguments).output().expect("the interpreter starts")
}

fn passes(python: &Path, arguments: &[String]) {
    let output = check(python, arguments);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{text}\n{}", String::from_utf8_lossy(&output.stderr));
}

fn fails(python: &Path, arguments: &[String], with: &str) {
    let output = check(python, arguments);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(!output.status.success() && text.contains(with), "{text}");
}

fn write_solid(file: &Path, mesh: &Mesh) {
    let n = mesh.node_count();
    let vector: Vec<f64> = mesh.coordinates.iter().flat_map(|[x, y, z]| [y * z, x - z, x * y]).collect();
    let stress: Vec<[f64; 6]> =
        mesh.coordinates.iter().map(|[x, y, z]| [*x, *y, *z, 1.0, 2.0, 3.0]).collect();
    let scalar: Vec<f64> = (0..n).map(|i| i as f64).collect();
    let frame = sample::solid(mesh, &vector, &stress, &scalar);
    vtu::write_solid(file, &frame, Choice::default()).unwrap();
}

fn grains(count: usize) -> GrainFrame {
    sample::grains(count, |i| [i as f64, libm::sin(i as f64), -0.5])
}

fn chains(count: usize) -> ChainFrame {
    ChainFrame {
        ends: (0..count).map(|i| [[i as f64, 0.0, 0.0], [i as f64, 1.0, 0.5]]).collect(),
        normal_force: (0..count).map(|i| i as f64).collect(),
        tangential_force: vec![0.1; count],
        kind: vec![0; count],
        strong: vec![1; count],
        partners: vec![[0, 1]; count],
    }
}

#[test]
fn vtk_reads_run_with_same_volume() {
    let Some(python) = python() else { return };
    let dir = sample::folder("oracle_run");
    let path = |name: &str| dir.join(name);
    let mesh = sample::block([3, 2, 3]);
    let info = mesh_tools::info(&mesh, &[]);
    let mut series = Series::new(&path("results.pvd"));
    // No contacts in the first frame; last arrays of whole 32768-byte blocks.
    for (frame, (grain_count, chain_count)) in
        [(1, 0), (100, 3), (4096, 4096), (8192, 2048)].into_iter().enumerate()
    {
        let time = 0.25 * frame as f64;
        let name = |kind: &str, ending: &str| format!("{kind}_{frame}.{ending}");
        write_solid(&path(&name("solid", "vtu")), &mesh);
        vtp::write_grains(&path(&name("grains", "vtp")), &grains(grain_count), Choice::default()).unwrap();
        vtp::write_chains(&path(&name("chains", "vtp")), &chains(chain_count)).unwrap();
        let walls = WallFrame {
            points: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            polygons: vec![vec![0, 1, 2, 3], vec![0, 1, 4]],
            id: vec![0, 1],
            kind: vec![0, 2],
            grains: vec![
                ("velocity", Values::Vectors(vec![[0.0; 3], [1.0, 2.0, 3.0]])),
                ("part", Values::Counts(vec![0, 7])),
            ],
        };
        vtp::write_walls(&path(&name("walls", "vtp")), &walls, Choice::default()).unwrap();
        for (part, kind, ending) in
            [(0, "solid", "vtu"), (1, "grains", "vtp"), (2, "chains", "vtp"), (3, "walls", "vtp")]
        {
            series.push(time, part, kind, &name(kind, ending));
        }
    }
    series.write().unwrap();
    let constraint = Constraint { node: 3, direction: 1, value: 0.0 };
    let content = MeshFile { mesh: mesh.clone(), constraints: vec![constraint], ..Default::default() };
    vtu::write_mesh_file(&path("mesh.vtu"), &content).unwrap();
    let all = [path("results.pvd").display().to_string(), path("mesh.vtu").display().to_string()];
    let volume = ["--volume".to_string(), info.volume.to_string()];
    passes(&python, &[&all[..], &volume[..]].concat());

    // The check must fail for wrong volume, node order, array and file.
    let wrong = ["--volume".to_string(), (info.volume * (1.0 + 1e-8)).to_string()];
    fails(&python, &[&all[1..], &wrong[..]].concat(), "expected");
    let mut turned = mesh.clone();
    for element in 0..turned.element_count() {
        turned.connectivity[element][12..20].rotate_left(4);
    }
    write_solid(&path("turned.vtu"), &turned);
    fails(&python, &[path("turned.vtu").display().to_string()], "turned inside out");
    let text = std::fs::read_to_string(path("solid_0.vtu")).unwrap();
    std::fs::write(path("renamed.vtu"), text.replace("\"von_mises\"", "\"mises\"")).unwrap();
    fails(&python, &[path("renamed.vtu").display().to_string()], "no point array von_mises");
    std::fs::remove_file(path("grains_2.vtp")).unwrap();
    fails(&python, &all[..1], "no such file");
    std::fs::remove_dir_all(&dir).unwrap();
}
