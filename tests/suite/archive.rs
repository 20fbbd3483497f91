//! Archives of finished runs: `trackbed reproduce --archive`.

use super::support::{
    Folder, GRAINS, Outcome, SOLID, scene_folder, small_block, snapshot, trackbed_in, write_lists,
};
use flate2::Compression;
use flate2::read::GzDecoder;
use flate2::write::GzEncoder;
use std::fs;
use std::io::Read;
use std::path::Path;

/// Names and contents of an archive.
type Entries = Vec<(String, Vec<u8>)>;

/// Finished run `out` of a scene whose mesh and material are in other directories.
fn finished(name: &str) -> Folder {
    let folder = Folder::new(name);
    fs::create_dir_all(folder.join("mesh")).unwrap();
    write_lists(&small_block(), &folder.join("mesh"));
    let (head, rest) = SOLID.split_once("[[solid.material]]").unwrap();
    let (material, tail) = rest.split_once("[[solid.load]]").unwrap();
    let mut scene = format!("include = [\"../parts/soil.toml\"]\n{head}[[solid.load]]{tail}");
    for list in ["NODECOORD.DAT", "ELEMENTNUM.DAT", "DOF.DAT"] {
        scene = scene.replace(list, &format!("../mesh/{list}"));
    }
    folder.write("model/scene.toml", &scene);
    folder.write("parts/soil.toml", &format!("[[solid.material]]{material}"));
    let set = "solid.material.soil.young=30 MPa";
    trackbed_in(folder.path(), ["run", "model/scene.toml", "--out", "out", "--quiet", "--set", set]).good();
    folder
}

fn reproduce(dir: &Path, arguments: &[&str]) -> Outcome {
    trackbed_in(dir, [&["reproduce"][..], arguments].concat())
}

fn unpacked(file: &Path) -> Entries {
    let mut archive = tar::Archive::new(GzDecoder::new(fs::File::open(file).unwrap()));
    let read = |entry: std::io::Result<tar::Entry<'_, GzDecoder<fs::File>>>| {
        let mut entry = entry.unwrap();
        let name = entry.path().unwrap().to_str().unwrap().to_string();
        let mut content = Vec::new();
        entry.read_to_end(&mut content).unwrap();
        (name, content)
    };
    archive.entries().unwrap().map(read).collect()
}

/// Packs any names, also those that the crate rejects.
fn pack(file: &Path, entries: &Entries) {
    let mut archive = tar::Builder::new(GzEncoder::new(Vec::new(), Compression::fast()));
    for (name, content) in entries {
        let mut header = tar::Header::new_gnu();
        header.as_old_mut().name[..name.len()].copy_from_slice(name.as_bytes());
        header.set_entry_type(tar::EntryType::Regular);
        header.set_mode(0o644);
        header.set_size(content.len() as u64);
        header.set_cksum();
        archive.append(&header, content.as_slice()).unwrap();
    }
    fs::write(file, archive.into_inner().unwrap().finish().unwrap()).unwrap();
}

#[test]
fn moved_archive_is_reproduced() {
    let folder = finished("archive");
    let archived = reproduce(folder.path(), &["out", "--archive", "run.tar.gz"]).good();
    assert_eq!(archived.stdout, "run.tar.gz written\n");
    reproduce(folder.path(), &["out", "--archive", "again.tar.gz"]).good();
    assert!(fs::read(folder.join("run.tar.gz")).unwrap() == fs::read(folder.join("again.tar.gz")).unwrap());
    let entries = unpacked(&folder.join("run.tar.gz"));
    let names: Vec<&str> = entries.iter().map(|(name, _)| name.as_str()).collect();
    let inputs =
        ["mesh/DOF.DAT", "mesh/ELEMENTNUM.DAT", "mesh/NODECOORD.DAT", "model/scene.toml", "parts/soil.toml"];
    assert_eq!(names[0], "archive.json");
    assert_eq!(names[1..6], inputs.map(|name| format!("inputs/{name}")));
    assert!(names.is_sorted() && names[6..].iter().all(|name| name.starts_with("results/")), "{names:?}");
    assert_eq!(names.len() - 6, snapshot(&folder.join("out")).len());
    let record: serde_json::Value = serde_json::from_slice(&entries[0].1).unwrap();
    assert_eq!(record["scene"], "inputs/model/scene.toml");
    assert_eq!(record["overrides"][0], "solid.material.0.young=30 MPa");
    assert_eq!(record["files"].as_object().unwrap().len(), inputs.len());
    assert!(record["environment"]["cores"].as_u64() > Some(0), "{record}");

    let other = Folder::new("archive_moved");
    fs::rename(folder.join("run.tar.gz"), other.join("run.tar.gz")).unwrap();
    ["model", "mesh", "parts"].iter().for_each(|name| fs::remove_dir_all(folder.join(name)).unwrap());
    let same = reproduce(other.path(), &["run.tar.gz", "--threads", "2"]).good();
    let words = same.stdout.strip_prefix("run/results: reproduced, ").unwrap_or_default();
    assert!(words.ends_with(" files identical\n"), "{same:?}");
    assert!(other.join("run/results-reproduced/summary.json").exists());
    let full = reproduce(other.path(), &["run.tar.gz"]);
    assert_eq!(full.code, 2, "{full:?}");
    assert!(full.stderr.contains("run: found a directory that is not empty, expected"), "{full:?}");
}

#[test]
fn changed_archives_are_rejected() {
    let folder = finished("archive_changed");
    let file = folder.join("run.tar.gz");
    reproduce(folder.path(), &["out", "--archive", "run.tar.gz"]).good();
    let whole = fs::read(&file).unwrap();
    let entries = unpacked(&file);
    let refused = |expected: &str| {
        let outcome = reproduce(folder.path(), &["run.tar.gz"]);
        assert_eq!((outcome.code, outcome.stderr.lines().count()), (2, 1), "{outcome:?}");
        assert!(outcome.stderr.contains(expected), "{expected}: {outcome:?}");
        assert!(!folder.join("run").exists() && !folder.join("outside.txt").exists());
    };
    let part = "inputs/parts/soil.toml";
    let at = entries.iter().position(|(name, _)| name == part).unwrap();
    let with = |change: &dyn Fn(&mut Entries)| {
        let mut changed = entries.clone();
        change(&mut changed);
        pack(&file, &changed);
    };
    with(&|all| all[at].1[5] ^= 1);
    refused("run.tar.gz: inputs/parts/soil.toml: found changed content with hash ");
    with(&|all| drop(all.remove(at)));
    refused("run.tar.gz: inputs/parts/soil.toml: found nothing, expected the input file of the run");
    with(&|all| all.push(("inputs/model/more.toml".into(), Vec::new())));
    refused("run.tar.gz: inputs/model/more.toml: found a file without a hash");
    with(&|all| drop(all.remove(0)));
    refused("run.tar.gz: found no archive.json, expected an archive by");
    for name in ["../outside.txt", "results/../../outside.txt", "/outside.txt"] {
        with(&|all| all.push((name.into(), b"text".to_vec())));
        refused(&format!("run.tar.gz: {name}: found this entry, expected a relative path"));
    }
    fs::write(&file, &whole[..whole.len() / 2]).unwrap();
    refused("run.tar.gz: found a damaged archive");
    // Changed results are differences.
    let at = entries.iter().position(|(name, _)| name == "results/nodes.csv").unwrap();
    with(&|all| all[at].1.push(b'\n'));
    let outcome = reproduce(folder.path(), &["run.tar.gz"]);
    assert_eq!(outcome.code, 1, "{outcome:?}");
    assert!(outcome.stderr.contains("nodes.csv: "), "{outcome:?}");
}

#[test]
fn unsuitable_runs_are_not_archived() {
    let folder = scene_folder("archive_from", GRAINS);
    let run = |arguments: &[&str]| {
        trackbed_in(folder.path(), [&["run", "scene.toml", "--quiet", "--out"][..], arguments].concat())
            .good()
    };
    run(&["first"]);
    run(&["second", "--from", "first"]);
    let refused = |results: &str, archive: &str, expected: &str| {
        let outcome = reproduce(folder.path(), &[results, "--archive", archive]);
        assert_eq!((outcome.code, outcome.stderr.lines().count()), (2, 1), "{outcome:?}");
        assert!(outcome.stderr.contains(expected), "{expected}: {outcome:?}");
        assert!(!folder.join("run.tar.gz").exists() && !folder.join("run.tar.gz.part").exists());
    };
    refused("second", "run.tar.gz", "run.json: found a run with --from first, expected a run without --from");
    refused("first", "run.zip", "run.zip: found another extension, expected a name that ends with .tar.gz");
    folder.write("kept.tar.gz", "");
    refused("first", "kept.tar.gz", "kept.tar.gz: found an existing file, expected a new file");
    refused("scene.toml", "run.tar.gz", "run.json: found nothing readable, expected the results of a run");
    let file = reproduce(folder.path(), &["scene.toml"]);
    assert_eq!(file.code, 2, "{file:?}");
    assert!(
        file.stderr.contains("scene.toml: found a file, expected a results directory, or an archive"),
        "{file:?}"
    );

    let folder = scene_folder("archive_absolute", SOLID);
    let nodes = format!("solid.nodes={}", folder.join("NODECOORD.DAT").display());
    trackbed_in(folder.path(), ["run", "scene.toml", "--out", "out", "--quiet", "--set", &nodes]).good();
    let absolute = reproduce(folder.path(), &["out", "--archive", "run.tar.gz"]);
    assert_eq!(absolute.code, 2, "{absolute:?}");
    assert!(absolute.stderr.contains("scene.toml: found the absolute path /"), "{absolute:?}");
}
