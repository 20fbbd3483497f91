//! `cargo test --release --test suite structure -- --nocapture` prints details.

mod graph;
mod keys;
mod source;
mod words;

use graph::{Circle, circles, files_in_circles, graph};
use source::{functions, read_crate};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

const LONGEST: usize = 80;

const CRATES: [&str; 13] = [
    "dem/geometry/lib.rs",
    "dem/kernels/lib.rs",
    "dem/src/lib.rs",
    "fem/src/lib.rs",
    "coupling/track/lib.rs",
    "coupling/src/lib.rs",
    "src/io/lib.rs",
    "src/scene/lib.rs",
    "src/input/lib.rs",
    "src/run/lib.rs",
    "src/report/lib.rs",
    "src/post/lib.rs",
    "src/lib.rs",
];

/// Exempt functions with reasons.
const TABLES: &[(&str, &str)] = &[];

fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Files with these extensions: (path, text).
fn files(endings: &[&str]) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut open = vec![PathBuf::new()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(repository().join(&folder)).expect("folders of the repository can be read")
        {
            let entry = entry.expect("entries can be read");
            let name = entry.file_name().into_string().expect("names are text");
            let path = folder.join(&name);
            if entry.file_type().expect("kinds can be read").is_dir() {
                if !name.starts_with('.') && !name.starts_with("target") && name != "results" {
                    open.push(path);
                }
            } else if endings.iter().any(|e| name.ends_with(e)) {
                let text = fs::read_to_string(entry.path()).unwrap_or_else(|e| panic!("{name}: {e}"));
                found.push((path.to_str().expect("names are text").to_string(), text));
            }
        }
    }
    found.sort();
    found
}

fn print(circle: &Circle) {
    println!("  {}: {}", circle.folder, circle.entries.join(", "));
    circle.ties.iter().for_each(|tie| println!("    {tie}"));
}

#[test]
fn dependency_cycles_are_small() {
    let mut failures = Vec::new();
    for root in CRATES {
        let scopes = read_crate(repository(), root);
        assert!(scopes.len() > 5, "{root}: {} modules", scopes.len());
        let folder = root.rsplit_once('/').expect("a root lies in a folder").0;
        let graph = graph(&scopes);
        let (large, small): (Vec<_>, Vec<_>) =
            circles(&graph, folder).into_iter().partition(Circle::too_large);
        let entries: usize = large.iter().map(|c| c.entries.len()).sum();
        println!(
            "{root}: {entries} files and folders in {} circles to be cut, {} small ones",
            large.len(),
            small.len()
        );
        println!("  sizes of the circles of files, folders apart: {:?}", files_in_circles(&graph));
        large.iter().chain(&small).for_each(print);
        if entries > 0 {
            failures.push(format!("{root}: {entries} in circles, expected none"));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// Functions whose last bits depend on system library and CPU; use those of `libm`.
const ELEMENTARY: &str = "sin cos tan asin acos atan atan2 sin_cos exp exp2 exp_m1 ln ln_1p log2 log10 powf cbrt sinh cosh \
                          tanh asinh acosh atanh hypot scaled_axis from_scaled_axis from_axis_angle from_euler_angles";

#[test]
fn elementary_functions_use_libm() {
    let mut found = Vec::new();
    for root in CRATES {
        for scope in read_crate(repository(), root).values() {
            let of_types = scope.paths.iter().filter(|path| path.len() > 1 && path[0] != "libm");
            let last = of_types.filter_map(|path| path.last());
            let names: BTreeSet<&String> = scope.calls.iter().chain(last).collect();
            let own = ELEMENTARY.split_whitespace().filter(|name| names.iter().any(|n| n == name));
            found.extend(own.map(|name| format!("{}: {name}", scope.file)));
        }
    }
    found.iter().for_each(|use_| println!("{use_}"));
    assert!(found.is_empty(), "{} uses", found.len());
}

/// Names and paths of one operating system.
const SYSTEM: [&str; 10] = [
    "std::os::unix",
    "std::os::fd",
    "std::os::linux",
    "std::os::windows",
    "libc::",
    "windows_sys::",
    "cfg(unix)",
    "cfg(windows)",
    "target_os",
    "target_env",
];

const SYSTEM_PATHS: [&str; 4] = ["\"/proc/", "\"/dev/", "\"/sys/", "\"/tmp"];

fn production(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = text.lines().take_while(|line| !line.starts_with("#[cfg(test)]"));
    lines.enumerate().map(|(k, line)| (k + 1, line)).filter(|(_, line)| !line.trim_start().starts_with("//"))
}

#[test]
fn only_one_module_differs_between_systems() {
    let of_program = |file: &str| {
        ["src/", "dem/src/", "fem/src/", "coupling/src/"].iter().any(|folder| file.starts_with(folder))
            && !file.starts_with("src/io/system/")
            && !file.ends_with("tests.rs")
            && !file.contains("/tests/")
    };
    let mut found = Vec::new();
    for (file, text) in files(&[".rs"]).iter().filter(|(file, _)| of_program(file)) {
        let uses = |line: &str| SYSTEM.iter().chain(&SYSTEM_PATHS).any(|name| line.contains(name));
        let lines = production(text).filter(|(_, line)| uses(line));
        found.extend(lines.map(|(number, line)| format!("{file}:{number}: {}", line.trim())));
    }
    assert!(found.is_empty(), "expected in src/io/system only:\n{}", found.join("\n"));
}

#[test]
fn functions_are_short() {
    let sources = files(&[".rs"]);
    let longest = sources.iter().max_by_key(|(_, text)| text.lines().count()).expect("there are sources");
    println!("longest file: {} with {} lines", longest.0, longest.1.lines().count());
    let mut all: Vec<_> = sources.iter().flat_map(|(file, text)| functions(file, text)).collect();
    all.sort();
    let last = all.last().expect("there are functions");
    println!("longest of {} functions: {} with {} lines", all.len(), last.place, last.lines);
    let free = |place: &str| TABLES.iter().any(|(table, _)| place.ends_with(table));
    let long: Vec<_> = all.iter().filter(|f| f.lines > LONGEST && !free(&f.place)).collect();
    long.iter().for_each(|f| println!("  {} lines: {}", f.lines, f.place));
    assert!(long.is_empty(), "{} functions of more than {LONGEST} lines", long.len());
}

#[test]
fn keys_in_errors_exist() {
    let sources = files(&[".rs"]);
    let tables = ["src/scene/", "src/input/model/track/trains.rs", "src/input/model/track/vehicles.rs"];
    let mut known = BTreeSet::from(["scene".to_string()]);
    for (_, text) in sources.iter().filter(|(file, _)| tables.iter().any(|t| file.starts_with(t))) {
        keys::declared(text, &mut known);
    }
    // Files with separate keys.
    let others =
        ["src/input/model/tables.rs", "src/scene/document.rs", "src/scene/table.rs", "src/scene/wording.rs"];
    let of_scene = |file: &str| {
        (file.starts_with("src/input/model/") || file.starts_with("src/scene/")) && !others.contains(&file)
    };
    let (mut count, mut unknown) = (0, Vec::new());
    for (file, text) in sources.iter().filter(|(file, _)| of_scene(file)) {
        for (line, key) in keys::named(text) {
            count += 1;
            if !known.contains(&key) {
                unknown.push(format!("{file}:{line}: {key}"));
            }
        }
    }
    println!("{count} names of keys, {} keys", known.len());
    assert!(count > 500 && known.len() > 250, "{count} names of {} keys", known.len());
    assert!(unknown.is_empty(), "no such key in a scene:\n{}", unknown.join("\n"));
}

#[test]
fn replaced_words_are_gone() {
    let page = fs::read_to_string(repository().join("ARCHITECTURE.md")).expect("the page is there");
    let replaced = words::replaced(&page);
    let mut all: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (file, text) in files(&[".rs", ".md", ".toml", ".py"]).iter().filter(|(f, _)| f != "ARCHITECTURE.md")
    {
        for (word, places) in words::uses(file, text, &replaced) {
            all.entry(word).or_default().extend(places);
        }
    }
    let found: usize = all.values().map(Vec::len).sum();
    for (word, places) in &all {
        println!("{word}: {}", places.len());
        places.iter().for_each(|place| println!("  {place}"));
    }
    assert!(found == 0, "{found} uses of replaced words");
}

#[test]
fn replaced_phrases_are_gone() {
    let page = fs::read_to_string(repository().join("ARCHITECTURE.md")).expect("the page is there");
    let phrases = words::replaced_phrases(&page);
    let texts = files(&[".rs", ".md", ".py"]);
    let found: Vec<String> = texts
        .iter()
        .filter(|(file, _)| file != "ARCHITECTURE.md" && !file.starts_with("tests/suite/structure/"))
        .flat_map(|(file, text)| words::phrases_in(file, text, &phrases))
        .collect();
    assert!(found.is_empty(), "replaced phrases:\n{}", found.join("\n"));
}

mod the_checks {
    use super::super::support::Folder;
    use super::words::{Ban, phrases_in, uses, words_of};
    use super::{circles, functions, graph, keys, read_crate};
    use std::collections::{BTreeMap, BTreeSet};
    use std::fs;

    fn circles_of(name: &str, files: &[(&str, &str)]) -> Vec<(Vec<String>, bool)> {
        let folder = Folder::new(name);
        for (file, text) in files {
            let path = folder.join("src").join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let graph = graph(&read_crate(&folder.join(""), "src/lib.rs"));
        circles(&graph, "src").into_iter().map(|c| (c.entries.clone(), c.too_large())).collect()
    }

    const ROOT: (&str, &str) = ("lib.rs", "mod low; mod high; mod kinds;");
    const KINDS: (&str, &str) = ("kinds.rs", "pub struct Kind;");

    #[test]
    fn imports_downwards_are_no_circle() {
        let low = ("low/mod.rs", "mod inner; pub use inner::{Low, Other};");
        let inner = ("low/inner.rs", "use crate::kinds::Kind; pub struct Low(Kind); pub struct Other;");
        let high = ("high.rs", "fn high(_: crate::low::Low) { super::low::Other; }");
        assert_eq!(circles_of("checks_downwards", &[ROOT, KINDS, low, inner, high]), []);
        let tests = ("kinds.rs", "pub struct Kind; #[cfg(test)] mod tests { use crate::high::high; }");
        assert_eq!(circles_of("checks_tests", &[ROOT, tests, low, inner, high]), []);
    }

    #[test]
    fn every_reference_closes_cycle() {
        let low = |text| {
            let inner = ("low/inner.rs", text);
            let face = ("low/mod.rs", "mod inner; pub use inner::Low;");
            let high = (
                "high.rs",
                "use crate::low::Low; pub struct High(Low); pub fn high() {} impl High { fn all() {} }",
            );
            circles_of("checks_upwards", &[ROOT, KINDS, face, inner, high])
        };
        let expected = [(vec!["high.rs".to_string(), "low/".to_string()], true)];
        assert_eq!(low("pub struct Low;"), []);
        assert_eq!(low("use crate::high::High; pub struct Low;"), expected);
        assert_eq!(low("pub struct Low; fn f() { crate::high::high() }"), expected);
        assert_eq!(low("use super::super::high as up; pub struct Low; fn f() { up::high() }"), expected);
        assert_eq!(low("use crate::high::*; pub struct Low; fn f() { high() }"), expected);
        assert_eq!(low("pub struct Low; fn f() { assert!(crate::high::high() == ()); }"), expected);
        assert_eq!(low("use crate::{kinds::Kind, high::{self, High}}; pub struct Low;"), expected);
    }

    #[test]
    fn methods_away_from_their_type_count() {
        let kinds = ("kinds.rs", "pub struct Kind; fn f(k: Kind) { k.more() }");
        let high = ("high.rs", "use crate::kinds::Kind; impl Kind { pub fn more(&self) {} }");
        let found = circles_of("checks_methods", &[("lib.rs", "mod kinds; mod high;"), kinds, high]);
        assert_eq!(found, [(vec!["high.rs".to_string(), "kinds.rs".to_string()], false)]);
    }

    #[test]
    fn four_files_are_too_many() {
        let name = |k: usize| {
            (format!("m{k}.rs"), format!("use crate::m{}::T{}; pub struct T{k};", k % 4 + 1, k % 4 + 1))
        };
        let files: Vec<(String, String)> = (1..=4).map(name).collect();
        let mut all = vec![("lib.rs", "mod m1; mod m2; mod m3; mod m4;")];
        all.extend(files.iter().map(|(a, b)| (a.as_str(), b.as_str())));
        let found = circles_of("checks_four", &all);
        assert_eq!((found.len(), found[0].0.len(), found[0].1), (1, 4, true));
    }

    #[test]
    fn lengths_are_those_of_the_lines() {
        let found =
            functions("x.rs", "struct S;\nimpl S {\n    fn f() {\n        g();\n    }\n}\nfn g() {}\n");
        let found: Vec<_> = found.iter().map(|f| (f.lines, f.place.as_str())).collect();
        assert_eq!(found, [(3, "x.rs:3 f"), (1, "x.rs:7 g")]);
    }

    #[test]
    fn finds_keys_in_tables_and_errors() {
        let mut declared = BTreeSet::new();
        let tables = "struct A { #[serde(default)] mass: f64, #[serde(rename = \"box\")] region: B }\n\
                      enum C { D { low: f64 } }";
        keys::declared(tables, &mut declared);
        assert_eq!(declared.into_iter().collect::<Vec<_>>(), ["box", "low", "mass"]);
        let code = "fn f(a: T) {\n a.error(\"sleeper.mas\", b, c);\n a.refuse([(\"low\", d.is_some())], e);\n\
                    find(s, a, \"box\", n);\n a.other(\"no key\");\n g(\"no key\");\n h((\"found\", \"expected\"));\n}";
        let named: Vec<_> =
            keys::named(code).into_iter().map(|(line, key)| format!("{line} {key}")).collect();
        assert_eq!(named, ["2 sleeper", "2 mas", "3 low", "4 box"]);
    }

    #[test]
    fn finds_words_in_names_and_text() {
        assert_eq!(words_of("LoadCycle2d_ofX"), ["load", "cycle2d", "of", "x"]);
        let replaced =
            BTreeMap::from([("wheel".to_string(), Ban::Names), ("axle".to_string(), Ban::Anywhere)]);
        let text = "/// An axle, a wheel.\nfn first_wheel(axle: u8) {}\nstruct WheelList; // wheels\n";
        let found = uses("x.rs", text, &replaced);
        assert_eq!(found["wheel"], ["x.rs:2 first_wheel", "x.rs:3 WheelList"]);
        assert_eq!(found["axle"], ["x.rs:2 axle", "x.rs:1 /// An axle, a wheel."]);
    }

    #[test]
    fn finds_phrases_across_lines() {
        let phrases = [("goes on".to_string(), true), ("refused".to_string(), false)];
        let text = "/// A run goes\n/// on. It goes. On refused, it \"Goes on\".\n";
        assert_eq!(phrases_in("x.rs", text, &phrases), ["x.rs:1: goes on", "x.rs:2: goes on"]);
        assert_eq!(phrases_in("x.md", "| refused |\n", &phrases), ["x.md:1: refused"]);
    }
}
