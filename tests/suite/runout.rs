//! Slides: closed forms, terrain formats, runout results, rejected input.

use super::support::{Folder, Table, json, repository, run, trackbed};
use std::f64::consts::PI;
use std::fmt::Write;
use std::fs;
use std::path::Path;

const DIP: f64 = 30.0;

/// Grid of 1 m of a plane falling along x by [`DIP`].
fn incline() -> String {
    let mut text = String::from("ncols 42\nnrows 11\nxllcenter -2\nyllcenter -5\ncellsize 1\n");
    for _ in 0..11 {
        for column in 0..42 {
            write!(text, "{} ", -(f64::from(column) - 2.0) * (DIP * PI / 180.0).tan()).unwrap();
        }
        text.push('\n');
    }
    text
}

fn block(radius: f64) -> String {
    let (sin, cos) = (DIP * PI / 180.0).sin_cos();
    let mut rows = String::from("x,y,z,r\n");
    for (i, j, k) in (0..4).flat_map(|i| (0..4).flat_map(move |j| (0..2).map(move |k| (i, j, k)))) {
        let (s, h) = (2.0 * radius * f64::from(i), radius * (1.0 + 2.0 * f64::from(k)));
        let y = 2.0 * radius * (f64::from(j) - 1.5);
        writeln!(rows, "{},{y},{},{radius}", s * cos + h * sin, h * cos - s * sin).unwrap();
    }
    rows
}

fn scene(terrain: &str) -> String {
    format!(
        r#"[[material]]
name = "rock"
density = 2600
stiffness = "20 MN/m"
tangential_ratio = 0.5
friction = 0.3
restitution = 0.3
[[grains]]
name = "block"
shape = "sphere"
material = "rock"
packing = "block.csv"
[[bond]]
name = "bonds"
gap = "1 mm"
damping = 0.5
[bond.parallel]
young = "1 GPa"
[[walls]]
kind = "mesh"
material = "rock"
file = "{terrain}"
[runout]
direction = [1, 0]
cell = 0.5
[time]
end = 2.0
[output]
frames = 2
"#
    )
}

/// s = g (sin a - mu cos a) t²/2 within 0.5 %.
#[test]
fn sliding_block_matches_closed_form() {
    let folder = Folder::new("slide");
    folder.write("incline.asc", &incline());
    folder.write("block.csv", &block(0.25));
    let file = folder.write("scene.toml", &scene("incline.asc"));
    run(&file, &folder.join("r"), &[]).good();
    let summary = json(&folder.join("r/summary.json"));
    let runout = &summary["runout"];
    let of = |key: &str| runout[key].as_f64().unwrap();
    let (sin, cos) = (DIP * PI / 180.0).sin_cos();
    let way = 9.81 * (sin - 0.3 * cos) * 2.0_f64.powi(2) / 2.0;
    let found =
        (runout["centre_end"][0].as_f64().unwrap() - runout["centre_start"][0].as_f64().unwrap()) / cos;
    println!("way {found:.5} m, closed form {way:.5} m; travel angle {:.4}", of("travel_angle"));
    assert!((found / way - 1.0).abs() < 5e-3, "{found} {way}");
    assert!((of("travel_angle") - DIP).abs() < 0.05, "{runout}");
    assert!((of("advance") / cos / way - 1.0).abs() < 5e-3, "{runout}");
    assert_eq!((of("largest_share"), of("moved_share"), of("below_ground")), (1.0, 1.0, 0.0));
    assert!(summary["energy"]["largest_relative_error"].as_f64().unwrap() < 1e-3, "{}", summary["energy"]);
    assert!(of("deepest") > 0.9 && of("deepest") < 1.0 / cos + 0.5, "{runout}");
    let front = Table::read(&folder.join("r/history.csv")).column("runout_front");
    assert!((front[front.len() - 1] - of("front")).abs() < 1e-12);
    let origins = fs::read_to_string(folder.join("r/origins.csv")).unwrap();
    assert!(origins.starts_with("id,x0 [m],y0 [m],z0 [m],x [m],y [m],z [m],fragment\n0,"), "{origins}");
    for name in ["runout.vti", "runout.png", "outline.csv", "fragments.csv"] {
        assert!(folder.join("r").join(name).exists(), "{name}");
    }
    let frame = fs::read_to_string(folder.join("r/frames/grains_00002.vtp")).unwrap();
    assert!(frame.contains("Name=\"displacement\"") && frame.contains("Name=\"initial_position\""));
}

#[test]
fn terrain_comes_in_every_form() {
    let folder = Folder::new("terrain");
    folder.write("block.csv", &block(0.25));
    let fall = |x: f64| -x * (DIP * PI / 180.0).tan();
    let corners: Vec<[f64; 3]> = [-2.0, 40.0]
        .into_iter()
        .flat_map(|x| [-5.0, 5.0].map(|y| [[x, y, fall(x)], [x, y, -40.0]]))
        .flatten()
        .collect();
    let mut list = String::from("8 14\n");
    for [x, y, z] in &corners {
        writeln!(list, "{x:e} {y:e} {z:e}").unwrap();
    }
    // Ascending indices carry no orientation.
    for t in [
        "1 3 5", "3 5 7", "2 4 6", "4 6 8", "1 2 3", "2 3 4", "5 6 7", "6 7 8", "1 2 5", "2 5 6", "3 4 7",
        "4 7 8", "1 2 7", "2 7 8",
    ] {
        writeln!(list, "{t}").unwrap();
    }
    folder.write("body.dat", &list);
    let file = folder.write("scene.toml", &scene("body.dat"));
    run(&file, &folder.join("r"), &["time.end=0.5"]).good();
    let runout = json(&folder.join("r/summary.json"))["runout"].clone();
    let (sin, cos) = (DIP * PI / 180.0).sin_cos();
    let way = 9.81 * (sin - 0.3 * cos) * 0.25 / 2.0;
    let found =
        (runout["centre_end"][0].as_f64().unwrap() - runout["centre_start"][0].as_f64().unwrap()) / cos;
    assert!((found / way - 1.0).abs() < 2e-2, "{found} {way}");
    assert_eq!((runout["below_ground"].as_u64(), runout["beyond_ground"].as_u64()), (Some(0), Some(0)));
}

#[test]
fn a_mesh_of_elements_is_filled() {
    let folder = Folder::new("skin");
    let mesh = repository().join("inputs/coupled/slab_mixed");
    let mesh = fs::read_dir(mesh)
        .unwrap()
        .map(|e| e.unwrap().path())
        .find(|p| p.extension().is_some_and(|e| e == "inp"));
    let mesh = mesh.unwrap();
    let info = trackbed(["stone", "info", &mesh.display().to_string()]).good().stdout;
    assert!(info.contains("volume"), "{info}");
    let text = scene("x.stl");
    let (head, _) = text.split_once("[[grains]]").unwrap();
    let file = folder.write(
        "scene.toml",
        &format!(
            "{head}[[grains]]\nname = \"fill\"\nshape = \"sphere\"\nmaterial = \"rock\"\ncount = 50\nsize = [0.02, 0.02]\n\
             region = {{ surface = {:?} }}\n[time]\nend = 1e-4\n[output]\nframes = 0\n",
            mesh.display()
        ),
    );
    run(&file, &folder.join("r"), &[]).good();
    assert_eq!(json(&folder.join("r/summary.json"))["model"]["bodies"], 50);
}

#[test]
fn what_is_no_slide_is_refused() {
    let folder = Folder::new("refused");
    folder.write("incline.asc", &incline());
    folder.write("block.csv", &block(0.25));
    let file = folder.write("scene.toml", &scene("incline.asc"));
    for (set, sentence) in [
        ("runout.direction=[0, 0]", "runout.direction: found 0, expected a vector that is not null"),
        ("runout.groups=[\"x\"]", "runout.groups.0: found \"x\", expected the name of a [[grains]]: block"),
        ("runout.groups=[]", "runout.groups: found none, expected at least one group that can slide"),
        ("runout.cell=0", "runout.cell: found 0, expected a length above 0"),
        ("runout.depth=-1", "runout.depth: found -1, expected a length above 0"),
        ("runout.share=0.2", "runout.share: found 0.2, expected 0.5 to 1"),
        (
            "output.fields=[\"broken\"]",
            "output.fields.0: found \"broken\", expected one of acceleration, broken_bonds,",
        ),
        (
            "bond.0.stiffness_spread={ kind = \"normal\" }",
            "bond.0.stiffness_spread: found other keys, expected `deviation`",
        ),
    ] {
        let outcome = trackbed(["check", &file.display().to_string(), "--set", set]);
        assert_eq!(outcome.code, 2, "{set}: {outcome:?}");
        assert!(outcome.stderr.contains(sentence), "{sentence}\n{}", outcome.stderr);
    }
}

/// Chain of bonds with scattered moduli: mean compliance.
#[test]
fn stiffnesses_spread() {
    let folder = Folder::new("spread");
    let spheres: Vec<String> = (0..202).map(|k| format!("[0, 0, {}, 0.01]", 0.02 * f64::from(k))).collect();
    let (middle, ends) = (&spheres[1..201], [&spheres[0], &spheres[201]]);
    let file = folder.write(
        "scene.toml",
        &format!(
            "gravity = [0, 0, 0]\n[[material]]\nname = \"rock\"\ndensity = 2600\nstiffness = 1e6\nfriction = 0.5\nrestitution = 0.5\n\
             [[grains]]\nname = \"foot\"\nshape = \"sphere\"\nmaterial = \"rock\"\nspheres = [{}]\nprescribed_velocity = [0, 0, 0]\n\
             [[grains]]\nname = \"row\"\nshape = \"sphere\"\nmaterial = \"rock\"\nspheres = [{}]\n\
             [[grains]]\nname = \"head\"\nshape = \"sphere\"\nmaterial = \"rock\"\nspheres = [{}]\nprescribed_velocity = [0, 0, 0.01]\nrecord = true\n\
             [[bond]]\nname = \"b\"\ngap = 1e-4\ndamping = 1.0\n[bond.parallel]\nyoung = 1e9\n\
             [time]\nend = 0.03\n[output]\nframes = 0\n",
            ends[0],
            middle.join(", "),
            ends[1]
        ),
    );
    let force = |set: &[&str], out: &str| {
        run(&file, &folder.join(out), set).good();
        // Second half only: waves average out.
        let force = Table::read(&folder.join(out).join("history.csv")).column("head_force_z");
        -force[force.len() / 2..].iter().sum::<f64>()
    };
    let alike = force(&[], "a");
    let spread = force(&["bond.0.stiffness_spread={ kind = \"normal\", deviation = 0.2 }"], "b");
    // E[1/x] = 1.0456 for a normal law with mean 1 and deviation 0.2; 201 bonds scatter by 1.6 %.
    println!("softer by {:.4}, expected 1.0456", alike / spread);
    assert!((alike / spread - 1.0456).abs() < 0.05, "{alike} {spread}");
    assert!((alike / spread - 1.0).abs() > 5e-3);
}

/// Energies of passed cells stay below the energy of the fall; results survive interruption.
#[test]
fn passed_cells_hold_the_energy_of_the_fall() {
    let scene = repository().join("inputs/geo/dam.toml");
    let set = ["time.end=8", "output.frames=1", "grains.0.count=4"];
    let folder = Folder::new("passage");
    run(&scene, &folder.join("out"), &set).good();
    let (table, summary) =
        (Table::read(&folder.join("out/passage.csv")), json(&folder.join("out/summary.json")));
    let [x, y, ground, energy] = ["x", "y", "ground", "energy"].map(|name| table.column(name));
    let mass = summary["runout"]["mass"].as_f64().unwrap();
    assert!(x.len() > 10 && table.column("entries").iter().any(|n| *n >= 2.0), "{} cells", x.len());
    for k in 0..x.len() {
        // Terrain: a slope of 32 degrees with bumps of a few metres; stones begin 20 m above it.
        let most = mass * 9.81 * (458.0 - ground[k]) + 0.5 * mass * 9.0;
        assert!(energy[k] <= most, "{} J at {}, {}; the fall of all has {most} J", energy[k], x[k], y[k]);
        assert!((x[k] / 20.0 - 0.5).fract() == 0.0 && (ground[k] - 0.6249 * (1000.0 - x[k])).abs() < 40.0);
    }
    let fastest = energy.iter().copied().fold(0.0, f64::max);
    assert!(fastest > 0.01 * mass * 9.81 * 100.0, "{fastest} J");
    super::checkpoint::broken(&scene, &set, &[0.3, 0.7], &["passage.csv"]);
}

/// Cells keep the side of the scene where the grid of the deposit has too many.
#[test]
fn passed_cells_keep_their_side() {
    let scene = "title = \"far\"\n[[material]]\nname = \"rock\"\ndensity = 2600\nstiffness = \"1 MN/m\"\nfriction = 0.5\nrestitution = 0.3\n\
                 [[grains]]\nname = \"rocks\"\nshape = \"sphere\"\nmaterial = \"rock\"\n\
                 spheres = [[0.5, 0.5, 0.5, 0.5], [5000.5, 0.5, 0.5, 0.5]]\n\
                 [[walls]]\nkind = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = \"rock\"\n\
                 [runout]\ndirection = [1, 0]\ncell = 1\npassage = true\n[time]\nend = \"10 ms\"\n[output]\nvtk = false\n";
    let folder = super::support::scene_folder("far", scene);
    run(&folder.join("scene.toml"), &folder.join("out"), &[]).good();
    let x = Table::read(&folder.join("out/passage.csv")).column("x");
    assert!(x.contains(&0.5) && x.contains(&5000.5), "{x:?}");
    let runout = &json(&folder.join("out/summary.json"))["runout"];
    assert!(runout["passage_cell"] == 1.0 && runout["cell"].as_f64().unwrap() > 1.0, "{runout}");
}

/// Values of an ESRI grid by position.
fn grid(maps: &Path, name: &str) -> impl Fn(f64, f64) -> f64 + use<> {
    let mut files = fs::read_dir(maps).unwrap().map(|e| e.unwrap().path());
    let file = files.find(|f| f.display().to_string().ends_with(&format!("_{name}.asc"))).unwrap();
    let text = fs::read_to_string(file).unwrap();
    let head: Vec<f64> =
        text.lines().take(6).map(|l| l.split_whitespace().nth(1).unwrap().parse().unwrap()).collect();
    let rows: Vec<Vec<f64>> =
        text.lines().skip(6).map(|l| l.split(' ').map(|v| v.parse().unwrap()).collect()).collect();
    assert_eq!([rows[0].len() as f64, rows.len() as f64], [head[0], head[1]]);
    move |x: f64, y: f64| {
        let (i, j) = ((x - head[2]) / head[4], (y - head[3]) / head[4]);
        rows[rows.len() - 1 - j as usize][i as usize]
    }
}

/// Maps of three releases against their own tables.
#[test]
fn hazard_maps_count_releases() {
    let folder = Folder::new("hazard");
    let scene = repository().join("inputs/geo/dam.toml");
    let study = format!(
        "scene = {:?}\n[base]\nset = [\"time.end=6\", \"output.vtk=false\", \"grains.0.count=3\"]\n[seeds]\nvalues = [1, 2, 3]\n\
         [[quantity]]\nsummary = \"runout.farthest\"\n[hazard]\nquantile = 0.6\nenergies = [1e5]\n",
        scene.display().to_string()
    );
    let file = folder.write("study.toml", &study);
    let out = folder.join("out");
    let arguments =
        ["study", &file.display().to_string(), "--out", &out.display().to_string(), "--threads", "1"];
    let said = trackbed(arguments).good().stdout;
    assert!(said.contains("60 % energy [kJ]") && said.contains("95 % confidence"), "{said}");
    let grid = |name: &str| grid(&out.join("maps"), name);
    let runs: Vec<Table> = fs::read_dir(out.join("runs"))
        .unwrap()
        .map(|e| e.unwrap().path().join("passage.csv"))
        .filter(|f| f.exists())
        .map(|f| Table::read(&f))
        .collect();
    assert_eq!(runs.len(), 3);
    let (reach, energy, above) = (grid("reach"), grid("energy"), grid("above_100kJ"));
    let of = |run: &Table, x: f64, y: f64| {
        let (xs, ys) = (run.column("x"), run.column("y"));
        (0..xs.len()).find(|k| xs[*k] == x && ys[*k] == y).map(|k| run.column("energy")[k])
    };
    for (x, y) in runs.iter().flat_map(|run| run.column("x").into_iter().zip(run.column("y"))) {
        let mut energies: Vec<f64> = runs.iter().map(|run| of(run, x, y).unwrap_or(-1.0)).collect();
        energies.sort_by(f64::total_cmp);
        let share = |least: f64| energies.iter().filter(|e| **e > least).count() as f64 / 3.0;
        assert!((reach(x, y) - share(-0.5)).abs() < 1e-12 && (above(x, y) - share(1e5)).abs() < 1e-12);
        // The second of three is not exceeded in 60 % of the runs.
        assert_eq!(energy(x, y), energies[1].max(0.0));
    }
    // Samples of parameters are releases of one case.
    let sampled = study.replace(
        "[seeds]\nvalues = [1, 2, 3]\n",
        "[sampling]\nmethod = \"sobol\"\nsamples = 4\n[[parameter]]\nkey = \"material.rock.restitution\"\nrange = [0.2, 0.5]\n",
    );
    let file = folder.write("sampled.toml", &sampled);
    let out = folder.join("sampled");
    trackbed(["study", &file.display().to_string(), "--out", &out.display().to_string()]).good();
    let maps = &json(&out.join("study.json"))["analysis"]["hazard"];
    assert!(maps.as_array().unwrap().len() == 1 && maps[0]["runs"] == 4, "{maps}");
    assert!(out.join("maps/all-samples_reach.asc").exists());
    let file = folder.write(
        "without.toml",
        &study.replace("[\"time.end=6\"", "[\"runout.passage=false\", \"time.end=6\""),
    );
    let out = folder.join("without");
    let said = trackbed(["study", &file.display().to_string(), "--out", &out.display().to_string()]);
    assert!(said.code == 2 && said.stderr.contains("runout.passage") && !out.exists(), "{}", said.stderr);
    for (key, line) in [
        ("energies = [1e5]", "energies = [2, 1]"),
        ("quantile = 0.6", "quantile = 0.2"),
        ("[hazard]", "[hazard]\nnonsense = 1"),
    ] {
        let file = folder.write("wrong.toml", &study.replace(key, line));
        let said = trackbed([
            "study",
            &file.display().to_string(),
            "--out",
            &folder.join("w").display().to_string(),
        ]);
        assert!(said.code == 2 && said.stderr.contains("hazard"), "{}", said.stderr);
    }
}

/// Largest sag of a chain of strands under a load that is let go in its middle: W f = k (√(l² + f²) − l)² for halves of
/// length l and stiffness k.
#[test]
fn strands_stretch_as_a_cable() {
    let folder = Folder::new("strands");
    let nodes: Vec<String> =
        (1..20).filter(|k| *k != 10).map(|k| format!("[{}, 0, 0, 0.01]", 0.1 * f64::from(k))).collect();
    let number = |k: usize| match k {
        0 => 19,
        10 => 18,
        20 => 20,
        k if k < 10 => k - 1,
        k => k - 2,
    };
    let pairs: Vec<String> = (0..20).map(|k| format!("{},{}", number(k), number(k + 1))).collect();
    folder.write("pairs.csv", &format!("a,b\n{}\n", pairs.join("\n")));
    let scene = folder.write(
        "scene.toml",
        &format!(
            "title = \"chain\"\n[[material]]\nname = \"strand\"\ndensity = 1000\nstiffness = \"1 MN/m\"\nfriction = 0.3\nrestitution = 0.5\n\
             [[material]]\nname = \"load\"\ndensity = 2e6\nstiffness = \"1 MN/m\"\nfriction = 0.3\nrestitution = 0.5\n\
             [[grains]]\nname = \"nodes\"\nshape = \"sphere\"\nmaterial = \"strand\"\nspheres = [{}]\n\
             [[grains]]\nname = \"load\"\nshape = \"sphere\"\nmaterial = \"load\"\nspheres = [[1, 0, 0, 0.01]]\n\
             [[grains]]\nname = \"ends\"\nshape = \"sphere\"\nmaterial = \"strand\"\nprescribed_velocity = [0, 0, 0]\n\
             spheres = [[0, 0, 0, 0.01], [2, 0, 0, 0.01]]\n\
             [[bond]]\nname = \"strand\"\npairs = \"pairs.csv\"\ndamping = 0.0\n\
             contact_point = {{ normal_stiffness = \"200 kN/m\", shear_stiffness = 0.0 }}\n\
             [[probe]]\nname = \"load\"\ngrain = 18\n[time]\nend = \"0.6 s\"\n[output]\nframes = 0\nvtk = false\n",
            nodes.join(", ")
        ),
    );
    run(&scene, &folder.join("out"), &[]).good();
    let history = Table::read(&folder.join("out/history.csv"));
    let z = history.column("load_x_z");
    let sag = z.iter().fold(0.0, |most: f64, z| most.max(-z));
    // Ten strands of 0.1 m on each side.
    let (stiffness, weight) = (200e3 / 10.0, 9.81 * 2e6 * 4.0 / 3.0 * PI * 1e-6);
    let stored = |f: f64| stiffness * ((1.0 + f * f).sqrt() - 1.0).powi(2);
    let (mut low, mut high) = (0.01, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if stored(middle) < weight * middle { low = middle } else { high = middle }
    }
    assert!((sag / low - 1.0).abs() < 0.01, "{sag} m, closed form {low} m");
}
