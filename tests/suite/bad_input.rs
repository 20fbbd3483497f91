//! Bad input: exit code 2, one line with file, line, key, found and expected; nothing is written.
//!
//! Each test breaks one thing of a valid scene and runs it into a new and into a used directory. `check`
//! prints the same line, except for errors found only by a solution or a deposition.

use super::support::{COUPLED, Folder, GRAINS, PLASTIC, SOLID, run, scene_folder, snapshot, trackbed};
use std::fs;

mod bonds;
mod flow;
mod grains;
mod lists;
mod materials;
mod scene;
mod solid;
mod track;
mod types;
mod walls;

const SCENE: &str = "scene.toml";
const NODES: &str = "NODECOORD.DAT";
const ELEMENTS: &str = "ELEMENTNUM.DAT";
const DOF: &str = "DOF.DAT";

const SPHERES: &str = "spheres = [[0.0, 0.0, 0.051, 0.05], [0.01, 0.0, 0.152, 0.05]]";
const FILL: &str = "fill = { low = [0, 0, 0], high = [0.3, 0.3] }";
const FACES: &str = "faces = [[5, 6], [6, 6], [7, 6], [8, 6]]";

/// Valid scene with earlier results in `earlier`.
struct Good {
    folder: Folder,
    earlier: std::collections::BTreeMap<String, Vec<u8>>,
    set: Vec<&'static str>,
    check_sees_it: bool,
}

impl Good {
    fn new(text: &str) -> Good {
        let folder = scene_folder("bad_input", text);
        run(&folder.join(SCENE), &folder.join("earlier"), &[]).good();
        let earlier = snapshot(&folder.join("earlier"));
        assert!(earlier.contains_key("summary.json"));
        Good { folder, earlier, set: Vec::new(), check_sees_it: true }
    }

    /// Replaces unique text of the scene.
    fn scene(self, old: &str, new: &str) -> Good {
        self.folder.edit(SCENE, old, new);
        self
    }

    fn file(self, name: &str, text: &str) -> Good {
        self.folder.write(name, text);
        self
    }

    fn append(self, name: &str, line: &str) -> Good {
        let text = fs::read_to_string(self.folder.join(name)).unwrap();
        self.file(name, &format!("{text}{line}\n"))
    }

    fn line(self, name: &str, number: usize, change: impl Fn(&mut Vec<String>)) -> Good {
        let text = fs::read_to_string(self.folder.join(name)).unwrap();
        let mut lines: Vec<String> = text.lines().map(String::from).collect();
        let mut fields = lines[number - 1].split_whitespace().map(String::from).collect();
        change(&mut fields);
        lines[number - 1] = fields.join(" ");
        self.file(name, &(lines.join("\n") + "\n"))
    }

    fn field(self, name: &str, number: usize, column: usize, value: &str) -> Good {
        self.line(name, number, |fields| fields[column] = value.into())
    }

    fn without(self, name: &str) -> Good {
        fs::remove_file(self.folder.join(name)).unwrap();
        self
    }

    fn set(mut self, assignment: &'static str) -> Good {
        self.set.push(assignment);
        self
    }

    /// `check` does not find this error.
    fn only_run_sees_it(mut self) -> Good {
        self.check_sees_it = false;
        self
    }

    /// Requires this line; paths relative to the directory.
    #[track_caller]
    fn refused(self, line: &str) {
        let scene = self.folder.join(SCENE);
        let said = |text: &str| text.replace(&format!("{}/", self.folder.path().display()), "");
        let expected = format!("error: {line}\n");
        for out in ["fresh", "earlier"] {
            let outcome = run(&scene, &self.folder.join(out), &self.set);
            assert_eq!((outcome.code, said(&outcome.stderr).as_str()), (2, expected.as_str()));
            assert_eq!(outcome.stdout, "");
        }
        assert!(!self.folder.join("fresh").exists(), "a refused run leaves nothing");
        assert!(
            snapshot(&self.folder.join("earlier")) == self.earlier,
            "results of the earlier run have changed"
        );
        if self.check_sees_it {
            let mut arguments = vec!["check".to_string(), scene.display().to_string()];
            self.set.iter().for_each(|s| arguments.extend(["--set".to_string(), s.to_string()]));
            let outcome = trackbed(arguments);
            assert_eq!((outcome.code, said(&outcome.stderr).as_str()), (2, expected.as_str()), "by `check`");
        }
        let value = line.contains("found ") && line.contains(", expected ");
        assert!(value || line.contains(": found, but it has no effect without "), "{line}");
    }
}

fn solid() -> Good {
    Good::new(SOLID)
}

fn plastic() -> Good {
    Good::new(PLASTIC)
}

fn grains_scene() -> Good {
    Good::new(GRAINS)
}

fn coupled() -> Good {
    Good::new(COUPLED)
}
