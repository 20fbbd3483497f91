//! Mesh formats: round trips, real archives, rejected input, `mesh` commands.

use super::mesh_orders::all_kinds;
use super::support::{Folder, trackbed};
use std::path::{Path, PathBuf};
use trackbed::read::{FileMaterial, MeshFile, read_mesh_file};
use trackbed::write::{MeshOptions, write_mesh_file};
use trackbed_fem::ElementKind;
use trackbed_fem::mesh::Constraint;

/// All element kinds and all contents.
pub fn full() -> MeshFile {
    let mesh = all_kinds();
    let constraint = |node, direction, value| Constraint { node, direction, value };
    MeshFile {
        constraints: vec![
            constraint(0, 0, 0.0),
            constraint(3, 1, -1.25e-3),
            constraint(3, 2, 0.1),
            constraint(70, 2, 0.0),
        ],
        node_sets: [("base", vec![0, 1, 2, 3, 40]), ("top", vec![5, 80])]
            .map(|(n, s)| (n.to_string(), s))
            .into(),
        element_sets: [("bed", vec![0, 3, 5]), ("rest", vec![6])].map(|(n, s)| (n.to_string(), s)).into(),
        materials: [
            (1, FileMaterial { young: 2.1e11, poisson: 0.3, density: Some(7850.0) }),
            (2, FileMaterial { young: 1.0 / 3.0 * 1e8, poisson: 0.25, density: None }),
        ]
        .into(),
        mesh,
        ..MeshFile::default()
    }
}

pub const FORMS: [(&str, bool); 7] = [
    ("mesh.cdb", false),
    ("mesh.inp", false),
    ("mesh.msh", false),
    ("mesh2.msh", true),
    ("mesh.vtu", false),
    ("mesh.vtk", false),
    ("lists", false),
];

/// Order of VTK arrays: by node.
fn sorted(mut constraints: Vec<Constraint>) -> Vec<(u32, u8, f64)> {
    constraints.sort_by_key(|c| (c.node, c.direction));
    constraints.iter().map(|c| (c.node, c.direction, c.value)).collect()
}

#[test]
fn every_format_round_trips() {
    let folder = Folder::new("forms");
    let file = full();
    for (name, msh2) in FORMS {
        let path = folder.join(name);
        let lost = write_mesh_file(&path, &file, MeshOptions { msh2 }).unwrap();
        let back = read_mesh_file(&path).unwrap();
        assert_eq!(back.mesh, file.mesh, "{name}");
        let (msh, lists) = (name.ends_with("msh"), name == "lists");
        if msh {
            assert!(
                back.constraints.is_empty() && lost.iter().any(|l| l.contains("4 are left out")),
                "{lost:?}"
            );
        } else {
            assert_eq!(sorted(back.constraints), sorted(file.constraints.clone()), "{name}");
        }
        if lists {
            assert!(back.node_sets.is_empty() && lost.iter().any(|l| l.contains("no sets")), "{lost:?}");
        } else {
            assert_eq!(
                (&back.node_sets, &back.element_sets),
                (&file.node_sets, &file.element_sets),
                "{name}"
            );
        }
        if name.ends_with("cdb") || name.ends_with("inp") {
            assert_eq!(back.materials, file.materials, "{name}");
        } else {
            assert!(lost.iter().any(|l| l.contains("elastic constants")), "{name}: {lost:?}");
        }
        assert_eq!(back.element_types.iter().map(|t| t.1).sum::<usize>(), 8);
        assert_eq!(back.warnings, Vec::<String>::new(), "{name}");
    }
}

/// Archives by ANSYS; counts of mapdl-archive 0.4.2 (see their README).
#[test]
fn archives_that_ansys_wrote() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let data = std::env::var_os("TRACKBED_ANSYS_DATA")
        .map_or_else(|| root.join("../shared/data/ansys"), PathBuf::from);
    if !data.join("sector.cdb").exists() {
        eprintln!("skipped: no archives in {}", data.display());
        return;
    }
    type Types = [(&'static str, usize)];
    let cases: [(&str, usize, &Types); 3] = [
        ("sector.cdb", 655, &[("SOLID185 hex8", 101), ("SOLID185 wedge6", 4)]),
        ("TetBeam.cdb", 1041, &[("SOLID187 tet4", 3913)]),
        ("academic_rotor.cdb", 786, &[("SOLID185 hex8", 524)]),
    ];
    for (name, nodes, types) in cases {
        let file = read_mesh_file(&data.join(name)).unwrap();
        let mut found: Vec<(&str, usize)> =
            file.element_types.iter().map(|(name, count)| (name.as_str(), *count)).collect();
        found.sort_unstable();
        // Nodes of lines and surfaces meshed first are unused.
        let unused = file.warnings.iter().find_map(|w| {
            let (_, rest) = w.split_once(".cdb: ")?;
            rest.split_once(" nodes belong to no element")?.0.parse::<usize>().ok()
        });
        let all = file.mesh.node_count() + unused.unwrap_or(0);
        assert_eq!((all, &found[..]), (nodes, types), "{name} {:?}", file.warnings);
        for element in 0..file.mesh.element_count() {
            assert!(file.mesh.element_volume(element) > 0.0, "{name} {element}");
        }
        if name == "sector.cdb" {
            // 384 395-396 438-446 503-515, if used.
            let refine: Vec<u32> =
                file.node_sets["REFINE"].iter().map(|n| file.mesh.node_ids[*n as usize]).collect();
            let ranges = [384..=384, 395..=396, 438..=446, 503..=515];
            let expected: Vec<u32> =
                ranges.into_iter().flatten().filter(|id| file.mesh.node_ids.contains(id)).collect();
            assert_eq!(refine, expected);
        }
    }
}

const HEX: &str = "        1        2        3        4        5        6        7        8";

fn archive(body: &str) -> String {
    let mut nodes = String::from("NBLOCK,6,SOLID,12,12\r\n(3i9,6e21.13e3)\r\n");
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    for id in 1..=12_usize {
        let ([x, y], z) = (square[(id - 1) % 4], ((id - 1) / 4) as f64);
        // Without trailing zeros, like ANSYS.
        let all = [x, y, z].map(|v| format!("{v:21.13e}"));
        let kept = if z != 0.0 {
            3
        } else if y != 0.0 {
            2
        } else if x != 0.0 {
            1
        } else {
            0
        };
        nodes += &format!("{id:9}{:9}{:9}{}\r\n", 0, 0, all[..kept].concat());
    }
    format!("{body}\r\n{nodes}N,R5.3,LOC,       -1,\r\n/GO\r\n")
}

fn solid(id: u32, type_number: u32, nodes: &str) -> String {
    let head: String = [1, type_number, 1, 1, 0, 0, 0, 0, 8, 0, id].map(|n| format!("{n:9}")).concat();
    format!("{head}{nodes}\r\n")
}

fn cdb(folder: &Folder, text: &str) -> Result<MeshFile, String> {
    read_mesh_file(&folder.write("mesh.cdb", text)).map_err(|e| e.to_string())
}

#[test]
fn archives_with_compact_blocks_and_components() {
    let folder = Folder::new("cdb");
    let body = format!(
        "! elements before nodes\r\nEBLOCK,19,SOLID,1,1\r\n(19i9)\r\n{}       -1\r\nEBLOCK,10,,,1\r\n(15i9)\r\n\
         {:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}\r\n{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}{:9}\r\n       -1\r\n\
         CMBLOCK,LOW     ,NODE,       4  ! users node component definition\r\n(8i10)\r\n\
         {:10}{:10}{:10}{:10}\r\nCMBLOCK,BOTH,ELEM,2\r\n(8i10)\r\n{:10}{:10}\r\n\
         ET,1,185\r\nETBLOCK,2,2\r\n(2i9,19a9)\r\n{:9}{:9}{:9}\r\n{:9}{:9}{:9}\r\n       -1\r\n\
         D,LOW,UZ,0.5\r\nD,1,UX,,,4,3\r\nD,5,ALL\r\nD,6,UX,0,,,,UY\r\nD,7,TEMP,20\r\n\
         MPDATA,R5.0, 1,EX  ,     1, 1,  200000000.000    ,\r\nMP,PRXY,1,0.3\r\nmpdata,DENS,1,1,1800.\r\nF,5,FX,1.0",
        solid(7, 1, HEX),
        8,
        2,
        1,
        3,
        0,
        5,
        6,
        7,
        8,
        9,
        10,
        11,
        12,
        9,
        3,
        1,
        3,
        0,
        1,
        2,
        3,
        4,
        1,
        -4,
        11,
        -12,
        7,
        -9,
        2,
        185,
        0,
        3,
        170,
        0,
    );
    let file = cdb(&folder, &archive(&body)).unwrap();
    assert_eq!(file.mesh.element_ids, [7, 8]);
    assert_eq!(file.mesh.materials, [1, 3]);
    assert_eq!((0..2).map(|e| file.mesh.element_volume(e)).map(|v| (v * 1e9).round()).sum::<f64>(), 2e9);
    assert_eq!(file.node_sets["LOW"], [0, 1, 2, 3, 10, 11]);
    assert_eq!(file.element_sets["BOTH"], [0, 1]);
    let constraints: Vec<(u32, u8, f64)> =
        file.constraints.iter().map(|c| (c.node, c.direction, c.value)).collect();
    let mut expected: Vec<(u32, u8, f64)> = [0, 1, 2, 3, 10, 11].map(|n| (n, 2, 0.5)).to_vec();
    expected.extend([
        (0, 0, 0.0),
        (3, 0, 0.0),
        (4, 0, 0.0),
        (4, 1, 0.0),
        (4, 2, 0.0),
        (5, 0, 0.0),
        (5, 1, 0.0),
    ]);
    assert_eq!(constraints, expected);
    let constants = FileMaterial { young: 2e8, poisson: 0.3, density: Some(1800.0) };
    assert_eq!(file.materials, [(1, constants)].into());
    let warnings = file.warnings.join("\n");
    for part in
        ["1 elements of type TARGE170 are left out", "D of TEMP", "F (1)", "1 elements that were left out"]
    {
        assert!(warnings.contains(part), "{part} is missing in {warnings}");
    }
}

#[test]
fn damaged_archives_are_refused_by_name() {
    let folder = Folder::new("cdb_bad");
    let good = format!("ET,1,185\r\nEBLOCK,19,SOLID,1,1\r\n(19i9)\r\n{}       -1", solid(7, 1, HEX));
    assert!(cdb(&folder, &archive(&good)).is_ok());
    let turned = archive(&format!("{good}\r\nD,8,UX"))
        .replace("e0\r\n        9", &format!("e0{:21.13e}\r\n        9", 30.0));
    for (text, part) in [
        (archive(&good.replace("ET,1,185", "ET,1,70")), "element 7: found type 70"),
        (archive(&good.replace("ET,1,185", "")), "type number 1, expected a type that an ET command defines"),
        (archive(&good.replace("       8\r\n", "      88\r\n")), "element 7: found node 88"),
        (archive(&good.replace("       2        3", "       3        3")), "node 3 more than once"),
        (archive(&good.replace("       -1", "")), "mesh.cdb:5: element: found 0 numbers"),
        (archive(&format!("{good}\r\nD,99,UX")), "node 99"),
        (archive(&format!("{good}\r\nD,NONE,UX")), "\"NONE\""),
        (archive(&format!("{good}\r\nD,9,UX,1\r\nD,9,UX,2")), "2 after 1 on line"),
        (archive(&format!("{good}\r\nE,1,2,3")), "CDWRITE without UNBLOCKED"),
        (archive("ET,1,185"), "no volume element"),
        (turned, "constraint of node 8: found a node in a rotated coordinate system"),
    ] {
        let error = cdb(&folder, &text).expect_err(part);
        assert!(error.contains(part), "{part}: {error}");
        assert!(error.contains("mesh.cdb"), "{error}");
    }
}

#[test]
fn abaqus_parts_sets_includes_and_refusals() {
    let folder = Folder::new("inp");
    folder.write(
        "sub/nodes.inc",
        "*NODE, NSET=All\n1\n2, 1.\n3, 1., 1.\n4, 0., 1.\n5, 0., 0., 1.D0\n6, 1, 0, 1\n",
    );
    let text = "*HEADING\ncubes\n*Part, name=Soil\n*Include, input=sub/nodes.inc\n7, 1., 1., 1.\n8, 0., 1., 1.\n\
                ** a comment\n*Element, type=C3D8R,\n elset=Cube\n11, 1,2,3,4,\n5,6,7,8\n*Element, type=S4\n12, 1,2,3,4\n\
                *Nset, nset=Bottom, generate\n1, 4, 1\n*Nset, nset=Two\nBottom, 8\n*Elset, elset=Mine\nCube\n\
                *Solid Section, elset=Cube, material=Clay\n,\n*End Part\n*Assembly, name=A\n\
                *Instance, name=Soil-1, part=Soil\n*End Instance\n*Nset, nset=Top, instance=Soil-1\n5, 6\n*End Assembly\n\
                *Material, name=Clay\n*Elastic\n2e7, 0.3\n*Density\n1900.,\n*Boundary\nSoil-1.Bottom, PINNED\nTop, 1, 2\n8, 3, 3, -0.5\n\
                *Step\n*Static\n*Boundary\n7, 6\n*End Step\n";
    let file = read_mesh_file(&folder.write("model.inp", text)).unwrap();
    assert_eq!((file.mesh.node_count(), file.mesh.materials.as_slice()), (8, &[1][..]));
    assert!((file.mesh.element_volume(0) - 1.0).abs() < 1e-12);
    assert_eq!(file.node_sets["Two"], [0, 1, 2, 3, 7]);
    assert_eq!(file.node_sets["Top"], [4, 5]);
    assert_eq!(file.element_sets["Mine"], [0]);
    assert_eq!(file.materials[&1], FileMaterial { young: 2e7, poisson: 0.3, density: Some(1900.0) });
    assert_eq!(file.constraints.len(), 12 + 4 + 1);
    assert!(
        file.warnings.iter().any(|w| w.contains("1 elements of type S4 are left out")),
        "{:?}",
        file.warnings
    );
    assert!(file.warnings.iter().any(|w| w.contains("Clay is material 1")));
    for (old, new, part) in [
        ("type=C3D8R", "type=C3D27", "C3D27"),
        ("*Elset,", "*Nfill\n*Elset,", "*NFILL"),
        ("*End Part", "*End Part\n*Part, name=B", "several parts: Soil, B"),
        ("part=Soil\n", "part=Soil\n0., 0., 1.\n", "without translation or rotation"),
        ("input=sub/nodes.inc", "input=gone.inc", "no such file"),
        ("input=sub/nodes.inc", "input=model.inp", "10 deep"),
        ("5,6,7,8\n", "5,6,7,\n", "element 11"),
        ("material=Clay\n,", "material=Sand\n,", "MATERIAL=SAND"),
        ("Top, 1, 2", "Side, 1, 2", "\"Side\""),
        ("Top, 1, 2", "Top, 2, 1", "2 to 1"),
    ] {
        assert_eq!(text.matches(old).count(), 1, "{old}");
        let path = folder.write("model.inp", &text.replace(old, new));
        let error = read_mesh_file(&path).expect_err(part).to_string();
        assert!(error.contains(part), "{part}: {error}");
    }
}

#[test]
fn gmsh_refusals_name_the_remedy() {
    let folder = Folder::new("msh_bad");
    let text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n\
                $Elements\n1\n1 4 2 5 1 1 2 3 4\n$EndElements\n";
    let file = read_mesh_file(&folder.write("mesh.msh", text)).unwrap();
    assert_eq!(
        (file.mesh.materials.as_slice(), file.mesh.connectivity.kind(0)),
        (&[5][..], ElementKind::Tet4)
    );
    for (old, new, part) in [
        ("1 4 2 5 1", "1 12 2 5 1", "27-node hexahedra (type 12), expected first-order elements"),
        ("2.2 0 8", "4.0 0 8", "4.0, expected 2.2 or 4.1"),
        ("1 2 3 4\n", "1 2 3 9\n", "node 9"),
        ("$Elements\n1", "$Elements\n99999999", "99999999"),
        ("3 0 1 0", "3 0 x 0", "mesh.msh:8: coordinate of a node: found \"x\""),
        ("3 0 1 0", "2 0 1 0", "node 2: found it again"),
    ] {
        let error =
            read_mesh_file(&folder.write("mesh.msh", &text.replace(old, new))).unwrap_err().to_string();
        assert!(error.contains(part), "{part}: {error}");
    }
}

#[test]
fn legacy_vtk_wedges_are_reordered() {
    let folder = Folder::new("vtk_wedge");
    let text = "# vtk DataFile Version 5.1\nold\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 float\n0 0 0 1 0 0 0 1 0 0 0 1 1 0 1 0 1 1\n\
                CELLS 2 6\nOFFSETS vtktypeint64\n0 6\nCONNECTIVITY vtktypeint64\n0 2 1 3 5 4\nCELL_TYPES 1\n13\n\
                CELL_DATA 1\nSCALARS MaterialIds int 1\nLOOKUP_TABLE default\n4\n";
    let file = read_mesh_file(&folder.write("mesh.vtk", text)).unwrap();
    assert_eq!(&file.mesh.connectivity[0], [0, 1, 2, 3, 4, 5]);
    assert_eq!(file.mesh.materials, [4]);
    assert!((file.mesh.element_volume(0) - 0.5).abs() < 1e-12);
    assert!(file.warnings[0].contains("1 wedges"), "{:?}", file.warnings);
}

#[test]
fn the_mesh_commands_take_every_form() {
    let folder = Folder::new("mesh_commands");
    let first = folder.join("first.cdb");
    write_mesh_file(&first, &full(), MeshOptions::default()).unwrap();
    let mut from = first;
    for name in ["a.inp", "b.vtu", "lists", "c.vtk", "d.msh", "e.cdb"] {
        let to = folder.join(name);
        let outcome = trackbed([Path::new("mesh"), Path::new("convert"), &from, &to]).good();
        assert!(outcome.stdout.contains("written"), "{}", outcome.stdout);
        assert_eq!(read_mesh_file(&to).unwrap().mesh, full().mesh, "{name}");
        from = to;
    }
    let text = trackbed([Path::new("mesh"), Path::new("info"), &folder.join("a.inp")]).good().stdout;
    for part in [
        "hex20",
        "wedge6",
        "C3D20R pyramid13",
        "nodes in base",
        "elements in bed",
        "E 210000000000",
        "aspect",
    ] {
        assert!(text.contains(part), "{part} is missing in {text}");
    }
    let outcome = trackbed([Path::new("mesh"), Path::new("check"), &folder.join("a.inp")]);
    assert!(outcome.code == 2 && outcome.stderr.contains("8 unconnected parts"), "{outcome:?}");
    let msh = folder.join("old.msh");
    let arguments =
        [Path::new("mesh"), Path::new("convert"), &from, &msh, Path::new("--format"), Path::new("msh2")];
    trackbed(arguments).good();
    assert!(std::fs::read_to_string(&msh).unwrap().starts_with("$MeshFormat\n2.2 0 8"));
    for (to, part) in [("x.stl", "expected a file .cdb"), ("x.vtu", "--format")] {
        let to = folder.join(to);
        let outcome = trackbed([
            Path::new("mesh"),
            Path::new("convert"),
            &from,
            &to,
            Path::new("--format"),
            Path::new("msh2"),
        ]);
        assert!(outcome.code == 2 && outcome.stderr.contains(part) && !to.exists(), "{outcome:?}");
    }
    let outcome = trackbed([Path::new("mesh"), Path::new("info"), &folder.write("x.stl", "solid")]);
    assert!(outcome.code == 2 && outcome.stderr.contains("found \".stl\""), "{outcome:?}");
}
