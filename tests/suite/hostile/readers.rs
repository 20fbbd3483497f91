//! Random changes to files of every format, shared with the targets of `fuzz/`.

use super::super::support::{COUPLED, Folder, PLASTIC, repository, run, small_block};
use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use trackbed::read::{MeshFile, read_mesh_file, read_surface};
use trackbed::write::{MeshOptions, hdf5, write_mesh_file};
use trackbed_fem::mesh::Constraint;

/// Limit for files up to 1 MB.
const TIME: Duration = Duration::from_secs(1);
/// Limit of additional memory for all readers [bytes].
const MEMORY: u64 = 400 << 20;

const NUMBERS: [&str; 14] = [
    "0",
    "-1",
    "1",
    "7",
    "4294967295",
    "4294967296",
    "99999999999999999999",
    "1e300",
    "-1e300",
    "1e-320",
    "nan",
    "inf",
    "1,5",
    "",
];

#[path = "../../../fuzz/targets.rs"]
mod targets;

struct Chance(u64);

impl Chance {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n.max(1) as u64) as usize
    }
}

fn change(bytes: &mut Vec<u8>, chance: &mut Chance) {
    let at = chance.below(bytes.len());
    let to = (at + 1 + chance.below(40)).min(bytes.len());
    match chance.below(9) {
        0 => bytes.truncate(at),
        1 => bytes.iter_mut().skip(at).take(1).for_each(|b| *b ^= 1 << chance.below(8)),
        2 => bytes.iter_mut().skip(at).take(1).for_each(|b| *b = chance.below(256) as u8),
        3 => drop(bytes.drain(at..to)),
        4 => {
            let piece = bytes[at..to].to_vec();
            let place = chance.below(bytes.len());
            bytes.splice(place..place, piece);
        }
        5 | 6 => number(bytes, at, NUMBERS[chance.below(NUMBERS.len())]),
        _ => lines(bytes, chance),
    }
}

fn number(bytes: &mut Vec<u8>, at: usize, by: &str) {
    let is_part = |b: &u8| b.is_ascii_digit() || matches!(b, b'.' | b'-' | b'+' | b'e' | b'E');
    let Some(first) = bytes[at..].iter().position(u8::is_ascii_digit).map(|n| at + n) else { return };
    let end = bytes[first..].iter().position(|b| !is_part(b)).map_or(bytes.len(), |n| first + n);
    bytes.splice(first..end, by.bytes());
}

fn lines(bytes: &mut Vec<u8>, chance: &mut Chance) {
    let mut all: Vec<Vec<u8>> = bytes.split(|b| *b == b'\n').map(<[u8]>::to_vec).collect();
    let (a, b) = (chance.below(all.len()), chance.below(all.len()));
    match chance.below(3) {
        0 => drop(all.remove(a)),
        1 => all.insert(b, all[a].clone()),
        _ => all.swap(a, b),
    }
    *bytes = all.join(&b'\n');
}

fn mesh() -> MeshFile {
    let mesh = small_block();
    let constraints = (0..9).map(|node| Constraint { node, direction: 2, value: 0.0 }).collect();
    MeshFile {
        node_sets: BTreeMap::from([("BASE".to_string(), (0..9).collect())]),
        element_sets: BTreeMap::from([("ALL".to_string(), (0..8).collect())]),
        mesh,
        constraints,
        ..MeshFile::default()
    }
}

const TRIANGLE: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";

fn good(folder: &Folder) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for (name, msh2) in [
        ("a.cdb", false),
        ("two.msh", true),
        ("four.msh", false),
        ("a.inp", false),
        ("a.vtu", false),
        ("a.vtk", false),
        ("lists", false),
    ] {
        write_mesh_file(&folder.join(name), &mesh(), MeshOptions { msh2 }).unwrap();
        files.push(folder.join(name));
    }
    let lists = files.pop().unwrap();
    files.extend(["NODECOORD.DAT", "ELEMENTNUM.DAT", "DOF.DAT"].map(|name| lists.join(name)));
    files.push(folder.write("a.stl", TRIANGLE));
    files.push(
        folder
            .write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1/1/1 2//2 4/4\nf -1 -2 -3 -4\n"),
    );
    files.push(folder.write("a.tri", "4 2\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 2 3\n1 2 4\n"));
    let mut binary = vec![0_u8; 80];
    binary.extend(2_u32.to_le_bytes());
    binary.extend([7_u8; 100]);
    fs::write(folder.join("b.stl"), binary).unwrap();
    files.push(folder.join("b.stl"));
    files
}

fn read(file: &Path) {
    let ending = file.extension().unwrap().to_str().unwrap();
    match ending {
        "stl" | "obj" | "tri" => drop(read_surface(file)),
        "DAT" => drop(read_mesh_file(file.parent().unwrap())),
        _ => drop(read_mesh_file(file)),
    }
}

/// Records a panic or timeout of `target` with the saved file.
fn judged(name: &str, bytes: &[u8], target: impl Fn(), faults: &mut Vec<String>) {
    let timed = || {
        let begun = Instant::now();
        let panicked = catch_unwind(AssertUnwindSafe(&target)).is_err();
        (panicked, begun.elapsed())
    };
    let (panicked, mut took) = timed();
    // Other processes may have delayed the first try.
    if !panicked && took > TIME {
        took = took.min(timed().1);
    }
    if panicked || took > TIME {
        let kept = std::env::temp_dir().join(format!("trackbed_fault_{}_{name}", faults.len()));
        fs::write(&kept, bytes).unwrap();
        faults.push(format!(
            "{}: {}",
            kept.display(),
            if panicked { "panic".into() } else { format!("{took:?}") }
        ));
    }
}

fn changed_files(count: usize, seed: u64) {
    let folder = Folder::new("changed_files");
    let files = good(&folder);
    files.iter().for_each(|file| read(file));
    let before = trackbed::run::peak_memory().unwrap_or(0);
    let (mut chance, mut faults) = (Chance(seed), Vec::new());
    for file in &files {
        let whole = fs::read(file).unwrap();
        for _ in 0..count {
            let mut bytes = whole.clone();
            (0..=chance.below(4)).for_each(|_| change(&mut bytes, &mut chance));
            fs::write(file, &bytes).unwrap();
            let name = file.file_name().unwrap().to_str().unwrap();
            judged(name, &bytes, || read(file), &mut faults);
        }
        fs::write(file, whole).unwrap();
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
    let took = trackbed::run::peak_memory().unwrap_or(0) - before;
    assert!(took < MEMORY, "{took} bytes for small files");
}

#[test]
fn changed_meshes_and_surfaces_are_handled() {
    changed_files(150, 3);
}

fn changed_texts(count: usize, seed: u64) {
    let (mut chance, mut faults) = (Chance(seed), Vec::new());
    for whole in [PLASTIC, COUPLED] {
        for _ in 0..count {
            let mut bytes = whole.as_bytes().to_vec();
            (0..=chance.below(3)).for_each(|_| change(&mut bytes, &mut chance));
            let mut set = b"solid.material.0.young=[1, \"2 MPa\", { a = 1 }]".to_vec();
            change(&mut set, &mut chance);
            bytes.push(b'\n');
            bytes.extend(set);
            judged("scene.toml", &bytes, || targets::scene(&bytes), &mut faults);
        }
    }
    for open in ["[", "{ a = ", "[[a.", "a."] {
        let deep = format!("a = {}", open.repeat(50_000));
        judged("deep.toml", deep.as_bytes(), || targets::scene(deep.as_bytes()), &mut faults);
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn changed_scenes_and_overrides_are_handled() {
    changed_texts(300, 4);
}

/// Frames, a VTKHDF file, a checkpoint and a study, by fuzz target.
fn good_results(folder: &Folder) -> Vec<(&'static str, Vec<u8>)> {
    let made = |name: &str, scene: &str, set: &[&str]| {
        let out = folder.join(name);
        run(&repository().join("inputs").join(scene), &out, set).good();
        out
    };
    let set = ["grains.0.count=40", "time.end=0.05", "output.frames=1", "output.chains=\"all\""];
    let grains = made("grains", "grains/box.toml", &set);
    let solid = made("solid", "solid/cylinder/scene.toml", &["output.frames=1"]);
    let mut found = Vec::new();
    let frames = |dir: &Path, part: &str| {
        let entries = fs::read_dir(dir.join("frames")).unwrap().map(|e| e.unwrap().path());
        let mut files: Vec<PathBuf> =
            entries.filter(|f| f.file_name().unwrap().to_str().unwrap().starts_with(part)).collect();
        files.sort();
        fs::read(files.last().unwrap_or_else(|| panic!("no {part}"))).unwrap()
    };
    let parts = [(0, &grains, "grains"), (1, &grains, "chains"), (2, &grains, "walls"), (3, &solid, "solid")];
    for (number, dir, part) in parts {
        found.push(("frame", [&[number], frames(dir, part).as_slice()].concat()));
    }
    found.push(("checkpoint", fs::read(grains.join("end.state")).unwrap()));
    let study = fs::read_to_string(repository().join("inputs/studies/box_trade.toml")).unwrap();
    let study = study.replace("scene = \"../", &format!("scene = \"{}/inputs/", repository().display()));
    found.push(("study", study.into_bytes()));
    let file = folder.join("results.vtkhdf");
    let mut hdf = hdf5::File::create(&file).unwrap();
    hdf.commit().unwrap();
    let mark = hdf.mark();
    found.push(("vtkhdf", [&[mark.len() as u8], mark.as_slice(), &fs::read(&file).unwrap()].concat()));
    found
}

fn changed_results(count: usize, time: Duration, seed: u64) {
    let folder = Folder::new("changed_results");
    let (mut chance, mut faults) = (Chance(seed), Vec::new());
    let only = std::env::var("TRACKBED_TARGET").ok();
    let mut results = good_results(&folder);
    results.retain(|(name, _)| only.as_ref().is_none_or(|only| only == name));
    for (name, whole) in results {
        let target = targets::named(name);
        judged(name, &whole, || target(&whole), &mut faults);
        let (begun, mut done) = (Instant::now(), 0);
        while done < count || begun.elapsed() < time {
            let mut bytes = whole.clone();
            (0..=chance.below(4)).for_each(|_| change(&mut bytes, &mut chance));
            judged(name, &bytes, || target(&bytes), &mut faults);
            done += 1;
        }
        println!("{name}: {done} changed files of {} bytes", whole.len());
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn changed_results_are_read_or_refused() {
    changed_results(40, Duration::ZERO, 5);
}

/// `TRACKBED_SECONDS` per target, `TRACKBED_SEED`, `TRACKBED_TARGET` for one of them.
#[test]
#[ignore = "2 min for each of seven files"]
fn many_changed_results() {
    let number = |name: &str, default| std::env::var(name).map_or(default, |v| v.parse().unwrap());
    changed_results(1, Duration::from_secs(number("TRACKBED_SECONDS", 120)), number("TRACKBED_SEED", 12));
}

#[test]
#[ignore = "half a million changes, 10 min"]
fn many_changed_files() {
    let seed = std::env::var("TRACKBED_SEED").map_or(11, |v| v.parse().unwrap());
    changed_files(30_000, seed);
    changed_texts(30_000, seed);
}

/// Former failures, and one input of every format.
#[test]
fn fuzz_corpus_is_handled() {
    let mut count = 0;
    let mut faults = Vec::new();
    for target in fs::read_dir(repository().join("fuzz/corpus")).unwrap() {
        let target = target.unwrap().path();
        for file in fs::read_dir(&target).unwrap() {
            let file = file.unwrap().path();
            let bytes = fs::read(&file).unwrap();
            let name = file.file_name().unwrap().to_str().unwrap();
            let call = targets::named(target.file_name().unwrap().to_str().unwrap());
            judged(name, &bytes, || call(&bytes), &mut faults);
            count += 1;
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(count >= 8, "{count} inputs");
}
