//! Forces that move over a solid, regions of other materials.

use super::support::{Folder, Table, repository, trackbed};

/// Simply supported beam of 20 m, 1 m × 1 m, E 30 GPa, 2,500 kg/m³; 100 kN at 40 m/s.
const BEAM: &str = include_str!("../../inputs/verify/moving_force.toml");

/// Midspan deflection, undamped: Fryba, Vibration of Solids and Structures under Moving Loads, 1999, chapter 1.
fn deflection(t: f64, speed: f64) -> f64 {
    use std::f64::consts::PI;
    let (length, bending, mass, force) = (20.0_f64, 30e9 / 12.0, 2500.0_f64, 1e5);
    let first = (PI / length).powi(2) * (bending / mass).sqrt();
    let omega = PI * speed / length;
    let alpha = omega / first;
    let scale = 2.0 * force * length.powi(3) / (PI.powi(4) * bending);
    let term = |n: f64| {
        let share = (n * PI / 2.0).sin() / (n * n * (n * n - alpha * alpha));
        share * ((n * omega * t).sin() - alpha / n * (n * n * first * t).sin())
    };
    scale * [1.0, 3.0, 5.0, 7.0].into_iter().map(term).sum::<f64>()
}

#[test]
fn beam_matches_closed_form() {
    let folder = Folder::new("moving_beam");
    let file = folder.write("scene.toml", BEAM).display().to_string();
    let out = folder.join("out").display().to_string();
    trackbed(["run", &file, "--out", &out]).good();
    let history = Table::read(&folder.join("out/history.csv"));
    let (times, middle) = (history.column("time"), history.column("middle_u_z"));
    let on_beam: Vec<(f64, f64)> = times.into_iter().zip(middle).filter(|(t, _)| *t <= 0.5).collect();
    let largest = on_beam.iter().map(|(t, _)| deflection(*t, 40.0)).fold(0.0, f64::max);
    let error = on_beam.iter().map(|(t, u)| (u + deflection(*t, 40.0)).abs()).fold(0.0, f64::max);
    println!("largest {largest:.4e} m, error {:.2} %", 100.0 * error / largest);
    assert!(error < 0.02 * largest, "{error} of {largest}");
    // Later than a slow force by inertia, and larger.
    assert!(largest > 1.05 * 1e5 * 8000.0 / (48.0 * 2.5e9));
}

#[test]
fn axles_and_patch_follow() {
    let folder = Folder::new("moving_axles");
    let quasi_static = BEAM
        .replace("[solid.dynamics]", "[solid.quasi_static]")
        .replace("end = 0.6", "end = 0.3")
        .replace("solid_step = \"1 ms\"", "solid_step = \"25 ms\"")
        .replace("history_interval = \"1 ms\"", "history_interval = \"25 ms\"")
        .replace(
            "[[solid.support]]\nnodes_in = [[-0.5, 0, 0]",
            "[[solid.support]]\nname = \"start\"\nnodes_in = [[-0.5, 0, 0]",
        )
        .replace(
            "speed = \"40 m/s\"",
            "speed = \"40 m/s\"\naxles = [0, 2.5]\nsize = [0.4, 0.5]\nstart = \"25 ms\"",
        );
    let scene =
        quasi_static.replace("path = [[0, 0, 0.5], [0, 20, 0.5]]", "path = [[0, 1, 0.5], [0, 19, 0.5]]");
    let file = folder.write("scene.toml", &scene).display().to_string();
    let out = folder.join("out").display().to_string();
    trackbed(["run", &file, "--out", &out]).good();
    let history = Table::read(&folder.join("out/history.csv"));
    let (times, reaction) = (history.column("time"), history.column("start_reaction_z"));
    for (t, found) in times.iter().zip(reaction) {
        // Lever rule; on the line from 1 to 19 m, the second axle 2.5 m behind.
        let first = 40.0 * (t - 0.025);
        let place = |s: f64| if (0.0..=18.0).contains(&s) { 1e5 * (1.0 - (1.0 + s) / 20.0) } else { 0.0 };
        let expected = if *t == 0.0 { 0.0 } else { place(first) + place(first - 2.5) };
        assert!((found - expected).abs() < 1.0, "{t}: {found} for {expected}");
    }
}

#[test]
fn wrong_keys_are_named() {
    let rejected = |old: &str, new: &str, words: &str| {
        let folder = Folder::new("moving_wrong");
        let file = folder.write("scene.toml", &BEAM.replace(old, new)).display().to_string();
        let outcome = trackbed(["check", &file]);
        assert!(outcome.code == 2 && outcome.stderr.contains(words), "{}", outcome.stderr);
    };
    rejected("[0, 20, 0.5]]", "[0, 21, 0.5]]", "path: found (0, 20.00");
    rejected("speed = \"40 m/s\"", "speed = 0", "speed: found 0, expected above 0");
    rejected("speed = \"40 m/s\"", "", "speed: found nothing, expected a value for a moving load");
    rejected("speed = \"40 m/s\"", "speed = 1\naxles = [0, 2, 1]", "axles: found [0.0, 2.0, 1.0]");
    rejected(
        "speed = \"40 m/s\"",
        "speed = 1\nsize = [0.2, 2]",
        "expected points of the solid, with all of `size`",
    );
    rejected("kind = \"moving\"", "kind = \"point\"\nat = [0, 1, 0.5]", "path: found");
}

#[test]
fn axles_that_never_arrive_are_implausible() {
    let warned = |new: &str, words: &str| {
        let folder = Folder::new("moving_late");
        let scene = BEAM.replace("speed = \"40 m/s\"", new);
        let file = folder.write("scene.toml", &scene).display().to_string();
        let said = trackbed(["check", &file]).good().stdout;
        assert!(said.contains(words), "{said}");
    };
    warned(
        "speed = 40\nstart = 2",
        "solid.load.0.start: found 2 s, the run ends at 0.6 s, expected the first axle",
    );
    warned("speed = 4000", "solid.load.0.speed: found 4000 m/s, 5.0 steps along the path, expected 8 steps");
    warned("speed = 4000", "solid.load.0.speed: found 4000 m/s, expected 0.1 to 300 m/s (unusual)");
}

/// Soft half-space: the largest deflection is where the load moves with the Rayleigh wave, 38.0 m/s
/// (inputs/studies/critical_speed.toml with linear elements).
#[test]
fn deflection_is_largest_at_rayleigh_speed() {
    let study = repository().join("inputs/studies/critical_speed.toml");
    let text = std::fs::read_to_string(study).unwrap();
    let scene = repository().join("inputs/solid/moving_load.toml").display().to_string();
    let kept = ["26 m/s", "38 m/s", "58 m/s"];
    let is_kept = |line: &&str| !line.contains("label =") || kept.iter().any(|v| line.contains(v));
    let shortened: Vec<&str> = text.lines().filter(is_kept).collect();
    let shortened = shortened
        .join("\n")
        .replace("\"../solid/moving_load.toml\"", &format!("{scene:?}"))
        .replace("\"output.frames=0\"", "\"output.frames=0\", \"solid.order=linear\"");
    let folder = Folder::new("moving_critical");
    let file = folder.write("study.toml", &shortened).display().to_string();
    let out = folder.join("out").display().to_string();
    trackbed(["study", &file, "--out", &out, "--jobs", "1"]).good();
    let mut rows = csv::Reader::from_path(folder.join("out/study.csv")).unwrap();
    let at = rows.headers().unwrap().iter().position(|h| h == "largest deflection [mm]").unwrap();
    let found: Vec<f64> = rows.records().map(|r| r.unwrap()[at].parse().unwrap()).collect();
    println!("{kept:?}: {found:?} mm");
    let [slow, critical, fast] = found[..] else { panic!("{found:?}") };
    assert!(critical > 1.2 * slow && critical > 1.2 * fast, "{found:?}");
}

/// Far from the transition each side deflects as uniform ground.
#[test]
fn transition_joins_two_grounds() {
    let scene = repository().join("inputs/solid/transition.toml").display().to_string();
    let folder = Folder::new("moving_transition");
    let deflection = |name: &str, set: &str, probe: &str| {
        let out = folder.join(name).display().to_string();
        let common = ["--set", "solid.order=linear", "--set", "output.vtk=false", "--set", "output.frames=0"];
        let own = ["run", &scene, "--out", &out, "--force", "--set", set];
        trackbed(own.iter().chain(&common)).good();
        let history = Table::read(&folder.join(name).join("history.csv"));
        -history.column(&format!("{probe}_u_z")).into_iter().fold(0.0, f64::min)
    };
    let both = |probe: &str| deflection("both", "time.end=0.7", probe);
    let (soft, stiff) = (both("soft"), both("stiff"));
    let uniform_soft = deflection("soft", "solid.region=", "soft");
    let uniform_stiff = deflection("stiff", "solid.region.0.box=[[0, 0, -4], [8, 30, -0.8]]", "stiff");
    println!("soft {soft:.3e} {uniform_soft:.3e}, stiff {stiff:.3e} {uniform_stiff:.3e}");
    assert!((soft / uniform_soft - 1.0).abs() < 0.02 && (stiff / uniform_stiff - 1.0).abs() < 0.02);
    assert!(soft > 2.0 * stiff);
}

/// A mat of bedding modulus C under pressure p is compressed by p/C: modulus C t, Poisson's ratio 0.
#[test]
fn mat_adds_pressure_over_bedding_modulus() {
    let scene = r#"title = "Slab on a mat"
[solid]
gravity = false
[solid.block]
x = { lines = [0, 1], counts = [2] }
y = { lines = [0, 1], counts = [2] }
z = { lines = [-1, -0.525, -0.5, 0], counts = [2, 1, 2] }
[solid.quasi_static]
[[solid.material]]
id = 1
young = "100 MPa"
poisson = 0
density = 2000
[[solid.material]]
id = 7
name = "mat of 0.06 N/mm3"
young = "1.5 MPa"
poisson = 0
density = 1000
[[solid.region]]
box = [[0, 0, -0.525], [1, 1, -0.5]]
material = 7
[[solid.support]]
side = "z-"
directions = ["x", "y", "z"]
[[solid.load]]
kind = "pressure"
side = "z+"
pressure = "60 kPa"
[[probe]]
name = "top"
at = [0.5, 0.5, 0]
[time]
end = 1
solid_step = 1
"#;
    let folder = Folder::new("mat");
    let file = folder.write("scene.toml", scene).display().to_string();
    let out = folder.join("out").display().to_string();
    trackbed(["run", &file, "--out", &out]).good();
    let top = *Table::read(&folder.join("out/history.csv")).column("top_u_z").last().unwrap();
    let expected = -60e3 / 6e7 - 60e3 * 0.975 / 100e6;
    assert!((top / expected - 1.0).abs() < 1e-9, "{top} for {expected}");
    for (old, new, words) in [
        ("material = 7", "material = 8", "solid.region.0.material: found 8, expected the `id`"),
        ("[1, 1, -0.5]]", "[1, 1, -0.6]]", "solid.region.0.box: found [0.0, 0.0, -0.525] to"),
        ("[[0, 0, -0.525]", "[[0, 0, -0.51]", "solid.region.0.box: found no element"),
    ] {
        let file = folder.write("wrong.toml", &scene.replace(old, new)).display().to_string();
        let outcome = trackbed(["check", &file]);
        assert!(outcome.code == 2 && outcome.stderr.contains(words), "{}", outcome.stderr);
    }
}

/// Unloaded elastic ground returns to its shape: forces of zero have no size to compare with.
#[test]
fn vanishing_loads_leave_nothing() {
    let folder = Folder::new("moving_unloaded");
    let scene = BEAM
        .replace("[solid.dynamics]", "[solid.quasi_static]")
        .replace("solid_step = \"1 ms\"", "solid_step = \"50 ms\"")
        .replace("history_interval = \"1 ms\"", "history_interval = \"50 ms\"");
    let out = folder.join("out").display().to_string();
    let of = |name: &str, text: &str| {
        let file = folder.write(name, text).display().to_string();
        trackbed(["run", &file, "--out", &out, "--force"]).good();
        Table::read(&folder.join("out/history.csv")).column("middle_u_z")
    };
    // The axle leaves after 0.5 of 0.6 s.
    let middle = of("axle.toml", &scene);
    let largest = middle.iter().fold(0.0_f64, |m, u| m.max(-u));
    assert!(largest > 5e-3 && middle[middle.len() - 1].abs() < 1e-9 * largest, "{middle:?}");
    let pulse = scene.replace(
        "kind = \"moving\"\npath = [[0, 0, 0.5], [0, 20, 0.5]]",
        "kind = \"point\"\nat = [0, 10, 0.5]\nhistory = { kind = \"table\", points = [[0, 1], [0.3, 0], [0.45, -1], [0.6, 0]] }",
    );
    let middle = of("pulse.toml", &pulse.replace("speed = \"40 m/s\"\n", ""));
    assert!(
        middle[6].abs() < 1e-9 * middle[0].abs() && middle[12].abs() < 1e-9 * middle[0].abs(),
        "{middle:?}"
    );
    assert!((middle[9] / middle[0] + 1.0).abs() < 1e-6, "{middle:?}");
}
