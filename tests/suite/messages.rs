//! Messages: several errors together, colours, progress.

use super::support::{Folder, GRAINS, Outcome, SOLID, scene_folder, trackbed};
use std::process::Command;

fn faults(outcome: &Outcome) -> Vec<&str> {
    assert_eq!(outcome.code, 2, "{outcome:?}");
    let lines: Vec<&str> = outcome.stderr.lines().collect();
    lines.iter().map(|l| l.strip_prefix("error: ").unwrap_or_else(|| panic!("{outcome:?}"))).collect()
}

#[test]
fn reports_all_syntax_errors() {
    let folder = Folder::new("faults_of_form");
    let text = GRAINS
        .replace("friction = 0.5", "fricton = 0.5")
        .replace("\"20 ms\"", "\"20 mm\"")
        .replace("frames = 2", "frames = \"two\"")
        .replace("kind = \"plane\"", "kind = \"plain\"");
    let scene = folder.write("scene.toml", &text);
    let (scene, out) = (scene.to_str().unwrap(), folder.join("out"));
    let checked = trackbed(["check", scene]);
    let lines = faults(&checked);
    let line = |word: &str| 1 + text.lines().position(|l| l.contains(word)).unwrap();
    for (word, key) in [
        ("fricton", "material.0.fricton"),
        ("\"20 mm\"", "time.end"),
        ("\"two\"", "output.frames"),
        ("plain", "walls.0"),
    ] {
        let place = format!("scene.toml:{}: {key}", line(word));
        assert_eq!(lines.iter().filter(|l| l.contains(&place)).count(), 1, "{place}: {lines:#?}");
    }
    assert_eq!(lines.len(), 4, "{lines:#?}");
    let run = trackbed(["run", scene, "--out", out.to_str().unwrap()]);
    assert!(run.stderr == checked.stderr && !out.exists(), "{run:?}");
}

#[test]
fn reports_errors_of_separate_tables() {
    let folder = scene_folder("faults_of_values", SOLID);
    let scene = folder.join("scene.toml");
    let check = |set: &[&str]| {
        let set = set.iter().flat_map(|s| ["--set", *s]);
        trackbed(["check", scene.to_str().unwrap()].into_iter().chain(set))
    };
    let outcome = check(&["solid.material.0.young=-5", "probe.0.node=77777", "output.frames=2000000"]);
    let found = faults(&outcome);
    let keys = ["material.0.young", "probe.0", "output.frames"];
    let named = |key: &&str| found.iter().filter(|line| line.contains(*key)).count() == 1;
    assert!(found.len() == keys.len() && keys.iter().all(named), "{found:#?}");
    // Poisson's ratio depends on the given modulus: first error only.
    let outcome = check(&["solid.material.0.young=-5", "solid.material.0.poisson=0.7"]);
    assert_eq!(faults(&outcome).len(), 1, "{outcome:?}");
    let folder = Folder::new("faults_of_names");
    let scene = folder.write("scene.toml", &GRAINS.replace("name = \"stone\"", "name = \"\""));
    let outcome = trackbed(["check", scene.to_str().unwrap()]);
    assert_eq!(faults(&outcome).len(), 1, "{outcome:?}");
}

/// Terminals, or forced; `NO_COLOR` wins.
#[test]
fn colours_are_for_terminals() {
    let folder = Folder::new("colours");
    let scene = folder.write("scene.toml", &GRAINS.replace("0.05]", "-0.05]"));
    let said = |variables: &[(&str, &str)]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_trackbed"));
        command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE").envs(variables.iter().copied());
        let output = command.arg("check").arg(&scene).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    };
    let plain = said(&[]);
    assert!(plain.starts_with("error: ") && !plain.contains('\u{1b}'), "{plain:?}");
    let coloured = said(&[("CLICOLOR_FORCE", "1")]);
    assert!(coloured.starts_with("\u{1b}[1m\u{1b}[31merror:\u{1b}[0m "), "{coloured:?}");
    assert_eq!(said(&[("CLICOLOR_FORCE", "1"), ("NO_COLOR", "1")]), plain);
}

#[test]
fn lines_of_a_verbose_run() {
    let folder = Folder::new("verbose");
    let scene = super::support::repository().join("inputs/grains/box.toml");
    let run = |more: &[&str], out: &str| {
        let out = folder.join(out);
        let own = ["run", scene.to_str().unwrap(), "--threads", "1", "--out", out.to_str().unwrap()];
        trackbed(
            own.into_iter()
                .chain(["--set", "grains.0.count=3000", "--set", "time.end=0.3"])
                .chain(more.iter().copied()),
        )
    };
    let verbose = run(&["--verbose"], "verbose").good();
    let lines: Vec<&str> = verbose.stderr.lines().filter(|l| l.contains(" % ")).collect();
    assert!(!lines.is_empty(), "{verbose:?}");
    for line in lines {
        let percent: f64 =
            line.split('%').next().unwrap().split_whitespace().last().unwrap().parse().unwrap();
        assert!(line.trim_start().starts_with("running"), "{line}");
        assert!(percent <= 3.0 || line.contains(" of about "), "{line}");
        assert!(line.contains(" DEM steps, ") && line.ends_with(" contacts"), "{line}");
    }
    assert_eq!(run(&["--quiet"], "quiet").good().stderr, "");
    assert_eq!(run(&["--quiet", "--verbose"], "both").code, 2);
}

/// Earlier names of keys and values act as the present ones.
#[test]
fn earlier_names_give_notes() {
    let folder = scene_folder("earlier_names", SOLID);
    let dynamics =
        "[solid.dynamics]\nalpha = 0.3025\ndelta = 0.6\n\n[time]\nend = 0.1\nsolid_step = 0.01\n\n[output]";
    let solid = SOLID.replace("[output]", dynamics);
    let spheres = GRAINS.lines().find(|line| line.starts_with("spheres")).unwrap();
    let law = "count = 3\nsizes = { law = \"equal\", size = 0.01 }\nregion = { box = [[-0.1, -0.1, 0.1], [0.1, 0.1, 0.4]] }";
    let cases = [
        (solid.clone(), vec![("alpha", "beta"), ("delta", "gamma")]),
        (
            GRAINS.replace(spheres, &format!("{spheres}\nmotion = [0, 0, 0]")),
            vec![("motion", "prescribed_velocity")],
        ),
        (GRAINS.replace(spheres, law), vec![("\"equal\"", "\"monodisperse\"")]),
    ];
    for (text, names) in cases {
        let scene = folder.write("scene.toml", &text);
        let earlier = trackbed(["check", "--json", scene.to_str().unwrap()]).good();
        let mut present = text.clone();
        for (old, new) in &names {
            let quoted =
                |name: &str| if name.starts_with('"') { name.to_string() } else { format!("`{name}`") };
            let note = format!("found {}, expected {}", quoted(old), quoted(new));
            assert!(
                earlier.stderr.contains("note: ") && earlier.stderr.contains(&note),
                "{}",
                earlier.stderr
            );
            present = present
                .replace(&format!("{old} ="), &format!("{new} ="))
                .replace(&format!("= {old}"), &format!("= {new}"));
        }
        folder.write("scene.toml", &present);
        let now = trackbed(["check", "--json", scene.to_str().unwrap()]).good();
        // Memory differs between processes.
        let same = |outcome: &Outcome| -> Vec<String> {
            outcome.stdout.lines().filter(|line| !line.contains("memory")).map(String::from).collect()
        };
        assert_eq!((same(&now), now.stderr.contains("note: ")), (same(&earlier), false));
    }
    let scene = folder.write("scene.toml", &solid);
    let check = |set: &[&str]| {
        let set = set.iter().flat_map(|set| ["--set", set]);
        trackbed(["check", scene.to_str().unwrap()].into_iter().chain(set)).good().stderr
    };
    let line = 1 + solid.lines().position(|line| line.starts_with("alpha")).unwrap();
    let notes = check(&[]);
    assert!(notes.contains(&format!("scene.toml:{line}: solid.dynamics.alpha: found")), "{notes}");
    // Overrides in either name, of a table and then of its key.
    for set in ["solid.dynamics.beta=0.36", "solid.dynamics.alpha=0.36"] {
        assert!(check(&[set]).contains("`delta`"));
        check(&["solid.dynamics={ alpha = 0.4, delta = 0.6 }", set]);
    }
    // The scene overrides an included file, whatever the names.
    let keys = "[solid.dynamics]\nbeta = 0.3025\ngamma = 0.6\n";
    let table = "[solid.dynamics]\nalpha = 0.3025\ndelta = 0.6\n";
    for (own, other) in [(keys, table), (table, keys)] {
        folder.write("common.toml", other);
        folder.write("scene.toml", &format!("include = [\"common.toml\"]\n{}", solid.replace(table, own)));
        assert!(check(&[]).contains("note: "));
    }
    let both = solid.replace("delta", "beta = 0.3\ndelta");
    folder.write("scene.toml", &both);
    let refused = trackbed(["check", scene.to_str().unwrap()]);
    assert_eq!(refused.code, 2);
    assert!(
        refused.stderr.contains("solid.dynamics.alpha: found together with `beta`"),
        "{}",
        refused.stderr
    );
}
