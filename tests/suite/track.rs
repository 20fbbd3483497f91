//! Rows of sleepers.

use super::support::{Folder, Table, json, results};
use std::path::Path;
use trackbed::run::{Interrupt, Options, Verbosity};

/// Bed stiffness per sleeper [N/m]: four fixed balls.
pub const BED: f64 = 40e6;

/// Sleepers 0.6 m apart on four fixed balls each; `more` follows the sleepers.
pub fn springs(sleepers: usize, more: &str) -> String {
    let balls: Vec<String> = (0..4 * sleepers)
        .map(|k| {
            let x = if k % 2 == 0 { -0.7 } else { 0.7 };
            let y = 0.6 * (k / 4) as f64 + if k / 2 % 2 == 0 { -0.08 } else { 0.08 };
            format!("[{x}, {y:.2}, 0.05, 0.05]")
        })
        .collect();
    format!(
        r#"title = "sleepers on springs"

[[material]]
name = "steel"
density = 7800
stiffness = "10 MN/m"
friction = 0.5
restitution = 0.2

[[grains]]
name = "balls"
shape = "sphere"
material = "steel"
prescribed_velocity = [0, 0, 0]
spheres = [{}]

[track.sleeper]
size = [2.6, 0.28, 0.2]
mass = "300 kg"
material = "steel"
centre = [0, 0]
count = {sleepers}
spacing = "0.6 m"
along = "y"
hold = ["x", "y", "rz"]

[time]
grain_step = "50 us"
accept_step_above_limit = true

[output]
frames = 1
vtk = false

{more}
"#,
        balls.join(", ")
    )
}

/// Writes the scene into a directory.
pub fn written(text: &str) -> (Folder, std::path::PathBuf) {
    let folder = Folder::new("track");
    let scene = folder.write("scene.toml", text);
    (folder, scene)
}

/// Options of a quiet run.
pub fn options(out: &Path, threads: usize) -> Options {
    Options {
        out: Some(out.to_path_buf()),
        threads: Some(threads),
        verbosity: Verbosity::Quiet,
        ..Options::default()
    }
}

const HAVERSINE: &str = r#"
[track.load]
kind = "haversine"
minimum = "5 kN"
maximum = "45 kN"
frequency = "10 Hz"
cycles = 2
rest = "50 ms"
ramp = "50 ms"
seats = [[-0.75, 0], [0.75, 0]]
"#;

#[test]
fn sleepers_in_a_row_sink_alike() {
    let (folder, scene) = written(&springs(3, HAVERSINE));
    let out = folder.join("out");
    trackbed::run::run(&scene, &options(&out, 1)).unwrap();
    let history = Table::read(&out.join("history.csv"));
    let rest = 300.0 * 9.81 / BED;
    for k in 1..=3 {
        let z = history.column(&format!("sleeper_{k}_z"));
        let y = history.column(&format!("sleeper_{k}_y"));
        assert!(y.iter().all(|y| (y - 0.6 * f64::from(k - 1)).abs() < 1e-9));
        let load = history.column(&format!("load_{k}"));
        let most = load.iter().copied().fold(0.0, f64::max);
        let lowest = z.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((most - 45e3).abs() < 50.0, "{most}");
        // Quasi-static to (10 Hz/58 Hz)² = 3 %.
        let sunk = z[0] - lowest;
        let expected = rest + 45e3 / BED;
        assert!((sunk / expected - 1.0).abs() < 0.04, "{sunk} m, static {expected} m");
    }
    let z = |k: usize| history.column(&format!("sleeper_{k}_z"));
    let apart = z(1).iter().zip(z(3)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-12, "{apart}");
    let summary = json(&out.join("summary.json"));
    assert_eq!(summary["settlement"]["per_cycle"].as_array().unwrap().len(), 2);
    let energy = summary["energy"]["relative_error"].as_f64().unwrap();
    assert!(energy < 2e-3, "{energy}");
}

#[test]
fn a_single_sleeper_has_no_number() {
    let text = springs(1, HAVERSINE).replace("count = 1\nspacing = \"0.6 m\"\nalong = \"y\"\n", "");
    let (folder, scene) = written(&text);
    trackbed::run::run(&scene, &options(&folder.join("out"), 1)).unwrap();
    let heads = Table::read(&folder.join("out").join("history.csv")).heads;
    assert_eq!(heads[1..6], ["load", "sleeper_x", "sleeper_y", "sleeper_z", "sleeper_tilt"]);
}

/// Compares an uninterrupted run with runs interrupted at `breaks`.
pub fn goes_on_bit_for_bit(scene: &Path, folder: &Folder, breaks: &[u64]) {
    let (whole, broken) = (folder.join("whole"), folder.join("broken"));
    trackbed::run::run(scene, &options(&whole, 1)).unwrap();
    for (k, &steps) in breaks.iter().enumerate() {
        let interrupt = Interrupt::after(steps);
        let how = Options { interrupt, resume: k > 0, ..options(&broken, 2 + k % 2) };
        let stopped = trackbed::run::run(scene, &how).unwrap_err();
        assert_eq!(stopped.code(), 130, "{stopped}");
    }
    trackbed::run::run(scene, &Options { resume: true, ..options(&broken, 3) }).unwrap();
    let (whole, broken) = (results(&whole), results(&broken));
    assert!(whole.keys().eq(broken.keys()), "{:?}\n{:?}", whole.keys(), broken.keys());
    for (name, bytes) in &whole {
        assert!(*bytes == broken[name], "{name} differs after a restart");
    }
}

#[test]
fn sleeper_row_resumes_bitwise() {
    let text = springs(2, HAVERSINE).replace("vtk = false", "vtk = true");
    let (folder, scene) = written(&text);
    goes_on_bit_for_bit(&scene, &folder, &[700, 2900]);
}

/// Walton and Braun, e = 0.5, K₂ = 4 K₁: pulses from F₀ to F₁ leave (F₁ − F₀)(1/K₁ − 1/K₂), smaller cycles
/// nothing.
#[test]
fn seating_removes_initial_settlement() {
    let text = springs(1, HAVERSINE).replace("cycles = 2", "cycles = 3").replace("10 Hz", "4 Hz");
    let text = text.replace("restitution = 0.2", "restitution = 0.5\nnormal = \"walton_braun\"");
    let run = |seating: &str| {
        let (folder, scene) = written(&format!("{text}\n{seating}"));
        let out = folder.join("out");
        trackbed::run::run(&scene, &options(&out, 1)).expect("a good run");
        (json(&out.join("summary.json")), Table::read(&out.join("cycles.csv")))
    };
    let lost = |from: f64, to: f64| (to - from) * (1.0 - 0.25) / BED;
    let (plain, _) = run("");
    let first = plain["settlement"]["per_cycle"][0].as_f64().unwrap();
    assert!((first / lost(5e3, 45e3) - 1.0).abs() < 0.03, "{first} for {}", lost(5e3, 45e3));
    assert!(plain["settlement"].get("seating").is_none());

    let (seated, cycles) =
        run("[track.load.seating]\ncycles = 2\nmaximum = \"60 kN\"\nfrequency = \"4 Hz\"\n");
    let settlement = &seated["settlement"];
    let found = settlement["seating"].as_f64().unwrap();
    assert!((found / lost(5e3, 60e3) - 1.0).abs() < 0.03, "{found} for {}", lost(5e3, 60e3));
    let after = settlement["per_cycle"][2].as_f64().unwrap();
    assert!(after.abs() < 0.01 * found, "{after} after {found}");
    let (own, total) = (cycles.column("settlement"), cycles.column("total_settlement"));
    assert!(own.iter().zip(&total).all(|(s, t)| (t - s - found).abs() < 1e-12), "{own:?} {total:?}");
}

#[test]
fn rejects_seating_load_below_initial_load() {
    let seating = "[track.load.seating]\ncycles = 2\nmaximum = \"4 kN\"\nfrequency = \"4 Hz\"\n";
    let (_folder, scene) = written(&format!("{}\n{seating}", springs(1, HAVERSINE)));
    let error = trackbed::run::run(&scene, &options(Path::new("nowhere"), 1)).unwrap_err().to_string();
    assert!(error.contains("track.load.seating.maximum") && error.contains("5000 N"), "{error}");
}
