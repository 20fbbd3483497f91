//! `trackbed view` and `trackbed render` of scenes: all shipped ones, errors, reload.

use super::cli::inputs;
use super::render::files::Pixels;
use super::support::{Folder, repository, trackbed};
use super::view::Server;
use std::time::{Duration, Instant};
use trackbed::preview::{KINDS, Preview, Source};

#[test]
fn shipped_scenes_have_all_objects() {
    let mut used = vec![0; KINDS.len()];
    for file in inputs() {
        let begun = Instant::now();
        let source = Source::new(&file, &[]);
        let (document, job) = source.resolve().unwrap();
        let resolved = begun.elapsed();
        let preview = Preview::new(&document, &job).unwrap();
        let name = file.strip_prefix(repository()).unwrap().display();
        println!(
            "{name}: {:.2} s + {:.2} s",
            resolved.as_secs_f64(),
            (begun.elapsed() - resolved).as_secs_f64()
        );
        let scene = document.scene().unwrap();
        let count = |word: &str| preview.of(word).count();
        assert_eq!(count("grains"), scene.grains.len(), "{name}");
        assert_eq!(count("walls"), if scene.grains.is_empty() { 0 } else { scene.walls.len() }, "{name}");
        assert_eq!(count("boxes"), scene.measure.len() + scene.compaction.len(), "{name}");
        assert_eq!(count("sleepers"), usize::from(scene.track.is_some()), "{name}");
        assert_eq!(count("water"), usize::from(scene.water.is_some()), "{name}");
        let inlets = scene.grains.iter().filter(|g| g.inlet.is_some()).count();
        assert_eq!(count("flow"), inlets + scene.outlet.len(), "{name}");
        let groups = scene.probe.iter().filter(|p| p.group.is_some()).count();
        assert_eq!(count("probes"), scene.probe.len() - groups, "{name}");
        let placed = |g: &&trackbed::scene::grains::Grains| {
            g.fill.is_some() || g.lattice.is_some() || g.region.is_some() || g.floes.is_some()
        };
        assert_eq!(count("fills"), scene.grains.iter().filter(placed).count(), "{name}");
        if let (Some(table), Some(part)) = (&scene.solid, &job.solid) {
            let mesh = part.model.mesh();
            let elements: usize = preview.of("solid").map(|item| number(&item.count)).sum();
            let ground = part.sleepers.as_ref().map_or(mesh.element_count(), |s| s.ground_elements());
            assert_eq!(elements, ground, "{name}: elements");
            let supports: usize = preview.of("supports").map(|item| number(&item.count)).sum();
            if part.sleepers.is_none() {
                assert_eq!(supports, part.model.supports().fixed().len(), "{name}: supports");
            }
            assert_eq!(count("loads"), table.load.len(), "{name}");
        }
        let bodies = job.grains.as_ref().map_or(0, |g| g.groups.bodies.iter().filter(|b| !b.absent).count());
        assert_eq!(preview.of("grains").map(|item| number(&item.count)).sum::<usize>(), bodies, "{name}");
        for item in preview.of("supports") {
            let marks = item.shape.points.len() / 5;
            assert!(marks <= number(&item.count).min(2500), "{name}: {} has {marks} marks", item.name);
        }
        for item in &preview.items {
            used[item.kind] += 1;
            let points = item.shape.points.len() as u32;
            assert!(item.shape.triangles.iter().flatten().all(|n| *n < points), "{name}: {}", item.name);
            assert!(item.shape.edges.iter().flatten().all(|n| *n < points), "{name}: {}", item.name);
        }
    }
    for (kind, count) in KINDS.iter().zip(used) {
        assert!(count > 0, "no shipped scene has {}", kind.label);
    }
}

/// First number of a count such as "1,200 elements".
fn number(count: &str) -> usize {
    count.split([' ', ';']).next().unwrap().replace(',', "").parse().unwrap()
}

#[test]
fn shipped_scenes_render_nonempty_pictures() {
    let folder = Folder::new("preview_pictures");
    let out = folder.join("picture.bmp");
    for scene in inputs() {
        let words = ["render", scene.to_str().unwrap(), "--force", "--out", out.to_str().unwrap()];
        let bare = ["--size", "200x140", "--hide", "caption,axes,scale,legends"];
        let outcome = trackbed(words.iter().chain(&bare)).good();
        assert!(outcome.stdout.contains("200 x 140 pixels, before the run"), "{}", outcome.stdout);
        let seen = Pixels::read(&out).count();
        assert!(seen > 400, "{}: {seen} pixels", scene.display());
    }
}

const SCENE: &str = r#"title = "cube"

[solid]
gravity = false
block = { x = { lines = [0.0, 1.0], counts = [2] }, y = { lines = [0.0, 1.0], counts = [2] }, z = { lines = [0.0, 1.0], counts = [2] } }

[[solid.material]]
id = 1
name = "clay"
young = "20 MPa"
poisson = 0.3
density = 1900

[[solid.support]]
side = "z-"
directions = ["x", "y", "z"]

[[solid.load]]
kind = "pressure"
side = "z+"
pressure = "10 kPa"
"#;

fn meta(server: &Server) -> serde_json::Value {
    let (status, body) = server.get("/data/scene");
    assert_eq!(status, 200, "{}", String::from_utf8_lossy(&body));
    let length = u32::from_le_bytes(body[4..8].try_into().unwrap()) as usize;
    let text: serde_json::Value = serde_json::from_slice(&body[8..8 + length]).unwrap();
    text["meta"].clone()
}

/// Saves the scene and waits for a new version.
fn saved(server: &Server, folder: &Folder, text: &str) -> serde_json::Value {
    let before = meta(server)["version"].clone();
    folder.write("scene.toml", text);
    let begun = Instant::now();
    while serde_json::from_slice::<serde_json::Value>(&server.get("/version").1).unwrap() == before {
        assert!(begun.elapsed() < Duration::from_secs(20), "the version does not change");
        std::thread::sleep(Duration::from_millis(20));
    }
    meta(server)
}

#[test]
fn page_follows_file_and_shows_errors() {
    let folder = Folder::new("preview_live");
    folder.write("scene.toml", SCENE);
    folder.write("soft.toml", "title = \"other\"\n");
    let server = Server::start(folder.path());
    let first = meta(&server);
    assert_eq!(first["title"], "cube");
    assert!(first["errors"].is_null());
    let names = |meta: &serde_json::Value| -> Vec<String> {
        let items = meta["model"]["items"].as_array().unwrap();
        items.iter().map(|item| item["name"].as_str().unwrap().to_string()).collect()
    };
    assert_eq!(names(&first), ["clay", "fixed in x", "fixed in y", "fixed in z", "pressure 0, 10 kN"]);
    assert_eq!(server.get("/data/model").0, 200);
    let check = String::from_utf8_lossy(&server.get("/data/check").1).into_owned();
    assert!(check.contains("solid: 81 nodes"), "{check}");

    let broken = SCENE.replace("\"20 MPa\"", "\"-20 MPa\"");
    let wrong = saved(&server, &folder, &broken);
    let said = trackbed(["check", folder.join("scene.toml").to_str().unwrap()]).stderr;
    let message = wrong["errors"][0].as_str().unwrap();
    assert!(
        wrong["model"].is_null() && message.contains("scene.toml:10: solid.material.0.young: "),
        "{wrong}"
    );
    assert!(said.contains(message), "{said}");
    assert_eq!(server.get("/data/model").0, 404);
    let syntax = saved(&server, &folder, "title = \n");
    assert!(syntax["errors"][0].as_str().unwrap().contains("scene.toml:1: syntax: "), "{syntax}");
    let included = format!(
        "include = [\"soft.toml\"]\n{}",
        SCENE.replace("\"clay\"", "\"sand\"").replace("title = \"cube\"", "")
    );
    let good = saved(&server, &folder, &included);
    assert_eq!((&good["title"], names(&good)[0].as_str()), (&"other".into(), "sand"));

    // Included files count too.
    let before = good["version"].clone();
    folder.write("soft.toml", "title = \"renamed\"\n");
    let after = meta(&server);
    assert_ne!(after["version"], before);
    assert_eq!(after["title"], "renamed");
    assert_eq!(server.get("/folders").1, b"[]");
}

#[test]
fn warnings_name_their_objects() {
    let folder = Folder::new("preview_warnings");
    let file = folder.write("scene.toml", &SCENE.replace("\"20 MPa\"", "20.0"));
    let (document, job) = Source::new(&file, &[]).resolve().unwrap();
    let preview = Preview::new(&document, &job).unwrap();
    let found = preview.warnings.iter().find(|r| r.text.starts_with("solid.material.0.young: ")).unwrap();
    assert!(found.serious);
    assert_eq!(preview.items[found.item.unwrap()].name, "clay");
}

#[test]
fn scenes_are_exported_with_overrides() {
    let folder = Folder::new("preview_export");
    let file = folder.write("scene.toml", SCENE);
    let html = folder.join("page.html");
    let words =
        ["view", file.to_str().unwrap(), "--set", "title=changed", "--export", html.to_str().unwrap()];
    let said = trackbed(words).good().stdout;
    assert!(said.contains("page.html: 5 objects, "), "{said}");
    let page = std::fs::read_to_string(&html).unwrap();
    assert!(page.contains("<title>changed \u{2013} trackbed</title>"));
    for name in ["scene", "model"] {
        assert_eq!(page.matches(&format!("data-block=\"{name}\"")).count(), 1, "{name}");
    }
}

#[test]
fn bad_input_ends_with_one_error() {
    let folder = Folder::new("preview_bad");
    let good = folder.write("scene.toml", SCENE);
    let broken = folder.write("broken.toml", &SCENE.replace("\"20 MPa\"", "\"-20 MPa\""));
    let (html, picture) = (folder.join("page.html"), folder.join("picture.png"));
    let [good, broken, html, picture] = [&good, &broken, &html, &picture].map(|path| path.to_str().unwrap());
    let nowhere = folder.join("nowhere.toml");
    let nowhere = nowhere.to_str().unwrap();
    std::fs::create_dir(folder.join("results")).unwrap();
    folder.write("results/results.pvd", "");
    folder.write("results/scene.toml", SCENE);
    let results = folder.join("results");
    let results = results.to_str().unwrap();
    for (words, expected) in [
        (&["view", broken, "--export", html][..], "broken.toml:10: solid.material.0.young: found "),
        (&["view", nowhere, "--no-open"], "nowhere.toml: file: found "),
        (&["view", good, "--set", "solid.x=1", "--export", html], "--set: solid.x: found "),
        (&["view", results, "--export", html], "results.pvd: found "),
        (
            &["view", results, "--set", "title=a", "--export", html],
            "--set: found, but it has no effect without a scene",
        ),
        (&["render", broken, "--out", picture], "broken.toml:10: solid.material.0.young: found "),
        (
            &["render", good, "--out", picture, "--field", "speed"],
            "--field: found, but it has no effect without a results",
        ),
        (
            &["render", good, "--out", "a.avi"],
            "--out: found a.avi, expected a picture: a scene has no frames",
        ),
        (&["render", results, "--set", "title=a"], "--set: found, but it has no effect without a scene"),
    ] {
        let outcome = trackbed(words);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{words:?}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(expected), "{words:?}: {}", outcome.stderr);
        assert_eq!(outcome.stderr.lines().count(), 1, "{words:?}: {}", outcome.stderr);
    }
}
