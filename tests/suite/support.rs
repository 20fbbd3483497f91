//! Shared test helpers: directories, program runs, small scenes, result readers.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};
use trackbed_fem::mesh::{Constraint, Mesh};

/// Temporary directory, removed if the test passes.
pub struct Folder(PathBuf);

impl Folder {
    /// Creates a directory with the prefix `name`.
    pub fn new(name: &str) -> Folder {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let path =
            std::env::temp_dir().join(format!("trackbed_suite_{}_{number}_{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    /// Path of the directory.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Path in the directory.
    pub fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Writes a file.
    pub fn write(&self, name: &str, text: &str) -> PathBuf {
        let file = self.join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(&file, text).unwrap();
        file
    }

    /// Replaces `old`, which must occur once.
    pub fn edit(&self, name: &str, old: &str, new: &str) {
        let text = fs::read_to_string(self.join(name)).unwrap();
        assert_eq!(text.matches(old).count(), 1, "{name} should hold exactly one {old:?}:\n{text}");
        fs::write(self.join(name), text.replace(old, new)).unwrap();
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let _ = fs::remove_dir_all(&self.0);
        }
    }
}

/// Exit code and output.
#[derive(Debug)]
pub struct Outcome {
    /// Exit code; -1 after a signal.
    pub code: i32,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Outcome {
    /// Requires exit code 0.
    #[track_caller]
    pub fn good(self) -> Outcome {
        assert_eq!(self.code, 0, "stdout: {}\nstderr: {}", self.stdout, self.stderr);
        self
    }
}

/// Threads of programs run without `--threads`.
pub const ONE_THREAD: (&str, &str) = ("RAYON_NUM_THREADS", "1");

/// Runs the program in `dir`.
pub fn trackbed_in<A: AsRef<std::ffi::OsStr>>(dir: &Path, arguments: impl IntoIterator<Item = A>) -> Outcome {
    let output = Command::new(env!("CARGO_BIN_EXE_trackbed"))
        .args(arguments)
        .env(ONE_THREAD.0, ONE_THREAD.1)
        .current_dir(dir)
        .output()
        .unwrap();
    Outcome {
        code: output.status.code().unwrap_or(-1),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Runs the program.
pub fn trackbed<A: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = A>) -> Outcome {
    trackbed_in(&std::env::temp_dir(), arguments)
}

/// Runs a scene into `out` with overrides, `--force` and `--quiet`.
pub fn run(scene: &Path, out: &Path, set: &[&str]) -> Outcome {
    let mut arguments: Vec<String> =
        ["run", &scene.display().to_string(), "--out", &out.display().to_string(), "--quiet", "--force"]
            .map(String::from)
            .into();
    for assignment in set {
        arguments.extend(["--set".to_string(), assignment.to_string()]);
    }
    trackbed(arguments)
}

/// Repository root.
pub fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Contents of all files below `dir`.
pub fn snapshot(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    fn visit(root: &Path, dir: &Path, files: &mut BTreeMap<String, Vec<u8>>) {
        for entry in fs::read_dir(dir).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                visit(root, &path, files);
            } else {
                files
                    .insert(path.strip_prefix(root).unwrap().display().to_string(), fs::read(&path).unwrap());
            }
        }
    }
    let mut files = BTreeMap::new();
    visit(dir, dir, &mut files);
    files
}

/// Contents of all results without wall time, memory and thread count.
pub fn results(out: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = snapshot(out);
    let log = String::from_utf8(files.remove("log.txt").expect("a log")).unwrap();
    let mut summary: serde_json::Value =
        serde_json::from_slice(&files.remove("summary.json").unwrap()).unwrap();
    summary["threads"].take();
    summary["peak_memory"].take();
    summary["cpu_seconds"].take();
    summary["model"]["predicted_memory"].take();
    for seconds in ["assembly_seconds", "factor_seconds", "solve_seconds"] {
        if let Some(newton) = summary.get_mut("newton") {
            newton[seconds].take();
        }
    }
    let mut stages = Vec::new();
    for stage in summary["stages"].as_array_mut().unwrap() {
        stage["seconds"].take();
        stages.push(format!("{}: ", stage["name"].as_str().unwrap()));
    }
    let log: String = log
        .lines()
        .map(|line| match stages.iter().find(|s| line.starts_with(*s)) {
            Some(stage) => format!("{stage}{}\n", line.split_once(" s, ").unwrap().1),
            None => format!("{}\n", line.split("; time: assembly").next().unwrap()),
        })
        .collect();
    files.insert("summary.json".into(), summary.to_string().into_bytes());
    files.insert("log.txt".into(), log.into_bytes());
    files
}

/// Reads JSON.
pub fn json(file: &Path) -> serde_json::Value {
    let text = fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    serde_json::from_str(&text).unwrap()
}

/// Numbers of a JSON array.
pub fn numbers(value: &serde_json::Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

/// Numeric CSV file, headers without units.
pub struct Table {
    /// Headers.
    pub heads: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads a file; requires full rows of finite numbers.
    pub fn read(file: &Path) -> Table {
        let text = fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
        let mut lines = text.lines();
        let header = lines.next().unwrap();
        super::columns::expect_defined(file, header);
        let heads: Vec<String> =
            header.split(',').map(|h| h.split(" [").next().unwrap().to_string()).collect();
        let rows: Vec<Vec<f64>> = lines
            .map(|line| {
                let row: Vec<f64> =
                    line.split(',').map(|v| v.parse().unwrap_or_else(|_| panic!("{line}"))).collect();
                assert!(
                    row.len() == heads.len() && row.iter().all(|v| v.is_finite()),
                    "{}: {line}",
                    file.display()
                );
                row
            })
            .collect();
        Table { heads, rows }
    }

    /// Index of a column.
    #[track_caller]
    pub fn index(&self, name: &str) -> usize {
        self.heads
            .iter()
            .position(|h| h == name)
            .unwrap_or_else(|| panic!("no column {name} in {:?}", self.heads))
    }

    /// Values of a column.
    #[track_caller]
    pub fn column(&self, name: &str) -> Vec<f64> {
        let index = self.index(name);
        self.rows.iter().map(|row| row[index]).collect()
    }
}

/// Block of 2 × 2 × 2 elements, 2 m × 2 m × 1 m, top at z = 0.
pub fn small_block() -> Mesh {
    let mut mesh = Mesh::block([2, 2, 2], [2.0, 2.0, 1.0]);
    for point in &mut mesh.coordinates {
        point[2] -= 1.0;
    }
    mesh
}

/// Writes `mesh` as lists with a fixed base.
pub fn write_lists(mesh: &Mesh, dir: &Path) {
    let bottom = mesh.coordinates.iter().map(|x| x[2]).fold(f64::INFINITY, f64::min);
    let constraints: Vec<Constraint> = (0..mesh.node_count() as u32)
        .filter(|&n| mesh.coordinates[n as usize][2] == bottom)
        .flat_map(|node| (0..3).map(move |direction| Constraint { node, direction, value: 0.0 }))
        .collect();
    trackbed::write::ansys_lists::write_lists(mesh, &constraints, dir).unwrap();
}

/// Small block under static pressure.
pub const SOLID: &str = r#"title = "block"

[solid]
nodes = "NODECOORD.DAT"
elements = "ELEMENTNUM.DAT"
constraints = "DOF.DAT"

[[solid.material]]
id = 1
name = "soil"
young = "20 MPa"
poisson = 0.3
density = "2000 kg/m3"

[[solid.load]]
kind = "pressure"
pressure = "10 kPa"
faces = [[5, 6], [6, 6], [7, 6], [8, 6]]

[[probe]]
node = 1

[output]
tables = true
"#;

/// Plastic block between rough platens.
pub const PLASTIC: &str = r#"title = "pressed block"

[solid]
gravity = false

[solid.block]
x = { lines = [0.0, 1.0], counts = [2] }
y = { lines = [0.0, 1.0], counts = [1] }
z = { lines = [0.0, 0.4, 1.0], counts = [1, 1] }
layer = [{ material = 1, top = 0.4 }, { material = 2 }]

[[solid.material]]
id = 1
name = "base"
young = "50 MPa"
poisson = 0.3
density = 2000

[[solid.material]]
id = 2
name = "soil"
model = "mohr_coulomb"
young = "20 MPa"
poisson = 0.3
density = 1900
cohesion = "20 kPa"
friction = "25 deg"
dilation = "5 deg"

[[solid.support]]
name = "base"
side = "z-"
directions = ["x", "y", "z"]

[[solid.support]]
name = "plate"
side = "z+"
directions = ["z"]
displacement = "-10 mm"
history = { kind = "ramp", duration = 1.0 }

[solid.quasi_static]

[time]
end = 1.0
solid_step = 0.1

[output]
frames = 2
"#;

/// Two spheres above a plane.
pub const GRAINS: &str = r#"title = "two spheres"

[[material]]
name = "stone"
density = 2650
stiffness = "1 MN/m"
friction = 0.5
restitution = 0.4

[[grains]]
name = "pair"
shape = "sphere"
material = "stone"
spheres = [[0.0, 0.0, 0.051, 0.05], [0.01, 0.0, 0.152, 0.05]]

[[walls]]
kind = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
material = "stone"

[time]
end = "20 ms"

[output]
frames = 2
"#;

/// Five spheres and a cyclically loaded sleeper on the small block.
pub const COUPLED: &str = r#"title = "spheres on a block"

[solid]
nodes = "NODECOORD.DAT"
elements = "ELEMENTNUM.DAT"
constraints = "DOF.DAT"
rayleigh = { damping_ratio = 0.05, frequencies = [10, 100] }

[[solid.material]]
id = 1
young = "20 MPa"
poisson = 0.3
density = 2000

[[material]]
name = "stone"
density = 2650
stiffness = "1 MN/m"
friction = 0.5
restitution = 0.4

[[grains]]
name = "bed"
shape = "sphere"
material = "stone"
spheres = [
    [0.7, 0.7, 0.1, 0.1], [1.3, 0.7, 0.1, 0.1], [0.7, 1.3, 0.1, 0.1], [1.3, 1.3, 0.1, 0.1], [1.0, 1.0, 0.1, 0.1],
]

[track.sleeper]
size = [1.0, 1.0, 0.2]
mass = 400
material = "stone"
centre = [1.0, 1.0]

[track.load]
kind = "haversine"
minimum = "1 kN"
maximum = "5 kN"
frequency = 50
cycles = 2
rest = "20 ms"
ramp = "20 ms"

[coupling]
substeps = 10
material = "stone"

[[probe]]
name = "middle"
at = [1.0, 1.0, 0.0]

[output]
frames = 2
tecplot = true
"#;

/// Planes around a square shaft of `width` [m].
pub fn shaft(width: f64) -> String {
    let plane = |point: [f64; 3], normal: [f64; 3]| {
        format!("[[walls]]\nkind = \"plane\"\npoint = {point:?}\nnormal = {normal:?}\nmaterial = \"stone\"\n")
    };
    [
        plane([0.0; 3], [0.0, 0.0, 1.0]),
        plane([0.0; 3], [1.0, 0.0, 0.0]),
        plane([width, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        plane([0.0; 3], [0.0, 1.0, 0.0]),
        plane([0.0, width, 0.0], [0.0, -1.0, 0.0]),
    ]
    .concat()
}

/// Compiles a routine of a user material in C; the library lives as long as the system keeps its temporary files.
pub fn compile(source: &Path) -> PathBuf {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let name = format!("trackbed-law-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
    let library = std::env::temp_dir().join(format!("{name}.so"));
    let options = ["-O2", "-ffp-contract=off", "-shared", "-fPIC", "-o"];
    let mut command = Command::new("cc");
    let done =
        command.args(options).arg(&library).arg(source).arg("-lm").output().expect("a C compiler (cc)");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    library
}

/// Directory with the small block's lists and `text` as `scene.toml`.
pub fn scene_folder(name: &str, text: &str) -> Folder {
    let folder = Folder::new(name);
    write_lists(&small_block(), folder.path());
    folder.write("scene.toml", text);
    folder
}
