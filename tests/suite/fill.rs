//! Fills to a target height or mass.

use super::support::{Folder, json, repository, run, shaft, trackbed};
use serde_json::Value;

const SPHERES: &str = "shape = \"sphere\"\nsize = [\"36 mm\", \"44 mm\"]";

/// Box of 0.24 m; `amount` of `[[grains]]`, `level` of `[deposition]`.
fn scene(shape: &str, amount: &str, level: &str) -> String {
    format!(
        "[[material]]\nname = \"stone\"\ndensity = 2650\nstiffness = \"20 kN/m\"\nfriction = 0.5\nrestitution = 0.3\n\n\
         [[grains]]\nname = \"bed\"\nmaterial = \"stone\"\nfill = {{ low = [0, 0, 0], high = [0.24, 0.24] }}\n{shape}\n{amount}\n\n\
         {}\n[deposition]\nmax_time = \"1 s\"\n{level}\n\n[time]\nend = \"0.1 ms\"\n\n[output]\nframes = 1\nvtk = false\n",
        shaft(0.24)
    )
}

fn clumps() -> String {
    let library = repository().join("inputs/grains/stones.toml").display().to_string();
    format!("shape = \"clump\"\nlibrary = \"{library}\"\nsize = [\"36 mm\", \"44 mm\"]")
}

/// Output and `beds` of `check`.
fn checked(text: &str) -> (String, Value) {
    let folder = Folder::new("fill_check");
    let scene = folder.write("scene.toml", text).display().to_string();
    let numbers: Value = serde_json::from_str(&trackbed(["check", &scene, "--json"]).good().stdout).unwrap();
    (trackbed(["check", &scene]).good().stdout, numbers["grains"]["beds"].clone())
}

fn refused(text: &str, message: &str) {
    let folder = Folder::new("fill_refused");
    let scene = folder.write("scene.toml", text).display().to_string();
    let outcome = trackbed(["check", &scene]);
    assert_eq!(outcome.code, 2, "{outcome:?}");
    assert!(outcome.stderr.contains(message), "{}\nis not in\n{}", message, outcome.stderr);
}

/// Log, summary.
fn settled(text: &str) -> (String, Value) {
    let folder = Folder::new("fill_run");
    let scene = folder.write("scene.toml", text);
    run(&scene, &folder.join("out"), &[]).good();
    let log = std::fs::read_to_string(folder.join("out/log.txt")).unwrap();
    (log, json(&folder.join("out/summary.json")))
}

/// Largest grain of 44 mm: 0.118 kg; a clump has at most the volume 0.784 d³.
#[test]
fn mass_matches_target_within_grain() {
    for (shape, largest) in [(SPHERES.to_string(), 0.118), (clumps(), 0.177)] {
        for target in [3.0, 20.0] {
            let (_, beds) = checked(&scene(&shape, &format!("target_mass = \"{target} kg\""), ""));
            let mass = beds[0]["mass"].as_f64().unwrap();
            assert!((mass - target).abs() <= largest, "{shape}: {mass} {target}");
        }
    }
}

#[test]
fn target_height_sets_grain_count() {
    let (text, beds) = checked(&scene(SPHERES, "target_height = 0.26", ""));
    assert!((beds[0]["height"].as_f64().unwrap() / 0.26 - 1.0).abs() < 0.003, "{beds}");
    let porosity = beds[0]["porosity"].as_f64().unwrap();
    assert!((0.44..0.47).contains(&porosity), "{porosity}");
    let count = beds[0]["grains"].as_u64().unwrap();
    assert!((230..255).contains(&count), "{count}");
    assert!(text.contains(&format!("  bed: {count} grains, ")), "{text}");
    assert!(
        text.contains("expected bed height 0.2") && text.contains("m above z = 0 m (porosity 0.4"),
        "{text}"
    );
    let (same, _) = checked(&scene(SPHERES, &format!("count = {count}"), ""));
    assert_eq!(text.split_once('\n'), Some((text.lines().next().unwrap(), same.split_once('\n').unwrap().1)));
}

#[test]
fn spheres_settle_to_the_target_height() {
    let (log, summary) = settled(&scene(SPHERES, "target_height = 0.26", ""));
    let bed = &summary["bed"][0];
    assert_eq!(bed["stage"], "settling");
    let height = bed["height"].as_f64().unwrap();
    assert!((height / 0.26 - 1.0).abs() < 0.05, "{bed}");
    let mass = bed["mass"].as_f64().unwrap();
    assert!((20.5..23.0).contains(&mass), "{bed}");
    let porosity = 1.0 - mass / 2650.0 / (0.24 * 0.24 * height);
    assert!((bed["porosity"].as_f64().unwrap() - porosity).abs() < 0.02, "{bed} {porosity}");
    assert_eq!(bed["targets"][0]["group"], "bed");
    let reached = bed["targets"][0]["reached"].as_f64().unwrap();
    assert!((reached / height - 1.0).abs() < 0.01, "{bed}");
    assert!(log.contains(&format!("bed after settling: height {height:.3} m, mass ")), "{log}");
    assert!(log.contains(&format!("bed: target height 0.26 m, reached {reached:.3} m (")), "{log}");
    assert!(!log.contains("off the target height"), "{log}");
}

#[test]
fn clumps_settle_to_the_target_height() {
    let (_, summary) = settled(&scene(&clumps(), "target_height = 0.16\nporosity = 0.42", ""));
    let height = summary["bed"][0]["height"].as_f64().unwrap();
    assert!((height / 0.16 - 1.0).abs() < 0.05, "{}", summary["bed"]);
}

#[test]
fn missed_target_is_a_warning() {
    let (log, summary) = settled(&scene(SPHERES, "target_height = 0.1\nporosity = 0.65", ""));
    let target = &summary["bed"][0]["targets"][0];
    assert!(target["reached"].as_f64().unwrap() < 0.095, "{target}");
    assert!(target["suggested_porosity"].as_f64().unwrap() < 0.63, "{target}");
    assert!(
        log.contains("warning: bed: bed height 0.0")
            && log.contains("off the target height 0.1 m. Set `porosity = 0."),
        "{log}"
    );
}

#[test]
fn warns_of_level_above_bed() {
    let (low, _) = checked(&scene(SPHERES, "target_height = 0.26", "level = 0.24"));
    assert!(!low.contains("deposition.level"), "{low}");
    let (high, _) = checked(&scene(SPHERES, "target_height = 0.26", "level = 0.35"));
    assert!(
        high.contains("deposition.level: found 0.35 m, a level above the bed (top at most 0.3"),
        "{high}"
    );
}

#[test]
fn rejects_contradictory_amounts() {
    let both = "expected only one of them";
    for (amount, message) in [
        (
            "count = 9\ntarget_height = 0.2",
            format!("grains.0.count: found together with `target_height`, {both}"),
        ),
        ("count = 9\ntarget_mass = 2", format!("grains.0.count: found together with `target_mass`, {both}")),
        (
            "target_height = 0.2\ntarget_mass = 2",
            format!("grains.0.target_height: found together with `target_mass`, {both}"),
        ),
        ("", "grains.0.count: found nothing, expected `count`, `target_height` or `target_mass`".into()),
        ("target_height = 201", "grains.0.target_height: found 201, expected above 0, at most 200 m".into()),
        ("target_height = -1", "grains.0.target_height: found -1, expected above 0, at most 200 m".into()),
        ("target_mass = 0", "grains.0.target_mass: found 0, expected above 0".into()),
        ("count = 9\nporosity = 1", "grains.0.porosity: found 1, expected above 0, below 1".into()),
        ("target_mass = \"1 g\"", "grains.0.target_mass: found 0.0111 grains, expected".into()),
    ] {
        refused(&scene(SPHERES, amount, ""), &message);
    }
    let region = "shape = \"sphere\"\nsize = [0.01, 0.01]\nregion = { box = [[0, 0, 0], [0.2, 0.2, 0.2]] }";
    let text =
        scene(region, "target_mass = 1", "").replace("fill = { low = [0, 0, 0], high = [0.24, 0.24] }\n", "");
    refused(&text, "grains.0.target_mass: found, but it has no effect without `fill`");
}

#[test]
fn second_group_counts_the_first() {
    let text = scene(SPHERES, "target_height = 0.2", "");
    let group = &text[text.find("[[grains]]").unwrap()..text.find("[[walls]]").unwrap()];
    let second = group.replace("\"bed\"", "\"top\"").replace("target_height = 0.2", "target_height = 0.3");
    let (_, beds) = checked(&text.replacen(group, &format!("{group}{second}"), 1));
    let count = |k: usize| beds[k]["grains"].as_f64().unwrap();
    assert!((count(1) / count(0) - 0.5).abs() < 0.02, "{beds}");
    assert!((beds[1]["height"].as_f64().unwrap() / 0.3 - 1.0).abs() < 0.003, "{beds}");
}
