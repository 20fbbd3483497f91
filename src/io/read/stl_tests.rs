use super::*;

/// Triangles of a tetrahedron.
const TET: [[[f32; 3]; 3]; 4] = [
    [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
];

fn ascii() -> String {
    let mut text = "solid a tetrahedron\n".to_string();
    for t in TET {
        text += " facet normal 0 0 0\n  outer loop\n";
        t.iter().for_each(|[x, y, z]| text += &format!("   vertex {x:e} {y:e} {z:e}\n"));
        text += "  endloop\n endfacet\n";
    }
    text + "endsolid a tetrahedron\n"
}

fn binary_file(title: &str) -> Vec<u8> {
    let mut bytes = title.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4_u32.to_le_bytes());
    for t in TET {
        bytes.extend([0; 12]);
        t.iter().flatten().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([7, 0]);
    }
    bytes
}

fn read(bytes: &[u8]) -> Result<Surface, String> {
    parse(Path::new("s.stl"), bytes).map_err(|e| e.to_string())
}

#[test]
fn reads_text_and_binary_identically() {
    let text = read(ascii().as_bytes()).unwrap();
    assert_eq!((text.vertices.len(), text.triangles.len()), (12, 4));
    assert_eq!(text.corners(2)[1].z, 0.0);
    assert_eq!(text.corners(2)[2].z, 1.0);
    for title in ["made by a program", "solid made by a program", "solid facet normal"] {
        assert_eq!(read(&binary_file(title)).unwrap(), text, "{title}");
    }
    let loud = ascii().to_uppercase().replace('\n', "\r\n");
    assert_eq!(read(loud.as_bytes()).unwrap(), text);
    assert_eq!(read(format!("\u{feff}{loud}").as_bytes()).unwrap(), text);
    let twice = read((ascii() + "\n" + &ascii()).as_bytes()).unwrap();
    assert_eq!(twice.triangles.len(), 8);
    // A missing last line loses nothing.
    assert_eq!(read(ascii().replace("endsolid a tetrahedron", "").as_bytes()).unwrap(), text);
}

#[test]
fn damaged_text_is_named_by_line() {
    let broken = |old: &str, new: &str| read(ascii().replacen(old, new, 1).as_bytes()).unwrap_err();
    assert_eq!(
        broken("vertex 0e0 1e0 0e0", "vertex 0e0 1e0"),
        "s.stl:5: vertex: found 2 numbers, expected three numbers"
    );
    assert_eq!(
        broken("vertex 0e0 1e0 0e0", "vertex 0e0 one 0e0"),
        "s.stl:5: coordinate y: found \"one\", expected a finite number"
    );
    assert_eq!(
        broken("vertex 0e0 1e0 0e0", "vertex 0e0 1e0 nan"),
        "s.stl:5: coordinate z: found \"nan\", expected a finite number"
    );
    assert_eq!(
        broken("   vertex 1e0 0e0 0e0\n", ""),
        "s.stl:6: statement: found \"endloop\", expected `vertex` and three numbers"
    );
    assert_eq!(
        broken("  endloop\n", "   vertex 1 1 1\n  endloop\n"),
        "s.stl:7: statement: found \"vertex 1 1 1\", expected `endloop` after three vertices"
    );
    let cut = &ascii()[..ascii().len() - 60];
    let error = read(cut.as_bytes()).unwrap_err();
    assert!(error.contains("expected"), "{error}");
    assert_eq!(
        read(b"solid nothing\nendsolid\n").unwrap_err(),
        "s.stl: triangles: found none, expected at least one"
    );
    assert_eq!(
        read(b"solid x\nfacet normal 0 0 0\n").unwrap_err(),
        "s.stl:2: statement: found the end of the file, expected `outer loop`"
    );
}

#[test]
fn rejects_binary_of_wrong_length() {
    for title in ["by a program", "solid by a program"] {
        let whole = binary_file(title);
        let error = read(&whole[..whole.len() - 10]).unwrap_err();
        assert!(
            error.starts_with("s.stl: length in bytes: found 274, expected 284 for the 4 triangles"),
            "{error}"
        );
    }
    let error = read(b"hello").unwrap_err();
    assert!(error.contains("found 5, expected text that begins with `solid`"), "{error}");
    let mut bad = binary_file("x");
    bad[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(read(&bad).unwrap_err(), "s.stl: vertex of triangle 1: found NaN, expected a finite number");
    let mut none = vec![b' '; 80];
    none.extend([0; 4]);
    assert_eq!(read(&none).unwrap_err(), "s.stl: triangles: found none, expected at least one");
    let error = read_stl(Path::new("/nowhere/s.stl")).unwrap_err().to_string();
    assert!(error.contains("found no such file"), "{error}");
}
