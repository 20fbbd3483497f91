//! `trackbed life`: traffic, tampings, pushes, several packings.

use super::support::{Folder, Outcome, Table, json, repository, trackbed};
use std::fs;

/// The shipped life with small beds and few cycles.
fn small() -> Folder {
    let folder = Folder::new("life");
    let bay = repository().join("inputs/track/life/bay.toml");
    let set = "[\"grains.0.count=150\", \"grains.1.count=60\", \"grains.2.count=20\", \"deposition.max_time=0.3\", \
        \"compaction.0.rest=0.05\", \"compaction.1.rest=0.2\", \"compaction.2.cycles=1\", \"compaction.2.rest=0.05\", \
        \"track.load.frequency=20\", \"track.jump.first=20\", \"track.jump.measure=4\", \"output.frames=1\"]";
    let text = fs::read_to_string(repository().join("inputs/track/life/life.toml")).unwrap();
    let text = text
        .replace("scene = \"bay.toml\"", &format!("scene = {:?}\nset = {set}", bay.to_str().unwrap()))
        .replace("until = 19.25", "until = 1.6e-3")
        .replace("at = [9.625]", "at = [1.2e-3]")
        .replace("cycles = 32", "cycles = 4")
        .replace("displacement = \"5 mm\"", "displacement = \"2.2 mm\"")
        .replace("[control]\nrepetitions = 0 ", "[control]\ntolerance = 10 ");
    folder.write("life.toml", &text);
    folder
}

fn life(folder: &Folder, more: &[&str]) -> Outcome {
    let [file, out] = ["life.toml", "out"].map(|name| folder.join(name).display().to_string());
    trackbed([&["life", &file, "--out", &out][..], more].concat())
}

#[test]
fn a_small_life_adds_up() {
    let folder = small();
    let said = life(&folder, &[]).good();
    let out = folder.join("out");
    let life_json = json(&out.join("life.json"));
    // Mean axle 19.25 t; half the axles count (16/22.5)^1.6.
    let axles = 1e6 / 19.25;
    let cycles = axles * 0.5 * (1.0 + (16.0_f64 / 22.5).powf(1.6));
    let near = |value: &serde_json::Value, expected: f64| {
        let value = value.as_f64().unwrap();
        assert!((value - expected).abs() <= 1e-9 * expected.abs(), "{value}, not {expected}");
    };
    near(&life_json["axles_per_mgt"], axles);
    near(&life_json["cycles_per_mgt"], cycles);
    let periods = life_json["periods"].as_array().unwrap();
    let counts: Vec<f64> = periods.iter().map(|p| p["cycles"].as_f64().unwrap()).collect();
    let expected = [1.2e-3, 4e-4].map(|mgt: f64| (mgt * cycles).round());
    assert_eq!(counts, [expected[0], expected[0], expected[1], expected[1]]);
    let (tampings, pushes) = (&life_json["tampings"], &life_json["lateral_resistance"]);
    assert_eq!((tampings.as_array().unwrap().len(), pushes.as_array().unwrap().len()), (2, 8));
    // A sleeper on 150 stones may lose its support, so the mean counts.
    let forces: Vec<f64> = pushes.as_array().unwrap().iter().map(|p| p["force"].as_f64().unwrap()).collect();
    assert!(forces.iter().sum::<f64>() / 8.0 > 100.0, "{pushes}");
    // Level: settlements less what tamping raised.
    let of = |list: &serde_json::Value, packing: u64, key: &str| -> f64 {
        let own = list.as_array().unwrap().iter().filter(|p| p["packing"] == packing);
        own.map(|p| p[key].as_f64().unwrap()).sum()
    };
    let settled = |packing, key| of(&life_json["periods"], packing, key);
    let level = |packing| {
        settled(packing, "settlement") + settled(packing, "before_cycles") - of(tampings, packing, "raised")
    };
    let last = life_json["curve"].as_array().unwrap().last().unwrap()["level"][0].as_f64().unwrap();
    let mean = 0.5 * (level(1) + level(2));
    assert!((last - mean).abs() < 1e-12, "{last}, not {mean}");
    // The band has the errors of both periods.
    let ends = [1, 2].map(|p| [level(p), settled(p, "jump_error")]);
    let [low, high] =
        [1, 2].map(|k| life_json["curve"].as_array().unwrap().last().unwrap()["level"][k].as_f64().unwrap());
    let expected = ends.iter().map(|[s, e]| s - e).fold(f64::INFINITY, f64::min);
    assert!((low - expected).abs() < 1e-12 && high - low > ends[0][1], "{low} {high}, not {expected}");
    let csv = Table::read(&out.join("life.csv"));
    assert!((csv.column("level").last().unwrap() - last).abs() < 1e-15);
    assert!((csv.column("traffic").last().unwrap() - 1.6e-3).abs() < 0.5 / cycles);
    // Each period starts from the end of the run before.
    let height = |name: &str| Table::read(&out.join("1").join(name).join("history.csv")).column("sleeper_z");
    let [built, traffic, tamped, again] = ["built", "traffic-1", "tamped-1", "traffic-2"].map(height);
    assert!((built.last().unwrap() - traffic[0]).abs() < 1e-12);
    assert!((tamped.last().unwrap() - again[0]).abs() < 1e-12);
    let raised = tampings[0]["raised"].as_f64().unwrap();
    assert!((tamped.last().unwrap() - traffic.last().unwrap() - raised).abs() < 1e-12, "{raised}");
    assert!(raised != 0.0);
    assert!(said.stdout.contains("lateral resistance at 2 mm [kN]"), "{}", said.stdout);
    // Forecasts of the last simulated cycle from half of the cycles.
    let forecasts = periods[0]["forecasts"].as_array().unwrap();
    let simulated = periods[0]["simulated"].as_f64().unwrap();
    assert_eq!(forecasts[0]["cycle"], simulated);
    assert_eq!(forecasts[0]["from"], (0.5 * simulated).floor());
    let page = fs::read_to_string(out.join("life.md")).unwrap();
    assert!(page.contains("## Forecasts of simulated cycles"), "{page}");
    for name in ["life.md", "life.svg", "resistance.svg"] {
        assert!(out.join(name).is_file(), "{name}");
    }
    // Finished runs are kept; without --resume nothing is overwritten.
    let refused = life(&folder, &[]);
    assert!(refused.code == 2 && refused.stderr.contains("found a run, expected --resume"), "{refused:?}");
    fs::remove_dir_all(out.join("2/traffic-2")).unwrap();
    fs::remove_file(out.join("life.json")).unwrap();
    let before = fs::metadata(out.join("1/traffic-1/summary.json")).unwrap().modified().unwrap();
    life(&folder, &["--resume"]).good();
    assert_eq!(fs::metadata(out.join("1/traffic-1/summary.json")).unwrap().modified().unwrap(), before);
    assert_eq!(json(&out.join("life.json"))["curve"], life_json["curve"]);
}

/// Without jumps the level is the height lost by the sleeper.
#[test]
fn level_follows_the_sleeper() {
    let folder = small();
    folder.edit("life.toml", "\"track.jump.first=20\", \"track.jump.measure=4\"", "\"track.jump=\"");
    let text = fs::read_to_string(folder.join("life.toml")).unwrap();
    let push = text.find("[push]").unwrap();
    folder.write("life.toml", &text[..push]);
    life(&folder, &[]).good();
    let out = folder.join("out");
    let lost = |packing: &str| {
        let at = |name: &str| {
            let z = Table::read(&out.join(packing).join(name).join("history.csv")).column("sleeper_z");
            z[z.len() - 1]
        };
        at("built") - at("traffic-2")
    };
    let life_json = json(&out.join("life.json"));
    let last = life_json["curve"].as_array().unwrap().last().unwrap()["level"][0].as_f64().unwrap();
    let mean = 0.5 * (lost("1") + lost("2"));
    assert!((last - mean).abs() < 2e-5, "{last}, not {mean}");
    assert!(
        life_json["jumps"].as_array().unwrap().is_empty()
            && life_json["laws_alone"].as_array().unwrap().is_empty()
    );
}

#[test]
fn plan_lists_the_runs() {
    let folder = small();
    let file = folder.join("life.toml").display().to_string();
    let said = trackbed(["life", &file, "--plan"]).good().stdout;
    for expected in [
        "seeds 4, 5, 8 runs",
        "period 2: 0.0012 to 0.0016 MGT, 21 axles, 16 load cycles",
        "tamping 1: 2 stages",
    ] {
        assert!(said.contains(expected), "{said}");
    }
    folder.edit("life.toml", "displacement = \"2.2 mm\"", "displacement = \"-2 mm\"");
    assert_eq!(trackbed(["life", &file, "--plan"]).code, 2);
}

#[test]
fn faults_name_the_key() {
    let folder = small();
    let refused = |old: &str, new: &str, words: &str| {
        let folder = small();
        folder.edit("life.toml", old, new);
        let said = life(&folder, &[]);
        assert!(said.code == 2 && said.stderr.contains(words), "{words}: {said:?}");
        assert!(!folder.join("out").exists());
    };
    drop(folder);
    refused(
        "packings = [4, 5]",
        "packings = [4, 4]",
        "packings: found [4, 4], expected at least two seeds, each once",
    );
    refused(
        "share = 0.5 }]",
        "share = 0.4 }]",
        "traffic.axles: found shares with the sum 0.9, expected the sum 1",
    );
    refused(
        "at = [1.2e-3]",
        "at = [2e-3]",
        "tamping.at: found [0.002], expected rising values between 0 and `until`",
    );
    refused("per_year = 10.0", "per_year = 0", "traffic.per_year: found 0, expected above 0");
    refused("until = 1.6e-3", "until = 1.20001e-3", "found a period of 0 cycles");
    refused("gap = \"80 mm\"", "gap = \"60 mm\"", "compaction.3.tines.gap");
    refused("direction = [1, 0]", "direction = [0, 0]", "push: ");
    refused("per_year", "a_year", "a_year");
    refused("\"2.2 mm\"", "\"2 mm\"", "push.displacement: found 0.002 m, expected more than 0.002 m");
    refused("per_year = 10.0", "exponent = 30", "traffic.exponent: found 30, expected at most 20");
    refused("tolerance = 10", "repetitions = 11", "control.repetitions: found 11, expected at most 10");
}
