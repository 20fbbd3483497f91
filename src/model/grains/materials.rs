//! `[[material]]` resolved.

use super::check;
use crate::scene::{Document, Scene, SceneError};
use trackbed_dem::Material;

/// Checks the materials, in the order of the scene.
pub(super) fn build(document: &Document, scene: &Scene) -> Result<Vec<Material>, SceneError> {
    let mut out = Vec::new();
    for (i, m) in scene.material.iter().enumerate() {
        let key = |k: &str| format!("material.{i}.{k}");
        if scene.material[..i].iter().any(|other| other.name == m.name) {
            return Err(document.error(&key("name"), format!("\"{}\" again", m.name), "each name once"));
        }
        check(document, &key("density"), m.density.map(|d| d.si), |d| d > 0.0, "a density above 0")?;
        check(document, &key("stiffness"), m.stiffness.map(|s| s.si), |k| k > 0.0, "a stiffness above 0")?;
        check(
            document,
            &key("tangential_ratio"),
            Some(m.tangential_ratio),
            |r| (0.0..=1.0).contains(&r),
            "0 to 1",
        )?;
        check(
            document,
            &key("tangential_damping_ratio"),
            Some(m.tangential_damping_ratio),
            |r| (0.0..=1.0).contains(&r),
            "0 to 1",
        )?;
        check(document, &key("friction"), Some(m.friction), |f| f >= 0.0, "0 or more")?;
        check(
            document,
            &key("restitution"),
            Some(m.restitution),
            |e| e > 0.0 && e <= 1.0,
            "above 0, at most 1",
        )?;
        out.push(Material {
            // Bodies need a density and say so; walls never use it.
            density: m.density.map_or(1.0, |d| d.si),
            stiffness: m.stiffness.map_or(f64::INFINITY, |s| s.si),
            tangential_ratio: m.tangential_ratio,
            tangential_damping_ratio: m.tangential_damping_ratio,
            friction: m.friction,
            restitution: m.restitution,
        });
    }
    Ok(out)
}
