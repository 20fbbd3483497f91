//! Supports and absorbing boundaries resolved.

use super::common::time_function;
use super::geometry::Geometry;
use super::selection;
use crate::scene::history::TimeFunction;
use crate::scene::solid::{Solid, Support};
use crate::scene::{SceneError, Table};
use std::collections::BTreeMap;
use trackbed_fem::boundary::{BoundaryLayer, SpringFactors};
use trackbed_fem::material::Material;
use trackbed_fem::mesh::{Constraint, Mesh};

/// Supports of scene and mesh file.
pub struct Supports {
    /// Constraints with displacements at time 0.
    pub constraints: Vec<Constraint>,
    /// Moving supports by dof (`3 * node + direction`): displacement [m], time history.
    pub moving: BTreeMap<u32, (f64, TimeFunction)>,
    /// Named supports and their dofs.
    pub named: Vec<(String, Vec<u32>)>,
}

/// Resolves `[[solid.support]]`.
///
/// # Errors
/// Missing, contradictory or conflicting keys.
pub fn supports(solid: &Table<Solid>, geometry: &Geometry) -> Result<Supports, SceneError> {
    let mut all =
        Supports { constraints: geometry.constraints.clone(), moving: BTreeMap::new(), named: Vec::new() };
    // Displacement and scene support; none for the mesh file.
    let mut given: BTreeMap<u32, (f64, Option<usize>)> =
        all.constraints.iter().map(|c| (3 * c.node + u32::from(c.direction), (c.value, None))).collect();
    for (i, s) in solid.rows("support", &solid.support).enumerate() {
        let nodes = selection::nodes(&s, geometry)?;
        let directions = directions(&s)?;
        let value = s.displacement.map_or(0.0, |d| d.si);
        let function = time_function(s.optional("history", &s.history))?;
        if s.history.is_some() && value == 0.0 {
            return Err(s.no_effect("history", "a `displacement` other than 0"));
        }
        let mut dofs = Vec::new();
        for &node in &nodes {
            for &direction in &directions {
                let dof = 3 * node + u32::from(direction);
                dofs.push(dof);
                let start = value * function.factor(0.0);
                if let Some(&(other, by)) = given.get(&dof) {
                    let moves = s.history.is_some() || all.moving.contains_key(&dof);
                    if moves || other != value {
                        let id = geometry.mesh.node_ids[node as usize];
                        let axis = ["x", "y", "z"][direction as usize];
                        let first =
                            by.map_or("the mesh file".into(), |k| solid.path(&format!("support.{k}")));
                        let found = format!("node {id} in {axis}, which {first} holds already");
                        return Err(s.here(found, "one time history for each direction of a node"));
                    }
                } else {
                    given.insert(dof, (value, Some(i)));
                    all.constraints.push(Constraint { node, direction, value: start });
                    if s.history.is_some() {
                        all.moving.insert(dof, (value, function.clone()));
                    }
                }
            }
        }
        if let Some(name) = &s.name {
            if name.is_empty() || name.contains([',', '"', '\n']) {
                let expected = "a name without commas or quotes";
                return Err(s.error("name", format!("\"{name}\""), expected));
            }
            match all.named.iter_mut().find(|(n, _)| n == name) {
                Some((_, known)) => {
                    known.extend(dofs);
                    known.sort_unstable();
                    known.dedup();
                }
                None => all.named.push((name.clone(), dofs)),
            }
        }
    }
    Ok(all)
}

fn directions(s: &Table<Support>) -> Result<Vec<u8>, SceneError> {
    let wrong = |found: String| s.error("directions", found, "one or more of \"x\", \"y\", \"z\", each once");
    let mut directions = Vec::new();
    for name in &s.directions {
        let direction =
            ["x", "y", "z"].iter().position(|d| d == name).ok_or_else(|| wrong(format!("\"{name}\"")))? as u8;
        if directions.contains(&direction) {
            return Err(wrong(format!("\"{name}\" again")));
        }
        directions.push(direction);
    }
    if directions.is_empty() { Err(wrong("none".into())) } else { Ok(directions) }
}

/// Resolves `[[solid.absorbing]]`: a layer per material.
///
/// # Errors
/// No face, or a factor out of range.
pub fn absorbing(
    solid: &Table<Solid>,
    geometry: &Geometry,
    materials: &BTreeMap<u32, Material>,
) -> Result<Vec<BoundaryLayer>, SceneError> {
    let mesh: &Mesh = &geometry.mesh;
    let mut layers = Vec::new();
    for a in solid.rows("absorbing", &solid.absorbing) {
        let faces = selection::faces(&a, geometry, None, a.faces_in, a.side, a.set.as_deref())?;
        for (key, factor) in [("normal", a.normal), ("tangential", a.tangential)] {
            a.check(key, factor, |f| f >= 0.0, "0 or more")?;
        }
        a.check("radius", a.radius, |r| r > 0.0, "a distance above 0")?;
        let mut by_material: BTreeMap<u32, Vec<_>> = BTreeMap::new();
        for face in faces {
            by_material.entry(mesh.materials[face.element as usize]).or_default().push(face);
        }
        for (number, faces) in by_material {
            let Some(material) = materials.get(&number) else { continue };
            let elastic = &material.elastic;
            let mut layer = match a.radius {
                Some(r) => BoundaryLayer::viscous_spring(faces, elastic, r.si, SpringFactors::SPATIAL),
                None => BoundaryLayer::absorbing(faces, elastic),
            };
            layer.dashpot_normal *= a.normal;
            layer.dashpot_tangential *= a.tangential;
            layers.push(layer);
        }
    }
    Ok(layers)
}
