//! First steps: `new`, scene schema, completions, `check --json`, overrides by name.

use super::support::{Folder, json, repository, trackbed};
use boon::{Compiler, SchemaIndex, Schemas};
use clap::CommandFactory;
use serde_json::{Value, json};
use std::path::PathBuf;
use trackbed::cli::Cli;
use trackbed::scene::schema;
use trackbed::start::TEMPLATES;

#[test]
fn templates_are_valid_scenes() {
    let folder = Folder::new("templates");
    assert!(TEMPLATES.len() >= 6, "{}", TEMPLATES.len());
    let all = trackbed(["new"]).good().stdout;
    for template in TEMPLATES {
        let name = template.name;
        assert!(all.lines().any(|line| line.starts_with(name) && line.ends_with(template.about)), "{all}");
        let own = folder.join(name);
        let made = trackbed(["new", name, own.to_str().unwrap()]).good();
        let scene = own.join("scene.toml");
        let next: Vec<String> =
            ["view", "check", "run"].map(|c| format!("  trackbed {c} {}", scene.display())).into();
        assert_eq!(made.stdout, format!("{} written; next:\n{}\n", scene.display(), next.join("\n")));
        let shipped = repository().join("inputs").join(template.source);
        // Memory use varies.
        let check = |scene: &PathBuf| {
            let text = trackbed(["check", scene.to_str().unwrap(), "--strict"]).good().stdout;
            text.lines().filter(|line| !line.contains("memory: ")).map(String::from).collect::<Vec<_>>()
        };
        assert_eq!(check(&scene), check(&shipped), "{name}");
    }
    let own = folder.join("box");
    let scene = own.join("scene.toml");
    std::fs::write(&scene, "my own work").unwrap();
    let again = trackbed(["new", "box", own.to_str().unwrap()]);
    assert_eq!((again.code, again.stderr.lines().count()), (2, 1), "{again:?}");
    assert_eq!(std::fs::read_to_string(&scene).unwrap(), "my own work");
    let unknown = trackbed(["new", "bridge", folder.join("bridge").to_str().unwrap()]);
    assert!(unknown.code == 2 && unknown.stderr.contains("found bridge, expected one of track, box, "));
    assert!(!folder.join("bridge").exists());
}

fn as_json(text: &str) -> Value {
    serde_json::to_value(toml::from_str::<toml::Table>(text).unwrap()).unwrap()
}

fn compiled(schemas: &mut Schemas) -> SchemaIndex {
    let mut compiler = Compiler::new();
    compiler.add_resource("scene.json", schema::schema()).unwrap();
    compiler.compile("scene.json", schemas).unwrap()
}

#[test]
fn schema_accepts_shipped_scenes_only() {
    let mut schemas = Schemas::new();
    let index = compiled(&mut schemas);
    let mut folders = vec![repository().join("inputs")];
    let mut count = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = match path.extension() {
                Some(ending) if ending == "toml" => std::fs::read_to_string(&path).unwrap(),
                _ => continue,
            };
            let scene = as_json(&text);
            // Skips studies and stone libraries.
            if scene.get("title").is_some() && scene.get("scene").is_none() {
                count += 1;
                let result = schemas.validate(&scene, index);
                assert!(result.is_ok(), "{}: {:#}", path.display(), result.unwrap_err());
            }
        }
    }
    assert!(count >= 40, "{count} scenes");
    // With an include, a material may be only a name.
    let named = |include: Value| {
        let mut scene = as_json(
            "[[material]]\nname = \"stone\"\n[[material]]\nname = \"box\"\nfriction = 0.3\nrestitution = 0.3\n",
        );
        scene["include"] = include;
        scene.as_object_mut().unwrap().retain(|_, value| !value.is_null());
        schemas.validate(&scene, index).is_ok()
    };
    assert!(named(json!(["granite.toml"])) && !named(Value::Null));
    let text = std::fs::read_to_string(repository().join("inputs/ballast/box.toml")).unwrap();
    let whole = as_json(&text);
    for (place, value) in [
        ("/material/0/densty", json!(2650)),
        ("/material/0/density", json!("2650 kN")),
        ("/material/0/density", json!("many")),
        ("/grains/0/shape", json!("cube")),
        ("/grains/0/count", json!("650")),
        ("/walls/0/normal", json!([0.0, 0.0])),
        ("/output/vtk", json!("yes")),
        ("/output/vkt", json!(true)),
        ("/track/sleeper/hold", json!("x")),
    ] {
        let mut scene = whole.clone();
        let (table, key) = place.rsplit_once('/').unwrap();
        scene.pointer_mut(table).unwrap()[key] = value.clone();
        assert!(schemas.validate(&scene, index).is_err(), "{place} = {value}");
    }
}

/// Key descriptions equal the documentation.
#[test]
fn the_schema_explains_keys() {
    let printed = trackbed(["schema"]).good().stdout;
    let schema: Value = serde_json::from_str(&printed).unwrap();
    let text = |place: &str| schema.pointer(place).and_then(Value::as_str).unwrap_or_default().to_string();
    assert!(text("/properties/gravity/description").starts_with("Gravity"), "{printed}");
    assert!(text("/$defs/Wall/properties/normal/description").starts_with("Normal towards grains"));
    let without: Vec<&String> = schema["$defs"]["Wall"]["properties"]
        .as_object()
        .unwrap()
        .iter()
        .filter(|(_, value)| value.get("description").is_none())
        .map(|(key, _)| key)
        .collect();
    assert!(without.is_empty(), "no description: {without:?}");
}

/// All commands with their names, such as `trackbed-mesh-info`.
fn commands() -> Vec<(String, clap::Command)> {
    fn collect(command: &clap::Command, name: &str, all: &mut Vec<(String, clap::Command)>) {
        all.push((name.to_string(), command.clone()));
        for inner in command.get_subcommands() {
            collect(inner, &format!("{name}-{}", inner.get_name()), all);
        }
    }
    let mut command = Cli::command().disable_help_subcommand(true);
    command.build();
    let mut all = Vec::new();
    collect(&command, "trackbed", &mut all);
    all
}

fn options(command: &clap::Command) -> impl Iterator<Item = &str> {
    command.get_arguments().filter_map(clap::Arg::get_long)
}

#[test]
fn completions_name_every_option() {
    let commands = commands();
    assert!(commands.len() > 20, "{}", commands.len());
    for (shell, dashes) in
        [("bash", "--"), ("zsh", "--"), ("fish", "-l "), ("elvish", "--"), ("powershell", "--")]
    {
        let text = trackbed(["completions", shell]).good().stdout;
        for (name, command) in &commands {
            assert!(text.contains(command.get_name()), "{shell}: {name}");
            for option in options(command) {
                assert!(text.contains(&format!("{dashes}{option}")), "{shell}: {name}: {option}");
            }
        }
    }
}

#[test]
fn manual_covers_every_command() {
    let folder = Folder::new("manual");
    let pages = folder.join("man/man1");
    trackbed(["manual", pages.to_str().unwrap()]).good();
    let commands = commands();
    for (name, command) in &commands {
        let page = std::fs::read_to_string(pages.join(format!("{name}.1"))).unwrap();
        assert!(page.contains(&format!(".TH {name} 1")), "{page}");
        for option in options(command) {
            let written = format!("--{option}").replace('-', r"\-");
            assert!(page.contains(&written), "{name}: {written} is missing in\n{page}");
        }
    }
    assert_eq!(std::fs::read_dir(&pages).unwrap().count(), commands.len());
    trackbed(["manual", pages.to_str().unwrap()]).good();
    let kept = folder.write("man/man1/trackbed-run.1", "mine");
    let outcome = trackbed(["manual", pages.to_str().unwrap()]);
    assert!(
        outcome.code == 2 && outcome.stderr.contains("trackbed-run.1: found an existing file"),
        "{outcome:?}"
    );
    assert_eq!(std::fs::read_to_string(kept).unwrap(), "mine");
    let file = folder.write("file", "");
    let outcome = trackbed(["manual", file.to_str().unwrap()]);
    assert_eq!((outcome.code, outcome.stderr.lines().count()), (1, 1), "{outcome:?}");
    assert!(outcome.stderr.ends_with(", expected a writable directory\n"), "{outcome:?}");
}

#[test]
fn demo_runs_a_small_track() {
    let folder = Folder::new("demo");
    let out = folder.join("demo");
    let words = ["demo", "--no-view", "--out", out.to_str().unwrap()];
    let first = trackbed(words).good();
    for stage in ["settling", "compacting", "equilibrium", "running"] {
        assert!(first.stderr.contains(stage), "{stage} is missing in {first:?}");
    }
    assert!(!first.stderr.contains("warning: "), "{}", first.stderr);
    let summary = json(&out.join("results/summary.json"));
    assert_eq!(summary["status"], "done");
    assert!(out.join("scene/scene.toml").is_file() && out.join("results/results.pvd").is_file());
    // The second time it only reads the results.
    let second = trackbed(words).good();
    assert!(second.stdout.ends_with("run completed, nothing to resume\n"), "{second:?}");
}

#[test]
fn check_prints_numbers_for_programs() {
    let scene = repository().join("inputs/track/cyclic/scene.toml");
    let done = trackbed([
        "check",
        scene.to_str().unwrap(),
        "--json",
        "--set",
        "solid.material.subgrade.young=80",
        "--set",
        "material.stone.density=2700",
    ]);
    let report: Value = serde_json::from_str(&done.good().stdout).unwrap();
    let finding = &report["findings"][0];
    // Named tables are reported by index.
    assert_eq!(finding["key"], "solid.material.0.young", "{report:#}");
    assert_eq!((&finding["serious"], &finding["found"]), (&json!(true), &json!("80 Pa")));
    assert_eq!(report["solid"]["elements"], 684);
    assert!(report["solid"]["memory_bytes"].as_u64().unwrap() > 1_000_000);
    assert!(report["grains"]["bodies"].as_u64().unwrap() >= 1200);
    let share = report["coupling"]["stability"]["damping"].as_f64().unwrap();
    assert!(share > 0.0 && share <= 1.0, "{report:#}");
    let unknown = trackbed(["check", scene.to_str().unwrap(), "--set", "material.gravel.density=1"]);
    let words = "found material.gravel.density, expected an index below ";
    assert!(unknown.code == 2 && unknown.stderr.contains(words), "{unknown:?}");
}
