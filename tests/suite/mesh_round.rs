//! Round trips of shipped and generated meshes through all pairs of formats.

use super::mesh_forms::FORMS;
use super::support::{Folder, repository};
use std::collections::BTreeMap;
use trackbed::read::{FileMaterial, MeshFile, read_mesh_file};
use trackbed::write::{MeshOptions, write_mesh_file};
use trackbed_fem::ElementKind;
use trackbed_fem::mesh::{Constraint, Mesh};

const MESHES: u64 = 200;

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    fn ids(&mut self, count: usize) -> Vec<u32> {
        let mut ids = Vec::with_capacity(count);
        let mut last = 0;
        for _ in 0..count {
            last += 1 + if self.next() < 0.2 { self.below(9000) as u32 } else { 0 };
            ids.push(last);
        }
        for k in (1..count).rev() {
            if self.next() < 0.5 {
                ids.swap(k, self.below(k + 1));
            }
        }
        ids
    }
}

/// Supported: constraints, node and element sets, face sets, elastic constants.
fn holds(name: &str) -> [bool; 4] {
    match name {
        "mesh.cdb" => [true, true, false, true],
        "mesh.inp" => [true, true, true, true],
        "lists" => [true, false, false, false],
        _ if name.ends_with("msh") => [false, true, true, false],
        _ => [true, true, true, false],
    }
}

fn mesh(random: &mut Random) -> Mesh {
    let counts = [1 + random.below(3), 1 + random.below(2), 1 + random.below(3)];
    let place = |i: usize, j: usize, k: usize| (i + (counts[0] + 1) * (j + (counts[1] + 1) * k)) as u32;
    let mut mesh = Mesh::default();
    for k in 0..=counts[2] {
        for j in 0..=counts[1] {
            for i in 0..=counts[0] {
                let mut shifted = |x: usize| x as f64 + 0.2 * (random.next() - 0.5);
                mesh.coordinates.push([shifted(i), shifted(j), shifted(k)]);
            }
        }
    }
    for k in 0..counts[2] {
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                let [a, b] = [k, k + 1].map(|k| {
                    [place(i, j, k), place(i + 1, j, k), place(i + 1, j + 1, k), place(i, j + 1, k)]
                });
                cell(&mut mesh, random.below(4), [a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3]]);
            }
        }
    }
    mesh.node_ids = (0..mesh.node_count() as u32).collect();
    match random.below(3) {
        0 => {}
        1 => mesh = mesh.to_quadratic(),
        _ => mesh = mixed(&mesh.to_quadratic(), random),
    }
    mesh.node_ids = random.ids(mesh.node_count());
    mesh.element_ids = random.ids(mesh.element_count());
    let materials: &[u32] = [&[1, 1, 2, 7][..], &[0], &[0, 3], &[4_000_000, 12]][random.below(4)];
    mesh.materials = (0..mesh.element_count()).map(|_| materials[random.below(materials.len())]).collect();
    mesh
}

fn cell(mesh: &mut Mesh, kind: usize, n: [u32; 8]) {
    let mut push = |kind, nodes: &[u32]| {
        let id = mesh.element_count() as u32 + 1;
        mesh.push_element(id, 1, kind, nodes);
    };
    match kind {
        0 => push(ElementKind::Hex8, &n),
        1 => {
            push(ElementKind::Wedge6, &[n[0], n[1], n[2], n[4], n[5], n[6]]);
            push(ElementKind::Wedge6, &[n[0], n[2], n[3], n[4], n[6], n[7]]);
        }
        2 => {
            for [a, b] in [[1, 2], [2, 3], [3, 7], [7, 4], [4, 5], [5, 1]] {
                push(ElementKind::Tet4, &[n[0], n[a], n[b], n[6]]);
            }
        }
        _ => {
            let middle = mesh_middle(mesh, n);
            for [a, b, c, d] in
                [[0, 1, 2, 3], [7, 6, 5, 4], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]]
            {
                let id = mesh.element_count() as u32 + 1;
                mesh.push_element(id, 1, ElementKind::Pyramid5, &[n[a], n[b], n[c], n[d], middle]);
            }
        }
    }
}

fn mesh_middle(mesh: &mut Mesh, n: [u32; 8]) -> u32 {
    let x = n.map(|node| mesh.coordinates[node as usize]);
    mesh.coordinates.push([0, 1, 2].map(|d| x.iter().map(|p| p[d]).sum::<f64>() / 8.0));
    mesh.node_count() as u32 - 1
}

fn mixed(mesh: &Mesh, random: &mut Random) -> Mesh {
    let mut mixed = Mesh { coordinates: Vec::new(), ..Mesh::default() };
    let mut index: BTreeMap<u32, u32> = BTreeMap::new();
    for e in 0..mesh.element_count() {
        let kind = mesh.connectivity.kind(e);
        let kind = if random.next() < 0.5 { kind.linear() } else { kind };
        let nodes: Vec<u32> = mesh.connectivity[e][..kind.node_count()]
            .iter()
            .map(|n| {
                *index.entry(*n).or_insert_with(|| {
                    mixed.coordinates.push(mesh.coordinates[*n as usize]);
                    mixed.coordinates.len() as u32 - 1
                })
            })
            .collect();
        mixed.push_element(e as u32 + 1, 1, kind, &nodes);
    }
    mixed
}

const NAMES: [&str; 12] = [
    "base",
    "Bed face",
    "1st",
    "Ä-set",
    "x,y",
    "PK 50%",
    "top",
    "TOP",
    "a_b",
    "a b",
    "MATERIAL_1",
    "part.side",
];

fn generated(seed: u64) -> MeshFile {
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) + 1);
    (0..3).for_each(|_| _ = random.next());
    let mut mesh = mesh(&mut random);
    // Readers drop unused nodes.
    let mut used = vec![false; mesh.node_count()];
    mesh.connectivity.nodes().iter().for_each(|n| used[*n as usize] = true);
    if used.contains(&false) {
        mesh = compact(&mesh, &used);
    }
    let (nodes, elements) = (mesh.node_count(), mesh.element_count());
    let mut file = MeshFile { mesh, ..MeshFile::default() };
    for name in NAMES {
        let mut members = |count: usize, share: f64| {
            // Consecutive ids, so that ranges span rows.
            let start = random.below(count);
            let mut set: Vec<u32> =
                (start..count).filter(|_| random.next() < share).map(|n| n as u32).collect();
            set.truncate(40);
            set
        };
        let (of_nodes, of_elements) = (members(nodes, 0.9), members(elements, 0.6));
        match random.below(4) {
            0 if !of_nodes.is_empty() => drop(file.node_sets.insert(name.into(), of_nodes)),
            1 if !of_elements.is_empty() => drop(file.element_sets.insert(name.into(), of_elements)),
            2 => faces(&mut file, name, &mut random),
            _ => {}
        }
    }
    for node in 0..nodes as u32 {
        for direction in 0..3 {
            if random.next() < 0.1 {
                let value = if random.next() < 0.5 { 0.0 } else { (random.next() - 0.5) * 1e-3 };
                file.constraints.push(Constraint { node, direction, value });
            }
        }
    }
    for number in file.mesh.materials.clone() {
        let density = (random.next() < 0.5).then(|| 1000.0 + random.next());
        let constants =
            FileMaterial { young: 1e9 * random.next() + 1.0, poisson: 0.3 * random.next(), density };
        if random.next() < 0.3 {
            file.materials.insert(number, constants);
        }
    }
    file
}

fn faces(file: &mut MeshFile, name: &str, random: &mut Random) {
    let boundary = file.mesh.boundary_faces();
    let chosen = boundary.iter().filter(|_| random.next() < 0.4);
    let set: Vec<[u32; 2]> = chosen.map(|f| [f.element, u32::from(f.side)]).collect();
    if set.is_empty() {
        return;
    }
    let mut nodes: Vec<u32> =
        set.iter().flat_map(|[e, s]| file.mesh.face(*e as usize, *s as usize).nodes().to_vec()).collect();
    nodes.sort_unstable();
    nodes.dedup();
    file.face_sets.insert(name.into(), set);
    file.node_sets.insert(name.into(), nodes);
}

fn compact(mesh: &Mesh, used: &[bool]) -> Mesh {
    let mut index = vec![0; used.len()];
    let mut kept = Mesh { materials: Vec::new(), ..Mesh::default() };
    for (n, _) in used.iter().enumerate().filter(|(_, used)| **used) {
        index[n] = kept.node_ids.len() as u32;
        kept.node_ids.push(mesh.node_ids[n]);
        kept.coordinates.push(mesh.coordinates[n]);
    }
    for e in 0..mesh.element_count() {
        let nodes: Vec<u32> = mesh.connectivity[e].iter().map(|n| index[*n as usize]).collect();
        kept.push_element(mesh.element_ids[e], mesh.materials[e], mesh.connectivity.kind(e), &nodes);
    }
    kept
}

/// Some formats change set names.
fn contents<T: Clone + Ord>(sets: &BTreeMap<String, Vec<T>>) -> Vec<Vec<T>> {
    let mut all: Vec<Vec<T>> = sets.values().cloned().collect();
    all.sort();
    all
}

fn compare(name: &str, file: &MeshFile, back: &MeshFile, [constraints, sets, faces, materials]: [bool; 4]) {
    assert_eq!(back.mesh, file.mesh, "{name}");
    let sorted = |file: &MeshFile| {
        let mut all: Vec<(u32, u8, f64)> =
            file.constraints.iter().map(|c| (c.node, c.direction, c.value)).collect();
        all.sort_by_key(|c| (c.0, c.1));
        all
    };
    assert_eq!(sorted(back), if constraints { sorted(file) } else { Vec::new() }, "{name}");
    if sets {
        assert_eq!(contents(&back.node_sets), contents(&file.node_sets), "{name}");
        assert_eq!(contents(&back.element_sets), contents(&file.element_sets), "{name}");
    }
    if faces {
        assert_eq!(contents(&back.face_sets), contents(&file.face_sets), "{name}");
    }
    if materials {
        assert_eq!(back.materials, file.materials, "{name}");
    }
}

fn round(folder: &Folder, label: &str, file: &MeshFile, first: usize, then: &[usize]) {
    let pass = |file: &MeshFile, form: usize| {
        let (name, msh2) = FORMS[form];
        let path = folder.join(name);
        write_mesh_file(&path, file, MeshOptions { msh2 }).unwrap_or_else(|e| panic!("{label} {name}: {e}"));
        read_mesh_file(&path).unwrap_or_else(|e| panic!("{label} {name}: {e}"))
    };
    let one = pass(file, first);
    let held = holds(FORMS[first].0);
    compare(&format!("{label} {}", FORMS[first].0), file, &one, held);
    for &second in then {
        let both = [0, 1, 2, 3].map(|k| held[k] && holds(FORMS[second].0)[k]);
        let name = format!("{label} {} {}", FORMS[first].0, FORMS[second].0);
        compare(&name, file, &pass(&one, second), both);
    }
}

#[test]
fn generated_meshes_round_trip() {
    let folder = Folder::new("round");
    let mut kinds = std::collections::BTreeSet::new();
    for seed in 0..MESHES {
        let file = generated(seed);
        kinds.extend(file.mesh.connectivity.kinds().iter().map(|kind| kind.name()));
        for first in 0..FORMS.len() {
            round(&folder, &format!("seed {seed}"), &file, first, &[(first + seed as usize) % FORMS.len()]);
        }
    }
    assert_eq!(kinds.len(), 8, "{kinds:?}");
}

#[test]
fn meshes_of_inputs_pass_every_form() {
    let folder = Folder::new("round_inputs");
    for name in [
        "solid/cylinder/cylinder.inp",
        "coupled/embankment_tet10/embankment.msh",
        "coupled/slab_mixed/slab.inp",
        "verify/cavity/octant.inp",
        "track/cyclic",
        "track/bay",
    ] {
        let mut file = read_mesh_file(&repository().join("inputs").join(name)).unwrap();
        file.warnings.clear();
        let first = file.mesh.element_volume(0);
        assert!(first > 0.0, "{name}");
        for form in 0..FORMS.len() {
            round(&folder, name, &file, form, &[(form + 1) % FORMS.len()]);
        }
    }
}
