//! Table readers, random numbers and small models.

use std::collections::BTreeMap;
use std::path::Path;
use trackbed_fem::ElementKind;
use trackbed_fem::element::quadrature::Quadrature;
use trackbed_fem::material::{Elastic, Material};
use trackbed_fem::mesh::{Constraint, Mesh};
use trackbed_fem::model::{Model, ModelInput};

/// Numbers in [-1, 1): linear congruential generator (Knuth's constants).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    pub fn point(&mut self) -> [f64; 3] {
        [self.next(), self.next(), self.next()]
    }
}

const FOLDERS: [&str; 2] = ["../tests/data/fem", "tests/data/plasticity_fe"];

/// Numbers separated by commas or blanks; other lines are skipped.
pub fn table(case: &str, file: &str) -> Vec<Vec<f64>> {
    let folders = FOLDERS.map(|f| Path::new(env!("CARGO_MANIFEST_DIR")).join(f).join(case));
    let folder = folders.iter().find(|f| f.is_dir()).unwrap_or_else(|| panic!("no folder of {case}"));
    let path = folder.join(file);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    text.lines()
        .filter_map(|line| line.split([',', ' ']).filter(|f| !f.is_empty()).map(|f| f.parse().ok()).collect())
        .filter(|row: &Vec<f64>| !row.is_empty())
        .collect()
}

pub fn read_mesh(case: &str) -> (Mesh, Vec<Constraint>) {
    let mut mesh = Mesh::default();
    for row in table(case, "NODECOORD.DAT") {
        mesh.node_ids.push(row[0] as u32);
        mesh.coordinates.push([row[1], row[2], row[3]]);
    }
    for row in table(case, "ELEMENTNUM.DAT") {
        let nodes: [u32; 20] = std::array::from_fn(|a| row[2 + a] as u32 - 1);
        mesh.push_element(row[0] as u32, row[1] as u32, ElementKind::Hex20, &nodes);
    }
    let constraints = table(case, "DOF.DAT")
        .iter()
        .map(|row| Constraint { node: row[0] as u32 - 1, direction: row[1] as u8 - 1, value: row[2] })
        .collect();
    (mesh, constraints)
}

/// Soils of the embankment and the column.
pub fn soils() -> BTreeMap<u32, Material> {
    let soil = |young, poisson, density| Elastic { young, poisson, density }.into();
    [(1, soil(60e6, 0.35, 1900.0)), (2, soil(110e6, 0.3, 2000.0)), (3, soil(180e6, 0.25, 2100.0))].into()
}

/// Model without gravity and damping.
pub fn model(
    mesh: Mesh,
    constraints: Vec<Constraint>,
    material: impl Into<Material>,
    quadrature: Quadrature,
) -> Model {
    Model::new(ModelInput {
        mesh,
        materials: [(1, material.into())].into(),
        quadrature,
        constraints,
        gravity: [0.0; 3],
        ..Default::default()
    })
    .unwrap()
}

pub fn fix(mesh: &Mesh, directions: &[u8], chosen: impl Fn([f64; 3]) -> bool) -> Vec<Constraint> {
    (0..mesh.node_count() as u32)
        .filter(|&n| chosen(mesh.coordinates[n as usize]))
        .flat_map(|node| directions.iter().map(move |&direction| Constraint { node, direction, value: 0.0 }))
        .collect()
}

/// Largest difference over the largest entry of `b`.
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let size = b.iter().fold(0.0, |m: f64, b| m.max(b.abs()));
    a.iter().zip(b).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / size
}
