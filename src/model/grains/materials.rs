//! `[[material]]` and `[[contact]]` resolved.

use super::check;
use crate::scene::material::{DampingKind, GrainMaterial, PairContact, Resistance};
use crate::scene::{Document, Scene, SceneError};
use trackbed_dem::law::damping::Damping;
use trackbed_dem::law::table::{self, Combination, combination};
use trackbed_dem::material::{LawName, Pair};
use trackbed_dem::{Material, PairOverride};

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
        poisson_beside_young(document, i, m)?;
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
            normal: normal(document, &key("normal"), m.normal.as_deref())?,
        });
    }
    Ok(out)
}

fn poisson_beside_young(document: &Document, i: usize, m: &GrainMaterial) -> Result<(), SceneError> {
    let key = format!("material.{i}.poisson");
    match (&m.young, m.poisson) {
        (Some(_), None) => Err(document.error(&key, "nothing", "Poisson's ratio beside `young`")),
        (None, Some(_)) => Err(document.error(&key, "a value", "no such key without `young`")),
        _ => Ok(()),
    }
}

fn normal(document: &Document, key: &str, name: Option<&str>) -> Result<Option<LawName>, SceneError> {
    let Some(name) = name else { return Ok(None) };
    let expected = || format!("one of {}", table::normals().join(", "));
    table::normal_named(name).map(Some).ok_or_else(|| document.error(key, format!("\"{name}\""), expected()))
}

fn tangential(document: &Document, key: &str, name: Option<&str>) -> Result<Option<LawName>, SceneError> {
    let Some(name) = name else { return Ok(None) };
    let expected = || format!("one of {}", table::tangentials().join(", "));
    table::tangential_named(name)
        .map(Some)
        .ok_or_else(|| document.error(key, format!("\"{name}\""), expected()))
}

/// Checks the pairs, in the order of the scene; `find` gives the number of a material.
pub(super) fn pairs(
    document: &Document,
    scene: &Scene,
    find: impl Fn(&str, &str) -> Result<usize, SceneError>,
) -> Result<Vec<PairOverride>, SceneError> {
    let mut out = Vec::new();
    for (i, c) in scene.contact.iter().enumerate() {
        let key = |k: &str| format!("contact.{i}.{k}");
        check(document, &key("friction"), c.friction, |f| f >= 0.0, "0 or more")?;
        check(document, &key("restitution"), c.restitution, |e| e > 0.0 && e <= 1.0, "above 0, at most 1")?;
        check(document, &key("stiffness"), c.stiffness.map(|s| s.si), |k| k > 0.0, "above 0")?;
        check(document, &key("adhesion"), c.adhesion.map(|w| w.si), |w| w >= 0.0, "0 or more")?;
        let resist = |k: &str, kind: Option<Resistance>, value: Option<f64>| {
            check(document, &key(k), value, |f| f >= 0.0, "0 or more")?;
            match (kind, value) {
                (Some(Resistance::None), Some(_)) => {
                    let expected = "no such key without the resistance";
                    Err(document.error(&key(k), "a value", expected))
                }
                (Some(Resistance::None), None) => Ok(Some(0.0)),
                (Some(Resistance::Spring) | None, value) => Ok(value),
            }
        };
        out.push(PairOverride {
            a: find(&key("between"), &c.between[0])?,
            b: find(&key("between"), &c.between[1])?,
            friction: c.friction,
            restitution: c.restitution,
            stiffness: c.stiffness.map(|s| s.si),
            adhesion: c.adhesion.map(|w| w.si),
            normal: normal(document, &key("normal"), c.normal.as_deref())?,
            tangential: tangential(document, &key("tangential"), c.tangential.as_deref())?,
            damping: damping(document, i, c)?,
            rolling_friction: resist("rolling_friction", c.rolling, c.rolling_friction)?,
            twisting_friction: resist("twisting_friction", c.twisting, c.twisting_friction)?,
        });
    }
    Ok(out)
}

fn damping(document: &Document, i: usize, c: &PairContact) -> Result<Option<Damping>, SceneError> {
    let key = |k: &str| format!("contact.{i}.{k}");
    check(document, &key("damping_ratio"), c.damping_ratio, |z| z >= 0.0, "0 or more")?;
    match (c.damping, c.damping_ratio) {
        (Some(DampingKind::Ratio), Some(zeta)) => Ok(Some(Damping::Ratio(zeta))),
        (Some(DampingKind::Ratio), None) => {
            Err(document.error(&key("damping_ratio"), "nothing", "the damping ratio"))
        }
        (_, Some(_)) => {
            let expected = "no such key without `damping = \"ratio\"`";
            Err(document.error(&key("damping_ratio"), "a value", expected))
        }
        (Some(_), None) if c.restitution.is_some() && c.damping == Some(DampingKind::None) => {
            let expected = "no such key beside `damping = \"none\"`";
            Err(document.error(&key("restitution"), "a value", expected))
        }
        (Some(DampingKind::None), None) => Ok(Some(Damping::None)),
        (Some(DampingKind::Restitution), None) => Ok(Some(Damping::Restitution)),
        (None, None) => Ok(None),
    }
}

/// Refuses pairs without a law, and constants that no law uses.
pub(super) fn check_laws(
    document: &Document,
    scene: &Scene,
    materials: &[Material],
    contacts: &[PairOverride],
) -> Result<(), SceneError> {
    let name = |i: usize| scene.material[i].name.as_str();
    let law = |i: usize, j: usize| combination(&Pair::of(materials, contacts, i, j));
    let given =
        |i: usize, j: usize| contacts.iter().rposition(|c| (c.a, c.b) == (i, j) || (c.a, c.b) == (j, i));
    for i in 0..materials.len() {
        let mut laws: Vec<&Combination> = Vec::new();
        for j in 0..materials.len() {
            match law(i, j) {
                Ok(law) => laws.extend(law),
                Err(problem) => {
                    let entry = given(i, j).filter(|&c| contacts[c].normal.is_some());
                    let key = entry.map_or(format!("material.{j}"), |c| format!("contact.{c}.normal"));
                    let expected =
                        "a law for each pair of materials, from both or from `normal` of their [[contact]]";
                    let found = format!("for \"{}\" and \"{}\" {problem}", name(i), name(j));
                    return Err(document.error(&key, found, expected));
                }
            }
        }
        check_constants(document, scene, i, &laws)?;
        if let (Some(normal), Ok(Some(own))) = (materials[i].normal, law(i, i)) {
            let m = &scene.material[i];
            let there = [("stiffness", m.stiffness.is_some()), ("young", m.young.is_some())];
            if let Some((key, _)) = there.iter().find(|(key, there)| own.normal_keys.contains(key) && !there)
            {
                let expected =
                    format!("a value for this key, which `normal = \"{}\"` needs", normal.as_str());
                return Err(document.error(&format!("material.{i}.{key}"), "nothing", expected));
            }
        }
    }
    for (i, c) in contacts.iter().enumerate() {
        let Ok(Some(own)) = law(c.a, c.b) else { continue };
        let key = |k: &str| format!("contact.{i}.{k}");
        if c.stiffness.is_some() && !own.uses("stiffness") {
            let expected = "no stiffness where materials have a Young's modulus";
            return Err(document.error(&key("stiffness"), "a stiffness", expected));
        }
        if c.damping.is_some() && !own.dashpot {
            let expected = format!("no such key, as normal law \"{}\" has no dashpot", own.normal);
            return Err(document.error(&key("damping"), "a value", expected));
        }
    }
    Ok(())
}

/// Refuses constants of material `i` that none of the laws of its contacts uses.
fn check_constants(
    document: &Document,
    scene: &Scene,
    i: usize,
    laws: &[&Combination],
) -> Result<(), SceneError> {
    let m = &scene.material[i];
    let unused = |key: &str| !laws.is_empty() && !laws.iter().any(|law| law.uses(key));
    let key = |k: &str| format!("material.{i}.{k}");
    if m.stiffness.is_some() && unused("stiffness") {
        let young = scene.material.iter().find(|other| other.young.is_some());
        let expected = match young {
            Some(other) => format!("no stiffness, as \"{}\" has a Young's modulus", other.name),
            None => "no stiffness, as no law of its contacts uses one".to_string(),
        };
        return Err(document.error(&key("stiffness"), "a stiffness", expected));
    }
    if m.young.is_some() && unused("young") {
        let expected = "no modulus, as no law of its contacts uses one";
        return Err(document.error(&key("young"), "a modulus", expected));
    }
    if m.tangential_damping_ratio > 0.0 && !laws.is_empty() && !laws.iter().any(|law| law.dashpot) {
        let expected = "no such key, as no law of its contacts has a dashpot";
        return Err(document.error(&key("tangential_damping_ratio"), "a value", expected));
    }
    if m.tangential_ratio.is_some() && unused("tangential_ratio") {
        let expected = "no such key beside `young`: Poisson's ratio sets it";
        return Err(document.error(&key("tangential_ratio"), "a value", expected));
    }
    Ok(())
}

/// Whether the stiffness of any contact grows with the overlap.
pub(super) fn stiffens(materials: &[Material], contacts: &[PairOverride]) -> bool {
    let count = materials.len();
    let mut pairs = (0..count).flat_map(|i| (i..count).map(move |j| Pair::of(materials, contacts, i, j)));
    pairs.any(|pair| combination(&pair).ok().flatten().is_some_and(|law| law.stiffens))
}
