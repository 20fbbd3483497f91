use std::path::PathBuf;

use super::*;

fn folder(name: &str) -> PathBuf {
    let dir = std::env::temp_dir().join(format!("trackbed_lists_{}_{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&dir);
    std::fs::create_dir_all(&dir).unwrap();
    dir
}

/// Two bricks with a common face, nodes unordered.
fn brick_nodes() -> String {
    let mut rows: Vec<String> =
        (1..=32).map(|i| format!("{} {}.5 {} {}", node(i), i, i * i, -(i as i32))).collect();
    rows.reverse();
    rows.join("\n") + "\n"
}

fn node(i: u32) -> u32 {
    if i <= 20 { i } else { 80 + i }
}

fn element_nodes(first: u32) -> String {
    (first..first + 20).map(|i| node(i).to_string()).collect::<Vec<_>>().join(" ")
}

fn elements() -> String {
    format!("7 2 {}\n3 1 {}\n", element_nodes(1), element_nodes(13))
}

fn read(name: &str, nodes: &str, elements: &str, constraints: Option<&str>) -> Result<Lists, String> {
    read_as(name, nodes, elements, constraints, ListLayout::default())
}

fn read_as(
    name: &str,
    nodes: &str,
    elements: &str,
    constraints: Option<&str>,
    layout: ListLayout,
) -> Result<Lists, String> {
    let dir = folder(name);
    let path = |file: &str| dir.join(file);
    std::fs::write(path("NODECOORD.DAT"), nodes).unwrap();
    std::fs::write(path("ELEMENTNUM.DAT"), elements).unwrap();
    let dof = constraints.map(|text| {
        std::fs::write(path("DOF.DAT"), text).unwrap();
        path("DOF.DAT")
    });
    let result = read_lists(&path("NODECOORD.DAT"), &path("ELEMENTNUM.DAT"), dof.as_deref(), &layout);
    std::fs::remove_dir_all(&dir).unwrap();
    let prefix = format!("{}{}", dir.display(), std::path::MAIN_SEPARATOR);
    result
        .map(|mut lists| {
            lists.warnings.iter_mut().for_each(|w| *w = w.replace(&prefix, ""));
            lists
        })
        .map_err(|error| error.to_string().replace(&prefix, ""))
}

fn refused(name: &str, nodes: &str, elements: &str, constraints: Option<&str>) -> String {
    read(name, nodes, elements, constraints).expect_err("this list has a fault")
}

#[test]
fn our_layout() {
    let lists = read("plain", &brick_nodes(), &elements(), Some("5 1 0.0\n112 UZ -1.5e-3\n2 all\n")).unwrap();
    let mesh = &lists.mesh;
    assert_eq!(mesh.node_count(), 32);
    assert_eq!((mesh.node_ids[0], mesh.node_ids[31]), (112, 1));
    assert_eq!(mesh.coordinates[30], [2.5, 4.0, -2.0]);
    assert_eq!(mesh.element_ids, [7, 3]);
    assert_eq!(mesh.materials, [2, 1]);
    // Node 1 is the last of the file, index 31.
    assert_eq!(mesh.connectivity[0], std::array::from_fn::<u32, 20, _>(|n| 31 - n as u32));
    assert_eq!(mesh.connectivity[1], std::array::from_fn::<u32, 20, _>(|n| 19 - n as u32));
    let expected = [(27, 0, 0.0), (0, 2, -1.5e-3), (30, 0, 0.0), (30, 1, 0.0), (30, 2, 0.0)];
    let expected = expected.map(|(node, direction, value)| Constraint { node, direction, value });
    assert_eq!(lists.constraints, expected);
    assert!(lists.warnings.is_empty());
}

#[test]
fn recognises_columns_by_count_and_content() {
    let (a, b) = (element_nodes(1), element_nodes(13));
    let cases = [
        ("21_id", format!("7 {a}\n3 {b}\n"), [7, 3], [1, 1], true),
        ("21_mat", format!("5 {a}\n5 {b}\n"), [1, 2], [5, 5], true),
        ("20", format!("{a}\n{b}\n"), [1, 2], [1, 1], false),
        ("26", format!("7 2 1 1 0 1 {a}\n3 4 1 1 0 1 {b}\n"), [7, 3], [2, 4], false),
    ];
    for (name, text, ids, materials, guessed) in cases {
        let lists = read(name, &brick_nodes(), &text, None).unwrap();
        assert_eq!(lists.mesh.element_ids, ids, "{name}");
        assert_eq!(lists.mesh.materials, materials, "{name}");
        assert_eq!(lists.mesh.connectivity[1][0], 19, "{name}");
        assert_eq!(lists.warnings.len(), usize::from(guessed), "{name}: {:?}", lists.warnings);
    }
}

#[test]
fn reads_ambiguous_ten_columns() {
    let eight = "1 1 1 2 3 4 9 10 11 12\n2 1 9 10 11 12 17 18 19 20\n";
    for text in [
        eight.to_string(),
        format!("{eight}3 2 5 6 7 8 13 14 15 16\n"),
        format!("{eight}{}", "3 1 101 102 103 104 105 106 107 108\n4 1 5 6 7 8 13 14 15 16\n"),
    ] {
        let lists = read("ten", &brick_nodes(), &text, None).unwrap();
        assert!(lists.mesh.connectivity.kinds().iter().all(|kind| *kind == ElementKind::Hex8), "{text}");
        assert_eq!((lists.mesh.element_ids[1], lists.mesh.materials[1]), (2, 1));
    }
    let first: Vec<u32> = (1..=10).collect();
    let join = |ids: Vec<u32>| ids.iter().map(u32::to_string).collect::<Vec<_>>().join(" ");
    let twenty = format!("{}\n{}\n", join(first), join((11..=20).collect()));
    let lists = read("twenty", &brick_nodes(), &twenty, None).unwrap();
    assert_eq!((lists.mesh.element_count(), lists.mesh.connectivity.kind(0)), (1, ElementKind::Hex20));
}

#[test]
fn blank_coordinates_of_nwrite_are_zero() {
    let points: Vec<[f64; 3]> =
        (0..8).map(|i| [f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)]).collect();
    let row = |(n, x): (usize, &[f64; 3]), id: usize, real: usize| {
        let kept = 3 - x.iter().rev().take_while(|v| **v == 0.0).count();
        let reals: String = x[..kept].iter().map(|v| format!("{v:real$.13e}")).collect();
        format!("{:id$}{reals}\n", n + 1)
    };
    let elements = "1 1 1 2 4 3 5 6 8 7\n";
    for (id, real) in [(9, 21), (8, 20)] {
        let nodes: String = points.iter().enumerate().map(|row_of| row(row_of, id, real)).collect();
        let lists = read("nwrite", &nodes, elements, None).unwrap();
        assert_eq!(lists.mesh.coordinates, points, "{id}");
        assert!(
            lists.warnings[0]
                .ends_with("4 rows have blank coordinates, which are 0 in the columns of NWRITE")
        );
        let gap = nodes.replacen(
            &format!("{:id$}{:real$.13e}{:real$.13e}\n", 4, 1.0, 1.0),
            &format!("{:id$}{:real$}{:real$.13e}\n", 4, "", 1.0),
            1,
        );
        assert_eq!(read("gap", &gap, elements, None).unwrap().mesh.coordinates[3], [0.0, 1.0, 0.0]);
    }
    let free: String = points.iter().enumerate().map(|row_of| row(row_of, 3, 21)).collect();
    let expected = "NODECOORD.DAT:1: columns of a node: found 1, expected 4 (id x y z)";
    assert_eq!(refused("free", &free, elements, None), expected);
}

#[test]
fn rejects_rotated_coordinate_systems() {
    let plain = brick_nodes();
    for system in ["1", "2", "11"] {
        let nodes =
            format!(" LIST ALL SELECTED NODES.   DSYS=      {system}\n\n   NODE   X   Y   Z\n{plain}");
        let error = refused("dsys", &nodes, &elements(), None);
        assert!(error.starts_with(&format!(
            "NODECOORD.DAT:1: coordinate system: found DSYS = {system}, expected DSYS = 0"
        )));
    }
    let nodes = format!(
        " LIST ALL SELECTED NODES.   DSYS=      0\n SORT TABLE ON  NODE  NODE  NODE\n\n   NODE   X   Y   Z\n{plain}"
    );
    assert!(read("dsys_0", &nodes, &elements(), None).unwrap().warnings.is_empty());
}

#[test]
fn the_scene_may_tell_the_columns() {
    let text = format!("7 {}\n3 {}\n", element_nodes(1), element_nodes(13));
    let layout = ListLayout { columns: ElementColumns::MaterialNodes, material: 9 };
    let lists = read_as("given_mat", &brick_nodes(), &text, None, layout).unwrap();
    assert_eq!((lists.mesh.materials, lists.mesh.element_ids), (vec![7, 3], vec![1, 2]));
    let layout = ListLayout { columns: ElementColumns::IdNodes, material: 9 };
    let lists = read_as("given_id", &brick_nodes(), &text, None, layout).unwrap();
    assert_eq!((lists.mesh.materials, lists.mesh.element_ids), (vec![9, 9], vec![7, 3]));
    assert!(lists.warnings.is_empty());
    let layout = ListLayout { columns: ElementColumns::IdMaterialNodes, material: 1 };
    let error = read_as("given_wrong", &brick_nodes(), &text, None, layout).unwrap_err();
    let expected = "ELEMENTNUM.DAT:1: columns of an element: found 21, and 42 with the lines up to 2, \
                    expected 22 (id mat n1…n20)";
    assert_eq!(error, expected);
}

#[test]
fn lists_as_the_macros_write_them() {
    let whole = |text: &str| format!("{:>10}", format!("{text}."));
    let mut nodes = String::new();
    for row in brick_nodes().lines() {
        let fields: Vec<&str> = row.split(' ').collect();
        nodes += &whole(fields[0]);
        for value in &fields[1..] {
            let (mantissa, exponent) = (value.parse::<f64>().unwrap() / 1e4, 4);
            nodes += &format!("{:>26}", format!("{mantissa:.17}E+{exponent:02}"));
        }
        nodes += "\n";
    }
    let mut two_lines = String::new();
    for row in elements().lines() {
        let fields: Vec<String> = row.split(' ').map(whole).collect();
        two_lines += &format!("{}\n{}\n", fields[..12].concat(), fields[12..].concat());
    }
    let dof = "        5.  1.   0.00000000000000000E+00\n      112.  3.  -0.15000000000000000E-02\n";
    let lists = read("macros", &nodes, &two_lines, Some(dof)).unwrap();
    let plain = read("macros_plain", &brick_nodes(), &elements(), Some("5 1\n112 3 -1.5e-3\n")).unwrap();
    assert_eq!(lists.mesh.connectivity, plain.mesh.connectivity);
    assert_eq!((lists.mesh.node_ids, lists.mesh.element_ids), (plain.mesh.node_ids, plain.mesh.element_ids));
    assert_eq!(lists.constraints, plain.constraints);
    for (a, b) in lists.mesh.coordinates.as_flattened().iter().zip(plain.mesh.coordinates.as_flattened()) {
        assert!((a - b).abs() <= 1e-15 * b.abs(), "{a} {b}");
    }
}

#[test]
fn elements_of_several_lines() {
    let plain = read("lines_plain", &brick_nodes(), &elements(), None).unwrap();
    for per_line in [2, 5, 8, 10, 11, 12] {
        let mut text = String::new();
        for row in elements().lines() {
            let fields: Vec<&str> = row.split(' ').collect();
            for piece in fields.chunks(per_line) {
                text += &(piece.join("  ") + "\n");
            }
        }
        let split = read(&format!("lines_{per_line}"), &brick_nodes(), &text, None).unwrap();
        assert_eq!(split, plain, "{per_line} per line");
    }
}

#[test]
fn faults_of_the_node_list() {
    let bad = |name: &str, from: &str, to: &str| {
        refused(name, &brick_nodes().replacen(from, to, 1), &elements(), None)
    };
    assert_eq!(
        bad("real", "14.5 196 -14", "14.5 1.9.6 -14"),
        "NODECOORD.DAT:19: coordinate y: found \"1.9.6\", expected a number"
    );
    assert_eq!(
        bad("nan", "14.5 196 -14", "14.5 196 NaN"),
        "NODECOORD.DAT:19: coordinate z: found \"NaN\", expected a finite number"
    );
    assert_eq!(
        bad("overflow", "14.5 196", "1e400 196"),
        "NODECOORD.DAT:19: coordinate x: found \"1e400\", expected a finite number"
    );
    assert_eq!(
        bad("id", "14 14.5", "14.5 14.5"),
        "NODECOORD.DAT:19: node number: found \"14.5\", expected a whole number of 0 or more"
    );
    assert_eq!(
        bad("width", "14 14.5 196", "14 14.5"),
        "NODECOORD.DAT:19: columns of a node: found 3, expected 4 (id x y z)"
    );
    assert_eq!(
        bad("twice", "14 14.5", "20 14.5"),
        "NODECOORD.DAT:19: node 20: found it again after line 13, expected each number once"
    );
    assert_eq!(
        bad("rotated", "14.5 196 -14", "14.5 196 -14 0 30 0"),
        "NODECOORD.DAT:19: nodal rotation: found 30, expected 0 (global directions)"
    );
    let none = "expected at least 4 rows of id x y z";
    assert_eq!(refused("empty", "", &elements(), None), format!("NODECOORD.DAT: nodes: found none, {none}"));
    assert_eq!(
        refused("header", "! only this\nID X Y Z\n", &elements(), None),
        format!("NODECOORD.DAT: nodes: found none, {none}")
    );
}

#[test]
fn faults_of_the_element_list() {
    let bad = |name: &str, from: &str, to: &str| {
        refused(name, &brick_nodes(), &elements().replacen(from, to, 1), None)
    };
    assert_eq!(
        bad("absent", " 111 112\n", " 111 113\n"),
        "ELEMENTNUM.DAT:2: element 3, node n20: found 113, expected a node of the node list"
    );
    assert_eq!(
        bad("dropped", "8 9 10", "8 0 10"),
        "ELEMENTNUM.DAT:1: element 7: found no node Q, and other mid-side nodes are there, expected all mid-side nodes \
         of an element, or none"
    );
    assert_eq!(
        bad("not_whole", "8 9 10", "8 9x 10"),
        "ELEMENTNUM.DAT:1: element 7, node n9: found \"9x\", expected a whole number of 0 or more"
    );
    assert_eq!(
        bad("material", "7 2 ", "7 -2 "),
        "ELEMENTNUM.DAT:1: material of element 7: found \"-2\", expected a whole number of 0 or more"
    );
    assert_eq!(
        bad("element_twice", "\n3 1", "\n7 1"),
        "ELEMENTNUM.DAT:2: element 7: found it again after line 1, expected each number once"
    );
    assert_eq!(
        bad("truncated", " 109 110 111 112\n", "\n"),
        "ELEMENTNUM.DAT:2: columns of the last element: found 18 and the end of the file (a truncated element), \
         expected 22 (id mat n1…n20)"
    );
    assert_eq!(
        bad("wide", " 112\n", " 112 5\n"),
        "ELEMENTNUM.DAT:2: columns of an element: found 23, expected 22 (id mat n1…n20)"
    );
    // The first element lacks a node; most lines still have 22 columns.
    let narrow = elements().replacen(" 20\n", "\n", 1) + &elements().replace("7 2 ", "8 2 ");
    assert_eq!(
        refused("narrow", &brick_nodes(), &narrow, None),
        "ELEMENTNUM.DAT:1: columns of an element: found 21, and 43 with the lines up to 2, expected 22 (id mat n1…n20)"
    );
    let none = "ELEMENTNUM.DAT: elements: found none, expected at least one row of id mat n1…n20";
    assert_eq!(refused("no_elements", &brick_nodes(), "\r\n# nothing\r\n", None), none);
}

#[test]
fn bricks_with_repeated_or_missing_nodes() {
    let forms = [
        (ElementKind::Wedge15, [1, 2, 3, 3, 5, 6, 7, 7, 9, 10, 3, 12, 13, 14, 7, 16, 17, 18, 19, 19]),
        (ElementKind::Pyramid13, [1, 2, 3, 4, 5, 5, 5, 5, 9, 10, 11, 12, 5, 5, 5, 5, 17, 18, 19, 20]),
        (ElementKind::Tet10, [1, 2, 3, 3, 5, 5, 5, 5, 9, 10, 3, 12, 5, 5, 5, 5, 17, 18, 19, 19]),
    ];
    for (kind, nodes) in forms {
        let text = |nodes: &[u32]| nodes.iter().map(u32::to_string).collect::<Vec<_>>().join(" ");
        let lists = read(kind.name(), &brick_nodes(), &format!("4 1 {}\n", text(&nodes)), None).unwrap();
        assert_eq!((lists.mesh.connectivity.kind(0), lists.mesh.node_count()), (kind, kind.node_count()));
        let corners = text(&nodes[..8]);
        for row in [format!("4 1 {corners}{}\n", " 0".repeat(12)), format!("4 1 {corners}\n")] {
            let lists = read(kind.name(), &brick_nodes(), &row, None).unwrap();
            assert_eq!(lists.mesh.connectivity.kind(0), kind.linear());
        }
    }
    let message = refused("folded", &brick_nodes(), &elements().replacen("3 4 5", "3 3 5", 1), None);
    let expected = "ELEMENTNUM.DAT:1: element 7: found node 3 more than once, expected different nodes, or those of a \
                    wedge (K = L, O = P), a pyramid (M = N = O = P) or a tetrahedron (both)";
    assert_eq!(message, expected);
}

#[test]
fn faults_of_the_constraint_list() {
    let bad = |name: &str, text: &str| refused(name, &brick_nodes(), &elements(), Some(text));
    assert_eq!(
        bad("dof_absent", "5 1 0\n99 1 0\n"),
        "DOF.DAT:2: constrained node: found 99, expected a node of the node list"
    );
    for (name, direction) in [("rotx", "ROTX"), ("four", "4"), ("zero", "0")] {
        assert_eq!(
            bad(name, &format!("5 {direction} 0\n")),
            format!("DOF.DAT:1: direction: found \"{direction}\", expected 1, 2, 3, UX, UY, UZ or ALL")
        );
    }
    assert_eq!(
        bad("two_values", "5 UX 0\n6 1 0\n5 1 0.25\n"),
        "DOF.DAT:3: constraint of node 5 in x: found 0.25 after 0 on line 1, expected one value"
    );
    assert_eq!(bad("value", "5 1 0,5\n"), "DOF.DAT:1: row: found \"0,5\", expected a decimal point");
    assert_eq!(bad("imaginary", "5 1 0 5\n"), "DOF.DAT:1: imaginary part: found 5, expected 0");
    assert_eq!(
        bad("value_text", "5 1 o.o\n"),
        "DOF.DAT:1: prescribed value: found \"o.o\", expected a number"
    );
    assert_eq!(
        bad("dof_width", "5\n"),
        "DOF.DAT:1: columns of a constraint: found 1, expected 3 (node dir value) or 2 (node dir)"
    );
}

#[test]
fn constraints_given_twice_alike_are_one() {
    let lists = read("alike", &brick_nodes(), &elements(), Some("NODE LABEL REAL IMAG\n5 ALL\n5 ux 0. 0.\n"))
        .unwrap();
    assert_eq!(lists.constraints.len(), 3);
    let empty = read("no_dof", &brick_nodes(), &elements(), Some("! none\n")).unwrap();
    assert!(empty.constraints.is_empty());
}

#[test]
fn a_missing_file_is_named() {
    let dir = folder("missing");
    let file = dir.join("NODECOORD.DAT");
    let error = read_lists(&file, &file, None, &ListLayout::default()).unwrap_err();
    let expected = format!("{}: node list: found no such file, expected a readable file", file.display());
    assert_eq!(error.to_string(), expected);
    let error = read_lists(&dir, &file, None, &ListLayout::default()).unwrap_err();
    assert!(error.to_string().contains("found a directory, expected a regular file"), "{error}");
    std::fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn drops_unused_nodes_with_warning() {
    let plain = read("unused_not", &brick_nodes(), &elements(), Some("112 1 0\n1 ALL\n")).unwrap();
    let nodes = "900 0 0 0\n".to_string() + &brick_nodes();
    let lists = read("unused", &nodes, &elements(), Some("900 1 0\n112 1 0\n1 ALL\n")).unwrap();
    assert_eq!(lists.warnings, ["NODECOORD.DAT: node 900 belongs to no element and is left out"]);
    assert_eq!((lists.mesh, lists.constraints), (plain.mesh.clone(), plain.constraints.clone()));
    let nodes = nodes + "901 0 0 0\n";
    let lists = read("unused_2", &nodes, &elements(), Some("112 1 0\n1 ALL\n901 ALL\n")).unwrap();
    let expected = "NODECOORD.DAT: 2 nodes belong to no element and are left out: 900, 901";
    assert_eq!(lists.warnings, [expected]);
    assert_eq!((lists.mesh, lists.constraints), (plain.mesh, plain.constraints));
}

#[test]
fn reads_reformatted_mesh_identically() {
    let embankment = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/fem/E3_embankment_patch");
    let read = |dir: &Path| {
        let (n, e, d) = (dir.join("NODECOORD.DAT"), dir.join("ELEMENTNUM.DAT"), dir.join("DOF.DAT"));
        read_lists(&n, &e, Some(&d), &ListLayout::default()).unwrap()
    };
    let plain = read(&embankment);
    assert_eq!((plain.mesh.node_count(), plain.mesh.element_count()), (2593, 480));
    assert_eq!((plain.constraints.len(), plain.warnings.len()), (1547, 0));

    let dir = folder("mangled");
    crate::write::ansys_lists::write_lists(&plain.mesh, &plain.constraints, &dir).unwrap();
    assert_eq!(read(&dir), plain, "our own writer");
    let path = |name: &str| dir.join(name);
    for (name, header) in
        [("NODECOORD.DAT", "NODE  X  Y  Z"), ("ELEMENTNUM.DAT", "ELEM NODES"), ("DOF.DAT", "NODE LABEL REAL")]
    {
        let text = std::fs::read_to_string(path(name)).unwrap();
        let mut mangled = format!("\u{feff}! mangled\r\n{header}\r\n");
        for row in text.lines() {
            let fields: Vec<String> = row
                .split_whitespace()
                .map(|f| if name == "ELEMENTNUM.DAT" { f.to_string() } else { f.replace('e', "D") })
                .collect();
            let per_line = if name == "ELEMENTNUM.DAT" { 8 } else { 4 };
            for piece in fields.chunks(per_line) {
                mangled += &format!(" {}\r\n", piece.join(" , "));
            }
            mangled += "\r\n";
        }
        let mangled = match name {
            "DOF.DAT" => mangled.replace(" , 1 , ", " , UX , ").replace(" , 3 , ", " , uz , "),
            _ => mangled,
        };
        std::fs::write(path(name), mangled).unwrap();
    }
    assert_eq!(read(&dir), plain);
    std::fs::remove_dir_all(&dir).unwrap();
}
