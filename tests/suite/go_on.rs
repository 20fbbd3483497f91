//! Restart from the final state of another run (`--from`).

use super::scenes::vtk;
use super::support::{Folder, Table, json, repository, results, run, trackbed};
use std::path::Path;

fn from(scene: &Path, out: &Path, before: &Path, set: &[&str]) -> super::support::Outcome {
    let mut words = vec!["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap(), "--from"];
    words.push(before.to_str().unwrap());
    set.iter().for_each(|s| words.extend(["--set", s]));
    trackbed(words)
}

#[test]
fn two_halves_are_a_whole() {
    let folder = Folder::new("from_halves");
    let scene = repository().join("inputs/grains/box.toml");
    let common =
        ["grains.0.count=300", "output.history_interval=0.001", "output.packing=true", "output.frames=2"];
    let with = |end: &'static str| [&common[..], &[end]].concat();
    let [whole, first, second, short] = ["whole", "first", "second", "short"].map(|name| folder.join(name));
    run(&scene, &whole, &with("time.end=0.2")).good();
    run(&scene, &first, &with("time.end=0.1")).good();
    from(&scene, &second, &first, &with("time.end=0.1")).good();
    let packing = |out: &Path| std::fs::read_to_string(out.join("packing.csv")).unwrap();
    assert!(packing(&second) == packing(&whole), "the second half ends elsewhere");
    assert!(packing(&first) != packing(&whole));
    let (half, all) = (json(&second.join("summary.json")), json(&whole.join("summary.json")));
    let error = |s: &serde_json::Value| s["energy"]["largest_relative_error"].as_f64().unwrap();
    assert!(error(&half) < 2.0 * error(&all) + 1e-3, "{} {}", error(&half), error(&all));
    assert!(half["momentum"]["linear"].as_f64().unwrap() < 1e-9, "{half:#}");
    let history = Table::read(&second.join("history.csv"));
    assert_eq!(history.column("time")[0], 0.0);
    // The result depends on the earlier run and nothing else.
    assert_ne!(half["scene_hash"], json(&first.join("summary.json"))["scene_hash"]);
    let again = folder.join("again");
    let mut words = vec!["run", scene.to_str().unwrap(), "--out", again.to_str().unwrap(), "--threads", "1"];
    words.extend(["--from", first.to_str().unwrap()]);
    let set = with("time.end=0.1");
    set.iter().for_each(|s| words.extend(["--set", s]));
    trackbed(words).good();
    let (a, b) = (results(&second), results(&again));
    assert!(a.keys().eq(b.keys()) && a.iter().all(|(name, bytes)| *bytes == b[name]));
    run(&scene, &short, &with("output.state=false")).good();
    let refused = from(&scene, &folder.join("none"), &short, &with("time.end=0.1"));
    assert_eq!((refused.code, refused.stderr.lines().count()), (2, 1), "{refused:?}");
    assert!(
        refused.stderr.contains("found no end.state, expected the results directory of a completed run"),
        "{refused:?}"
    );
}

#[test]
fn track_restarts_with_changed_load() {
    let folder = Folder::new("from_track");
    let scene = repository().join("inputs/track/meshed_sleeper/scene.toml");
    let common = [
        "track.sleeper.mesh=",
        "grains.0.count=150",
        "deposition.max_time=0.4",
        "compaction=",
        "track.load.frequency=\"20 Hz\"",
        "track.load.rest=0.05",
        "track.load.cycles=2",
        "output.frames=2",
    ];
    let (first, more, soft) = (folder.join("first"), folder.join("more"), folder.join("soft"));
    run(&scene, &first, &common).good();
    from(&scene, &more, &first, &common).good();
    let next = [&common[..], &["track.load.maximum=\"100 kN\"", "solid.material.subgrade.young=\"20 MPa\""]]
        .concat();
    from(&scene, &soft, &first, &next).good();
    let [hard, soft] =
        [&more, &soft].map(|out| Table::read(&out.join("cycles.csv")).column("resilient_deflection"));
    assert!(soft[0] > 1.1 * hard[0] && hard[0] > 0.0, "{hard:?} {soft:?}");
    let summary = json(&more.join("summary.json"));
    assert!(summary["energy"]["largest_relative_error"].as_f64().unwrap() < 0.01, "{summary:#}");
    let stages: Vec<&str> =
        summary["stages"].as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(stages, ["run"], "nothing is packed again");
    let height = |out: &Path| Table::read(&out.join("history.csv")).column("sleeper_z");
    let (before, after) = (height(&first), height(&more));
    assert!((before[before.len() - 1] - after[0]).abs() < 1e-12, "{} {}", before[before.len() - 1], after[0]);
    let page = folder.join("report.html");
    trackbed(["report", more.to_str().unwrap(), "--out", page.to_str().unwrap()]).good();
    let page = std::fs::read_to_string(&page).unwrap();
    assert!(page.contains(&format!(" --from {}", first.display())), "no --from in the report");
    // Another model is rejected by its key; nothing is written.
    for (set, words) in [
        ("grains.0.count=151", "grains.0.count: found 151, expected 150, as in "),
        ("coupling.scheme=lagged", "coupling.scheme: found \"lagged\", expected nothing, as in "),
        (
            "material.stone.rolling_friction=0.1",
            "material.0.rolling_friction: found 0.1, expected nothing, as in ",
        ),
    ] {
        let out = folder.join("other");
        let other = from(&scene, &out, &first, &[&common[..], &[set]].concat());
        assert!(other.code == 2 && other.stderr.contains(words) && !out.exists(), "{set}: {other:?}");
    }
    let state = first.join("end.state");
    let mut bytes = std::fs::read(&state).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&state, &bytes).unwrap();
    let damaged = from(&scene, &folder.join("damaged"), &first, &common);
    assert!(damaged.code == 2 && damaged.stderr.contains("end.state: damaged"), "{damaged:?}");
}

const BONDED: u64 = 4;

fn kinds() -> [(&'static str, String); 4] {
    let data = repository().join("inputs/data");
    let stones = repository().join("inputs/grains/bonded_stone/stones.toml");
    let file = |name: &str| data.join(name).display().to_string();
    let fill = "fill = { low = [0.0, 0.0, 0.0], high = [0.3, 0.3] }\nsize = [\"50 mm\", \"70 mm\"]\nmaterial = \"stone\"";
    let bond = "[[bond]]\nname = \"mineral\"\ndamping = 0.1\n[bond.parallel]\nyoung = \"0.1 GPa\"\nstiffness_ratio = 2.0\n\
                tensile_strength = \"20 kPa\"\nshear_strength = \"32 kPa\"\nfriction_angle = \"35 deg\"\nmoment_factor = 0.5\n";
    let group = |keys: &str| {
        let count = if keys.contains("bonded") { BONDED } else { 30 };
        format!("[[grains]]\nname = \"stones\"\ncount = {count}\nseed = 2\n{fill}\n{keys}\n")
    };
    [
        ("spheres", group("shape = \"sphere\"")),
        ("clumps", group(&format!("shape = \"clump\"\nlibrary = {:?}", file("clumps.toml")))),
        ("bonded", group(&format!("shape = \"bonded\"\nbond = \"mineral\"\nlibrary = {stones:?}")) + bond),
        ("polyhedra", group(&format!("shape = \"polyhedron\"\nlibrary = {:?}", file("polyhedra.toml")))),
    ]
}

fn shaft(grains: &str, more: &str, floor: bool) -> String {
    let wall = |point: [f64; 3], normal: [f64; 3]| {
        format!(
            "[[walls]]\nkind = \"plane\"\npoint = {point:?}\nnormal = {normal:?}\nmaterial = \"smooth\"\n"
        )
    };
    let mut walls = vec![
        wall([0.0; 3], [1.0, 0.0, 0.0]),
        wall([0.3, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        wall([0.0; 3], [0.0, 1.0, 0.0]),
        wall([0.0, 0.3, 0.0], [0.0, -1.0, 0.0]),
    ];
    walls.extend(floor.then(|| wall([0.0; 3], [0.0, 0.0, 1.0])));
    format!(
        "title = \"shaft\"\n[[material]]\nname = \"stone\"\ndensity = 2650\nstiffness = \"0.5 MN/m\"\nfriction = 0.5\nrestitution = 0.3\n\
         [[material]]\nname = \"smooth\"\nstiffness = \"0.5 MN/m\"\nfriction = 0.0\nrestitution = 0.3\n[[contact]]\nbetween = [\"stone\", \"smooth\"]\nfriction = 0.0\nrestitution = 1.0\n{grains}\n{more}\n{}",
        walls.concat()
    )
}

fn places(out: &Path) -> Vec<f64> {
    match std::fs::read_to_string(out.join("packing.csv")) {
        Ok(rows) => rows.lines().skip(1).flat_map(|row| row.split(',')).map(|x| x.parse().unwrap()).collect(),
        Err(_) => vtk(&out.join("frames/grains_00001.vtp")).0,
    }
}

#[test]
fn grain_kinds_restart_bitwise() {
    for (name, grains) in kinds() {
        let folder = Folder::new(&format!("from_{name}"));
        let (count, step) = match name {
            "bonded" => (BONDED, "2.5 us"),
            "polyhedra" => (30, "2.5 us"),
            _ => (30, "10 us"),
        };
        let packing = name != "bonded";
        let rest =
            format!("[time]\ngrain_step = \"{step}\"\nend = 1\n[output]\nframes = 1\npacking = {packing}\n");
        let scene = folder.write("scene.toml", &shaft(&grains, &rest, true));
        let far = "[[walls]]\nkind = \"plane\"\npoint = [0.0, 0.0, -40.0]\nnormal = [0.0, 0.0, 1.0]\nmaterial = \"stone\"\n";
        let next = folder.write("next.toml", &shaft(&grains, &format!("{rest}{far}"), true));
        let [whole, first, same, bed] = ["whole", "first", "same", "bed"].map(|out| folder.join(out));
        run(&scene, &whole, &["time.end=0.381999"]).good();
        run(&scene, &first, &["time.end=0.379999"]).good();
        from(&scene, &same, &first, &["time.end=0.001999"]).good();
        let end = places(&whole);
        assert!(end.len() >= 90 && places(&same) == end, "{name}: the second half ends elsewhere");
        let refused = from(&next, &bed, &first, &["time.end=0.001999"]);
        assert!(
            refused.code == 2 && refused.stderr.contains("--bed imports grains into another"),
            "{refused:?}"
        );
        let words = ["run", next.to_str().unwrap(), "--out", bed.to_str().unwrap(), "--bed", "--from"];
        let words = [&words[..], &[first.to_str().unwrap(), "--set", "time.end=0.001999"]].concat();
        let said = trackbed(words).good();
        assert!(said.stderr.contains("their contacts start from scratch"), "{said:?}");
        let apart = places(&bed).iter().zip(&end).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{name}: {} numbers, apart by {apart:.1e} in another scene", end.len());
        assert!(apart < 1e-8, "{name}: {apart:.1e}");
        let fragments = |out: &Path| json(&out.join("summary.json"))["bonds"]["fragments"].as_u64();
        assert_eq!(fragments(&bed), fragments(&whole), "{name}");
        assert!(name != "bonded" || fragments(&bed) > Some(BONDED), "no bond is broken");
        let other = trackbed(
            [&words_of(&next, &folder.join("other"), &first)[..], &["--set", "grains.0.count=31"]].concat(),
        );
        let said = format!("grains.0.count: found 31, expected {count}");
        assert!(other.code == 2 && other.stderr.contains(&said), "{other:?}");
        assert!(!folder.join("other").exists());
    }
}

fn words_of<'a>(scene: &'a Path, out: &'a Path, before: &'a Path) -> Vec<&'a str> {
    let [scene, out, before] = [scene, out, before].map(|path| path.to_str().unwrap());
    vec!["run", scene, "--out", out, "--bed", "--from", before]
}

#[test]
fn bed_import_onto_solid() {
    let folder = Folder::new("from_bed");
    let (_, grains) = kinds().into_iter().nth(1).unwrap();
    let grains = grains.replace("count = 30", "count = 60");
    let settle = "[deposition]\nmax_time = \"0.6 s\"\nsettled_speed = \"20 mm/s\"\nlocal_damping = 0.3\n[time]\nend = 0.01\n[output]\nframes = 1\n";
    let scene = folder.write("scene.toml", &shaft(&grains, settle, true));
    let track = "[solid]\ngravity = false\n[solid.block]\nx = { lines = [0.0, 0.3], counts = [2] }\ny = { lines = [0.0, 0.3], counts = [2] }\n\
        z = { lines = [-0.3, 0.0], counts = [2] }\n[[solid.support]]\nside = \"z-\"\ndirections = [\"x\", \"y\", \"z\"]\n\
        [[solid.material]]\nid = 1\nname = \"soil\"\nyoung = \"50 MPa\"\npoisson = 0.3\ndensity = 1900\n\
        [coupling]\nsubsteps = \"auto\"\nmaterial = \"stone\"\n\
        [track.sleeper]\nsize = [0.2, 0.2, 0.1]\nmass = 20\nmaterial = \"stone\"\ncentre = [0.15, 0.15]\n\
        [track.load]\nkind = \"haversine\"\nminimum = \"100 N\"\nmaximum = \"500 N\"\nfrequency = 50\ncycles = 1\nrest = \"20 ms\"\nramp = \"10 ms\"\n\
        [output]\nframes = 1\n";
    let next = folder.write("next.toml", &shaft(&grains, track, false));
    let (first, bed) = (folder.join("first"), folder.join("bed"));
    run(&scene, &first, &[]).good();
    trackbed(words_of(&next, &bed, &first)).good();
    let summary = json(&bed.join("summary.json"));
    let stages: Vec<&str> =
        summary["stages"].as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(stages, ["run"], "nothing settles again");
    assert!(summary["energy"]["largest_relative_error"].as_f64().unwrap() < 0.01, "{summary:#}");
    let column = |name: &str| Table::read(&bed.join("history.csv")).column(name);
    let (z, force) = (column("sleeper_z"), column("contact_force_on_solid_z"));
    let highest = places(&first).chunks(3).map(|x| x[2]).fold(f64::NEG_INFINITY, f64::max);
    assert!((z[0] - highest).abs() < 0.06 && z[z.len() - 1] < z[0], "{} {highest}", z[0]);
    let heights = column("grains_gravity")[0] - 20.0 * 9.81 * z[0];
    let before = *Table::read(&first.join("history.csv")).column("grains_gravity").last().unwrap();
    assert!((heights - before).abs() < 1e-4 * before, "{heights} J, {before} J before");
    assert!((120.0..190.0).contains(&-force[1]), "{} N", force[1]);
    let strain = column("solid_strain");
    assert!(
        strain[0] > 0.0 && (strain[1] / strain[0] - 1.0).abs() < 0.01,
        "{} J, then {} J",
        strain[0],
        strain[1]
    );
    let text = std::fs::read_to_string(bed.join("run.json")).unwrap();
    assert!(text.contains("\"bed\": true"), "{text}");
}

#[test]
fn bed_import_into_narrower_walls() {
    let folder = Folder::new("from_narrow");
    let (_, grains) = kinds().into_iter().next().unwrap();
    let settle = "[deposition]\nmax_time = \"0.6 s\"\nsettled_speed = \"20 mm/s\"\nlocal_damping = 0.3\n[time]\nend = 0.01\n[output]\nframes = 1\n";
    let rest = "[time]\nend = 1e-4\n[output]\nframes = 1\n";
    let scene = folder.write("scene.toml", &shaft(&grains, settle, true));
    let first = folder.join("first");
    run(&scene, &first, &[]).good();
    let moved = |text: &str| text.replace("[0.3, 0.0, 0.0]", "[0.28, 0.0, 0.0]");
    let narrow = folder.write("narrow.toml", &moved(&shaft(&grains, rest, true)));
    let refused = trackbed(words_of(&narrow, &folder.join("narrow"), &first));
    assert_eq!(refused.code, 2, "{refused:?}");
    let words = ["of \"stones\" and wall", "% of the smaller radius, expected at most 10 % at the start"];
    assert!(words.iter().all(|w| refused.stderr.contains(w)), "{refused:?}");
    assert!(!folder.join("narrow/summary.json").exists());
    let accepted = grains.replace("name = \"stones\"\n", "name = \"stones\"\naccept_overlap = true\n");
    let accepted = folder.write("accepted.toml", &moved(&shaft(&accepted, rest, true)));
    trackbed(words_of(&accepted, &folder.join("accepted"), &first)).good();
    let same = folder.write("same.toml", &shaft(&grains, rest, true));
    trackbed(words_of(&same, &folder.join("same"), &first)).good();
}
