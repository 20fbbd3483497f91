//! Contact laws in scenes.

use super::support::{Folder, Table, json, repository, run, trackbed};
use trackbed::results::grains::GrainFile;

fn sources(summary: &serde_json::Value) -> Vec<String> {
    let list = summary["sources"].as_array().unwrap();
    list.iter().map(|s| s.as_str().unwrap().to_string()).collect()
}

#[test]
fn two_laws_meet_in_one_scene() {
    let folder = Folder::new("two_laws");
    let scene = repository().join("inputs/grains/two_laws.toml");
    let set = ["time.end=\"0.25 s\"", "output.frames=2", "output.vtk=false"];
    run(&scene, &folder.join("out"), &set).good();
    let summary = json(&folder.join("out/summary.json"));
    let sources = sources(&summary);
    for law in ["Hertz", "Mindlin", "Cundall & Strack", "Schwager"] {
        assert!(sources.iter().any(|s| s.contains(law)), "{law} in {sources:?}");
    }
    assert!(!sources.iter().any(|s| s.contains("rolling")), "{sources:?}");
    let history = Table::read(&folder.join("out/history.csv"));
    let last = |name: &str| *history.column(name).last().unwrap();
    let spent = last("dissipated_dashpot") + last("dissipated_friction");
    assert!(spent > 0.5 && last("energy_error").abs() < 5e-3 * spent, "{} of {spent}", last("energy_error"));
    let text = trackbed(["explain", &scene.display().to_string(), "--trial", "0"]).good().stdout;
    assert!(text.contains("contact kernels: Hertz-Mindlin and linear spring-dashpot"), "{text}");
}

#[test]
fn explicit_default_laws_change_nothing() {
    let scene = repository().join("inputs/grains/box.toml");
    let end = "time.end=\"0.12 s\"";
    let named = [
        end,
        "material.0.normal=\"linear\"",
        "contact.0.normal=\"linear\"",
        "contact.0.tangential=\"linear\"",
        "contact.0.damping=\"restitution\"",
        "contact.0.rolling=\"spring\"",
    ];
    let histories = [&[end][..], &named].map(|set| {
        let folder = Folder::new("named_laws");
        run(&scene, &folder.join("out"), set).good();
        std::fs::read(folder.join("out/history.csv")).unwrap()
    });
    assert_eq!(histories[0], histories[1]);
}

#[test]
fn parts_switched_off_dissipate_nothing() {
    let folder = Folder::new("no_parts");
    let set = [
        "time.end=\"0.12 s\"",
        "contact.0.friction=",
        "contact.0.damping=\"none\"",
        "contact.0.tangential=\"none\"",
        "contact.0.rolling=\"none\"",
        "material.0.rolling_friction=0.1",
    ];
    run(&repository().join("inputs/grains/box.toml"), &folder.join("out"), &set).good();
    let history = Table::read(&folder.join("out/history.csv"));
    for name in ["dissipated_dashpot", "dissipated_friction"] {
        assert!(history.column(name).iter().all(|e| *e == 0.0), "{name}");
    }
    assert!(history.column("contact_springs").iter().any(|e| *e > 0.0));
}

/// Ball impact of `inputs/verify`: history, kinetic energies before and after [J].
fn impact(scene: &str, folder: &Folder, set: &[String]) -> (Table, [f64; 2]) {
    let set: Vec<&str> = set.iter().map(String::as_str).collect();
    run(&repository().join("inputs/verify").join(scene), &folder.join("out"), &set).good();
    let history = Table::read(&folder.join("out/history.csv"));
    let kinetic = history.column("grains_kinetic");
    let ends = [kinetic[0], *kinetic.last().unwrap()];
    (history, ends)
}

/// Walton & Braun 1986: e = √(k₁/k₂), plastic work (1 − e²) m v²/2 at any speed. Tolerance 0.5 %.
#[test]
fn plastic_rebound_matches_closed_form() {
    for e in [0.3, 0.6, 0.9] {
        for speed in [0.1, 2.0, 6.0] {
            let folder = Folder::new("bounce");
            let set = [
                format!("grains.0.velocity=[0, 0, -{speed}]"),
                format!("material.0.restitution={e}"),
                // The smaller value is used.
                format!("material.1.restitution={e}"),
                // The load reversal lies within a step: first-order error.
                "time.grain_step=3e-7".to_string(),
                format!("time.end={}", 0.04 / speed / e + 0.01),
                "output.vtk=false".to_string(),
            ];
            let (history, [first, last]) = impact("bounce.toml", &folder, &set);
            let found = (last / first).sqrt();
            let plastic = history.column("dissipated_dashpot").last().unwrap() / first;
            println!("e {e}, {speed} m/s: found {found:.5}, plastic work {plastic:.5} of {:.5}", 1.0 - e * e);
            assert!((found / e - 1.0).abs() < 1e-4, "wanted {e}, found {found} at {speed} m/s");
            assert!((plastic / (1.0 - e * e) - 1.0).abs() < 1e-4, "{plastic} at {speed} m/s");
            assert_eq!(*history.column("contact_springs").last().unwrap(), 0.0);
            assert!(sources(&json(&folder.join("out/summary.json"))).iter().any(|s| s.contains("Walton")));
        }
    }
}

/// Conical damage model (Harkness and others 2016, Suhr & Six 2017): an impact above first crushing keeps the
/// energy stored at the largest tip radius. Largest force c R². Tolerance 1e-4 (1e-3 if a step skips the
/// peak).
#[test]
fn conical_damage_matches_closed_form() {
    let (modulus, strength, angle) = (1e10 / 2.0 / 0.96, 6e7, 85.0_f64.to_radians());
    let h = (0.5 * std::f64::consts::PI * strength / modulus).powi(2);
    let k = (1.0 - angle.sin()) / angle.sin();
    let (c, radius) = (4.0 / 3.0 * modulus * h.powf(1.5), 0.1_f64);
    for speed in [0.05, 0.5] {
        let folder = Folder::new("corner");
        let set = [
            format!("grains.0.velocity=[0, 0, -{speed}]"),
            "time.grain_step=1e-6".into(),
            "output.vtk=false".into(),
        ];
        let (history, [first, last]) = impact("corner.toml", &folder, &set);
        let cube = radius.powi(3) + 3.0 * (first - 0.4 * c * h * radius.powi(3)) / (c * (h + k));
        let (kept, force) = (0.4 * c * h * cube / first, c * cube.powf(2.0 / 3.0));
        let crushed = history.column("dissipated_dashpot").last().unwrap() / first;
        let most = history.column("wall_force_z").iter().map(|f| f.abs()).fold(0.0, f64::max);
        println!(
            "{speed} m/s: kept {:.6} of {kept:.6}, crushed {crushed:.6}, force {most:.2} of {force:.2} N",
            last / first
        );
        assert!((last / first / kept - 1.0).abs() < 1e-4 && (crushed + kept - 1.0).abs() < 1e-4);
        assert!((most / force - 1.0).abs() < 1e-3);
        assert!(sources(&json(&folder.join("out/summary.json"))).iter().any(|s| s.contains("Harkness")));
    }
}

/// v = v∞ tanh(g t/v∞), v∞² = 8 r g ρₛ/(3 C ρ); kinetic energy to 0.2 %.
#[test]
fn drag_matches_closed_form() {
    let folder = Folder::new("wind");
    run(&repository().join("inputs/verify/wind.toml"), &folder.join("out"), &["output.vtk=false"]).good();
    let history = Table::read(&folder.join("out/history.csv"));
    let (r, density) = (0.01575_f64, 2700.0);
    let mass = density * 4.0 / 3.0 * std::f64::consts::PI * r.powi(3);
    let end = (8.0 * r * 9.81 * density / (3.0 * 0.9 * 1.225)).sqrt();
    let (time, kinetic) = (history.column("time"), history.column("grains_kinetic"));
    let mut seen = 0;
    for (t, found) in time.iter().zip(kinetic).filter(|(t, _)| **t > 0.5) {
        let v = end * (9.81 * t / end).tanh();
        assert!((found / (0.5 * mass * v * v) - 1.0).abs() < 4e-3, "{found} at {t} s for {v} m/s");
        seen += 1;
    }
    assert!(seen > 100);
    let summary = json(&folder.join("out/summary.json"));
    assert!(summary["energy"]["flows"]["applied_work"].as_f64().unwrap() < -1.0, "{}", summary["energy"]);
    assert!(summary["energy"]["relative_error"].as_f64().unwrap() < 1e-9);
    assert!(sources(&summary).iter().any(|s| s.contains("Haider")));
}

/// Pressure-dependent friction: a light frame sticks, a heavy one slides. Each foot has the friction of its
/// load; the moment of friction loads the lower feet more. Error 0.01 %.
#[test]
fn friction_decreases_with_pressure() {
    let folder = Folder::new("asperities");
    let scene = repository().join("inputs/verify/asperities/scene.toml");
    run(&scene, &folder.join("out"), &["output.packing=true", "output.vtk=false"]).good();
    let place = |group: usize| {
        let text = std::fs::read_to_string(folder.join(&format!("out/packing_{group}.csv"))).unwrap();
        let row: Vec<f64> = text.lines().nth(1).unwrap().split(',').map(|v| v.parse().unwrap()).collect();
        [row[0], row[2]]
    };
    let ([light, _], [heavy, height]) = (place(0), place(1));
    assert!(light < 2e-3 && heavy > 0.4, "{light} {heavy}");

    // Volume by `trackbed stone info`; feet in rows 0.2 m apart.
    let (mass, angle) = (7850.0 * 0.040550 * 0.24_f64.powi(3), 35.0_f64.to_radians());
    let friction = |load: f64| load * (0.3 + 0.9 / (1.0 + load / (1e4 * 0.02 * 0.02)));
    let (mean, mut more, mut total) = (mass * 9.81 * angle.cos() / 4.0, 0.0, 0.0);
    for _ in 0..50 {
        total = 2.0 * (friction(mean + more) + friction(mean - more));
        more = total * height / 0.4;
    }
    let expected = 9.81 * angle.sin() - total / mass;

    let history = Table::read(&folder.join("out/history.csv"));
    let (time, kinetic) = (history.column("time"), history.column("grains_kinetic"));
    let late = time.iter().position(|t| *t > 0.4).unwrap();
    let speed = |at: usize| (2.0 * kinetic[at] / mass).sqrt();
    let end = time.len() - 1;
    let found = (speed(end) - speed(late)) / (time[end] - time[late]);
    println!("acceleration {found:.5} m/s2, closed form {expected:.5}");
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} for {expected}");
}

#[test]
fn asperities_out_of_place_are_refused() {
    let scene = repository().join("inputs/verify/asperities/scene.toml");
    for (set, message) in [
        ("material.0.asperity_pressure=", "the pressure at which half of `asperity_friction` is left"),
        ("material.0.asperity_friction=0", "found, but it has no effect without `asperity_friction`"),
        ("material.0.asperity_friction=-1", "0 or more"),
        ("material.0.asperity_pressure=0", "found 0 Pa, expected above 0"),
    ] {
        let folder = Folder::new("no_asperities");
        let outcome = run(&scene, &folder.join("out"), &[set]);
        assert!(outcome.code == 2 && outcome.stderr.contains(message), "{set}: {outcome:?}");
    }
    let hertz = [
        "material.0.stiffness=",
        "material.0.young=1e7",
        "material.0.poisson=0.3",
        "material.1.stiffness=",
        "material.1.young=1e7",
        "material.1.poisson=0.3",
        "material.2.stiffness=",
    ];
    let folder = Folder::new("hertz_asperities");
    let outcome = run(&scene, &folder.join("out"), &hertz);
    let message = "found, but it has no effect without a contact law with asperities";
    assert!(outcome.code == 2 && outcome.stderr.contains(message), "{outcome:?}");
}

/// Overlap of a ball at rest after Hertz; 16 classes of four balls keep mean and 99 % of the standard deviation.
#[test]
fn stiffness_spreads_over_grains() {
    let folder = Folder::new("stiffness_spread");
    let scene = repository().join("inputs/grains/stiffness_spread.toml");
    run(&scene, &folder.join("out"), &["output.frames=1"]).good();
    let file = GrainFile::open(&folder.join("out/frames/grains_00001.vtp")).unwrap();
    let factors = file.field("stiffness_factor").unwrap();
    let radius: f64 = 0.02;
    let weight = 1200.0 * 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3) * 9.81;
    for (centre, factor) in file.centres().chunks_exact(3).zip(&factors) {
        let modulus = factor * 1e6 / (1.0 - 0.49 * 0.49);
        let overlap = (0.75 * weight / (modulus * radius.sqrt())).powf(2.0 / 3.0);
        assert!((radius - centre[2] - overlap).abs() < 0.01 * overlap, "{centre:?} of factor {factor}");
    }
    let mut classes = factors.clone();
    classes.sort_by(f64::total_cmp);
    assert!(classes.chunks_exact(4).all(|four| four[0] == four[3]), "{classes:?}");
    let mean = factors.iter().sum::<f64>() / 64.0;
    let deviation = (factors.iter().map(|f| (f - mean).powi(2)).sum::<f64>() / 64.0).sqrt();
    assert!((mean - 1.0).abs() < 1e-3 && (0.197..0.2).contains(&deviation), "{mean}, {deviation}");
    // Neighbours in space differ: the order is random.
    assert!(factors.windows(2).filter(|pair| pair[0] == pair[1]).count() < 12, "{factors:?}");
    for (set, expected) in [
        (
            "material.1.stiffness_spread={ kind = \"normal\", deviation = 0.1 }",
            "material.1.stiffness_spread: found, but it has no effect without `young` or `stiffness`",
        ),
        (
            "material.0.stiffness_spread={ kind = \"normal\", modulus = 3 }",
            "material.0.stiffness_spread: found other keys",
        ),
        (
            "material.0.stiffness_spread.deviation=0",
            "material.0.stiffness_spread.deviation: found 0, expected above 0",
        ),
    ] {
        let said = trackbed(["check", &scene.display().to_string(), "--set", set]);
        assert!(said.code == 2 && said.stderr.contains(expected), "{}", said.stderr);
    }
}

#[test]
fn spread_of_replaced_stiffness_is_refused() {
    let scene = repository().join("inputs/grains/stiffness_spread.toml").display().to_string();
    let pair = |other: &str| format!("{{ between = [\"rubber\", \"{other}\"], stiffness = 4000.0 }}");
    let all = format!("contact=[{}, {}]", pair("rubber"), pair("plate"));
    let linear =
        ["material.rubber.young=", "material.rubber.poisson=", "material.rubber.stiffness=2000.0", &all];
    let words = ["check", &scene].into_iter().chain(linear.iter().flat_map(|set| ["--set", set]));
    let said = trackbed(words);
    assert!(said.code == 2 && said.stderr.contains("material.0.stiffness_spread"), "{}", said.stderr);
}
