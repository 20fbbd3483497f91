//! Node orders of every mesh format against the manuals, on curved elements.
//!
//! Natural shapes are mapped by x = R + a S², y = S + b T², z = T + c R² (R, S, T: natural coordinates plus
//! ½). Quadratic elements represent the map exactly; det J = 1 + 8abc RST gives closed-form volumes.

use super::support::Folder;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use trackbed::read::{MeshFile, read_mesh_file};
use trackbed::write::{MeshOptions, write_mesh_file};
use trackbed_fem::ElementKind;
use trackbed_fem::mesh::Mesh;

const A: [f64; 3] = [0.1, 0.12, 0.09];

pub fn curved([r, s, t]: [f64; 3], place: usize) -> [f64; 3] {
    let [r, s, t] = [r + 0.5, s + 0.5, t + 0.5];
    [r + A[0] * s * s + 4.0 * place as f64, s + A[1] * t * t, t + A[2] * r * r]
}

/// Mapped volume of a quadratic element: V + 8abc ∫RST dV.
pub fn volume(kind: ElementKind) -> f64 {
    let moment = match kind {
        ElementKind::Hex20 => 1.0,
        ElementKind::Wedge15 => 1.0 / 24.0 + 0.5 * (1.0 / 6.0 + 1.0 / 6.0) + 0.25 * 0.5,
        ElementKind::Pyramid13 => 0.25 * (1.0 / 3.0 + 2.0 / 3.0),
        ElementKind::Tet10 => 1.0 / 720.0 + 0.5 * 3.0 / 120.0 + 0.25 * 3.0 / 24.0 + 0.125 / 6.0,
        _ => panic!("the map is quadratic"),
    };
    let straight = match kind {
        ElementKind::Hex20 => 8.0,
        ElementKind::Wedge15 => 1.0,
        ElementKind::Pyramid13 => 4.0 / 3.0,
        _ => 1.0 / 6.0,
    };
    straight + 8.0 * A[0] * A[1] * A[2] * moment
}

pub const QUADRATIC: [ElementKind; 4] =
    [ElementKind::Hex20, ElementKind::Wedge15, ElementKind::Pyramid13, ElementKind::Tet10];

fn fault(mesh: &Mesh, element: usize, volume: f64) -> Option<String> {
    let (kind, nodes) = (mesh.connectivity.kind(element), &mesh.connectivity[element]);
    let x = |n: usize| mesh.coordinates[nodes[n] as usize];
    for mid in kind.corner_count()..nodes.len() {
        let distance = |[a, b]: [usize; 2]| -> f64 {
            (0..3).map(|k| (0.5 * (x(a)[k] + x(b)[k]) - x(mid)[k]).powi(2)).sum()
        };
        let edges = kind.edges();
        let near = (0..edges.len()).min_by(|a, b| distance(edges[*a]).total_cmp(&distance(edges[*b])));
        if near != Some(mid - kind.corner_count()) {
            return Some(format!("{} node {mid} lies at edge {near:?}", kind.name()));
        }
    }
    let found = mesh.element_volume(element);
    let wrong = (found / volume - 1.0).abs() > 1e-12;
    wrong.then(|| format!("{}: volume {found}, expected {volume}", kind.name()))
}

/// Correct as read, detected as wrong after any exchange of two nodes.
fn proves(mesh: &Mesh) {
    for element in 0..mesh.element_count() {
        let kind = mesh.connectivity.kind(element);
        assert_eq!(fault(mesh, element, volume(kind)), None);
        for first in 0..kind.node_count() {
            for second in 0..first {
                let mut wrong = mesh.clone();
                wrong.connectivity[element].swap(first, second);
                assert!(fault(&wrong, element, volume(kind)).is_some(), "{} {first} {second}", kind.name());
            }
        }
    }
}

/// Corner and mid-edge coordinates without duplicates; indices of the element's nodes.
fn nodes(corners: &[[f64; 3]], edges: &[[usize; 2]]) -> (Vec<[f64; 3]>, Vec<usize>) {
    let mids = edges.iter().map(|[a, b]| [0, 1, 2].map(|k| 0.5 * (corners[a - 1][k] + corners[b - 1][k])));
    let mut places: Vec<[f64; 3]> = Vec::new();
    let element = corners.iter().copied().chain(mids).map(|x| match places.iter().position(|p| *p == x) {
        Some(at) => at,
        None => {
            places.push(x);
            places.len() - 1
        }
    });
    let element = element.collect();
    (places, element)
}

/// SOLID186 edges, corners I…P as 1…8: Q = IJ, R = JK, S = KL, T = LI, U = MN, V = NO, W = OP, X = PM, Y =
/// IM, Z = JN, A = KO, B = LP (Element Reference).
const BRICK: [[usize; 2]; 12] =
    [[1, 2], [2, 3], [3, 4], [4, 1], [5, 6], [6, 7], [7, 8], [8, 5], [1, 5], [2, 6], [3, 7], [4, 8]];

/// Corners I…P of each kind as a degenerate brick.
fn folded(kind: ElementKind) -> [[f64; 3]; 8] {
    let square = |t: f64| [[-1.0, -1.0, t], [1.0, -1.0, t], [1.0, 1.0, t], [-1.0, 1.0, t]];
    let triangle = |t: f64| [[0.0, 0.0, t], [1.0, 0.0, t], [0.0, 1.0, t], [0.0, 1.0, t]];
    let both =
        |a: [[f64; 3]; 4], b: [[f64; 3]; 4]| std::array::from_fn(|i| if i < 4 { a[i] } else { b[i - 4] });
    let apex = [[0.0, 0.0, 1.0]; 4];
    match kind {
        ElementKind::Hex20 => both(square(-1.0), square(1.0)),
        ElementKind::Wedge15 => both(triangle(-1.0), triangle(1.0)),
        ElementKind::Pyramid13 => both(square(0.0), apex),
        _ => both(triangle(0.0), apex),
    }
}

#[test]
fn ansys_bricks_folded_by_their_letters() {
    let folder = Folder::new("order_ansys");
    for form in ["cdb", "lists"] {
        let (mut node_rows, mut elements) = (String::new(), String::new());
        let mut count = 0;
        for (place, kind) in QUADRATIC.into_iter().enumerate() {
            let (places, element) = nodes(&folded(kind), &BRICK);
            for (n, natural) in places.iter().enumerate() {
                let [x, y, z] = curved(*natural, place);
                let id = count + n + 1;
                let row = match form {
                    "cdb" => format!("{id:9}{:9}{:9}{x:25.16e}{y:25.16e}{z:25.16e}", 0, 0),
                    _ => format!("{id} {x:?} {y:?} {z:?}"),
                };
                writeln!(node_rows, "{row}").unwrap();
            }
            let ids: Vec<usize> = element.iter().map(|n| count + n + 1).collect();
            let id = 10 + place;
            if form == "cdb" {
                let head = [1, 1, 1, 1, 0, 0, 0, 0, 20, 0, id];
                let fixed = |ids: &[usize]| ids.iter().map(|i| format!("{i:9}")).collect::<String>();
                writeln!(elements, "{}{}\n{}", fixed(&head), fixed(&ids[..8]), fixed(&ids[8..])).unwrap();
            } else {
                let text = ids.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
                writeln!(elements, "{id} 1 {text}").unwrap();
            }
            count += places.len();
        }
        let path = if form == "cdb" {
            let text = format!(
                "/PREP7\nET,1,186\nNBLOCK,6,SOLID,{count},{count}\n(3i9,3e25.16)\n{node_rows}N,R5.3,LOC,-1,\n\
                 EBLOCK,19,SOLID,14,4\n(19i9)\n{elements}       -1\n"
            );
            folder.write("mesh.cdb", &text)
        } else {
            folder.write("lists/NODECOORD.DAT", &node_rows);
            folder.write("lists/ELEMENTNUM.DAT", &elements);
            folder.join("lists")
        };
        let file = read_mesh_file(&path).unwrap();
        assert_eq!(file.mesh.connectivity.kinds(), QUADRATIC);
        proves(&file.mesh);
    }
}

/// Abaqus element types and mid-side edges (Analysis User's Guide, "Node ordering").
#[test]
fn abaqus_elements_by_their_edges() {
    let wedge = [[1, 2], [2, 3], [3, 1], [4, 5], [5, 6], [6, 4], [1, 4], [2, 5], [3, 6]];
    let tet = [[1, 2], [2, 3], [3, 1], [1, 4], [2, 4], [3, 4]];
    let (mut node_rows, mut elements) = (String::from("*NODE\n"), String::new());
    let mut count = 0;
    let cases: [(&str, ElementKind, &[[usize; 2]]); 3] = [
        ("C3D20R", ElementKind::Hex20, &BRICK),
        ("C3D15", ElementKind::Wedge15, &wedge),
        ("C3D10", ElementKind::Tet10, &tet),
    ];
    for (place, (name, kind, edges)) in cases.into_iter().enumerate() {
        let corners = match kind {
            ElementKind::Hex20 => folded(kind).to_vec(),
            ElementKind::Wedge15 => [0, 1, 2, 4, 5, 6].map(|c| folded(kind)[c]).to_vec(),
            _ => [0, 1, 2, 4].map(|c| folded(kind)[c]).to_vec(),
        };
        let (places, element) = nodes(&corners, edges);
        for (n, natural) in places.iter().enumerate() {
            let [x, y, z] = curved(*natural, place);
            writeln!(node_rows, "{}, {x:?}, {y:?}, {z:?}", count + n + 1).unwrap();
        }
        let ids: Vec<String> = element.iter().map(|n| (count + n + 1).to_string()).collect();
        let rows: Vec<String> = ids.chunks(11).map(|row| row.join(", ")).collect();
        writeln!(elements, "*ELEMENT, TYPE={name}\n{}, {}", place + 1, rows.join(",\n")).unwrap();
        count += places.len();
    }
    let folder = Folder::new("order_abaqus");
    let path = folder.write("mesh.inp", &format!("{node_rows}{elements}"));
    let file = read_mesh_file(&path).unwrap();
    assert_eq!(file.element_types[0], ("C3D20R hex20".to_string(), 1));
    proves(&file.mesh);
}

pub fn all_kinds() -> Mesh {
    let mut mesh = Mesh::default();
    for (place, kind) in ElementKind::ALL.into_iter().enumerate() {
        let first = mesh.node_count() as u32;
        for natural in kind.natural() {
            mesh.node_ids.push(5000 - 7 * mesh.node_count() as u32);
            mesh.coordinates.push(curved(*natural, place));
        }
        let nodes: Vec<u32> = (first..mesh.node_count() as u32).collect();
        mesh.push_element(300 - place as u32, 1 + (place % 3) as u32, kind, &nodes);
    }
    mesh
}

/// Gmsh files with volumes by Gmsh's shape functions (tests/data/mesh/make_gmsh.py).
#[test]
fn gmsh_volumes_match_gmsh() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh");
    let volumes: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(data.join("gmsh_volumes.json")).unwrap()).unwrap();
    for order in ["order1", "order2"] {
        let mut first: Option<Vec<(ElementKind, Vec<u32>)>> = None;
        for name in ["gmsh2_ORDER.msh", "gmsh4_ORDER.msh", "gmsh2_ORDER_binary.msh", "gmsh4_ORDER_binary.msh"]
        {
            let file = read_mesh_file(&data.join(name.replace("ORDER", order))).unwrap();
            let mesh = &file.mesh;
            // Gmsh renumbers elements on saving: compared by kind, sorted.
            for kind in ElementKind::ALL {
                let of_kind = || (0..mesh.element_count()).filter(|e| mesh.connectivity.kind(*e) == kind);
                let mut found: Vec<f64> = of_kind().map(|e| mesh.element_volume(e)).collect();
                found.sort_by(f64::total_cmp);
                let expected = volumes[order][kind.name()].as_array().map_or(&[][..], Vec::as_slice);
                assert_eq!(found.len(), expected.len(), "{name}: {}", kind.name());
                for (found, expected) in found.iter().zip(expected) {
                    let expected = expected.as_f64().unwrap();
                    let close = (found / expected - 1.0).abs() < 1e-9;
                    assert!(close, "{name}: {} of {found}, Gmsh {expected}", kind.name());
                }
                assert_eq!(of_kind().find_map(|e| own_edges(mesh, e)), None, "{name}");
            }
            let counts =
                ElementKind::ALL.map(|kind| mesh.connectivity.kinds().iter().filter(|k| **k == kind).count());
            let expected =
                if order == "order1" { [0, 0, 0, 0, 4, 14, 4, 27] } else { [4, 14, 4, 27, 0, 0, 0, 0] };
            assert_eq!(counts, expected);
            assert_eq!(mesh.materials.iter().filter(|m| **m == 7).count(), 4);
            assert_eq!(mesh.materials.iter().filter(|m| **m == 4).count(), 14);
            let sets: Vec<&String> = file.element_sets.keys().collect();
            assert_eq!(sets, ["ballast bed", "wing"]);
            assert_eq!(file.element_sets["ballast bed"].len(), 4);
            let sets: Vec<(&str, usize)> =
                file.node_sets.iter().map(|(name, set)| (name.as_str(), set.len())).collect();
            let on_face = if order == "order1" { [9, 6] } else { [21, 13] };
            assert_eq!(sets, [("apex", 1), ("base", on_face[0]), ("physical_surface_12", on_face[1])]);
            // Element order depends on the format.
            let mut elements: Vec<(ElementKind, Vec<u32>)> = (0..mesh.element_count())
                .map(|e| (mesh.connectivity.kind(e), mesh.connectivity[e].to_vec()))
                .collect();
            elements.sort();
            match &first {
                None => first = Some(elements),
                Some(first) => assert!(*first == elements, "{name}"),
            }
        }
    }
}

fn own_edges(mesh: &Mesh, element: usize) -> Option<String> {
    fault(mesh, element, mesh.element_volume(element))
}

#[test]
fn exchanged_gmsh_nodes_are_detected() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/mesh");
    let mesh = read_mesh_file(&data.join("gmsh4_order2.msh")).unwrap().mesh;
    for kind in QUADRATIC {
        let element = mesh.connectivity.kinds().iter().position(|k| *k == kind).unwrap();
        for first in kind.corner_count()..kind.node_count() {
            for second in kind.corner_count()..first {
                let mut wrong = mesh.clone();
                wrong.connectivity[element].swap(first, second);
                assert!(own_edges(&wrong, element).is_some(), "{} {first} {second}", kind.name());
            }
        }
    }
}

/// Needs `ccx`; no pyramids. Its integration is exact for the cubic determinant except C3D10 (4 points,
/// degree 2): 1e-3.
#[test]
fn calculix_reads_what_is_written() {
    let ccx = std::env::var_os("TRACKBED_CCX").map_or_else(|| PathBuf::from("ccx"), PathBuf::from);
    if Command::new(&ccx).arg("-v").output().is_err() {
        eprintln!("skipped: there is no ccx");
        return;
    }
    let kinds = ElementKind::ALL.into_iter().filter(|k| k.linear() != ElementKind::Pyramid5);
    let mut mesh = Mesh::default();
    let whole = all_kinds();
    for (e, kind) in ElementKind::ALL.into_iter().enumerate().filter(|(_, k)| kinds.clone().any(|n| n == *k))
    {
        let first = mesh.node_count() as u32;
        for node in &whole.connectivity[e] {
            mesh.node_ids.push(mesh.node_count() as u32 + 1);
            mesh.coordinates.push(whole.coordinates[*node as usize]);
        }
        let nodes: Vec<u32> = (first..mesh.node_count() as u32).collect();
        mesh.push_element(e as u32 + 1, 1, kind, &nodes);
    }
    let materials =
        [(1, trackbed::read::FileMaterial { young: 2.1e11, poisson: 0.3, density: Some(7800.0) })].into();
    let constraints = (0..mesh.node_count() as u32)
        .flat_map(|node| (0..3).map(move |direction| (node, direction)))
        .map(|(node, direction)| trackbed_fem::mesh::Constraint { node, direction, value: 0.0 })
        .collect();
    let file = MeshFile { mesh, materials, constraints, ..MeshFile::default() };
    let folder = Folder::new("ccx");
    let path = folder.join("job.inp");
    write_mesh_file(&path, &file, MeshOptions::default()).unwrap();
    let mut text = std::fs::read_to_string(&path).unwrap();
    text += "*STEP\n*STATIC\n*DLOAD\nMATERIAL_1, GRAV, 9.81, 0., 0., -1.\n*EL PRINT, ELSET=MATERIAL_1\nEVOL\n*END STEP\n";
    std::fs::write(&path, text).unwrap();
    let output = Command::new(&ccx).arg("job").current_dir(folder.path()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    let dat = std::fs::read_to_string(folder.join("job.dat")).unwrap_or_else(|_| panic!("{said}"));
    let rows: Vec<(usize, f64)> = dat
        .lines()
        .filter_map(|line| {
            let mut words = line.split_whitespace();
            Some((words.next()?.parse().ok()?, words.next()?.parse().ok()?))
        })
        .collect();
    assert_eq!(rows.len(), file.mesh.element_count(), "{dat}\n{said}");
    for (id, found) in rows {
        let element = file.mesh.element_ids.iter().position(|e| *e as usize == id).unwrap();
        let kind = file.mesh.connectivity.kind(element);
        let expected = file.mesh.element_volume(element);
        let tolerance = if kind == ElementKind::Tet10 { 1e-3 } else { 2e-6 };
        assert!((found / expected - 1.0).abs() < tolerance, "{}: ccx {found}, {expected}", kind.name());
    }
}

#[test]
fn vtk_reads_what_is_written() {
    let named = std::env::var_os("TRACKBED_PYTHON");
    let python = named.clone().map_or_else(|| PathBuf::from("python3"), PathBuf::from);
    let probe = Command::new(&python).args(["-c", "import vtkmodules.vtkIOXML"]).output();
    if named.is_none() && !probe.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: python3 has no package vtk, and TRACKBED_PYTHON is not set");
        return;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/vtk_check.py");
    let folder = Folder::new("order_vtk");
    let check = |mesh: &Mesh, volume: f64, name: &str| {
        let file = MeshFile { mesh: mesh.clone(), ..MeshFile::default() };
        let path = folder.join(name);
        write_mesh_file(&path, &file, MeshOptions::default()).unwrap();
        let arguments = ["--volume".to_string(), format!("{volume:?}"), path.display().to_string()];
        let output = Command::new(&python).arg(&script).args(arguments).output().unwrap();
        (output.status.success(), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let mesh = all_kinds();
    let total: f64 = (0..8).map(|e| mesh.element_volume(e)).sum();
    let closed: f64 = QUADRATIC.into_iter().map(volume).sum();
    let quadratic: f64 = (0..4).map(|e| mesh.element_volume(e)).sum();
    assert!((quadratic / closed - 1.0).abs() < 1e-12);
    for name in ["mesh.vtu", "mesh.vtk"] {
        let (good, text) = check(&mesh, total, name);
        assert!(good, "{text}");
    }
    for element in 0..4 {
        let mut wrong = mesh.clone();
        let corners = mesh.connectivity.kind(element).corner_count();
        wrong.connectivity[element][corners..].rotate_left(1);
        let (good, text) = check(&wrong, total, "wrong.vtu");
        assert!(!good, "{text}");
    }
    // A wedge with its first triangle facing outwards is inverted for VTK.
    let mut wrong = mesh.clone();
    wrong.connectivity[5].swap(1, 2);
    wrong.connectivity[5].swap(4, 5);
    let (good, text) = check(&wrong, total, "wrong.vtu");
    assert!(!good && text.contains("turned inside out"), "{text}");
}
