//! Tables and small models of the elastoplastic cases. The tables are in `fem/tests/data/plasticity_fe`; each folder's
//! `case.json` tells how they were made.

use std::collections::BTreeMap;
use std::path::PathBuf;
use trackbed_fem::nonlinear::{NewtonOptions, Variant};
use trackbed_fem::{
    Cone, Constraint, DruckerPrager, Elastic, ElementKind, Material, Mesh, Model, ModelInput, MohrCoulomb,
    Quadrature,
};

/// Numbers of a table, split at commas and blanks; lines that do not start with a number are left out.
pub fn table(case: &str, file: &str) -> Vec<Vec<f64>> {
    let path: PathBuf =
        [env!("CARGO_MANIFEST_DIR"), "tests", "data", "plasticity_fe", case, file].iter().collect();
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    text.lines()
        .filter_map(|line| line.split([',', ' ']).filter(|f| !f.is_empty()).map(|f| f.parse().ok()).collect())
        .filter(|row: &Vec<f64>| !row.is_empty())
        .collect()
}

/// The mesh and the constraints of a case.
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

/// Mohr–Coulomb without tension cut-off; angles in degrees.
pub fn mohr_coulomb(elastic: Elastic, c: f64, phi: f64, psi: f64) -> Material {
    Material::plastic(
        elastic,
        MohrCoulomb {
            cohesion: c.into(),
            friction: phi.to_radians().into(),
            dilation: psi.to_radians(),
            tension: None,
        },
    )
}

/// Drucker–Prager without cap; angles in degrees.
pub fn drucker_prager(elastic: Elastic, c: f64, phi: f64, psi: f64, cone: Cone) -> Material {
    Material::plastic(
        elastic,
        DruckerPrager {
            cohesion: c.into(),
            friction: phi.to_radians().into(),
            dilation: psi.to_radians(),
            cone,
            tension: None,
        },
    )
}

/// A model of one material, without gravity.
pub fn model(mesh: Mesh, constraints: Vec<Constraint>, material: Material, quadrature: Quadrature) -> Model {
    let materials: BTreeMap<u32, Material> = [(1, material)].into();
    Model::new(ModelInput { mesh, materials, quadrature, constraints, ..Default::default() }).unwrap()
}

/// Full Newton with tight tolerances.
pub fn tight() -> NewtonOptions {
    NewtonOptions { force_tolerance: 1e-10, energy_tolerance: 1e-12, ..NewtonOptions::new(Variant::Full) }
}
