//! Mesh files are read exactly or rejected.

use super::support::{Folder, trackbed};
use std::path::Path;
use trackbed::read::{MeshFile, read_mesh_file, read_surface};

/// Brick of 2 m × 0.5 m × 0.25 m.
const CORNERS: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [2.0, 0.0, 0.0],
    [2.0, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.25],
    [2.0, 0.0, 0.25],
    [2.0, 0.5, 0.25],
    [0.0, 0.5, 0.25],
];

fn points(separator: &str, numbered: bool) -> String {
    let row = |(n, x): (usize, &[f64; 3])| {
        let fields: Vec<String> = x.iter().map(|v| format!("{v:?}")).collect();
        let id = if numbered { format!("{}{separator}", n + 1) } else { String::new() };
        format!("{id}{}\n", fields.join(separator))
    };
    CORNERS.iter().enumerate().map(row).collect()
}

fn read(folder: &Folder, name: &str, text: &str) -> Result<MeshFile, String> {
    read_mesh_file(&folder.write(name, text)).map_err(|e| e.to_string())
}

fn volume(file: &MeshFile) -> f64 {
    (0..file.mesh.element_count()).map(|e| file.mesh.element_volume(e)).sum()
}

fn inp(body: &str) -> String {
    format!("*NODE\n{}*ELEMENT, TYPE=C3D8, ELSET=SOIL\n1, 1,2,3,4,5,6,7,8\n{body}", points(", ", true))
}

#[test]
fn names_in_quotes_are_one_name() {
    let folder = Folder::new("quotes");
    let bed = "*NSET,NSET=\"Bed face\"\n1,2,3,4\n";
    for body in [
        format!("{bed}*BOUNDARY\n\"Bed face\",1,3\n"),
        format!("{bed}*BOUNDARY\nbed face, PINNED\n"),
        "*NSET,NSET=\"a, b\"\n1,2,3,4\n*NSET, NSET=\"C\"\n\"a, b\"\n*BOUNDARY\n\"C\",1,3\n".to_string(),
        "*NSET,NSET=Bed\n1,2,3,4\n*BOUNDARY\n\"Bed\",ENCASTRE\n".to_string(),
    ] {
        let file = read(&folder, "quoted.inp", &inp(&body)).unwrap();
        assert_eq!(file.constraints.len(), 12, "{body}");
    }
    let section = "*ELSET, ELSET=\"all of it\"\n1\n*MATERIAL, NAME=\"Clay 7\"\n*ELASTIC\n1e7, 0.3\n\
                   *SOLID SECTION, ELSET=\"all of it\", MATERIAL=\"Clay 7\"\n";
    assert_eq!(read(&folder, "section.inp", &inp(section)).unwrap().mesh.materials, [7]);
}

/// CalculiX manual, *BOUNDARY: with OP=NEW "previously prescribed displacements are removed".
#[test]
fn op_new_removes_model_constraints() {
    let folder = Folder::new("op_new");
    let model = "*NSET,NSET=BED\n1,2,3,4\n*BOUNDARY\nBED,1,3\n";
    let step = |rows: &str| inp(&format!("{model}*STEP\n*STATIC\n{rows}*END STEP\n"));
    for (rows, count, removed) in [
        ("*BOUNDARY,OP=NEW\n1,3,3\n", 1, true),
        ("*BOUNDARY, OP=new\n*BOUNDARY, OP=NEW\n1,3,3\n2,1,2\n", 3, true),
        ("*BOUNDARY,OP=NEW\n", 0, true),
        ("*BOUNDARY,OP=MOD\n5,3,3\n", 13, false),
        ("*BOUNDARY\n5,3,3\n", 13, false),
        ("*END STEP\n*STEP\n*BOUNDARY,OP=NEW\n1,3,3\n", 12, false),
    ] {
        let file = read(&folder, "brick.inp", &step(rows)).unwrap();
        assert_eq!(file.constraints.len(), count, "{rows}");
        let note = "*BOUNDARY, OP=NEW removes the 1 rows of constraints of the model";
        assert_eq!(file.warnings.iter().any(|w| w.contains(note)), removed, "{rows}: {:?}", file.warnings);
    }
    for (rows, part) in [
        ("*BOUNDARY\n5,3,3\n*BOUNDARY,OP=NEW\n1,3,3\n", "OP=NEW for all entries of a step, or for none"),
        ("*BOUNDARY,OP=NEW\n1,3,3\n*BOUNDARY\n5,3,3\n", "OP=NEW for all entries of a step, or for none"),
        ("*BOUNDARY, USER\n1,3,3,1.0\n", "*BOUNDARY: found USER, expected displacements in the rows"),
    ] {
        let error = read(&folder, "brick.inp", &step(rows)).unwrap_err();
        assert!(error.contains(part), "{rows}: {error}");
    }
    let file = read(&folder, "brick.inp", &step("*BOUNDARY, AMPLITUDE=RAMP\n5,3,3,0.1\n")).unwrap();
    assert!(file.warnings.iter().any(|w| w.contains("AMPLITUDE=RAMP")), "{:?}", file.warnings);
}

/// Coincident elements would double the weight and hide all faces.
#[test]
fn rejects_overlapping_elements() {
    let folder = Folder::new("twins");
    let twin = |nodes: &str| inp(&format!("*ELEMENT, TYPE=C3D8\n2, {nodes}\n"));
    for text in [twin("1,2,3,4,5,6,7,8"), twin("2,3,4,1,6,7,8,5"), twin("5,6,7,8,1,2,3,4")] {
        let error = read(&folder, "twin.inp", &text).unwrap_err();
        assert!(
            error.contains("elements 1, 2: found the same corners, expected each volume once"),
            "{error}"
        );
    }
    let cells = |cells: &str, types: &str| {
        format!(
            "# vtk DataFile Version 3.0\nb\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n{}CELLS {cells}CELL_TYPES {types}",
            points(" ", false)
        )
    };
    let brick = "8 0 1 2 3 4 5 6 7\n";
    assert!(read(&folder, "one.vtk", &cells(&format!("1 9\n{brick}"), "1\n12\n")).is_ok());
    let error = read(&folder, "two.vtk", &cells(&format!("2 18\n{brick}{brick}"), "2\n12 12\n")).unwrap_err();
    assert!(error.contains("elements 1, 2: found the same corners"), "{error}");
    let three = "3 15\n4 0 1 2 4\n4 0 2 1 5\n4 0 1 2 6\n";
    let error = read(&folder, "three.vtk", &cells(three, "3\n10 10 10\n")).unwrap_err();
    assert!(error.contains("elements 1, 2, 3: found the face of nodes 1, 2, 3 in all of them"), "{error}");
    let lists = folder.join("lists");
    std::fs::create_dir_all(&lists).unwrap();
    folder.write("lists/NODECOORD.DAT", &points(" ", true));
    folder.write("lists/ELEMENTNUM.DAT", "1 1 1 2 3 4 5 6 7 8\n2 1 1 2 3 4 5 6 7 8\n3 1 1 2 3 4 5 6 7 8\n");
    let error = read_mesh_file(&lists).unwrap_err().to_string();
    assert!(error.contains("ELEMENTNUM.DAT: elements 1, 2, 3: found the same corners"), "{error}");
    for command in ["info", "check"] {
        let outcome = trackbed([Path::new("mesh"), Path::new(command), &folder.join("twin.inp")]);
        assert!(outcome.code == 2 && outcome.stderr.contains("elements 1, 2"), "{outcome:?}");
    }
}

fn archive(block: &str, rows: &str, body: &str) -> String {
    let head: String =
        [1, 1, 1, 1, 0, 0, 0, 0, 8, 0, 1, 1, 2, 3, 4, 5, 6, 7, 8].map(|n| format!("{n:9}")).concat();
    format!(
        "/PREP7\nET,1,185\nNBLOCK,6,SOLID,8,8\n{block}\n{rows}N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID,1,1\n(19i9)\n{head}\n{:>9}\n\
         {body}FINISH\n",
        -1
    )
}

fn rows(widths: [usize; 3]) -> String {
    let row = |(n, x): (usize, &[f64; 3])| {
        let [a, b, c] = widths;
        let reals: String = x.iter().map(|v| format!("{v:21.13e}")).collect();
        format!("{:a$}{:b$}{:c$}{reals}\n", n + 1, 0, 0)
    };
    CORNERS.iter().enumerate().map(row).collect()
}

/// Block formats as read by mapdl-archive 0.4.2.
#[test]
fn node_blocks_with_several_integer_groups() {
    let folder = Folder::new("nblock");
    for (format, widths) in [
        ("(1i7,2i9,6e21.13)", [7, 9, 9]),
        ("(3i9,6e21.13)", [9, 9, 9]),
        ("(i8,i9,i10,6e21.13e3)", [8, 9, 10]),
        ("(2I8,1I6,3E21.13)", [8, 8, 6]),
        ("(1i10,2i7,6e21.13)", [10, 7, 7]),
    ] {
        let file = read(&folder, "brick.cdb", &archive(format, &rows(widths), "")).unwrap();
        assert_eq!((file.mesh.node_count(), volume(&file)), (8, 0.25), "{format}");
    }
}

#[test]
fn component_ranges_continue_across_rows() {
    let folder = Folder::new("components");
    let plain = |body: &str| archive("(3i9,6e21.13)", &rows([9; 3]), body);
    for kind in ["KP", "LINE", "AREA", "VOLU"] {
        let body = format!(
            "CMBLOCK,CREST,{kind},       2  ! of the model\n(8i10)\n{:10}{:10}\nCMBLOCK,FOOT,NODE,       2\n(8i10)\n{:10}{:10}\n",
            1, -7, 1, -4
        );
        let file = read(&folder, "brick.cdb", &plain(&body)).unwrap();
        assert_eq!(file.node_sets.len(), 1, "{kind}");
        assert_eq!(file.node_sets["FOOT"], [0, 1, 2, 3]);
        assert!(
            file.warnings.iter().any(|w| w.contains("component CREST of the solid model")),
            "{:?}",
            file.warnings
        );
    }
    // One number per row: ranges span rows.
    let body = format!("CMBLOCK,FACE,NODE,3\n(1i10)\n{:10}\n{:10}\n{:10}\n", 2, -5, 8);
    assert_eq!(read(&folder, "row.cdb", &plain(&body)).unwrap().node_sets["FACE"], [1, 2, 3, 4, 7]);
    let error = read(&folder, "row.cdb", &plain("CMBLOCK,FACE,NODE,1\n(8i10)\n        -5\n")).unwrap_err();
    assert!(error.contains("expected a range after its first number"), "{error}");
}

/// Tetrahedron from SOLID186, mid-side S of a collapsed edge equal to M, as ANSYS writes it (pymapdl-reader,
/// all_solid_cells).
#[test]
fn mid_sides_on_collapsed_edges() {
    let folder = Folder::new("folded");
    let nodes: String = [
        [0., 0., 0.],
        [2., 0., 0.],
        [0., 1.5, 0.],
        [0., 0., 1.],
        [1., 0., 0.],
        [1., 0.75, 0.],
        [0., 0.75, 0.],
        [0., 0., 0.5],
        [1., 0., 0.5],
        [0., 0.75, 0.5],
    ]
    .iter()
    .enumerate()
    .map(|(n, [x, y, z])| format!("{} {x} {y} {z}\n", n + 1))
    .collect();
    folder.write("lists/NODECOORD.DAT", &nodes);
    for s in [3, 4, 1] {
        folder.write("lists/ELEMENTNUM.DAT", &format!("1 1 1 2 3 3 4 4 4 4 5 6 {s} 7 4 4 4 4 8 9 10 10\n"));
        let file = read_mesh_file(&folder.join("lists")).unwrap();
        assert!((volume(&file) - 0.5).abs() < 1e-12 && file.mesh.node_count() == 10, "{s}");
    }
    folder.write("lists/ELEMENTNUM.DAT", "1 1 1 2 3 3 4 4 4 4 5 6 9 7 4 4 4 4 8 9 10 10\n");
    let error = read_mesh_file(&folder.join("lists")).unwrap_err().to_string();
    assert!(error.contains("node S = 9 on an edge of a tet10"), "{error}");
}

#[test]
fn vtk_empty_sections_and_face_ids() {
    let folder = Folder::new("vtk");
    let grid = |cells: &str, types: &str, data: &str| {
        format!(
            "# vtk DataFile Version 3.0\nb\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n{}CELLS {cells}CELL_TYPES {types}{data}",
            points(" ", false)
        )
    };
    let (one, two) = ("1 9\n8 0 1 2 3 4 5 6 7\n", "2 14\n8 0 1 2 3 4 5 6 7\n4 0 1 2 3\n");
    for data in [
        "POINT_DATA 8\n",
        "POINT_DATA 8",
        "CELL_DATA 1\nPOINT_DATA 8\n",
        "CELL_DATA 1\n",
        "POINT_DATA 8\nFIELD f 0\n",
    ] {
        let file = read(&folder, "brick.vtk", &grid(one, "1\n12\n", data)).unwrap();
        assert_eq!(volume(&file), 0.25, "{data}");
    }
    for name in ["MaterialID", "material", "element_id"] {
        for number in ["-1", "0.5", "4294967296"] {
            let data = format!("CELL_DATA 2\nSCALARS {name} double 1\nLOOKUP_TABLE default\n3 {number}\n");
            let file = read(&folder, "brick.vtk", &grid(two, "2\n12 9\n", &data)).unwrap();
            let found = if name == "element_id" { &file.mesh.element_ids } else { &file.mesh.materials };
            assert_eq!(found, &[3], "{name} {number}");
            let wrong = data.replace("3 ", "-3 ");
            let error = read(&folder, "brick.vtk", &grid(two, "2\n12 9\n", &wrong)).unwrap_err();
            assert!(error.contains(&format!("array {name}: found -3")), "{error}");
        }
    }
    let error = read(
        &folder,
        "brick.vtk",
        &grid(one, "1\n12\n", "POINT_DATA 99999999\nSCALARS s float\nLOOKUP_TABLE default\n1\n"),
    );
    assert!(error.unwrap_err().contains("expected a count that"));
}

/// Column of 1 m × 1 m, two elements high, sides one physical surface.
fn column(binary_names: &str) -> String {
    let mut nodes = String::new();
    for (level, z) in [0.0, 1.0, 2.0].iter().enumerate() {
        for (k, [x, y]) in [[0, 0], [1, 0], [1, 1], [0, 1]].iter().enumerate() {
            nodes += &format!("{} {x} {y} {z}\n", 4 * level + k + 1);
        }
    }
    let mut elements = String::new();
    let mut id = 0;
    for level in 0..2 {
        let n = |k: usize| 4 * level + k + 1;
        id += 1;
        elements += &format!(
            "{id} 5 2 1 1 {} {} {} {} {} {} {} {}\n",
            n(0),
            n(1),
            n(2),
            n(3),
            n(4),
            n(5),
            n(6),
            n(7)
        );
        for k in 0..4 {
            let next = (k + 1) % 4;
            id += 1;
            elements += &format!("{id} 3 2 10 {} {} {} {} {}\n", k + 1, n(k), n(next), n(next + 4), n(k + 4));
        }
    }
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 10 \"{binary_names}\"\n$EndPhysicalNames\n$Nodes\n12\n{nodes}$EndNodes\n\
         $Elements\n10\n{elements}$EndElements\n"
    )
}

const PRESSED: &str = r#"
[solid]
mesh = "MESH"
gravity = false
integration = "full"

[[solid.material]]
id = 1
young = "100 MPa"
poisson = 0.0
density = 2000

[[solid.support]]
side = "z-"
directions = ["z"]

[[solid.support]]
nodes_in = [[-0.01, -0.01, -0.01], [0.01, 0.01, 3]]
directions = ["x", "y"]

[[solid.support]]
nodes_in = [[0.99, -0.01, -0.01], [1.01, 0.01, 3]]
directions = ["y"]

[[solid.load]]
kind = "pressure"
set = "jacket"
pressure = "50 kPa"

[[probe]]
name = "top"
at = [1.0, 1.0, 2.0]

[output]
tables = true
"#;

/// u = p L / E = 0.5 mm along x and y, zero along z (nu = 0).
#[test]
fn face_sets_survive_every_format() {
    let folder = Folder::new("face_set");
    let msh = folder.write("column.msh", &column("jacket"));
    let read = read_mesh_file(&msh).unwrap();
    assert_eq!((read.face_sets["jacket"].len(), read.node_sets["jacket"].len()), (8, 12));
    for name in ["column.msh", "again.msh", "column.inp", "column.vtu", "column.vtk"] {
        let mesh = folder.join(name);
        if name != "column.msh" {
            trackbed([Path::new("mesh"), Path::new("convert"), &msh, &mesh]).good();
            assert_eq!(read_mesh_file(&mesh).unwrap().face_sets, read.face_sets, "{name}");
        }
        let info = trackbed([Path::new("mesh"), Path::new("info"), &mesh]).good().stdout;
        assert!(info.contains("8   faces in jacket"), "{info}");
        let scene = folder.write("scene.toml", &PRESSED.replace("MESH", name));
        let out = folder.join("out");
        super::support::run(&scene, &out, &[]).good();
        let text = std::fs::read_to_string(out.join("nodes.csv")).unwrap();
        let last = text.lines().last().unwrap();
        let row: Vec<f64> = last.split(',').filter_map(|f| f.trim().parse().ok()).collect();
        let heads: Vec<&str> = text.lines().find(|l| !l.starts_with('#')).unwrap().split(',').collect();
        let value = |start: &str| {
            let at =
                heads.iter().position(|h| h.trim().starts_with(start)).unwrap_or_else(|| panic!("{heads:?}"));
            row[at]
        };
        // Node 12 at (0, 1, 2), before it node 11 at (1, 1, 2).
        assert!((value("uz")).abs() < 1e-12, "{name}: {last}");
        assert!((value("uy") + 0.5e-3).abs() < 1e-9, "{name}: {last}");
    }
}

#[test]
fn abaqus_surfaces_become_face_sets() {
    let folder = Folder::new("surface");
    let top = [[0.0, 0.0, 0.25], [2.0, 0.0, 0.25], [2.0, 0.5, 0.25], [0.0, 0.5, 0.25]];
    let corners = |file: &MeshFile, name: &str| -> Vec<Vec<[f64; 3]>> {
        let face = |[e, s]: &[u32; 2]| {
            let face = file.mesh.face(*e as usize, *s as usize);
            let mut all: Vec<[f64; 3]> =
                face.corners().iter().map(|n| file.mesh.coordinates[*n as usize]).collect();
            all.sort_by(|a, b| a.partial_cmp(b).unwrap());
            all
        };
        file.face_sets[name].iter().map(face).collect()
    };
    let sorted = |points: &[[f64; 3]]| {
        let mut all = points.to_vec();
        all.sort_by(|a, b| a.partial_cmp(b).unwrap());
        all
    };
    for body in [
        "*SURFACE, NAME=Top\n1, S2\n",
        "*SURFACE, TYPE=ELEMENT, NAME=\"Top\"\nSOIL, S2\n",
        "*Surface, type=element, name=Top, internal\nsoil, s2\n1, S2\n",
    ] {
        assert_eq!(corners(&read(&folder, "b.inp", &inp(body)).unwrap(), "Top"), [sorted(&top)], "{body}");
    }
    let south = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, 0.25], [0.0, 0.0, 0.25]];
    let file = read(&folder, "b.inp", &inp("*SURFACE, NAME=A\n1, S3\n*SURFACE, NAME=All\nSOIL,\n")).unwrap();
    assert_eq!((corners(&file, "A"), file.face_sets["All"].len()), (vec![sorted(&south)], 6));
    let file = read(&folder, "b.inp", &inp("*SURFACE, TYPE=NODE, NAME=N\n1, 1.0\n")).unwrap();
    assert!(file.face_sets.is_empty() && file.warnings.iter().any(|w| w.contains("SURFACE of NODE")));
    for (body, part) in [
        ("*SURFACE, NAME=A\n1, S7\n", "found \"S7\", expected S1 to S6"),
        ("*SURFACE, NAME=A\n1, SPOS\n", "found \"SPOS\""),
        ("*SURFACE, NAME=A\nNONE, S1\n", "found \"NONE\", expected an element or a set"),
    ] {
        let error = read(&folder, "b.inp", &inp(body)).unwrap_err();
        assert!(error.contains(part), "{body}: {error}");
    }
    // Wedge as degenerate brick: its third face, S5, has zero area.
    let folded = format!(
        "*NODE\n{}*ELEMENT, TYPE=C3D8\n1, 1,2,3,3,5,6,7,7\n*SURFACE, NAME=A\n1, ",
        points(", ", true)
    );
    assert!(read(&folder, "f.inp", &format!("{folded}S6\n")).is_ok());
    let error = read(&folder, "f.inp", &format!("{folded}S5\n")).unwrap_err();
    assert!(error.contains("S5 of element 1, a wedge6, expected a face that the element has"), "{error}");
}

#[test]
fn gmsh_comments_and_unconstrained_checks() {
    let folder = Folder::new("gmsh");
    let text = column("jacket");
    for before in
        ["$Comments\nwritten by a test\n$EndComments\n", "$Note\n$EndNote\n\n$Comments\n$EndComments\n"]
    {
        assert_eq!(volume(&read(&folder, "c.msh", &format!("{before}{text}")).unwrap()), 2.0);
    }
    let (format, rest) = text.split_once("$EndMeshFormat\n").unwrap();
    let late = format!("{rest}{format}$EndMeshFormat\n");
    assert!(read(&folder, "late.msh", &late).unwrap_err().contains("expected $MeshFormat first"));
    let outcome = trackbed([Path::new("mesh"), Path::new("check"), &folder.join("c.msh")]).good();
    assert!(outcome.stdout.contains("no defects found"), "{outcome:?}");
    assert!(
        outcome
            .stdout
            .contains("warning: this format contains no constraints; add [[solid.support]] to the scene")
    );
    let foreign = "# vtk DataFile Version 3.0\nb\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n";
    let vtk = format!("{foreign}{}CELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n12\n", points(" ", false));
    trackbed([Path::new("mesh"), Path::new("check"), &folder.write("b.vtk", &vtk)]).good();
    let bare = folder.write("b.inp", &inp(""));
    let outcome = trackbed([Path::new("mesh"), Path::new("check"), &bare]).good();
    let note = "warning: the mesh contains no constraints; add [[solid.support]] to the scene";
    assert!(outcome.stdout.contains(note), "{outcome:?}");
    let material = "[[solid.material]]\nid = 1\nyoung = \"50 MPa\"\npoisson = 0.3\ndensity = 1900\n";
    let scene = folder.write("scene.toml", &format!("[solid]\nmesh = \"b.inp\"\n{material}"));
    let outcome = trackbed([Path::new("mesh"), Path::new("check"), &scene]);
    assert!(outcome.code == 2 && outcome.stderr.contains("no constraint in"), "{outcome:?}");
}

/// OBJ faces with empty fields, as trimesh 5.2.0 reads them.
#[test]
fn faces_of_obj_with_empty_fields() {
    let folder = Folder::new("obj");
    let cube = [[1, 4, 3, 2], [5, 6, 7, 8], [1, 2, 6, 5], [2, 3, 7, 6], [3, 4, 8, 7], [4, 1, 5, 8]];
    for end in ["//", "/", "", "//1", "/1/", "/1/1", "/1"] {
        let vertices: String = CORNERS.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
        let faces: String =
            cube.iter().map(|f| format!("f {}\n", f.map(|v| format!("{v}{end}")).join(" "))).collect();
        let surface = read_surface(&folder.write("cube.obj", &format!("{vertices}{faces}"))).unwrap();
        assert_eq!((surface.vertices.len(), surface.triangles.len()), (8, 12), "{end}");
    }
}

/// Gmsh has no physical volume 0.
#[test]
fn material_0_stays_0_in_gmsh() {
    use trackbed::write::{MeshOptions, write_mesh_file};
    let folder = Folder::new("material_0");
    let mut file = read(&folder, "column.msh", &column("jacket")).unwrap();
    file.warnings.clear();
    for (materials, set) in [([0, 0], false), ([0, 0], true), ([0, 3], true), ([5, 0], false)] {
        file.mesh.materials = materials.to_vec();
        file.element_sets.clear();
        if set {
            file.element_sets.insert("low".into(), vec![0]);
        }
        for msh2 in [false, true] {
            let path = folder.join("zero.msh");
            write_mesh_file(&path, &file, MeshOptions { msh2 }).unwrap();
            let back = read_mesh_file(&path).unwrap();
            assert_eq!(back.mesh.materials, materials, "{set} {msh2}");
            assert_eq!(back.element_sets, file.element_sets, "{materials:?} {msh2}");
        }
    }
}

#[test]
fn inverted_meshes_are_reported() {
    let folder = Folder::new("inside_out");
    let mirrored = inp("").replace("1, 1,2,3,4,5,6,7,8", "1, 5,6,7,8,1,2,3,4");
    let path = folder.write("b.inp", &format!("{mirrored}*BOUNDARY\n1,1,3\n2,1,3\n3,1,3\n4,1,3\n"));
    let outcome = trackbed([Path::new("mesh"), Path::new("check"), &path]);
    let sentence = "the only element inverted: bottom and top faces are exchanged (order of the nodes, or a mirrored mesh)";
    assert!(outcome.code == 2 && outcome.stderr.contains(sentence), "{outcome:?}");
    let info = trackbed([Path::new("mesh"), Path::new("info"), &path]).good().stdout;
    assert!(info.contains("inverted") && info.contains("negative volume"), "{info}");
    let material = "[[solid.material]]\nid = 1\nyoung = \"50 MPa\"\npoisson = 0.3\ndensity = 1900\n";
    let scene = folder.write("scene.toml", &format!("[solid]\nmesh = \"b.inp\"\n{material}"));
    let outcome = trackbed([Path::new("check"), &scene]);
    assert!(outcome.code == 2 && outcome.stderr.contains(&format!("mesh: found {sentence}")), "{outcome:?}");
}

#[test]
fn time_history_uses_header_units() {
    let folder = Folder::new("course");
    let scene = "[solid]\ngravity = false\n[solid.block]\nx = { lines = [0, 1], counts = [2] }\ny = { lines = [0, 1], counts = [2] }\n\
                 z = { lines = [0, 1], counts = [2] }\n[[solid.material]]\nid = 1\nyoung = \"60 MPa\"\npoisson = 0.3\ndensity = 2000\n\
                 [[solid.support]]\nside = \"z-\"\ndirections = [\"x\", \"y\", \"z\"]\nname = \"base\"\n\
                 [[solid.load]]\nkind = \"pressure\"\nside = \"z+\"\npressure = \"10 kPa\"\n\
                 history = { kind = \"table\", file = \"course.csv\" }\n[solid.quasi_static]\n\
                 [time]\nend = \"1 s\"\nsolid_step = \"0.5 s\"\n[output]\nhistory_interval = \"0.5 s\"\nframes = 0\n";
    let path = folder.write("scene.toml", scene);
    let run = |course: &str| {
        folder.write("course.csv", course);
        super::support::run(&path, &folder.join("out"), &[])
    };
    for course in [
        "time [ms],factor\n0,0\n1000,2\n",
        "\u{feff}0,0\n1,2\n",
        "Time (s),load factor [-]\n0,0\n1,2\n",
        "t/ms,percent [%]\n0,0\n1000,200\n",
        "factor,time\n0,0\n2,1\n",
        "time,load_case,factor\n0,1,0\n1,1,2\n",
        "Zeit;Faktor\n0,0;0,0\n0,5;1,0\n1,0;2,0\n",
        "\u{feff}# measured\r\n\"time [ms]\";\"factor [-]\"\r\n\r\n\"0\";\"0\"\r\n1.0E+03 ; 2\r\n",
        "time\tfactor\n0\t0\n1\t2\n",
    ] {
        run(course).good();
        let history = super::support::Table::read(&folder.join("out/history.csv"));
        let reaction = *history.column("base_reaction_z").last().unwrap();
        assert!((reaction.abs() - 20_000.0).abs() < 1e-3, "{course}: {reaction}");
    }
    for (course, part) in [
        (
            "time [ms],pressure [kPa]\n0,0\n1,2\n",
            "course.csv:1: factor: found \"pressure [kPa]\", expected a number without a unit",
        ),
        ("factor,place\n0,0\n1,2\n", "course.csv:1: heading: found \"place\", expected a column of time"),
        (
            "time,load_case,settlement\n0,1,0\n1,1,2\n",
            "course.csv:1: heading: found columns time, load_case, settlement, expected a column of factor",
        ),
        ("time factor\n0 0\n1 2\n", "course.csv:1: heading: found \"time factor\", separated by blanks"),
        (
            "# time in milliseconds\n0,0\n1000,2\n",
            "course.csv:1: unit of the comment: found \"time in milliseconds\"",
        ),
        (
            "time [parsec],factor\n0,0\n1,2\n",
            "course.csv:1: time: found \"time [parsec]\", expected one of the units s",
        ),
        ("O,0\n1,2\n", "course.csv:1: heading: found \"O\""),
        ("time,factor\ns,-\n0,0\n1,2\n", "course.csv:2: time: found \"s\", expected a number"),
    ] {
        let outcome = run(course);
        assert!(outcome.code == 2 && outcome.stderr.contains(part), "{part}: {outcome:?}");
    }
}

#[test]
fn stated_units_need_a_scale() {
    let folder = Folder::new("stated_units");
    let bare = folder.write("bare.inp", &inp("*BOUNDARY\n1,1,3\n2,1,3\n3,1,3\n4,1,3\n"));
    for name in ["a.cdb", "a.msh", "a.vtk", "lists"] {
        trackbed([Path::new("mesh"), Path::new("convert"), &bare, &folder.join(name)]).good();
    }
    let text = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    folder.write("a.inp", &format!("** UNITS: MM, N\n{}", text("bare.inp")));
    folder.write("a.cdb", &format!("/UNITS,MPA\n{}", text("a.cdb")));
    folder.write("a.msh", &format!("$Comments\nunits: mm\n$EndComments\n{}", text("a.msh")));
    folder.write("a.vtk", &text("a.vtk").replacen("\nmesh\n", "\nunits: mm\n", 1));
    folder.write("lists/NODECOORD.DAT", &format!("! NODE X [mm] Y [mm]\n{}", text("lists/NODECOORD.DAT")));
    let material = "[[solid.material]]\nid = 1\nyoung = \"50 MPa\"\npoisson = 0.3\ndensity = 1900\n";
    for (name, sentence) in [
        ("a.inp", "a.inp:1: unit of the comment: found mm in \"** UNITS: MM, N\", expected metres"),
        ("a.cdb", "a.cdb:1: /UNITS: found MPA (mm), expected SI or MKS (m)"),
        ("a.msh", "a.msh:2: unit of the comment: found mm in \"units: mm\", expected metres"),
        ("a.vtk", "a.vtk:2: unit of the comment: found mm in \"units: mm\", expected metres"),
        (
            "lists",
            "NODECOORD.DAT:1: unit of the comment: found mm in \"! NODE X [mm] Y [mm]\", expected metres",
        ),
    ] {
        let sentence = format!("{sentence}. Set solid.scale = 0.001, or convert the file.");
        let info = trackbed([Path::new("mesh"), Path::new("info"), &folder.join(name)]).good().stdout;
        assert!(info.contains(&sentence) && info.contains("0.2500 m³"), "{info}");
        let solid = format!("[solid]\nmesh = \"{name}\"\n");
        let scene = folder.write("scene.toml", &format!("{solid}{material}"));
        let outcome = trackbed([Path::new("mesh"), Path::new("info"), &scene]);
        assert!(outcome.code == 2 && outcome.stderr.contains(&sentence), "{outcome:?}");
        folder.write("scene.toml", &format!("{solid}scale = 0.001\n{material}"));
        trackbed([Path::new("mesh"), Path::new("info"), &scene]).good();
    }
}

/// Overflow would give NaN volumes.
#[test]
fn coordinates_have_volumes_that_are_numbers() {
    let folder = Folder::new("overflow");
    for (value, good) in [("1e15", true), ("1e16", false), ("-1e300", false), ("1e308", false)] {
        let text = inp("").replace("7, 2.0,", &format!("7, {value},"));
        let outcome = trackbed([Path::new("mesh"), Path::new("info"), &folder.write("far.inp", &text)]);
        assert_eq!(outcome.code, if good { 0 } else { 2 }, "{outcome:?}");
        let said = format!("{}{}", outcome.stdout, outcome.stderr);
        assert!(!said.contains("NaN") && !said.contains("inf "), "{said}");
        assert!(
            good || said.contains("coordinates of node 7: found") && said.contains("up to 1e15"),
            "{said}"
        );
    }
    folder.write("lists/NODECOORD.DAT", &points(" ", true).replace("7 2.0", "7 1e200"));
    folder.write("lists/ELEMENTNUM.DAT", "1 1 1 2 3 4 5 6 7 8\n");
    let error = read_mesh_file(&folder.join("lists")).unwrap_err().to_string();
    assert!(error.contains("NODECOORD.DAT:7: coordinates of node 7: found 1e200"), "{error}");
}
