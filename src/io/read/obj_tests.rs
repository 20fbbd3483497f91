use super::*;
use trackbed_dem::shape::polyhedron::Polyhedron;

fn read(text: &str) -> Result<Surface, String> {
    parse(Path::new("s.obj"), text).map_err(|e| e.to_string())
}

const CUBE: &str = "# a cube\nmtllib c.mtl\no cube\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 0.2 0.3 0.4\nv 0 1 0\n\
v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1 # last\nvt 0 0\nvn 0 0 1\ns off\nusemtl stone\n";

#[test]
fn reads_all_corner_formats() {
    let faces = [[1, 4, 3, 2], [5, 6, 7, 8], [1, 2, 6, 5], [2, 3, 7, 6], [3, 4, 8, 7], [4, 1, 5, 8]];
    let write = |form: &dyn Fn(i32) -> String| {
        faces.iter().fold(CUBE.to_string(), |text, f| {
            text + "f " + &f.iter().map(|v| form(*v)).collect::<Vec<_>>().join(" ") + "\n"
        })
    };
    let plain = read(&write(&|v| v.to_string())).unwrap();
    assert_eq!((plain.vertices.len(), plain.triangles.len()), (8, 12));
    assert!((Polyhedron::new(&plain).unwrap().moments().volume - 1.0).abs() < 1e-14);
    assert_eq!(plain.topology().unwrap().turned_edges, 0);
    assert_eq!(read(&write(&|v| format!("{v}/1"))).unwrap(), plain);
    assert_eq!(read(&write(&|v| format!("{v}//1"))).unwrap(), plain);
    assert_eq!(read(&write(&|v| format!("{v}/1/1"))).unwrap(), plain);
    // Backward indices, and faces over two lines.
    assert_eq!(read(&write(&|v| (v - 9).to_string())).unwrap(), plain);
    assert_eq!(read(&write(&|v| v.to_string()).replace(" 6 ", " 6 \\\n ")).unwrap(), plain);
    assert_eq!(read(&write(&|v| v.to_string()).replace('\n', "\r\n")).unwrap(), plain);
}

#[test]
fn splits_pentagon_into_three_triangles() {
    let surface = read("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 2 0\nv -1 1 0\nf 1 2 3 4 5\n").unwrap();
    assert_eq!(surface.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
}

#[test]
fn forward_indices_allowed_backward_rejected() {
    assert_eq!(read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").unwrap().triangles, [[0, 1, 2]]);
    assert_eq!(
        read("v 0 0 0\nf -1 -2 -3\n").unwrap_err(),
        "s.obj:2: corner of a face: found \"-2\", expected the number of one of the 1 vertices so far"
    );
}

#[test]
fn damaged_files_are_named_by_line() {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (text, error) in [
        ("f 1 2 4\n", "s.obj:4: corner of a face: found 4, expected the number of one of the 3 vertices"),
        ("f 1 2\n", "s.obj:4: face: found 2 corners, expected at least three"),
        ("v 1 2\n", "s.obj:4: vertex: found 2 numbers, expected x y z"),
        ("v 1 2 x\n", "s.obj:4: coordinate z: found \"x\", expected a finite number"),
        ("v 1 inf 0\n", "s.obj:4: coordinate y: found \"inf\", expected a finite number"),
        ("", "s.obj: faces: found none, expected at least one"),
    ] {
        assert_eq!(read(&format!("{triangle}{text}")).unwrap_err(), error);
    }
    for corner in ["0", "1/0", "1/x/", "1/1/1/1", "a", "1.0", "//1"] {
        let error = read(&format!("{triangle}f {corner} 2 3\n")).unwrap_err();
        assert!(error.starts_with(&format!("s.obj:4: corner of a face: found \"{corner}\"")), "{error}");
    }
    let error = read(&format!("{triangle}curv2 1 2\n")).unwrap_err();
    assert!(error.starts_with("s.obj:4: statement: found \"curv2\", expected v, f"), "{error}");
}
