//! Plastic solids.

use super::determinism::same_bits;
use super::support::{COUPLED, Folder, PLASTIC, Table, json, repository, run, scene_folder, trackbed_in};

/// Strength 2 c cos φ/(1 − sin φ) = 62.787 kPa.
const COLUMN: &str = r#"title = "column"

[solid]
gravity = false

[solid.block]
x = { lines = [0.0, 1.0], counts = [1] }
y = { lines = [0.0, 1.0], counts = [1] }
z = { lines = [0.0, 4.0], counts = [4] }

[[solid.material]]
id = 1
name = "soil"
model = "mohr_coulomb"
young = "20 MPa"
poisson = 0.3
density = 1900
cohesion = "20 kPa"
friction = "25 deg"
dilation = "25 deg"

[[solid.support]]
name = "base"
side = "z-"
directions = ["z"]

[[solid.support]]
side = "x-"
directions = ["x"]

[[solid.support]]
side = "y-"
directions = ["y"]

[[solid.load]]
kind = "pressure"
side = "z+"
pressure = "100 kPa"
history = { kind = "ramp", duration = 1.0 }

[solid.quasi_static]

[time]
end = 1.0
solid_step = 0.1

[[probe]]
name = "top"
at = [1.0, 1.0, 4.0]

[output]
frames = 10
history_interval = 0.1
tables = true
"#;

#[test]
fn limit_load_keeps_last_equilibrium() {
    let folder = Folder::new("beyond");
    let scene = folder.write("scene.toml", COLUMN);
    let out = folder.join("out");
    let outcome = run(&scene, &out, &[]);
    assert_eq!(outcome.code, 3, "{outcome:?}");
    for word in ["not converged at time 0.62", "element ", "integration point ", "residual"] {
        assert!(outcome.stderr.contains(word), "no {word:?} in {}", outcome.stderr);
    }
    let phi = 25.0_f64.to_radians();
    let strength = 2.0 * 20e3 * phi.cos() / (1.0 - phi.sin());
    let summary = json(&out.join("summary.json"));
    let status = summary["status"].as_str().unwrap();
    assert!(
        status.starts_with("failed: ") && outcome.stderr.contains(&status["failed: ".len()..]),
        "{status}"
    );
    assert!(std::fs::read_to_string(out.join("log.txt")).unwrap().contains(status));
    assert!(summary["newton"]["halvings"].as_u64().unwrap() > 0);

    let history = Table::read(&out.join("history.csv"));
    let (time, base) = (history.column("time"), history.column("base_reaction_z"));
    let [reached, carried] = [&time, &base].map(|column| *column.last().unwrap());
    println!("carried {carried:.1} Pa at {reached}, strength {strength:.1} Pa");
    assert!(carried < strength * (1.0 + 1e-6) && carried > 0.999 * strength);
    assert!((carried / (100e3 * reached) - 1.0).abs() < 1e-6, "the load of {reached}");
    assert_eq!(time.len(), 8, "whole steps up to 0.6, and where it stopped: {time:?}");
    assert_eq!(summary["reactions"][0]["force"][2].as_f64().unwrap(), carried);
    assert!(summary["energy"]["relative_error"].as_f64().unwrap() < 1e-6, "{}", summary["energy"]);
    let nodes = Table::read(&out.join("nodes.csv"));
    let total: f64 = nodes.column("rz").iter().sum();
    assert!((total / carried - 1.0).abs() < 1e-9, "{total}");
    let lowest = nodes.column("uz").into_iter().fold(0.0, f64::min);
    let top = *history.column("top_u_z").last().unwrap();
    assert!((lowest / top - 1.0).abs() < 1e-6, "{lowest} and {top}");
    let gauss = Table::read(&out.join("gauss.csv"));
    assert!(gauss.column("szz").iter().all(|s| (s / -carried - 1.0).abs() < 1e-6));
    assert!(out.join("frames/solid_00007.vtu").is_file() && !out.join("frames/solid_00008.vtu").exists());
}

const TOP: [[f64; 2]; 8] =
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]];

#[test]
fn dynamic_plastic_column_conserves_energy() {
    let folder = Folder::new("pulse");
    let probes: String = TOP
        .iter()
        .enumerate()
        .map(|(i, [x, y])| format!("[[probe]]\nname = \"top{i}\"\nat = [{x}, {y}, 4.0]\n\n"))
        .collect();
    let scene = folder.write(
        "scene.toml",
        &COLUMN
            .replace("[output]", &format!("{probes}[output]"))
            .replace("[solid.quasi_static]", "[solid.dynamics]")
            .replace(
                "kind = \"ramp\", duration = 1.0",
                "kind = \"haversine\", frequency = \"20 Hz\", cycles = 1",
            )
            .replace("end = 1.0", "end = 0.1")
            .replace("solid_step = 0.1", "solid_step = \"0.5 ms\"")
            .replace("interval = 0.1", "interval = 0.001"),
    );
    let set = ["solid.load.0.pressure=\"150 kPa\"", "solid.rayleigh.beta_k=2e-4", "output.frames=2"];
    run(&scene, &folder.join("out"), &set).good();
    let summary = json(&folder.join("out/summary.json"));
    let energy = &summary["energy"];
    let spent = |key: &str| energy["flows"][key].as_f64().unwrap();
    let stored = |key: &str| energy["end"][key].as_f64().unwrap();
    let work = spent("solid_load_work");
    let stored = stored("solid_kinetic") + stored("solid_strain");
    let open = (work - stored - spent("plastic") - spent("rayleigh")) / work;
    println!(
        "work {work:.1} J, plastic {:.1}, damping {:.1}, stored {stored:.1}, open {open:.1e} of the work, numerical {:.1e}",
        spent("plastic"),
        spent("rayleigh"),
        spent("numerical") / work
    );
    assert!(open.abs() < 5e-3 && (spent("numerical") / work).abs() < 5e-3);
    assert!(energy["relative_error"].as_f64().unwrap() < 5e-3);
    assert!(spent("plastic") > 0.5 * work && spent("rayleigh") > 0.0);
    let history = Table::read(&folder.join("out/history.csv"));
    let tops: Vec<Vec<f64>> = (0..TOP.len()).map(|i| history.column(&format!("top{i}_u_z"))).collect();
    assert!(tops.iter().all(|top| top[top.len() - 20..].iter().all(|u| *u < -1e-2)));
    // Consistent nodal loads: -1/12 (corners), 1/3 (mid-sides).
    let top: Vec<f64> = (0..tops[0].len())
        .map(|row| (0..8).map(|i| tops[i][row] * if i < 4 { -1.0 / 12.0 } else { 1.0 / 3.0 }).sum())
        .collect();
    // Work of the load by the trapezoidal rule over history rows.
    let pressure =
        |t: f64| 150e3 * (std::f64::consts::PI * 20.0 * t).sin().powi(2) * f64::from(u8::from(t <= 0.05));
    let time = history.column("time");
    let by_hand: f64 = (1..time.len())
        .map(|i| 0.5 * (pressure(time[i]) + pressure(time[i - 1])) * (top[i - 1] - top[i]))
        .sum();
    println!("work from the history {by_hand:.1} J");
    assert!((by_hand / work - 1.0).abs() < 5e-3, "{by_hand} J against {work} J");
}

#[test]
fn plastic_footing_is_identical_across_threads() {
    let set = [
        "time.end=0.2",
        "solid.material.0.dilation=\"10 deg\"",
        "output.frames=1",
        "output.tables=true",
        "output.tecplot=true",
    ];
    let scene = repository().join("inputs/solid/footing.toml");
    let expected =
        ["history.csv", "nodes.csv", "gauss.csv", "frames/solid_00001.vtu", "tecplot/solid_00001.dat"];
    let folder = same_bits(&scene, &set, &expected);
    let newton = &json(&folder.join("2/summary.json"))["newton"];
    assert!(newton["factorizations_unsymmetric"].as_u64().unwrap() > 0, "{newton}");
    let kappa = Table::read(&folder.join("2/gauss.csv")).column("equivalent_plastic_strain");
    assert!(kappa.iter().any(|k| *k > 0.0));
}

const SETTLED: [&str; 3] = ["track.load.rest=0.3", "track.load.cycles=3", "material.0.restitution=0.1"];

fn soil(cohesion: &str) -> Vec<String> {
    ["model=\"mohr_coulomb\"", &format!("cohesion={cohesion}"), "friction=\"20 deg\"", "dilation=\"6 deg\""]
        .map(|key| format!("solid.material.0.{key}"))
        .into()
}

#[test]
fn strong_soil_matches_elastic_ground() {
    let folder = scene_folder("strong", COUPLED);
    let scene = folder.join("scene.toml");
    run(&scene, &folder.join("elastic"), &[]).good();
    let strong = soil("1e9");
    let set: Vec<&str> = strong.iter().map(String::as_str).collect();
    run(&scene, &folder.join("plastic"), &set).good();
    let [one, other] = ["elastic", "plastic"].map(|o| Table::read(&folder.join(&format!("{o}/history.csv"))));
    assert_eq!((&one.heads, one.rows.len()), (&other.heads, other.rows.len()));
    let strain = one.column("solid_strain").into_iter().fold(0.0, f64::max);
    for (name, scale, tolerance) in [
        ("sleeper_z", None, 1e-6),
        ("contact_force_on_solid_z", None, 1e-6),
        ("middle_u_z", None, 1e-6),
        ("middle_v_z", None, 1e-5),
        ("grains_kinetic", Some(strain), 1e-6),
        ("contact_springs", Some(strain), 1e-6),
        ("solid_kinetic", Some(strain), 1e-6),
        ("solid_strain", Some(strain), 1e-6),
        ("work", Some(strain), 1e-6),
        ("dissipated_solid", Some(strain), 1e-6),
    ] {
        let (a, b) = (one.column(name), other.column(name));
        let largest = scale.unwrap_or_else(|| a.iter().fold(0.0_f64, |m, x| m.max(x.abs())));
        let farthest = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{name}: {:.1e}", farthest / largest);
        assert!(farthest <= tolerance * largest, "{name}: {farthest:e} of {largest:e}");
    }
    let summary = json(&folder.join("plastic/summary.json"));
    assert_eq!(summary["newton"]["factorizations_unsymmetric"], 0, "nothing yields");
}

#[test]
fn grains_press_into_weak_soil() {
    let folder = scene_folder("weak", COUPLED);
    let scene = folder.join("scene.toml");
    let weak = soil("4e3");
    let mut settlement = Vec::new();
    for (out, set) in [("elastic", &[][..]), ("plastic", &weak[..])] {
        let set: Vec<&str> = SETTLED
            .into_iter()
            .chain(["track.load.maximum=15e3"])
            .chain(set.iter().map(String::as_str))
            .collect();
        run(&scene, &folder.join(out), &set).good();
        let summary = json(&folder.join(&format!("{out}/summary.json")));
        let energy = &summary["energy"];
        let relative = energy["relative_error"].as_f64().unwrap();
        let plastic = energy["flows"]["plastic"].as_f64().unwrap();
        println!("{out}: plastic {plastic:.3} J of {:.3} J, error {:.4} %", energy["work"], 100.0 * relative);
        assert!(relative < 0.01);
        assert_eq!(plastic > 1.0, out == "plastic");
        let transfer = &summary["coupling"]["transfer"];
        assert!(["force", "moment"].iter().all(|k| transfer[k].as_f64().unwrap() < 1e-12), "{transfer}");
        settlement.push(summary["settlement"]["per_cycle"][2].as_f64().unwrap());
    }
    println!("settlement {settlement:?} m");
    assert!(settlement[1] > settlement[0] + 1e-4, "{settlement:?}");
}

#[test]
fn mesh_formats_give_identical_results() {
    let folder = Folder::new("forms");
    let start = PLASTIC.find("[solid.block]").unwrap();
    let end = PLASTIC.find("[[solid.material]]").unwrap();
    let scene = format!("{PLASTIC}tables = true\n");
    folder.write("scene.toml", &scene);
    let bare = format!(
        "{}\n[solid.quasi_static]\n\n[time]\nend = 1.0\nsolid_step = 0.1\n",
        &PLASTIC[..PLASTIC.find("[[solid.support]]").unwrap()]
    );
    folder.write("bare.toml", &bare);
    run(&folder.join("scene.toml"), &folder.join("reference"), &[]).good();
    let tables = |out: &str| {
        ["nodes.csv", "gauss.csv", "history.csv"]
            .map(|name| std::fs::read_to_string(folder.join(&format!("{out}/{name}"))).unwrap())
    };
    let reference = tables("reference");
    assert!(Table::read(&folder.join("reference/nodes.csv")).column("ux").iter().any(|u| u.abs() > 1e-5));
    for form in ["lists", "mesh.cdb", "mesh.msh", "mesh22.msh", "mesh.inp", "mesh.vtu", "mesh.vtk"] {
        let mut arguments = vec!["mesh", "convert", "bare.toml", form];
        if form == "mesh22.msh" {
            arguments.extend(["--format", "msh2"]);
        }
        trackbed_in(folder.path(), arguments).good();
        let other = scene.replace(&PLASTIC[start..end], "").replacen(
            "gravity = false",
            &format!("gravity = false\nmesh = \"{form}\""),
            1,
        );
        let file = folder.write(&format!("with_{form}.toml"), &other);
        let out = format!("out_{form}");
        run(&file, &folder.join(&out), &[]).good();
        for (one, two) in reference.iter().zip(tables(&out)) {
            assert!(*one == two, "{form} gives another result");
        }
    }
}
