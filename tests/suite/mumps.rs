//! `[solid.equations] method = "mumps"`: missing library, keys, comparison with the built-in direct solver.

use super::support::{repository, trackbed};

const SCENE: &str = "inputs/solid/large.toml";

fn checked(equations: &str) -> (i32, String) {
    let scene = repository().join(SCENE);
    let mut arguments: Vec<String> = ["check", &scene.display().to_string()].map(String::from).into();
    let small = ["x.counts=[4]", "y.counts=[3]", "z.counts=[2, 2]"].map(|s| format!("solid.block.{s}"));
    for set in small.into_iter().chain([format!("solid.equations={equations}")]) {
        arguments.extend(["--set".to_string(), set]);
    }
    let outcome = trackbed(arguments);
    (outcome.code, if outcome.code == 0 { outcome.stdout } else { outcome.stderr })
}

#[test]
fn keys_of_it_need_it() {
    for (equations, key, expected) in [
        (
            "{ method = \"direct\", out_of_core = true }",
            "out_of_core",
            "found, but it has no effect without `method = \"mumps\"`",
        ),
        (
            "{ method = \"iterative\", out_of_core = false }",
            "out_of_core",
            "found, but it has no effect without `method = \"mumps\"`",
        ),
        (
            "{ method = \"mumps\", tolerance = 1e-9 }",
            "tolerance",
            "found together with `method = \"mumps\"`, expected only one of them",
        ),
    ] {
        let (code, text) = checked(equations);
        let expected = format!("solid.equations.{key}: {expected}\n");
        assert!(code == 2 && text.ends_with(&expected), "{text}");
    }
}

#[cfg(not(feature = "mumps"))]
#[test]
fn missing_library_gives_build_advice() {
    use super::support::Folder;
    let folder = Folder::new("mumps");
    let text = std::fs::read_to_string(repository().join(SCENE)).unwrap();
    let changed = text.replace("method = \"auto\" ", "method = \"mumps\"").replace("tolerance = 1e-8", "");
    let line = 1 + changed.lines().position(|l| l.starts_with("method = \"mumps\"")).unwrap();
    let scene = folder.write("scene.toml", &changed);
    for command in ["check", "run"] {
        let outcome = trackbed([command, &scene.display().to_string()]);
        let expected = format!(
            "scene.toml:{line}: solid.equations.method: found \"mumps\", which this program was built without, expected \"auto\", \
             \"direct\" or \"iterative\"; `cargo build --release --features mumps` builds a program that has it\n"
        );
        assert!(outcome.code == 2 && outcome.stderr.ends_with(&expected), "{}", outcome.stderr);
    }
}

#[cfg(feature = "mumps")]
mod library {
    use super::checked;
    use crate::suite::support::{Folder, Table, repository, run};

    fn tables(scene: &str, set: &[&str], file: &str, methods: &[&str]) -> Vec<Table> {
        let folder = Folder::new("mumps");
        let out = folder.join("out");
        let by = |method: &&str| {
            let equations = format!("solid.equations={method}");
            let set: Vec<&str> = set.iter().copied().chain([equations.as_str()]).collect();
            run(&repository().join(scene), &out, &set).good();
            Table::read(&out.join(file))
        };
        methods.iter().map(by).collect()
    }

    fn miss(a: &Table, b: &Table, column: &str) -> f64 {
        let (a, b) = (a.column(column), b.column(column));
        let size = a.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        assert!(size > 0.0 && a.len() == b.len());
        a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
    }

    const DIRECT: &str = "{ method = \"direct\" }";
    const MUMPS: &str = "{ method = \"mumps\" }";
    const IN_FILES: &str = "{ method = \"mumps\", out_of_core = true }";

    #[test]
    fn embankment_matches_built_in_solver() {
        let methods = [DIRECT, MUMPS, IN_FILES];
        let found = tables("inputs/solid/embankment.toml", &[], "nodes.csv", &methods);
        for (other, method) in found[1..].iter().zip(&methods[1..]) {
            let miss = miss(&found[0], other, "uz");
            println!("{method}: differs by {miss:.1e}");
            assert!(miss < 1e-9, "{miss:e}");
        }
    }

    #[test]
    fn pulse_matches_built_in_solver() {
        let set = [
            "solid.block.x.counts=[20]",
            "solid.block.y.counts=[12]",
            "solid.block.z.counts=[3, 3]",
            "time.end=0.02",
            "output.frames=2",
        ];
        let methods = [DIRECT, MUMPS, IN_FILES];
        let found = tables("inputs/solid/large.toml", &set, "history.csv", &methods);
        for (other, method) in found[1..].iter().zip(&methods[1..]) {
            let miss = miss(&found[0], other, "crest_u_z");
            println!("{method}: differs by {miss:.1e}");
            assert!(miss < 1e-9, "{miss:e}");
        }
    }

    #[test]
    fn settlement_matches_built_in_solver() {
        let set = [
            "track.sleeper.mesh=",
            "grains.0.count=100",
            "deposition.max_time=0.2",
            "compaction=",
            "track.load.cycles=1",
            "track.load.frequency=\"50 Hz\"",
            "track.load.rest=0.02",
            "track.load.ramp=0.02",
            "output.frames=2",
        ];
        let found = tables("inputs/track/meshed_sleeper/scene.toml", &set, "cycles.csv", &[DIRECT, MUMPS]);
        let miss = miss(&found[0], &found[1], "settlement");
        println!("settlements differ by {miss:.1e}");
        assert!(miss < 1e-6, "{miss:e}");
    }

    #[test]
    fn check_says_what_it_takes() {
        let (code, text) = checked("{ method = \"mumps\", out_of_core = true }");
        assert!(code == 0 && text.contains("MUMPS in files (set in the scene), "), "{text}");
        let (code, text) = checked("{ method = \"mumps\" }");
        assert!(code == 0 && text.contains("MUMPS (set in the scene), "), "{text}");
    }
}
