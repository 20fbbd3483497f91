//! Common content of mesh files, and its builder.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};

use trackbed_fem::ElementKind;
use trackbed_fem::mesh::{Constraint, Mesh};

use super::error::ReadError;
use super::faces::Faces;
use super::source;

/// Content of a mesh file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshFile {
    /// Nodes and volume elements in file order, without unused nodes.
    pub mesh: Mesh,
    /// Constraints in file order, one per node and direction.
    pub constraints: Vec<Constraint>,
    /// Whether the format cannot contain constraints.
    pub no_constraints: bool,
    /// Node indices of named sets, ascending.
    pub node_sets: BTreeMap<String, Vec<u32>>,
    /// Element indices of named sets, ascending.
    pub element_sets: BTreeMap<String, Vec<u32>>,
    /// Element index and face of `ElementKind::faces`, ascending. A node set has the same name.
    pub face_sets: BTreeMap<String, Vec<[u32; 2]>>,
    /// Elastic constants by material id, if given.
    pub materials: BTreeMap<u32, FileMaterial>,
    /// Element types with counts, in file order.
    pub element_types: Vec<(String, usize)>,
    /// Guesses, omissions and likely mistakes, one sentence each.
    pub warnings: Vec<String>,
    /// Stated length unit other than metres, as the error without `solid.scale`.
    pub unit: Option<Box<ReadError>>,
}

/// Largest coordinate: keeps volumes and their products finite.
pub const FARTHEST: f64 = 1e15;
pub(super) const FARTHEST_EXPECTED: &str = "coordinates up to 1e15";

/// Linear elastic constants, in file units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FileMaterial {
    /// Young's modulus [Pa].
    pub young: f64,
    /// Poisson's ratio [1].
    pub poisson: f64,
    /// Density [kg/m³].
    pub density: Option<f64>,
}

pub(super) struct Builder {
    pub file: PathBuf,
    /// Content so far.
    pub made: MeshFile,
    nodes: HashMap<u32, u32>,
    elements: HashMap<u32, u32>,
    given: HashMap<(u32, u8), (f64, usize)>,
    left_out: BTreeMap<String, usize>,
}

impl Builder {
    pub fn new(file: &Path) -> Builder {
        Builder {
            file: file.to_path_buf(),
            made: MeshFile::default(),
            nodes: HashMap::new(),
            elements: HashMap::new(),
            given: HashMap::new(),
            left_out: BTreeMap::new(),
        }
    }

    pub fn fault(
        &self,
        line: usize,
        key: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> ReadError {
        if line == 0 {
            return ReadError::whole(&self.file, key, found, expected);
        }
        ReadError::at(&self.file, line, key, found, expected)
    }

    pub fn warn(&mut self, sentence: impl AsRef<str>) {
        self.made.warnings.push(format!("{}: {}", self.file.display(), sentence.as_ref()));
    }

    /// Adds a node; `line` is 0 if unknown.
    pub fn node(&mut self, line: usize, id: u32, point: [f64; 3]) -> Result<(), ReadError> {
        if let Some(x) = point.iter().find(|x| !x.is_finite()) {
            return Err(self.fault(
                line,
                format!("coordinates of node {id}"),
                x.to_string(),
                "finite numbers",
            ));
        }
        if let Some(x) = point.iter().find(|x| x.abs() > FARTHEST) {
            let key = format!("coordinates of node {id}");
            return Err(self.fault(line, key, format!("{x:e}"), FARTHEST_EXPECTED));
        }
        if self.nodes.insert(id, self.made.mesh.node_ids.len() as u32).is_some() {
            return Err(self.fault(line, format!("node {id}"), "it again", "each number once"));
        }
        self.made.mesh.node_ids.push(id);
        self.made.mesh.coordinates.push(point);
        Ok(())
    }

    pub fn node_index(&self, id: u32) -> Option<u32> {
        self.nodes.get(&id).copied()
    }

    pub fn element_index(&self, id: u32) -> Option<u32> {
        self.elements.get(&id).copied()
    }

    /// Adds an element by node ids in kind order.
    pub fn element(
        &mut self,
        line: usize,
        id: u32,
        material: u32,
        (kind, type_name): (ElementKind, &str),
        ids: &[u32],
    ) -> Result<(), ReadError> {
        if ids.len() != kind.node_count() {
            let key = format!("nodes of element {id}");
            return Err(self.fault(line, key, ids.len().to_string(), kind.node_count().to_string()));
        }
        let mut nodes = Vec::with_capacity(ids.len());
        for node in ids {
            let Some(index) = self.node_index(*node) else {
                let key = format!("element {id}");
                return Err(self.fault(line, key, format!("node {node}"), "a node of the file"));
            };
            nodes.push(index);
        }
        let mut sorted = nodes.clone();
        sorted.sort_unstable();
        if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            let node = self.made.mesh.node_ids[pair[0] as usize];
            let expected = format!("{} different nodes", kind.node_count());
            return Err(self.fault(
                line,
                format!("element {id}"),
                format!("node {node} more than once"),
                expected,
            ));
        }
        if self.elements.insert(id, self.made.mesh.element_ids.len() as u32).is_some() {
            return Err(self.fault(line, format!("element {id}"), "it again", "each number once"));
        }
        self.made.mesh.push_element(id, material, kind, &nodes);
        let types = &mut self.made.element_types;
        match types.iter_mut().find(|(name, _)| name == type_name) {
            Some((_, count)) => *count += 1,
            None => types.push((type_name.to_string(), 1)),
        }
        Ok(())
    }

    pub fn leave_out(&mut self, type_name: &str) {
        *self.left_out.entry(type_name.to_string()).or_insert(0) += 1;
    }

    /// Adds a constraint; duplicates must have the same value.
    pub fn constrain(&mut self, line: usize, node: u32, direction: u8, value: f64) -> Result<(), ReadError> {
        let id = self.made.mesh.node_ids[node as usize];
        let key = || format!("constraint of node {id} in {}", ["x", "y", "z"][direction as usize]);
        if !value.is_finite() {
            return Err(self.fault(line, key(), value.to_string(), "a finite number"));
        }
        match self.given.insert((node, direction), (value, line)) {
            None => self.made.constraints.push(Constraint { node, direction, value }),
            Some((first, _)) if first == value => {}
            Some((first, before)) => {
                let found = format!("{value} after {first} on line {before}");
                return Err(self.fault(line, key(), found, "one value"));
            }
        }
        Ok(())
    }

    pub fn node_set(&mut self, name: &str, nodes: impl IntoIterator<Item = u32>) {
        self.made.node_sets.entry(name.to_string()).or_default().extend(nodes);
    }

    pub fn element_set(&mut self, name: &str, elements: impl IntoIterator<Item = u32>) {
        self.made.element_sets.entry(name.to_string()).or_default().extend(elements);
    }

    pub fn face_set(&mut self, name: &str, faces: impl IntoIterator<Item = [u32; 2]>) {
        self.made.face_sets.entry(name.to_string()).or_default().extend(faces);
    }

    /// Drops unused nodes and sorts sets. A file without volume elements is rejected.
    pub fn finish(mut self) -> Result<MeshFile, ReadError> {
        for (name, count) in std::mem::take(&mut self.left_out) {
            self.warn(format!("{count} elements of type {name} are left out"));
        }
        if self.made.mesh.element_count() == 0 {
            let nodes = self.made.mesh.node_count();
            let types = self.made.warnings.iter().filter(|w| w.contains("left out")).cloned();
            let types: Vec<String> = types.collect();
            let found = match types.is_empty() {
                true => format!("{nodes} nodes and no volume element"),
                false => format!("{nodes} nodes and no volume element ({})", types.join("; ")),
            };
            return Err(self.fault(0, "elements", found, "at least one volume element"));
        }
        check_faces(&self.file, &self.made.mesh)?;
        let MeshFile { mesh, constraints, node_sets, element_sets, face_sets, warnings, .. } = &mut self.made;
        for (name, faces) in face_sets {
            faces.sort_unstable();
            faces.dedup();
            let nodes = faces.iter().flat_map(|[e, side]| {
                let face = mesh.face(*e as usize, *side as usize);
                face.nodes().to_vec()
            });
            if !node_sets.contains_key(name) {
                node_sets.insert(name.clone(), nodes.collect());
            }
        }
        for set in node_sets.values_mut().chain(element_sets.values_mut()) {
            set.sort_unstable();
            set.dedup();
        }
        drop_unused_nodes(&self.file, mesh, constraints, node_sets, warnings);
        Ok(self.made)
    }
}

/// Rejects overlapping elements.
pub(super) fn check_faces(file: &Path, mesh: &Mesh) -> Result<(), ReadError> {
    match Faces::of(mesh).fault(mesh) {
        None => Ok(()),
        Some((key, found, expected)) => Err(ReadError::whole(file, key, found, expected)),
    }
}

/// Drops unused nodes and their constraints; meshing often leaves nodes without stiffness.
pub(super) fn drop_unused_nodes(
    file: &Path,
    mesh: &mut Mesh,
    constraints: &mut Vec<Constraint>,
    node_sets: &mut BTreeMap<String, Vec<u32>>,
    warnings: &mut Vec<String>,
) {
    let mut used = vec![false; mesh.node_count()];
    for node in mesh.connectivity.nodes() {
        used[*node as usize] = true;
    }
    let unused: Vec<u32> =
        used.iter().zip(&mesh.node_ids).filter(|(used, _)| !**used).map(|(_, id)| *id).collect();
    if unused.is_empty() {
        return;
    }
    let mut next = 0;
    let renumbered: Vec<u32> = used
        .iter()
        .map(|used| {
            next += u32::from(*used);
            next.wrapping_sub(1)
        })
        .collect();
    let mut keep = used.iter();
    mesh.node_ids.retain(|_| keep.next().copied().unwrap_or(false));
    let mut keep = used.iter();
    mesh.coordinates.retain(|_| keep.next().copied().unwrap_or(false));
    for node in mesh.connectivity.nodes_mut() {
        *node = renumbered[*node as usize];
    }
    constraints.retain(|c| used[c.node as usize]);
    for constraint in constraints {
        constraint.node = renumbered[constraint.node as usize];
    }
    for set in node_sets.values_mut() {
        set.retain(|node| used[*node as usize]);
        set.iter_mut().for_each(|node| *node = renumbered[*node as usize]);
    }
    let shown = unused.iter().take(5).map(u32::to_string).collect::<Vec<_>>().join(", ");
    let sentence = match unused.len() {
        1 => format!("node {shown} belongs to no element and is left out"),
        count if count <= 5 => format!("{count} nodes belong to no element and are left out: {shown}"),
        count => format!("{count} nodes belong to no element and are left out: {shown}, …"),
    };
    warnings.push(format!("{}: {sentence}", file.display()));
}

/// Bytes of a file; `what` names the content in messages.
pub(super) fn read_bytes(file: &Path, what: &str) -> Result<Vec<u8>, ReadError> {
    source::bytes(file, source::LARGEST).map_err(|refusal| {
        let (found, expected) = refusal.words(|error| match error.kind() {
            std::io::ErrorKind::NotFound => "no such file".to_string(),
            _ => format!("that it cannot be read ({error})"),
        });
        ReadError::whole(file, what, found, expected)
    })
}

pub(super) fn read_text(file: &Path, what: &str) -> Result<String, ReadError> {
    let text = String::from_utf8_lossy(&read_bytes(file, what)?).into_owned();
    Ok(text.strip_prefix('\u{feff}').map(str::to_string).unwrap_or(text))
}
