use super::*;
use crate::write::sample::folder;

fn grown(path: &Path, rows: u32) -> (File, Vec<Vec<u8>>) {
    let mut file = File::create(path).unwrap();
    let group = file.group(0, "data");
    file.set(group, "Type", Attribute::Text("rows".into()));
    let mut marks = Vec::new();
    for from in (0..rows).step_by(700) {
        add(&mut file, from..(from + 700).min(rows));
        file.commit().unwrap();
        marks.push(file.mark());
    }
    (file, marks)
}

fn add(file: &mut File, rows: std::ops::Range<u32>) {
    let group = file.group(0, "data");
    let dataset = file.dataset(group, "vectors", Kind::F64, Some(3));
    let bytes: Vec<u8> =
        rows.flat_map(|i| [0.0, 0.5, 1.0].map(|d| f64::from(i) + d)).flat_map(f64::to_le_bytes).collect();
    file.append(dataset, &bytes).unwrap();
}

#[test]
fn every_commit_leaves_valid_file() {
    let dir = folder("hdf5_commit");
    let path = dir.join("a.h5");
    let mut file = File::create(&path).unwrap();
    add(&mut file, 0..10);
    assert!(!path.exists());
    file.commit().unwrap();
    let committed = fs::read(&path).unwrap();
    assert_eq!(fs::read_dir(&dir).unwrap().count(), 1, "no part is left");
    add(&mut file, 10..5000);
    let longer = fs::read(&path).unwrap();
    assert!(longer.len() > committed.len() && longer[..committed.len()] == committed);
    file.commit().unwrap();
    let later = fs::read(&path).unwrap();
    assert!(later[SUPERBLOCK..committed.len()] == committed[SUPERBLOCK..]);
    assert!(later[..SUPERBLOCK] != committed[..SUPERBLOCK]);
    fs::remove_dir_all(&dir).unwrap();
}

#[test]
fn resumed_file_is_identical() {
    let dir = folder("hdf5_resume");
    let path = dir.join("a.h5");
    let rows = 60_000;
    let (file, marks) = grown(&path, rows);
    drop(file);
    let whole = fs::read(&path).unwrap();
    for at in [0, 30, 61, marks.len() - 1] {
        let mut file = File::resume(&path, &marks[at]).unwrap();
        for from in (0..rows).step_by(700).skip(at + 1) {
            add(&mut file, from..(from + 700).min(rows));
            file.commit().unwrap();
        }
        assert!(fs::read(&path).unwrap() == whole, "resumed at mark {at}");
    }
    fs::write(&path, &whole[..whole.len() - 1]).unwrap();
    let error = File::resume(&path, marks.last().unwrap()).unwrap_err();
    assert!(error.to_string().contains("is not the file of the checkpoint"), "{error}");
    fs::remove_dir_all(&dir).unwrap();
}
