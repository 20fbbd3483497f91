//! Materials of the solid, resolved.

use crate::scene::solid::{MaterialFault, Solid};
use crate::scene::{Document, SceneError};
use std::collections::BTreeMap;
use trackbed_fem::material::Material;

/// Materials of a solid by number, and their names for reports.
pub struct Materials {
    /// Constants.
    pub constants: BTreeMap<u32, Material>,
    /// Names.
    pub names: BTreeMap<u32, String>,
    /// Horizontal over vertical initial stress, where a material has its own.
    pub k0: BTreeMap<u32, f64>,
}

/// Resolves `[[solid.material]]`.
///
/// # Errors
/// A constant is missing, out of range, or not one of the model.
pub fn materials(document: &Document, solid: &Solid) -> Result<Materials, SceneError> {
    let mut materials = Materials { constants: BTreeMap::new(), names: BTreeMap::new(), k0: BTreeMap::new() };
    for (i, m) in solid.material.iter().enumerate() {
        let key = |k: &str| format!("solid.material.{i}.{k}");
        let constants = m
            .resolve()
            .map_err(|MaterialFault { key: k, found, expected }| document.error(&key(k), found, expected))?;
        if materials.constants.insert(m.id, constants).is_some() {
            return Err(document.error(&key("id"), format!("material {} again", m.id), "each number once"));
        }
        let name = if m.name.is_empty() { format!("material {}", m.id) } else { m.name.clone() };
        materials.names.insert(m.id, name);
        if let Some(k0) = m.k0 {
            super::common::check(document, &key("k0"), k0, k0 >= 0.0 && k0.is_finite(), "0 or more")?;
            materials.k0.insert(m.id, k0);
        }
    }
    Ok(materials)
}
