//! Rails, wheels and trains over sleepers.

use super::support::{COUPLED, Folder, Table, json, repository, run, scene_folder, trackbed};
use super::track::{BED, goes_on_bit_for_bit, options, springs, written};

/// Beam like UIC 60 on soft pads, on the centre line.
pub const BEAM: &str = r#"
[track.rail]
kind = "beam"
bending_stiffness = "12.8 MN m2"
mass = "120 kg/m"
pad_stiffness = "120 MN/m"
pad_damping = "60 kN s/m"
foundation = "40 MN/m"
foundation_damping = "100 kN s/m"
extension = "9 m"
"#;

fn bogie(speed: &str) -> String {
    format!(
        r#"
[track.load]
kind = "bogie"
axle_load = "140 kN"
wheelbase = "2.5 m"
speed = "{speed}"
rest = "30 ms"
ramp = "100 ms"
"#
    )
}

fn extremes(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(*v), b.max(*v)])
}

#[test]
fn a_bogie_on_a_beam() {
    let mut peaks = Vec::new();
    for speed in ["36 km/h", "200 km/h"] {
        let (folder, scene) = written(&springs(3, &(bogie(speed) + BEAM)));
        let out = folder.join("out");
        trackbed::run::run(&scene, &options(&out, 1)).unwrap();
        let history = Table::read(&out.join("history.csv"));
        let summary = json(&out.join("summary.json"));
        let series = BED * 120e6 / (BED + 120e6);
        let beta = (series / 0.6 / (4.0 * 12.8e6_f64)).powf(0.25);
        let shape = |x: f64| (-beta * x).exp() * ((beta * x).cos() + (beta * x).sin());
        // One axle, the other 2.5 m away, and the rail's weight.
        let formula = 140e3 * 0.5 * beta * 0.6 * (1.0 + shape(2.5)) + 120.0 * 9.81 * 0.6;
        let energy = summary["energy"]["relative_error"].as_f64().unwrap();
        assert!(energy < 1e-5, "{energy} at {speed}");
        let spent = |key: &str| summary["energy"]["flows"][key].as_f64().unwrap();
        let (seats, pads) = (spent("applied_work"), spent("pads_on_sleepers"));
        assert!((seats - pads).abs() < 1e-10 * seats.abs(), "{seats} {pads}");
        let time = history.column("time");
        let begun = time.iter().position(|t| *t > 0.13).unwrap();
        for k in 1..=3 {
            let [least, most] = extremes(&history.column(&format!("load_{k}")));
            let record = &summary["track"]["sleepers"][k - 1];
            let number = |key: &str| record[key].as_f64().unwrap();
            println!(
                "{speed}, sleeper {k}: {most:.0} N, {:.4} of Winkler's, {:.4} of the static beam's; least {least:.0} N; \
                 energy {energy:.1e}",
                most / formula,
                number("dynamic_amplification"),
            );
            assert!(number("largest_force") >= most - 1e-6 && number("largest_force") < 1.01 * most);
            assert!((number("static_force") / formula - 1.0).abs() < 0.02);
            assert!((number("load_share") - number("largest_force") / 140e3).abs() < 1e-12);
            assert!(number("rail_deflection") > number("lowering"));
            let load = history.column(&format!("load_{k}"))[begun];
            assert!((load / (120.0 * 9.81 * 0.6) - 1.0).abs() < 0.03, "{load} N before the wheels");
            let z = history.column(&format!("sleeper_{k}_z"));
            let lowering = z[begun] - extremes(&z[begun..])[0];
            assert!((number("lowering") / lowering - 1.0).abs() < 0.01, "{lowering}");
            if speed == "36 km/h" {
                assert!((most / formula - 1.0).abs() < 0.05, "{most} {formula}");
            }
            peaks.push(most);
        }
        let when = |k: usize| {
            let force = history.column(&format!("load_{k}"));
            let most = extremes(&force)[1];
            force.iter().zip(&time).find(|(f, _)| **f > 0.7 * most).map(|(_, t)| *t).unwrap()
        };
        let v = if speed == "36 km/h" { 10.0 } else { 200.0 / 3.6 };
        let delay = 0.5 * (when(3) - when(1));
        assert!((delay / (0.6 / v) - 1.0).abs() < 0.1, "{delay} s from sleeper to sleeper");
    }
    let amplification = peaks[4] / peaks[1];
    println!("200 km/h over 36 km/h: {amplification:.4}");
    assert!((1.0..1.5).contains(&amplification), "{amplification}");
}

/// Vehicle of `inputs/data` over the same sleepers.
fn vehicle(speed: &str) -> String {
    let file = repository().join("inputs/data/vehicles.toml");
    format!(
        "\n[track.load]\nkind = \"vehicle\"\nfile = '{}'\nvehicle = \"Manchester\"\nspeed = \"{speed}\"\nrest = \"30 ms\"\nramp = \"100 ms\"\n",
        file.display()
    )
}

#[test]
fn a_vehicle_on_a_beam() {
    let dip = "irregularity = { dips = [{ at = 0.6, depth = \"2 mm\", length = \"1 m\" }] }\n";
    let ran = |rail: &str| {
        let (folder, scene) = written(&springs(3, &(vehicle("200 km/h") + BEAM + rail)));
        let out = folder.join("out");
        trackbed::run::run(&scene, &options(&out, 1)).unwrap();
        (Table::read(&out.join("history.csv")), json(&out.join("summary.json")))
    };
    let weight = (32e3 + 2.0 * 2615.0 + 4.0 * 1813.0) * 9.81;
    let (history, even) = ran("");
    assert!(even["energy"]["relative_error"].as_f64().unwrap() < 1e-5, "{}", even["energy"]);
    let vehicles = &even["track"]["vehicles"];
    assert!((vehicles["static_force"].as_f64().unwrap() - 0.25 * weight).abs() < 1.0);
    for axle in vehicles["axles"].as_array().unwrap() {
        let number = |key: &str| axle[key].as_f64().unwrap() / (0.25 * weight);
        assert!((number("mean_force") - 1.0).abs() < 0.005, "{axle}");
        assert!(number("largest_force") < 1.2 && number("smallest_force") > 0.8, "{axle}");
    }
    // No wheels before the pass; the whole weight while all are on the rail or the even track beside.
    let forces: Vec<Vec<f64>> = (1..=4).map(|k| history.column(&format!("axle_{k}_force"))).collect();
    let sum: Vec<f64> = (0..forces[0].len()).map(|i| forces.iter().map(|f| f[i]).sum()).collect();
    assert_eq!(sum[0], 0.0);
    let during: Vec<f64> = sum.into_iter().filter(|f| *f != 0.0).collect();
    let mean = during.iter().sum::<f64>() / during.len() as f64;
    assert!((mean / weight - 1.0).abs() < 0.01, "{mean} {weight}");
    let (_, uneven) = ran(dip);
    let largest =
        |summary: &serde_json::Value| summary["track"]["vehicles"]["axles"][1]["largest_force"].as_f64();
    let ratio = largest(&uneven).unwrap() / largest(&even).unwrap();
    println!("largest axle force at a joint dipped by 16 mrad, 200 km/h: {ratio:.2} of that on an even rail");
    assert!((1.5..4.0).contains(&ratio), "{ratio}");
}

/// A changed profile of the rail is another model, for `--resume` and `reproduce`.
#[test]
fn profile_of_the_rail_belongs_to_the_model() {
    let (folder, file) =
        written(&springs(3, &(vehicle("200 km/h") + BEAM + "irregularity = { file = \"profile.csv\" }\n")));
    let hash = |rows: &str| {
        folder.write("profile.csv", rows);
        let document = trackbed::scene::Document::open(&file).unwrap();
        let scene = trackbed::model::read_scene(&document).unwrap();
        trackbed::run::scene_hash(&document, &scene)
    };
    let first = hash("position [m], height [mm]\n0, 0\n0.6, -1\n1.2, 0\n");
    assert_ne!(hash("position [m], height [mm]\n0, 0\n0.6, -2\n1.2, 0\n"), first);
    folder.write("profile.csv", "position [m], height [mm]\n0, 0\n0.6, -2\n0.5, 0\n");
    let outcome = trackbed([std::path::Path::new("check"), &file]);
    let line = "profile.csv:4: position: found 0.5, expected a position after 0.6 m";
    assert!(outcome.code == 2 && outcome.stderr.contains(line), "{}", outcome.stderr);
}

#[test]
fn broken_vehicles_are_refused() {
    let rail = "irregularity = { waves = [[1.0, 0.001]], dips = [{ at = 0, depth = 0.001, length = 1 }] }\n";
    let scene = springs(2, &(vehicle("200 km/h") + "share = 0.5\n" + BEAM + rail));
    let of = |old: &str, new: &str, line: &str| refused(&scene, old, new, line);
    of(
        "\"Manchester\"",
        "\"Mancester\"",
        "vehicle: found no vehicle \"Mancester\", expected one of Velaro E, ",
    );
    of("share = 0.5", "share = 0", "track.load.share: found 0, expected above 0, at most 1");
    of("share = 0.5", "cars = 0", "track.load.cars: found 0, expected 1 to 1000");
    of("share = 0.5", "axle_load = 1e5", "track.load.axle_load: found, but it has no effect without");
    of("[[1.0,", "[[0.0,", "track.rail.irregularity.waves: found 0, expected lengths above 0");
    of("depth = 0.001", "depth = -1", "track.rail.irregularity.dips.0.depth: found -1, expected above 0");
    of("waves = [[1.0, 0.001]]", "file = \"none.csv\"", "none.csv: profile: found ");
    let bogie = springs(2, &(bogie("200 km/h") + BEAM + rail));
    refused(
        &bogie,
        "extension",
        "extension",
        "track.rail.irregularity: found without track.load.kind = \"vehicle\", expected both",
    );
}

/// A sleeper over a void hangs on the rail by its weight; its neighbours take a larger share of the wheels until it touches the bed.
#[test]
fn sleeper_hangs_over_a_void() {
    let scene = |gap: &str| springs(3, &(bogie("36 km/h") + BEAM + gap));
    let results = |text: &str| {
        let (folder, scene) = written(text);
        let out = folder.join("out");
        trackbed::run::run(&scene, &options(&out, 1)).unwrap();
        let energy = json(&out.join("summary.json"))["energy"]["relative_error"].as_f64().unwrap();
        assert!(energy < 1e-5, "{energy}");
        Table::read(&out.join("history.csv"))
    };
    let (whole, gap) =
        (results(&scene("")), results(&scene("hanging = [{ sleeper = 2, gap = \"3 mm\" }]\n")));
    // After the swing of the lift, before the wheels.
    let time = gap.column("time");
    let quiet: Vec<usize> = (0..time.len()).filter(|k| (0.3..0.6).contains(&time[*k])).collect();
    let mean = |values: &[f64]| quiet.iter().map(|k| values[*k]).sum::<f64>() / quiet.len() as f64;
    let (load, z) = (mean(&gap.column("load_2")), gap.column("sleeper_2_z"));
    let lifted = mean(&z) - z[0];
    println!("load {load:.1} N, lifted {:.3} mm", 1e3 * lifted);
    assert!((load / -(300.0 * 9.81) - 1.0).abs() < 0.02 && (2.5e-3..3e-3).contains(&lifted));
    let share = |table: &Table, k: usize| extremes(&table.column(&format!("load_{k}")))[1] / 140e3;
    let neighbour = share(&gap, 1) / share(&whole, 1);
    let own = share(&gap, 2) / share(&whole, 2);
    println!(
        "share of the neighbour {neighbour:.3}, of the hanging sleeper {own:.3} times those without a gap"
    );
    assert!(neighbour > 1.1 && own < 0.6);
}

#[test]
fn two_rails_equal_combined_rail() {
    let one = springs(3, &(bogie("200 km/h") + BEAM));
    let mut two = one.replace("ramp = \"100 ms\"", "ramp = \"100 ms\"\nseats = [[-0.75, 0], [0.75, 0]]");
    for (whole, half) in [
        ("12.8 MN m2", "6.4 MN m2"),
        ("mass = \"120 kg/m\"", "mass = \"60 kg/m\""),
        ("120 MN/m", "60 MN/m"),
        ("60 kN s/m", "30 kN s/m"),
        ("foundation = \"40 MN/m\"", "foundation = \"20 MN/m\""),
        ("100 kN s/m", "50 kN s/m"),
    ] {
        assert_eq!(two.matches(whole).count(), 1, "{whole}");
        two = two.replace(whole, half);
    }
    let [one, two] = [one, two].map(|text| {
        let (folder, scene) = written(&text);
        let out = folder.join("out");
        trackbed::run::run(&scene, &options(&out, 1)).unwrap();
        (Table::read(&out.join("history.csv")), json(&out.join("summary.json")))
    });
    for k in 1..=3 {
        let loads = [&one, &two].map(|run| run.0.column(&format!("load_{k}")));
        let most = extremes(&loads[0])[1];
        let apart = loads[0].iter().zip(&loads[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("sleeper {k}: {apart:.1e} N apart of {most:.0} N");
        assert!(apart < 1e-7 * most, "{apart}");
        let fixed = [&one, &two].map(|run| recorded(&run.1, k - 1, "static_force"));
        assert!((fixed[1] / fixed[0] - 1.0).abs() < 1e-9, "{fixed:?}");
    }
}

#[test]
fn rails_restore_state_in_iterations() {
    let head = COUPLED.split_once("[track.load]").unwrap();
    let tail = head.1.split_once("[coupling]").unwrap().1;
    let sleeper = format!("{}spacing = 1.2\nalong = \"y\"\n", head.0.trim_end().to_string() + "\n");
    let load = bogie("72 km/h").replace("140 kN", "8 kN");
    let beam = BEAM.replace("120 MN/m", "20 MN/m").replace("60 kN s/m", "10 kN s/m");
    let folder = scene_folder("again", &format!("{sleeper}{load}{beam}\n[coupling]{tail}"));
    let mut peaks = Vec::new();
    for scheme in ["predicted", "iterated"] {
        let out = folder.join(scheme);
        // Pad work agrees to rounding only with equal steps.
        let set = [&format!("coupling.scheme={scheme:?}")[..], "time.grain_step=20 us"];
        run(&folder.join("scene.toml"), &out, &set).good();
        let summary = json(&out.join("summary.json"));
        let energy = summary["energy"]["relative_error"].as_f64().unwrap();
        let passes = summary["coupling"]["passes"]["passes"].as_f64().unwrap();
        let spent = |key: &str| summary["energy"]["flows"][key].as_f64().unwrap();
        let sides = [spent("applied_work"), spent("pads_on_sleepers")];
        println!("{scheme}: {passes} passes, energy {energy:.1e}, pads {sides:?} J");
        assert!(energy < 5e-3, "{energy}");
        assert!((sides[0] - sides[1]).abs() < 1e-9 * sides[0].abs(), "{sides:?}");
        peaks.push(recorded(&summary, 0, "largest_force"));
    }
    assert!((peaks[1] / peaks[0] - 1.0).abs() < 0.01, "{peaks:?}");
}

/// Quasi-static rail: axle load shares at the beam's times.
#[test]
fn a_train_by_winklers_formula() {
    let file = repository().join("inputs/data/trains.toml");
    let load = format!(
        r#"
[track.load]
kind = "train"
file = "{}"
train = "CRH2"
cars = 1
speed = "300 km/h"
rest = "10 ms"
ramp = "10 ms"
seats = [[-0.75, 0], [0.75, 0]]
[track.rail]
kind = "winkler"
bending_stiffness = "6.4 MN m2"
foundation = "15 MN/m"
"#,
        file.display()
    );
    let (folder, scene) = written(&springs(2, &load));
    let out = folder.join("out");
    trackbed::run::run(&scene, &options(&out, 1)).unwrap();
    let history = Table::read(&out.join("history.csv"));
    let beta = (15e6_f64 / 0.6 / (4.0 * 6.4e6)).powf(0.25);
    let (time, load) = (history.column("time"), history.column("load_2"));
    let reach = 3.0 * std::f64::consts::PI / beta;
    for (t, found) in time.iter().zip(&load).filter(|(t, _)| **t > 0.0201) {
        let first = -reach + 300.0 / 3.6 * (t - 0.02);
        let share = |behind: f64| {
            let x = beta * (0.6 - (first - behind)).abs();
            0.5 * beta * 0.6 * (-x).exp() * (x.cos() + x.sin())
        };
        let expected: f64 = [0.0, 2.5, 17.5, 20.0].iter().map(|a| 140e3 * share(*a)).sum();
        assert!((found - expected).abs() < 1e-6 * 140e3, "{found} {expected} at {t}");
    }
    let summary = json(&out.join("summary.json"));
    assert!(summary["energy"]["relative_error"].as_f64().unwrap() < 2e-3);
    assert!(
        summary["track"]["sleepers"][1]["smallest_force"].as_f64().unwrap() < 0.0,
        "lifted before the wheels"
    );
}

/// Rail irregularity under an unsprung mass adds M a w² sin(2πx/L), w = 2πv/L, to each axle.
#[test]
fn rail_irregularity_varies_axle_load() {
    let load = r#"
[track.load]
kind = "bogie"
axle_load = "140 kN"
wheelbase = "2.5 m"
speed = "300 km/h"
rest = "10 ms"
ramp = "10 ms"
seats = [[-0.75, 0], [0.75, 0]]
excitation = { mass = 750, waves = [["10 m", "3.5 mm"]] }
[track.rail]
kind = "winkler"
bending_stiffness = "6.4 MN m2"
foundation = "15 MN/m"
"#;
    let (folder, scene) = written(&springs(2, load));
    let out = folder.join("out");
    trackbed::run::run(&scene, &options(&out, 1)).unwrap();
    let history = Table::read(&out.join("history.csv"));
    let beta = (15e6_f64 / 0.6 / (4.0 * 6.4e6)).powf(0.25);
    let reach = 3.0 * std::f64::consts::PI / beta;
    let (v, turn) = (300.0 / 3.6, std::f64::consts::TAU / 10.0);
    let (time, load) = (history.column("time"), history.column("load_1"));
    let mut swing = 0.0_f64;
    for (t, found) in time.iter().zip(&load).filter(|(t, _)| **t > 0.0201) {
        let each = |behind: f64| {
            let at = -reach + v * (t - 0.02) - behind;
            let x = beta * at.abs();
            let more = 750.0 * 3.5e-3 * (turn * v).powi(2) * (turn * at).sin();
            swing = swing.max(more.abs());
            (140e3 + more) * 0.5 * beta * 0.6 * (-x).exp() * (x.cos() + x.sin())
        };
        let expected: f64 = [0.0, 2.5].map(each).iter().sum();
        assert!((found - expected).abs() < 1e-6 * 140e3, "{found} {expected} at {t}");
    }
    assert!(swing > 7e3, "{swing}");
}

#[test]
fn a_lifted_sleeper_comes_down_again() {
    let load = r#"
[track.load]
kind = "history"
file = "force.csv"
factor = 2.0
speed = 30
rest = "20 ms"
ramp = "0 s"
"#;
    let (folder, scene) = written(&springs(2, load).replace("[time]", "[time]\nend = 0.4"));
    folder.write("force.csv", "time, force\n0, 0\n0.01, -3000\n0.06, -3000\n0.07, 0\n");
    let out = folder.join("out");
    trackbed::run::run(&scene, &options(&out, 1)).unwrap();
    let history = Table::read(&out.join("history.csv"));
    for k in 1..=2 {
        let z = history.column(&format!("sleeper_{k}_z"));
        let highest = extremes(&z)[1];
        assert!(highest - z[0] > 0.01, "lifted by {} m", highest - z[0]);
        let rest = 300.0 * 9.81 / BED;
        let last = z.last().unwrap();
        assert!((z[0] - last - rest).abs() < 0.2 * rest, "{} m above its rest", last - z[0] + rest);
    }
    let summary = json(&out.join("summary.json"));
    assert!((summary["track"]["sleepers"][0]["smallest_force"].as_f64().unwrap() + 6000.0).abs() < 1.0);
    assert!(summary["energy"]["relative_error"].as_f64().unwrap() < 2e-2);
}

fn recorded(summary: &serde_json::Value, k: usize, key: &str) -> f64 {
    let path = format!("/track/sleepers/{k}/{key}");
    summary
        .pointer(&path)
        .and_then(serde_json::Value::as_f64)
        .unwrap_or_else(|| panic!("{path}: {summary:#}"))
}

/// In the air z'' = F/m − g: second differences of height are those of parabolas to rounding, contacts
/// store no energy.
#[test]
fn lifted_sleeper_matches_free_flight() {
    let load = r#"
[track.load]
kind = "history"
file = "force.csv"
rest = "50 ms"
ramp = "0 s"
"#;
    let more = "[time]\nend = 0.5";
    let text = springs(1, load)
        .replace("[time]", more)
        .replace("50 us", "20 us")
        .replace("frames = 1", "frames = 1\nhistory_interval = \"1 ms\"");
    let (folder, scene) = written(&text);
    const PULL: f64 = 6000.0;
    folder.write("force.csv", "time, force\n0, 0\n0.01, -6000\n0.06, -6000\n0.0601, 0\n");
    let out = folder.join("out");
    trackbed::run::run(&scene, &options(&out, 1)).unwrap();
    let history = Table::read(&out.join("history.csv"));
    let (t, z) = (history.column("time"), history.column("sleeper_z"));
    let springs = history.column("contact_springs");
    let (mut pulled, mut free) = (0, 0);
    for k in 1..t.len() - 1 {
        // Force constant between adjacent rows, no contact.
        let force = match t[k] {
            x if x > 0.0711 && x < 0.1089 => PULL,
            x if x > 0.1121 && x < 0.2 => 0.0,
            _ => continue,
        };
        let step = 1e-3;
        let found = (z[k + 1] - 2.0 * z[k] + z[k - 1]) / (step * step);
        let expected = force / 300.0 - 9.81;
        assert!((found - expected).abs() < 1e-6 * 9.81, "{found} {expected} at {}", t[k]);
        assert_eq!(springs[k], 0.0, "a contact at {}", t[k]);
        if force > 0.0 { pulled += 1 } else { free += 1 }
    }
    assert!(pulled > 30 && free > 80, "{pulled} {free}");
    let summary = json(&out.join("summary.json"));
    // Pull equals weight after 4.9 ms.
    let (first, seconds) =
        (recorded(&summary, 0, "lifted_off/first"), recorded(&summary, 0, "lifted_off/seconds"));
    assert!((0.0549..0.062).contains(&first), "{first}");
    // Free fall from the top to first contact at about 0.2 m, rebound at a fifth of the speed.
    let highest = extremes(&z)[1];
    let top = t.iter().zip(&z).find(|(_, z)| **z == highest).map(|(t, _)| *t).unwrap();
    let fall = (2.0 * (highest - 0.2) / 9.81).sqrt();
    let flight = top + fall - first;
    println!("off at {first:.6} s for {seconds:.6} s, the first flight {flight:.6} s; top {highest:.6} m");
    assert!(seconds > flight - 2e-3 && seconds < flight + 0.6 * fall, "{seconds} {flight}");
    let rise = recorded(&summary, 0, "lifted_off/rise");
    assert!((rise - (highest - (0.2 - 300.0 * 9.81 / BED))).abs() < 2e-5, "{rise}");
    let warnings = summary["warnings"].to_string();
    assert!(warnings.contains(&format!("first at t = {first:.6} s")), "{warnings}");
    assert!(summary["energy"]["relative_error"].as_f64().unwrap() < 2e-3, "{}", summary["energy"]);

    folder.write("force.csv", "time, force\n0, 0\n0.01, -1470\n0.06, -1470\n0.0601, 0\n");
    trackbed::run::run(&scene, &options(&folder.join("stays"), 1)).unwrap();
    let summary = json(&folder.join("stays/summary.json"));
    assert!(summary["track"]["sleepers"][0].get("lifted_off").is_none(), "{}", summary["track"]);
    assert!(!summary["warnings"].to_string().contains("without contact"));
}

#[test]
fn uplift_wave_lifts_sleeper_off_grains() {
    let folder = scene_folder("wave", COUPLED);
    let scene = folder.join("scene.toml");
    let mut seconds = Vec::new();
    for scheme in ["predicted", "iterated"] {
        let out = folder.join(scheme);
        let set = [
            &format!("coupling.scheme={scheme:?}")[..],
            "track.load.minimum=-16 kN",
            "track.load.frequency=20",
            "track.load.kind=sine",
        ];
        run(&scene, &out, &set).good();
        let summary = json(&out.join("summary.json"));
        let energy = summary["energy"]["relative_error"].as_f64().unwrap();
        println!("{scheme}: {}, energy {energy:.1e}", summary["track"]["sleepers"][0]["lifted_off"]);
        assert!(recorded(&summary, 0, "lifted_off/rise") > 0.01);
        assert!(summary["warnings"].to_string().contains("sleeper 1: without contact for "));
        assert!(energy < 0.01, "{energy}");
        seconds.push(recorded(&summary, 0, "lifted_off/seconds"));
    }
    assert!((seconds[1] / seconds[0] - 1.0).abs() < 0.02, "{seconds:?}");
}

#[test]
fn rails_go_on_bit_for_bit() {
    let text = springs(2, &(bogie("200 km/h") + BEAM)).replace("vtk = false", "vtk = true");
    let (folder, scene) = written(&text.replace("extension = \"9 m\"", "extension = \"2.4 m\""));
    goes_on_bit_for_bit(&scene, &folder, &[300, 900, 2000]);
    let walls = std::fs::read_to_string(folder.join("whole/frames/walls_00001.vtp")).unwrap();
    assert!(walls.contains("NumberOfPolys"), "a picture with sleepers and rail");
    let from = Some(folder.join("whole"));
    let next = trackbed::run::Options { from, ..options(&folder.join("next"), 1) };
    let refused = trackbed::run::run(&scene, &next).expect_err("a rail is refused");
    assert!(refused.to_string().contains("expected no rail with --from"), "{refused}");
    assert!(refused.code() == 2 && !folder.join("next").exists());
}

#[track_caller]
fn refused(scene: &str, old: &str, new: &str, line: &str) {
    assert_eq!(scene.matches(old).count(), 1, "{old}");
    let (folder, file) = written(&scene.replace(old, new));
    folder.write("force.csv", "time, force\n0, 0\n1, 5\n");
    let outcome = run(&file, &folder.join("out"), &[]);
    assert_eq!(outcome.code, 2, "{}", outcome.stderr);
    assert!(outcome.stderr.contains(line), "{}\n{line}", outcome.stderr);
    assert!(!folder.join("out").exists());
    if !line.contains("DEM time steps") {
        let checked = trackbed([std::path::Path::new("check"), &file]);
        assert_eq!(checked.stderr, outcome.stderr);
    }
    let _: &Folder = &folder;
}

#[test]
fn broken_loads_are_refused() {
    let scene = springs(2, &(bogie("200 km/h") + BEAM));
    let of = |old, new, line: &str| refused(&scene, old, new, line);
    of("kind = \"bogie\"", "kind = \"cart\"", "track.load.kind: found \"cart\", expected one of \"sine\"");
    of("axle_load = \"140 kN\"", "axle_load = -1", "track.load.axle_load: found -1, expected above 0");
    of(
        "axle_load = \"140 kN\"",
        "",
        "track.load.axle_load: found nothing, expected a value for this kind of load",
    );
    of("wheelbase = \"2.5 m\"", "wheelbase = 0", "track.load.wheelbase: found 0, expected above 0");
    of("speed = \"200 km/h\"", "speed = 0", "track.load.speed: found 0, expected above 0");
    of(
        "speed = \"200 km/h\"",
        "speed = \"2 kg\"",
        "track.load.speed: found string \"2 kg\", expected a velocity in m/s",
    );
    of("rest = \"30 ms\"", "rest = -1", "track.load.rest: found -1, expected 0 or more");
    of("ramp = \"100 ms\"", "ramp = -1", "track.load.ramp: found -1, expected 0 or more");
    of("rest = \"30 ms\"", "cycles = 0", "track.load.cycles: found 0, expected 1 or more");
    of(
        "rest = \"30 ms\"",
        "cars = 2",
        "track.load.cars: found, but it has no effect without `kind = \"train\"`",
    );
    of("rest = \"30 ms\"", "maximum = 2", "track.load.maximum: found, but it has no effect without");
    of(
        "rest = \"30 ms\"",
        "seats = [[0, 0.1]]",
        "track.load.seats: found (0, 0.1), expected rails on the line across",
    );
    let waves = "excitation = { mass = 750, waves = [[0, 1e-3]] }";
    of("rest = \"30 ms\"", waves, "track.load.excitation.waves: found 0, expected lengths above 0");
    let mass = "excitation = { mass = 0, waves = [[1, 1e-3]] }";
    of("rest = \"30 ms\"", mass, "track.load.excitation.mass: found 0, expected above 0");
    of(
        "rest = \"30 ms\"",
        "rest = 0\n[track.rails]",
        "track.rails: found the unknown key `rails`, expected `rail`",
    );
}

#[test]
fn broken_rails_are_refused() {
    let scene = springs(2, &(bogie("200 km/h") + BEAM));
    let of = |old, new, line: &str| refused(&scene, old, new, line);
    of("kind = \"beam\"", "kind = \"slab\"", "track.rail.kind: found \"slab\", expected");
    of(
        "kind = \"beam\"",
        "kind = \"winkler\"",
        "track.rail.mass: found, but it has no effect without `kind = \"beam\"`",
    );
    of("mass = \"120 kg/m\"", "", "track.rail.mass: found nothing, expected a value for a beam");
    of("mass = \"120 kg/m\"", "mass = 0", "track.rail.mass: found 0, expected above 0");
    of("\"12.8 MN m2\"", "0", "track.rail.bending_stiffness: found 0, expected above 0");
    of("foundation = \"40 MN/m\"", "foundation = 0", "track.rail.foundation: found 0, expected above 0");
    of(
        "pad_stiffness = \"120 MN/m\"",
        "pad_stiffness = 0",
        "track.rail.pad_stiffness: found 0, expected above 0",
    );
    of(
        "pad_stiffness = \"120 MN/m\"",
        "pad_stiffness = 1e13",
        "track.rail.pad_stiffness: found 10000000000000, expected at most",
    );
    of(
        "pad_damping = \"60 kN s/m\"",
        "pad_damping = -1",
        "track.rail.pad_damping: found -1, expected 0 or more",
    );
    of(
        "pad_damping = \"60 kN s/m\"",
        "pad_damping = 1e9",
        "track.rail.pad_damping: found 1000000000, expected at most",
    );
    of("\"100 kN s/m\"", "-2", "track.rail.foundation_damping: found -2, expected 0 or more");
    of(
        "extension = \"9 m\"",
        "extension = \"1 m\"",
        "track.rail.extension: found 1, expected 3 to 10000 sleepers of 0.6 m",
    );
    of("extension = \"9 m\"", "", "track.rail.extension: found nothing, expected a value for a beam");
    of(
        "extension = \"9 m\"",
        "extension = 9\nelements = 0",
        "track.rail.elements: found 0, expected 1 to 100",
    );
    let hanging = |rows: &str, line: &str| {
        let new = format!("extension = 9\nhanging = [{rows}]");
        refused(&scene, "extension = \"9 m\"", &new, line);
    };
    hanging("{ sleeper = 3, gap = 0.001 }", "track.rail.hanging.0.sleeper: found 3, expected 1 to 2");
    hanging("{ sleeper = 1, gap = 1 }", "track.rail.hanging.0.gap: found 1, expected above 0, at most 50 mm");
}

#[test]
fn broken_loads_on_sleepers_are_refused() {
    let load = |text: &str| springs(2, &format!("[track.load]\n{text}\nrest = \"1 ms\"\nramp = 0\n"));
    let gauss = load("kind = \"gauss\"\nmaximum = 10\nspeed = 10\nwidth = 0.7\naxles = [0, 2.5]");
    refused(&gauss, "width = 0.7", "width = 0", "track.load.width: found 0, expected above 0");
    refused(
        &gauss,
        "[0, 2.5]",
        "[1, 2.5]",
        "track.load.axles: found [1.0, 2.5], expected ascending distances, the first 0",
    );
    refused(
        &gauss,
        "maximum = 10",
        "maximum = -10",
        "track.load.maximum: found -10, expected more than the minimum",
    );
    let ramp = load("kind = \"ramp\"\nmaximum = 10\nrise = 0.1\nhold = 0.1\nfall = 0.1");
    refused(&ramp, "rise = 0.1", "rise = 0", "track.load.rise: found 0, expected above 0");
    refused(&ramp, "hold = 0.1", "hold = -1", "track.load.hold: found -1, expected 0 or more");
    refused(&ramp, "fall = 0.1", "fall = 0", "track.load.fall: found 0, expected above 0");
    refused(&ramp, "fall = 0.1", "width = 0.1", "width: found, but it has no effect without");
    let measured = load("kind = \"history\"\nfile = \"force.csv\"\nfactor = 2");
    refused(&measured, "factor = 2", "factor = 0", "track.load.factor: found 0, expected other than 0");
    refused(&measured, "\"force.csv\"", "\"none.csv\"", "none.csv: history: found ");
    let train = load("kind = \"train\"\nfile = \"force.csv\"\ntrain = \"CRH2\"\nspeed = 10");
    refused(
        &train,
        "speed = 10",
        "speed = 10",
        "track.load.kind: found wheels, expected [track.rail], on which they roll",
    );
    let sine = load("kind = \"sine\"\nminimum = 0\nmaximum = 10\nfrequency = 1\ncycles = 1");
    refused(&sine, "frequency = 1", "frequency = 0", "track.load.frequency: found 0, expected above 0");
    refused(
        &sine,
        "minimum = 0",
        "minimum = 10",
        "track.load.maximum: found 10, expected more than the minimum",
    );
    let on_rail = sine.clone() + BEAM;
    refused(
        &on_rail,
        "cycles = 1",
        "cycles = 1",
        "track.load.kind: found a load on the sleepers, expected \"bogie\", \"train\" or \"vehicle\" on a rail",
    );
    let alone = springs(2, BEAM);
    refused(
        &alone,
        "[time]",
        "[time]\nend = 1",
        "track.rail: found a rail, expected [track.load] with wheels on it",
    );
    let push = "\n[track.push]\ndirection = [1, 0]\nspeed = 0.1\ndisplacement = 0.01\n";
    let pushed = springs(2, &(bogie("10") + BEAM + push));
    refused(
        &pushed,
        "displacement = 0.01",
        "displacement = 0.02",
        "track.push: found together with a rail with `mass`, expected only one of them",
    );
    let wave = "kind = \"sine\"\nminimum = 1\nmaximum = 2\nfrequency = 10\ncycles = 1\n";
    let pushed = springs(2, &format!("[track.load]\n{wave}{push}"));
    refused(
        &pushed,
        "displacement = 0.01",
        "displacement = 0.02",
        "track.push: found together with several sleepers, expected only one of them",
    );
    let single = springs(1, &(bogie("10") + BEAM)).replace("spacing = \"0.6 m\"\n", "");
    refused(
        &single,
        "along = \"y\"",
        "along = \"y\"",
        "track.sleeper.spacing: found nothing, expected the distance of the sleepers under a rail",
    );
}
