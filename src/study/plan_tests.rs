//! Tests of counts, labels and overrides.

use super::*;
use std::fs;
use trackbed_io::scratch::folder;

const SCENE: &str =
    "[[grains]]\nname = \"a\"\n[[grains]]\nname = \"b\"\nseed = 4\n[[bond]]\nspread = { seed = 3 }\n";

fn plan(name: &str, front: &str, behind: &str) -> Result<Plan, Failure> {
    let dir = folder(name);
    fs::write(dir.join("scene.toml"), "title = \"x\"\n").unwrap();
    let text = format!(
        "scene = \"scene.toml\"\n{front}\n[base]\nset = [\"title=y\"]\n[[axis]]\nkey = \"time.end\"\nvalues = [1, 2.5]\n\
         [[axis]]\nname = \"law\"\nvalues = [{{ label = \"a\", set = [\"x=1\", \"y=2\"] }}, {{ label = \"b\", set = [] }}]\n\
         [[quantity]]\nsummary = \"energy.error\"\n{behind}"
    );
    let document = Document::parse(&dir.join("study.toml"), text)?;
    let plan = Plan::new(&document, &document.read()?);
    fs::remove_dir_all(&dir).unwrap();
    plan
}

fn labels(plan: &Plan) -> Vec<&str> {
    plan.settings.iter().map(|s| s.label.as_str()).collect()
}

#[test]
fn axes_are_combined_in_three_ways() {
    let grid = plan("study_grid", "", "").unwrap();
    let all = ["end=1, law=a", "end=1, law=b", "end=2.5, law=a", "end=2.5, law=b"];
    assert_eq!(labels(&grid), all);
    assert_eq!(grid.settings[2].set, ["title=y", "time.end=2.5", "x=1", "y=2"]);
    assert_eq!(grid.settings[2].levels, ["2.5", "a"]);
    assert_eq!((grid.reference, grid.runs.len()), (0, 4));
    assert_eq!(grid.runs[1].folder, "end=1_law=b");
    let list = plan("study_list", "combine = \"list\"", "").unwrap();
    assert_eq!(labels(&list), ["end=1, law=a", "end=2.5, law=b"]);
    let single = plan("study_single", "combine = \"one_at_a_time\"", "").unwrap();
    assert_eq!(labels(&single), ["base", "end=2.5", "law=b"]);
    assert_eq!(single.settings[2].set, ["title=y", "time.end=1"]);
    let unlike = plan("study_unlike", "combine = \"list\"", "[[axis]]\nkey = \"z\"\nvalues = [1]\n");
    let error = unlike.unwrap_err().to_string();
    let expected =
        "axis.2.values: found 1 values, expected 2, as many as the first axis has, for combine = \"list\"";
    assert!(error.ends_with(expected), "{error}");
}

#[test]
fn resolves_reference() {
    let own = plan("study_own", "", "[reference]\nset = [\"time.end=0.1\"]").unwrap();
    assert_eq!((own.reference, labels(&own)[0], own.runs.len()), (0, "reference", 5));
    assert_eq!(own.settings[0].set, ["title=y", "time.end=0.1"]);
    let one = plan("study_one", "", "[reference]\nlabel = \"end=2.5, law=a\"").unwrap();
    assert_eq!((one.reference, one.runs.len()), (2, 4));
    let both = plan("study_both", "", "[reference]\nlabel = \"a\"\nset = []").unwrap_err().to_string();
    assert!(both.contains("reference.label: found together with `set`, expected only one of them"), "{both}");
}

#[test]
fn assigns_seeds_to_scene_keys() {
    let keys = "[seeds]\nvalues = [7, 8]\nkeys = [\"a.seed\"]";
    let stated = plan("study_keys", "", keys).unwrap();
    assert_eq!(stated.runs.len(), 8);
    assert_eq!(stated.runs[1].label, "end=1, law=a, seed=8");
    assert_eq!(stated.runs[1].set.last().unwrap(), "a.seed=8");
    let none = plan("study_no_keys", "", "[seeds]\nvalues = [1]").unwrap_err().to_string();
    assert!(none.contains("seeds.keys: found nothing"), "{none}");
    let twice = plan("study_twice", "", "[seeds]\nvalues = [1, 1]").unwrap_err().to_string();
    assert!(twice.contains("seeds.values: found [1, 1], expected at least one seed, each once"), "{twice}");
    let dir = folder("study_seeds");
    let scene = dir.join("scene.toml");
    fs::write(&scene, SCENE).unwrap();
    let setting = Setting { label: String::new(), levels: Vec::new(), set: Vec::new() };
    assert_eq!(
        seed_keys(&Document::open(&scene).unwrap(), &setting.set).unwrap(),
        ["bond.0.spread.seed", "grains.0.seed", "grains.1.seed"]
    );
    fs::remove_dir_all(&dir).unwrap();
}

const SAMPLES: &str = "[sampling]\nmethod = \"latin-hypercube\"\nsamples = 6\n[[parameter]]\nkey = \"grains.0.count\"\n\
                       range = [1, 3]\ninteger = true\n";

#[test]
fn samples_run_at_each_case() {
    let plan = plan("study_sampled", "", SAMPLES).unwrap();
    assert_eq!((plan.runs.len(), plan.axes.len(), plan.has_reference()), (24, 3, false));
    assert_eq!(plan.runs[7].label, "end=1, law=b, sample=002");
    assert_eq!(plan.axes, ["count", "end", "law"]);
    assert_eq!(plan.factors[2].categories, ["a", "b"]);
    let count = |k: usize| plan.settings[k].set.last().unwrap().clone();
    assert_eq!(plan.settings[7].set[..2], ["title=y", "time.end=1"]);
    assert_eq!(plan.coordinates[7][1..], [Some(1.0), Some(2.0)]);
    // Two samples of each whole number; the same ones at each case.
    let mut counts: Vec<String> = (0..6).map(count).collect();
    assert_eq!(counts, (18..24).map(count).collect::<Vec<_>>());
    counts.sort();
    let expected = [1, 1, 2, 2, 3, 3].map(|n| format!("grains.0.count={n}"));
    assert_eq!(counts, expected);
    let twice = SAMPLES.replace("range", "name = \"law\"\nrange");
    let error = self::plan("study_twins", "", &twice).unwrap_err().to_string();
    assert!(error.contains("axis.1.name: found \"law\" twice, expected distinct names"), "{error}");
}
