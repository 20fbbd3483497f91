//! Materials of the solid, resolved.

use crate::scene::solid::{MaterialFault, Solid};
use crate::scene::{SceneError, Table};
use std::collections::BTreeMap;
use trackbed_fem::material::Material;

/// Materials by number, with names.
pub struct Materials {
    /// Constants.
    pub constants: BTreeMap<u32, Material>,
    /// Names.
    pub names: BTreeMap<u32, String>,
    /// Horizontal over vertical initial stress, if set.
    pub k0: BTreeMap<u32, f64>,
}

/// Resolves `[[solid.material]]`.
///
/// # Errors
/// Missing, unexpected or invalid constants.
pub fn materials(solid: &Table<Solid>) -> Result<Materials, SceneError> {
    let mut materials = Materials { constants: BTreeMap::new(), names: BTreeMap::new(), k0: BTreeMap::new() };
    for m in solid.rows("material", &solid.material) {
        let constants = m
            .resolve(|file| m.locate(file))
            .map_err(|MaterialFault { key, problem }| m.problem(key, problem))?;
        if materials.constants.insert(m.id, constants).is_some() {
            return Err(m.error("id", format!("material {} again", m.id), "each number once"));
        }
        materials.names.insert(m.id, m.title());
        if let Some(k0) = m.check("k0", m.k0, |k0| k0 >= 0.0, "0 or more")? {
            materials.k0.insert(m.id, k0);
        }
    }
    Ok(materials)
}
