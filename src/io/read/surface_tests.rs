use super::*;
use std::path::PathBuf;
use trackbed_dem::shape::polyhedron::Polyhedron;

struct File(PathBuf);

impl File {
    fn new(name: &str, content: impl AsRef<[u8]>) -> File {
        let path = std::env::temp_dir().join(format!("trackbed-{}-{name}", std::process::id()));
        std::fs::write(&path, content).unwrap();
        File(path)
    }
    fn read(&self) -> Result<Surface, String> {
        let name = self.0.file_name().unwrap().to_string_lossy().into_owned();
        read_surface(&self.0)
            .map_err(|e| e.to_string().replace(&self.0.display().to_string(), &name[name.len() - 5..]))
    }
}

impl Drop for File {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

const TET: &str = "4 4\n0 0 0\n1.0D0 0 0\n0 1 0\n0, 0, 1\n1 2 3\n1 2 4\n1 3 4\n2 3 4\n";

#[test]
fn reads_plain_list_of_any_winding() {
    let one = File::new("a.dat", TET).read().unwrap();
    assert_eq!(one.triangles, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]);
    let zero = TET.replace("1 2 3\n1 2 4\n1 3 4\n2 3 4", "0 1 2\n0 1 3\n0 2 3\n1 2 3");
    assert_eq!(File::new("b.tri", zero).read().unwrap(), one);
    // Ascending ids carry no winding.
    assert!(one.topology().unwrap().turned_edges > 0);
    assert!((Polyhedron::new(&one).unwrap().moments().volume - 1.0 / 6.0).abs() < 1e-15);
    let open = TET.replace("4 4\n", "4 3\n").replace("2 3 4\n", "");
    assert_eq!(File::new("c.txt", open).read().unwrap().topology().unwrap().open_edges, 3);
}

#[test]
fn damaged_lists_are_named_by_line() {
    for (k, (old, new, error)) in [
        ("4 4\n", "4\n", "d.dat:1: numbers of vertices and triangles: found 1 columns, expected two counts"),
        ("4 4\n", "4 5\n", "d.dat: rows: found 8, expected 4 vertices and 5 triangles, as in line 1"),
        ("0 1 0\n", "0 1\n", "d.dat:4: vertex: found 2 columns, expected x y z"),
        ("0 1 0\n", "0 1 1e999\n", "d.dat:4: coordinate z: found \"1e999\", expected a finite number"),
        ("1 2 4\n", "1 2 5\n", "d.dat:7: vertex of a triangle: found 5, expected 1 to 4"),
        ("1 2 4\n", "1 0 4\n", "d.dat:7: vertex of a triangle: found 4, expected 0 to 3"),
        ("1 2 4\n", "1 2 4 4\n", "d.dat:7: triangle: found 4 columns, expected three vertex numbers"),
        (
            "1 2 4\n",
            "1 2 -4\n",
            "d.dat:7: vertex of a triangle: found \"-4\", expected a whole number of 0 or more",
        ),
    ]
    .into_iter()
    .enumerate()
    {
        assert!(TET.contains(old));
        assert_eq!(File::new(&format!("{k}d.dat"), TET.replacen(old, new, 1)).read().unwrap_err(), error);
    }
    let error = File::new("e.dat", "# nothing\n").read().unwrap_err();
    assert!(error.contains("no rows of numbers"), "{error}");
    let error = File::new("f.ply", "ply\n").read().unwrap_err();
    assert!(error.contains("found \".ply\", expected .stl, .obj"), "{error}");
}

#[test]
fn merges_rounded_stl_vertices() {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut text = "solid t\n".to_string();
    for (i, t) in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]].iter().enumerate() {
        text += "facet normal 0 0 0\nouter loop\n";
        for v in t {
            let p: [f64; 3] = points[*v].map(|x: f64| x + 1e-8 * i as f64);
            text += &format!("vertex {} {} {}\n", p[0], p[1], p[2]);
        }
        text += "endloop\nendfacet\n";
    }
    let surface = File::new("g.stl", text).read().unwrap();
    assert_eq!((surface.vertices.len(), surface.triangles.len()), (4, 4));
    assert!((Polyhedron::new(&surface).unwrap().moments().volume - 1.0 / 6.0).abs() < 1e-6);
}

#[test]
fn comment_states_unit() {
    let unit = |name: &str, content: &str| {
        let file = File::new(name, content);
        surface_unit(&file.0).map(|error| error.to_string())
    };
    let error = unit("u.obj", "# Units: mm\nv 0 0 0\n").unwrap();
    assert!(
        error.contains("u.obj:1: unit of the comment: found mm in \"# Units: mm\", expected metres"),
        "{error}"
    );
    assert!(error.ends_with(". Set scale = 0.001, or convert the file."), "{error}");
    assert!(unit("v.dat", &format!("! X [in] Y [in] Z [in]\n{TET}")).unwrap().contains("found in in"));
    for content in ["# ballast of 31.5 mm\nv 0 0 0\n", "# units: m\n", "v 0 0 0\n"] {
        assert_eq!(unit("w.obj", content), None);
    }
}

#[test]
fn rejects_coordinates_whose_moments_overflow() {
    for (name, text) in [
        ("big.obj", "v 0 0 0\nv 1e90 0 0\nv 0 1e90 0\nf 1 2 3\n"),
        ("big.dat", "3 1\n0 0 0\n1e90 0 0\n0 1e90 0\n1 2 3\n"),
    ] {
        let refused = File::new(name, text).read().unwrap_err();
        assert!(refused.ends_with("vertices: found 1e90 m, expected at most 1e50 m"), "{refused}");
    }
    File::new("fits.obj", "v 0 0 0\nv 1e49 0 0\nv 0 1e49 0\nf 1 2 3\n").read().unwrap();
}
