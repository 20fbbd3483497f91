//! `trackbed reproduce`: a finished run again, compared with its results file by file.

use super::archive;
use super::output::print;
use crate::cli::{ReproduceArgs, RunArgs};
use serde_json::Value;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use trackbed_input::model::read_scene;
use trackbed_input::scene::{Document, Scene};
use trackbed_io::failure::Failure;
use trackbed_io::message;
use trackbed_run::{RunFile, hash_after, scene_hash, state_hash};

/// Not compared: times of the clock, state of the program, pages of other commands.
const OTHERS: [&str; 6] = ["checkpoint", "end.state", "log.txt", "report.html", "run.json", "run.lock"];

/// Keys of `summary.json` that depend on clock and machine.
const MACHINE: [&str; 11] = [
    "stages.seconds",
    "newton.assembly_seconds",
    "newton.factor_seconds",
    "newton.solve_seconds",
    "threads",
    "peak_memory",
    "cpu_seconds",
    "model.predicted_memory",
    "version",
    "scene_hash",
    "libraries.path",
];

/// Finished run whose input files are as they were.
struct Finished {
    file: RunFile,
    document: Document,
    scene: Scene,
}

/// Runs the scene of `args.results`, a directory or an archive, by `run` and compares; with `--archive`,
/// writes an archive instead.
///
/// # Errors
/// No finished run, changed input files, differences. See [`Failure`].
pub fn reproduce(
    args: ReproduceArgs,
    run: impl FnOnce(RunArgs) -> Result<(), Failure>,
) -> Result<(), Failure> {
    if let Some(file) = &args.archive {
        return pack(&args.results, file);
    }
    let (dir, moved) = match args.results.is_file() {
        true => archive::unpack(&args.results).map(|(dir, scene)| (dir, Some(scene)))?,
        false => (args.results, None),
    };
    let Finished { file, .. } = unchanged(&dir, moved.as_deref())?;
    if file.version != env!("CARGO_PKG_VERSION") {
        let version = env!("CARGO_PKG_VERSION");
        message::warn(&format!("{}: run by version {}, this is {version}", dir.display(), file.version));
    }
    let out = args.out.unwrap_or_else(|| {
        let mut name = dir.file_name().map_or_else(|| OsString::from("results"), OsString::from);
        name.push("-reproduced");
        dir.with_file_name(name)
    });
    run(RunArgs {
        scene: PathBuf::from(&file.scene),
        out: Some(out.clone()),
        threads: args.threads,
        set: file.overrides,
        from: file.from.map(PathBuf::from),
        bed: file.bed,
        quiet: true,
        ..RunArgs::default()
    })?;
    let (equal, differences) = compare(&dir, &out)?;
    if differences.is_empty() {
        let count = if equal == 1 { "1 file".into() } else { format!("{equal} files") };
        return print(&format!("{}: reproduced, {count} identical\n", dir.display()));
    }
    let list = differences.join("; ");
    let of = equal + differences.len();
    Err(Failure::Other(format!("{}: {} of {of} files differ: {list}", dir.display(), differences.len())))
}

/// Archives a finished run.
fn pack(dir: &Path, file: &Path) -> Result<(), Failure> {
    archive::check(file, dir)?;
    let run = unchanged(dir, None)?;
    let mut results = BTreeMap::new();
    collect(dir, "", &archive::OMITTED, &mut results)?;
    archive::write(file, &run.file, (&run.document, &run.scene), &results)?;
    print(&format!("{} written\n", file.display()))
}

/// Finished run whose input files are as they were; its scene may have `moved`.
fn unchanged(dir: &Path, moved: Option<&Path>) -> Result<Finished, Failure> {
    let refuse = |file: &Path, found: &str, expected: &str| {
        Err(Failure::Input(format!("{}: found {found}, expected {expected}", file.display())))
    };
    let Some(mut file) = RunFile::read(dir) else {
        return refuse(&dir.join("run.json"), "nothing readable", "the results of a run");
    };
    if let Some(scene) = moved {
        file.scene = scene.display().to_string();
    }
    let summary = dir.join("summary.json");
    let content: Value =
        fs::read(&summary).ok().and_then(|b| serde_json::from_slice(&b).ok()).unwrap_or_default();
    if content["status"] != "done" {
        return refuse(&summary, "no finished run", "status \"done\"");
    }
    let scene = Path::new(&file.scene);
    if !scene.is_file() {
        return refuse(scene, "nothing", "the scene of the run, from the directory in which it was started");
    }
    let mut document = Document::open(scene)?;
    document.set_all(&file.overrides)?;
    if document.text() != file.text {
        return refuse(scene, "another text than in run.json of the results", "the scene as it was run");
    }
    let parsed = read_scene(&document)?;
    let mut hash = scene_hash(&document, &parsed);
    if let Some(from) = &file.from {
        hash = hash_after(&hash, &state_hash(Path::new(from))?);
    }
    if content["scene_hash"] != hash {
        let expected = "the files named in the scene as they were run";
        return refuse(scene, "a changed mesh, table or included file", expected);
    }
    Ok(Finished { file, document, scene: parsed })
}

/// Number of equal files and what differs.
fn compare(before: &Path, after: &Path) -> Result<(usize, Vec<String>), Failure> {
    let (mut old, mut new) = (BTreeMap::new(), BTreeMap::new());
    collect(before, "", &OTHERS, &mut old)?;
    collect(after, "", &OTHERS, &mut new)?;
    let (mut equal, mut differences) = (0, Vec::new());
    for (name, path) in &old {
        let Some(other) = new.remove(name) else {
            differences.push(format!("{name}: missing now"));
            continue;
        };
        match difference(name, &bytes(path)?, &bytes(&other)?) {
            None => equal += 1,
            Some(how) => differences.push(format!("{name}: {how}")),
        }
    }
    differences.extend(new.into_keys().map(|name| format!("{name}: new")));
    Ok((equal, differences))
}

fn bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    fs::read(path).map_err(|e| Failure::Other(format!("{}: {e}", path.display())))
}

/// Files below `dir` by name relative to it, without its entries `omitted`.
fn collect(
    dir: &Path,
    prefix: &str,
    omitted: &[&str],
    out: &mut BTreeMap<String, PathBuf>,
) -> Result<(), Failure> {
    let failure = |e| Failure::Other(format!("{}: {e}", dir.display()));
    for entry in fs::read_dir(dir).map_err(failure)? {
        let path = entry.map_err(failure)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if prefix.is_empty() && omitted.contains(&name.as_str()) {
            continue;
        }
        let name = format!("{prefix}{name}");
        if path.is_dir() {
            collect(&path, &format!("{name}/"), omitted, out)?;
        } else {
            out.insert(name, path);
        }
    }
    Ok(())
}

fn difference(name: &str, old: &[u8], new: &[u8]) -> Option<String> {
    if old == new {
        return None;
    }
    match Path::new(name).extension().and_then(|e| e.to_str()) {
        Some("json") => {
            let [old, new] = [old, new].map(|b| serde_json::from_slice(b).unwrap_or(Value::Null));
            let mut path = None;
            first_difference(&old, &new, "", &mut path);
            path.map(|path| format!("first at {path}"))
        }
        Some("csv") => Some(of_tables(old, new)),
        Some("bib") if without_version(old) == without_version(new) => None,
        _ => Some("other content".into()),
    }
}

/// Bibliography without the version of the program.
fn without_version(text: &[u8]) -> Vec<&[u8]> {
    text.split(|byte| *byte == b'\n').filter(|line| !line.starts_with(b"  version = ")).collect()
}

/// Path of the first different value, except machine data.
fn first_difference(old: &Value, new: &Value, path: &str, found: &mut Option<String>) {
    if found.is_some() || old == new || MACHINE.contains(&path) {
        return;
    }
    match (old, new) {
        (Value::Object(a), Value::Object(b)) if a.keys().eq(b.keys()) => {
            for (key, value) in a {
                let below = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                first_difference(value, &b[key], &below, found);
            }
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).for_each(|(a, b)| first_difference(a, b, path, found));
        }
        _ => *found = Some(if path.is_empty() { "the beginning".into() } else { path.into() }),
    }
}

/// Column with the largest difference over the column's largest value.
fn of_tables(old: &[u8], new: &[u8]) -> String {
    let read = |bytes: &[u8]| -> Option<(Vec<String>, Vec<Vec<f64>>)> {
        let mut reader = csv::Reader::from_reader(bytes);
        let heads = reader.headers().ok()?.iter().map(str::to_string).collect();
        let row = |r: csv::StringRecord| r.iter().map(|v| v.parse().unwrap_or(f64::NAN)).collect();
        let rows = reader.into_records().map(|r| r.ok().map(row)).collect::<Option<_>>()?;
        Some((heads, rows))
    };
    let (Some((heads, a)), Some((others, b))) = (read(old), read(new)) else { return "other content".into() };
    if heads != others || a.len() != b.len() {
        return "other columns or rows".into();
    }
    let deviation = |k: usize| {
        let largest = a.iter().map(|row| row[k].abs()).fold(f64::MIN_POSITIVE, f64::max);
        a.iter().zip(&b).map(|(x, y)| (x[k] - y[k]).abs() / largest).fold(0.0, f64::max)
    };
    let worst = (0..heads.len()).map(|k| (deviation(k), k)).max_by(|x, y| x.0.total_cmp(&y.0));
    worst.map_or("other content".into(), |(by, k)| format!("by up to {by:.1e} of the largest {}", heads[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_described() {
        let at = |name, old: &str, new: &str| difference(name, old.as_bytes(), new.as_bytes());
        assert_eq!(at("a.json", r#"{"threads": 1, "x": 2}"#, r#"{"threads": 3, "x": 2}"#), None);
        let first = at("a.json", r#"{"a": {"b": [1, 2]}}"#, r#"{"a": {"b": [1, 3]}}"#);
        assert_eq!(first.as_deref(), Some("first at a.b"));
        let table = at("a.csv", "t,z\n0,2\n1,4\n", "t,z\n0,2\n1,3\n");
        assert_eq!(table.as_deref(), Some("by up to 2.5e-1 of the largest z"));
        assert_eq!(at("a.csv", "t\n0\n", "t\n0\n1\n").as_deref(), Some("other columns or rows"));
        assert_eq!(at("a.vtu", "1", "2").as_deref(), Some("other content"));
        let entry =
            |version, year| format!("@misc{{a,\n  version = {{{version}}},\n  year = {{{year}}},\n}}\n");
        assert_eq!(at("a.bib", &entry("0.1.0", 1979), &entry("0.2.0", 1979)), None);
        assert_eq!(
            at("a.bib", &entry("0.1.0", 1979), &entry("0.1.0", 1980)).as_deref(),
            Some("other content")
        );
    }
}
