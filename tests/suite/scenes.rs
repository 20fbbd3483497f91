//! Result files and numerical failures (exit code 3).

use super::support::{
    COUPLED, Folder, GRAINS, SOLID, Table, json, repository, run, scene_folder, snapshot, trackbed,
};
use super::tecplot_zone::read;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use vtkio::model::{Attribute, DataSet};

/// Name → (components, values).
pub(super) type Arrays = BTreeMap<String, (usize, Vec<f64>)>;

/// Points, point data and cell data of a VTK file; all finite.
pub(super) fn vtk(file: &Path) -> (Vec<f64>, Arrays, Arrays) {
    let arrays = |list: Vec<Attribute>| -> Arrays {
        let one = |attribute: Attribute| match attribute {
            Attribute::DataArray(a) => (a.name.clone(), (a.num_comp(), a.data.cast_into::<f64>().unwrap())),
            Attribute::Field { .. } => panic!("a field in {}", file.display()),
        };
        list.into_iter().map(one).collect()
    };
    let (points, data) = match vtkio::Vtk::import(file).unwrap().data {
        DataSet::UnstructuredGrid { mut pieces, .. } => {
            let piece = pieces.remove(0).into_loaded_piece_data(None).unwrap();
            (piece.points, piece.data)
        }
        DataSet::PolyData { mut pieces, .. } => {
            let piece = pieces.remove(0).into_loaded_piece_data(None).unwrap();
            (piece.points, piece.data)
        }
        _ => panic!("{}", file.display()),
    };
    let points = points.cast_into::<f64>().unwrap();
    let (point, cell) = (arrays(data.point), arrays(data.cell));
    for values in point.values().chain(cell.values()).map(|(_, v)| v).chain([&points]) {
        assert!(values.iter().all(|v| v.is_finite()), "{}", file.display());
    }
    (points, point, cell)
}

#[track_caller]
fn expect_arrays(arrays: &Arrays, items: usize, expected: &[(&str, usize)]) {
    for (name, components) in expected {
        let (found, values) = arrays.get(*name).unwrap_or_else(|| panic!("no {name} in {:?}", arrays.keys()));
        assert_eq!((*found, values.len()), (*components, components * items), "{name}");
    }
}

fn series(dir: &Path) -> Vec<(f64, PathBuf)> {
    let text = fs::read_to_string(dir.join("results.pvd")).unwrap();
    let attribute = |row: &str, name: &str| {
        row.split(&format!("{name}=\"")).nth(1).unwrap().split('"').next().unwrap().to_string()
    };
    text.lines()
        .filter(|row| row.contains("<DataSet"))
        .map(|row| (attribute(row, "timestep").parse().unwrap(), dir.join(attribute(row, "file"))))
        .collect()
}

fn coupled(name: &str) -> Folder {
    let folder = scene_folder(name, COUPLED);
    run(&folder.join("scene.toml"), &folder.join("out"), &[]).good();
    folder
}

#[test]
fn solid_frames_contain_every_field() {
    let folder = coupled("fields");
    let out = folder.join("out");
    let frames = series(&out);
    assert_eq!(frames.len(), 12);
    assert!(frames.iter().all(|(_, file)| file.is_file()));
    assert_eq!(frames[0].0, 0.0);

    let (points, point, cell) = vtk(&out.join("frames/solid_00002.vtu"));
    let nodes = points.len() / 3;
    assert_eq!(nodes, 81);
    let solid = [
        ("displacement", 3),
        ("velocity", 3),
        ("stress", 9),
        ("von_mises", 1),
        ("equivalent_plastic_strain", 1),
        ("yield_function", 1),
        ("node_id", 1),
    ];
    expect_arrays(&point, nodes, &solid);
    expect_arrays(&cell, 8, &[("material", 1), ("element_id", 1)]);
    let history = Table::read(&out.join("history.csv"));
    let probe = (0..nodes).find(|n| points[3 * n..3 * n + 3] == [1.0, 1.0, 0.0]).unwrap();
    for (d, axis) in ["x", "y", "z"].iter().enumerate() {
        let last = |name: &str| *history.column(&format!("{name}_{axis}")).last().unwrap();
        assert_eq!(point["displacement"].1[3 * probe + d], last("middle_u"));
        assert_eq!(point["velocity"].1[3 * probe + d], last("middle_v"));
    }
    assert_eq!(frames.last().unwrap().0, *history.column("time").last().unwrap());
}

#[test]
fn coupled_frames_contain_every_part() {
    let folder = coupled("frames");
    let out = folder.join("out");
    let history = Table::read(&out.join("history.csv"));
    let (points, point, _) = vtk(&out.join("frames/grains_00002.vtp"));
    let grains = [
        ("radius", 1),
        ("velocity", 3),
        ("spin", 3),
        ("orientation", 4),
        ("id", 1),
        ("part", 1),
        ("mean_stress", 1),
        ("force", 3),
    ];
    assert_eq!(points.len(), 3 * 5);
    expect_arrays(&point, 5, &grains);
    assert!(point["radius"].1.iter().all(|r| *r == 0.1));

    let (points, _, cell) = vtk(&out.join("frames/chains_00002.vtp"));
    let contacts = points.len() / 6;
    assert!(contacts >= 4, "the bed carries the sleeper: {contacts} contacts");
    expect_arrays(
        &cell,
        contacts,
        &[("normal_force", 1), ("tangential_force", 1), ("magnitude", 1), ("kind", 1)],
    );
    let on_solid: f64 =
        cell["kind"].1.iter().zip(&cell["normal_force"].1).filter(|(k, _)| **k == 3.0).map(|(_, f)| f).sum();
    assert!(on_solid > 100.0, "the force chains end on the solid: {on_solid} N");

    let (points, _, cell) = vtk(&out.join("frames/walls_00002.vtp"));
    assert_eq!(points.len(), 3 * 8, "the sleeper's corners");
    expect_arrays(&cell, 6, &[("id", 1)]);
    let height: f64 = (0..8).map(|c| points[3 * c + 2] / 8.0).sum();
    assert!((height - history.column("sleeper_z").last().unwrap()).abs() < 1e-12);
}

#[test]
fn coupled_tables_have_their_columns() {
    let folder = coupled("tables");
    let out = folder.join("out");
    let history = Table::read(&out.join("history.csv"));
    let expected = [
        "time",
        "load",
        "sleeper_x",
        "sleeper_y",
        "sleeper_z",
        "sleeper_tilt",
        "contact_force_on_solid_x",
        "contact_force_on_solid_y",
        "contact_force_on_solid_z",
        "peak_formation_pressure",
        "grains_kinetic",
        "contact_springs",
        "grains_gravity",
        "solid_kinetic",
        "solid_strain",
        "solid_gravity",
        "work",
        "dissipated_dashpot",
        "dissipated_friction",
        "dissipated_solid",
        "interface_error",
        "energy_error",
        "middle_u_x",
        "middle_u_y",
        "middle_u_z",
        "middle_v_x",
        "middle_v_y",
        "middle_v_z",
    ];
    assert_eq!(history.heads, expected);
    let cycles = Table::read(&out.join("cycles.csv"));
    let expected = [
        "cycle",
        "settlement",
        "resilient_deflection",
        "secant_stiffness",
        "dissipated_energy",
        "peak_formation_pressure",
        "rate",
        "bed_stiffness",
    ];
    assert_eq!(cycles.heads, expected);
    assert_eq!(cycles.column("cycle"), [1.0, 2.0]);
    for plot in ["settlement.svg", "sleeper.svg"] {
        assert!(fs::read_to_string(out.join(plot)).unwrap().contains("<svg"), "{plot}");
    }
}

/// Every field that VTK reads from the same frame, at the nodes and elements of the mesh.
#[test]
fn tecplot_file_equals_vtk_frame() {
    let folder = scene_folder("tecplot", COUPLED);
    let (scene, out) = (folder.join("scene.toml"), folder.join("out"));
    let fields = "output.fields=[\"velocity\", \"stress\", \"von_mises\", \"equivalent_plastic_strain\", \
                  \"yield_function\", \"strain\", \"plastic_strain\"]";
    run(&scene, &out, &[fields]).good();
    let zone = read(&fs::read_to_string(out.join("tecplot/solid_00002.dat")).unwrap());
    let (points, point, cell) = vtk(&out.join("frames/solid_00002.vtu"));
    // 81 nodes, 36 face centres, 8 element centres; eight bricks per element.
    assert_eq!((zone.points["x"].len(), zone.bricks.len()), (81 + 36 + 8, 64));
    assert!(zone.bricks.iter().flatten().all(|p| *p < 125));
    let equal = |name: &str, found: &[f64], expected: &[f64]| {
        let size = expected.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        assert_eq!(found.len(), expected.len(), "{name}");
        let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart <= 1e-9 * size, "{name}: apart by {apart}, largest value {size}");
        size
    };
    let matrix = [("xx", 0), ("yy", 4), ("zz", 8), ("xy", 1), ("yz", 5), ("zx", 6)];
    let axes = [("x", 0), ("y", 1), ("z", 2)];
    let short = [
        ("displacement", "u"),
        ("velocity", "v"),
        ("stress", "s"),
        ("strain", "e"),
        ("plastic_strain", "ep"),
    ];
    let mut all = point.clone();
    all.insert("".into(), (3, points));
    for (name, (components, values)) in &all {
        let stem = match name.as_str() {
            "equivalent_plastic_strain" => "eps_p",
            name => short.iter().find(|(long, _)| *long == name).map_or(name, |(_, short)| short),
        };
        let of: &[(&str, usize)] = if *components == 9 { &matrix } else { &axes };
        let of = if *components == 1 { &[("", 0)] } else { of };
        for (end, k) in of {
            let expected: Vec<f64> = values.iter().skip(*k).step_by(*components).copied().collect();
            let name = format!("{stem}{end}");
            let found = zone.points.get(&name).unwrap_or_else(|| panic!("no {name} in {:?}", zone.header));
            let size = equal(&name, &found[..81], &expected);
            assert!(size > 0.0 || name.starts_with("ep"), "{name} is zero");
        }
    }
    // The sum of squares is computed by the writer.
    assert_eq!(zone.points.len(), 3 + 3 + 1 + 3 + 3 * 6 + 4);
    for name in ["material", "element_id"] {
        let expected: Vec<f64> = cell[name].1.iter().flat_map(|v| [*v; 8]).collect();
        equal(name, &zone.cells[name], &expected);
    }
    assert_eq!(zone.cells.len(), cell.len());
}

#[test]
fn vtk_itself_opens_the_results() {
    let Some(python) = python() else { return };
    let folder = coupled("vtk");
    let script = repository().join("tests/vtk_check.py");
    let output = Command::new(python)
        .arg(script)
        .args(["--volume", "4"])
        .arg(folder.join("out/results.pvd"))
        .output()
        .expect("the interpreter starts");
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && text.contains("13 passed, 0 failed"), "{text}");
}

/// Python with `vtk`: `TRACKBED_PYTHON`, or `python3`.
fn python() -> Option<PathBuf> {
    if let Some(path) = std::env::var_os("TRACKBED_PYTHON") {
        return Some(path.into());
    }
    match Command::new("python3").args(["-c", "import vtkmodules.vtkIOXML"]).output() {
        Ok(output) if output.status.success() => Some("python3".into()),
        _ => {
            eprintln!("skipped: python3 has no package vtk, and TRACKBED_PYTHON is not set");
            None
        }
    }
}

#[test]
fn disabled_output_is_not_written() {
    let folder = scene_folder("no_output", COUPLED);
    let out = folder.join("out");
    let set = ["output.vtk=false", "output.tecplot=false", "output.frames=0", "output.state=false"];
    run(&folder.join("scene.toml"), &out, &set).good();
    let mut names: Vec<String> =
        fs::read_dir(&out).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    assert_eq!(
        names,
        [
            "cycles.csv",
            "history.csv",
            "log.txt",
            "run.json",
            "settlement.svg",
            "sleeper.svg",
            "sources.bib",
            "summary.json"
        ]
    );
}

#[test]
fn frames_contain_selected_fields() {
    let folder = scene_folder("fields", COUPLED);
    let (scene, out) = (folder.join("scene.toml"), folder.join("out"));
    let names = |file: &str| -> Vec<String> {
        let bytes = fs::read(out.join(file)).unwrap();
        let text = String::from_utf8_lossy(&bytes).into_owned();
        text.split("<DataArray ")
            .skip(1)
            .filter_map(|array| array.split("Name=\"").nth(1)?.split('"').next().map(String::from))
            .filter(|name| !["Points", "connectivity", "offsets", "types"].contains(&name.as_str()))
            .collect()
    };
    let (grains, solid) = ("frames/grains_00001.vtp", "frames/solid_00001.vtu");
    run(&scene, &out, &[]).good();
    assert_eq!((names(grains).len(), names(solid).len()), (10, 9));
    let chosen = ["output.fields=[\"von_mises\", \"force\"]", "output.vtkhdf=true"];
    run(&scene, &out, &chosen).good();
    assert_eq!(names(grains), ["radius", "id", "part", "force"]);
    assert_eq!(names(solid), ["displacement", "von_mises", "node_id", "material", "element_id"]);
    for (file, there, gone) in [("grains", "force", "velocity"), ("solid", "von_mises", "yield_function")] {
        let bytes = fs::read(out.join(format!("{file}.vtkhdf"))).unwrap();
        let has = |name: &str| bytes.windows(name.len()).any(|w| w == name.as_bytes());
        assert!(has(there) && !has(gone), "{file}");
    }
    let refused = run(&scene, &out, &["output.fields=[\"force\", \"colour\"]"]);
    assert_eq!(refused.code, 2);
    assert!(
        refused.stderr.contains("output.fields.1: found \"colour\", expected one of coordination,"),
        "{refused:?}"
    );
    trackbed(["render", out.to_str().unwrap(), "--out", folder.join("one.png").to_str().unwrap()]).good();
    trackbed(["view", out.to_str().unwrap(), "--export", folder.join("one.html").to_str().unwrap()]).good();
}

#[test]
fn files_that_are_no_results_stay() {
    let folder = scene_folder("beside", SOLID);
    fs::rename(folder.join("NODECOORD.DAT"), folder.join("nodes.csv")).unwrap();
    folder.edit("scene.toml", "NODECOORD.DAT", "nodes.csv");
    let before = fs::read(folder.join("nodes.csv")).unwrap();
    run(&folder.join("scene.toml"), folder.path(), &["output.tables=false"]).good();
    assert!(folder.join("summary.json").exists() && fs::read(folder.join("nodes.csv")).unwrap() == before);
}

#[test]
fn earlier_results_are_removed() {
    let folder = scene_folder("stale", COUPLED);
    let (scene, out) = (folder.join("scene.toml"), folder.join("out"));
    run(&scene, &out, &["output.frames=5"]).good();
    folder.write("out/notes.txt", "kept by hand");
    assert!(out.join("frames/solid_00005.vtu").exists() && out.join("cycles.csv").exists());
    run(&scene, &out, &["output.frames=1"]).good();
    let listed: Vec<PathBuf> = series(&out).into_iter().map(|(_, file)| file).collect();
    assert_eq!(fs::read_dir(out.join("frames")).unwrap().count(), listed.len());
    assert_eq!(fs::read_dir(out.join("tecplot")).unwrap().count(), 2);

    folder.write("scene.toml", GRAINS);
    run(&scene, &out, &[]).good();
    for name in
        ["cycles.csv", "settlement.svg", "sleeper.svg", "frames/solid_00000.vtu", "tecplot/solid_00000.dat"]
    {
        assert!(!out.join(name).exists(), "{name} is of another run");
    }

    // A failure before the first frame leaves summary, log and sources only.
    folder.write("scene.toml", &one_in_the_other());
    fails(&folder, &["overlap"]);
    assert_eq!(
        snapshot(&out).into_keys().collect::<Vec<_>>(),
        ["log.txt", "notes.txt", "run.json", "sources.bib", "summary.json"]
    );
}

/// Numerical failure: code 3, one line with `what` and a time, the same in the summary.
fn fails(folder: &Folder, what: &[&str]) -> PathBuf {
    let (scene, out) = (folder.join("scene.toml"), folder.join("out"));
    let outcome = run(&scene, &out, &[]);
    assert_eq!((outcome.code, outcome.stderr.lines().count()), (3, 1), "{outcome:?}");
    println!("{}", outcome.stderr.trim());
    for part in what.iter().chain(&["at t = "]) {
        assert!(outcome.stderr.contains(part), "{part} is missing in {}", outcome.stderr);
    }
    let text = fs::read_to_string(out.join("summary.json")).unwrap();
    assert!(!text.contains("NaN") && !text.contains("Infinity"));
    let summary = json(&out.join("summary.json"));
    let status = summary["status"].as_str().unwrap();
    assert_eq!(format!("error: {}\n", status.strip_prefix("failed: ").unwrap()), outcome.stderr);
    out
}

/// Failure during the run: earlier results are kept and finite.
fn blows_up(folder: &Folder, what: &[&str]) {
    let out = fails(folder, what);
    let history = Table::read(&out.join("history.csv"));
    assert!(!history.rows.is_empty(), "what was known until then is kept");
    let frames = series(&out);
    assert!(!frames.is_empty());
    for (_, file) in &frames {
        let text = String::from_utf8_lossy(&fs::read(file).unwrap()).into_owned();
        // Without contacts there are no arrays.
        if !text.contains("NumberOfPoints=\"0\"") {
            vtk(file);
        }
    }
    for entry in fs::read_dir(out.join("tecplot")).into_iter().flatten() {
        let text = fs::read_to_string(entry.unwrap().path()).unwrap();
        assert!(!text.contains("NaN") && !text.contains("inf"));
    }
}

#[test]
fn grain_step_above_limit_diverges() {
    let step = "[time]\nend = \"0.5\"\ngrain_step = \"5 ms\"\naccept_step_above_limit = true\n";
    let folder = Folder::new("blow_up_grains");
    folder.write("scene.toml", &GRAINS.replace("[time]\nend = \"20 ms\"\n", step));
    blows_up(&folder, &["energy error: ", "at t = "]);
}

#[test]
fn coupled_step_above_limit_diverges() {
    let step = "[time]\ngrain_step = \"10 ms\"\naccept_step_above_limit = true\n\n[output]";
    let folder = scene_folder("blow_up_coupled", &COUPLED.replace("[output]", step));
    blows_up(&folder, &["speed of body ", "(limit "]);
}

fn one_in_the_other() -> String {
    GRAINS.replace("[0.01, 0.0, 0.152, 0.05]]", "[0.001, 0.0, 0.06, 0.05]]\naccept_overlap = true")
}

#[test]
fn grains_inside_each_other_are_named() {
    let folder = Folder::new("overlap");
    folder.write("scene.toml", &one_in_the_other());
    fails(&folder, &["overlap of body 0 of \"pair\" and body 1 of \"pair\""]);
}

#[test]
fn a_failure_while_settling_is_reported() {
    let folder = Folder::new("overlap_settling");
    folder.write("scene.toml", &(one_in_the_other() + "\n[deposition]\nmax_time = 0.1\n"));
    fails(&folder, &["settling: ", "overlap of body 0 of \"pair\" and body 1 of \"pair\""]);
}

#[test]
fn unstable_newmark_constants_blow_up() {
    let dynamics =
        "[solid.dynamics]\nbeta = 0\ngamma = 0.3\naccept_conditional_stability = true\n\n[[solid.load]]";
    let time = "[time]\nend = 5\nsolid_step = 0.01\n\n[output]";
    let text = SOLID.replace("[[solid.load]]", dynamics).replace("[output]", time);
    let folder = scene_folder("blow_up_solid", &text);
    blows_up(&folder, &["energy error: ", "at t = "]);
}

#[test]
fn failed_run_leaves_no_trace() {
    let folder = Folder::new("after_failure");
    let scene = folder.write("scene.toml", GRAINS);
    let steps = ["time.grain_step=5 ms", "time.end=0.5", "time.accept_step_above_limit=true"];
    assert_eq!(run(&scene, &folder.join("out"), &steps).code, 3);
    run(&scene, &folder.join("out"), &[]).good();
    run(&scene, &folder.join("fresh"), &[]).good();
    for file in ["history.csv", "results.pvd", "frames/grains_00002.vtp"] {
        assert!(
            fs::read(folder.join("out").join(file)).unwrap()
                == fs::read(folder.join("fresh").join(file)).unwrap()
        );
    }
    assert_eq!(json(&folder.join("out/summary.json"))["status"], "done");
}

#[test]
fn single_domain_scenes_run() {
    let folder = scene_folder("alone", SOLID);
    run(&folder.join("scene.toml"), &folder.join("solid"), &[]).good();
    let names = |dir: &str| {
        let frames = fs::read_dir(folder.join(dir).join("frames")).unwrap();
        frames.map(|e| e.unwrap().file_name().into_string().unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(names("solid"), ["solid_00000.vtu"]);
    assert!(!folder.join("solid/history.csv").exists(), "it has no effect without [solid.dynamics]");
    folder.write("grains.toml", GRAINS);
    run(&folder.join("grains.toml"), &folder.join("grains"), &[]).good();
    assert!(names("grains").iter().all(|n| !n.starts_with("solid")));
    assert!(!folder.join("grains/cycles.csv").exists(), "no load, no cycles");
}

#[test]
fn groups_filled_into_one_box_stack() {
    let group = |name: &str| {
        format!(
            "[[grains]]\nname = \"{name}\"\nshape = \"sphere\"\nmaterial = \"stone\"\ncount = 30\n\
             size = [0.04, 0.06]\nfill = {{ low = [0, 0, 0], high = [0.3, 0.3] }}\n\n"
        )
    };
    let folder = scene_folder("two_groups", GRAINS);
    let text = fs::read_to_string(folder.join("scene.toml")).unwrap();
    let (head, rest) = text.split_once("[[grains]]").unwrap();
    let tail = rest.split_once("[[walls]]").unwrap().1;
    folder.write("scene.toml", &format!("{head}{}{}[[walls]]{tail}", group("first"), group("second")));
    let out = folder.join("out");
    run(&folder.join("scene.toml"), &out, &[]).good();
    let (points, fields, _) = vtk(&out.join("frames/grains_00000.vtp"));
    let height = |part: f64| {
        let of_part = |(_, p): &(usize, &f64)| **p == part;
        let heights = fields["part"].1.iter().enumerate().filter(of_part).map(|(i, _)| points[3 * i + 2]);
        heights.fold((f64::INFINITY, 0.0_f64), |(low, high), z| (low.min(z), high.max(z)))
    };
    assert!(height(1.0).0 > height(0.0).1, "the second group starts above the first");
}

#[test]
fn moving_walls_wait_for_the_run() {
    let folder = scene_folder("moving_wall", GRAINS);
    folder.edit("scene.toml", "normal = [0, 0, 1]", "normal = [0, 0, 1]\nvelocity = [0, 0, 0.5]");
    folder.edit("scene.toml", "[time]", "[deposition]\nmax_time = 0.3\n\n[time]");
    let out = folder.join("out");
    run(&folder.join("scene.toml"), &out, &[]).good();
    let (first, ..) = vtk(&out.join("frames/grains_00000.vtp"));
    let (last, ..) = vtk(&out.join("frames/grains_00002.vtp"));
    assert!((first[2] - 0.05).abs() < 1e-3, "at rest on the wall's first place: {}", first[2]);
    assert!(last[2] > first[2] + 0.005, "lifted by the wall: {}", last[2]);
}

#[test]
fn small_scenes_run() {
    let out = scene_folder("small_scenes", SOLID);
    for (scene, set, energy) in [
        ("solid/embankment", [].as_slice(), None),
        ("solid/pulse", &["time.end=0.06"], Some(1e-10)),
        ("grains/box", &["time.end=0.15"], Some(0.02)),
        ("grains/chute", &["time.end=0.6"], Some(0.02)),
        ("grains/rolling", &["time.end=0.5"], Some(0.02)),
    ] {
        let dir = out.join(scene.split('/').next_back().unwrap());
        run(&repository().join("inputs").join(format!("{scene}.toml")), &dir, set).good();
        let summary = json(&dir.join("summary.json"));
        assert_eq!(summary["warnings"].as_array().unwrap().len(), 0, "{scene}: {}", summary["warnings"]);
        match energy {
            None => assert!(summary["statics"]["equilibrium_error"].as_f64().unwrap() < 1e-12),
            Some(bound) => {
                let error = summary["energy"]["relative_error"].as_f64().unwrap();
                println!("{scene}: energy error {error:.1e}");
                assert!(error < bound, "{scene}: {error:e}");
            }
        }
    }
}
