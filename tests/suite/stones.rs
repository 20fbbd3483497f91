//! `trackbed stone`: surfaces, libraries, rejected input.

use super::support::{Folder, GRAINS, repository, trackbed, trackbed_in};
use std::fs;

fn surface(name: &str) -> String {
    repository().join("tests/data/surface").join(name).display().to_string()
}

fn scene(library: &str) -> String {
    let (head, tail) = GRAINS.split_once("[[grains]]").unwrap();
    let tail = &tail[tail.find("[[walls]]").unwrap()..];
    let grains = format!(
        "[[grains]]\nname = \"stones\"\nshape = \"clump\"\nlibrary = \"{library}\"\nmaterial = \"stone\"\ncount = 6\n\
         size = [0.03, 0.05]\nfill = {{ low = [-0.1, -0.1, 0.0], high = [0.1, 0.1] }}\n\n"
    );
    format!("{head}{grains}{tail}")
}

#[test]
fn library_from_surface_runs() {
    let folder = Folder::new("stone_make");
    let stone = surface("stone.stl");
    let make = ["stone", "make", stone.as_str(), "--spheres", "6", "--out", "stones.toml"];
    let made = trackbed_in(folder.path(), make).good();
    assert!(
        made.stdout.contains("stone: 6 spheres, volume 0.9") && made.stdout.contains("stones.toml written"),
        "{made:?}"
    );
    let info = trackbed_in(folder.path(), ["stone", "info", "stones.toml"]).good().stdout;
    assert!(info.contains("0 'stone': clump, 6 spheres, sieve size 1.000000 m"), "{info}");
    folder.write("scene.toml", &scene("stones.toml"));
    let ran = trackbed_in(folder.path(), ["run", "scene.toml", "--quiet"]).good();
    assert!(ran.stderr.is_empty(), "{ran:?}");

    let before = fs::read_to_string(folder.join("stones.toml")).unwrap();
    let again = trackbed_in(folder.path(), make);
    assert_eq!(
        (again.code, again.stderr.as_str()),
        (
            2,
            "error: --out: found stones.toml, which exists, expected a new file, or --force to overwrite it\n"
        )
    );
    assert_eq!(fs::read_to_string(folder.join("stones.toml")).unwrap(), before);
    let forced = ["stone", "make", &stone, "--spheres", "3", "--out", "stones.toml", "--force"];
    trackbed_in(folder.path(), forced).good();
    assert_ne!(fs::read_to_string(folder.join("stones.toml")).unwrap(), before);
}

#[test]
fn rejects_stone_in_two_pieces() {
    let folder = Folder::new("stone_pieces");
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let mut text = String::new();
    for shift in [0.0, 5.0] {
        text += "solid tetrahedron\n";
        for face in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in face.map(|k: usize| corners[k]) {
                text += &format!("vertex {} {y} {z}\n", x + shift);
            }
            text += "endloop\nendfacet\n";
        }
        text += "endsolid\n";
    }
    folder.write("two.stl", &text);
    let info = trackbed_in(folder.path(), ["stone", "info", "two.stl"]).good().stdout;
    assert!(info.contains("note: 2 separate pieces"), "{info}");
    let outcome = trackbed_in(folder.path(), ["stone", "make", "two.stl", "--spheres", "3"]);
    let sentence = "error: two.stl: surface: found 2 separate pieces, expected one, as a stone is in one piece. \
                    Write each stone into its own file\n";
    assert_eq!((outcome.code, outcome.stderr.as_str()), (2, sentence));
}

#[test]
fn random_stones_and_their_surfaces() {
    let folder = Folder::new("stone_random");
    fs::create_dir(folder.join("stl")).unwrap();
    let command = |out: &'static str| {
        ["stone", "random", "--count", "2", "--seed", "9", "--spheres", "12", "--as", "bonded", "--out", out]
    };
    let first = trackbed_in(folder.path(), command("a.toml").into_iter().chain(["--surfaces", "stl"])).good();
    assert!(
        first.stdout.contains("random 2: 12 spheres, ") && first.stdout.contains("porosity"),
        "{first:?}"
    );
    trackbed_in(folder.path(), command("b.toml")).good();
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    assert_eq!(
        read("a.toml").lines().skip(3).collect::<Vec<_>>(),
        read("b.toml").lines().skip(3).collect::<Vec<_>>()
    );
    assert!(read("a.toml").contains("bonds = [") && read("a.toml").contains("density_factor = "));
    let info = trackbed_in(folder.path(), ["stone", "info", "a.toml"]).good().stdout;
    assert!(info.contains("1 'random 2': bonded, ") && info.contains("12 spheres"), "{info}");
    let info = trackbed_in(folder.path(), ["stone", "info", "stl/stone_2.stl"]).good().stdout;
    assert!(
        info.contains("open                       0") && info.contains("sieve size            1.000000 m"),
        "{info}"
    );
    let again = trackbed_in(folder.path(), command("c.toml").into_iter().chain(["--surfaces", "stl"]));
    assert_eq!(again.code, 2, "{again:?}");
    assert!(!folder.join("c.toml").exists());
}

#[test]
fn rejects_bad_input_in_one_line() {
    let folder = Folder::new("stone_bad");
    folder.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("cut.stl", "solid x\nfacet normal 0 0 0\nouter loop\nvertex 0 0\n");
    let stone = surface("stone.stl");
    let out = ["--out", "x.toml"];
    for (arguments, error) in [
        (
            vec!["make", "none.stl", "--spheres", "3"],
            "none.stl: STL surface: found no such file, expected a readable file",
        ),
        (
            vec!["make", "a.ply", "--spheres", "3"],
            "a.ply: file extension: found \".ply\", expected .stl, .obj",
        ),
        (
            vec!["make", "cut.stl", "--spheres", "3"],
            "cut.stl:4: vertex: found 2 numbers, expected three numbers",
        ),
        (vec!["make", "open.obj", "--spheres", "3"], "open.obj: surface: found the surface is open: 3 edges"),
        (vec!["make", &stone, "--spheres", "0"], "--spheres: found 0, expected 1 to 200"),
        (
            vec!["make", &stone, "--spheres", "9999", "--as", "bonded"],
            "--spheres: found 9999, expected 1 to 2000",
        ),
        (vec!["make", &stone, "--spheres", "3", "--overhang=-1"], "--overhang: found -1, expected 0 to 1"),
        (
            vec!["make", &stone, "--spheres", "3", "--overhang", "1.5"],
            "--overhang: found 1.5, expected 0 to 1",
        ),
        (
            vec!["make", &stone, "--spheres", "3", "--gap", "0.1"],
            "--gap: found, but it has no effect without `--as bonded`",
        ),
        (
            vec!["make", &stone, "--spheres", "3", "--seed", "1"],
            "--seed: found, but it has no effect without `--as bonded`",
        ),
        (
            vec!["make", &stone, "--spheres", "3", "--as", "bonded", "--overhang", "0.1"],
            "--overhang: found, but it has no effect without `--as clump`",
        ),
        (
            vec!["make", &stone, "--spheres", "9", "--as", "bonded", "--gap", "0"],
            "stone 'stone': no chain of bonds leads from sphere 0",
        ),
        (vec!["random", "--count", "0", "--spheres", "3"], "--count: found 0, expected 1 to 10000"),
        (
            vec!["random", "--count", "1", "--spheres", "3", "--flatness", "0.9:0.5"],
            "--flatness: found 0.9:0.5, expected a number or a range low:high between 0.05 and 1",
        ),
        (
            vec!["random", "--count", "1", "--spheres", "3", "--angularity", "sharp"],
            "--angularity: found sharp",
        ),
        (
            vec!["random", "--count", "1", "--spheres", "3", "--surfaces", "nowhere"],
            "--surfaces: found nowhere",
        ),
    ] {
        let outcome =
            trackbed_in(folder.path(), ["stone"].into_iter().chain(arguments.iter().copied()).chain(out));
        assert_eq!(outcome.code, 2, "{arguments:?}: {outcome:?}");
        assert!(outcome.stderr.contains(error), "{arguments:?}: {}", outcome.stderr);
        assert!(!folder.join("x.toml").exists(), "{arguments:?}");
    }
}

#[test]
fn rejects_unreadable_and_unwritable_files() {
    let folder = Folder::new("stone_files");
    folder.write("nothing.toml", "name = \"a\"\nsource = \"b\"\nstones = []\n");
    let stone = surface("stone.stl");
    for (arguments, error) in [
        (
            ["make", stone.as_str(), "--spheres", "3", "--out", "no/x.toml"],
            "--out: found no/x.toml, expected a file in an existing directory",
        ),
        (
            ["make", stone.as_str(), "--spheres", "3", "--out", "stones"],
            "--out: found stones, expected a file name",
        ),
    ] {
        let outcome = trackbed_in(folder.path(), ["stone"].into_iter().chain(arguments));
        assert!(outcome.code == 2 && outcome.stderr.contains(error), "{outcome:?}");
    }
    let outcome = trackbed_in(folder.path(), ["stone", "info", "nothing.toml"]);
    assert!(outcome.code == 2 && outcome.stderr.contains("expected at least one stone"), "{outcome:?}");
}

/// Libraries in `inputs/data` equal the output of their commands, except last digits (compiler).
#[test]
fn shipped_libraries_match_their_commands() {
    let data = repository().join("inputs/data");
    let readme = fs::read_to_string(data.join("README.md")).unwrap();
    let folder = Folder::new("stone_shipped");
    let mut found = 0;
    for line in readme.lines().filter_map(|l| l.trim().strip_prefix("trackbed stone ")) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let name = *words.last().unwrap();
        trackbed_in(folder.path(), ["stone"].into_iter().chain(words)).good();
        let info = |file: &str| trackbed(["stone", "info", file]).good().stdout;
        let shipped = info(&data.join(name).display().to_string());
        assert_eq!(shipped, info(&folder.join(name).display().to_string()), "{name}");
        assert!(
            shipped.lines().count() >= 5 && shipped.matches("sieve size 1.000000 m").count() >= 3,
            "{shipped}"
        );
        found += 1;
    }
    assert_eq!(found, 4);
}

#[test]
fn a_library_of_polyhedra_is_measured() {
    let folder = Folder::new("stone_polyhedra");
    // Cube of 0.2 m dilated by 0.1 m: 0.4 m.
    let corners = (0..8).map(|k| {
        format!("[{}, {}, {}]", 0.2 * f64::from(k & 1), 0.1 * f64::from(k & 2), 0.05 * f64::from(k & 4))
    });
    let corners = corners.collect::<Vec<_>>().join(", ");
    let text = format!(
        "name = \"one\"\nsource = \"test\"\n\n[[stones]]\nname = \"cube\"\nradius = 0.1\ncorners = [{corners}]\n"
    );
    fs::write(folder.join("cube.toml"), text).unwrap();
    let info = trackbed_in(folder.path(), ["stone", "info", "cube.toml"]).good().stdout;
    // Steiner: a³ + 6 a² r + 3 π a r² + 4/3 π r³.
    let pi = std::f64::consts::PI;
    let volume = (0.008 + 6.0 * 0.04 * 0.1 + 3.0 * pi * 0.2 * 0.01 + 4.0 / 3.0 * pi * 0.001) / 0.064;
    let expected = format!(
        "0 'cube': polyhedron, 8 corners, 6 faces, sieve size 0.400000 m; for sieve size 1 m: volume {volume:.6} m³"
    );
    assert!(info.contains(&expected), "{info}\n{expected}");
    let shipped = repository().join("inputs/data/polyhedra.toml");
    let info = trackbed(["stone", "info", &shipped.display().to_string()]).good().stdout;
    assert_eq!(info.matches(": polyhedron, ").count(), 5, "{info}");
}
