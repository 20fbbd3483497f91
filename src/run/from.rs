//! Runs that start from the final state of another: `trackbed run NEXT --from DIR`.
//!
//! `end.state` contains grains with contact history, broken bonds, and the solid with plastic strains. The
//! next run starts from it instead of packing, with time, balances and settlement at zero. The model must be
//! the same except [`FREE`]. With `--bed`, grains with the same [`BED`] are imported into another scene.

use super::checkpoint::{self, Loaded, Origin};
use super::hash::Hash;
use super::run_file::{RunFile, Source};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use trackbed_input::model::Job;
use trackbed_input::scene::Document;
use trackbed_io::failure::Failure;

/// File name.
pub const FILE: &str = "end.state";
/// Stage name of a final state.
pub const END: &str = "end";

/// May be changed, added or removed.
const FREE: [&str; 18] = [
    "title",
    "gravity",
    "include",
    "time",
    "output",
    "measure",
    "probe",
    "wind",
    "water",
    "track.load",
    "track.jump",
    "track.push",
    "solid.load",
    "solid.newton",
    "coupling.tolerance",
    "coupling.max_passes",
    "coupling.window",
    "coupling.substeps",
];
/// Numbers may change; keys and laws must stay.
const CONSTANTS: [&str; 4] = ["material", "contact", "solid.material", "solid.rayleigh"];
const WORDS: [&str; 10] =
    ["name", "id", "model", "between", "normal", "tangential", "damping", "rolling", "twisting", "cone"];
/// Compared by content.
const FILES: [&str; 9] =
    ["mesh", "nodes", "elements", "constraints", "library", "packing", "file", "surface", "pairs"];

/// Must match with `--bed`.
const BED: [&str; 4] = ["grains", "bond", "periodic", "outlet"];

/// Final state of another run.
pub struct Previous {
    /// State.
    pub loaded: Loaded,
    /// File hash.
    pub hash: String,
    /// Whether the run was coupled.
    pub coupled: bool,
    /// First compaction stage that the run did not have, if any.
    pub added: Option<usize>,
}

/// Describes the imported data; `bed`: grains only.
pub fn carries(bed: bool, added: bool) -> &'static str {
    match bed {
        false if added => {
            "--from: grains, walls and sleepers stand where the earlier run left them, at rest, for the added compaction; contact history, solid, time, loads, settlement and energy balance start anew"
        }
        true => {
            "--bed: grains with their motion, contact history and bonds are imported from the earlier run; walls, sleepers, solid, loads and their contacts start from scratch, without deposition and compaction"
        }
        false => {
            "--from: grains with their contact history, walls, sleepers and solid continue from the final state of the earlier run; time, loads, settlement and energy balance start at zero"
        }
    }
}

/// Reads the final state in `dir` and checks compatibility.
///
/// # Errors
/// No state, or another model.
pub fn open(dir: &Path, document: &Document, origin: &Origin, bed: bool) -> Result<Previous, Failure> {
    let file = dir.join(FILE);
    if !file.is_file() {
        let expected = "the results directory of a completed run with grains and `output.state`";
        return Err(Failure::Input(format!(
            "--from: {}: found no {FILE}, expected {expected}",
            dir.display()
        )));
    }
    let (before, loaded, hash) =
        checkpoint::read_file(&file).map_err(|e| Failure::Input(format!("--from: {e}")))?;
    let old = match earlier(dir, document, origin, &before) {
        Ok(old) => old,
        Err(wrong) => return Err(wrong.refusal(document)),
    };
    if let Some(wrong) = difference(dir, document, origin, &before, &old, bed) {
        return Err(wrong.refusal(document));
    }
    let coupled = old.keys().any(|key| key.starts_with("solid."));
    let (stages, now) = (compaction_stages(&old), compaction_stages(&document.keys()));
    let added = (!bed && now > stages).then_some(stages);
    Ok(Previous { loaded, hash, coupled, added })
}

/// Returns the hash of scene and initial state.
pub fn hash_after(scene: &str, state: &str) -> String {
    let mut hash = Hash::default();
    hash.add(scene.as_bytes());
    hash.add(state.as_bytes());
    hash.hex()
}

/// Returns the hash of the final state in `dir`, as [`hash_after`] takes it.
///
/// # Errors
/// No state, or a damaged one.
pub fn state_hash(dir: &Path) -> Result<String, Failure> {
    let (_, _, hash) =
        checkpoint::read_file(&dir.join(FILE)).map_err(|e| Failure::Input(format!("--from: {e}")))?;
    Ok(hash)
}

/// Rejects scenes that would drop part of the state.
///
/// # Errors
/// Input errors.
pub fn check(
    job: &Job,
    document: &Document,
    source: Source<'_>,
    added: Option<usize>,
) -> Result<(), Failure> {
    if let Some(stage) = added {
        let yields = job.solid.as_ref().is_some_and(|solid| !solid.is_linear());
        let bonds = job.grains.as_ref().is_some_and(|g| !g.bonds.is_empty());
        let flow =
            job.grains.as_ref().is_some_and(|g| g.flow.as_ref().is_some_and(|flow| !flow.inlets.is_empty()));
        let moves = job.grains.as_ref().is_some_and(|g| g.walls.others.iter().any(|w| *w != w.at_rest()));
        let why = [
            (yields, "materials that yield"),
            (moves, "walls that move"),
            (bonds, "bonds, which may be broken"),
            (flow, "inlets, whose grains wait"),
        ];
        if let Some((_, what)) = why.into_iter().find(|(there, _)| *there) {
            let found = format!("a stage after those of {}", source.dir.display());
            let expected = format!("no added stage in a scene with {what}");
            return Err(document.error(&format!("compaction.{stage}"), found, expected).into());
        }
    }
    if source.bed && job.grains.is_none() {
        let expected = "a scene with grains for --bed";
        return Err(document.error("grains", "nothing", expected).into());
    }
    if !source.bed && job.grains.as_ref().is_some_and(|g| g.track.rail.is_some()) {
        let expected = "no rail with --from. Use --bed, or remove [track.rail]";
        return Err(document.error("track.rail", "a rail", expected).into());
    }
    Ok(())
}

struct Difference {
    key: String,
    found: String,
    expected: String,
}

impl Difference {
    fn refusal(self, document: &Document) -> Failure {
        document.error(&self.key, self.found, self.expected).into()
    }
}

fn earlier(
    dir: &Path,
    document: &Document,
    origin: &Origin,
    before: &Origin,
) -> Result<BTreeMap<String, String>, Difference> {
    if before.version != origin.version {
        let found = format!("{} of program version {}", dir.display(), before.version);
        return Err(Difference {
            key: "--from".into(),
            found,
            expected: format!("version {}", origin.version),
        });
    }
    // At its original location, with included files.
    let place =
        RunFile::read(dir).map_or_else(|| document.file().to_path_buf(), |run| PathBuf::from(run.scene));
    let old = Document::parse(&place, before.scene.clone()).ok().and_then(|mut old| {
        old.set_all(&before.overrides).ok()?;
        Some(old.keys())
    });
    old.ok_or_else(|| Difference {
        key: "--from".into(),
        found: format!("{}, whose scene cannot be read", dir.display()),
        expected: "its scene with its includes".into(),
    })
}

fn difference(
    dir: &Path,
    document: &Document,
    origin: &Origin,
    before: &Origin,
    old: &BTreeMap<String, String>,
    bed: bool,
) -> Option<Difference> {
    let new = document.keys();
    let keys: BTreeSet<&String> = old.keys().chain(new.keys()).collect();
    let stages = compaction_stages(old);
    let fits = |key: &str| match bed {
        true => may_be_beside(key, old, &new),
        false => may_be(key, old, &new) || is_added(key, stages),
    };
    let other = keys.into_iter().find(|key| !fits(key));
    if let Some(key) = other {
        let text = |keys: &BTreeMap<String, String>| keys.get(key).map_or("nothing", |v| v).to_string();
        let (found, expected) = (
            text(&new),
            format!("{}, as in {}: {}", text(old), dir.display(), if bed { OWN_GRAINS } else { OWN_MODEL }),
        );
        return Some(Difference { key: key.clone(), found, expected });
    }
    let hashes = |files: &[(PathBuf, String)]| files.iter().map(|f| f.1.clone()).collect::<BTreeSet<_>>();
    let known = hashes(&before.files);
    let included = document.included().map(Path::to_path_buf);
    let free: Vec<PathBuf> = files(&new, |key| may_be_free(key, bed)).chain(included).collect();
    let changed = origin.files.iter().find(|(file, hash)| !known.contains(hash) && !free.contains(file));
    changed.map(|(file, _)| Difference {
        key: "--from".into(),
        found: format!("{}, changed since the run in {}", file.display(), dir.display()),
        expected: "the same mesh, libraries and lists".into(),
    })
}

const OWN_MODEL: &str = "--from requires the same model (--bed imports grains into another)";
const OWN_GRAINS: &str = "--bed requires the same grains";

/// Number of compaction stages.
fn compaction_stages(keys: &BTreeMap<String, String>) -> usize {
    let index = |key: &String| key.strip_prefix("compaction.")?.split('.').next()?.parse::<usize>().ok();
    keys.keys().filter_map(index).max().map_or(0, |last| last + 1)
}

/// Whether a key belongs to a stage after the `stages` of the earlier run.
fn is_added(key: &str, stages: usize) -> bool {
    key.strip_prefix("compaction.")
        .and_then(|rest| rest.split('.').next()?.parse::<usize>().ok())
        .is_some_and(|index| index >= stages)
}

/// Bodies refer to materials by index.
fn may_be_beside(key: &str, old: &BTreeMap<String, String>, new: &BTreeMap<String, String>) -> bool {
    let (before, now) = (old.get(key), new.get(key));
    let last = key.rsplit('.').next().unwrap_or(key);
    let material = key.starts_with("material.") && last == "name" && before.is_some();
    let file = FILES.contains(&last) && before.is_some() && now.is_some();
    let accepted = key.starts_with("grains.") && last == "accept_overlap";
    before == now || file || accepted || !(material || BED.iter().any(|table| is_in(key, table)))
}

fn is_in(key: &str, table: &str) -> bool {
    key.strip_prefix(table).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

fn may_be_free(key: &str, bed: bool) -> bool {
    if bed { !BED.iter().any(|table| is_in(key, table)) } else { FREE.iter().any(|table| is_in(key, table)) }
}

fn may_be(key: &str, old: &BTreeMap<String, String>, new: &BTreeMap<String, String>) -> bool {
    let (before, now) = (old.get(key), new.get(key));
    let last = key.rsplit('.').next().unwrap_or(key);
    let both = before.is_some() && now.is_some();
    let in_table = |table: &&str| is_in(key, table);
    // The state contains grain masses.
    let mass = key == "time.mass_factor" || key.starts_with("material.") && last == "density";
    // Meshed sleepers are held by the solid.
    let hold = is_in(key, "track.sleeper.hold") && !new.keys().any(|k| is_in(k, "track.sleeper.mesh"));
    before == now
        || hold
        || !mass && FREE.iter().any(in_table)
        || both
            && !mass
            && (FILES.contains(&last) || CONSTANTS.iter().any(in_table) && !WORDS.contains(&last))
}

fn files(keys: &BTreeMap<String, String>, below: impl Fn(&str) -> bool) -> impl Iterator<Item = PathBuf> {
    let names = keys.iter().filter(move |(key, _)| below(key));
    // Quoted strings, single or in lists.
    names.flat_map(|(_, value)| value.split('"').skip(1).step_by(2)).map(PathBuf::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accepts_changed_loads_rejects_changed_model() {
        let keys = |text: &str| {
            let document = Document::parse(Path::new("scene.toml"), text.into()).unwrap();
            document.keys()
        };
        let old = keys(
            "title = \"a\"\n[[material]]\nname = \"stone\"\nfriction = 0.5\ndensity = 2650.0\n[[solid.material]]\ndensity = 2000.0\n[track.load]\ncycles = 10\n[[grains]]\ncount = 3\n\
             library = \"a.toml\"\n[coupling]\nscheme = \"lagged\"\n",
        );
        for (key, value, free) in [
            ("title", "\"b\"", true),
            ("track.load.cycles", "20", true),
            ("track.load.maximum", "3.0", true),
            ("track.jump.largest", "3.0", true),
            ("compaction.0.force", "3.0", false),
            ("track.loads", "3.0", false),
            ("track.sleeper.hold", "[\"x\"]", true),
            ("material.0.friction", "0.7", true),
            ("material.0.name", "\"rock\"", false),
            ("material.0.density", "2700.0", false),
            ("solid.material.0.density", "2100.0", true),
            ("time.mass_factor", "4.0", false),
            ("material.0.rolling_friction", "0.2", false),
            ("grains.0.count", "4", false),
            ("grains.0.library", "\"../a.toml\"", true),
            ("coupling.scheme", "\"predicted\"", false),
            ("walls", "[]", false),
        ] {
            let mut new = old.clone();
            new.insert(key.into(), value.into());
            assert_eq!(may_be(key, &old, &new), free, "{key} = {value}");
        }
        let mut fewer = old.clone();
        fewer.remove("grains.0.count");
        assert!(!may_be("grains.0.count", &old, &fewer));
        let stages = keys("[[compaction]]\nkind = \"bedding\"\n[[compaction]]\nkind = \"pouring\"\n");
        assert_eq!([compaction_stages(&old), compaction_stages(&stages)], [0, 2]);
        assert!(is_added("compaction.2.kind", 2) && is_added("compaction.10.tines.gap", 2));
        assert!(!is_added("compaction.1.kind", 2) && !is_added("coupling.2", 2));
        let named = keys("[track.load]\nfile = \"a.csv\"\n[solid]\nmesh = \"b.cdb\"");
        let free = files(&named, |key| may_be_free(key, false));
        assert_eq!(free.collect::<Vec<_>>(), [PathBuf::from("a.csv")]);
        for (key, value, free) in [
            ("walls", "[]", true),
            ("coupling.scheme", "\"predicted\"", true),
            ("grains.0.count", "4", false),
            ("grains.0.accept_overlap", "true", true),
            ("material.0.name", "\"rock\"", false),
        ] {
            let mut new = old.clone();
            new.insert(key.into(), value.into());
            assert_eq!(may_be_beside(key, &old, &new), free, "{key} = {value}");
        }
    }
}
