//! Bad parameters, samples and targets.

use super::arguments;
use super::parameters::folder;
use crate::suite::support::trackbed;

const STUDY: &str = r#"scene = "scene.toml"

[sampling]
method = "sobol"
samples = 4

[[parameter]]
name = "duration"
key = "time.end"
range = [0.2, 2.0]
unit = "ms"

[[quantity]]
name = "height"
file = "history.csv"
column = "ball_z"

[[target]]
quantity = "height"
value = 0.059
tolerance = 0.001
"#;

#[track_caller]
fn refused(old: &str, new: &str, line: &str) {
    assert_eq!(STUDY.matches(old).count(), 1, "{old}");
    let folder = folder("study_refused_parameters", &STUDY.replace(old, new));
    let outcome = trackbed(arguments(&folder, "out", &[]));
    let said = outcome.stderr.replace(&format!("{}/", folder.path().display()), "");
    assert_eq!((outcome.code, said.as_str()), (2, format!("error: {line}\n").as_str()));
    assert!(!folder.join("out").exists(), "a rejected study writes nothing");
}

#[test]
fn rejects_bad_samples() {
    let line =
        "study.toml:4: sampling.method: found \"monte-carlo\", expected \"latin-hypercube\" or \"sobol\"";
    refused("\"sobol\"", "\"monte-carlo\"", line);
    refused("samples = 4", "samples = 1", "study.toml:5: sampling.samples: found 1, expected 2 to 100000");
    let line = "study.toml:5: sampling.sample: found the unknown key `sample`, expected `samples`";
    refused("samples = 4", "sample = 4", line);
    let line = "study.toml:4: parameter: found without `sampling`, expected both";
    refused("[sampling]\nmethod = \"sobol\"\nsamples = 4\n\n", "\n", line);
    let line = "study.toml:2: combine: found together with `parameter`, expected only one of them";
    refused("\"scene.toml\"\n", "\"scene.toml\"\ncombine = \"grid\"", line);
    let line = "study.toml:2: tolerance: found together with `parameter`, expected only one of them";
    refused("\"scene.toml\"\n", "\"scene.toml\"\ntolerance = 0.1", line);
    let line = "study.toml:17: quantity.0.exact: found together with `parameter`, expected only one of them";
    refused("\"ball_z\"\n", "\"ball_z\"\nexact = 1.0", line);
    let ten: String = (0..10)
        .map(|k| format!("[[parameter]]\nname = \"p{k}\"\nkey = \"x{k}\"\nrange = [0, 1]\n"))
        .collect();
    let line = "study.toml:7: parameter: found 11 parameters, expected at most 10 with method = \"sobol\"";
    refused("unit = \"ms\"\n", &format!("unit = \"ms\"\n{ten}"), line);
    let line = "study.toml:14: parameter.1.key: found \"time.end\" twice, expected distinct keys";
    let twice = "unit = \"ms\"\n[[parameter]]\nname = \"again\"\nkey = \"time.end\"\nrange = [0, 1]\n";
    refused("unit = \"ms\"\n", twice, line);
}

#[test]
fn rejects_bad_parameters() {
    let at = "study.toml:10: parameter.0.range: found";
    let line = format!("{at} [2.0, 0.2], expected two finite numbers, ascending");
    refused("[0.2, 2.0]", "[2.0, 0.2]", &line);
    refused("[0.2, 2.0]", "[1, 1]", &format!("{at} [1.0, 1.0], expected two finite numbers, ascending"));
    refused("[0.2, 2.0]", "[0, inf]", &format!("{at} [0.0, inf], expected two finite numbers, ascending"));
    refused("[0.2, 2.0]", "[-1e308, 1e308]", &format!("{at} [-1e308, 1e308], expected a smaller range"));
    let line = format!("{at} [0.0, 2.0], expected two numbers above 0 with scale = \"log\"");
    refused("[0.2, 2.0]", "[0, 2]\nscale = \"log\"", &line);
    let line = format!("{at} [0.2, 2.0], expected two whole numbers of at most 2⁵³ with integer = true");
    refused("[0.2, 2.0]", "[0.2, 2.0]\ninteger = true", &line);
    let line = "study.toml:9: parameter.0.key: found \"a=b\", expected a key of the scene";
    refused("\"time.end\"", "\"a=b\"", line);
    let line = "study.toml:8: parameter.0.name: found \"a,b\", expected a name without = , | or quotes";
    refused("\"duration\"", "\"a,b\"", line);
    let line =
        "study.toml:8: parameter.0.name: found \"height\", the name of a quantity, expected distinct names";
    refused("\"duration\"", "\"height\"", line);
    let line = "study.toml:11: parameter.0.unit: found \"\\\"\", expected a unit such as \"GPa\"";
    refused("\"ms\"", "'\"'", line);
    let twice = "unit = \"ms\"\n[[parameter]]\nname = \"duration\"\nkey = \"x\"\nrange = [0, 1]\n";
    refused(
        "unit = \"ms\"\n",
        twice,
        "study.toml:13: parameter.1.name: found \"duration\" twice, expected distinct names",
    );
}

#[test]
fn rejects_bad_targets() {
    let line = "study.toml:19: target.0.quantity: found \"heigth\", expected one of \"height\"";
    refused("quantity = \"height\"", "quantity = \"heigth\"", line);
    refused("0.001", "0.0", "study.toml:21: target.0.tolerance: found 0, expected a number above 0");
    refused("0.059", "nan", "study.toml:20: target.0.value: found NaN, expected a finite number");
    let twice = "0.001\n[[target]]\nquantity = \"height\"\nvalue = 1\ntolerance = 1";
    refused(
        "0.001",
        twice,
        "study.toml:23: target.1.quantity: found \"height\" twice, expected one target per quantity",
    );
    let line =
        "study.toml:20: target.0.quantity: found \"height\", expected a quantity without take = \"curve\"";
    refused("\"ball_z\"\n", "\"ball_z\"\ntake = \"curve\"\n", line);
}

#[test]
fn rejects_samples_of_invalid_scenes() {
    let folder = folder("study_invalid_samples", &STUDY.replace("[0.2, 2.0]", "[-1.0, 2.0]"));
    let outcome = trackbed(arguments(&folder, "out", &[]));
    assert_eq!(outcome.code, 2);
    let words = "study.toml: 2 runs rejected: \"sample=001\": --set: time.end: found -0.001, expected";
    assert!(outcome.stderr.contains(words) && outcome.stderr.lines().count() == 1, "{}", outcome.stderr);
    folder.edit("study.toml", "\"time.end\"", "\"time.stop\"");
    let outcome = trackbed(arguments(&folder, "out", &[]));
    let words = "study.toml: \"sample=001\" and 3 more: --set: time.stop: found the unknown key `stop`";
    assert!(outcome.code == 2 && outcome.stderr.contains(words), "{}", outcome.stderr);
    assert!(!folder.join("out").exists());
}
