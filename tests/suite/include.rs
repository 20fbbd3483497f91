//! Scenes that include files.

use super::support::{Folder, results, run};
use std::fs;

const MATERIAL: &str = "[[material]]\nname = \"stone\"\ndensity = 2650\nstiffness = \"1 MN/m\"\nfriction = 0.5\nrestitution = 0.4\n";
const WALL: &str =
    "[[walls]]\nkind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = \"stone\"\n";
const GRAINS: &str = "[[grains]]\nname = \"g\"\nshape = \"sphere\"\nmaterial = \"stone\"\n\
                      spheres = [[0, 0, 0.03, 0.02], [0.1, 0, 0.04, 0.02]]\nvelocity = [0.3, 0, -1]\n";
const REST: &str = "[time]\nend = \"20 ms\"\n\n[output]\nframes = 2\nvtk = false\n";

fn written(name: &str, scene: &str, parts: &[(&str, &str)]) -> Folder {
    let folder = Folder::new(name);
    folder.write("scene.toml", scene);
    fs::create_dir_all(folder.join("parts")).unwrap();
    parts.iter().for_each(|(file, text)| {
        folder.write(&format!("parts/{file}"), text);
    });
    folder
}

#[test]
fn the_same_scene_in_pieces() {
    let whole = written("include_whole", &format!("{MATERIAL}\n{GRAINS}\n{WALL}\n{REST}"), &[]);
    let pieces = written(
        "include_pieces",
        &format!(
            "include = [\"parts/stone.toml\", \"parts/box.toml\"]\n\n[[material]]\nname = \"stone\"\nfriction = 0.5\n\n{GRAINS}\n\
             [output]\nframes = 2\n"
        ),
        &[
            // Byte order mark of Windows editors.
            ("stone.toml", &format!("\u{feff}{}", MATERIAL.replace("friction = 0.5", "friction = 0.1"))),
            ("box.toml", &format!("{WALL}\n{}", REST.replace("frames = 2", "frames = 7"))),
        ],
    );
    for folder in [&whole, &pieces] {
        run(&folder.join("scene.toml"), &folder.join("out"), &[]).good();
    }
    let [mut whole, mut pieces] = [&whole, &pieces].map(|folder| results(&folder.join("out")));
    assert!(whole.contains_key("history.csv"));
    for name in ["summary.json", "log.txt", "run.json", "end.state"] {
        assert!(whole.remove(name).is_some() && pieces.remove(name).is_some());
    }
    assert!(whole == pieces, "{:?} {:?}", whole.keys(), pieces.keys());
}

#[test]
fn faults_name_the_file() {
    let bad = MATERIAL.replace("friction = 0.5", "friction = -1");
    let cases: [(&str, &str, &str); 6] = [
        (
            "include = [\"parts/a.toml\"]",
            &bad,
            "parts/a.toml:5: material.0.friction: found -1, expected 0 or more",
        ),
        (
            "include = [\"parts/a.toml\"]",
            "[[material]]\nname = \"stone\"\ncolour = 1\n",
            "parts/a.toml:3: material.0.colour",
        ),
        ("include = [\"parts/a.toml\"]", "[[material]]\nname = \n", "parts/a.toml:2: syntax"),
        ("include = [\"parts/b.toml\"]", MATERIAL, "scene.toml:1: include.0: found"),
        (
            "include = \"parts/a.toml\"",
            MATERIAL,
            "scene.toml:1: include: found no list, expected a list of files",
        ),
        (
            "include = [\"parts/a.toml\"]",
            "include = []\n",
            "which includes files itself, expected a file without `include`",
        ),
    ];
    for (head, part, expected) in cases {
        let folder =
            written("include_bad", &format!("{head}\n{GRAINS}\n{WALL}\n{REST}"), &[("a.toml", part)]);
        let outcome = run(&folder.join("scene.toml"), &folder.join("out"), &[]);
        assert_eq!(outcome.code, 2, "{}", outcome.stderr);
        assert!(outcome.stderr.contains(expected), "{}\n{expected}", outcome.stderr);
        assert!(!folder.join("out").exists());
    }
}

#[test]
fn overrides_paths_and_changes() {
    let grains =
        GRAINS.replace("spheres = [[0, 0, 0.03, 0.02], [0.1, 0, 0.04, 0.02]]", "packing = \"two.csv\"");
    let scene = format!("include = [\"parts/grains.toml\"]\n{MATERIAL}\n{WALL}\n{REST}");
    let packing = "x [m],y [m],z [m],r [m]\n0,0,0.03,0.02\n0.1,0,0.04,0.02\n";
    let folder = written("include_paths", &scene, &[("grains.toml", &grains), ("two.csv", packing)]);
    let file = folder.join("scene.toml");
    run(&file, &folder.join("out"), &["grains.0.velocity=[0,0,-2]"]).good();
    let text = fs::read_to_string(folder.join("out/summary.json")).unwrap();
    assert!(text.contains("grains.0.velocity=[0,0,-2]"));
    let hash = |out: &str| {
        run(&file, &folder.join(out), &[]).good();
        let text = fs::read_to_string(folder.join(out).join("summary.json")).unwrap();
        serde_json::from_str::<serde_json::Value>(&text).unwrap()["scene_hash"].to_string()
    };
    let before = hash("first");
    folder.edit("parts/two.csv", "0.04", "0.05");
    let moved = hash("second");
    folder.edit("parts/grains.toml", "-1]", "-1.5]");
    let faster = hash("third");
    assert!(before != moved && moved != faster);
}

#[test]
fn other_files_by_an_override() {
    let scene = format!("include = [\"parts/one.toml\"]\n{GRAINS}\n{WALL}\n{REST}");
    let hard = MATERIAL.replace("1 MN/m", "2 MN/m");
    let two = format!(
        "[[material]]\nname = \"rubber\"\nstiffness = \"1 MN/m\"\nfriction = 0.5\nrestitution = 0.5\n\n{hard}"
    );
    let folder = written(
        "include_others",
        &scene,
        &[("one.toml", MATERIAL), ("two.toml", &two), ("same.toml", &hard)],
    );
    let file = folder.join("scene.toml");
    let history = |out: &str, set: &[&str]| {
        run(&file, &folder.join(out), set).good();
        fs::read_to_string(folder.join(out).join("history.csv")).unwrap()
    };
    let friction = "material.stone.friction=0.1";
    let others = "include=[\"parts/two.toml\"]";
    let plain = history("plain", &[friction]);
    let before = history("before", &[friction, others]);
    assert_eq!(before, history("after", &[others, friction]));
    assert_eq!(before, history("same", &["include=[\"parts/same.toml\"]", friction]));
    assert!(before != plain && before != history("rough", &[others]));
    for (set, expected) in [
        ("include=[\"parts/none.toml\"]", "--set: include.0: found"),
        ("include=parts/two.toml", "--set: include: found no list"),
        ("include=", "grains.0.material: found \"stone\", expected"),
    ] {
        let outcome = run(&file, &folder.join("bad"), &[set]);
        assert_eq!(outcome.code, 2, "{}", outcome.stderr);
        assert!(outcome.stderr.contains(expected), "{}\n{expected}", outcome.stderr);
    }
}
