//! Speed–accuracy keys: mass factor, search skin, facets; breakage of bonded stones.

use super::support::{
    COUPLED, Folder, GRAINS, Table, json, repository, run, small_block, trackbed, write_lists,
};
use std::fs;

#[test]
fn mass_factor_keeps_weights_and_settling() {
    let folder = Folder::new("mass_factor");
    let long = GRAINS.replace("end = \"20 ms\"", "end = \"100 ms\"");
    let scene = folder.write("scene.toml", &long);
    let history = |name: &str, set: &[&str]| {
        let out = folder.join(name);
        run(&scene, &out, set).good();
        (fs::read(out.join("history.csv")).unwrap(), json(&out.join("summary.json")))
    };
    let (factor, summary) = history("factor", &["time.mass_factor=4"]);
    let (by_hand, _) = history("by_hand", &["material.0.density=10600", "gravity=[0, 0, -2.4525]"]);
    let (plain, before) = history("plain", &[]);
    assert!(factor == by_hand && factor != plain);
    let error = |s: &serde_json::Value| s["energy"]["relative_error"].as_f64().unwrap();
    assert!(error(&summary) < 5e-3 && error(&before) < 5e-3, "{} {}", error(&summary), error(&before));

    let bed = repository().join("inputs/ballast/box.toml");
    let short = [
        "grains.0.count=60",
        "deposition.level=",
        "deposition.max_time=0.2",
        "compaction=",
        "track.load.cycles=1",
        "track.load.rest=0.01",
        "track.load.ramp=0.02",
        "output.frames=0",
        "output.vtk=false",
    ];
    let heavier: Vec<&str> = short.iter().copied().chain(["time.mass_factor=16"]).collect();
    run(&bed, &folder.join("light"), &short).good();
    run(&bed, &folder.join("heavy"), &heavier).good();
    let stages = |name: &str| {
        let summary = json(&folder.join(name).join("summary.json"));
        let steps = |stage: &str| {
            let all = summary["stages"].as_array().unwrap();
            all.iter().find(|s| s["name"] == stage).unwrap()["grain_steps"].as_f64().unwrap()
        };
        (steps("settling"), steps("run"), summary)
    };
    let ((settling, light, before), (same, heavy, after)) = (stages("light"), stages("heavy"));
    println!("steps of the run {light}, with 16 times the mass {heavy}");
    assert!(settling == same && heavy < 0.4 * light, "{settling} {same}, {light} {heavy}");
    assert!(error(&after) < 0.01, "{}", error(&after));
    let force = |s: &serde_json::Value| s["track"]["sleepers"][0]["largest_force"].as_f64().unwrap();
    assert!((force(&after) / force(&before) - 1.0).abs() < 1e-3);
}

#[test]
fn refusals() {
    let folder = Folder::new("trade_refusals");
    let scene = folder.write("scene.toml", GRAINS);
    for (set, expected) in [
        ("time.mass_factor=0.5", "time.mass_factor: found 0.5, expected 1 to 10000"),
        ("time.search_skin=0", "time.search_skin: found 0, expected 0.01 to 2"),
        ("time.search_skin=3", "time.search_skin: found 3, expected 0.01 to 2"),
    ] {
        let outcome = run(&scene, &folder.join("out"), &[set]);
        assert!(outcome.code == 2 && outcome.stderr.contains(expected), "{}", outcome.stderr);
    }
    let outcome = run(&scene, &folder.join("out"), &["time.mass_factor=4", "wind={ drag = 0.5 }"]);
    let expected = "time.mass_factor: found together with [wind], expected only one of them";
    assert!(outcome.code == 2 && outcome.stderr.contains(expected), "{}", outcome.stderr);
    let coupled = folder.write("coupled.toml", COUPLED);
    write_lists(&small_block(), folder.path());
    let outcome = run(&coupled, &folder.join("out"), &["coupling.faces=\"bent\""]);
    assert!(outcome.code == 2 && outcome.stderr.contains("coupling.faces"), "{}", outcome.stderr);
}

#[test]
fn inertial_number_is_weighed() {
    let scene = repository().join("inputs/ballast/box.toml").display().to_string();
    let said = |factor: &str| {
        trackbed(["check", &scene, "--set", &format!("time.mass_factor={factor}")]).good().stdout
    };
    assert!(!said("4").contains("inertial number"));
    let text = said("1000");
    assert!(text.contains("warning: time.mass_factor: found 1000, at which the inertial number"), "{text}");
}

#[test]
fn search_skin_changes_no_motion() {
    let folder = Folder::new("search_skin");
    let scene = repository().join("inputs/grains/box.toml");
    let base = ["grains.0.count=150", "time.end=0.3", "output.frames=0", "output.vtk=false"];
    let result = |name: &str, skin: &str| {
        let set: Vec<&str> = base.iter().copied().chain([skin]).collect();
        run(&scene, &folder.join(name), &set).good();
        let history = Table::read(&folder.join(name).join("history.csv"));
        (history.column("grains_kinetic"), history.column("contact_springs"))
    };
    let usual = result("usual", "time.search_skin=0.2");
    assert!(
        usual == result("narrow", "time.search_skin=0.03") && usual == result("wide", "time.search_skin=1")
    );
}

#[test]
fn flat_facets_approximate_curved_faces() {
    let folder = Folder::new("flat_faces");
    let scene = folder.write("scene.toml", COUPLED);
    write_lists(&small_block(), folder.path());
    let ran = |name: &str, set: &[&str]| {
        run(&scene, &folder.join(name), set).good();
        let history = Table::read(&folder.join(name).join("history.csv"));
        (history.column("sleeper_z"), json(&folder.join(name).join("summary.json")))
    };
    let (curved, _) = ran("curved", &[]);
    let (flat, summary) = ran("flat", &["coupling.faces=\"flat\""]);
    let (first, last) = (curved[0], curved[curved.len() - 1]);
    let apart = curved.iter().zip(&flat).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let way = curved.iter().map(|z| (z - first).abs()).fold((last - first).abs(), f64::max);
    println!("sleeper moves {way:.3e} m, on facets {apart:.3e} m apart");
    assert!(apart > 0.0 && apart < 0.2 * way, "{apart} of {way}");
    let audit = &summary["coupling"]["transfer"];
    assert!(audit["force"].as_f64().unwrap() < 1e-12 && audit["moment"].as_f64().unwrap() < 1e-12, "{audit}");
    let faces = |set: &str| {
        let scene = scene.display().to_string();
        let text = trackbed(["check", &scene, "--set", set]).good().stdout;
        let line = text.lines().find(|l| l.contains(" faces, ")).unwrap().to_string();
        line.trim().trim_start_matches("coupling: ").split(' ').next().unwrap().parse::<usize>().unwrap()
    };
    assert_eq!(faces("coupling.faces=\"flat\""), 6 * faces("coupling.faces=\"curved\""));
}

#[test]
fn breakage_of_a_crushed_stone() {
    let folder = Folder::new("breakage");
    let scene = repository().join("inputs/grains/bonded_stone/scene.toml");
    let of = |name: &str, set: &[&str]| {
        run(&scene, &folder.join(name), set).good();
        json(&folder.join(name).join("summary.json"))["bonds"]["breakage"].clone()
    };
    let broken = of("broken", &["output.frames=0", "time.end=0.12"]);
    let whole = of(
        "whole",
        &[
            "output.frames=0",
            "time.end=0.02",
            "bond.mineral.parallel.tensile_strength=1e12",
            "bond.mineral.parallel.shear_strength=1e12",
        ],
    );
    println!("{broken}");
    assert_eq!(whole["marsal"].as_f64(), Some(0.0));
    assert_eq!(whole["ballast_index"].as_f64(), Some(0.0));
    // One 40 mm stone: its whole mass moves to other sieves.
    assert!(
        broken["marsal"].as_f64().unwrap() > 0.5 && broken["ballast_index"].as_f64().unwrap() > 0.1,
        "{broken}"
    );
    let last =
        |b: &serde_json::Value, key: &str| b[key].as_array().unwrap().last().unwrap().as_f64().unwrap();
    assert!((last(&broken, "passing_after") - 1.0).abs() < 1e-12);
}
