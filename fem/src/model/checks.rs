//! Checks of mesh and materials before assembly.

use crate::element::quadrature::Quadrature;
use crate::element::{mass_points, stiffness_points};
use crate::error::ModelError;
use crate::kinematics::jacobian;
use crate::material::Material;
use crate::mesh::Mesh;
use std::collections::BTreeMap;

pub(super) fn check_mesh(mesh: &Mesh) -> Result<(), ModelError> {
    let (nodes, elements) = (mesh.node_count(), mesh.element_count());
    for (what, count) in [("nodes", nodes), ("elements", elements)] {
        if count == 0 {
            return Err(ModelError::EmptyMesh { what });
        }
    }
    for (what, found, expected) in [
        ("node numbers", mesh.node_ids.len(), nodes),
        ("element numbers", mesh.element_ids.len(), elements),
        ("element materials", mesh.materials.len(), elements),
    ] {
        if found != expected {
            return Err(ModelError::Length { what, found, expected });
        }
    }
    if let Some(n) = mesh.coordinates.iter().position(|c| c.iter().any(|x| !x.is_finite())) {
        return Err(ModelError::Coordinate { node: mesh.node_ids[n] });
    }
    let mut used = vec![false; nodes];
    for (e, connectivity) in mesh.connectivity.iter().enumerate() {
        let element = mesh.element_ids[e];
        for (a, &n) in connectivity.iter().enumerate() {
            let Some(used) = used.get_mut(n as usize) else {
                return Err(ModelError::NodeRange { element, index: n, nodes });
            };
            *used = true;
            if connectivity[..a].contains(&n) {
                let kind = mesh.connectivity.kind(e);
                let node = mesh.node_ids[n as usize];
                return Err(ModelError::RepeatedNode {
                    element,
                    node,
                    kind: kind.name(),
                    nodes: kind.node_count(),
                });
            }
        }
    }
    match used.iter().position(|used| !used) {
        Some(n) => Err(ModelError::UnusedNode { node: mesh.node_ids[n] }),
        None => Ok(()),
    }
}

pub(super) fn check_materials(mesh: &Mesh, materials: &BTreeMap<u32, Material>) -> Result<(), ModelError> {
    for (&material, constants) in materials {
        if let Some((constant, value, expected)) = constants.invalid_constant() {
            return Err(ModelError::MaterialConstant { material, constant, value, expected });
        }
    }
    match mesh.materials.iter().position(|m| !materials.contains_key(m)) {
        Some(e) => {
            Err(ModelError::MissingMaterial { element: mesh.element_ids[e], material: mesh.materials[e] })
        }
        None => Ok(()),
    }
}

pub(super) fn point_start(mesh: &Mesh, rule: Quadrature) -> Vec<u32> {
    let mut start = vec![0];
    let mut count = 0;
    for &kind in mesh.connectivity.kinds() {
        count += stiffness_points(kind, rule).len() as u32;
        start.push(count);
    }
    start
}

pub(super) fn value_start(mesh: &Mesh, rule: Quadrature, materials: &BTreeMap<u32, Material>) -> Vec<u32> {
    let mut start = vec![0];
    let mut count = 0;
    for (kind, number) in mesh.connectivity.kinds().iter().zip(&mesh.materials) {
        let values = materials[number].law.state_values().len();
        count += (values * stiffness_points(*kind, rule).len()) as u32;
        start.push(count);
    }
    start
}

pub(super) fn check_shape(mesh: &Mesh, rule: Quadrature) -> Result<(), ModelError> {
    for e in 0..mesh.element_count() {
        let (x, kind) = (mesh.element_coordinates(e), mesh.connectivity.kind(e));
        for point in mass_points(kind).iter().chain(stiffness_points(kind, rule)) {
            let determinant = jacobian(&x, &point.gradients).1;
            if determinant.is_nan() || determinant <= 0.0 {
                return Err(ModelError::Inverted {
                    element: mesh.element_ids[e],
                    point: point.xi,
                    determinant,
                });
            }
        }
    }
    Ok(())
}
