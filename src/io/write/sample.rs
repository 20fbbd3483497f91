use super::body_fields::BODY_FIELDS;
use super::frame::{GrainFrame, NodalValues, SolidFrame, Values};
use super::solid_fields::SOLID_FIELDS;
pub use crate::scratch::folder;
use std::collections::BTreeMap;
use trackbed_fem::ElementKind;
use trackbed_fem::mesh::Mesh;

pub fn grains(count: usize, vector: impl Fn(usize) -> [f64; 3]) -> GrainFrame {
    let vectors = || (0..count).map(&vector).collect::<Vec<_>>();
    let values = |name: &str| match name {
        "radius" => Values::Numbers(vec![0.02; count]),
        "mean_stress" => Values::Numbers(vec![-2.0e3; count]),
        "orientation" => Values::Quaternions(vec![[0.5; 4]; count]),
        "id" => Values::Counts((0..count as u32).collect()),
        "part" | "fragment" => Values::Counts(vec![1; count]),
        "coordination" => Values::Counts(vec![6; count]),
        _ => Values::Vectors(vectors()),
    };
    let written = BODY_FIELDS.iter().filter(|field| field.written.needs().is_none());
    let fields = written.map(|field| (field.name, values(field.name))).collect();
    GrainFrame { position: vectors(), fields }
}

/// Solid with these values in the default fields of each kind.
pub fn solid<'a>(
    mesh: &'a Mesh,
    vector: &'a [f64],
    stress: &'a [[f64; 6]],
    scalar: &'a [f64],
) -> SolidFrame<'a> {
    let values = |name: &str| match name {
        "displacement" | "velocity" => NodalValues::Vectors(vector.into()),
        "stress" => NodalValues::Tensors(stress.into()),
        _ => NodalValues::Numbers(scalar.into()),
    };
    let written = SOLID_FIELDS.iter().filter(|field| field.written.needs().is_none());
    SolidFrame { mesh, fields: written.map(|field| (field.name, values(field.name))).collect() }
}

/// The frame with another field of this name.
pub fn with<'a>(frame: &SolidFrame<'a>, name: &'static str, values: NodalValues<'a>) -> SolidFrame<'a> {
    let mut frame = frame.clone();
    match frame.fields.iter_mut().find(|field| field.0 == name) {
        Some(field) => field.1 = values,
        None => frame.fields.push((name, values)),
    }
    frame
}

const LATTICE: [[usize; 3]; 20] = [
    [0, 0, 0],
    [2, 0, 0],
    [2, 2, 0],
    [0, 2, 0],
    [0, 0, 2],
    [2, 0, 2],
    [2, 2, 2],
    [0, 2, 2],
    [1, 0, 0],
    [2, 1, 0],
    [1, 2, 0],
    [0, 1, 0],
    [1, 0, 2],
    [2, 1, 2],
    [1, 2, 2],
    [0, 1, 2],
    [0, 0, 1],
    [2, 0, 1],
    [2, 2, 1],
    [0, 2, 1],
];

/// Block of `n[0]` x `n[1]` x `n[2]` unit elements in three material layers.
pub fn straight_block(n: [usize; 3]) -> Mesh {
    mapped_block(n, |p| p)
}

/// As `straight_block`, curved and distorted without symmetry.
pub fn block(n: [usize; 3]) -> Mesh {
    mapped_block(n, |[x, y, z]| {
        [
            x + 0.11 * libm::sin(1.3 * y + 0.4) + 0.07 * z * z / (1.0 + z),
            1.2 * y + 0.09 * libm::cos(1.7 * x + 0.8 * z),
            0.8 * z + 0.05 * x * y / (1.0 + x) + 0.06 * libm::sin(2.1 * x - y),
        ]
    })
}

fn mapped_block(n: [usize; 3], map: impl Fn([f64; 3]) -> [f64; 3]) -> Mesh {
    let mut index: BTreeMap<[usize; 3], u32> = BTreeMap::new();
    for i in 0..=2 * n[0] {
        for j in 0..=2 * n[1] {
            for k in 0..=2 * n[2] {
                if i % 2 + j % 2 + k % 2 <= 1 {
                    let next = index.len() as u32;
                    index.insert([i, j, k], next);
                }
            }
        }
    }
    let mut mesh = Mesh::default();
    for (p, at) in &index {
        mesh.node_ids.push(3 * at + 7);
        mesh.coordinates.push(map(p.map(|c| 0.5 * c as f64)));
    }
    for k in 0..n[2] {
        for j in 0..n[1] {
            for i in 0..n[0] {
                let nodes = LATTICE.map(|l| index[&[2 * i + l[0], 2 * j + l[1], 2 * k + l[2]]]);
                let (id, material) = (1000 - mesh.element_count() as u32, 1 + (3 * k / n[2]) as u32);
                mesh.push_element(id, material, ElementKind::Hex20, &nodes);
            }
        }
    }
    mesh
}
