//! Dependency graph of files and its cycles.

use super::source::{ModulePath, Scopes};
use std::collections::{BTreeMap, BTreeSet};

/// `from → to: names`, by file.
pub type Graph = BTreeMap<(String, String), BTreeSet<String>>;

type Edges = BTreeMap<String, BTreeSet<String>>;

enum Target {
    Module(ModulePath),
    /// File that defines an item.
    Item(String),
}

/// Longest chain of re-exports; more is an import cycle.
const DEPTH: usize = 16;

fn lookup(scopes: &Scopes, module: &ModulePath, name: &str, depth: usize) -> Option<Target> {
    let scope = scopes.get(module)?;
    if scope.items.contains(name) {
        return Some(Target::Item(scope.file.clone()));
    }
    let inner = [module.clone(), vec![name.to_string()]].concat();
    if scopes.contains_key(&inner) {
        return Some(Target::Module(inner));
    }
    if depth == 0 {
        return None;
    }
    if let Some(import) = scope.imports.get(name) {
        // `use name::…` of another crate resolves to itself.
        return if import.path.len() == 1 { None } else { resolve(scopes, module, &import.path, depth - 1) };
    }
    scope.globs.iter().find_map(|glob| match resolve(scopes, module, glob, depth - 1)? {
        Target::Module(of) if of != *module => lookup(scopes, &of, name, depth - 1),
        _ => None,
    })
}

fn resolve(scopes: &Scopes, from: &ModulePath, path: &[String], depth: usize) -> Option<Target> {
    let mut module = from.clone();
    for (k, name) in path.iter().enumerate() {
        match name.as_str() {
            "crate" if k == 0 => module = vec![],
            "self" if k == 0 => {}
            "super" => {
                module.pop()?;
            }
            _ => match lookup(scopes, &module, name, depth)? {
                Target::Module(inner) => module = inner,
                item => return Some(item),
            },
        }
    }
    Some(Target::Module(module))
}

/// Graph of a crate.
pub fn graph(scopes: &Scopes) -> Graph {
    let mut graph = Graph::new();
    let mut tie = |from: &str, to: String, name: &str| {
        if from != to {
            graph.entry((from.to_string(), to)).or_default().insert(name.to_string());
        }
    };
    let away = methods_away(scopes);
    for (module, scope) in scopes {
        let imports = scope.imports.values().filter(|i| !i.public).map(|i| &i.path);
        for path in imports.chain(&scope.paths) {
            if let Some(Target::Item(file)) = resolve(scopes, module, path, DEPTH) {
                tie(&scope.file, file, path.last().expect("a path has a name"));
            }
        }
        for (name, file) in scope.calls.iter().filter_map(|c| Some((c, away.get(c)?))) {
            tie(&scope.file, file.clone(), name);
        }
    }
    graph
}

/// Unique methods implemented outside their type's file.
fn methods_away(scopes: &Scopes) -> BTreeMap<String, String> {
    let mut all: BTreeMap<String, Vec<(String, bool)>> = BTreeMap::new();
    for (module, scope) in scopes {
        for (of, name) in &scope.methods {
            let away = match resolve(scopes, module, of, DEPTH) {
                Some(Target::Item(file)) => file != scope.file,
                _ => false,
            };
            all.entry(name.clone()).or_default().push((scope.file.clone(), away));
        }
    }
    all.into_iter()
        .filter(|(_, at)| at.len() == 1 && at[0].1)
        .map(|(name, at)| (name, at[0].0.clone()))
        .collect()
}

/// Cycle among entries of one directory.
#[derive(Debug)]
pub struct Circle {
    /// Directory.
    pub folder: String,
    /// Files and directories (with `/`) in the cycle.
    pub entries: Vec<String>,
    /// Ties: `from -> to: names`.
    pub ties: Vec<String>,
}

impl Circle {
    /// Whether directories, or too many files, are tied.
    pub fn too_large(&self) -> bool {
        self.entries.len() > 3 || self.entries.iter().any(|e| e.ends_with('/'))
    }
}

fn entry(folder: &str, file: &str, folders: &BTreeSet<String>) -> Option<String> {
    let rest = file.strip_prefix(folder)?;
    if rest == ".rs" {
        return file.rsplit('/').next().map(String::from);
    }
    let rest = rest.strip_prefix('/')?;
    let below = rest.split_once('/').map(|(first, _)| first).or_else(|| rest.strip_suffix(".rs"))?;
    let is_folder = folders.contains(&format!("{folder}/{below}"));
    Some(if is_folder { format!("{below}/") } else { rest.to_string() })
}

/// All cycles below a directory, level by level.
pub fn circles(graph: &Graph, folder: &str) -> Vec<Circle> {
    let parent = |file: &str| file.rsplit_once('/').map(|(above, _)| above.to_string());
    let mut folders: BTreeSet<String> = BTreeSet::new();
    for file in graph.keys().flat_map(|(from, to)| [from, to]) {
        folders.extend(std::iter::successors(parent(file), |at| parent(at)));
    }
    let mut found: Vec<Circle> = Vec::new();
    for at in folders.iter().filter(|f| f.starts_with(folder)) {
        found.extend(circles_at(graph, at, &folders));
    }
    found
}

fn circles_at(graph: &Graph, folder: &str, folders: &BTreeSet<String>) -> Vec<Circle> {
    let mut edges = Edges::new();
    let mut ties: Vec<(String, String, String)> = Vec::new();
    for ((from, to), names) in graph {
        let Some((a, b)) = entry(folder, from, folders).zip(entry(folder, to, folders)) else { continue };
        if a != b {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            ties.push((a.clone(), b.clone(), format!("{from} -> {to}: {}", names.join(", "))));
            edges.entry(a).or_default().insert(b);
        }
    }
    let circle = |entries: BTreeSet<String>| {
        let inside = |(a, b, _): &&(String, String, String)| entries.contains(a) && entries.contains(b);
        let ties = ties.iter().filter(inside).map(|t| t.2.clone()).collect();
        Circle { folder: folder.into(), entries: entries.iter().cloned().collect(), ties }
    };
    components(&edges).into_iter().map(circle).collect()
}

/// Sizes of file cycles, ignoring directories.
pub fn files_in_circles(graph: &Graph) -> Vec<usize> {
    let mut edges = Edges::new();
    for (from, to) in graph.keys() {
        edges.entry(from.clone()).or_default().insert(to.clone());
    }
    let mut sizes: Vec<usize> = components(&edges).iter().map(BTreeSet::len).collect();
    sizes.sort_by_key(|size| std::cmp::Reverse(*size));
    sizes
}

/// Strongly connected components of two and more.
fn components(edges: &Edges) -> Vec<BTreeSet<String>> {
    let reached: BTreeMap<&String, BTreeSet<&String>> = edges
        .keys()
        .map(|start| {
            let (mut seen, mut open) = (BTreeSet::new(), vec![start]);
            while let Some(at) = open.pop() {
                open.extend(edges.get(at).into_iter().flatten().filter(|next| seen.insert(*next)));
            }
            (start, seen)
        })
        .collect();
    let mut groups: Vec<BTreeSet<String>> = Vec::new();
    for (start, seen) in &reached {
        if seen.contains(start) && !groups.iter().any(|g| g.contains(*start)) {
            let back = |other: &&&String| reached.get(**other).is_some_and(|r| r.contains(start));
            groups.push(seen.iter().filter(back).map(|s| (*s).clone()).collect());
        }
    }
    groups
}
