//! Ballast under load cycles.

use super::support::{Folder, Outcome, Table, json, repository, results, run};
use std::path::Path;
use trackbed::failure::Failure;
use trackbed::run::{Interrupt, Options, Verbosity};

const BED: &str = r#"title = "bed"

[[material]]
name = "stone"
density = 2650
stiffness = "0.5 MN/m"
friction = 0.5
restitution = 0.5

[[grains]]
name = "bed"
shape = "sphere"
material = "stone"
count = 60
size = ["40 mm", "60 mm"]
fill = { low = [0.0, 0.0, 0.0], high = [0.25, 0.25] }
seed = 2

[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "stone"

[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [1, 0, 0]
material = "stone"

[[walls]]
kind = "plane"
point = [0.25, 0, 0]
normal = [-1, 0, 0]
material = "stone"

[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
material = "stone"

[[walls]]
kind = "plane"
point = [0, 0.25, 0]
normal = [0, -1, 0]
material = "stone"

[deposition]
max_time = "0.5 s"
settled_speed = "50 mm/s"
local_damping = 0.3

[time]
grain_step = "30 us"
accept_step_above_limit = true

[output]
frames = 2
vtk = false
history_interval = "20 ms"

[track.sleeper]
size = [0.24, 0.24, 0.1]
mass = 15
material = "stone"
centre = [0.125, 0.125]
hold = ["x", "y", "rx", "ry", "rz"]

[track.load]
kind = "haversine"
minimum = 200
maximum = 1000
frequency = 20
cycles = 40
rest = "20 ms"
ramp = "20 ms"
"#;

fn bed(name: &str, more: &str) -> Folder {
    let folder = Folder::new(name);
    folder.write("scene.toml", &format!("{BED}{more}"));
    folder
}

fn go(folder: &Folder, out: &str, set: &[&str]) -> Outcome {
    run(&folder.join("scene.toml"), &folder.join(out), set)
}

/// Rigid block on a plane: 100 kg, friction coefficients 0.6 and 0.4.
const BLOCK: &str = r#"title = "block on a plane"

[[material]]
name = "plane"
stiffness = "2 MN/m"
friction = 0.4
restitution = 0.3

[[material]]
name = "block"
density = 2500
stiffness = "2 MN/m"
friction = 0.6
restitution = 0.3

[[grains]]                  # out of the way
name = "pebble"
shape = "sphere"
material = "block"
spheres = [[5.0, 5.0, 0.05, 0.05]]

[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "plane"

[time]
grain_step = "20 us"
accept_step_above_limit = true

[output]
frames = 1
vtk = false

[track.sleeper]
size = [0.5, 0.3, 0.2]
mass = 100
material = "block"
centre = [0, 0]
hold = ["rx", "ry", "rz"]

[track.push]
direction = [3, 4]
speed = "20 mm/s"
displacement = "5 mm"
rest = "200 ms"
"#;

#[test]
fn block_resists_by_coulomb_friction() {
    let folder = Folder::new("push");
    folder.write("scene.toml", BLOCK);
    for (load, set) in [(0.0, vec![]), (500.0, vec!["track.push.load=500"])] {
        go(&folder, "out", &set).good();
        let push = &json(&folder.join("out/summary.json"))["push"];
        let weight = 100.0 * 9.81 + load;
        assert_eq!(push["vertical_force"], weight);
        // Steady sliding at 0.4 W (Coulomb), independent of direction and actuator height.
        for key in ["resistance_at_2_mm", "residual"] {
            let found = push[key].as_f64().unwrap();
            assert!((found / (0.4 * weight) - 1.0).abs() < 2e-3, "{key}: {found} against {}", 0.4 * weight);
        }
        let history = Table::read(&folder.join("out/history.csv"));
        assert_eq!(*history.column("load").last().unwrap(), load, "the history has the load that acts");
        let curve = Table::read(&folder.join("out/push.csv"));
        let (way, force) = (curve.column("displacement"), curve.column("force"));
        assert!(way.windows(2).all(|w| w[0] < w[1]), "the block follows the ram");
        assert!((way.last().unwrap() - 5e-3).abs() < 1e-4, "{:?}", way.last());
        assert!(force[0] < 0.5 * force[100], "{} {}", force[0], force[100]);
        let energy = &json(&folder.join("out/summary.json"))["energy"];
        assert!(energy["relative_error"].as_f64().unwrap() < 1e-3, "{energy}");
    }
}

/// Slope 1:10: horizontal actuator force W tan(θ + φ), uplift a tenth of the displacement.
#[test]
fn push_on_slope_above_base() {
    let folder = Folder::new("slope");
    let slope = BLOCK
        .replace("point = [0, 0, 0]\nnormal = [0, 0, 1]", "point = [0, 0, -0.0251]\nnormal = [-0.1, 0, 1]")
        .replace("[5.0, 5.0, 0.05, 0.05]", "[0.0, 5.0, 0.026, 0.05]")
        .replace("direction = [3, 4]", "direction = [1, 0]");
    folder.write("scene.toml", &slope);
    go(&folder, "out", &[]).good();
    let push = &json(&folder.join("out/summary.json"))["push"];
    let expected = 981.0 * 0.5 / (1.0 - 0.04);
    let residual = push["residual"].as_f64().unwrap();
    assert!((residual / expected - 1.0).abs() < 5e-3, "{residual} {expected}");
    let way = *Table::read(&folder.join("out/push.csv")).column("displacement").last().unwrap();
    let uplift = push["uplift"].as_f64().unwrap();
    // Sinking at two corners from the increased normal force.
    let (cos, sin) = (1.0 / 1.01_f64.sqrt(), 0.1 / 1.01_f64.sqrt());
    let sunk = 981.0 * (1.0 / (cos - 0.4 * sin) - cos) / (2.0 * 2e6);
    let expected = 0.1 * way - sunk / cos;
    assert!((uplift / expected - 1.0).abs() < 1e-3, "{uplift} m, {expected} m, in {way} m");

    folder.write("scene.toml", &BLOCK.replace("\"rx\", \"ry\"", "\"rx\"").replace("[3, 4]", "[1, 0]"));
    let tilts = ["0", "0.1"].map(|height| {
        go(&folder, "out", &[&format!("track.push.height={height}")]).good();
        *Table::read(&folder.join("out/history.csv")).column("sleeper_tilt").last().unwrap()
    });
    let lean = |height: f64| 0.4 * 981.0 * (height + 0.1) / (4.0 * 2e6 * 0.25 * 0.25);
    println!("tilts {tilts:?}, {} {}", lean(0.0), lean(0.1));
    assert!(
        (tilts[0] / lean(0.0) - 1.0).abs() < 0.02 && (tilts[1] / lean(0.1) - 1.0).abs() < 0.02,
        "{tilts:?}"
    );
}

#[test]
fn settlement_rates_and_stiffness_match_cycles() {
    let folder = bed("laws", "");
    go(&folder, "out", &[]).good();
    let cycles = Table::read(&folder.join("out/cycles.csv"));
    let (n, s) = (cycles.column("cycle"), cycles.column("settlement"));
    assert_eq!(n.len(), 40);
    let summary = json(&folder.join("out/summary.json"));
    let settlement = &summary["settlement"];
    let fit =
        settlement["fits"].as_array().unwrap().iter().find(|f| f["law"] == "Alva-Hurtado & Selig").unwrap();
    assert_eq!((fit["range"][0].as_f64(), fit["points"].as_u64()), (Some(10.0), Some(31)));
    // Independent regression.
    let used: Vec<(f64, f64)> =
        n.iter().zip(&s).filter(|p| *p.0 >= 10.0).map(|(n, s)| (n.log10(), *s)).collect();
    let count = used.len() as f64;
    let (mx, my) =
        (used.iter().map(|p| p.0).sum::<f64>() / count, used.iter().map(|p| p.1).sum::<f64>() / count);
    let slope = used.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum::<f64>()
        / used.iter().map(|p| (p.0 - mx).powi(2)).sum::<f64>();
    let first = my - slope * mx;
    let parameter = |k: usize| fit["parameters"][k][1].as_f64().unwrap();
    assert!((parameter(0) / first - 1.0).abs() < 1e-9, "{fit}");
    assert!((parameter(1) / (slope / first) - 1.0).abs() < 1e-9, "{fit}");
    let sum: f64 = cycles.column("rate").iter().sum();
    assert!((sum - s[39]).abs() < 1e-12);
    // Modulus: secant stiffness times height over area.
    let (k, e) = (cycles.column("secant_stiffness"), cycles.column("resilient_modulus"));
    let ratio: Vec<f64> = e.iter().zip(&k).map(|(e, k)| e / k).collect();
    assert!(ratio.iter().all(|r| (r / ratio[0] - 1.0).abs() < 1e-9));
    let height = ratio[0] * 0.24 * 0.24;
    assert!(height > 0.05 && height < 0.2, "the bed is {height} m high");
    let bed = &settlement["bed_stiffness"];
    assert_eq!(bed["between"][0], 400.0);
    assert_eq!(bed["between"][1], 800.0);
    let stiffness = cycles.column("bed_stiffness");
    assert!(
        (bed["mean_of_last_ten"].as_f64().unwrap() - stiffness[30..].iter().sum::<f64>() / 10.0).abs() < 1.0
    );
    // Loading branch against whole cycle.
    assert!(stiffness[39] > 0.5 * k[39] && stiffness[39] < 3.0 * k[39], "{} {}", stiffness[39], k[39]);
    let printed = std::fs::read_to_string(folder.join("out/log.txt")).unwrap();
    assert!(printed.contains("Alva-Hurtado & Selig: s [m] = s1 (1 + C log10 N)"), "{printed}");
}

#[test]
fn too_few_cycles_have_no_law() {
    let folder = bed("few", "");
    go(&folder, "out", &["track.load.cycles=3"]).good();
    let summary = json(&folder.join("out/summary.json"));
    assert_eq!(summary["settlement"]["fits"].as_array().unwrap().len(), 0);
}

const JUMP: &str = "\n[track.jump]\nfirst = 16\nmeasure = 4\n";

fn jumps(summary: &Path) -> (serde_json::Value, f64) {
    let summary = json(summary);
    (summary["settlement"]["jump"].clone(), summary["energy"]["relative_error"].as_f64().unwrap())
}

/// Eight seeds: 124 to 180 of 200 cycles simulated; six: 139 to 297 of 400.
#[test]
fn cycle_jumps_conserve_energy() {
    for method in ["extrapolate", "displace"] {
        let folder = bed(method, JUMP);
        let set = [&format!("track.jump.method={method:?}")[..], "track.load.cycles=400"];
        go(&folder, "out", &set).good();
        let cycles = Table::read(&folder.join("out/cycles.csv"));
        let (n, simulated) = (cycles.column("cycle"), cycles.column("simulated"));
        assert_eq!(*n.last().unwrap(), 400.0, "{method}");
        assert_eq!(*simulated.last().unwrap(), cycles.rows.len() as f64);
        let (jump, energy) = jumps(&folder.join("out/summary.json"));
        let done = jump["simulated"].as_f64().unwrap();
        assert_eq!(done, *simulated.last().unwrap());
        assert_eq!(done + jump["skipped"].as_f64().unwrap(), 400.0);
        assert!(done < 300.0, "{method}: {done} of 400 cycles were simulated");
        assert!(n.windows(2).filter(|w| w[1] - w[0] > 1.0).count() >= 1);
        let error = jump["error_estimate"].as_f64().unwrap();
        assert!(
            error > 0.0 && (error - cycles.column("jump_error").last().unwrap()).abs() < 1e-15,
            "{method}"
        );
        assert!(energy < 5e-3, "{method}: energy error {energy}");
        let brought = jump["energy"].as_f64().unwrap();
        assert_eq!(brought != 0.0, method == "displace", "{brought} J");
        let summary = json(&folder.join("out/summary.json"));
        assert_eq!(summary["energy"]["flows"]["jumps"].as_f64().unwrap(), brought);
        assert!(summary["momentum"]["angular"].as_f64().unwrap() < 1e-9, "{}", summary["momentum"]);
        assert!(jump["jumps"][0]["predicted_slope"].as_f64().unwrap() > 0.0);
        let checks = summary["validity"].as_array().unwrap();
        let check = checks.iter().find(|c| c["name"] == "settlement error of cycle jumps").expect("a check");
        assert_eq!(check["value"], jump["relative_error_estimate"]);
    }
}

fn options(out: &Path, set: &[&str], threads: usize) -> Options {
    let set = set.iter().map(|s| s.to_string()).collect();
    Options {
        out: Some(out.to_path_buf()),
        threads: Some(threads),
        set,
        verbosity: Verbosity::Quiet,
        ..Options::default()
    }
}

#[test]
fn jumps_and_push_resume_bitwise() {
    let push = "\n[track.push]\ndirection = [1, 0]\nspeed = 0.1\ndisplacement = 0.002\nrest = 0.01\n";
    for method in ["extrapolate", "displace"] {
        let folder = bed("resumed", &format!("{JUMP}{push}"));
        let scene = folder.join("scene.toml");
        let method = format!("track.jump.method={method:?}");
        let set = [&method[..], "track.load.cycles=40", "track.sleeper.hold=[\"rx\", \"ry\", \"rz\"]"];
        let whole = folder.join("whole");
        trackbed::run::run(&scene, &options(&whole, &set, 1)).unwrap();
        let summary = json(&whole.join("summary.json"));
        let stages = summary["stages"].as_array().unwrap();
        let steps = |k: usize| stages[k]["grain_steps"].as_u64().unwrap();
        assert!(summary["push"]["peak"].as_f64().unwrap() > 0.0);
        let broken = folder.join("broken");
        let (settling, run) = (steps(0), steps(1));
        let mut before = 0;
        for (k, share) in [0.3, 0.7, 0.99].iter().enumerate() {
            let at = settling + (share * run as f64) as u64;
            let stop = at - before;
            before = at;
            let options = Options {
                interrupt: Interrupt::after(stop),
                resume: k > 0,
                ..options(&broken, &set, 1 + k % 2)
            };
            let end = trackbed::run::run(&scene, &options);
            assert!(matches!(end, Err(Failure::Interrupted(_))), "{end:?}");
        }
        trackbed::run::run(&scene, &Options { resume: true, ..options(&broken, &set, 2) }).unwrap();
        let (whole, broken) = (results(&whole), results(&broken));
        assert_eq!(whole.keys().collect::<Vec<_>>(), broken.keys().collect::<Vec<_>>());
        for (name, bytes) in &whole {
            assert!(bytes == &broken[name], "{method}: {name} differs");
        }
    }
}

#[test]
fn fines_in_the_voids_are_reported() {
    let fines = r#"
[[grains]]
name = "sand"
shape = "sphere"
material = "stone"
count = 300
size = ["6 mm", "8 mm"]
fill = { low = [0.0, 0.0, 0.0], high = [0.25, 0.25] }
fouling = true

[[measure]]
name = "box"
box = [[0.0, 0.0, 0.0], [0.25, 0.25, 2.0]]
"#;
    let folder = bed("fouled", fines);
    let set = ["track.load.cycles=1", "deposition.max_time=\"0.1 s\"", "time.grain_step=\"5 us\""];
    go(&folder, "out", &set).good();
    let summary = json(&folder.join("out/summary.json"));
    let fouling = &summary["packing"]["fouling"];
    // Mean d³ of uniform sizes by number: 350 mm³ for 6–8 mm, 130,000 mm³ for 40–60 mm.
    let ratio = 300.0 * 350.0 / (60.0 * 130_000.0);
    let found = fouling["relative_fouling_ratio"].as_f64().unwrap();
    assert!((found / ratio - 1.0).abs() < 0.15, "{found} against {ratio}");
    let index = fouling["fouling_index"].as_f64().unwrap();
    assert!((index - found / (1.0 + found)).abs() < 1e-12, "one density");
    let both = summary["packing"]["measures"][0]["porosity"].as_f64().unwrap();
    let (stones, share) =
        (fouling["boxes"][0][1].as_f64().unwrap(), fouling["boxes"][0][2].as_f64().unwrap());
    assert!((stones * (1.0 - share) - both).abs() < 1e-12 && share > 0.0, "{fouling}");
}

#[test]
#[ignore = "the box test of the guide, 100 cycles, 2 min"]
fn the_box_test_settles_as_measured() {
    let folder = Folder::new("box");
    let scene = repository().join("inputs/ballast/box.toml");
    run(&scene, &folder.join("out"), &["output.vtk=false"]).good();
    let cycles = Table::read(&folder.join("out/cycles.csv"));
    let settlement = cycles.column("settlement");
    let (tenth, last) = (settlement[9], settlement[99]);
    assert!((5e-3..=20e-3).contains(&last), "{last}");
    // Measured 0.20–0.40 for N = 10 to 100; this bed 0.50 (docs/ballast.md).
    let exponent = (last / tenth).log10();
    assert!((0.1..=0.5).contains(&exponent), "{exponent}");
    let moduli = &cycles.column("resilient_modulus")[50..];
    assert!(moduli.iter().all(|m| (60e6..=300e6).contains(m)), "{moduli:?}");
}
