//! Laws of the contacts that materials and pairs select, and constants that none of them uses.

use crate::scene::{Document, Scene, SceneError};
use trackbed_dem::law::table::{Combination, combination};
use trackbed_dem::material::Pair;
use trackbed_dem::{Material, PairOverride};

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
