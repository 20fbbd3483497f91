//! Laws of contact by name: several in one scene, and what the summary says of them.

use super::support::{Folder, Table, json, repository, run, trackbed};

fn sources(summary: &serde_json::Value) -> Vec<String> {
    let list = summary["sources"].as_array().unwrap();
    list.iter().map(|s| s.as_str().unwrap().to_string()).collect()
}

/// Hertz among the balls, the linear law on the mat: the account of energy closes, and both laws are named.
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
    let text = trackbed(["explain", &scene.display().to_string()]).good().stdout;
    assert!(text.contains("contact loop: Hertz-Mindlin and linear spring-dashpot"), "{text}");
}

/// A law named where it is the implied one changes nothing, and neither does a pair whose parts are the usual ones.
#[test]
fn names_of_the_usual_laws_change_nothing() {
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

/// Parts switched off: without dashpot and friction nothing is dissipated.
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
