//! Random changes of one to three scene keys.

use super::super::support::{COUPLED, Folder, GRAINS, PLASTIC, SOLID, repository, small_block, write_lists};
use super::within;
use std::fs;
use std::path::{Path, PathBuf};

#[rustfmt::skip]
const VALUES: [&str; 34] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "0.5",
    "1e-3",
    "1e3",
    "1e-9",
    "1e9",
    "-1e9",
    "1e-300",
    "1e300",
    "-1e300",
    "1e308",
    "5e-324",
    "nan",
    "-nan",
    "inf",
    "-inf",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "\"\"",
    "\"x\"",
    "\"1 parsec\"",
    "\"../../..\"",
    "true",
    "[]",
    "[0]",
    "[1, 2, 3]",
    "{}",
    "1979-05-27",
];

struct Chance(u64);

impl Chance {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n as u64) as usize
    }
}

fn leaves(path: &str, value: &toml::Value, out: &mut Vec<(String, toml::Value)>) {
    let below = |key: &str| if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
    match value {
        toml::Value::Table(table) => table.iter().for_each(|(key, v)| leaves(&below(key), v, out)),
        toml::Value::Array(items) if items.iter().any(toml::Value::is_table) => {
            items.iter().enumerate().for_each(|(i, v)| leaves(&below(&i.to_string()), v, out));
        }
        _ => {}
    }
    if !path.is_empty() {
        out.push((path.to_string(), value.clone()));
    }
}

fn scaled(value: &toml::Value, factor: f64) -> Option<String> {
    match value {
        toml::Value::Integer(i) if factor > 1.0 => Some(format!("{}", (*i as f64 * factor) as i64)),
        toml::Value::Float(x) => Some(format!("{:e}", x * factor)),
        toml::Value::String(text) => {
            let (number, unit) = text.split_once(' ')?;
            Some(format!("\"{:e} {unit}\"", number.parse::<f64>().ok()? * factor))
        }
        toml::Value::Array(items) if !items.is_empty() => {
            let items: Option<Vec<String>> = items.iter().map(|item| scaled(item, factor)).collect();
            Some(format!("[{}]", items?.join(", ")))
        }
        _ => None,
    }
}

/// Mostly plausible factors.
const FACTORS: [f64; 12] = [0.5, 2.0, 0.9, 1.1, 0.1, 10.0, 1e-3, 1e3, 1e-6, 1e6, -1.0, 1e12];

fn change(leaves: &[(String, toml::Value)], chance: &mut Chance) -> String {
    let (path, value) = &leaves[chance.below(leaves.len())];
    let other = VALUES[chance.below(VALUES.len())];
    match (chance.below(8), scaled(value, FACTORS[chance.below(FACTORS.len())]), value.as_array()) {
        (0, ..) => format!("{path}="),
        (1..=4, Some(text), _) => format!("{path}={text}"),
        (5, _, Some(items)) if !items.is_empty() => {
            let mut items: Vec<String> = items.iter().map(toml::Value::to_string).collect();
            let at = chance.below(items.len());
            items[at] = other.to_string();
            format!("{path}=[{}]", items.join(", "))
        }
        _ => format!("{path}={other}"),
    }
}

fn tiny(folder: &Folder) -> Vec<PathBuf> {
    write_lists(&small_block(), folder.path());
    [("solid", SOLID), ("plastic", PLASTIC), ("grains", GRAINS), ("coupled", COUPLED)]
        .map(|(name, text)| folder.write(&format!("{name}.toml"), text))
        .to_vec()
}

fn shipped() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![repository().join("inputs")];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "toml") {
                let text = fs::read_to_string(&path).unwrap();
                let large = ["embankment_large.toml", "solid/large.toml"].iter().any(|l| path.ends_with(l));
                let is_scene =
                    text.lines().any(|l| ["[solid]", "[[grains]]"].iter().any(|h| l.starts_with(h)));
                found.extend((is_scene && !large).then_some(path));
            }
        }
    }
    found.sort();
    found
}

/// Error in the exit of a command, if any.
fn fault(verb: &str, scene: &Path, set: &[String], out: &Path) -> Option<String> {
    let mut arguments = vec![verb.to_string(), scene.display().to_string()];
    set.iter().for_each(|s| arguments.extend(["--set".to_string(), s.clone()]));
    if verb == "run" {
        arguments.extend(["--quiet".to_string(), "--out".into(), out.display().to_string()]);
    }
    let shown = format!("{verb} {} --set {}", scene.display(), set.join(" --set "));
    let Some(outcome) = within(if verb == "run" { 5 } else { 60 }, &arguments) else {
        // Runs may be slow.
        return (verb != "run").then(|| format!("no end: {shown}"));
    };
    let good = match (verb, outcome.code) {
        (_, 0) => true,
        // One error per change.
        ("check", 2) => {
            let lines: Vec<&str> = outcome.stderr.lines().collect();
            (1..=set.len()).contains(&lines.len())
                && lines.iter().all(|l| l.starts_with("error: ") && l[7..].contains(": "))
        }
        // Only factorisation detects these.
        ("run", 2) => ["an ill-conditioned stiffness matrix", "expected supports that prevent"]
            .iter()
            .any(|w| outcome.stderr.contains(w)),
        ("run", 3) => !outcome.stderr.contains("internal error"),
        _ => false,
    };
    (!good).then(|| format!("{} of {shown}: {}", outcome.code, outcome.stderr))
}

fn changed(scenes: &[PathBuf], count: usize, seed: u64, runs: bool) {
    let folder = Folder::new("mutations");
    let mut chance = Chance(seed);
    let (mut faults, mut ran) = (Vec::new(), 0);
    for scene in scenes {
        let tree: toml::Table = toml::from_str(&fs::read_to_string(scene).unwrap()).unwrap();
        let mut all = Vec::new();
        leaves("", &toml::Value::Table(tree), &mut all);
        for _ in 0..count {
            let set: Vec<String> = (0..=chance.below(5) / 3).map(|_| change(&all, &mut chance)).collect();
            let out = folder.join("out");
            let wrong = fault("check", scene, &set, &out);
            let good = wrong.is_none() && runs && {
                let mut arguments = vec!["check".to_string(), scene.display().to_string()];
                set.iter().for_each(|s| arguments.extend(["--set".to_string(), s.clone()]));
                within(30, &arguments).is_some_and(|o| o.code == 0)
            };
            faults.extend(wrong);
            if good {
                ran += 1;
                faults.extend(fault("run", scene, &set, &out));
                let _ = fs::remove_dir_all(&out);
            }
        }
    }
    println!("{ran} changed scenes ran");
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
    assert!(!runs || ran > count / 4, "hardly any changed scene ran: {ran}");
}

#[test]
fn changed_scenes_run_or_are_refused() {
    let folder = Folder::new("tiny");
    changed(&tiny(&folder), 30, 1, true);
}

#[test]
fn changed_shipped_scenes_pass_or_fail() {
    changed(&shipped(), 3, 2, false);
}

/// `TRACKBED_SEED` and `TRACKBED_CHANGES` (count).
#[test]
#[ignore = "some thousand changes, 15 min"]
fn many_changed_scenes() {
    let number = |name: &str, default| std::env::var(name).map_or(default, |v| v.parse().unwrap());
    let (seed, count) = (number("TRACKBED_SEED", 7), number("TRACKBED_CHANGES", 400));
    let folder = Folder::new("tiny_many");
    changed(&tiny(&folder), count as usize, seed, true);
    changed(&shipped(), count as usize / 10, seed, false);
}
