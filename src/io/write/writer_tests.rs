use super::*;
use crate::write::sample::{self, folder};
use crate::write::{ChainFrame, FORMATS, WallFrame};
use std::collections::BTreeSet;
use std::path::PathBuf;

fn with_frame(number: usize, act: impl FnOnce(&Frame<'_>)) {
    let mesh = sample::block([1, 1, 1]);
    let n = mesh.node_count();
    let (vector, stress, scalar) = (vec![0.5; 3 * n], vec![[1.0; 6]; n], vec![number as f64; n]);
    let solid = sample::solid(&mesh, &vector, &stress, &scalar);
    let grains = sample::grains(1, |_| [0.0; 3]);
    let chains = ChainFrame {
        ends: vec![[[0.0; 3], [1.0; 3]]],
        normal_force: vec![1.0],
        tangential_force: vec![0.0],
        kind: vec![0],
        strong: vec![1],
        partners: vec![[0, 1]; 1],
    };
    let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let walls =
        WallFrame { points, polygons: vec![vec![0, 1, 2]], id: vec![0], kind: vec![0], grains: Vec::new() };
    act(&Frame {
        number,
        time: 0.1 * number as f64,
        solid: Some(&solid),
        grains: Some(&grains),
        chains: Some(&chains),
        walls: Some(&walls),
        ..Frame::default()
    });
}

fn files(dir: &Path) -> BTreeSet<(PathBuf, Vec<u8>)> {
    let mut out = BTreeSet::new();
    for entry in std::fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            out.extend(files(&path));
        } else {
            out.insert((path.clone(), std::fs::read(&path).unwrap()));
        }
    }
    out
}

fn fresh(name: &str, format: &Format) -> PathBuf {
    let dir = folder(&format!("{name}_{}", format.key));
    std::fs::create_dir_all(dir.join(format.folder)).unwrap();
    dir
}

#[test]
fn later_run_clears_all_files() {
    let keys: BTreeSet<&str> = FORMATS.iter().map(|format| format.key).collect();
    assert_eq!(keys.len(), FORMATS.len(), "two formats have the same key");
    for format in FORMATS {
        let dir = fresh("formats", format);
        let mut writers = Writers::begin(&dir, &[format]).unwrap();
        (0..2).for_each(|number| with_frame(number, |frame| writers.frame(frame).unwrap()));
        writers.end().unwrap();
        let left = files(&dir);
        assert!(!left.is_empty(), "{} writes nothing", format.key);
        for (file, _) in left {
            let within = file.strip_prefix(&dir).unwrap();
            let frame = within.parent() == Some(Path::new(format.folder)) && format.is_frame(&file);
            let named = format.files.iter().any(|name| Path::new(name) == within);
            assert!(frame || named, "{}: {} is never cleared", format.key, within.display());
        }
        std::fs::remove_dir_all(&dir).unwrap();
    }
}

#[test]
fn resumed_format_is_identical() {
    for format in FORMATS {
        let dir = fresh("resumed", format);
        let mut writers = Writers::begin(&dir, &[format]).unwrap();
        (0..2).for_each(|number| with_frame(number, |frame| writers.frame(frame).unwrap()));
        let marks = writers.marks();
        (2..4).for_each(|number| with_frame(number, |frame| writers.frame(frame).unwrap()));
        writers.end().unwrap();
        let whole = files(&dir);
        let mut writers = Writers::resume(&dir, &[format], &marks).unwrap();
        (2..4).for_each(|number| with_frame(number, |frame| writers.frame(frame).unwrap()));
        writers.end().unwrap();
        assert!(files(&dir) == whole, "{}: other bytes after the break", format.key);
        std::fs::remove_dir_all(&dir).unwrap();
    }
}
