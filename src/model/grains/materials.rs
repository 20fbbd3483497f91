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
        check(document, &key("young"), m.young.map(|y| y.si), |y| y > 0.0, "a modulus above 0")?;
        check(document, &key("poisson"), m.poisson, |p| p > -1.0 && p <= 0.5, "above -1, at most 0.5")?;
        refuse_mixed(document, scene, i)?;
        check(
            document,
            &key("tangential_ratio"),
            m.tangential_ratio,
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
        for (k, value) in
            [("rolling_friction", m.rolling_friction), ("twisting_friction", m.twisting_friction)]
        {
            check(document, &key(k), Some(value), |f| f >= 0.0, "0 or more")?;
        }
        out.push(Material {
            // Bodies need a density and say so; walls never use it.
            density: m.density.map_or(1.0, |d| d.si),
            stiffness: m.stiffness.map_or(f64::INFINITY, |s| s.si),
            tangential_ratio: m.tangential_ratio.unwrap_or(0.5),
            tangential_damping_ratio: m.tangential_damping_ratio,
            friction: m.friction,
            restitution: m.restitution,
            young: m.young.map(|y| y.si),
            poisson: m.poisson.unwrap_or(0.0),
            rolling_friction: m.rolling_friction,
            twisting_friction: m.twisting_friction,
        });
    }
    Ok(out)
}

/// Keys of the linear law and of Hertz's may not meet in one scene, nor stand where they have no effect.
fn refuse_mixed(document: &Document, scene: &Scene, i: usize) -> Result<(), SceneError> {
    let m = &scene.material[i];
    let key = |k: &str| format!("material.{i}.{k}");
    let hertz = scene.material.iter().find(|m| m.young.is_some());
    match (&m.young, hertz) {
        (Some(_), _) if m.poisson.is_none() => {
            Err(document.error(&key("poisson"), "nothing", "Poisson's ratio beside `young`"))
        }
        (None, _) if m.poisson.is_some() => {
            Err(document.error(&key("poisson"), "a value", "no such key without `young`"))
        }
        (_, Some(other)) if m.stiffness.is_some() => {
            let expected = format!("no stiffness, as \"{}\" has a Young's modulus", other.name);
            Err(document.error(&key("stiffness"), "a stiffness", expected))
        }
        (_, Some(_)) if m.tangential_ratio.is_some() => {
            let expected = "no such key beside `young`: Poisson's ratio sets it";
            Err(document.error(&key("tangential_ratio"), "a value", expected))
        }
        _ => Ok(()),
    }
}
