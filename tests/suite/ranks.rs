//! Runs partitioned among ranks (threads with messages): identical files and checkpoints for any number. With
//! MPI: `tests/ranks_check.sh`.

use super::support::{COUPLED, Folder, repository, results, scene_folder, shaft};
use std::path::Path;
use trackbed::failure::Failure;
use trackbed::run::{Interrupt, Options, Outcome, Ranked, Verbosity, follow, run};
use trackbed_dem::ranks::{Lost, local};

fn scene() -> String {
    let library = repository().join("inputs/track/cyclic/stones.toml");
    let walls = shaft(0.3);
    format!(
        r#"title = "marbles and stones"

[[material]]
name = "stone"
density = 2650
stiffness = "0.2 MN/m"
friction = 0.5
restitution = 0.4

[[grains]]
name = "stones"
shape = "clump"
library = "{}"
material = "stone"
count = 40
size = ["40 mm", "50 mm"]
velocity = [0.0, 0.0, -1.0]
fill = {{ low = [0.0, 0.0, 0.06], high = [0.3, 0.3] }}

[[grains]]
name = "marbles"
shape = "sphere"
material = "stone"
count = 1600
size = ["14 mm", "20 mm"]
velocity = [0.0, 0.0, -1.0]
fill = {{ low = [0.0, 0.0, 0.2], high = [0.3, 0.3] }}

{walls}
[[walls]]
kind = "triangles"
material = "stone"
vertices = [[0.0, 0.0, 0.05], [0.3, 0.0, 0.05], [0.3, 0.3, 0.01], [0.0, 0.3, 0.01]]
triangles = [[0, 1, 2], [0, 2, 3]]
velocity = [0.02, 0.0, 0.0]

[time]
end = "60 ms"

[output]
frames = 3
history_interval = "2 ms"
"#,
        library.display()
    )
}

/// Runs on `ranks`; outcomes of the first and the others.
fn shared(scene: &Path, options: Options, ranks: usize) -> (Result<Outcome, Failure>, Vec<Result<(), Lost>>) {
    let mut links = local(ranks);
    let first = links.remove(0);
    std::thread::scope(|scope| {
        let others: Vec<_> = links
            .into_iter()
            .map(|link| scope.spawn(|| follow(scene, &[], Some(1), Box::new(link))))
            .collect();
        let outcome = run(scene, &Options { ranks: Ranked::first(Box::new(first)), ..options });
        (outcome, others.into_iter().map(|other| other.join().unwrap()).collect())
    })
}

fn options(out: &Path) -> Options {
    Options {
        out: Some(out.to_path_buf()),
        threads: Some(1),
        verbosity: Verbosity::Quiet,
        ..Options::default()
    }
}

#[test]
fn ranks_write_identical_files() {
    let folder = Folder::new("ranks");
    let scene = folder.write("scene.toml", &scene());
    let alone = folder.join("alone");
    let Ok(Outcome::Done(summary)) = run(&scene, &options(&alone)) else { panic!("a run alone fails") };
    let (windows, contacts) = (summary.stages[0].windows, summary.model.coordination);
    assert!(windows > 20, "{windows} windows, {contacts:?}");
    let expected = results(&alone);
    let state = std::fs::read(alone.join("end.state")).unwrap();
    let same = |out: &Path, what: &str| {
        let found = results(out);
        assert!(expected.keys().eq(found.keys()), "{what}: {:?}\n{:?}", expected.keys(), found.keys());
        for (name, bytes) in &expected {
            assert!(*bytes == found[name], "{what}: {name} differs");
        }
        assert!(
            std::fs::read(out.join("end.state")).unwrap() == state,
            "{what}: the state at the end differs"
        );
    };
    for ranks in 1..=4 {
        let out = folder.join(&format!("ranks_{ranks}"));
        let (outcome, others) = shared(&scene, options(&out), ranks);
        assert!(matches!(outcome, Ok(Outcome::Done(_))), "{ranks} ranks: {outcome:?}");
        assert!(others.iter().all(Result::is_ok) && others.len() == ranks - 1, "{others:?}");
        same(&out, &format!("{ranks} ranks"));
    }

    let out = folder.join("broken");
    for (k, ranks) in [3, 2, 1].into_iter().enumerate() {
        let interrupt = Interrupt::after(windows / 4 - k as u64);
        let options = Options { interrupt, resume: k > 0, ..options(&out) };
        let (outcome, others) =
            if ranks == 1 { (run(&scene, &options), vec![]) } else { shared(&scene, options, ranks) };
        assert!(matches!(outcome, Err(Failure::Interrupted(_))), "{ranks} ranks: {outcome:?}");
        assert!(others.iter().all(Result::is_ok), "{others:?}");
    }
    let (outcome, _) = shared(&scene, Options { resume: true, ..options(&out) }, 4);
    assert!(matches!(outcome, Ok(Outcome::Done(_))), "{outcome:?}");
    same(&out, "with breaks");
}

#[test]
fn ranks_refuse_by_name() {
    let folder = scene_folder("ranks_solid", COUPLED);
    let (scene, out) = (folder.path().join("scene.toml"), folder.path().join("out"));
    let (outcome, others) = shared(&scene, options(&out), 2);
    let failure = outcome.unwrap_err();
    assert_eq!(failure.to_string(), "2 ranks: not supported with several ranks: solids");
    assert!(failure.code() == 2 && others.iter().all(Result::is_ok), "{others:?}");
    assert!(!out.exists(), "a folder was left");

    let folder = Folder::new("ranks_block");
    let blocks = std::fs::read_to_string(repository().join("inputs/grains/polyhedra.toml")).unwrap();
    let blocks = blocks.replace("\"../", &format!("\"{}/", repository().join("inputs").display()));
    let (outcome, _) = shared(&folder.write("scene.toml", &blocks), options(&out), 2);
    let text = outcome.unwrap_err().to_string();
    assert!(text.starts_with("2 ranks: not supported with several ranks: boxes and polyhedra"), "{text}");
}

#[test]
fn what_is_wrong_is_said_once() {
    let folder = Folder::new("ranks_wrong");
    let scene = folder.write("scene.toml", &scene().replace("friction = 0.5", "friction = -1"));
    let (outcome, others) = shared(&scene, options(&folder.join("out")), 3);
    let failure = outcome.unwrap_err();
    assert!(failure.code() == 2 && failure.to_string().contains("friction"), "{failure}");
    assert!(others.iter().all(Result::is_ok), "{others:?}");
}
